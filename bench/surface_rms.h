// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "quadmark/mesh.h"

namespace quadmark::bench {

/// Root mean square distance between two surfaces of the same connectivity, both directions averaged, of the diagonal
/// of `mesh`: each vertex of one against the faces around the corresponding place (two rings) of the other. Sliding
/// along the surface does not count.
[[nodiscard]] double surfaceRmsRel(const Mesh& mesh, const std::vector<double>& marked);

}  // namespace quadmark::bench
