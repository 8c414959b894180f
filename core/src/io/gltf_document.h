// SPDX-License-Identifier: MIT
// The parts of a glTF document that positions depend on: buffers, views, accessors, triangle primitives, nodes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bytes.h"
#include "gltf_components.h"
#include "json_text.h"
#include "meshopt.h"

namespace quadmark::io {

inline constexpr std::uint32_t kNone = 0xffffffff;
inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// A range of the file's bytes.
struct FileSpan {
  std::size_t begin = 0, end = 0;
  [[nodiscard]] bool empty() const { return begin == end; }
};

/// What EXT_meshopt_compression or KHR_meshopt_compression says about a bufferView.
struct MeshoptSource {
  std::uint32_t view = 0;  ///< the view that it decodes to
  std::uint32_t buffer = 0;
  std::uint64_t byteOffset = 0, byteLength = 0;  ///< of the stream in that buffer
  MeshoptLayout layout;
};

struct GltfBuffer {
  std::uint64_t byteLength = 0;
  bool hasUri = false;  ///< without: the GLB's BIN chunk if it is buffer 0, else no data
  FileSpan uri;         ///< as spelled between the quotes
  /// Set for a buffer that is none of the file's but stands for a decoded view. Decoded buffers follow the file's own.
  std::optional<MeshoptSource> meshopt;
};

struct GltfView {
  std::uint32_t buffer = kNone;  ///< kNone also for a view that is broken but that no position needs
  std::uint64_t byteOffset = 0, byteLength = 0;
  std::uint32_t byteStride = 0;  ///< 0: tightly packed
  std::string compression;       ///< name of the extension that compresses it, or empty; if needed, it is decoded
  bool needed = false;           ///< by triangles: then it is flawless
};

/// Elements that replace some of an accessor's: both arrays are tightly packed.
struct GltfSparse {
  std::uint64_t count = 0;
  std::uint32_t indicesView = kNone, valuesView = kNone;
  std::uint64_t indicesOffset = 0, valuesOffset = 0;  ///< in their views
  std::uint32_t indicesType = 0;
};

struct GltfAccessor {
  std::uint32_t view = kNone;  ///< kNone: zeros, where nothing is sparse
  std::uint64_t byteOffset = 0, count = 0;
  std::uint32_t componentType = 0, components = 0;
  bool normalized = false;
  std::optional<GltfSparse> sparse;
  bool needed = false;         ///< by triangles (positions or indices): then it is flawless
  bool usedOtherwise = false;  ///< by anything but POSITION of a primitive
  FileSpan min, max;           ///< the arrays' text

  [[nodiscard]] std::uint32_t elementBytes() const;
};

/// What KHR_draco_mesh_compression says about a primitive.
struct GltfDraco {
  std::uint32_t view = kNone;
  std::uint32_t position = 0;  ///< unique id of the positions in the stream
};

struct GltfPrimitive {
  std::uint32_t mesh = 0, index = 0;  ///< "mesh 2 primitive 0"
  std::uint32_t position = kNone, indices = kNone;
  std::uint32_t mode = 4;
  /// If set for triangles, position and indices declare what the stream holds; decodeDracoPrimitives() replaces them.
  std::optional<GltfDraco> draco;
  std::uint32_t material = kNone;  ///< these two only in documents with textures
  std::array<std::uint32_t, 4> textureCoordinates{kNone, kNone, kNone, kNone};  ///< accessor of each TEXCOORD_n

  [[nodiscard]] bool hasTriangles() const { return mode >= 4 && mode <= 6; }
  [[nodiscard]] std::string place() const;
};

struct GltfNode {
  std::uint32_t node = 0, mesh = 0;
  std::string name;
};

struct GltfDocument {
  std::string version;
  std::vector<GltfBuffer> buffers;
  std::vector<GltfView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfPrimitive> primitives;  ///< with a POSITION, in file order
  std::vector<GltfNode> nodes;            ///< with a mesh
  std::vector<std::uint32_t> imageViews;  ///< buffer views that hold images
  bool withTextures = false;  ///< whether texture coordinates are needed and the next three, elements of the JSON text,
                              ///< are there
  std::vector<JsonValue> materials, textures, images;
  std::uint64_t meshCount = 0, nodeCount = 0, primitiveCount = 0;
  std::vector<std::string> extensionsUsed;
  std::vector<std::string> warnings;

  /// Adds a warning, up to a limit that a hostile file cannot exceed.
  void warn(std::string text);
};

/// Components of an accessor's type such as "VEC3"; 0 for unknown ones.
std::uint32_t componentsOfType(std::string_view type);

/// A mode's name for messages.
const char* primitiveModeName(std::uint32_t mode);

/// Reads the document. What positions do not need may be broken; what they need is checked, in 64 bit:
/// types, ranges, references, views inside buffers, accessors inside views, and that this version can handle it.
/// @param jsonBegin  where the JSON text begins in the file, so that spans are the file's.
/// @param withTextures  reads texture coordinates of triangles, too, and keeps the JSON of what shows them.
/// Fails with badFile, unsupportedFile or tooLarge, naming the place.
Result<GltfDocument> readGltfDocument(std::string_view json, std::size_t jsonBegin, bool withTextures = false);

}  // namespace quadmark::io
