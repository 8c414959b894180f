// SPDX-License-Identifier: MIT
#include "gltf_sparse.h"

#include "concat.h"

namespace quadmark::io {
namespace {

const std::uint8_t* bytesAt(const GltfDocument& document, const std::vector<BufferBytes>& buffers, std::uint32_t view,
                            std::uint64_t offset) {
  return buffers[document.views[view].buffer].bytes.data() + document.views[view].byteOffset + offset;
}

}  // namespace

Result<std::vector<std::uint32_t>> readSparseIndices(const GltfDocument& document, std::uint32_t accessor,
                                                     const std::vector<BufferBytes>& buffers) {
  const std::uint64_t count = document.accessors[accessor].count;
  const GltfSparse& sparse = *document.accessors[accessor].sparse;
  const std::uint8_t* bytes = bytesAt(document, buffers, sparse.indicesView, sparse.indicesOffset);
  const std::uint32_t width = componentBytes(sparse.indicesType);
  std::vector<std::uint32_t> replaced;
  replaced.reserve(static_cast<std::size_t>(sparse.count));
  for (std::uint64_t i = 0; i < sparse.count; ++i) {
    const std::uint32_t index = width == 1   ? load<std::uint8_t>(bytes + i)
                                : width == 2 ? load<std::uint16_t>(bytes + 2 * i)
                                             : load<std::uint32_t>(bytes + 4 * i);
    if (index >= count || (i > 0 && index <= replaced.back())) {
      return badFile(concat("accessor ", accessor, " sparse.indices: ", index, " at position ", i,
                            " is not ascending or exceeds ", count, " elements"));
    }
    replaced.push_back(index);
  }
  return replaced;
}

Result<std::vector<std::uint8_t>> assembleSparse(const GltfDocument& document, std::uint32_t accessor,
                                                 const std::vector<BufferBytes>& buffers) {
  const GltfAccessor& source = document.accessors[accessor];
  const std::size_t width = source.elementBytes();
  std::vector<std::uint8_t> elements(static_cast<std::size_t>(source.count) * width);
  if (source.view != kNone) {
    std::memcpy(elements.data(), bytesAt(document, buffers, source.view, source.byteOffset), elements.size());
  }
  if (!source.sparse) return elements;
  const Result<std::vector<std::uint32_t>> replaced = readSparseIndices(document, accessor, buffers);
  if (!replaced) return replaced.error();
  const std::uint8_t* value = bytesAt(document, buffers, source.sparse->valuesView, source.sparse->valuesOffset);
  for (const std::uint32_t element : *replaced) {
    std::memcpy(&elements[element * width], value, width);
    value += width;
  }
  return elements;
}

}  // namespace quadmark::io
