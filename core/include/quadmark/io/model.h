// SPDX-License-Identifier: MIT
// Model: a user's file as bytes plus the mesh it describes, and the way back: patching positions in the original bytes.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/result.h"

namespace quadmark {

enum class FileFormat : std::uint8_t { ply, gltf, glb };

/// "ply", "gltf" or "glb".
[[nodiscard]] const char* fileFormatName(FileFormat format);

/// External files by the URI exactly as the glTF spells it (percent-decoded forms are tried too). The core never
/// opens files or follows URLs: whatever a model refers to must be here.
using Resources = std::map<std::string, std::vector<std::uint8_t>>;

/// Result of patching: the rewritten main file and those resources that changed (external .bin buffers).
struct PatchedFile {
  std::vector<std::uint8_t> bytes;
  Resources resources;             ///< only the changed ones, by the same URI
  /// Bytes that differ from the input, main file and resources together; where a number's text got longer or shorter,
  /// the difference in length counts too.
  std::uint64_t bytesChanged = 0;
};

/// Facts about the file for reports, each a plain sentence fragment or number.
struct ModelInfo {
  FileFormat format = FileFormat::ply;
  std::string variant;                      ///< "ascii 1.0", "binary_little_endian 1.0", "glTF 2.0"
  std::uint32_t meshes = 0, primitives = 0, nodes = 0;
  std::vector<std::string> extensionsUsed;  ///< glTF only, file order
  std::vector<std::string> warnings;        ///< e.g. "mesh 2 primitive 0: POINTS are passed through"
};

/// A parsed model. Owns no copy of the input bytes; patch() is given them again.
class Model {
 public:
  virtual ~Model() = default;

  /// All triangles and polygons of the file in local (accessor) space. A position stored once is one vertex, however
  /// many primitives, meshes or nodes use it. Mesh::groups numbers the glTF meshes (meshes that share a POSITION
  /// accessor are one group).
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] Mesh& mesh() { return mesh_; }
  [[nodiscard]] const ModelInfo& info() const { return info_; }

  /// For each vertex of mesh() the glTF mesh index it is drawn by (the lowest when shared); empty for PLY.
  [[nodiscard]] const std::vector<std::uint32_t>& vertexMesh() const { return vertexMesh_; }

  /// Names of the glTF nodes that instantiate each glTF mesh: (node index, name, mesh index); empty for PLY.
  struct NodeRef { std::uint32_t node; std::string name; std::uint32_t mesh; };
  [[nodiscard]] const std::vector<NodeRef>& nodes() const { return nodes_; }

  /// Writes new positions into a copy of the original bytes; nothing outside position components and (glTF) the text
  /// of those accessors' min / max changes. A component whose value is unchanged keeps its bytes, in text files its
  /// spelling too.
  /// @param file, resources  the same bytes that were read.
  /// @param positions        3 per vertex of mesh(), already representable in the file's precision.
  /// @return the new file. Fails with badOption (positions of another number or precision, or not the bytes that were
  ///         read), unsupportedFile (positions share bytes with other data; info().warnings already says so) or
  ///         internal (the self-check found a difference outside the allowed spans).
  [[nodiscard]] virtual Result<PatchedFile> patch(std::span<const std::uint8_t> file, const Resources& resources,
                                                  std::span<const double> positions) const = 0;

 protected:
  Mesh mesh_;
  ModelInfo info_;
  std::vector<std::uint32_t> vertexMesh_;
  std::vector<NodeRef> nodes_;
};

/// Reads a model of any supported format, found by content, never by name.
/// Fails with badFile (wrong magic, truncated, lying counts; the message names the place such as
/// "accessor 3: byteOffset 412 exceeds bufferView 1 (400 bytes)"), unsupportedFile (valid but not handled yet),
/// badMesh (no triangles, NaN or infinite position: names the vertex), tooLarge.
/// Allocates no more than a small multiple of the input's size, whatever the file claims. Parts that positions do not
/// depend on may be broken. Bytes behind the file's proper end are ignored with a warning: viewers ignore them too, so
/// they must not hide a mark.
[[nodiscard]] Result<std::unique_ptr<Model>> readModel(std::span<const std::uint8_t> file, const Resources& resources = {});

/// The URIs of external buffers a glTF refers to (not images), so that a caller can fetch them before readModel().
/// Empty for GLB without external buffers and for PLY; fails with badFile on broken JSON.
[[nodiscard]] Result<std::vector<std::string>> externalUris(std::span<const std::uint8_t> file);

}  // namespace quadmark
