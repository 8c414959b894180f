// SPDX-License-Identifier: MIT
// The trellis of a convolutional code as butterflies: states 2j and 2j + 1 lead to j and j + half.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "quadmark/robust/code.h"

namespace quadmark::robust {

/// State = the last `memory` inputs, the newest at the highest bit. A step with input b leads from s to
/// (b << memory | s) >> 1. Because every generator has its first and last tap, all outputs of a butterfly follow from
/// those of (2j, input 0): the branches 2j -> j and 2j + 1 -> j + half have these, the other two their complements.
struct Trellis {
  explicit Trellis(const ConvolutionalCode& code) : rate(code.rate()), half(1u << (code.memory - 1)), sign(rate * half) {
    for (std::uint32_t g = 0; g < rate; ++g)
      for (std::uint32_t j = 0; j < half; ++j) {
        std::uint32_t reg = 2 * j & code.generators[g], ones = 0;
        for (; reg != 0; reg &= reg - 1) ++ones;
        sign[g * half + j] = ones % 2 == 0 ? 1.0f : -1.0f;
      }
  }

  [[nodiscard]] std::uint32_t states() const { return 2 * half; }

  /// branch[j] = half the metric difference between the outputs of (2j, input 0) and their complements.
  void branches(std::span<const float> ratios, std::size_t step, std::vector<float>& branch) const {
    for (std::uint32_t j = 0; j < half; ++j) branch[j] = 0;
    for (std::uint32_t g = 0; g < rate; ++g) {
      const float value = ratios[step * rate + g] * 0.5f;
      const float* s = sign.data() + std::size_t{g} * half;
      for (std::uint32_t j = 0; j < half; ++j) branch[j] += value * s[j];
    }
  }

  std::uint32_t rate, half;
  std::vector<float> sign;  ///< [generator][butterfly]: +1 where the output is 0
};

}  // namespace quadmark::robust
