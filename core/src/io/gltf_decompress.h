// SPDX-License-Identifier: MIT
// Compressed data replaced by plain data appended to the file, as marking it demands.
#pragma once

#include <map>
#include <set>

#include "gltf_edits.h"

namespace quadmark::io {

class Decompression {
 public:
  /// @param edits  must outlive the object.
  explicit Decompression(GltfEdits& edits);

  /// Lets a view compressed by EXT_meshopt_compression or KHR_meshopt_compression refer to plain bytes instead; all
  /// accessors in it stay as they are. The compressed bytes stay in the file, unused.
  void replaceView(std::uint32_t view, Bytes plain);

  /// To be called once after all replacements: takes extensions back that nothing uses any more.
  /// @return a warning per extension that data was decoded from.
  std::vector<std::string> finish();

 private:
  [[nodiscard]] bool isStillUsed(std::string_view extension) const;

  GltfEdits& edits_;
  std::vector<JsonValue> views_;
  std::set<std::uint32_t> replacedViews_;
  std::map<std::string, std::uint64_t> decoded_;  // extension -> how many views lost it
};

}  // namespace quadmark::io
