// SPDX-License-Identifier: MIT
// Positions as they lie in the buffers: which accessors are windows onto the same bytes, and who else reads those.
#pragma once

#include "gltf_document.h"

namespace quadmark::io {

/// A maximal run of positions in one buffer. Unless there is a conflict, no two arrays share a byte.
struct PositionArray {
  std::uint32_t buffer = 0;
  std::uint64_t start = 0;  ///< first byte in the buffer
  std::uint32_t stride = 12;
  std::uint64_t count = 0;
  std::uint64_t firstVertex = 0;  ///< in Mesh
  PositionType type;
};

/// An accessor's part of an array, or the values that replace some elements of a sparse accessor.
struct PositionWindow {
  std::uint32_t accessor = 0;
  /// kNone for a sparse accessor without bufferView: its other elements are zeros that are stored nowhere. All of them
  /// are one vertex, the only one of the window, and it cannot move.
  /// Tried: appending a plain view instead. It lets that one point move, for 12 bytes an element.
  std::uint32_t array = 0;
  std::uint64_t firstVertex = 0, count = 0;
  std::uint32_t values = kNone;          ///< of a sparse accessor: the window of its values
  std::vector<std::uint32_t> replaced;   ///< of values: which elements they replace, ascending; see GltfModel

  [[nodiscard]] bool isStored() const { return array != kNone; }
};

struct PositionArrays {
  std::vector<PositionArray> arrays;    ///< in the order in which primitives first use them
  std::vector<PositionWindow> windows;  ///< every accessor of positions inside an array, and sparse values
  std::vector<std::uint32_t> windowOf;  ///< accessor -> index into windows, or kNone
  std::uint64_t vertexCount = 0;
  /// Not empty: positions share bytes with other data or in another layout: they can be read but not patched.
  std::string conflict;

  /// The mesh vertex of an accessor's element; values' `replaced` must be filled in.
  [[nodiscard]] std::uint32_t vertexOf(const PositionWindow& window, std::uint32_t element) const;
};

/// Groups the POSITION accessors of all triangle primitives. Accessors with the same bytes, or shifted by whole
/// elements of the same stride and type, are windows of one array.
/// @param sameBuffer  buffer -> lowest buffer with the same bytes (two buffers may name one file).
/// Fails with tooLarge.
Result<PositionArrays> collectPositionArrays(const GltfDocument& document,
                                             const std::vector<std::uint32_t>& sameBuffer);

}  // namespace quadmark::io
