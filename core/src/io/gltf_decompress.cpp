// SPDX-License-Identifier: MIT
#include "gltf_decompress.h"

namespace quadmark::io {
namespace {

constexpr const char* kMeshoptNames[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

}  // namespace

Decompression::Decompression(GltfEdits& edits) : edits_(edits) {
  edits.root().find("bufferViews").forEachElement([&](JsonValue view) { views_.push_back(view); });
}

void Decompression::replaceView(std::uint32_t view, Bytes plain) {
  const GltfEdits::Place place = edits_.appendBytes(plain);
  JsonEdits& json = edits_.json();
  json.setMember(views_[view], "buffer", std::to_string(place.buffer));
  json.setMember(views_[view], "byteOffset", std::to_string(place.byteOffset));
  const JsonValue extensions = views_[view].find("extensions");
  bool keepsOthers = false;
  extensions.forEachMember([&](std::string_view key, JsonValue) {
    for (const char* name : kMeshoptNames) {
      if (!keyIs(key, name)) continue;
      ++decoded_[name];
      return;
    }
    keepsOthers = true;
  });
  if (keepsOthers) {
    for (const char* name : kMeshoptNames) json.removeMember(extensions, name);
  } else {
    json.removeMember(views_[view], "extensions");
  }
  replacedViews_.insert(view);
}

bool Decompression::isStillUsed(std::string_view extension) const {
  bool used = false;
  for (std::uint32_t i = 0; i < views_.size() && !used; ++i) {
    used = replacedViews_.count(i) == 0 && views_[i].find("extensions").find(extension);
  }
  // A placeholder for fallback data carries the extension too.
  edits_.root().find("buffers").forEachElement(
      [&](JsonValue buffer) { used = used || buffer.find("extensions").find(extension); });
  return used;
}

std::vector<std::string> Decompression::finish() {
  std::vector<std::string> warnings;
  for (const auto& decoded : decoded_) {
    const std::string& extension = decoded.first;
    const std::uint64_t count = decoded.second;
    warnings.push_back("the data of " + std::to_string(count) + " bufferView" + (count == 1 ? "" : "s") +
                       " with marked positions is plain now, no longer compressed by " + extension +
                       "; compress the marked file anew if its size matters, with as many bits as before");
    if (isStillUsed(extension)) continue;
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      const JsonValue names = edits_.root().find(list);
      std::vector<std::size_t> found;
      std::size_t index = 0;
      names.forEachElement([&](JsonValue name) {
        if (name.asString() == extension) found.push_back(index);
        ++index;
      });
      if (found.empty()) continue;
      if (found.size() == index) {
        edits_.json().removeMember(edits_.root(), list);  // an empty list is not allowed
      } else {
        for (const std::size_t i : found) edits_.json().removeElement(names, i);
      }
    }
  }
  return warnings;
}

}  // namespace quadmark::io
