// SPDX-License-Identifier: MIT
// Draco's decoder behind our own bounds. It is a part of its own (core/draco): the core can be linked with the decoder
// or, where most files do without and every byte has to be loaded, with a stand-in that refuses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bytes.h"

namespace quadmark::io {

inline constexpr std::uint32_t kAnyDracoPosition = 0xffffffff;

/// An attribute to take out of a stream.
struct DracoAttribute {
  std::uint32_t id = kAnyDracoPosition;  ///< unique id in the stream, or its first attribute of positions
  std::uint32_t componentType = 5126;    ///< of glTF: what its values are converted to
  std::uint32_t components = 3;
};

struct DracoMesh {
  std::uint64_t pointCount = 0;
  std::vector<std::uint32_t> indices;             ///< 3 per triangle, each below pointCount
  std::vector<std::vector<std::uint8_t>> values;  ///< per attribute asked for: tightly packed elements, one per point
};

/// What a stream says before anything of it is decoded.
struct DracoHeader {
  bool isEdgebreaker = false;
  std::uint64_t faces = 0;
  std::size_t metadataBegin = 0, metadataEnd = 0;  ///< equal: it has none
};

inline bool isDraco(Bytes file) {
  return asText(file).substr(0, 5) == "DRACO";
}

/// Reads the header and refuses what would make the decoder allocate more than `memoryLimit` at once.
/// Fails with badFile, unsupportedFile (point clouds, streams older than Draco 1.1 or by an abandoned method),
/// tooLarge.
Result<DracoHeader> readDracoHeader(Bytes stream, std::uint64_t memoryLimit, const std::string& place);

/// Decodes a mesh.
/// @param memoryLimit  of any one allocation, in bytes.
/// @param place        named in errors, for example "mesh 0 primitive 2".
/// Fails as readDracoHeader(), with badFile for a broken stream or attributes that it lacks, or with unsupportedFile
/// when the decoder is not part of this build.
Result<DracoMesh> decodeDraco(Bytes stream, const std::vector<DracoAttribute>& attributes, std::uint64_t memoryLimit,
                              const std::string& place);

}  // namespace quadmark::io
