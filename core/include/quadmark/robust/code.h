// SPDX-License-Identifier: MIT
// Tail-biting convolutional codes with soft decoding: a list decoder for short frames that a MAC confirms, and a
// posteriori probabilities of the bits of long bodies.
//
// A codeword of n information bits is n cyclic steps of a shift register: no bits are spent on a tail, and every bit is
// protected alike. The register's input is not the information itself in systematic codes: these are the same code
// with the input chosen so that the first generator's output is the information, which keeps the distance of the best
// non-systematic code (systematic ones without feedback lose a third of it).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace quadmark::robust {

/// Feed-forward shift register. Each generator has `memory` + 1 taps, the newest input at the highest bit; first and
/// last tap are set (the decoder's butterflies need that).
struct ConvolutionalCode {
  std::uint32_t memory = 8;
  std::vector<std::uint32_t> generators;

  [[nodiscard]] std::uint32_t rate() const { return static_cast<std::uint32_t>(generators.size()); }
};

/// Largest distance for their length and constraint length 9 (Lin and Costello, table 12.1): rate 1/2 has free distance
/// 12, rate 1/3 has 18. The first generator of each has an odd number of taps, which systematicInput() needs.
[[nodiscard]] const ConvolutionalCode& halfRateCode();
[[nodiscard]] const ConvolutionalCode& thirdRateCode();

/// The codeword of n inputs: bit i * rate + g is generator g's output at step i.
/// @param input  bits (0, 1), at least `memory` + 1 of them.
[[nodiscard]] std::vector<std::uint8_t> encodeTailBiting(const ConvolutionalCode& code,
                                                         std::span<const std::uint8_t> input);

/// The input whose codeword has `information` as its generator 0's output. Empty if there is none or more than one,
/// which for a given code depends on the length alone: see systematicLength().
[[nodiscard]] std::vector<std::uint8_t> systematicInput(const ConvolutionalCode& code,
                                                        std::span<const std::uint8_t> information);

/// The smallest length from n up for which systematicInput() exists.
[[nodiscard]] std::uint32_t systematicLength(const ConvolutionalCode& code, std::uint32_t n);

/// Hands the likeliest inputs to `accept`, best first, until it returns true or `listSize` of them were tried.
///
/// Two laps around the trellis find how likely each state is at the seam, a third one is searched for its best paths:
/// those that leave the best path once, those that leave these, and so on ("serial list Viterbi", Seshadri and Sundberg
/// 1994). Paths that do not close are passed over.
/// @param ratios  rate * n log-likelihood ratios, positive where 0 is likelier, 0 = unknown; finite.
/// @return how many candidates were handed out, the accepted one included, and whether one was accepted.
/// Deterministic: additions and comparisons of floats in a fixed order. Cost: 92 bits at rate 1/3 take 0.1 ms.
struct ListResult {
  std::uint32_t tried = 0;
  bool accepted = false;
};
[[nodiscard]] ListResult decodeList(const ConvolutionalCode& code, std::span<const float> ratios,
                                    std::uint32_t listSize,
                                    const std::function<bool(std::span<const std::uint8_t> input)>& accept);

/// A posteriori log-likelihood ratios of all coded bits (Bahl, Cocke, Jelinek and Raviv 1974): as many as came in, within
/// +-60. Unlike the likeliest codeword they never know less than what came in.
/// @param ratios  as for decodeList(); magnitudes above 20 count as 20.
/// Deterministic. Cost: 2 microseconds and 1 kB per step.
[[nodiscard]] std::vector<float> posteriorRatios(const ConvolutionalCode& code, std::span<const float> ratios);

}  // namespace quadmark::robust
