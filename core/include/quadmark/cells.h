// SPDX-License-Identifier: MIT
// Embedding cells: the embedder's search and construction (section 3.2) and the decoder's enumeration.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "quadmark/adjacency.h"
#include "quadmark/key.h"
#include "quadmark/quad.h"

namespace quadmark {

/// Neighbourhoods larger than this are cut to their nearest members (D8): C(60, 4) is 487 635 sets, C(16, 4) is 1820.
/// Ties in distance are broken by position, so the rule does not see the vertex order. The reader keeps twice as many
/// because an affine map changes distances.
inline constexpr std::size_t kMaxMembersWriting = 16, kMaxMembersReading = 24;

/// How far rounding alone can take four points of a file off their common plane.
struct Rounding {
  double relative = 0;  ///< half a unit in the last place, as a fraction of a coordinate: 2^-24 or 2^-53
  /// Half a step of the grid of each welded vertex, which must outlive this; empty without grids.
  std::span<const double> halfStep;

  [[nodiscard]] double halfStepOf(std::uint32_t vertex) const { return halfStep.empty() ? 0 : halfStep[vertex]; }
  /// The unit in which gaps are measured: one coordinate's largest rounding error near these points, but never below
  /// 1e-8 of the longer diagonal (D4).
  [[nodiscard]] double unit(const Quad& quad, const double* positions) const;
  /// @param gridHalfStep  largest half step of their grids, 0 without.
  [[nodiscard]] double unit(const double* const points[4], double longerDiagonal, double gridHalfStep = 0) const;
};
[[nodiscard]] Rounding roundingOf(Precision precision);

/// The rounding of a file's own vertices, grids included.
/// @param welded  must outlive the result.
[[nodiscard]] Rounding roundingOf(Precision precision, const WeldedMesh& welded);

/// A gap of up to this many units counts as exactly coplanar.
inline constexpr double kExactUnits = 4;

struct SearchResult {
  std::vector<Quad> cells;             ///< vertex disjoint, each exactly coplanar up to rounding
  std::uint32_t naturalCells = 0;      ///< how many were coplanar before
};

/// Finds vertex-disjoint coplanar convex quadrilaterals in the neighbourhoods, in vertex order (section 4.2, steps 1-2):
/// natural ones, longest diagonals first; else the smallest projection of one vertex onto the plane of three others, up
/// to lambda * diagonal (D7). A vertex already used may still seed a neighbourhood (D9).
/// @param welded    weld(mesh); its positions become those after construction.
/// @param diagonal  bounding-box diagonal, file units, > 0.
/// Cost: linear, about 0.5 microseconds per vertex.
[[nodiscard]] SearchResult searchCells(const Mesh& mesh, WeldedMesh& welded, const PaperParams& params,
                                       double diagonal, const Rounding& rounding);

/// How flat a set must be to be reported: gap <= max(kExactUnits or fewer rounding units, min(units, relative * longer
/// diagonal)).
struct GapLimit {
  double units = kExactUnits;  ///< in rounding units
  double relative = 0;         ///< beyond kExactUnits also at most this fraction of the longer diagonal
  [[nodiscard]] bool admits(const Quad& quad, double unit) const {
    return quad.gap <= units * unit && (quad.gap <= kExactUnits * unit || quad.gap <= relative * quad.longerDiagonal());
  }
};

/// Have four vertices the same owner?
/// @param ownerOf  per vertex, kNoVertex for none.
[[nodiscard]] bool haveOneOwner(const std::uint32_t ids[4], const std::vector<std::uint32_t>& ownerOf);

/// Calls visit for every convex four-point set of the neighbourhoods that the limit admits, each set once, in an order
/// that depends on vertex numbers.
/// @param welded     connectivity.
/// @param positions  3 per welded vertex; need not be welded.positions.
/// @param skip       empty, or one byte per vertex: sets with a marked vertex are left out.
/// @param seeds      only these neighbourhoods; nullptr for all.
/// @param ownerOf    per vertex, kNoVertex for none: sets whose four vertices have one owner are left out; nullptr for
///                   no such rule.
/// Cost: linear for small gaps, about 0.2 microseconds per vertex.
void forEachCoplanarSet(const WeldedMesh& welded, const std::vector<double>& positions, int k, const Rounding& rounding,
                        const GapLimit& limit, const std::vector<std::uint8_t>& skip,
                        const std::function<void(const Quad&)>& visit,
                        const std::vector<std::uint32_t>* seeds = nullptr,
                        const std::vector<std::uint32_t>* ownerOf = nullptr);

}  // namespace quadmark
