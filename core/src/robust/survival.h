// SPDX-License-Identifier: MIT
// Which diamonds a simplifier will leave alone.
#pragma once

#include <vector>

#include "diamonds.h"
#include "surface.h"

namespace quadmark::robust {

/// Cells on vertices that simplifiers remove first are of little use. Gain, coded bit error rate of layer B at equal
/// distortion: fandisk optimised .27 -> .19, at .5 and 14 bits .29 -> .20; bunny at .5 .27 -> .17; cloth at .5 and 14
/// bits .30 -> .28. (Tried: one threshold at the error of gltf-transform's optimize; half the gain.)
class Survival {
 public:
  /// Cost: linear.
  Survival(const Surface& surface, const std::vector<double>& positions);

  /// Factor on the cost of a cell, 1 to 8: it doubles for each of the cheapest quarter, half and seven tenths of all
  /// vertices, by collapse cost, that the diamond's cheapest vertex belongs to.
  [[nodiscard]] float reluctance(const Diamond& diamond) const;

 private:
  static constexpr double kShares[] = {0.25, 0.5, 0.7};
  std::vector<float> cost_;  // per welded vertex
  float limits_[3] = {0, 0, 0};
};

}  // namespace quadmark::robust
