// SPDX-License-Identifier: MIT
// Positions as they lie in the buffers: which accessors are windows onto the same bytes, and who else reads those.
#pragma once

#include "gltf_document.h"

namespace quadmark::io {

/// A maximal run of positions in one buffer. No two arrays share a byte.
struct PositionArray {
  std::uint32_t buffer = 0;
  std::uint64_t start = 0;  ///< first byte in the buffer
  std::uint32_t stride = 12;
  std::uint64_t count = 0;
  std::uint64_t firstVertex = 0;  ///< in Mesh
};

/// An accessor's part of an array.
struct PositionWindow {
  std::uint32_t accessor = 0, array = 0;
  std::uint64_t firstVertex = 0, count = 0;
};

struct PositionArrays {
  std::vector<PositionArray> arrays;    ///< in the order in which primitives first use them
  std::vector<PositionWindow> windows;  ///< every accessor of positions inside an array
  std::vector<std::uint32_t> windowOf;  ///< accessor -> index into windows, or kNone
  std::uint64_t vertexCount = 0;
  /// Not empty: positions share bytes with other data, so they can be read but not patched.
  std::string conflict;
};

/// Groups the POSITION accessors of all triangle primitives. Accessors with the same bytes, or shifted by whole
/// elements of the same stride, are windows of one array.
/// @param sameBuffer  buffer -> lowest buffer with the same bytes (two buffers may name one file).
/// Fails with unsupportedFile where positions overlap in any other way, or tooLarge.
Result<PositionArrays> collectPositionArrays(const GltfDocument& document,
                                             const std::vector<std::uint32_t>& sameBuffer);

}  // namespace quadmark::io
