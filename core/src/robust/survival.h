// SPDX-License-Identifier: MIT
// Which diamonds a simplifier will leave alone.
#pragma once

#include <cstdint>
#include <vector>

#include "diamonds.h"
#include "surface.h"

namespace quadmark::robust {

/// The faces around a vertex as edge-collapse simplifiers (Garland and Heckbert 1997) see them.
class CollapseFan {
 public:
  /// @param area  a face's area vector, of any length common to all. At most kMaxRing of them.
  void add(const Vec3& area) {
    area_[count_] = length(area);
    total_ += area_[count_];
    normal_[count_++] = area;
  }
  /// Squared distance from the faces' planes, mean by area, of where the vertex would go.
  /// @param way  from the vertex to there. Only if hasArea().
  [[nodiscard]] double cost(const Vec3& way) const {
    double sum = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const double h = dot(normal_[k], way);
      if (area_[k] > 0) sum += h * h / area_[k];
    }
    return sum / total_;
  }
  [[nodiscard]] bool hasArea() const { return total_ > 0; }

 private:
  std::size_t count_ = 0;
  Vec3 normal_[kMaxRing];
  double area_[kMaxRing], total_ = 0;
};

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
