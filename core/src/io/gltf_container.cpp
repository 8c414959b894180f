// SPDX-License-Identifier: MIT
#include "gltf_container.h"

#include "concat.h"

namespace quadmark::io {
namespace {

constexpr std::uint32_t kMagic = 0x46546c67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN\0"

}  // namespace

Result<GltfContainer> openGltf(Bytes file) {
  GltfContainer container;
  if (file.size() < 4 || load<std::uint32_t>(file.data()) != kMagic) {
    const bool byteOrderMark = asText(file).substr(0, 3) == "\xef\xbb\xbf";
    container.jsonBegin = byteOrderMark ? 3 : 0;
    container.jsonEnd = file.size();
    return container;
  }

  container.isGlb = true;
  if (file.size() < kGlbHeaderBytes) return badFile("GLB: the file ends inside its 12-byte header");
  const std::uint32_t version = load<std::uint32_t>(&file[4]);
  const std::uint64_t length = load<std::uint32_t>(&file[8]);
  if (version != 2) return unsupportedFile(concat("GLB version ", version, "; only version 2 is supported"));
  if (length > file.size()) {
    return badFile(concat("GLB: the header says ", length, " bytes, the file has ", file.size()));
  }
  if (length < kGlbHeaderBytes) return badFile(concat("GLB: the header says ", length, " bytes"));
  if (length < file.size()) {
    container.warnings.push_back(concat(file.size() - length, " bytes after the GLB's end are kept as they are"));
  }

  std::uint64_t at = kGlbHeaderBytes;
  for (std::uint64_t chunk = 0; at < length; ++chunk) {
    const std::string place = concat("GLB chunk ", chunk);
    if (length - at < kGlbChunkHeaderBytes) return badFile(place + ": the file ends inside the chunk's header");
    const std::uint64_t chunkLength = load<std::uint32_t>(file.data() + at);
    const std::uint32_t type = load<std::uint32_t>(file.data() + at + 4);
    at += kGlbChunkHeaderBytes;
    if (chunkLength > length - at) {
      return badFile(concat(place, ": ", chunkLength, " bytes are claimed, ", length - at, " are left"));
    }
    if (chunk == 0) {
      if (type != kJsonChunk) return badFile("GLB: the first chunk is not JSON");
      container.jsonBegin = static_cast<std::size_t>(at);
      container.jsonEnd = static_cast<std::size_t>(at + chunkLength);
    } else if (type == kBinChunk && !container.hasBin) {
      container.hasBin = true;
      container.binBegin = static_cast<std::size_t>(at);
      container.binEnd = static_cast<std::size_t>(at + chunkLength);
    }
    at += chunkLength;
  }
  if (container.jsonBegin == 0) return badFile("GLB: the file has no JSON chunk");
  return container;
}

}  // namespace quadmark::io
