// SPDX-License-Identifier: MIT
// Symbols of several coded bits: ratios of their bits, and what the code adds.
#include "quadmark/robust/demapper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "quadmark/random.h"
#include "robust_simulation.h"

namespace quadmark::robust {
namespace {

TEST(Demapper, GivesSingleBitsBackAsTheyAre) {
  const SoftBits bits{{1.5f, -2.0f, 0.0f}};
  EXPECT_EQ(Demapper(bits).ratios(), bits.single);
  EXPECT_EQ(Demapper(bits, 0.5f).ratios(), (std::vector<float>{0.75f, -1.0f, 0.0f}));
  Demapper demapper(bits);
  demapper.iterate(halfRateCode(), 3);
  EXPECT_EQ(demapper.ratios(), bits.single) << "there is nothing to read again";
}

TEST(Demapper, SumsTheLikelihoodsOfASymbolsValues) {
  // Two bits: value 0 (both 0) is likeliest, then 3 (both 1).
  const SoftBits bits{{0.25f, 0.0f, 1.0f}, 2, {2, 0}, {2.0f, 0.0f, 0.0f, 1.0f}};
  const double e1 = std::exp(1.0), e2 = std::exp(2.0);
  const std::vector<float> ratios = Demapper(bits).ratios();
  EXPECT_NEAR(ratios[2], 1.0 + std::log((e2 + 1) / (1 + e1)), 1e-5) << "bit 0 of the symbol";
  EXPECT_NEAR(ratios[0], 0.25 + std::log((e2 + 1) / (1 + e1)), 1e-5) << "bit 1";
  EXPECT_EQ(ratios[1], 0.0f) << "no symbol carries it";
  // Known from elsewhere to be 1, bit 0 leaves values 1 and 3: now 3 is the likelier one.
  Demapper demapper(bits);
  demapper.update(std::vector<float>{0, 0, -40});
  EXPECT_NEAR(demapper.ratios()[0], 0.25 + std::log(1 / e1), 1e-3);
  EXPECT_NEAR(demapper.ratios()[2], 1.0 + std::log((e2 * std::exp(0.25) + 1) / (std::exp(0.25) + e1)), 1e-4)
      << "a symbol is not told what it said itself";
}

// Symbols of three bits of which a quarter is lost and the rest has a rival that is nearly as likely.
TEST(Demapper, IterationReadsWhatOnePassCannot) {
  Random random(2);
  int onePass = 0, iterated = 0;
  constexpr int kTrials = 20;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto information = randomBits(systematicLength(thirdRateCode(), 240), random);
    const auto codeword = encodeTailBiting(thirdRateCode(), systematicInput(thirdRateCode(), information));
    SoftBits bits{std::vector<float>(codeword.size(), 0.0f), 3};
    std::vector<std::uint32_t> order(codeword.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    for (std::size_t first = 0; first < order.size(); first += 3) {
      std::uint32_t value = 0;
      for (std::uint32_t t = 0; t < 3; ++t) {
        bits.bitOf.push_back(order[first + t]);
        value |= std::uint32_t{codeword[order[first + t]]} << t;
      }
      std::vector<float> scores(8, 0.0f);
      if (random.uniform() < 0.75) scores[value] = 4;
      scores[random.below(8)] += 3.5f;
      bits.score.insert(bits.score.end(), scores.begin(), scores.end());
    }
    const auto wrong = [&](const Demapper& demapper) {
      const std::vector<float> posterior = posteriorRatios(thirdRateCode(), demapper.ratios());
      int count = 0;
      for (std::size_t i = 0; i < information.size(); ++i) count += (posterior[3 * i] < 0) != (information[i] != 0);
      return count;
    };
    Demapper demapper(bits);
    onePass += wrong(demapper);
    demapper.iterate(thirdRateCode(), kDemapperRounds);
    iterated += wrong(demapper);
  }
  EXPECT_GT(onePass, 100) << "of " << kTrials * 240 << " bits and a few";
  EXPECT_LT(iterated, onePass / 4);
}

}  // namespace
}  // namespace quadmark::robust
