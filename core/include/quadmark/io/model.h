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

enum class FileFormat : std::uint8_t { ply, gltf, glb, drc };

/// "ply", "gltf", "glb" or "drc".
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
  std::vector<std::string> warnings;  ///< what had to be changed besides positions, as sentences
};

/// Facts about the file for reports, each a plain sentence fragment or number.
struct ModelInfo {
  FileFormat format = FileFormat::ply;
  std::string variant;                      ///< "ascii 1.0", "binary_little_endian 1.0", "glTF 2.0", "Draco 2.2"
  std::uint32_t meshes = 0, primitives = 0, nodes = 0;
  std::vector<std::string> extensionsUsed;  ///< glTF only, file order
  std::vector<std::string> warnings;        ///< e.g. "mesh 2 primitive 0: POINTS are passed through"
};

/// A run of vertices of mesh() that the file stores as one array.
struct VertexRange {
  std::uint32_t first = 0, count = 0;
};

/// Which vertices of a file may change places.
struct OrderFreedom {
  std::vector<VertexRange> ranges;    ///< ascending and disjoint; inside each of them any order is possible
  std::vector<std::string> warnings;  ///< arrays whose order is fixed, and references that cannot be followed
};

/// A parsed model. Owns no copy of the input bytes; patch() is given them again.
class Model {
 public:
  virtual ~Model() = default;

  /// All triangles and polygons of the file in local (accessor) space, integers dequantized, sparse values in their
  /// places. A position stored once is one vertex, however many primitives, meshes or nodes use it. Mesh::groups numbers the glTF meshes (meshes that share a POSITION
  /// accessor are one group).
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] Mesh& mesh() { return mesh_; }
  [[nodiscard]] const ModelInfo& info() const { return info_; }

  /// Whether patch() can write into this file at all; fails with unsupportedFile and the reason.
  [[nodiscard]] virtual Status checkMarkable() const { return okStatus(); }

  /// For each vertex of mesh() the glTF mesh index it is drawn by (the lowest when shared); empty for other formats.
  [[nodiscard]] const std::vector<std::uint32_t>& vertexMesh() const { return vertexMesh_; }

  /// Names of the glTF nodes that instantiate each glTF mesh: (node index, name, mesh index); empty for other formats.
  struct NodeRef { std::uint32_t node; std::string name; std::uint32_t mesh; };
  [[nodiscard]] const std::vector<NodeRef>& nodes() const { return nodes_; }

  /// Writes new positions into a copy of the original bytes; nothing outside position components and (glTF) the text
  /// of those accessors' min / max changes. A component whose value is unchanged keeps its bytes, in text files its
  /// spelling too. Compressed glTF positions that change become plain data appended to the file, which the warnings say.
  /// @param file, resources  the same bytes that were read.
  /// @param positions        3 per vertex of mesh(), already representable as roundToPrecision() has it.
  /// @return the new file. Fails with badOption (positions of another number or precision, or not the bytes that were
  ///         read), unsupportedFile (positions share bytes with other data; info().warnings already says so) or
  ///         internal (the self-check found a difference outside the allowed spans).
  [[nodiscard]] virtual Result<PatchedFile> patch(std::span<const std::uint8_t> file, const Resources& resources,
                                                  std::span<const double> positions) const = 0;

  /// Which vertices reorder() can exchange. PLY: all of them, one range. glTF: a range per array of positions that only
  /// indexed primitives draw, whose other attributes and morph targets (as many elements each, neither sparse nor
  /// compressed) and indices serve no other array; the rest is named in the warnings.
  /// @param file, resources  the same bytes that were read.
  [[nodiscard]] virtual Result<OrderFreedom> orderFreedom(std::span<const std::uint8_t> file,
                                                          const Resources& resources) const = 0;

  /// Changes the order in which the file stores its vertices: moves their records (all attributes of a vertex together)
  /// and rewrites the indices to them, so that every face has the same corners as before. All other bytes stay; a
  /// record keeps its spelling, an index its width. Text around records stays in place. In glTF the min / max of
  /// index accessors follow.
  /// @param file, resources  the same bytes that were read; mesh() must be as read, too.
  /// @param order            for each vertex of mesh() after the call, the vertex it was before: a permutation that
  ///                         leaves every range of orderFreedom(), and every vertex outside of them, in its place.
  /// @return the new file with bytesChanged counted against `file`; badOption for any other `order`; `internal` if
  ///         the result does not read back as the same faces.
  [[nodiscard]] virtual Result<PatchedFile> reorder(std::span<const std::uint8_t> file, const Resources& resources,
                                                    std::span<const std::uint32_t> order) const = 0;

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

/// Bytes that differ between a file and another version of it, main file and resources together. Binary parts are
/// compared byte by byte, texts (ascii PLY, JSON) word by word, so that a word that grew does not count what follows.
[[nodiscard]] std::uint64_t countChangedBytes(std::span<const std::uint8_t> file, const Resources& resources,
                                              const PatchedFile& after);

/// The URIs of external buffers a glTF refers to (not images), so that a caller can fetch them before readModel().
/// Empty for GLB without external buffers and for PLY; fails with badFile on broken JSON.
[[nodiscard]] Result<std::vector<std::string>> externalUris(std::span<const std::uint8_t> file);

}  // namespace quadmark
