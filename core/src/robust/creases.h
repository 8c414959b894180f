// SPDX-License-Identifier: MIT
// Which edges are creases: those that bend more than a limit, and more than the surface does everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "diamonds.h"

namespace quadmark::robust {

/// How far the surface bends along each diamond's edge, as the chord between the unit normals of its two triangles, 0..2:
/// 2 sin(angle / 2). Within a quad, along the diagonal that would cut it. Cost: 30 ns per diamond.
[[nodiscard]] std::vector<float> edgeBends(const std::vector<Diamond>& diamonds, const std::vector<double>& positions);

/// Where the typical edge (the median) bends more than this, 8.5 degrees, a surface is rough. Scans, CAD models and characters
/// from artists have 0 to 8.4, decimated sculptures and noisy height fields 9 to 26.
inline constexpr double kRoughBend = 0.148;

/// The bend beyond which an edge of a surface stands out: `least`, on rough surfaces more by `factor` for what the typical
/// bend is beyond rough, up to 60 degrees. What is rough all over has no creases to keep, and a limit made for smooth
/// surfaces leaves it without places (docs/robust.md, section 2).
[[nodiscard]] double creaseBend(double typical, double least, double factor);

/// Per vertex, whether an edge along which a diamond lies bends more than `limit` there.
[[nodiscard]] std::vector<std::uint8_t> creaseVertices(std::uint32_t vertices, const std::vector<Diamond>& diamonds,
                                                       const std::vector<float>& bends, double limit);

}  // namespace quadmark::robust
