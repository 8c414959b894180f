// SPDX-License-Identifier: MIT
#include "distortion_columns.h"

#include "distortion/measures.h"

namespace quadmark::bench {

std::vector<std::pair<std::string, double>> distortionColumns(const Mesh& original, const Mesh& marked) {
  const Measures m = measure(original, marked.positions);
  return {{"hausdorff", m.hausdorffRel}, {"rms", m.rmsRel},         {"max", m.maxRel},    {"snr", m.snrDb},
          {"psnr", m.psnrDb},            {"normals", m.normalsDeg}, {"msdm2", m.msdm2}};
}

}  // namespace quadmark::bench
