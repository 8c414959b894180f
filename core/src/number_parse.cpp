// SPDX-License-Identifier: MIT
#include <charconv>
#include <cstdlib>
#include <limits>

#include "number_text.h"

namespace quadmark {
namespace {

/// A decimal number taken apart: value = (+-) mantissa * 10^exponent, exact unless `truncated`.
struct Decimal {
  bool negative = false;
  bool truncated = false;  // more than 19 significant digits
  std::uint64_t mantissa = 0;
  std::int64_t exponent = 0;
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
    number.exponent += negative ? -exponent : exponent;
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

/// The general case, by the C++ library: from_chars where it exists for floating point, else strtof / strtod, which in
/// Emscripten (musl) know no locale and round once.
template <class T>
T parseWithLibrary(std::string_view text, const Decimal& number) {
  if (text[0] == '+') text.remove_prefix(1);  // from_chars knows no plus sign
#if defined(__cpp_lib_to_chars)
  T value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc()) return value;
  // Out of range and no value given: all such numbers are far on one side of 1.
  const T limit = number.exponent > -20 ? std::numeric_limits<T>::infinity() : T{0};
  return number.negative ? -limit : limit;
#else
  static_cast<void>(number);
  const std::string terminated(text);
  if constexpr (std::is_same_v<T, float>) {
    return std::strtof(terminated.c_str(), nullptr);
  } else {
    return std::strtod(terminated.c_str(), nullptr);
  }
#endif
}

/// NaN or infinity in the spellings that printf implementations produce.
template <class T>
std::optional<T> parseNotFinite(std::string_view text) {
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  std::string lower;
  for (const char character : text.substr(0, 12)) {
    lower += character >= 'A' && character <= 'Z' ? static_cast<char>(character - 'A' + 'a') : character;
  }
  if (lower == "inf" || lower == "infinity" || lower == "1.#inf") {
    return negative ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::infinity();
  }
  const bool nan = lower == "nan" || lower == "nan(ind)" || lower == "nan(snan)" || lower == "1.#ind" ||
                   lower == "1.#qnan" || lower == "1.#snan";
  if (nan) return std::numeric_limits<T>::quiet_NaN();
  return std::nullopt;
}

template <class T>
std::optional<T> parseNumber(std::string_view text) {
  using Fast = FastRange<T>;
  const std::optional<Decimal> number = takeApart(text);
  if (!number) return parseNotFinite<T>(text);
  // Mantissa and power of ten are exact, so one multiplication or division rounds correctly (Clinger 1990).
  constexpr auto kLargestPower = static_cast<std::int64_t>(std::size(Fast::kPowers)) - 1;
  if (!number->truncated && number->mantissa <= Fast::kMantissa && number->exponent >= -kLargestPower &&
      number->exponent <= kLargestPower) {
    T value = static_cast<T>(number->mantissa);
    if (number->exponent < 0) {
      value /= Fast::kPowers[-number->exponent];
    } else {
      value *= Fast::kPowers[number->exponent];
    }
    return number->negative ? -value : value;
  }
  if (number->mantissa == 0 && !number->truncated) return number->negative ? -T{0} : T{0};
  return parseWithLibrary<T>(text, *number);
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
