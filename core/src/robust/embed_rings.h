// SPDX-License-Identifier: MIT
// Writing layer A: carriers onto their lattices, sliding on the surface.
#pragma once

#include <cstdint>
#include <vector>

#include "carriers.h"
#include "distortion_budget.h"
#include "lattice.h"
#include "ring_votes.h"

namespace quadmark::robust {

struct RingLimits {
  double step = kRingSteps[0];  ///< of the lattice
  double maxCoordinate = 0.7;   ///< carriers off-centre by more ring radii are left alone
  double creaseCosine = 0;      ///< cosine of the largest dihedral angle in a carrier's fan
  double turnCosine = 0.5;      ///< cosine of the largest turn of a fan triangle
  double leastArea = 0.05;      ///< a fan triangle keeps at least this share of its area
  double maxMove = 1e300;       ///< of any vertex, file units
  double maxSlide = 1e300;      ///< of its part along the surface, file units
};

/// The least of kRingSteps that makes the lattice coarse enough for the model's typical ring.
[[nodiscard]] double chooseRingStep(const Carriers& carriers, const std::vector<double>& positions,
                                    const SymmetricTensor& tensor, double diagonal);

/// Moves carriers of `positions` in place; the lattice coordinates change, the third one follows the old surface.
/// @param change   knows the normals that limits.maxSlide refers to.
/// @param dropped  one flag per carrier: 1 = leave it alone.
/// @return the carriers written, ascending.
[[nodiscard]] std::vector<std::uint32_t> embedRings(const Carriers& carriers, const RingCode& code,
                                                    const CodedPayload& payload, const SymmetricTensor& tensor,
                                                    const RingLimits& limits, const ChangeMeter& change,
                                                    const std::vector<std::uint8_t>& dropped,
                                                    std::vector<double>& positions);

}  // namespace quadmark::robust
