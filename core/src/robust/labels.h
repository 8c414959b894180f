// SPDX-License-Identifier: MIT
// Connectivity signatures of vertices: names that no motion of the vertices changes (layer A).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "surface.h"

namespace quadmark::robust {

/// Brings a ring into the order of its least sequence of names over all rotations. Both senses would make names that
/// mirroring does not change, at the price of neighbourhoods that are their own mirror image (no unique order) and of twin
/// names on the two sides of a symmetric model: ogre has 900 names so, 1400 with one sense; icosphere none and all.
/// @param ring   kMaxRing vertices at most.
/// @param names  one per vertex of the surface.
/// @param order  receives the ring in canonical order; at least ring.size() long.
/// @param hash   receives a hash of that sequence, which the file's order does not change.
/// @return whether that order is the only one: then it names every ring vertex.
bool canonicalRing(std::span<const std::uint32_t> ring, std::span<const std::uint64_t> names, std::uint32_t* order,
                   std::uint64_t& hash);

/// Rounds of refinement at most: a vertex is told apart by the connectivity of this many rings around it.
inline constexpr int kLabelDepth = 4;

/// Names of all vertices, level by level, and each vertex's label: its name at the least level (2 or more) at which its
/// ring has a unique order and enough irregular vertices lie around; where there is none, its name from afar.
/// Simplification cuts names that reach far, so each vertex is named by as small a neighbourhood as can tell it apart.
struct Labels {
  std::vector<std::uint64_t> label;  ///< per welded vertex; 0 = none, its neighbourhood has a border too near
  std::vector<std::uint8_t> depth;   ///< level of the label
  std::array<std::vector<std::uint64_t>, kLabelDepth + 1> names;  ///< of levels 0 .. kLabelDepth - 1; farNames()

  /// The canonical order of a labelled vertex's ring; false where it is not unique.
  [[nodiscard]] bool orderRing(const Surface& surface, std::uint32_t vertex, std::uint32_t* order) const;
};

[[nodiscard]] Labels refineLabels(const Surface& surface);

}  // namespace quadmark::robust
