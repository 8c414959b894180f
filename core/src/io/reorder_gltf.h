// SPDX-License-Identifier: MIT
// Which arrays of a glTF can change the order of their vertices, and what has to move with them.
#pragma once

#include "gltf_arrays.h"
#include "gltf_buffers.h"

namespace quadmark::io {

/// Elements equally spaced in a buffer.
struct ElementRun {
  std::uint32_t buffer = 0;  ///< the lowest with these bytes
  std::uint64_t start = 0, stride = 0, count = 0;
  std::uint32_t width = 0;  ///< bytes per element
};

/// Indices to the vertices of one array, and the bounds that accessors state for them.
struct IndexRun {
  ElementRun run;
  std::uint32_t componentType = 0;
  std::vector<FileSpan> min, max;
};

/// What depends on the order of one PositionArray.
struct ReorderGroup {
  std::vector<ElementRun> attributes;  ///< positions among them; each byte once
  std::vector<IndexRun> indices;
  std::string obstacle;  ///< not empty: the order has to stay, for this reason
};

struct GltfReorderPlan {
  std::vector<ReorderGroup> groups;  ///< one per PositionArrays::arrays
  std::vector<BufferPlace> places;   ///< of every buffer
  std::vector<BufferBytes> buffers;  ///< opened where a group needs them
};

/// Follows every accessor of the primitives that draw an array. An array has an obstacle when anything about it is not
/// understood completely: a primitive without indices or with an unknown extension, an accessor that is sparse,
/// compressed, broken or of another length, one that also serves another purpose, bytes that anything else uses.
Result<GltfReorderPlan> planGltfReorder(const PositionArrays& positions, const GltfContainer& container, Bytes file,
                                        const Resources& resources);

}  // namespace quadmark::io
