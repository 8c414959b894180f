// SPDX-License-Identifier: MIT
#include "quadmark/digits.h"

#include <gtest/gtest.h>

#include <cmath>

namespace quadmark {
namespace {

PaperParams paramsOf(int L1, int H1, int L2, int H2) {
  PaperParams p;
  p.L1 = L1, p.H1 = H1, p.L2 = L2, p.H2 = H2;
  return p;
}

TEST(DigitSlot, ReadsThePaperExample) {
  const DigitSlot slot(2, 4);
  const RatioDigits d = slot.read(0.21375);
  EXPECT_EQ(d.prefix, 2u);
  EXPECT_EQ(d.code, 137u);
  EXPECT_NEAR(d.residue, 0, 1e-9);  // 0.2137 5: the centre
  EXPECT_EQ(slot.codeCount(), 1000u);
  EXPECT_EQ(slot.digitCount(), 3);
  EXPECT_DOUBLE_EQ(slot.cellWidth(), 1e-4);
}

TEST(DigitSlot, SplitsPrefixAndCodeAtAnyPositions) {
  const RatioDigits three = DigitSlot(3, 5).read(0.4130729);
  EXPECT_EQ(three.prefix, 41u);
  EXPECT_EQ(three.code, 307u);
  EXPECT_NEAR(three.residue, -0.21, 1e-9);
  const RatioDigits one = DigitSlot(2, 2).read(0.37499);
  EXPECT_EQ(one.prefix, 3u);
  EXPECT_EQ(one.code, 7u);
  EXPECT_NEAR(one.residue, -0.001, 1e-9);
  const RatioDigits nine = DigitSlot(2, 9).read(0.1234567894);
  EXPECT_EQ(nine.prefix, 1u);
  EXPECT_EQ(nine.code, 23456789u);
}

TEST(DigitSlot, ReadsBackEveryCodeItWrites) {
  for (const auto& [L, H] : {std::pair{2, 2}, {2, 3}, {2, 4}, {3, 5}, {4, 7}}) {
    const DigitSlot slot(L, H);
    for (std::uint32_t prefix = 0; slot.centre(prefix, 0) < 0.5; ++prefix)
      for (std::uint32_t code = 0; code < slot.codeCount(); code += H - L > 2 ? 37 : 1) {
        const double ratio = slot.centre(prefix, code);
        const RatioDigits d = slot.read(ratio);
        ASSERT_EQ(d.prefix, prefix) << ratio;
        ASSERT_EQ(d.code, code) << ratio;
        ASSERT_LT(std::fabs(d.residue), 1e-6) << ratio;
        // Anything less than half a digit away still reads the same.
        ASSERT_EQ(slot.read(ratio + 0.49 * slot.cellWidth()).code, code);
        ASSERT_EQ(slot.read(ratio - 0.49 * slot.cellWidth()).code, code);
      }
  }
}

TEST(OctalDigits, WritesBitsAsDecimalDigitsAndBack) {
  EXPECT_EQ(octalDigits(0b111000101, 3), 705u);
  EXPECT_EQ(octalDigits(0, 3), 0u);
  EXPECT_EQ(octalDigits(0b111111111, 3), 777u);
  EXPECT_EQ(octalDigits(0b001010, 2), 12u);
  for (std::uint32_t bits = 0; bits < 512; ++bits) {
    std::uint32_t back = ~0u;
    ASSERT_TRUE(fromOctalDigits(octalDigits(bits, 3), 3, back));
    EXPECT_EQ(back, bits);
  }
}

TEST(OctalDigits, DetectsEightAndNineAnywhere) {
  int refused = 0;
  for (std::uint32_t decimal = 0; decimal < 1000; ++decimal) {
    const bool hasBad = decimal % 10 > 7 || decimal / 10 % 10 > 7 || decimal / 100 > 7;
    std::uint32_t bits;
    EXPECT_EQ(fromOctalDigits(decimal, 3, bits), !hasBad) << decimal;
    refused += hasBad;
  }
  EXPECT_EQ(refused, 488);  // 1000 - 8^3
}

TEST(PairCodec, ReadsIndexFromTheSmallerAndPieceFromTheLargerRatio) {
  const PairCodec codec(paramsOf(2, 3, 2, 3), 96);
  for (const bool swapped : {false, true}) {
    const Reading r = swapped ? codec.read(0.3525, 0.1425) : codec.read(0.1425, 0.3525);
    EXPECT_EQ(r.state, ReadingState::ok);
    EXPECT_EQ(r.prefix1, 1u);
    EXPECT_EQ(r.index, 42u);
    EXPECT_EQ(r.prefix2, 3u);
    EXPECT_EQ(r.piece, 0b101'010u);  // digits 52, octal
  }
}

TEST(PairCodec, UsesSeparatePositionsForIndexAndPiece) {
  const PairCodec codec(paramsOf(2, 4, 3, 4), 900);
  EXPECT_EQ(codec.bitsPerPiece(), 6);
  const Reading r = codec.read(0.18475, 0.33645);  // 0.1|847 and 0.33|64
  EXPECT_EQ(r.state, ReadingState::ok);
  EXPECT_EQ(r.index, 847u);
  EXPECT_EQ(r.prefix1, 1u);
  EXPECT_EQ(r.prefix2, 33u);
  EXPECT_EQ(r.piece, 0b110'100u);
}

TEST(PairCodec, TellsErasuresFromReadings) {
  const PairCodec codec(paramsOf(2, 3, 2, 3), 96);
  EXPECT_EQ(codec.read(0.1975, 0.3525).state, ReadingState::badIndex);        // index 97 of 96
  EXPECT_EQ(codec.read(0.1955, 0.3525).state, ReadingState::ok);              // index 95
  EXPECT_EQ(codec.read(0.1425, 0.3825).state, ReadingState::badDigit);        // 82
  EXPECT_EQ(codec.read(0.1425, 0.3295).state, ReadingState::badDigit);        // 29
  EXPECT_EQ(codec.read(0.3525, 0.3525).state, ReadingState::ambiguousOrder);  // equal: which is which?
  EXPECT_EQ(codec.read(0.3525 - 4e-4, 0.3525).state, ReadingState::ambiguousOrder);  // less than a digit apart
  EXPECT_EQ(codec.read(0.005, 0.3525).state, ReadingState::outOfRange);       // below kMinRatio
  EXPECT_EQ(codec.read(0.1425, 0.4995).state, ReadingState::outOfRange);      // next to one half
}

TEST(PairCodec, OrdersRatiosThatRoundingCannotExchange) {
  const PairCodec codec(paramsOf(2, 3, 2, 3), 96);
  EXPECT_TRUE(codec.ordered(0.31, 0.3125));    // two and a half digit cells of 10^-3
  EXPECT_FALSE(codec.ordered(0.31, 0.3115));
  EXPECT_FALSE(codec.ordered(0.31, 0.31));
  EXPECT_FALSE(codec.ordered(0.32, 0.31));
  const PairCodec mixed(paramsOf(2, 4, 2, 2), 90);  // the coarser slot decides
  EXPECT_FALSE(mixed.ordered(0.31, 0.3125));
  EXPECT_TRUE(mixed.ordered(0.31, 0.3325));
}

}  // namespace
}  // namespace quadmark
