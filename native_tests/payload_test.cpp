// SPDX-License-Identifier: MIT
#include "quadmark/payload.h"

#include <gtest/gtest.h>

#include <set>

#include "fixtures.h"

namespace quadmark {
namespace {

using test::strangersKey;
using test::testKey;

Key keyOfSize(std::uint32_t width, std::uint32_t height, std::uint8_t seed = 1) {
  return testKey(width, height, 2, seed);
}

bool isPermutation(const std::vector<std::uint32_t>& target) {
  std::vector<std::uint8_t> seen(target.size(), 0);
  for (std::uint32_t t : target) {
    if (t >= seen.size() || seen[t] != 0) return false;
    seen[t] = 1;
  }
  return true;
}

std::size_t fixedPoints(const std::vector<std::uint32_t>& target) {
  std::size_t fixed = 0;
  for (std::size_t i = 0; i < target.size(); ++i) fixed += target[i] == i;
  return fixed;
}

TEST(PieceCount, DividesAndRoundsUp) {
  EXPECT_EQ(pieceCount(keyOfSize(90, 90).params), 900u);
  EXPECT_EQ(pieceCount(keyOfSize(24, 24).params), 96u);
  EXPECT_EQ(pieceCount(keyOfSize(8, 8).params), 11u);    // 64 bits in sixes
  EXPECT_EQ(pieceCount(keyOfSize(2, 1).params), 1u);
}

TEST(Scrambling, IsAPermutationForEverySquareSize) {
  for (std::uint32_t side = 2; side <= 64; ++side)
    for (std::uint8_t seed = 1; seed <= 3; ++seed)
      ASSERT_TRUE(isPermutation(scrambling(keyOfSize(side, side, seed)))) << side;
}

TEST(Scrambling, IsAPermutationForOtherShapes) {
  for (const auto& [w, h] : {std::pair{64u, 1u}, {1u, 7u}, {2u, 1u}, {17u, 40u}, {33u, 32u}, {100u, 3u}})
    ASSERT_TRUE(isPermutation(scrambling(keyOfSize(w, h)))) << w << " x " << h;
}

TEST(Scrambling, DependsOnTheSecret) {
  for (const auto& [w, h] : {std::pair{24u, 24u}, {90u, 90u}, {64u, 1u}, {30u, 20u}}) {
    std::set<std::vector<std::uint32_t>> different;
    for (std::uint32_t i = 0; i < 20; ++i) different.insert(scrambling(strangersKey(keyOfSize(w, h), i)));
    EXPECT_GE(different.size(), 19u) << w << " x " << h;  // 23^2 * 14 Arnold maps: a repeat is possible, two are not
    EXPECT_EQ(scrambling(keyOfSize(w, h)), scrambling(keyOfSize(w, h)));
  }
}

TEST(Scrambling, LeavesFewPixelsInPlace) {
  for (std::uint32_t i = 0; i < 20; ++i) {
    const std::vector<std::uint32_t> target = scrambling(strangersKey(keyOfSize(24, 24), i));
    EXPECT_LT(fixedPoints(target), target.size() / 4) << "stranger " << i;
  }
}

TEST(ToPieces, PutsEachBitWhereTheScramblingSays) {
  for (const auto& [w, h] : {std::pair{8u, 8u}, {24u, 24u}, {64u, 1u}, {7u, 5u}}) {
    const Key key = keyOfSize(w, h);
    const std::vector<std::uint32_t> target = scrambling(key);
    const std::uint32_t width = 3 * static_cast<std::uint32_t>(key.params.H2 - key.params.L2 + 1);
    for (std::uint32_t i = 0; i < key.params.bitCount(); ++i) {
      std::vector<std::uint8_t> bits(key.params.bitCount(), 0);
      bits[i] = 1;
      const std::vector<std::uint32_t> pieces = toPieces(bits, key);
      ASSERT_EQ(pieces.size(), pieceCount(key.params));
      for (std::uint32_t p = 0; p < pieces.size(); ++p)  // most significant bit first
        ASSERT_EQ(pieces[p], p == target[i] / width ? 1u << (width - 1 - target[i] % width) : 0u);
    }
  }
}

TEST(ToPieces, PadsTheLastPieceWithZeros) {
  const Key key = keyOfSize(8, 8);  // 64 bits: ten pieces of six and one of four
  const std::vector<std::uint32_t> pieces = toPieces(std::vector<std::uint8_t>(64, 1), key);
  ASSERT_EQ(pieces.size(), 11u);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(pieces[i], 0b111111u);
  EXPECT_EQ(pieces[10], 0b111100u);
}

TEST(Pad, StaysInsideThePieceAndIsBalanced) {
  const Key key = keyOfSize(24, 24);
  const Pad pad(key);
  std::vector<int> ones(6, 0);
  int count = 0;
  for (std::uint32_t index = 0; index < 96; ++index)
    for (std::uint32_t p1 = 0; p1 < 5; ++p1)
      for (std::uint32_t p2 = p1 + 1; p2 < 5; ++p2) {
        const std::uint32_t value = pad(index, p1, p2);
        ASSERT_LT(value, 64u);
        for (int bit = 0; bit < 6; ++bit) ones[bit] += value >> bit & 1;
        ++count;
      }
  for (int n : ones) EXPECT_NEAR(n, count / 2, 78);  // 960 coins: five standard deviations
}

TEST(Pad, DependsOnIndexBothPrefixesAndSecret) {
  const Key key = keyOfSize(90, 90);
  const Pad pad(key), other(strangersKey(key, 1));
  int sameIndex = 0, samePrefix1 = 0, samePrefix2 = 0, sameSecret = 0, swapped = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const std::uint32_t value = pad(i, 1, 3);
    EXPECT_EQ(value, Pad(key)(i, 1, 3));
    sameIndex += value == pad(i + 2000, 1, 3);
    samePrefix1 += value == pad(i, 2, 3);
    samePrefix2 += value == pad(i, 1, 4);
    swapped += value == pad(i, 3, 1);
    sameSecret += value == other(i, 1, 3);
  }
  // Nine bits: a chance agreement in 1 of 512 cases, 3.9 of 2000.
  for (int same : {sameIndex, samePrefix1, samePrefix2, swapped, sameSecret}) EXPECT_LE(same, 16);
}

TEST(Pad, ChoosesAboutHalfOfTheLabelsWhenCellsAreKeyed) {
  Key key = testKey(24, 24, 4);
  EXPECT_TRUE(Pad(key).carries(1, 2));
  key.params.keyedCells = true;
  const Pad pad(key), other(strangersKey(key, 5));
  int carrying = 0, agreeing = 0, labels = 0;
  for (std::uint32_t p1 = 0; p1 < 60; ++p1)
    for (std::uint32_t p2 = 0; p2 < 60; ++p2, ++labels) {
      carrying += pad.carries(p1, p2);
      agreeing += pad.carries(p1, p2) == other.carries(p1, p2);
    }
  EXPECT_NEAR(carrying, labels / 2, 150);  // 3600 coins: five standard deviations
  EXPECT_NEAR(agreeing, labels / 2, 150);
}

}  // namespace
}  // namespace quadmark
