// SPDX-License-Identifier: MIT
// The triangles of a mesh over its welded vertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "quadmark/adjacency.h"
#include "quadmark/mesh.h"

namespace quadmark::bench {

using Triangle = std::array<std::uint32_t, 3>;

/// Polygons are fanned from their first corners; triangles with two equal corners are left out.
struct Triangles {
  std::vector<Triangle> all;  ///< welded vertices, in the order of the faces

  Triangles(const Mesh& mesh, const WeldedMesh& welded);

  /// Indices into `all` of the triangles around a vertex, ascending.
  [[nodiscard]] std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    return {list_.data() + offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]};
  }

  /// Calls visit(corner) with the third corner of each triangle that has the edge a-b.
  template <class Visit>
  void acrossEdge(std::uint32_t a, std::uint32_t b, const Visit& visit) const {
    for (const std::uint32_t t : around(a)) {
      const Triangle& corners = all[t];
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t p = corners[i], q = corners[(i + 1) % 3];
        if ((p == a && q == b) || (p == b && q == a)) visit(corners[(i + 2) % 3]);
      }
    }
  }

 private:
  std::vector<std::uint32_t> offsets_, list_;
};

}  // namespace quadmark::bench
