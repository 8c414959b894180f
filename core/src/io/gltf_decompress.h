// SPDX-License-Identifier: MIT
// Compressed data replaced by plain data appended to the file, as marking it demands.
#pragma once

#include <map>
#include <set>

#include "gltf_buffers.h"
#include "gltf_edits.h"

namespace quadmark::io {

class Decompression {
 public:
  /// @param edits  must outlive the object.
  explicit Decompression(GltfEdits& edits);

  /// Lets a view compressed by EXT_meshopt_compression or KHR_meshopt_compression refer to plain bytes instead. All
  /// accessors in it stay as they are but for bounds that are not true of those bytes. The compressed bytes stay in the
  /// file, unused.
  void replaceView(std::uint32_t view, Bytes plain);

  /// Lets the primitives drawn from a Draco stream refer to plain accessors instead: the given positions, and the
  /// stream's other attributes and indices. What they referred to before stays in the file, unused.
  /// @param bytes      of the stream.
  /// @param positions  one packed element per point.
  /// Fails as decodeDraco(), or with unsupportedFile where the primitives disagree about the stream.
  Status replaceStream(const DracoStream& stream, Bytes bytes, Bytes positions, std::uint64_t memoryLimit);

  /// To be called once after all replacements: takes extensions back that nothing uses any more.
  /// @return a warning per extension that data was decoded from.
  std::vector<std::string> finish();

 private:
  /// An attribute of a Draco stream, and how its accessor spells what it becomes.
  struct Column {
    std::string name;
    DracoAttribute attribute;
    std::string type, normalized;  // as spelled; normalized may be empty
  };
  Result<std::vector<Column>> columnsOf(const std::vector<JsonValue>& primitives, const DracoStream& stream) const;
  std::string appendAccessor(Bytes packed, std::uint32_t elementBytes, std::uint32_t componentType,
                             const std::string& members);
  void correctBounds(JsonValue accessor, std::uint32_t view, Bytes plain);
  void removeExtension(JsonValue owner, std::initializer_list<const char*> names);
  [[nodiscard]] bool isStillUsed(std::string_view extension) const;

  GltfEdits& edits_;
  std::vector<JsonValue> views_, accessors_;
  std::vector<JsonValue> dracoPrimitives_;
  std::set<std::uint32_t> replacedViews_;
  std::map<std::string, std::uint64_t> decoded_;  // extension -> how many views or primitives lost it
};

}  // namespace quadmark::io
