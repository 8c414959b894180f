// SPDX-License-Identifier: MIT
#include "distortion_columns.h"

#include "quadmark/metrics.h"
#include "surface_rms.h"

namespace quadmark::bench {

std::vector<std::pair<std::string, double>> distortionColumns(const Mesh& original, const Mesh& marked) {
  const Distortion d = distortion(original, marked);
  return {{"hausdorff", d.hausdorffRel}, {"rms", surfaceRmsRel(original, marked.positions)},
          {"max", d.maxRel},             {"snr", d.snrDb},
          {"psnr", d.normalPsnrDb},      {"normals", d.meanNormalDeg}};
}

}  // namespace quadmark::bench
