// SPDX-License-Identifier: MIT
#include "noise_field.h"

#include <cmath>

#include "quadmark/random.h"

namespace quadmark::lab {
namespace {

double fade(double t) {
  return t * t * t * (t * (6 * t - 15) + 10);
}
double between(double a, double b, double t) {
  return a + t * (b - a);
}

/// Three gradient components out of one hash: 21 bits each, in [-1, 1).
double slope(std::uint64_t hash, double x, double y, double z) {
  const auto component = [&](int shift) { return static_cast<double>((hash >> shift) & 0x1fffff) * 0x1p-20 - 1; };
  return component(0) * x + component(21) * y + component(42) * z;
}

}  // namespace

double NoiseField::at(const Vec3& p) const {
  const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const double x = p.x - fx, y = p.y - fy, z = p.z - fz;
  const auto ix = static_cast<std::uint64_t>(static_cast<std::int64_t>(fx));
  const auto iy = static_cast<std::uint64_t>(static_cast<std::int64_t>(fy));
  const auto iz = static_cast<std::uint64_t>(static_cast<std::int64_t>(fz));
  double corner[8];
  for (std::uint64_t i = 0; i < 8; ++i) {
    const std::uint64_t dx = i & 1, dy = (i >> 1) & 1, dz = i >> 2;
    const std::uint64_t cell =
        (ix + dx) * 0x9e3779b97f4a7c15u + (iy + dy) * 0xc2b2ae3d27d4eb4fu + (iz + dz) * 0x165667b19e3779f9u;
    corner[i] = slope(Random::mix(cell ^ seed_), x - static_cast<double>(dx), y - static_cast<double>(dy),
                      z - static_cast<double>(dz));
  }
  const double u = fade(x), v = fade(y), w = fade(z);
  return between(between(between(corner[0], corner[1], u), between(corner[2], corner[3], u), v),
                 between(between(corner[4], corner[5], u), between(corner[6], corner[7], u), v), w);
}

double NoiseField::sum(Vec3 p, int octaves) const {
  double total = 0, amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    total += amplitude * at(p);
    p = 2 * p + Vec3{17.13, 5.71, 11.37};  // octaves must not share lattice points
    amplitude *= 0.5;
  }
  return total;
}

Vec3 NoiseField::vectorAt(const Vec3& p) const {
  return {at(p), at(p + Vec3{31.7, 12.9, 73.1}), at(p + Vec3{-57.3, 41.1, 19.9})};
}

std::vector<double> roughened(const std::vector<double>& positions, double amplitude, double featureSize,
                              std::uint64_t seed) {
  const NoiseField field(seed);
  std::vector<double> out = positions;
  for (std::size_t v = 0; v < positions.size() / 3; ++v) {
    const Vec3 p = at(positions, v);
    put(out, v, p + amplitude * field.vectorAt((1 / featureSize) * p + Vec3{0.371, 0.219, 0.537}));
  }
  return out;
}

}  // namespace quadmark::lab
