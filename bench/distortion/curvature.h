// SPDX-License-Identifier: MIT
// Curvature of triangle surfaces over a radius: the normal cycle of D. Cohen-Steiner, J.-M. Morvan, "Restricted
// Delaunay triangulations and normal cycle", 2003, as P. Alliez et al., "Anisotropic polygonal remeshing", 2003, use
// it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "point_triangle.h"
#include "quadmark/adjacency.h"
#include "quadmark/mesh.h"

namespace quadmark::bench {

/// Welded vertices and the edges of the triangles between them (polygons are fanned).
struct SurfaceGraph {
  struct Edge {
    std::uint32_t to;
    double bend;  ///< signed angle between the two faces' normals, radians; 0 where there are not just two faces
  };
  std::vector<detail::Point> points;   ///< per welded vertex, file units
  std::vector<std::uint32_t> offsets;  ///< vertices + 1
  std::vector<Edge> edges;             ///< each edge once at both of its ends

  [[nodiscard]] std::span<const Edge> edgesOf(std::uint32_t vertex) const {
    return {edges.data() + offsets[vertex], offsets[vertex + 1] - offsets[vertex]};
  }
};

/// @param welded  weld(mesh).
[[nodiscard]] SurfaceGraph surfaceGraph(const Mesh& mesh, const WeldedMesh& welded);

/// Walks the part of a surface that lies in a ball and is connected with its centre.
class BallWalk {
 public:
  explicit BallWalk(const SurfaceGraph& graph) : graph_(graph), seen_(graph.points.size(), 0) {}

  /// @param vertex  called with each vertex inside, the centre first.
  /// @param edge    called with (vertex inside, edge, share of the edge that is inside): 1 where the other end is
  /// inside, too,
  ///                and then the edge is met again from there.
  template <typename OnVertex, typename OnEdge>
  void run(std::uint32_t centre, double radius, const OnVertex& vertex, const OnEdge& edge) {
    ++round_;
    found_.assign(1, centre);
    seen_[centre] = round_;
    const detail::Point middle = graph_.points[centre];
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const std::uint32_t from = found_[i];
      vertex(from);
      for (const SurfaceGraph::Edge& e : graph_.edgesOf(from)) {
        const double share = shareInside(graph_.points[from] - middle, graph_.points[e.to] - middle, radius);
        edge(from, e, share);
        if (share < 1 || seen_[e.to] == round_) continue;
        seen_[e.to] = round_;
        found_.push_back(e.to);
      }
    }
  }

 private:
  /// Of the segment from p, inside the ball around the origin, to q.
  static double shareInside(const detail::Point& p, const detail::Point& q, double radius);

  const SurfaceGraph& graph_;
  std::vector<std::uint32_t> seen_, found_;
  std::uint32_t round_ = 0;
};

/// (|k1| + |k2|) / 2 of the principal curvatures at each vertex, 1 / file units, from the part of the surface within
/// `radius` of it. Cost: the vertices times those in a ball.
[[nodiscard]] std::vector<double> meanCurvature(const SurfaceGraph& graph, double radius);

}  // namespace quadmark::bench
