// SPDX-License-Identifier: MIT
// Cells that stand in a simplifier's way.
#pragma once

#include <cstdint>
#include <vector>

#include "embed_diamonds.h"

namespace quadmark::robust {

/// On machined parts and dense smooth surfaces every cell lies so close to the surface around it that a simplifier within
/// a small error, as `gltf-transform optimize` runs one (1e-4 of the extent), takes its vertices away. A cell stands
/// when taking any of them would cost more. This raises cells along their normals, which leaves their ratios and
/// flatness alone, by as little as makes them stand, until `wanted` of all do. (IDs read of 30, parts and the icosphere
/// of 40962 at `strong` after optimize and 14 bits: 5 before, 29 with it.)
///
/// Left alone: cells whose surroundings lie in one plane, as planes are to stay; cells that would have to turn a face by
/// more than 10 degrees from what it is in `surface`, or a vertex to move farther than `limits` allows; cells at
/// vertices of more than kMaxRing faces.
/// @param cells      in the order in which they are to be raised.
/// @param change     as for embedDiamonds().
/// @param positions  changed in place.
/// Cost: 2 microseconds per cell that is looked at, ten times that for one that is raised.
void raiseCells(const Surface& surface, const FacesAround& facesAround, const std::vector<WrittenCell>& cells,
                std::size_t wanted, const DiamondLimits& limits, const ChangeMeter* change,
                std::vector<double>& positions);

}  // namespace quadmark::robust
