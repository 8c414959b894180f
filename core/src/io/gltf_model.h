// SPDX-License-Identifier: MIT
// The glTF reader's model: what is needed to find the positions and their bounds in the file again.
#pragma once

#include "gltf_arrays.h"
#include "gltf_buffers.h"
#include "quadmark/io/gltf.h"

namespace quadmark::io {

class GltfModel final : public Model {
 public:
  Status read(Bytes file, const Resources& resources);
  [[nodiscard]] Result<PatchedFile> patch(std::span<const std::uint8_t> file, const Resources& resources,
                                          std::span<const double> positions) const override;
  [[nodiscard]] Result<OrderFreedom> orderFreedom(std::span<const std::uint8_t> file,
                                                  const Resources& resources) const override;
  [[nodiscard]] Result<PatchedFile> reorder(std::span<const std::uint8_t> file, const Resources& resources,
                                            std::span<const std::uint32_t> order) const override;

 private:
  /// The min and max of an accessor, to be kept true to the vertices it covers.
  struct Bounds {
    FileSpan min, max;
    std::uint32_t array = 0;
    std::uint64_t firstVertex = 0, count = 0;
  };

  Status readPositions(const std::vector<BufferBytes>& buffers);
  Status readFaces(const GltfDocument& document, const std::vector<BufferBytes>& buffers, std::uint64_t totalBytes,
                   std::uint64_t memoryLimit);
  void readGroups(const GltfDocument& document);

  GltfContainer container_;
  std::size_t fileSize_ = 0;
  std::vector<BufferPlace> buffers_;
  PositionArrays positions_;
  std::vector<Bounds> bounds_;
};

}  // namespace quadmark::io
