// SPDX-License-Identifier: MIT
#include "creases.h"

#include <algorithm>

#include "parallel.h"

namespace quadmark::robust {

std::vector<float> edgeBends(const std::vector<Diamond>& diamonds, const std::vector<double>& positions) {
  std::vector<float> bends(diamonds.size());
  forEachInParts(diamonds.size(), [&](std::size_t i) {
    const Diamond& q = diamonds[i];
    const Vec3 a = at(positions, q.a), b = at(positions, q.b), c = at(positions, q.c), d = at(positions, q.d);
    const Vec3 left = normalized(cross(b - a, d - a)), right = normalized(cross(d - c, b - c));
    // Triangles without an area, whose normal is zero, bend nothing; nor do those too large for one.
    const double bend = dot(left, left) == 0 || dot(right, right) == 0 ? 0 : length(left - right);
    bends[i] = bend <= 2.5 ? static_cast<float>(bend) : 0.0f;
  });
  return bends;
}

double creaseBend(double typical, double least, double factor) {
  constexpr double kMost = 1;  // the chord of 60 degrees
  const double rough = std::max(0.0, typical - kRoughBend);
  return std::max(least, std::min(kMost, least + factor * rough));
}

std::vector<std::uint8_t> creaseVertices(std::uint32_t vertices, const std::vector<Diamond>& diamonds,
                                         const std::vector<float>& bends, double limit) {
  std::vector<std::uint8_t> out(vertices, 0);
  for (std::size_t i = 0; i < diamonds.size(); ++i)
    if (static_cast<double>(bends[i]) > limit) out[diamonds[i].b] = out[diamonds[i].d] = 1;
  return out;
}

}  // namespace quadmark::robust
