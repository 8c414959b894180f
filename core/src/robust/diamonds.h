// SPDX-License-Identifier: MIT
// Cells of layer B: the two triangles at an interior edge, seen as a quadrilateral with two diagonals.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "surface.h"

namespace quadmark::robust {

/// Edge b-d with the opposite corners a and c. The triangle with a runs along the edge from b to d, that with c from d to
/// b; where the windings of the two disagree, which is a and which c is left to chance.
struct Diamond {
  std::uint32_t a = 0, b = 0, c = 0, d = 0;
};

/// All diamonds: interior edges of two triangles, and quads, whose edge is the diagonal from the first corner: most
/// tools cut quads along it, so that the mark survives them. (Tried: both diagonals, for files whose faces begin
/// elsewhere; the wrong one of each marked quad is flat, too, and reads as noise as strong as the mark.) Edges of other
/// polygons have none. In the order of the lower, then the higher vertex of the edge; quads follow in the order of
/// faces. Cost: linear.
[[nodiscard]] std::vector<Diamond> collectDiamonds(const Surface& surface);

/// Where the diagonals come closest, and how vertex noise moves that.
struct DiamondShape {
  double alongEdge = 0;  ///< ratio on b-d, from b
  double alongSpan = 0;  ///< ratio on a-c, from a
  Vec3 gap;              ///< from the point on b-d to that on a-c
  double gapLength = 0;
  double edgeLength = 0, spanLength = 0;
  double gapGain = 0;   ///< standard deviation of the gap per unit of vertex noise
  double edgeGain = 0;  ///< the same of alongEdge, per file unit
  double spanGain = 0;  ///< of alongSpan
};

/// @return false for diamonds that are not convex (a ratio outside 0..1) or nearly a line.
[[nodiscard]] bool diamondShape(const std::vector<double>& positions, const Diamond& diamond, DiamondShape& out);

}  // namespace quadmark::robust
