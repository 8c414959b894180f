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
/// flatness alone, by as little as makes them stand, until `wanted` in all have stood when they were looked at. What is
/// won is in docs/robust.md, section 2.
///
/// Left alone: cells with a vertex whose faces lay in one plane, as planes are to stay; cells that would have to turn a
/// face by more than 10 degrees from what it is in `surface`, or a vertex to move farther than `limits` allows; cells at
/// vertices of more than kMaxRing faces.
/// @param cells      in the order in which they are to be raised.
/// @param grain      how far rounding may have taken vertices out of a plane, beyond float32's own: file units.
/// @param change     knows the normals before embedding.
/// @param positions  changed in place.
/// Cost: some 2 microseconds per cell that is looked at, ten times that for one that is raised or cannot be.
void raiseCells(const Surface& surface, const FacesAround& facesAround, const std::vector<WrittenCell>& cells,
                std::size_t wanted, const DiamondLimits& limits, double grain, const ChangeMeter& change,
                std::vector<double>& positions);

}  // namespace quadmark::robust
