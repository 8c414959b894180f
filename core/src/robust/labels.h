// SPDX-License-Identifier: MIT
// Connectivity signatures of vertices: names that no motion of the vertices changes (layer A).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface.h"

namespace quadmark::robust {

/// Brings a ring into the order of its least sequence of names over all rotations and both senses.
/// @param ring   2 * kMaxRing at most.
/// @param names  one per vertex of the surface.
/// @param order  receives the ring in canonical order; at least ring.size() long.
/// @param hash   receives a hash of that sequence, which neither file order nor mirroring changes.
/// @return whether that order is the only one: then it names every ring vertex.
bool canonicalRing(std::span<const std::uint32_t> ring, std::span<const std::uint64_t> names, std::uint32_t* order,
                   std::uint64_t& hash);

struct Labels {
  std::vector<std::uint64_t> label;  ///< per welded vertex; 0 = none
  std::vector<std::uint64_t> below;  ///< the names one level down, by which rings are ordered
};

/// Rounds of refinement, starting from corner counts: a vertex is told apart by the connectivity of this many rings.
inline constexpr int kLabelDepth = 4;

/// Labels of all vertices whose neighbourhoods are closed for kLabelDepth rings; 0 for the others.
[[nodiscard]] Labels refineLabels(const Surface& surface);

}  // namespace quadmark::robust
