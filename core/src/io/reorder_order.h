// SPDX-License-Identifier: MIT
// Orders of vertices: checked, inverted, and the self-check of a reordered file. Shared by all formats.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bytes.h"
#include "quadmark/io/model.h"

namespace quadmark::io {

/// For each old vertex its new number.
/// @param order  for each new vertex the old one.
/// Fails with badOption unless `order` permutes the vertices inside each range and leaves all others in place.
Result<std::vector<std::uint32_t>> invertOrder(std::span<const std::uint32_t> order, std::uint64_t vertexCount,
                                               std::span<const VertexRange> ranges);

/// Reads a reordered file and compares its positions and faces with those of the mesh it was made from.
/// @return `internal` at the first difference.
Status checkReordered(const Mesh& before, std::span<const std::uint32_t> order, std::span<const std::uint32_t> newOf,
                      Bytes file, const Resources& resources);

}  // namespace quadmark::io
