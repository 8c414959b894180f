// SPDX-License-Identifier: MIT
// Four points as a convex quadrilateral: its diagonals, their ratios, and how far it is from flat (section 3.1).
//
//        b
//       / \         o: where the diagonals meet
//      a-o-c        |ao| / |ac| and |bo| / |bd| are unchanged by every affine map
//       \ /
//        d
#pragma once

#include <cstdint>

namespace quadmark {

/// A convex quadrilateral over four welded vertices. a-c and b-d are the diagonals; a and b are the nearer ends.
struct Quad {
  std::uint32_t a = 0, b = 0, c = 0, d = 0;
  double ratioAC = 0, ratioBD = 0;    ///< |ao| / |ac| and |bo| / |bd|, both <= 0.5
  double lengthAC = 0, lengthBD = 0;  ///< file units
  /// Distance between the lines of the two diagonals, file units: 0 iff coplanar. It treats the four points alike and,
  /// unless the set is sharply folded, stays below the distance of one point from the plane of the other three (the
  /// paper's h).
  double gap = 0;

  [[nodiscard]] double longerDiagonal() const { return lengthAC > lengthBD ? lengthAC : lengthBD; }
  [[nodiscard]] double diagonalSum() const { return lengthAC + lengthBD; }
};

/// Least area of a triangle of three of the points, as a fraction of its longest edge squared (D5). The reader is more
/// generous than the writer because an affine map changes this fraction.
inline constexpr double kMinTriangleWriting = 1e-3, kMinTriangleReading = 1e-5;

/// Finds the one pairing of four points whose diagonals cross (D5): none if the points are not in convex position (seen
/// along the common normal of the diagonals) or some three of them are nearly collinear.
/// The result, to the last bit, depends on the points alone and not on the order in which they are given.
/// @param ids        the four vertices, distinct.
/// @param positions  3 per vertex, indexed by id.
/// @param minTriangle  see kMinTriangle*.
/// @return false when there is no such quadrilateral.
[[nodiscard]] bool makeQuad(const std::uint32_t ids[4], const double* positions, double minTriangle, Quad& out);

/// The same for points given by pointer; out.a .. out.d are then indices 0..3 into `points`.
[[nodiscard]] bool makeQuad(const double* const points[4], double minTriangle, Quad& out);

/// Moves the near ends along their diagonals so that both ratios become the given ones: the paper's Eq. (3),
/// a' = (o - r' c) / (1 - r'). The crossing point o and the plane stay, so the two moves do not disturb each other.
/// When the four points are not exactly coplanar, each diagonal is first shifted by half the gap, so that afterwards
/// they are.
void writeRatios(const Quad& quad, double ratioAC, double ratioBD, double* positions);

}  // namespace quadmark
