// SPDX-License-Identifier: MIT
#include "measures.h"

#include "msdm2.h"
#include "quadmark/metrics.h"
#include "surface_rms.h"

namespace quadmark::bench {

Measures measure(const Mesh& mesh, const std::vector<double>& marked) {
  Mesh copy = mesh;
  copy.positions = marked;
  const Distortion d = distortion(mesh, copy);
  return {.hausdorffRel = d.hausdorffRel,
          .rmsRel = surfaceRms(mesh, marked).largestRel,
          .maxRel = d.maxRel,
          .snrDb = d.snrDb,
          .psnrDb = d.normalPsnrDb,
          .normalsDeg = d.meanNormalDeg,
          .msdm2 = msdm2(mesh, copy)};
}

}  // namespace quadmark::bench
