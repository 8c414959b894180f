// SPDX-License-Identifier: MIT
// The glTF reader's model: what is needed to find the positions and their bounds in the file again.
#pragma once

#include "gltf_arrays.h"
#include "gltf_buffers.h"
#include "gltf_texture_shift.h"
#include "json_edits.h"
#include "quadmark/io/gltf.h"

namespace quadmark::io {

class GltfModel final : public Model {
 public:
  /// @param meter  if given, measures against the positions read.
  Status read(Bytes file, const Resources& resources, TextureShiftMeter* meter = nullptr);
  [[nodiscard]] Status checkMarkable() const override {
    return positions_.conflict.empty() ? okStatus() : Status(unsupportedFile(positions_.conflict));
  }
  [[nodiscard]] Result<PatchedFile> patch(std::span<const std::uint8_t> file, const Resources& resources,
                                          std::span<const double> positions) const override;
  [[nodiscard]] Result<OrderFreedom> orderFreedom(std::span<const std::uint8_t> file,
                                                  const Resources& resources) const override;
  [[nodiscard]] Result<PatchedFile> reorder(std::span<const std::uint8_t> file, const Resources& resources,
                                            std::span<const std::uint32_t> order) const override;

 private:
  /// The min and max of an accessor, to be kept true to its elements.
  struct Bounds {
    FileSpan min, max;
    std::uint32_t window = 0;
  };
  /// What the codes of one component range over, before and after a patch.
  struct Extent {
    double low[3], high[3];
    bool empty = true;
    void include(const double (&codes)[3]);
  };

  /// Fills in which elements the values of sparse accessors replace.
  Status readReplaced(const GltfDocument& document, const std::vector<BufferBytes>& buffers);
  Status readPositions(const std::vector<BufferBytes>& buffers);
  /// @return those of each primitive, but for primitives that draw the same triangles again.
  Result<std::vector<PrimitiveFaces>> readFaces(const GltfDocument& document, const std::vector<BufferBytes>& buffers,
                                                std::uint64_t totalBytes, std::uint64_t memoryLimit);
  void readGroups(const GltfDocument& document);
  void setGrid(std::uint64_t firstVertex, std::uint64_t count, const CoordinateGrid& grid);
  [[nodiscard]] Error notFinite(std::uint64_t vertex, int axis) const;

  [[nodiscard]] Status checkPatch(std::span<const double> positions, const std::vector<BufferBytes>& buffers) const;
  [[nodiscard]] Status editBounds(Bytes file, const Bounds& bounds, std::span<const double> positions,
                                  const std::vector<BufferBytes>& buffers, const std::vector<bool>& decompressed,
                                  JsonEdits& edits) const;
  void includeElements(const PositionWindow& window, std::uint64_t begin, std::uint64_t end,
                       std::span<const double> positions, const std::vector<BufferBytes>& buffers, Extent& before,
                       Extent& after) const;

  GltfContainer container_;
  std::size_t fileSize_ = 0;
  std::vector<BufferPlace> buffers_;
  PositionArrays positions_;
  std::vector<Bounds> bounds_;
};

}  // namespace quadmark::io
