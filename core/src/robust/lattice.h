// SPDX-License-Identifier: MIT
// Keyed dither lattices (quantization index modulation, Chen and Wornell 2001) of layer A.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "quadmark/prf.h"
#include "quadmark/robust/coded.h"

namespace quadmark::robust {

/// Which of a payload's streams a slot carries.
enum class Stream : std::uint8_t { head, body };

/// What the key says about one coded bit of a coordinate.
struct RingSlot {
  std::uint32_t index = 0;     ///< picks the coded bit: index % bits of its stream
  bool pad = false;            ///< XORed to the coded bit
  bool headWhenSplit = false;  ///< its stream under Sharing::split

  [[nodiscard]] Stream stream(Sharing sharing) const {
    return sharing == Sharing::headOnly || headWhenSplit ? Stream::head : Stream::body;
  }
};

/// Names that many carriers share (symmetric subdivision surfaces repeat each up to 60 times) are few, but each is told by so
/// many votes that a coordinate can hold several coded bits: 2^bits points per lattice step instead of two.
inline constexpr std::uint32_t kMostRingBits = 5;
constexpr std::uint32_t mostRingBits(std::size_t copies) { return copies >= 48 ? 5 : copies >= 16 ? 3 : 1; }
/// A model whose names give so many places needs no more bits in any of them: one and a half for each bit of a head.
inline constexpr std::size_t kEnoughRingPlaces = 400;

/// One coordinate (0 = alpha, 1 = beta) of a label.
struct RingPlace {
  double offset = 0;            ///< of the lattice, in steps, 0..1
  RingSlot slot[kMostRingBits]; ///< as many as were asked for
};

/// Of 16 slots, this many carry the head when there is a body: the head is short, but nothing is read without it.
inline constexpr std::uint32_t kHeadSixteenths = 3;

/// Layer A's keyed functions.
class RingCode {
 public:
  explicit RingCode(const RobustKeys& keys) : dither_(keys.dither), share_(keys.share) {}

  [[nodiscard]] RingPlace place(std::uint64_t label, int coordinate, std::uint32_t bits) const;

 private:
  Prf dither_, share_;
};

/// The value that a payload gives to a place: bit t is the coded bit of slot t, padded.
[[nodiscard]] std::uint32_t valueAt(std::span<const RingSlot> slots, const CodedPayload& payload, Sharing sharing);

/// Which value the point (k + 1/2) / 2^bits of a step means, for two bits and more: Gray's code, whose bits are the signs of
/// the cosine, the sine, and the cosines of 2, 4, ... times the phase. (One bit: 0 at phase 0, 1 at 1/2.)
[[nodiscard]] std::uint32_t valueOfPoint(std::uint32_t k, std::uint32_t bits);

/// Phase of the point for a value, in steps, 0..1.
[[nodiscard]] double phaseOf(std::uint32_t value, std::uint32_t bits);

/// The lattice point of a phase that is nearest to a coordinate: one of step * (Z + offset + phase).
inline double nearestLatticePoint(double coordinate, double step, double offset, double phase) {
  const double shift = offset + phase;
  return step * (std::floor(coordinate / step - shift + 0.5) + shift);
}

/// 1 on a lattice, -1 half a step from it, linear between.
inline double latticeVote(double coordinate, double step, double offset) {
  double x = coordinate / step - offset;
  x -= std::floor(x + 0.5);
  return 1 - 4 * std::fabs(x);
}

/// How far a coordinate speaks for bit t of the value being 0 (above 0) or 1 (below).
[[nodiscard]] double bitVote(double coordinate, double step, double offset, std::uint32_t t);

/// Steps of the lattice, in ring radii: the embedder takes larger ones where rings are small, so that noise of one size
/// for the whole model does as little harm there as elsewhere; the reader tries all.
inline constexpr double kRingSteps[] = {0.5, 0.7, 0.9};

}  // namespace quadmark::robust
