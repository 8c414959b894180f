// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "number_text.h"

namespace quadmark {
namespace {

/// Knuth's 64-bit congruential generator; its upper bits are good enough to pick test values.
struct Bits {
  std::uint64_t state = 88172645463325252u;
  std::uint64_t next() {
    state = 6364136223846793005u * state + 1442695040888963407u;
    return (state >> 32) | (state << 32);
  }
};

template <class T, class Pattern>
T fromBits(std::uint64_t bits) {
  const auto pattern = static_cast<Pattern>(bits);
  T value;
  std::memcpy(&value, &pattern, sizeof(value));
  return value;
}

TEST(NumberFormat, WritesTheShortestDigitsInPlainOrScientificNotation) {
  EXPECT_EQ(formatShortest(0.0f), "0");
  EXPECT_EQ(formatShortest(-0.0f), "-0");
  EXPECT_EQ(formatShortest(1.0f), "1");
  EXPECT_EQ(formatShortest(-12.5f), "-12.5");
  EXPECT_EQ(formatShortest(0.1f), "0.1");
  EXPECT_EQ(formatShortest(0.1), "0.1");
  EXPECT_EQ(formatShortest(double{0.1f}), "0.10000000149011612");
  EXPECT_EQ(formatShortest(1.0f / 3), "0.33333334");
  EXPECT_EQ(formatShortest(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(formatShortest(16777216.0f), "16777216");
  EXPECT_EQ(formatShortest(1e15), "1000000000000000");
  EXPECT_EQ(formatShortest(1e16), "1e16");
  EXPECT_EQ(formatShortest(1.5e-5f), "0.000015");
  EXPECT_EQ(formatShortest(1.5e-7f), "1.5e-7");
  EXPECT_EQ(formatShortest(5e-324), "5e-324");
  EXPECT_EQ(formatShortest(1.401298464324817e-45f), "1e-45");
  EXPECT_EQ(formatShortest(std::numeric_limits<float>::max()), "3.4028235e38");
  EXPECT_EQ(formatShortest(std::numeric_limits<double>::max()), "1.7976931348623157e308");
  EXPECT_EQ(formatShortest(9007199254740993.0), "9007199254740992");
  EXPECT_EQ(formatShortest(9.5367431640625e-07f), "9.536743e-7");  // a power of two: the interval is lopsided
}

template <class T, class Pattern>
void expectRoundTrips(int count) {
  Bits bits;
  for (int i = 0; i < count; ++i) {
    T value = fromBits<T, Pattern>(bits.next());
    if (i % 3 == 1) value = static_cast<T>(static_cast<double>(bits.next() % 4000001) / 1e6 - 2);
    if (i % 16 == 0)
      value = fromBits<T, Pattern>(bits.next() & ~((std::uint64_t{1} << (sizeof(T) == 4 ? 23 : 52)) - 1));
    if (!std::isfinite(value)) continue;
    const std::string text = formatShortest(value);
    T parsed, byLibrary;
    if constexpr (sizeof(T) == 4) {
      parsed = parseFloat(text).value();
      byLibrary = std::strtof(text.c_str(), nullptr);
    } else {
      parsed = parseDouble(text).value();
      byLibrary = std::strtod(text.c_str(), nullptr);
    }
    ASSERT_EQ(parsed, value) << text;
    ASSERT_EQ(byLibrary, value) << text;
    ASSERT_EQ(std::signbit(parsed), std::signbit(value)) << text;
#if defined(__cpp_lib_to_chars)
    char expected[64];
    const auto [end, error] =
        std::to_chars(expected, expected + sizeof(expected), value, std::chars_format::scientific);
    const auto digitsOf = [](std::string_view spelled) {
      std::string digits;
      for (const char c : spelled.substr(0, spelled.find('e'))) {
        if (c >= '0' && c <= '9' && !(c == '0' && digits.empty())) digits += c;
      }
      while (!digits.empty() && digits.back() == '0') digits.pop_back();
      return digits;
    };
    ASSERT_EQ(digitsOf(text), digitsOf({expected, static_cast<std::size_t>(end - expected)}));
#endif
  }
}

TEST(NumberFormat, RoundTripsFloatsWithAsFewDigitsAsToChars) {
  expectRoundTrips<float, std::uint32_t>(200000);
}
TEST(NumberFormat, RoundTripsDoublesWithAsFewDigitsAsToChars) {
  expectRoundTrips<double, std::uint64_t>(100000);
}

TEST(NumberParse, RoundsOnceToTheTypeOfTheProperty) {
  // Through a double this would round twice: down to 1 + 2^-24 exactly, then to the even 1.
  EXPECT_EQ(parseFloat("1.00000005960464477540").value(), 1.00000011920928955f);
  EXPECT_EQ(static_cast<float>(parseDouble("1.00000005960464477540").value()), 1.0f);
}

TEST(NumberParse, RoundsMiddlesToEvenHoweverManyDigitsTheyHave) {
  Bits bits;
  for (int i = 0; i < 20000; ++i) {
    // An odd number of 25 bits is the middle between two floats.
    const int exponent = static_cast<int>(bits.next() % 200) - 100;
    char text[400];
    std::snprintf(text, sizeof(text), "%.200f", std::ldexp(static_cast<double>((bits.next() >> 39) | 1), exponent));
    const std::string spelled = text;
    ASSERT_EQ(parseFloat(spelled).value(), std::strtof(text, nullptr)) << spelled;
    ASSERT_EQ(parseFloat(spelled + "1").value(), std::strtof((spelled + "1").c_str(), nullptr)) << spelled;
  }
  const char* numbers[] = {"9007199254740993", "9007199254740993.00000000000000000000000000000000000000000000000001",
                           "2.4703282292062327e-324", "2.4703282292062328e-324", "4.9406564584124654e-324",
                           "2.2250738585072011e-308", "2.2250738585072012e-308", "1.7976931348623158e308",
                           "1.7976931348623159e308", "1.7976931348623157e308", "7.0064923216240853e-46",
                           "7.0064923216240854e-46", "3.4028235677973366e38", "3.4028235677973365e38", "1e309", "1e-400",
                           "-1e400", "-1e-400", "0.1e-1000000000000", "123456789012345678901234567890e-340"};
  for (const char* text : numbers) {
    EXPECT_EQ(parseDouble(text).value(), std::strtod(text, nullptr)) << text;
    EXPECT_EQ(parseFloat(text).value(), std::strtof(text, nullptr)) << text;
    EXPECT_EQ(std::signbit(parseDouble(text).value()), text[0] == '-') << text;
  }
  // The middle between 0 and the least double has 751 digits; one more digit, far behind, decides.
  std::string least(1200, '\0');
  least.resize(static_cast<std::size_t>(std::snprintf(least.data(), least.size(), "%.1074f", 5e-324)));
  std::string middle = least;
  for (std::size_t i = 2, carry = 0; i < least.size(); ++i) {
    const std::size_t digit = 10 * carry + static_cast<std::size_t>(least[i] - '0');
    middle[i] = static_cast<char>('0' + digit / 2);
    carry = digit % 2;
  }
  middle += "5";
  EXPECT_EQ(parseDouble(middle).value(), 0.0);
  EXPECT_EQ(parseDouble(middle + std::string(5000, '0')).value(), 0.0);
  EXPECT_EQ(parseDouble(middle + std::string(5000, '0') + "1").value(), 5e-324);
  EXPECT_EQ(parseDouble(std::string(5000, '9') + "e-4999").value(), 10.0);
}

TEST(NumberParse, AgreesWithTheCLibraryOnRandomDecimals) {
  Bits bits;
  for (int i = 0; i < 100000; ++i) {
    std::string text = i % 2 == 0 ? "-" : "";
    const int digits = 1 + static_cast<int>(bits.next() % 25);
    const int point = static_cast<int>(bits.next() % 25);
    for (int d = 0; d < digits; ++d) {
      if (d == point) text += '.';
      text += static_cast<char>('0' + bits.next() % 10);
    }
    if (i % 3 == 0) text += "e" + std::to_string(static_cast<int>(bits.next() % 90) - 45);
    ASSERT_EQ(parseFloat(text).value(), std::strtof(text.c_str(), nullptr)) << text;
    ASSERT_EQ(parseDouble(text).value(), std::strtod(text.c_str(), nullptr)) << text;
  }
}

TEST(NumberParse, ReadsExtremesAndSpecialSpellings) {
  EXPECT_EQ(parseFloat("1e-45").value(), 1.401298464324817e-45f);
  EXPECT_EQ(parseFloat("1e-60").value(), 0.0f);
  EXPECT_TRUE(std::signbit(parseFloat("-1e-60").value()));
  EXPECT_TRUE(std::isinf(parseFloat("1e39").value()));
  EXPECT_TRUE(std::isinf(parseDouble("-1e400").value()));
  EXPECT_EQ(parseDouble("1e-400").value(), 0.0);
  EXPECT_EQ(parseDouble("0e999999999999").value(), 0.0);
  EXPECT_TRUE(std::isinf(parseDouble("1e999999999999").value()));
  EXPECT_EQ(parseDouble("+.5").value(), 0.5);
  EXPECT_EQ(parseDouble("5.").value(), 5.0);
  for (const char* text : {"nan", "NaN", "-nan(ind)", "1.#QNAN"})
    EXPECT_TRUE(std::isnan(parseFloat(text).value())) << text;
  for (const char* text : {"inf", "-Infinity", "1.#INF"}) EXPECT_TRUE(std::isinf(parseFloat(text).value())) << text;
}

TEST(NumberParse, RefusesWhatIsNotADecimalNumber) {
  for (const char* text :
       {"", "-", "+", ".", "e5", "1e", "1e+", "1..2", "--1", "+-1", "0x10", "1,5", " 1", "1 ", "1f", "abc"}) {
    EXPECT_FALSE(parseFloat(text).has_value()) << text;
    EXPECT_FALSE(parseDouble(text).has_value()) << text;
  }
  for (const char* text : {"", "-", "1.0", "1e3", "9223372036854775808", "+-1", " 1", "0x1"}) {
    EXPECT_FALSE(parseInteger(text).has_value()) << text;
  }
  EXPECT_EQ(parseInteger("+7").value(), 7);
  EXPECT_EQ(parseInteger("-9223372036854775808").value(), std::numeric_limits<std::int64_t>::min());
}

}  // namespace
}  // namespace quadmark
