// SPDX-License-Identifier: MIT
#include "quadmark/robust/demapper.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "quadmark/exact_math.h"

namespace quadmark::robust {
namespace {

constexpr std::uint32_t kMostSymbolBits = 4;
// Priors are bounded so that products stay within a double and no value of a symbol is ever ruled out.
constexpr double kLargestPrior = 30;
// What the decoder limits its inputs to: its answer must not be credited with less than it was given.
constexpr float kLargestInput = 20;

}  // namespace

Demapper::Demapper(const SoftBits& bits, float scale) : bits_(bits), single_(bits.single) {
  for (float& ratio : single_) ratio *= scale;
  weight_.reserve(bits.score.size());
  for (const float score : bits.score) weight_.push_back(score == 0 ? 1 : exactExp(double{scale} * score));
  message_.assign(bits.bitOf.size(), 0.0f);
  ratios_ = single_;
  update({});
}

void Demapper::update(std::span<const float> outside) {
  const std::uint32_t bits = bits_.symbolBits;
  if (bits == 0) return;
  const std::uint32_t values = 1u << bits;
  std::vector<float> next = single_;
  for (std::size_t first = 0, value = 0; first < message_.size(); first += bits, value += values) {
    // Odds of 0 of each bit, without what this symbol itself has said.
    std::array<double, kMostSymbolBits> odds{};
    for (std::uint32_t t = 0; t < bits; ++t) {
      const std::uint32_t bit = bits_.bitOf[first + t];
      const double others = double{ratios_[bit]} - message_[first + t] + (outside.empty() ? 0 : outside[bit]);
      odds[t] = outside.empty() ? 1 : exactExp(std::clamp(others, -kLargestPrior, kLargestPrior));
    }
    std::array<std::array<double, 2>, kMostSymbolBits> of{};
    for (std::uint32_t k = 0; k < values; ++k) {
      double p = weight_[value + k];
      for (std::uint32_t t = 0; t < bits; ++t)
        if ((k >> t & 1) == 0) p *= odds[t];
      for (std::uint32_t t = 0; t < bits; ++t) of[t][k >> t & 1] += p;
    }
    for (std::uint32_t t = 0; t < bits; ++t) {
      const auto said = static_cast<float>(exactLog(of[t][0] / (of[t][1] * odds[t])));
      message_[first + t] = said;
      next[bits_.bitOf[first + t]] += said;
    }
  }
  ratios_ = std::move(next);
}

void Demapper::iterate(const ConvolutionalCode& code, int rounds) {
  if (bits_.symbolBits == 0) return;
  for (int round = 0; round < rounds; ++round) {
    std::vector<float> outside = posteriorRatios(code, ratios_);
    for (std::size_t i = 0; i < outside.size(); ++i)
      outside[i] -= std::clamp(ratios_[i], -kLargestInput, kLargestInput);
    update(outside);
  }
}

}  // namespace quadmark::robust
