// SPDX-License-Identifier: MIT
#include "quadmark/robust/code.h"

#include <bit>

namespace quadmark::robust {
namespace {

std::uint8_t outputOf(std::uint32_t reg, std::uint32_t generator) {
  return static_cast<std::uint8_t>(std::popcount(reg & generator) & 1);
}

// The recursive register whose generator-0 output is `information`: its input at each step is whatever makes that
// output right. Returns the register's last `memory` inputs after all steps.
std::uint32_t runFeedback(const ConvolutionalCode& code, std::span<const std::uint8_t> information, std::uint32_t state,
                          std::vector<std::uint8_t>* input) {
  for (std::size_t i = 0; i < information.size(); ++i) {
    const std::uint8_t bit = information[i] ^ outputOf(state, code.generators[0]);
    if (input != nullptr) (*input)[i] = bit;
    state = (state | std::uint32_t{bit} << code.memory) >> 1;
  }
  return state;
}

}  // namespace

const ConvolutionalCode& halfRateCode() {
  static const ConvolutionalCode code{8, {0561, 0753}};
  return code;
}

const ConvolutionalCode& thirdRateCode() {
  static const ConvolutionalCode code{8, {0557, 0663, 0711}};
  return code;
}

std::vector<std::uint8_t> encodeTailBiting(const ConvolutionalCode& code, std::span<const std::uint8_t> input) {
  const std::size_t n = input.size(), rate = code.rate();
  std::vector<std::uint8_t> out(n * rate);
  std::uint32_t reg = 0;  // before step 0: the last inputs, the newest at the highest bit below the current one
  for (std::size_t i = n - code.memory; i < n; ++i) reg = (reg | std::uint32_t{input[i]} << code.memory) >> 1;
  for (std::size_t i = 0; i < n; ++i) {
    reg |= std::uint32_t{input[i]} << code.memory;
    for (std::size_t g = 0; g < rate; ++g) out[i * rate + g] = outputOf(reg, code.generators[g]);
    reg >>= 1;
  }
  return out;
}

std::vector<std::uint8_t> systematicInput(const ConvolutionalCode& code, std::span<const std::uint8_t> information) {
  // The state after n steps is affine in the state before: end(s) = end(0) + T s. Tail-biting wants end(s) = s.
  const std::vector<std::uint8_t> zeros(information.size(), 0);
  std::vector<std::uint32_t> column(code.memory);
  for (std::uint32_t i = 0; i < code.memory; ++i) column[i] = runFeedback(code, zeros, 1u << i, nullptr);
  const std::uint32_t offset = runFeedback(code, information, 0, nullptr);
  std::uint32_t found = 0, solutions = 0;
  for (std::uint32_t state = 0; state < 1u << code.memory; ++state) {
    std::uint32_t end = offset;
    for (std::uint32_t i = 0; i < code.memory; ++i)
      if ((state >> i & 1) != 0) end ^= column[i];
    if (end != state) continue;
    found = state;
    ++solutions;
  }
  if (solutions != 1) return {};
  std::vector<std::uint8_t> input(information.size());
  runFeedback(code, information, found, &input);
  return input;
}

std::uint32_t systematicLength(const ConvolutionalCode& code, std::uint32_t n) {
  n = n <= code.memory ? code.memory + 1 : n;
  while (systematicInput(code, std::vector<std::uint8_t>(n, 0)).empty()) ++n;
  return n;
}

}  // namespace quadmark::robust
