// SPDX-License-Identifier: MIT
// A posteriori ratios by the forward-backward algorithm, in probabilities rather than logarithms: a step then takes
// additions and multiplications alone.
#include <algorithm>
#include <cstddef>

#include "quadmark/exact_math.h"
#include "quadmark/robust/code.h"
#include "trellis.h"

namespace quadmark::robust {
namespace {

constexpr float kLargestRatio = 20;
// No state is ever ruled out: rounding would otherwise decide, and products would leave the range of a float.
constexpr float kLeastProbability = 1e-18f;
// The register forgets where it started after five to ten times its length.
constexpr std::uint32_t kWarmUp = 96;

// Per butterfly the likelihood of the outputs of (2j, input 0), and of their complements, up to a common factor.
class Likelihoods {
 public:
  Likelihoods(const Trellis& trellis, std::span<const float> ratios)
      : same(trellis.half), complement(trellis.half), trellis_(trellis), ratios_(ratios) {}

  void load(std::size_t step) {
    std::fill(same.begin(), same.end(), 1.0f);
    std::fill(complement.begin(), complement.end(), 1.0f);
    for (std::uint32_t g = 0; g < trellis_.rate; ++g) {
      const double ratio = std::clamp(ratios_[step * trellis_.rate + g], -kLargestRatio, kLargestRatio);
      const double odds = exactExp(ratio);
      const auto zero = static_cast<float>(odds / (1 + odds)), one = static_cast<float>(1 / (1 + odds));
      const float* sign = trellis_.sign.data() + std::size_t{g} * trellis_.half;
      for (std::uint32_t j = 0; j < trellis_.half; ++j) {
        same[j] *= sign[j] > 0 ? zero : one;
        complement[j] *= sign[j] > 0 ? one : zero;
      }
    }
  }

  std::vector<float> same, complement;

 private:
  const Trellis& trellis_;
  std::span<const float> ratios_;
};

void normalise(std::vector<float>& probability) {
  float largest = 0;
  for (float p : probability) largest = p > largest ? p : largest;
  for (float& p : probability) {
    p /= largest;
    p = p > kLeastProbability ? p : kLeastProbability;
  }
}

void forward(const Likelihoods& l, std::uint32_t half, const std::vector<float>& before, std::vector<float>& after) {
  for (std::uint32_t j = 0; j < half; ++j) {
    after[j] = before[2 * j] * l.same[j] + before[2 * j + 1] * l.complement[j];
    after[j + half] = before[2 * j] * l.complement[j] + before[2 * j + 1] * l.same[j];
  }
  normalise(after);
}

void backward(const Likelihoods& l, std::uint32_t half, const std::vector<float>& after, std::vector<float>& before) {
  for (std::uint32_t j = 0; j < half; ++j) {
    before[2 * j] = after[j] * l.same[j] + after[j + half] * l.complement[j];
    before[2 * j + 1] = after[j] * l.complement[j] + after[j + half] * l.same[j];
  }
  normalise(before);
}

// log P(output is 0) / P(it is 1) of every generator at one step, from the states before and after it.
void ratiosOf(const Likelihoods& l, const Trellis& t, const float* before, const std::vector<float>& after,
              float* out) {
  for (std::uint32_t g = 0; g < t.rate; ++g) {
    const float* sign = t.sign.data() + std::size_t{g} * t.half;
    double zero = 0, one = 0;
    for (std::uint32_t j = 0; j < t.half; ++j) {
      const double same = double{l.same[j]} * (before[2 * j] * after[j] + before[2 * j + 1] * after[j + t.half]);
      const double complement =
          double{l.complement[j]} * (before[2 * j] * after[j + t.half] + before[2 * j + 1] * after[j]);
      zero += sign[j] > 0 ? same : complement;
      one += sign[j] > 0 ? complement : same;
    }
    constexpr double kTiny = 1e-60;
    out[g] = static_cast<float>(std::clamp(exactLog(zero + kTiny) - exactLog(one + kTiny), -60.0, 60.0));
  }
}

}  // namespace

std::vector<float> posteriorRatios(const ConvolutionalCode& code, std::span<const float> ratios) {
  const Trellis trellis(code);
  const std::size_t steps = ratios.size() / trellis.rate, states = trellis.states();
  const std::size_t warmUp = std::min<std::size_t>(kWarmUp, 3 * steps);
  Likelihoods likelihoods(trellis, ratios);

  std::vector<float> from(states, 1.0f), to(states);
  for (std::size_t i = 0; i < warmUp; ++i) {
    likelihoods.load((3 * steps - warmUp + i) % steps);
    forward(likelihoods, trellis.half, from, to);
    from.swap(to);
  }
  std::vector<float> stored(steps * states);
  for (std::size_t step = 0; step < steps; ++step) {
    std::copy(from.begin(), from.end(), stored.begin() + static_cast<std::ptrdiff_t>(step * states));
    likelihoods.load(step);
    forward(likelihoods, trellis.half, from, to);
    from.swap(to);
  }

  std::fill(from.begin(), from.end(), 1.0f);
  for (std::size_t i = warmUp; i-- > 0;) {
    likelihoods.load(i % steps);
    backward(likelihoods, trellis.half, from, to);
    from.swap(to);
  }
  std::vector<float> posterior(steps * trellis.rate);
  for (std::size_t step = steps; step-- > 0;) {
    likelihoods.load(step);
    ratiosOf(likelihoods, trellis, stored.data() + step * states, from, posterior.data() + step * trellis.rate);
    backward(likelihoods, trellis.half, from, to);
    from.swap(to);
  }
  return posterior;
}

}  // namespace quadmark::robust
