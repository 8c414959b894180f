// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "quadmark/mesh.h"

namespace quadmark::bench {

/// Root mean square distances between two surfaces, fractions of the diagonal of the first.
struct SurfaceRms {
  double meanRel = 0;     ///< both directions averaged (of the squares)
  double largestRel = 0;  ///< the larger one: MRMS, as the LIRIS protocol limits it
};

/// Of two surfaces of the same connectivity: each vertex of one against the faces around the corresponding place (two
/// rings) of the other. Sliding along the surface does not count.
[[nodiscard]] SurfaceRms surfaceRms(const Mesh& mesh, const std::vector<double>& marked);

}  // namespace quadmark::bench
