// SPDX-License-Identifier: MIT
// Reading a mark from a scene: the whole first, then object by object.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "quadmark/robust/mark.h"
#include "quadmark/robust/reader.h"

namespace quadmark::robust {

struct SceneReading {
  MarkReading reading;
  std::optional<std::uint32_t> component;  ///< read from one component alone: its rank by size, from 0
  std::uint32_t tried = 1;                 ///< readings
  ReaderCoverage coverage;                 ///< of the part that was read
  std::vector<float> evidence;             ///< per mesh vertex as MeshReader::evidence(); empty where nothing was read
};

struct SceneRequest {
  const SchemeKeys& keys;
  std::optional<Payload> expected{};
  std::function<bool(double done)> progress{};  ///< false cancels
};

/// Reads the whole mesh; if that is no match, each of its largest connected components alone: other objects in a scene add
/// votes that say nothing.
///
/// Every reading has a weight that connectivity alone fixes: 1/2 the whole, 1 / (2 r (r + 1)) the component that is r-th by
/// size. Its probabilities are divided by it (Bonferroni), and its verdict follows from them. Where no part matches, the
/// whole mesh's reading is returned. Fails like readMark(). Cost: readMark() once where that matches or there is one
/// component, else up to twice.
[[nodiscard]] Result<SceneReading> readScene(const Mesh& mesh, const SceneRequest& request);

}  // namespace quadmark::robust
