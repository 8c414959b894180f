// SPDX-License-Identifier: MIT
// Counting false positives, as bench/evaluate --experiment chance does.
#include <gtest/gtest.h>

#include <cmath>

#include "../bench/evaluation/chance.h"
#include "quadmark/lab/generate.h"

namespace quadmark {
namespace {

using bench::ChanceBins;
using bench::countChance;

std::uint64_t trialsOf(const ChanceBins& bins, double atMost = 1) {
  std::uint64_t sum = 0;
  for (const auto& [tenths, bin] : bins) sum += std::pow(10, -tenths / 10.0) <= atMost + 1e-12 ? bin.trials : 0;
  return sum;
}

TEST(Chance, CountsEveryTrialOnce) {
  const Mesh mesh = lab::sculpture(2000);
  const auto all = countChance({"cho-mean", "", "", 0, 60}, mesh);
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_EQ(trialsOf(*all), 60u);
}

// A run that was stopped goes on with the trials that come next.
TEST(Chance, GivesTheSameInPiecesAsAtOnce) {
  const Mesh mesh = lab::sculpture(2000);
  for (const char* mark : {"", "cho-mean", "paper"}) {
    const auto all = countChance({"cho-mean", "", mark, 0, 30}, mesh);
    ASSERT_TRUE(all) << all.error().message;
    ChanceBins sum;
    for (const std::uint64_t first : {0u, 10u, 20u}) {
      const auto part = countChance({"cho-mean", "", mark, first, 10}, mesh);
      ASSERT_TRUE(part);
      for (const auto& [tenths, bin] : *part) {
        sum[tenths].trials += bin.trials;
        sum[tenths].matches += bin.matches;
      }
    }
    ASSERT_EQ(sum.size(), all->size());
    for (const auto& [tenths, bin] : *all) {
      EXPECT_EQ(sum[tenths].trials, bin.trials) << mark << tenths;
      EXPECT_EQ(sum[tenths].matches, bin.matches) << mark << tenths;
    }
  }
}

// Binomial tails of bits whitened by the reader's key: of 1000 trials, 100 expected, 138 is four standard deviations
// more.
TEST(Chance, MeetsTenthsNoMoreOftenThanOnceInTen) {
  for (const char* mark : {"", "cho-mean"}) {
    const auto bins = countChance({"cho-mean", "", mark, 0, 1000}, lab::sculpture(2000));
    ASSERT_TRUE(bins);
    EXPECT_LT(trialsOf(*bins, 0.1), 138u) << mark;
    for (const auto& [tenths, bin] : *bins) EXPECT_EQ(bin.matches, 0u) << mark << tenths;
  }
}

TEST(Chance, SaysWhyAModelTakesNoMark) {
  const auto bins = countChance({"robust", "", "robust", 0, 1}, lab::cube());
  ASSERT_FALSE(bins);
  EXPECT_EQ(bins.error().code, ErrorCode::capacity);
  EXPECT_EQ(countChance({"nobody", "", "", 0, 1}, lab::cube()).error().code, ErrorCode::badOption);
}

}  // namespace
}  // namespace quadmark
