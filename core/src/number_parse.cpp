// SPDX-License-Identifier: MIT
#include <charconv>
#include <cstring>
#include <limits>
#include <type_traits>

#include "number_natural.h"
#include "number_text.h"

namespace quadmark {
namespace {

/// A decimal number taken apart: value = (+-) mantissa * 10^exponent, exact unless `truncated`.
struct Decimal {
  bool negative = false;
  bool truncated = false;  // more than 19 significant digits
  std::uint64_t mantissa = 0;
  std::int64_t exponent = 0;
  std::int64_t written = 0;  // the exponent behind the e, which `exponent` contains
};

bool isDigit(char character) {
  return character >= '0' && character <= '9';
}

/// Checks the grammar [+-] digits [. digits] [(e|E) [+-] digits] with a digit on at least one side of the point.
std::optional<Decimal> takeApart(std::string_view text) {
  constexpr std::int64_t kExponentLimit = 1000000;  // far outside any range, far from overflow
  Decimal number;
  std::size_t at = 0;
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) number.negative = text[at++] == '-';
  bool anyDigit = false, afterPoint = false;
  int significant = 0;
  for (; at < text.size(); ++at) {
    if (text[at] == '.' && !afterPoint) {
      afterPoint = true;
      continue;
    }
    if (!isDigit(text[at])) break;
    anyDigit = true;
    const auto digit = static_cast<std::uint64_t>(text[at] - '0');
    if (significant < 19) {
      number.mantissa = 10 * number.mantissa + digit;
      if (number.mantissa != 0) ++significant;
      if (afterPoint) --number.exponent;
    } else {
      number.truncated = true;
      if (!afterPoint) ++number.exponent;
    }
  }
  if (!anyDigit) return std::nullopt;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    bool negative = false;
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) negative = text[at++] == '-';
    if (at == text.size()) return std::nullopt;
    std::int64_t exponent = 0;
    for (; at < text.size() && isDigit(text[at]); ++at) {
      if (exponent < kExponentLimit) exponent = 10 * exponent + (text[at] - '0');
    }
    number.written = negative ? -exponent : exponent;
    number.exponent += number.written;
  }
  if (at != text.size()) return std::nullopt;
  return number;
}

template <class T>
struct FastRange;
template <>
struct FastRange<float> {
  static constexpr std::uint64_t kMantissa = std::uint64_t{1} << 24;
  static constexpr float kPowers[] = {1e0f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f, 1e7f, 1e8f, 1e9f, 1e10f};
};
template <>
struct FastRange<double> {
  static constexpr std::uint64_t kMantissa = std::uint64_t{1} << 53;
  static constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                       1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
};

/// Of an IEEE number: bits of the mantissa with the hidden one, exponent of its last bit at the least, and the number
/// of exponents, of which the last one means infinity.
struct Format {
  int mantissaBits, leastExponent, exponents;
};
constexpr Format kFloat = {24, -149, 255}, kDouble = {53, -1074, 2047};

/// The significant digits of a number as an integer, and the power of ten behind it. Digits beyond any that could matter
/// become a last 1, which lies on the same side of every binary number and of every middle between two.
Natural significantDigits(std::string_view text, std::int64_t& power) {
  constexpr int kMostDigits = 780;  // a middle between two doubles has at most 767
  Natural value(0);
  int digits = 0;
  bool afterPoint = false, cutOff = false;
  for (const char character : text) {
    if (character == 'e' || character == 'E') break;
    if (character == '.') afterPoint = true;
    if (!isDigit(character)) continue;
    if (digits < kMostDigits) {
      value.multiply(10, static_cast<std::uint32_t>(character - '0'));
      if (digits > 0 || character != '0') ++digits;
      if (afterPoint) --power;
    } else {
      cutOff = cutOff || character != '0';
      if (!afterPoint) ++power;
    }
  }
  if (!cutOff) return value;
  value.multiply(10, 1);
  --power;
  return value;
}

