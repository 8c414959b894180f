// SPDX-License-Identifier: MIT
// The plane of diagonal ratios, and the fine cells that layer B cuts it into.
#pragma once

#include <array>
#include <cstdint>

#include "diamonds.h"

namespace quadmark::robust {

/// A diamond's two ratios, whichever end of its edge they are counted from. The edge's is folded onto 0..0.5; which side
/// of 0.5 the span's lies on then follows from the winding of the triangles, and is worth a bit. (Before, both were folded:
/// half as many fine cells, each with twice as many strangers in it.)
struct Ratios {
  double edge = 0;  ///< 0..0.5
  double span = 0;  ///< 0..1
};
inline Ratios ratiosOf(const DiamondShape& s) {
  return s.alongEdge < 0.5 ? Ratios{s.alongEdge, s.alongSpan} : Ratios{1 - s.alongEdge, 1 - s.alongSpan};
}

/// Diamonds with a smaller ratio (counted from the nearer end) are too lopsided to be cells.
inline constexpr double kLeastRatio = 0.1;
inline bool isUsable(const Ratios& r) {
  return r.edge >= kLeastRatio && r.span >= kLeastRatio && r.span <= 1 - kLeastRatio;
}

/// A way to cut a part of the plane into square fine cells: `least`..0.5 of the edge's ratio, `least`..1 - `least` of the
/// span's.
struct DeltaClass {
  double delta;          ///< side of a fine cell
  double least;          ///< smallest ratio used
  std::uint32_t side;    ///< fine cells along the axis of edges, (0.5 - least) / delta; twice as many along that of spans
  std::uint32_t symbol;  ///< bits per symbol: one of 2^symbol cells of a group is good

  [[nodiscard]] constexpr std::uint32_t spanSide() const { return 2 * side; }
  [[nodiscard]] constexpr std::uint32_t cells() const { return side * spanSide(); }
  [[nodiscard]] constexpr std::uint32_t groups() const { return cells() >> symbol; }
};

/// Coarse cells survive quantization, fine ones hold more bits. Classes 0 to 2 are for IDs, 3 to 5 for payloads with a
/// body. Class 4 leaves out ratios that diamonds of evenly sampled surfaces seldom have: cells there stay empty (bunny at
/// .7: 700 bits of its body read instead of 583, at less distortion).
inline constexpr std::array<DeltaClass, 6> kDeltas = {{{0.012, 0.1, 33, 4},
                                                       {0.016, 0.1, 25, 3},
                                                       {0.020, 0.1, 20, 3},
                                                       {0.012, 0.1, 33, 3},
                                                       {0.006, 0.22, 46, 3},
                                                       {0.004, 0.1, 100, 3}}};

/// A fine cell by its place along both axes, counted from large ratios to small ones; may lie outside the class.
struct FineCell {
  std::uint32_t edge = 0, span = 0;

  [[nodiscard]] bool isIn(const DeltaClass& c) const { return edge < c.side && span < c.spanSide(); }
  /// Number within the class.
  [[nodiscard]] std::uint32_t number(const DeltaClass& c) const { return edge * c.spanSide() + span; }
  [[nodiscard]] static FineCell ofNumber(std::uint32_t number, const DeltaClass& c) {
    return {number / c.spanSide(), number % c.spanSide()};
  }
};

/// Ratios in units of fine cells; the cell is what is before the point.
inline double edgePlace(double edge, const DeltaClass& c) { return (0.5 - edge) / c.delta; }
inline double spanPlace(double span, const DeltaClass& c) { return (0.5 - span) / c.delta + c.side; }
inline FineCell fineCell(double edge, double span, const DeltaClass& c) {
  const double place = spanPlace(span, c);
  return {static_cast<std::uint32_t>(edgePlace(edge, c)), place < 0 ? c.spanSide() : static_cast<std::uint32_t>(place)};
}
inline double edgeCentre(std::uint32_t cell, const DeltaClass& c) { return 0.5 - (cell + 0.5) * c.delta; }
inline double spanCentre(std::uint32_t cell, const DeltaClass& c) { return 0.5 - (cell + 0.5 - c.side) * c.delta; }

}  // namespace quadmark::robust
