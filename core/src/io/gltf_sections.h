// SPDX-License-Identifier: MIT
// The root members of a glTF JSON text that the reader looks at, and the uses of accessors outside geometry.
#pragma once

#include "gltf_document.h"
#include "json_text.h"

namespace quadmark::io {

struct GltfSections {
  std::string_view text;      ///< the whole JSON text
  std::size_t textBegin = 0;  ///< where it begins in the file
  JsonValue asset, buffers, bufferViews, accessors, meshes, nodes, materials, textures, images, skins, animations,
      extensionsUsed;
};

/// Finds all of them in one pass; what is missing is absent.
GltfSections findSections(JsonValue root, std::string_view text, std::size_t textBegin);

/// Sets usedOtherwise for accessors that are read as anything but a primitive's POSITION (indices, normals, morph
/// targets, skins, animations, instancing), and lists the views of images. Broken references are ignored.
void markOtherUses(const GltfSections& sections, GltfDocument& document);

}  // namespace quadmark::io
