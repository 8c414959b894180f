// SPDX-License-Identifier: MIT
// The PLY reader's model: what is needed to find the coordinates in the file again.
#pragma once

#include "ply_header.h"
#include "quadmark/io/ply.h"

namespace quadmark::io {

class PlyModel final : public Model {
 public:
  Status read(Bytes file);
  [[nodiscard]] Result<PatchedFile> patch(std::span<const std::uint8_t> file, const Resources& resources,
                                          std::span<const double> positions) const override;
  [[nodiscard]] Result<OrderFreedom> orderFreedom(std::span<const std::uint8_t> file,
                                                  const Resources& resources) const override;
  [[nodiscard]] Result<PatchedFile> reorder(std::span<const std::uint8_t> file, const Resources& resources,
                                            std::span<const std::uint32_t> order) const override;

 private:
  template <class Cursor>
  Status readBody(Bytes file);
  template <class Cursor>
  Status readVertices(Cursor& cursor, const PlyElement& element);
  template <class Cursor>
  Status readFaces(Cursor& cursor, const PlyElement& element, bool isLastElement);
  Status checkVertexElement() const;

  [[nodiscard]] Result<PatchedFile> patchBinary(Bytes file, std::span<const double> positions) const;
  [[nodiscard]] Result<PatchedFile> patchText(Bytes file, std::span<const double> positions) const;
  [[nodiscard]] Status checkPatchedText(Bytes file, Bytes patched, std::span<const double> positions) const;
  [[nodiscard]] const PlyElement& vertexElement() const { return header_.elements[vertexElement_]; }

  PlyHeader header_;
  std::size_t fileSize_ = 0;
  std::size_t vertexElement_ = 0;
  std::size_t vertexBegin_ = 0;  // byte where the vertex element's rows begin
  int axisProperty_[3] = {-1, -1, -1};
};

/// Which coordinate (0, 1, 2) a property of the vertex element is, or -1.
inline int axisOf(const int (&axisProperty)[3], std::size_t property) {
  for (int axis = 0; axis < 3; ++axis) {
    if (axisProperty[axis] == static_cast<int>(property)) return axis;
  }
  return -1;
}

}  // namespace quadmark::io
