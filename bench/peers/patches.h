// SPDX-License-Identifier: MIT
// Cutting a mesh into patches by its connectivity alone: not by positions, so that marks, noise and affine maps change
// nothing, and as little by the order of the vertices as the mesh allows.
#pragma once

#include <cstdint>
#include <vector>

#include "quadmark/adjacency.h"

namespace quadmark::bench {

/// Vertices around a seed, at most a few hundred.
struct Patch {
  std::uint64_t name = 0;                ///< from the connectivity around the seed: the same in a cropped copy
  std::vector<std::uint32_t> vertices;   ///< welded; the seed first, then ring by ring, each in the order of names
  std::vector<std::uint32_t> rings;      ///< per entry of `vertices`: edges from the seed inside the patch
};

/// A number for each vertex from the numbers of neighbours within six edges (colour refinement, Weisfeiler and Leman 1968).
/// On irregular meshes nearly all differ; where they do not, as on regular grids, the order of the vertices decides.
[[nodiscard]] std::vector<std::uint64_t> connectivityNames(const WeldedMesh& welded);

/// Seeds are taken in the order of their names, each at least `spacing` edges from those before; all grow at once and a
/// vertex joins the patch that reaches it first, the lower name in a tie. Every vertex is in one patch.
/// @param spacing  >= 1. Patches have about 1.4 spacing^2 vertices on triangle meshes.
/// Ordered by names. Cost: about linear on meshes without hubs.
[[nodiscard]] std::vector<Patch> patchesOf(const WeldedMesh& welded, std::uint32_t spacing);

}  // namespace quadmark::bench
