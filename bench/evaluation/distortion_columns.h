// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "quadmark/mesh.h"

namespace quadmark::bench {

/// What a row about a marking says of its distortion, by the columns' names in bench/README.md.
/// @param marked  the same mesh with the marked positions.
[[nodiscard]] std::vector<std::pair<std::string, double>> distortionColumns(const Mesh& original, const Mesh& marked);

}  // namespace quadmark::bench
