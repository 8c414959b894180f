// SPDX-License-Identifier: MIT
// Mesh: the interchange structure between files, attacks, metrics and the watermarking scheme.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "quadmark/result.h"

namespace quadmark {

/// How the file stores one coordinate. Decides the rounding that a mark must survive.
enum class Precision : std::uint8_t { float32, float64 };

/// A polygon soup with shared vertices, in the file's own units and order.
///
/// Example, one quad and one triangle over five vertices:
///   positions    = { x0 y0 z0, x1 y1 z1, ... }            15 numbers
///   faceOffsets  = { 0, 4, 7 }                            faces + 1 numbers
///   faceVertices = { 0 1 2 3,  1 4 2 }                    corner -> vertex index
/// A pure triangle mesh leaves faceOffsets empty: face f then owns corners 3f, 3f+1, 3f+2. No face has fewer than 3 corners.
///
/// Nothing is assumed about manifoldness, orientation or duplicates. Vertices no face refers to are allowed.
struct Mesh {
  std::vector<double> positions;            ///< 3 per vertex (x, y, z), finite
  std::vector<std::uint32_t> faceOffsets;   ///< empty (all triangles) or faces + 1 ascending corner offsets
  std::vector<std::uint32_t> faceVertices;  ///< vertex index per corner, each < vertexCount()
  /// Seam group per vertex: vertices with bit-equal positions are twins only inside one group (in glTF: one mesh).
  /// Empty means that all vertices are of one group.
  std::vector<std::uint32_t> groups;
  Precision precision = Precision::float32;

  [[nodiscard]] std::size_t vertexCount() const { return positions.size() / 3; }
  [[nodiscard]] std::size_t faceCount() const {
    return faceOffsets.empty() ? faceVertices.size() / 3 : faceOffsets.size() - 1;
  }
  [[nodiscard]] std::size_t faceBegin(std::size_t face) const {
    return faceOffsets.empty() ? 3 * face : faceOffsets[face];
  }
  [[nodiscard]] std::size_t faceEnd(std::size_t face) const {
    return faceOffsets.empty() ? 3 * face + 3 : faceOffsets[face + 1];
  }
};

/// Progress of long work on a mesh: stage name and share done; return false to cancel (the work fails with `aborted`).
using MeshProgress = std::function<bool(const char* stage, double done)>;

/// Checks every invariant stated at Mesh. Fails with badMesh and the first offending index. Cost: one pass.
[[nodiscard]] Status validate(const Mesh& mesh);

/// Bounding-box diagonal of the vertices that faces refer to, in file units; 0 for none.
[[nodiscard]] double boundingDiagonal(const Mesh& mesh);

/// The float32 nearest to x, as a double. Always round through this: g++ 12 at -O2 vectorises the plain conversion
/// double -> float -> double of three neighbouring coordinates and loses it for two of them (the volatile stops that).
[[nodiscard]] inline double nearestFloat32(double x) {
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}

/// Rounds every coordinate to the mesh's own precision (nearest float32; nothing for float64).
void roundToPrecision(Mesh& mesh);

}  // namespace quadmark
