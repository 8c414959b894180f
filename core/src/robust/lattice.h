// SPDX-License-Identifier: MIT
// Keyed dither lattices (quantization index modulation, Chen and Wornell 2001) of layer A.
#pragma once

#include <cmath>
#include <cstdint>

#include "quadmark/prf.h"
#include "quadmark/random.h"
#include "quadmark/robust/coded.h"

namespace quadmark::robust {

/// Which of a payload's streams a slot carries.
enum class Stream : std::uint8_t { head, body };

/// What the key says about one coordinate (0 = alpha, 1 = beta) of a label.
struct RingSlot {
  std::uint32_t index = 0;     ///< picks the coded bit: index % bits of its stream
  bool pad = false;            ///< XORed to the coded bit
  bool headWhenSplit = false;  ///< its stream under Sharing::split
  double offset = 0;           ///< of the lattice, in steps, 0..1

  [[nodiscard]] Stream stream(Sharing sharing) const {
    return sharing == Sharing::headOnly || headWhenSplit ? Stream::head : Stream::body;
  }
};

/// Of 16 slots, this many carry the head when there is a body: the head is short, but nothing is read without it.
inline constexpr std::uint32_t kHeadSixteenths = 3;

/// Layer A's keyed functions.
class RingCode {
 public:
  explicit RingCode(const RobustKeys& keys) : dither_(keys.dither), share_(keys.share) {}

  [[nodiscard]] RingSlot slot(std::uint64_t label, int coordinate) const {
    const std::uint64_t item = label ^ (coordinate == 0 ? 0 : 0x9e3779b97f4a7c15u), word = dither_(item);
    RingSlot out;
    out.pad = (word & 1) != 0;
    out.index = static_cast<std::uint32_t>(word >> 32);
    out.headWhenSplit = share_(item) % 16 < kHeadSixteenths;
    out.offset = static_cast<double>(Random::mix(word) >> 11) * 0x1p-53;
    return out;
  }

 private:
  Prf dither_, share_;
};

/// The point of the lattice for a padded bit that is nearest to a coordinate. The lattice of 0 is
/// step * (Z + offset), that of 1 lies half a step further.
inline double nearestLatticePoint(double coordinate, double step, double offset, bool bit) {
  const double shift = offset + (bit ? 0.5 : 0.0);
  return step * (std::floor(coordinate / step - shift + 0.5) + shift);
}

/// Where a coordinate lies between the two lattices: 1 on that of 0, -1 on that of 1, linear between.
inline double latticeVote(double coordinate, double step, double offset) {
  double x = coordinate / step - offset;
  x -= std::floor(x + 0.5);
  return 1 - 4 * std::fabs(x);
}

/// Steps of the lattice, in ring radii: the embedder takes larger ones where rings are small, so that noise of one size
/// for the whole model does as little harm there as elsewhere; the reader tries all.
inline constexpr double kRingSteps[] = {0.5, 0.7, 0.9};

}  // namespace quadmark::robust
