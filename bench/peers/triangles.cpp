// SPDX-License-Identifier: MIT
#include "triangles.h"

namespace quadmark::bench {

Triangles::Triangles(const Mesh& mesh, const WeldedMesh& welded) : offsets_(std::size_t{welded.vertexCount()} + 1, 0) {
  for (std::size_t face = 0; face < mesh.faceCount(); ++face) {
    const std::size_t begin = mesh.faceBegin(face);
    for (std::size_t corner = begin + 1; corner + 1 < mesh.faceEnd(face); ++corner) {
      const std::uint32_t a = welded.weldedOf[mesh.faceVertices[begin]];
      const std::uint32_t b = welded.weldedOf[mesh.faceVertices[corner]];
      const std::uint32_t c = welded.weldedOf[mesh.faceVertices[corner + 1]];
      if (a != b && b != c && c != a) all.push_back({a, b, c});
    }
  }
  for (const Triangle& triangle : all) {
    for (const std::uint32_t v : triangle) ++offsets_[v + 1];
  }
  for (std::size_t v = 1; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
  std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
  list_.resize(3 * all.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) {
    for (const std::uint32_t v : all[t]) list_[next[v]++] = t;
  }
}

}  // namespace quadmark::bench
