// SPDX-License-Identifier: MIT
// How far surfaces slid under their textures. Read with a model, since it needs what the reader lets go again.
#pragma once

#include "gltf_arrays.h"
#include "gltf_buffers.h"
#include "quadmark/io/gltf.h"

namespace quadmark::io {

/// The corners of a primitive in Mesh::faceVertices, three per triangle.
struct PrimitiveFaces {
  const GltfPrimitive* primitive = nullptr;  ///< the first that draws these triangles
  std::size_t begin = 0, end = 0;
};

/// Compares a model with the same model before.
class TextureShiftMeter {
 public:
  /// @param before  3 per vertex; must outlive the meter.
  explicit TextureShiftMeter(const std::vector<double>& before) : before_(before) {}

  /// @param document  read with its textures.
  /// Leaves out primitives with sparse positions, and those that draw another one's triangles again.
  void measure(const GltfDocument& document, const Resources& resources, const std::vector<BufferBytes>& buffers,
               const PositionArrays& positions, const Mesh& after, const std::vector<PrimitiveFaces>& faces);

  /// Nothing where no texture was found.
  [[nodiscard]] const std::optional<TextureShift>& shift() const { return shift_; }

 private:
  void take(const GltfPrimitive& primitive, double distance, bool inTexels);

  const std::vector<double>& before_;
  std::optional<TextureShift> shift_;
};

}  // namespace quadmark::io
