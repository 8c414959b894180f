// SPDX-License-Identifier: MIT
#include "quadmark/exact_math.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "quadmark/random.h"

namespace quadmark {
namespace {

double relativeError(double value, double expected) { return std::fabs(value - expected) / std::fabs(expected); }

TEST(ExactLog, AgreesWithLibmOverTheWholeRange) {
  Random random(1);
  for (int exponent = -1022; exponent <= 1023; ++exponent) {
    const double x = std::ldexp(1 + random.uniform(), exponent);
    EXPECT_LT(relativeError(exactLog(x), std::log(x)), 1e-14) << x;
  }
  EXPECT_EQ(exactLog(1), 0);
  EXPECT_LT(relativeError(exactLog(DBL_MIN), std::log(DBL_MIN)), 1e-14);
  EXPECT_LT(relativeError(exactLog(DBL_MAX), std::log(DBL_MAX)), 1e-14);
}

TEST(ExactLog, IsAccurateNextToOne) {
  for (int exponent = -52; exponent <= -2; ++exponent) {
    const double step = std::ldexp(1.0, exponent);
    EXPECT_LT(relativeError(exactLog(1 + step), std::log1p(step)), 1e-14) << step;
    EXPECT_LT(relativeError(exactLog(1 - step), std::log1p(-step)), 1e-14) << step;
  }
}

TEST(ExactExp, AgreesWithLibmAndSaturates) {
  for (double x = -699.9; x < 700; x += 0.37) EXPECT_LT(relativeError(exactExp(x), std::exp(x)), 1e-13) << x;
  EXPECT_EQ(exactExp(0), 1);
  EXPECT_EQ(exactExp(-701), 0);
  EXPECT_EQ(exactExp(-1e300), 0);
  EXPECT_EQ(exactExp(1e300), exactExp(700));
  EXPECT_TRUE(std::isfinite(exactExp(1e300)));
}

TEST(ExactExp, UndoesTheLogarithm) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const double x = std::ldexp(1 + random.uniform(), static_cast<int>(random.below(200)) - 100);
    EXPECT_LT(relativeError(exactExp(exactLog(x)), x), 2e-12) << x;
  }
}

TEST(LogBinomialTail, GivesSmallCasesCountedByHand) {
  EXPECT_EQ(logBinomialTail(10, 0), 0);                                          // certain
  EXPECT_NEAR(exactExp(logBinomialTail(1, 1)), 0.5, 1e-15);                      // one coin
  EXPECT_NEAR(exactExp(logBinomialTail(10, 8)), 56.0 / 1024, 1e-15);             // 45 + 10 + 1
  EXPECT_NEAR(exactExp(logBinomialTail(10, 10)), 1.0 / 1024, 1e-16);
  EXPECT_NEAR(exactExp(logBinomialTail(4, 1)), 15.0 / 16, 1e-14);
  EXPECT_NEAR(exactExp(logBinomialTail(5, 3)), 0.5, 1e-14);                      // symmetric
  EXPECT_EQ(exactExp(logBinomialTail(10, 11)), 0);                               // impossible
}

// Matches needed for p <= 1e-6, 1e-9, 1e-12 by exact rational arithmetic: one match fewer is not enough.
TEST(LogBinomialTail, NeedsTheTabulatedMatches) {
  struct Row { std::uint64_t trials, matches[3]; };
  for (const Row& row : {Row{64, {51, 56, 59}}, Row{128, {92, 98, 103}}, Row{576, {346, 361, 373}},
                         Row{8100, {4265, 4321, 4367}}})
    for (int i = 0; i < 3; ++i) {
      const double limit = std::log(10.0) * -(6 + 3 * i);
      EXPECT_LE(logBinomialTail(row.trials, row.matches[i]), limit) << row.trials << " " << row.matches[i];
      EXPECT_GT(logBinomialTail(row.trials, row.matches[i] - 1), limit) << row.trials << " " << row.matches[i];
    }
  EXPECT_NEAR(exactExp(logBinomialTail(64, 51)), 9.404810782147007e-07, 1e-18);
  EXPECT_NEAR(exactExp(logBinomialTail(8100, 4367)), 9.831845427911331e-13, 1e-23);
}

TEST(LogBinomialTail, StaysFiniteAndFallingForHugeCounts) {
  double last = 1;
  for (std::uint64_t matches = 0; matches <= 1048576; matches += 65536) {
    const double value = logBinomialTail(1048576, matches);
    EXPECT_TRUE(std::isfinite(value));
    EXPECT_LE(value, 0);
    EXPECT_LE(value, last + 1e-8);  // near certainty the sum of 10^6 terms leaves that much rounding
    last = value;
  }
  EXPECT_NEAR(last, -1048576 * std::log(2.0), 1e-4);
}

}  // namespace
}  // namespace quadmark
