// SPDX-License-Identifier: MIT
// What both layers see of a mesh: welded faces without degenerate ones, ordered one-rings, the edge tensor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "quadmark/adjacency.h"
#include "quadmark/mesh.h"
#include "quadmark/vec3.h"

namespace quadmark::robust {

/// Rings of fewer or more vertices carry nothing.
inline constexpr std::uint32_t kMinRing = 3, kMaxRing = 24;

struct Surface {
  WeldedMesh welded;                        ///< without edges
  std::vector<std::uint32_t> faceOffsets;   ///< faces + 1 corner offsets
  std::vector<std::uint32_t> corners;       ///< welded vertex per corner; no corner equals its successor
  std::vector<std::uint32_t> ringOffsets;   ///< welded vertices + 1
  std::vector<std::uint32_t> rings;         ///< edge neighbours in cyclic order; none where the fan is not closed
  std::vector<std::uint32_t> cornerCounts;  ///< per welded vertex: face corners at it, plus 32 per side beyond three

  [[nodiscard]] std::uint32_t vertexCount() const { return welded.vertexCount(); }
  [[nodiscard]] std::uint32_t faceCount() const { return static_cast<std::uint32_t>(faceOffsets.size() - 1); }
  [[nodiscard]] std::span<const std::uint32_t> face(std::uint32_t f) const {
    return {corners.data() + faceOffsets[f], faceOffsets[f + 1] - faceOffsets[f]};
  }
  /// Closed manifold fan of kMinRing..kMaxRing neighbours in the sense in which the faces wind, or empty. Which one is
  /// first depends on the file's order.
  [[nodiscard]] std::span<const std::uint32_t> ring(std::uint32_t vertex) const {
    return {rings.data() + ringOffsets[vertex], ringOffsets[vertex + 1] - ringOffsets[vertex]};
  }
};

/// @param mesh  must validate(). Cost: linear.
[[nodiscard]] Surface makeSurface(const Mesh& mesh);

/// Frees rings and corner counts; ring() may not be called until they are remembered.
void forgetRings(Surface& surface);
void rememberRings(Surface& surface);

/// Reverses the winding of all faces and rings: as the mesh would be after mirroring and mending its winding.
void turnOver(Surface& surface);

/// The faces around each welded vertex.
class FacesAround {
 public:
  explicit FacesAround(const Surface& surface);
  /// Ascending; a face that meets the vertex twice is listed twice.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t vertex) const {
    return {faces_.data() + offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]};
  }

 private:
  std::vector<std::uint32_t> offsets_, faces_;
};

/// Twice the area vector of a face (Newell's, for polygons).
[[nodiscard]] Vec3 areaVector(std::span<const std::uint32_t> face, const std::vector<double>& positions);

/// Length of the part of a vertex's displacement that lies along the surface before it: by so much its texture swims.
[[nodiscard]] double slideOf(const Vec3& move, const Vec3& normal);

/// Largest side of the bounding box of the welded vertices; 0 for none.
[[nodiscard]] double largestExtent(std::span<const double> positions);

/// Symmetric 3 x 3 matrix.
struct SymmetricTensor {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  [[nodiscard]] Vec3 times(const Vec3& v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
};

/// Sum of e e^T over the directed edges of all faces. Under an affine map A it becomes A M A^T, so M n, for n normal to
/// a plane, turns with the surface as no Euclidean normal does.
[[nodiscard]] SymmetricTensor edgeTensor(const Surface& surface, const std::vector<double>& positions);

/// Positions before `lambda` of umbrella smoothing in all: steps of x -= 0.03 (mean of neighbours - x). Vertices
/// without a ring stay, as smoothing tools hold borders.
[[nodiscard]] std::vector<double> sharpened(const Surface& surface, double lambda);

}  // namespace quadmark::robust