/// The general case: a quotient of integers, divided bit by bit and rounded once, ties to even.
/// @param number  not zero.
/// @return the bits of the number in its format, without the sign.
std::uint64_t parseExactly(std::string_view text, const Decimal& number, const Format& format) {
  const std::uint64_t hidden = std::uint64_t{1} << (format.mantissaBits - 1), infinity = format.exponents * hidden;
  // 1. Numbers out of all ranges, so that the integers stay within bounds.
  if (number.exponent > 310) return infinity;
  if (number.exponent < -350) return 0;  // the mantissa is below 10^19

  // 2. numerator / denominator in [2^(bits-1), 2^bits) times 2^exponent, or less at the least exponent.
  std::int64_t power = number.written;
  Natural numerator = significantDigits(text, power), denominator(1);
  (power > 0 ? numerator : denominator).multiplyByPowerOfTen(static_cast<int>(power > 0 ? power : -power));
  int exponent = numerator.bitLength() - denominator.bitLength() - format.mantissaBits;
  if (exponent < format.leastExponent) exponent = format.leastExponent;
  (exponent > 0 ? denominator : numerator).shiftLeft(exponent > 0 ? exponent : -exponent);
  denominator.shiftLeft(format.mantissaBits - 1);
  Natural twice = denominator;
  twice.shiftLeft(1);
  if (numerator.compare(twice) >= 0) {
    denominator = twice;
    ++exponent;
  }

  // 3. The bits, from the highest to the lowest.
  std::uint64_t mantissa = 0;
  for (int bit = 0; bit < format.mantissaBits; ++bit) {
    mantissa *= 2;
    if (numerator.compare(denominator) >= 0) {
      numerator.subtract(denominator);
      ++mantissa;
    }
    numerator.shiftLeft(1);
  }
  const int rest = numerator.compare(denominator);  // twice the remainder, against the lowest bit
  if (rest > 0 || (rest == 0 && mantissa % 2 != 0)) ++mantissa;

  // 4. Bits of the format. A carry into the next exponent, or from the denormal numbers, is right by itself.
  const std::uint64_t bits = static_cast<std::uint64_t>(exponent - format.leastExponent) * hidden + mantissa;
  return bits < infinity ? bits : infinity;
}

void parseExactly(std::string_view text, const Decimal& number, float& value) {
  const auto bits = static_cast<std::uint32_t>(parseExactly(text, number, kFloat));
  std::memcpy(&value, &bits, sizeof(value));
}
void parseExactly(std::string_view text, const Decimal& number, double& value) {
  const std::uint64_t bits = parseExactly(text, number, kDouble);
  std::memcpy(&value, &bits, sizeof(value));
}

/// NaN or infinity in the spellings that printf implementations produce.
std::optional<double> parseNotFinite(std::string_view text) {
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  std::string lower;
  for (const char character : text.substr(0, 12)) {
    lower += character >= 'A' && character <= 'Z' ? static_cast<char>(character - 'A' + 'a') : character;
  }
  if (lower == "inf" || lower == "infinity" || lower == "1.#inf") {
    return negative ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  }
  const bool nan = lower == "nan" || lower == "nan(ind)" || lower == "nan(snan)" || lower == "1.#ind" ||
                   lower == "1.#qnan" || lower == "1.#snan";
  if (nan) return std::numeric_limits<double>::quiet_NaN();
  return std::nullopt;
}

/// Where mantissa and power of ten are exact, one multiplication or division rounds correctly (Clinger 1990).
template <class T>
std::optional<T> parseFast(const Decimal& number) {
  using Fast = FastRange<T>;
  constexpr auto kLargestPower = static_cast<std::int64_t>(std::size(Fast::kPowers)) - 1;
  if (number.truncated || number.mantissa > Fast::kMantissa || number.exponent < -kLargestPower ||
      number.exponent > kLargestPower) {
    return std::nullopt;
  }
  T value = static_cast<T>(number.mantissa);
  if (number.exponent < 0) {
    value /= Fast::kPowers[-number.exponent];
  } else {
    value *= Fast::kPowers[number.exponent];
  }
  return number.negative ? -value : value;
}

/// Most floats with too many digits for that: the nearest double tells the nearest float, unless it is the very middle
/// between two. Denormal floats are out of these powers' reach.
std::optional<float> parseByDouble(const Decimal& number) {
  const std::optional<double> wide = parseFast<double>(number);
  if (!wide) return std::nullopt;
  std::uint64_t bits;
  std::memcpy(&bits, &*wide, sizeof(bits));
  if ((bits & 0x1fffffff) == 0x10000000) return std::nullopt;
  return static_cast<float>(*wide);
}

template <class T>
std::optional<T> parseNumber(std::string_view text) {
  const std::optional<Decimal> number = takeApart(text);
  if (!number) {
    const std::optional<double> value = parseNotFinite(text);
    return value ? std::optional<T>(static_cast<T>(*value)) : std::nullopt;
  }
  if (const std::optional<T> value = parseFast<T>(*number)) return value;
  if constexpr (std::is_same_v<T, float>) {
    if (const std::optional<float> value = parseByDouble(*number)) return value;
  }
  if (number->mantissa == 0 && !number->truncated) return number->negative ? -T{0} : T{0};
  T value;
  parseExactly(text, *number, value);
  return number->negative ? -value : value;
}

}  // namespace

std::optional<float> parseFloat(std::string_view text) {
  return parseNumber<float>(text);
}
std::optional<double> parseDouble(std::string_view text) {
  return parseNumber<double>(text);
}

std::optional<std::int64_t> parseInteger(std::string_view text) {
  if (!text.empty() && text[0] == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text[0] == '-') return std::nullopt;
  }
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace quadmark
