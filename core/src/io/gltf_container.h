// SPDX-License-Identifier: MIT
// The outermost layer of glTF: a plain JSON text, or a GLB's header and chunks, as byte ranges of the file.
#pragma once

#include <string>
#include <vector>

#include "bytes.h"

namespace quadmark::io {

inline constexpr std::size_t kGlbHeaderBytes = 12;
inline constexpr std::size_t kGlbChunkHeaderBytes = 8;

struct GltfContainer {
  bool isGlb = false;
  std::size_t jsonBegin = 0, jsonEnd = 0;  ///< the JSON text with its padding
  bool hasBin = false;
  std::size_t binBegin = 0, binEnd = 0;  ///< the GLB's BIN chunk with its padding
  std::vector<std::string> warnings;

  [[nodiscard]] std::string_view json(Bytes file) const { return asText(file.subspan(jsonBegin, jsonEnd - jsonBegin)); }
  [[nodiscard]] Bytes bin(Bytes file) const { return file.subspan(binBegin, binEnd - binBegin); }
};

/// Checks the GLB header and every chunk's length. Unknown chunks and bytes after the last chunk are skipped; viewers
/// ignore them too, so they must not hide a mark.
Result<GltfContainer> openGltf(Bytes file);

}  // namespace quadmark::io
