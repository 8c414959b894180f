// SPDX-License-Identifier: MIT
// Gradient noise (K. Perlin, "Improving noise", 2002) over an integer hash, for reliefs of generated models.
#pragma once

#include <cstdint>

#include "quadmark/vec3.h"

namespace quadmark::lab {

class NoiseField {
 public:
  explicit NoiseField(std::uint64_t seed) : seed_(seed) {}

  /// Smooth, roughly within -1..1, zero on average; features are about one unit wide. @param p  below 2^30.
  [[nodiscard]] double at(const Vec3& p) const;

  /// Sum of `octaves` fields of doubling frequency and halving amplitude.
  [[nodiscard]] double sum(Vec3 p, int octaves) const;

  /// A vector of three independent values of at(), for displacing the argument of another field.
  [[nodiscard]] Vec3 vectorAt(const Vec3& p) const;

 private:
  std::uint64_t seed_;
};

/// Every vertex of a mesh displaced by noise of the given amplitude and feature size along each axis.
[[nodiscard]] std::vector<double> roughened(const std::vector<double>& positions, double amplitude, double featureSize,
                                            std::uint64_t seed);

}  // namespace quadmark::lab
