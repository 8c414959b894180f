// SPDX-License-Identifier: MIT
// Sparse accessors: elements that replace some of another array's, or some of zeros.
#pragma once

#include "gltf_buffers.h"
#include "gltf_document.h"

namespace quadmark::io {

/// Which elements of an accessor its sparse part replaces, ascending.
/// @param accessor  of a checked document, with a sparse part whose buffers are open.
/// Fails with badFile when they do not ascend or exceed the accessor.
Result<std::vector<std::uint32_t>> readSparseIndices(const GltfDocument& document, std::uint32_t accessor,
                                                     const std::vector<BufferBytes>& buffers);

/// All elements of an accessor, packed: those of its view, or zeros without one, with the sparse part in their places.
/// @param accessor  of a checked document; its view is packed, and its count is one that memory may be taken for.
/// Fails as readSparseIndices().
Result<std::vector<std::uint8_t>> assembleSparse(const GltfDocument& document, std::uint32_t accessor,
                                                 const std::vector<BufferBytes>& buffers);

}  // namespace quadmark::io
