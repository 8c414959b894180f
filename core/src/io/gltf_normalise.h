// SPDX-License-Identifier: MIT
// tinygltf as the reader of the document model, fed with a normalised text only.
#pragma once

#include "gltf_document.h"

namespace quadmark::io {

/// Writes the needed views and accessors and the primitives with POSITION as a small glTF text of checked integers,
/// lets tinygltf load it and takes the numbers back from its model.
///
/// Why not the user's text: tinygltf 2.7 truncates integers to 32 bits, dereferences buffers it has not checked,
/// refuses whole files for flaws in parts that positions do not depend on (Draco, meshopt, images), and takes about
/// 400 bytes per entry of any kind. It gets no buffers, images, extensions or names.
/// Fails with `internal` when the two readers disagree, else tooLarge.
Status loadThroughTinygltf(GltfDocument& document);

}  // namespace quadmark::io
