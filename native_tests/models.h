// SPDX-License-Identifier: MIT
// Finds the real models that tests and benchmarks use. They are not part of the repository.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace quadmark::test {

using FileBytes = std::vector<std::uint8_t>;

/// The directory of real models: $QUADMARK_MODELS, else ../shared/models beside the source tree.
inline std::string modelDirectory() {
  const char* given = std::getenv("QUADMARK_MODELS");
  if (given != nullptr && *given != '\0') return given;
  return std::string(QUADMARK_SOURCE_DIR) + "/../shared/models";
}

/// A whole file, or nothing if it cannot be opened.
inline std::optional<FileBytes> readFile(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return std::nullopt;
  return FileBytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The path of a real model ("bunny.ply", "Fox/Fox.gltf"), or nothing where it is absent, which is said on stderr: the
/// calling test then passes without having looked at this model.
inline std::optional<std::string> modelPath(const std::string& name) {
  const std::string path = modelDirectory() + "/" + name;
  if (std::ifstream(path, std::ios::binary)) return path;
  std::fprintf(stderr, "[  ABSENT  ] real model %s is not there; set QUADMARK_MODELS. This part is not tested.\n",
               path.c_str());
  return std::nullopt;
}

/// The bytes of a real model, or nothing where it is absent (said on stderr).
inline std::optional<FileBytes> modelBytes(const std::string& name) {
  const std::optional<std::string> path = modelPath(name);
  return path ? readFile(*path) : std::nullopt;
}

/// Files beside a real model, by the URI the model spells: modelResources("Fox/Fox.gltf", {"Fox.bin"}).
inline std::map<std::string, FileBytes> modelResources(const std::string& name, const std::vector<std::string>& uris) {
  std::map<std::string, FileBytes> resources;
  const std::size_t slash = name.rfind('/');
  const std::string directory = slash == name.npos ? "" : name.substr(0, slash + 1);
  for (const std::string& uri : uris) {
    if (std::optional<FileBytes> bytes = modelBytes(directory + uri)) resources[uri] = std::move(*bytes);
  }
  return resources;
}

}  // namespace quadmark::test
