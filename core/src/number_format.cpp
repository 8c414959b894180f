// SPDX-License-Identifier: MIT
#include <cstring>

#include "concat.h"
#include "number_natural.h"
#include "number_text.h"

namespace quadmark {
namespace {

/// The same operations on 64 bits, for the floats of everyday size.
class Word {
 public:
  explicit Word(std::uint64_t value) : value_(value) {}
  void multiply(std::uint32_t factor) { value_ *= factor; }
  void multiplyByPowerOfTen(int exponent) {
    for (; exponent > 0; --exponent) value_ *= 10;
  }
  void shiftLeft(int bits) { value_ <<= bits; }
  void add(const Word& other) { value_ += other.value_; }
  void subtract(const Word& other) { value_ -= other.value_; }
  [[nodiscard]] int compare(const Word& other) const {
    return value_ < other.value_ ? -1 : value_ > other.value_ ? 1 : 0;
  }
  [[nodiscard]] int compareSum(const Word& other, const Word& limit) const {
    return Word(value_ + other.value_).compare(limit);
  }

 private:
  std::uint64_t value_;
};

/// value = 0.d1 d2 ... dn * 10^exponent
struct Digits {
  char digits[20];
  int count = 0;
  int exponent = 0;
};

/// Digits of mantissa * 2^exponent, until they identify it among its neighbours of the same format.
/// @param atPowerOfTwo  the neighbour below is half as far away as the one above.
/// @tparam Int  wide enough for 10 * (mantissa + 1) and for 10 * 2^-exponent, both times the power of ten of step 1.
template <class Int>
Digits shortestDigits(std::uint64_t mantissa, int exponent, bool atPowerOfTwo) {
  // Invariants: value = remainder / scale; the rounding interval reaches below / scale and above / scale from it.
  Int remainder(mantissa), scale(1), below(1), above(1);
  const int extraBit = atPowerOfTwo ? 2 : 1;
  remainder.shiftLeft((exponent > 0 ? exponent : 0) + extraBit);
  scale.shiftLeft((exponent < 0 ? -exponent : 0) + extraBit);
  below.shiftLeft(exponent > 0 ? exponent : 0);
  above.shiftLeft((exponent > 0 ? exponent : 0) + extraBit - 1);

  // 1. Scale by the power of ten that brings the value into [0.1, 1): an estimate from the bit length, then a
  // correction.
  int bits = 0;
  for (std::uint64_t rest = mantissa; rest != 0; rest >>= 1) ++bits;
  const int log2Floor = exponent + bits - 1;
  Digits result;
  result.exponent =
      static_cast<int>((std::int64_t{log2Floor} * 78913) >> 18);  // floor(log10(2^log2Floor)), or one less
  if (result.exponent > 0) {
    scale.multiplyByPowerOfTen(result.exponent);
  } else {
    remainder.multiplyByPowerOfTen(-result.exponent);
    below.multiplyByPowerOfTen(-result.exponent);
    above.multiplyByPowerOfTen(-result.exponent);
  }
  const bool even = mantissa % 2 == 0;  // ties round to even, so the interval of an even mantissa contains its ends
  const auto reachesAbove = [&](const Int& limit) {
    const int order = remainder.compareSum(above, limit);
    return even ? order >= 0 : order > 0;
  };
  while (reachesAbove(scale)) {
    scale.multiply(10);
    ++result.exponent;
  }

  // 2. Digits.
  for (;;) {
    remainder.multiply(10);
    below.multiply(10);
    above.multiply(10);
    int digit = 0;
    while (remainder.compare(scale) >= 0) {
      remainder.subtract(scale);
      ++digit;
    }
    const int belowOrder = remainder.compare(below);
    const bool low = even ? belowOrder <= 0 : belowOrder < 0;
    const bool high = reachesAbove(scale);
    if (low || high) {
      // Down, up, or if both would do, to the nearer one, in a tie to the even digit (as std::to_chars does).
      const int half = remainder.compareSum(remainder, scale);
      const bool up = high && (!low || half > 0 || (half == 0 && digit % 2 != 0));
      result.digits[result.count++] = static_cast<char>('0' + digit + (up ? 1 : 0));
      return result;
    }
    result.digits[result.count++] = static_cast<char>('0' + digit);
  }
}

std::string layOut(bool negative, const Digits& number) {
  std::string text = negative ? "-" : "";
  const int point = number.exponent;  // digits before the decimal point
  if (point > -5 && point <= 16) {
    if (point <= 0) {
      text += "0.";
      text.append(static_cast<std::size_t>(-point), '0');
      text.append(number.digits, static_cast<std::size_t>(number.count));
      return text;
    }
    for (int i = 0; i < number.count || i < point; ++i) {
      if (i == point) text += '.';
      text += i < number.count ? number.digits[i] : '0';
    }
    return text;
  }
  text += number.digits[0];
  if (number.count > 1) {
    text += '.';
    text.append(number.digits + 1, static_cast<std::size_t>(number.count - 1));
  }
  return concat(text, 'e', point - 1);
}

/// Splits an IEEE number into its stored mantissa bits, `mantissaBits` of them, and the exponent above them.
std::string format(std::uint64_t bits, bool negative, int mantissaBits, int bias) {
  const std::uint64_t hidden = std::uint64_t{1} << mantissaBits, fraction = bits & (hidden - 1);
  const int biased = static_cast<int>(bits >> mantissaBits);
  if (biased == 0 && fraction == 0) return negative ? "-0" : "0";
  const std::uint64_t mantissa = biased == 0 ? fraction : fraction | hidden;
  const int exponent = (biased == 0 ? 1 : biased) - bias - mantissaBits;
  const bool atPowerOfTwo = fraction == 0 && biased > 1;
  // Floats from 2^-17 up to 2^24 stay below 2^52 throughout: 2^26 * 10^6 * 10 above the bar, 2^42 * 10 * 10 below it.
  const bool small = mantissaBits == 23 && exponent >= -40 && exponent <= 0 && biased != 0;
  if (small) return layOut(negative, shortestDigits<Word>(mantissa, exponent, atPowerOfTwo));
  return layOut(negative, shortestDigits<Natural>(mantissa, exponent, atPowerOfTwo));
}

}  // namespace

std::string formatShortest(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return format(bits & 0x7fffffffu, (bits >> 31) != 0, 23, 127);
}

std::string formatShortest(double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return format(bits & 0x7fffffffffffffffu, (bits >> 63) != 0, 52, 1023);
}

}  // namespace quadmark
