// SPDX-License-Identifier: MIT
#include "quadmark/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "quadmark/extract.h"

namespace quadmark {
namespace {

// All outcomes of `bits` x `copies` fair coins, so that the null distribution is known without sampling.
std::vector<double> allProbabilities(std::uint32_t bits, std::uint32_t copies, const std::vector<double>& bets) {
  std::vector<double> out;
  for (std::uint32_t outcome = 0; outcome < 1u << (bits * copies); ++outcome) {
    AgreementTest test(bits);
    for (std::uint32_t i = 0; i < bits * copies; ++i)
      test.add(i / copies, (outcome >> i & 1) != 0 ? 1 : -1, bets[i % bets.size()]);
    out.push_back(test.probability());
  }
  std::sort(out.begin(), out.end());
  return out;
}

// P(probability <= p) <= p for every p: the promise of the header, checked exactly.
void expectValid(const std::vector<double>& sorted) {
  for (std::size_t i = 0; i < sorted.size(); ++i)
    ASSERT_LE(static_cast<double>(i + 1) / static_cast<double>(sorted.size()), sorted[i] * (1 + 1e-9));
}

TEST(AgreementTest, NeverClaimsMoreThanItsNullDistributionAllows) {
  expectValid(allProbabilities(1, 12, {0.9}));
  expectValid(allProbabilities(6, 2, {0.998}));
  expectValid(allProbabilities(3, 4, {0.3, 0.99, 0.6}));
  expectValid(allProbabilities(4, 3, {0.05, 0.998}));
}

TEST(AgreementTest, FindsAgreementConvincing) {
  AgreementTest agreeing(100);
  for (std::uint32_t bit = 0; bit < 100; ++bit)
    for (int copy = 0; copy < 3; ++copy) agreeing.add(bit, bit % 2 == 0 ? 1 : -1, 0.95);
  EXPECT_LT(agreeing.probability(), 1e-30);
  EXPECT_DOUBLE_EQ(agreeing.probability(), agreeing.bestProbability());
}

TEST(AgreementTest, FindsDisagreementUnconvincing) {
  AgreementTest disagreeing(100);
  for (std::uint32_t bit = 0; bit < 100; ++bit)
    for (int copy = 0; copy < 4; ++copy) disagreeing.add(bit, copy % 2 == 0 ? 1 : -1, 0.95);
  EXPECT_EQ(disagreeing.probability(), 1);
  EXPECT_LT(disagreeing.bestProbability(), 1e-30);  // it could have shown agreement, and did not
}

TEST(AgreementTest, LearnsNothingFromSingleCopiesNoVotesAndZeroBets) {
  AgreementTest single(50), none(50), pointless(50);
  for (std::uint32_t bit = 0; bit < 50; ++bit) {
    single.add(bit, 1, 0.99);
    for (int copy = 0; copy < 3; ++copy) none.add(bit, 0, 0.99), pointless.add(bit, 1, 0);
  }
  for (const AgreementTest* test : {&single, &none, &pointless}) {
    EXPECT_NEAR(test->probability(), 1, 1e-12);
    EXPECT_NEAR(test->bestProbability(), 1, 1e-12);
  }
  EXPECT_EQ(AgreementTest(50).probability(), 1);
}

// Two copies of one bit that agree: E = 1 + q^2 exactly, whatever the scale of q; with many such bits E multiplies.
TEST(AgreementTest, HasTheEvidenceOfTwoCopiesThatTheFormulaSays) {
  AgreementTest one(1);
  one.add(0, 1, 1);
  one.add(0, 1, 1);
  double mean = 0;
  for (double s : {0.3, 0.6, 0.9, 0.99}) mean += (1 + s * s) / 4;
  EXPECT_NEAR(one.probability(), 1 / mean, 1e-12);

  AgreementTest many(20);
  for (std::uint32_t bit = 0; bit < 20; ++bit) many.add(bit, -1, 1), many.add(bit, -1, 1);
  double product = 0;
  for (double s : {0.3, 0.6, 0.9, 0.99}) product += std::pow(1 + s * s, 20) / 4;
  EXPECT_NEAR(many.probability() * product, 1, 1e-10);
}

TEST(AgreementTest, DoesNotSeeTheOrderOrTheSignOfAWholeBit) {
  AgreementTest a(3), b(3), flipped(3);
  const int votes[] = {1, 1, -1, 1, 1, -1, 1, 1, 1};
  for (std::uint32_t i = 0; i < 9; ++i) {
    a.add(i % 3, votes[i], 0.8);
    b.add((8 - i) % 3, votes[8 - i], 0.8);
    flipped.add(i % 3, i % 3 == 1 ? -votes[i] : votes[i], 0.8);
  }
  EXPECT_NEAR(a.probability(), b.probability(), 1e-14);
  EXPECT_NEAR(a.probability(), flipped.probability(), 1e-14);
}

TEST(AgreementTest, StaysAboveZero) {
  AgreementTest test(5000);
  for (std::uint32_t bit = 0; bit < 5000; ++bit)
    for (int copy = 0; copy < 20; ++copy) test.add(bit, 1, 1);
  EXPECT_GE(test.probability(), 1e-300);
  EXPECT_LE(test.probability(), 1e-299);
}

TEST(ReferenceProbability, IsTheBinomialTail) {
  EXPECT_NEAR(referenceProbability(10, 8), 56.0 / 1024, 1e-15);
  EXPECT_NEAR(referenceProbability(576, 346), 7.656233949010855e-07, 1e-18);
  EXPECT_EQ(referenceProbability(100, 0), 1);
  EXPECT_EQ(referenceProbability(0, 0), 1);
  EXPECT_GE(referenceProbability(8100, 8100), 1e-300);
  EXPECT_LE(referenceProbability(8100, 8100), 1e-299);
}

TEST(VerdictName, IsStable) {
  EXPECT_STREQ(verdictName(Verdict::match), "match");
  EXPECT_STREQ(verdictName(Verdict::none), "none");
  EXPECT_STREQ(verdictName(Verdict::inconclusive), "inconclusive");
}

}  // namespace
}  // namespace quadmark
