// SPDX-License-Identifier: MIT
// Writing layer B: diamonds onto the centres of good fine cells, flat.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "constellation.h"
#include "diamond_queues.h"
#include "diamonds.h"
#include "distortion_budget.h"

namespace quadmark::robust {

struct DiamondLimits {
  double mostGap = 0.05;              ///< natural gap of a candidate, of its shorter diagonal
  double turnCosine = 0;              ///< cosine of the largest turn of an incident face against the original
  double farQuota = 0;                ///< cells per vertex up to which far candidates may fill up a good cell's share
  double leastFar = 2, mostFar = 10;  ///< bounds of that share, cells
  double maxMove = 1e300;             ///< of any vertex, file units
  double maxSlide = 1e300;            ///< of its part along the surface, file units
};

struct WrittenCell {
  Diamond diamond;
  std::uint32_t meaning;  ///< Constellation::meaning of its fine cell
  float naturalGap;       ///< gap before, file units
};

struct DiamondEmbedding {
  std::vector<WrittenCell> cells;
  std::uint32_t vetoed = 0;
};

/// The diamonds that may become cells, and what each would cost.
struct DiamondCandidates {
  std::vector<Diamond> diamonds;
  std::vector<Candidate> items;  ///< one per diamond
};

/// Those within the limits, off occupied vertices and creases. Takes the list of all diamonds, which is much memory,
/// and gives that of the others back.
/// @param creased    per welded vertex: 1 = on a crease (creaseVertices()).
/// @param occupied   per welded vertex: 1 = not to be moved.
[[nodiscard]] DiamondCandidates findCandidates(const Surface& surface, std::vector<Diamond> diamonds,
                                               const DeltaClass& shape, const DiamondLimits& limits,
                                               const std::vector<std::uint8_t>& creased,
                                               const std::vector<std::uint8_t>& occupied,
                                               const std::vector<double>& positions);

/// Whether a face at a vertex of the diamond has turned from what it is in `surface` by an angle of a smaller cosine.
[[nodiscard]] bool anyFaceTurns(const Surface& surface, const FacesAround& facesAround, const Diamond& diamond,
                                double turnCosine, const std::vector<double>& positions);

/// Chooses and writes cells: each good cell has a queue of candidates by displacement, and all queues are served in
/// turn, so that no coded bit is left with few copies. (Tried: the flattest diamonds first, as the paper does; the
/// median good cell then gets 3 of 43 expected copies.)
/// Faces must not turn away from what they are in `surface`.
/// @param change     knows the normals that limits.maxSlide refers to; null where that is no limit.
/// @param occupied   per welded vertex: 1 = not to be moved; receives the vertices of the cells.
/// @param positions  changed in place.
[[nodiscard]] DiamondEmbedding embedDiamonds(const Surface& surface, const FacesAround& facesAround,
                                             DiamondCandidates candidates, const Constellation& constellation,
                                             const CodedPayload& payload, const DiamondLimits& limits,
                                             const ChangeMeter* change, std::vector<std::uint8_t>& occupied,
                                             std::vector<double>& positions);

}  // namespace quadmark::robust
