// SPDX-License-Identifier: MIT
// Parts that several attacks share.
#pragma once

#include <cstdint>
#include <vector>

#include "quadmark/adjacency.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/mesh.h"
#include "quadmark/vec3.h"

namespace quadmark::lab {

/// Axis-aligned box of the welded vertices; all zero when there are none.
struct Box {
  Vec3 low, high;
  [[nodiscard]] Vec3 size() const { return high - low; }
  [[nodiscard]] Vec3 centre() const { return 0.5 * (low + high); }
};
[[nodiscard]] Box boxOf(const std::vector<double>& positions);

/// Gives every mesh vertex the position of its welded vertex and rounds to the mesh's precision. Vertices no face uses
/// stay.
void putWelded(Mesh& mesh, const WeldedMesh& welded, const std::vector<double>& weldedPositions);

/// The vertices with a nonzero mark, in their order, and the faces all of whose vertices are marked.
[[nodiscard]] Mesh keepVertices(const Mesh& mesh, const std::vector<std::uint8_t>& marked, VertexOrigin* origin);

/// Three corners per triangle; polygons are fanned from their first corner, faces of fewer corners left out.
[[nodiscard]] std::vector<std::uint32_t> fannedTriangles(const Mesh& mesh);

/// One flag per welded vertex: 1 at the ends of edges that belong to exactly one face.
[[nodiscard]] std::vector<std::uint8_t> borderVertices(const Mesh& mesh, const WeldedMesh& welded);

/// A direction from the seed, uniform on the unit sphere.
[[nodiscard]] Vec3 randomDirection(std::uint64_t seed);

/// The height below or at which the lowest `count` of the welded vertices lie along `direction`, with ties broken by x,
/// y and z: a vertex belongs to them when !(limit < heightKey(vertex)). @param count  1..vertexCount().
struct HeightKey {
  double height = 0;
  Vec3 position;
  [[nodiscard]] bool operator<(const HeightKey& b) const {
    if (height != b.height) return height < b.height;
    if (position.x != b.position.x) return position.x < b.position.x;
    if (position.y != b.position.y) return position.y < b.position.y;
    return position.z < b.position.z;
  }
};
[[nodiscard]] inline HeightKey heightKey(const Vec3& position, const Vec3& direction) {
  return {dot(position, direction), position};
}
[[nodiscard]] HeightKey lowestKeys(const WeldedMesh& welded, const Vec3& direction, std::size_t count);

/// share * count, rounded to the nearest integer and held within 0 .. count.
[[nodiscard]] std::size_t shareOf(double share, std::size_t count);

}  // namespace quadmark::lab
