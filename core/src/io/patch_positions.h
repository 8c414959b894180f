// SPDX-License-Identifier: MIT
// Checks on the positions handed to patch(), shared by all formats.
#pragma once

#include <cmath>
#include <span>

#include "bytes.h"
#include "quadmark/mesh.h"

namespace quadmark::io {

/// Fails with badOption unless there are 3 finite positions per vertex, each representable in the file's precision.
inline Status checkPositions(std::span<const double> positions, std::uint64_t vertexCount, Precision precision) {
  if (positions.size() != 3 * vertexCount) {
    return Error{ErrorCode::badOption, "positions: " + std::to_string(positions.size()) + " numbers for " +
                                           std::to_string(vertexCount) + " vertices"};
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const float rounded = static_cast<float>(positions[i]);
    const bool fits = precision == Precision::float64 || double{rounded} == positions[i];
    if (!std::isfinite(positions[i]) || !fits) {
      return Error{ErrorCode::badOption, "positions: vertex " + std::to_string(i / 3) + ", component " + "xyz"[i % 3] +
                                             " is not a finite number of the file's precision"};
    }
  }
  return okStatus();
}

}  // namespace quadmark::io
