// SPDX-License-Identifier: MIT
// What marking a mesh leaves as it is: which vertices are one, the faces, the carriers. Who marks knows it, and the
// reading that proves the mark need not find it again.
#pragma once

#include <memory>

#include "carriers.h"
#include "quadmark/robust/coded.h"
#include "surface.h"

namespace quadmark::robust {

struct Ground {
  Surface surface;
  Carriers carriers;
};

/// @param mirrored  of the mesh turned over, see turnOver().
/// Cost: linear, about 0.4 microseconds per vertex.
[[nodiscard]] std::shared_ptr<Ground> groundOf(const Mesh& mesh, const RobustKeys& keys, bool mirrored = false);

/// Gives the surface the positions of a copy of its mesh.
/// @return false, with some of them changed, where these would weld other vertices.
[[nodiscard]] bool moveTo(Surface& surface, const Mesh& copy);

}  // namespace quadmark::robust
