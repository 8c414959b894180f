// SPDX-License-Identifier: MIT
#include "quadmark/io/model.h"

#include "bytes.h"
#include "quadmark/io/gltf.h"
#include "quadmark/io/ply.h"

namespace quadmark {

const char* fileFormatName(FileFormat format) {
  switch (format) {
    case FileFormat::ply: return "ply";
    case FileFormat::gltf: return "gltf";
    case FileFormat::glb: return "glb";
  }
  return "";
}

Result<std::unique_ptr<Model>> readModel(std::span<const std::uint8_t> file, const Resources& resources) {
  if (file.empty()) return io::badFile("the file is empty");
  if (isPly(file)) return readPly(file);
  if (isGltf(file)) return readGltf(file, resources);
  return io::badFile("the file is not a PLY, glTF or GLB: it begins with " +
                     io::quoted(io::asText(file.first(file.size() < 8 ? file.size() : 8))));
}

}  // namespace quadmark
