// SPDX-License-Identifier: MIT
#pragma once

#include "quadmark/adjacency.h"
#include "quadmark/mesh.h"

namespace quadmark::detail {

/// hausdorffLocal() for callers that have welded `a` already.
[[nodiscard]] double hausdorffLocal(const Mesh& a, const std::vector<double>& b, const Welding& welding);

}  // namespace quadmark::detail
