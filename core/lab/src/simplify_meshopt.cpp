// SPDX-License-Identifier: MIT
#include <meshoptimizer.h>

#include "mesh_tools.h"

namespace quadmark::lab {

Mesh simplifyMeshopt(const Mesh& mesh, double keep, VertexOrigin* origin, double errorLimit) {
  const std::vector<std::uint32_t> triangles = fannedTriangles(mesh);
  const std::size_t target = 3 * shareOf(keep, triangles.size() / 3);
  std::vector<std::uint32_t> kept = triangles;
  if (target < triangles.size()) {
    const std::vector<float> positions(mesh.positions.begin(), mesh.positions.end());
    const std::size_t corners = meshopt_simplify(kept.data(), triangles.data(), triangles.size(), positions.data(),
                                                 mesh.vertexCount(), 3 * sizeof(float), target,
                                                 static_cast<float>(errorLimit), 0, nullptr);
    kept.resize(corners);
  }
  Mesh simplified;
  simplified.positions = mesh.positions;
  simplified.groups = mesh.groups;
  simplified.precision = mesh.precision;
  simplified.faceVertices = std::move(kept);
  std::vector<std::uint8_t> used(mesh.vertexCount(), 0);
  for (std::uint32_t v : simplified.faceVertices) used[v] = 1;
  return keepVertices(simplified, used, origin);
}

}  // namespace quadmark::lab
