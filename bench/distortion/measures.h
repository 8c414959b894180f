// SPDX-License-Identifier: MIT
// How far a marked model is from its original, in every measure of the evaluation.
#pragma once

#include <vector>

#include "quadmark/mesh.h"

namespace quadmark::bench {

struct Measures {
  double hausdorffRel = 0;  ///< two-sided, of the diagonal
  double rmsRel = 0;        ///< between the surfaces, the larger of both directions, of the diagonal: MRMS
  double maxRel = 0;        ///< largest displacement of a vertex, of the diagonal
  double snrDb = 0;         ///< of the vertices (metrics.h); infinite when nothing moved
  double psnrDb = 0;        ///< of the vertex normals (metrics.h); infinite when none turned
  double normalsDeg = 0;    ///< mean angle between vertex normals
  double msdm2 = 0;         ///< 0 .. 1, see msdm2.h
};

/// @param marked  positions of the marked model, 3 per vertex, as its file holds them. The mesh has faces.
[[nodiscard]] Measures measure(const Mesh& mesh, const std::vector<double>& marked);

}  // namespace quadmark::bench
