// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/result.h"

namespace quadmark::bench {

struct NamedModel {
  std::string name;                 ///< without folders
  std::vector<std::uint8_t> bytes;  ///< the file; empty for generated models
  Mesh mesh;
};

/// A file, or KIND:VERTICES[:SEED] for a generated model (lab/generate.h). A suffix @KEEP decimates it (quadric edge
/// collapse, to that share of its vertices), ~STEPS smooths it (umbrella steps of 0.03).
[[nodiscard]] Result<NamedModel> loadModel(const std::string& name);

/// The model with other positions, as a GLB: its own file patched where it is one, otherwise a bare one.
[[nodiscard]] Result<std::vector<std::uint8_t>> toGlb(const NamedModel& model, const std::vector<double>& positions);

}  // namespace quadmark::bench
