// SPDX-License-Identifier: MIT
// Checks on the positions handed to patch(), shared by all formats.
#pragma once

#include <cmath>
#include <span>

#include "bytes.h"
#include "concat.h"

namespace quadmark::io {

/// Fails with badOption unless there are 3 numbers per vertex.
inline Status checkPositions(std::span<const double> positions, std::uint64_t vertexCount) {
  if (positions.size() == 3 * vertexCount) return okStatus();
  return Error{ErrorCode::badOption,
               concat("positions: ", positions.size(), " numbers for ", vertexCount, " vertices")};
}

inline bool fitsFloat32(double x) { return double{static_cast<float>(x)} == x; }

/// Fails with badOption, naming the vertex, unless the coordinates of a range are finite and fits(coordinate).
template <class Fits>
Status checkRepresentable(std::span<const double> positions, std::uint64_t firstVertex, std::uint64_t count,
                          const Fits& fits) {
  for (auto i = static_cast<std::size_t>(3 * firstVertex); i < static_cast<std::size_t>(3 * (firstVertex + count)); ++i) {
    if (std::isfinite(positions[i]) && fits(positions[i])) continue;
    return Error{ErrorCode::badOption, concat("positions: vertex ", i / 3, ", component ", "xyz"[i % 3],
                                              " is not a finite number of the file's precision")};
  }
  return okStatus();
}

}  // namespace quadmark::io
