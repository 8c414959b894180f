// SPDX-License-Identifier: MIT
#include "quadmark/io/model.h"

#include <set>

#include "bytes.h"
#include "data_uri.h"
#include "gltf_container.h"
#include "json_text.h"
#include "quadmark/io/drc.h"
#include "quadmark/io/gltf.h"
#include "quadmark/io/ply.h"

namespace quadmark {

const char* fileFormatName(FileFormat format) {
  switch (format) {
    case FileFormat::ply:
      return "ply";
    case FileFormat::gltf:
      return "gltf";
    case FileFormat::glb:
      return "glb";
    case FileFormat::drc:
      return "drc";
  }
  return "";
}

Result<std::unique_ptr<Model>> readModel(std::span<const std::uint8_t> file, const Resources& resources) {
  if (file.empty()) return io::badFile("the file is empty");
  if (isPly(file)) return readPly(file);
  if (isGltf(file)) return readGltf(file, resources);
  if (isDrc(file)) return readDrc(file);
  return io::badFile("the file is not a PLY, glTF, GLB or DRC: it begins with " +
                     io::quoted(io::asText(file.first(file.size() < 8 ? file.size() : 8))));
}

Result<std::vector<std::string>> externalUris(std::span<const std::uint8_t> file) {
  std::vector<std::string> uris;
  if (isPly(file) || !isGltf(file)) return uris;
  const Result<io::GltfContainer> container = io::openGltf(file);
  if (!container) return container.error();
  const Result<JsonValue> root = parseJson(container->json(file));
  if (!root) return root.error();
  std::set<std::string> seen;
  root->find("buffers").forEachElement([&](JsonValue buffer) {
    const JsonValue uri = buffer.find("uri");
    if (!uri.isString() || io::isDataUri(unescapeJson(uri.text().substr(1, 64)))) return;
    std::string text = uri.asString();
    if (seen.insert(text).second) uris.push_back(std::move(text));
  });
  return uris;
}

}  // namespace quadmark
