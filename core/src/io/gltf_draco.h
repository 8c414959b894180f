// SPDX-License-Identifier: MIT
// Primitives compressed by KHR_draco_mesh_compression, as plain accessors over decoded buffers.
#pragma once

#include "gltf_buffers.h"
#include "gltf_document.h"

namespace quadmark::io {

/// Decodes the triangles of such primitives. Each stream becomes two buffers, two views and two accessors behind those
/// of the file, tightly packed, which its primitives then refer to as if they had never been compressed.
/// @param places, buffers  one per buffer of the document, opened; they grow with it.
/// Fails as decodeDraco(), or with badFile / unsupportedFile for what the extension says, naming the primitive.
Status decodeDracoPrimitives(GltfDocument& document, std::vector<BufferPlace>& places,
                             std::vector<BufferBytes>& buffers, std::uint64_t memoryLimit);

}  // namespace quadmark::io
