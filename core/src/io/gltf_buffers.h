// SPDX-License-Identifier: MIT
// Where the bytes of a glTF buffer come from: the GLB's BIN chunk, a resource of the caller, a data: URI, or a decoder.
#pragma once

#include "draco_codec.h"
#include "gltf_container.h"
#include "gltf_document.h"
#include "quadmark/io/model.h"

namespace quadmark::io {

/// A stream of KHR_draco_mesh_compression and the positions in it.
struct DracoStream {
  std::uint32_t view = 0, buffer = 0;
  std::uint64_t byteOffset = 0, byteLength = 0;  ///< in the buffer
  std::uint32_t position = 0;                    ///< unique id
  std::uint32_t componentType = 0;               ///< of the decoded positions
  bool normalized = false;
  std::string place;  ///< the first primitive that it draws
};

struct BufferPlace {
  enum class Source : std::uint8_t { absent, bin, resource, dataUri, meshopt, draco };
  Source source = Source::absent;
  std::string key;        ///< of a resource: how the caller's map names it
  FileSpan uri;           ///< of a data: URI, between its quotes
  MeshoptSource meshopt;  ///< of a decoded view
  DracoStream draco;      ///< of decoded positions
  std::uint64_t byteLength = 0;
};

/// A buffer's bytes, decoded where necessary. The span stays valid when the object moves.
struct BufferBytes {
  std::vector<std::uint8_t> decoded;
  Bytes bytes;
};

/// Finds the sources of the buffers that triangles need, compressed ones included; the others stay absent.
/// Fails with badFile for a buffer without data, or whose resource the caller has not given.
Result<std::vector<BufferPlace>> placeBuffers(const GltfDocument& document, const GltfContainer& container, Bytes file,
                                              const Resources& resources);

/// Gives the bytes of a buffer of the file: byteLength or, with padding, more. Fails with badFile when there are fewer.
Result<BufferBytes> openBuffer(const BufferPlace& place, std::size_t index, const GltfContainer& container, Bytes file,
                               const Resources& resources);

/// Opens the buffers that are wanted and not absent, and decodes those that are compressed.
/// @param wanted  one per buffer.
/// @return one entry per buffer; besides the wanted ones those that they are decoded from. Fails as openBuffer(), with
///         badFile for broken compressed data, or tooLarge if decoding would take more than memoryLimit().
Result<std::vector<BufferBytes>> openBuffers(const std::vector<BufferPlace>& places, const std::vector<bool>& wanted,
                                             const GltfContainer& container, Bytes file, const Resources& resources);

/// Decodes a stream whose buffer is open; the result's first attribute are the positions.
Result<DracoMesh> decodeDracoStream(const DracoStream& stream, const std::vector<BufferBytes>& buffers,
                                    std::uint64_t memoryLimit);

/// The most that may be allocated for a model at once, whatever it claims: 8 times its bytes and 64 MiB.
std::uint64_t memoryLimit(Bytes file, const Resources& resources);

}  // namespace quadmark::io
