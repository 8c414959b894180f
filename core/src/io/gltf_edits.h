// SPDX-License-Identifier: MIT
// A glTF or GLB with edits of its JSON text and new data at its end, everything else being as it was.
#pragma once

#include "gltf_container.h"
#include "gltf_document.h"
#include "json_edits.h"

namespace quadmark::io {

/// The file's text at a span.
std::string_view textAt(Bytes file, FileSpan span);

/// What the whole file became.
struct AssembledGltf {
  std::vector<std::uint8_t> bytes;
  std::size_t binBegin = 0;  ///< where the content of the GLB's BIN chunk begins now; 0 without one
  std::uint64_t bytesChanged = 0;
};

/// Collects edits of one file. Nothing moves but what lies behind an edit in the file: chunks, even unknown ones,
/// padding and bytes behind a GLB's end stay as they are, and so do the caller's resources.
///
/// New data goes to the end of a GLB's BIN chunk, 4-byte aligned; a GLB without buffers gets a BIN chunk. Where there
/// can be none (.gltf, or a GLB whose first buffer is another file) it goes to one new buffer with a data: URI.
class GltfEdits {
 public:
  /// @param file, container  as read; both must outlive the object. Fails with badFile if the JSON text is broken.
  static Result<GltfEdits> of(Bytes file, const GltfContainer& container);

  [[nodiscard]] JsonValue root() const { return root_; }
  [[nodiscard]] JsonEdits& json() { return json_; }
  void replace(FileSpan span, std::string by) { json_.replace(textAt(file_, span), std::move(by)); }

  /// Where data went: as a bufferView has to say it.
  struct Place {
    std::uint32_t buffer = 0;
    std::uint64_t byteOffset = 0;
  };
  Place appendBytes(Bytes bytes);

  /// Appends data together with a bufferView over it, and returns the view's index.
  /// @param byteStride  0: none is stated (tightly packed).
  /// @param target      34962 vertices, 34963 indices, 0: none is stated.
  std::uint32_t appendView(Bytes bytes, std::uint32_t byteStride, std::uint32_t target);

  /// Adds an accessor, spelled as a JSON object, and returns its index.
  std::uint32_t addAccessor(std::string json);

  /// The file with all edits; to be called once. The self-check compares everything outside the JSON text.
  /// Fails with `internal` (edits overlap or break the text) or tooLarge (a GLB beyond 4 GiB).
  Result<AssembledGltf> assemble();

 private:
  GltfEdits(Bytes file, const GltfContainer& container, JsonValue root);
  void declareAppended();
  void appendGlb(const std::string& json, AssembledGltf& out) const;
  [[nodiscard]] Status check(const AssembledGltf& out) const;

  Bytes file_;
  const GltfContainer* container_;
  JsonValue root_;
  JsonEdits json_;
  std::vector<std::uint8_t> appended_;
  std::vector<std::string> views_, accessors_;  // new ones, spelled
  std::uint64_t bufferCount_ = 0, viewCount_ = 0, accessorCount_ = 0;
  bool appendsToBin_ = false;
};

}  // namespace quadmark::io
