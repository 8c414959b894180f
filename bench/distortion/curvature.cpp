// SPDX-License-Identifier: MIT
#include "curvature.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadmark::bench {
namespace {

using detail::Point;

/// One side of an edge: a triangle that has it.
struct Side {
  std::uint32_t low, high;
  bool upwards;  ///< the triangle's corners run from low to high
  Point normal;  ///< not normalised
};

std::vector<Side> sides(const Mesh& mesh, const WeldedMesh& welded) {
  std::vector<Side> all;
  all.reserve(mesh.faceVertices.size());
  for (std::size_t f = 0; f < mesh.faceCount(); ++f)
    for (std::size_t c = mesh.faceBegin(f) + 2; c < mesh.faceEnd(f); ++c) {
      const std::uint32_t corners[] = {welded.weldedOf[mesh.faceVertices[mesh.faceBegin(f)]],
                                       welded.weldedOf[mesh.faceVertices[c - 1]],
                                       welded.weldedOf[mesh.faceVertices[c]]};
      const Point a = detail::pointAt(welded.positions, corners[0]);
      const Point normal =
          cross(detail::pointAt(welded.positions, corners[1]) - a, detail::pointAt(welded.positions, corners[2]) - a);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = corners[i], to = corners[(i + 1) % 3];
        if (from != to) all.push_back({std::min(from, to), std::max(from, to), from < to, normal});
      }
    }
  std::stable_sort(all.begin(), all.end(),
                   [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  return all;
}

/// The angle by which the surface turns over an edge, positive where it is convex for one sense of all normals.
double bendOf(const Side& first, const Side& second, const Point& along) {
  // Where the two run the same way round the edge, one of the faces is turned over.
  const Point a = first.upwards ? first.normal : second.normal;
  Point b = first.upwards ? second.normal : first.normal;
  if (first.upwards == second.upwards) b = -1.0 * b;
  const double length = std::sqrt(squared(along));
  return length > 0 ? std::atan2(dot(cross(a, b), along) / length, dot(a, b)) : 0;
}

}  // namespace

SurfaceGraph surfaceGraph(const Mesh& mesh, const WeldedMesh& welded) {
  struct Both {
    std::uint32_t from;
    SurfaceGraph::Edge edge;
  };
  SurfaceGraph graph;
  graph.points.resize(welded.vertexCount());
  for (std::uint32_t v = 0; v < welded.vertexCount(); ++v) graph.points[v] = detail::pointAt(welded.positions, v);
  const std::vector<Side> all = sides(mesh, welded);
  std::vector<Both> both;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    const Side& first = all[begin];
    while (end < all.size() && all[end].low == first.low && all[end].high == first.high) ++end;
    const double bend =
        end - begin == 2 ? bendOf(first, all[begin + 1], graph.points[first.high] - graph.points[first.low]) : 0;
    both.push_back({first.low, {first.high, bend}});
    both.push_back({first.high, {first.low, bend}});
  }
  graph.offsets.assign(welded.vertexCount() + 1, 0);
  for (const Both& b : both) ++graph.offsets[b.from + 1];
  for (std::size_t v = 1; v < graph.offsets.size(); ++v) graph.offsets[v] += graph.offsets[v - 1];
  graph.edges.resize(both.size());
  std::vector<std::uint32_t> next(graph.offsets.begin(), graph.offsets.end() - 1);
  for (const Both& b : both) graph.edges[next[b.from]++] = b.edge;
  return graph;
}

double BallWalk::shareInside(const Point& p, const Point& q, double radius) {
  const double outside = squared(q) - radius * radius;
  if (outside <= 0) return 1;
  const Point along = q - p;
  const double a = squared(along), b = dot(p, along), c = squared(p) - radius * radius;
  return std::clamp((std::sqrt(std::max(0.0, b * b - a * c)) - b) / a, 0.0, 1.0 - 1e-12);
}

std::vector<double> meanCurvature(const SurfaceGraph& graph, double radius) {
  std::vector<double> out(graph.points.size());
  BallWalk ball(graph);
  const double area = std::numbers::pi * radius * radius;
  for (std::uint32_t v = 0; v < out.size(); ++v) {
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    ball.run(
        v, radius, [](std::uint32_t) {},
        [&](std::uint32_t from, const SurfaceGraph::Edge& edge, double share) {
          const Point along = graph.points[edge.to] - graph.points[from];
          const double length = std::sqrt(squared(along));
          if (edge.bend == 0 || !(length > 0)) return;
          // Edges that lie inside are met from both ends.
          const double weight = edge.bend * (share == 1 ? 0.5 : share) / length / area;
          const Eigen::Vector3d e(along.x, along.y, along.z);
          tensor += weight * (e * e.transpose());
        });
    // The direction of the normal has no share in the tensor: the other two eigenvalues are the curvatures.
    Eigen::Vector3d values =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly).eigenvalues().cwiseAbs();
    out[v] = (values.sum() - values.minCoeff()) / 2;
  }
  return out;
}

}  // namespace quadmark::bench
