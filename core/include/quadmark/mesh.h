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

/// Coordinates that a file stores as integers (KHR_mesh_quantization): a coordinate is code / divisor, code an integer.
struct CoordinateGrid {
  double divisor = 1;        ///< 1, or 127, 255, 32767 or 65535 where the file normalizes
  double low = 0, high = 0;  ///< least and largest code; equal: the coordinate is not stored and cannot change

  [[nodiscard]] double step() const { return 1 / divisor; }
  [[nodiscard]] bool operator==(const CoordinateGrid& other) const = default;
};

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
  Precision precision = Precision::float32;  ///< of the vertices without a grid
  std::vector<CoordinateGrid> grids;         ///< at most 250
  /// Per vertex: 0 for `precision`, i for grids[i - 1]. Empty means that no vertex has a grid.
  std::vector<std::uint8_t> gridOf;

  [[nodiscard]] const CoordinateGrid* grid(std::size_t vertex) const {
    return gridOf.empty() || gridOf[vertex] == 0 ? nullptr : &grids[gridOf[vertex] - 1u];
  }
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

/// The coordinate on the grid that is nearest to x (ties away from the grid's lower end), clamped to the grid's range.
[[nodiscard]] double nearestOnGrid(const CoordinateGrid& grid, double x);

/// Rounds every coordinate to what its vertex can store: nearest on its grid, nearest float32, or itself for float64.
void roundToPrecision(Mesh& mesh);

}  // namespace quadmark
