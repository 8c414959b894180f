// SPDX-License-Identifier: MIT
#include "mesh_tools.h"

namespace quadmark::lab {

Mesh crop(const Mesh& mesh, double fraction, int axis, std::uint64_t seed, VertexOrigin* origin) {
  const WeldedMesh welded = weld(mesh);
  const Vec3 direction =
      axis == 3 ? randomDirection(seed) : Vec3{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
  const std::size_t removed = shareOf(fraction, welded.vertexCount());
  std::vector<std::uint8_t> keep(mesh.vertexCount(), 1);
  if (removed > 0) {
    const HeightKey limit = lowestKeys(welded, direction, removed);
    for (std::size_t v = 0; v < keep.size(); ++v) keep[v] = limit < heightKey(at(mesh.positions, v), direction);
  }
  return keepVertices(mesh, keep, origin);
}

}  // namespace quadmark::lab
