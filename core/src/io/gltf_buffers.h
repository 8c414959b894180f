// SPDX-License-Identifier: MIT
// Where the bytes of a glTF buffer come from: the GLB's BIN chunk, a resource of the caller, or a data: URI.
#pragma once

#include "gltf_container.h"
#include "gltf_document.h"
#include "quadmark/io/model.h"

namespace quadmark::io {

struct BufferPlace {
  enum class Source : std::uint8_t { absent, bin, resource, dataUri };
  Source source = Source::absent;
  std::string key;  ///< of a resource: how the caller's map names it
  FileSpan uri;     ///< of a data: URI, between its quotes
  std::uint64_t byteLength = 0;
};

/// A buffer's bytes, decoded where necessary. The span stays valid when the object moves.
struct BufferBytes {
  std::vector<std::uint8_t> decoded;
  Bytes bytes;
};

/// Finds the sources of the buffers that triangles need; the others stay absent.
/// Fails with badFile for a buffer without data, or whose resource the caller has not given.
Result<std::vector<BufferPlace>> placeBuffers(const GltfDocument& document, const GltfContainer& container, Bytes file,
                                              const Resources& resources);

/// Gives a buffer's bytes: byteLength or, with padding, more. Fails with badFile when there are fewer.
Result<BufferBytes> openBuffer(const BufferPlace& place, std::size_t index, const GltfContainer& container, Bytes file,
                               const Resources& resources);

}  // namespace quadmark::io
