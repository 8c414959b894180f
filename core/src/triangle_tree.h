// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "point_triangle.h"
#include "quadmark/mesh.h"

namespace quadmark::detail {

/// The triangles of a mesh (polygons are fanned) in a binary tree of boxes, split at the median of the longest side.
/// The mesh must outlive it. Cost: n log n.
class TriangleTree {
 public:
  explicit TriangleTree(const Mesh& mesh) : mesh_(mesh) {
    for (std::size_t f = 0; f < mesh.faceCount(); ++f)
      for (std::size_t c = mesh.faceBegin(f) + 2; c < mesh.faceEnd(f); ++c)
        triangles_.push_back({mesh.faceVertices[mesh.faceBegin(f)], mesh.faceVertices[c - 1], mesh.faceVertices[c]});
    if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
  }

  [[nodiscard]] bool empty() const { return triangles_.empty(); }

  /// The vertices of a triangle that nearest() has found.
  [[nodiscard]] std::array<std::uint32_t, 3> corners(std::uint32_t triangle) const {
    const Triangle& t = triangles_[triangle];
    return {t.a, t.b, t.c};
  }

  /// Squared distance to the nearest triangle; any value <= `enough` once one is known to be that near.
  /// @param hint  a triangle to try first: the one found for a neighbouring point. Receives the one found here.
  [[nodiscard]] double nearest(const Point& p, double enough, std::uint32_t& hint) const {
    double best = distanceTo(hint, p);
    if (best > enough) search(0, p, enough, best, hint);
    return best;
  }

 private:
  static constexpr std::uint32_t kLeaf = 8;
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  struct Triangle {
    std::uint32_t a, b, c;
  };
  struct Node {
    double low[3], high[3];
    std::uint32_t begin, end, right;  // right == 0: a leaf; the left child follows its parent
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node node{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}, begin, end, 0};
    for (std::uint32_t i = begin; i < end; ++i)
      for (std::uint32_t v : {triangles_[i].a, triangles_[i].b, triangles_[i].c})
        for (std::size_t axis = 0; axis < 3; ++axis) {
          node.low[axis] = std::min(node.low[axis], mesh_.positions[3 * std::size_t{v} + axis]);
          node.high[axis] = std::max(node.high[axis], mesh_.positions[3 * std::size_t{v} + axis]);
        }
    nodes_.push_back(node);
    if (end - begin <= kLeaf) return index;
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (node.high[i] - node.low[i] > node.high[axis] - node.low[axis]) axis = i;
    const auto middleOf = [&](const Triangle& t) {
      return mesh_.positions[3 * std::size_t{t.a} + axis] + mesh_.positions[3 * std::size_t{t.b} + axis] +
             mesh_.positions[3 * std::size_t{t.c} + axis];
    };
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                     [&](const Triangle& s, const Triangle& t) { return middleOf(s) < middleOf(t); });
    build(begin, middle);
    const std::uint32_t right = build(middle, end);
    nodes_[index].right = right;
    return index;
  }

  [[nodiscard]] double squaredToBox(const Node& node, const Point& p) const {
    const double x = std::max({node.low[0] - p.x, 0.0, p.x - node.high[0]});
    const double y = std::max({node.low[1] - p.y, 0.0, p.y - node.high[1]});
    const double z = std::max({node.low[2] - p.z, 0.0, p.z - node.high[2]});
    return x * x + y * y + z * z;
  }

  [[nodiscard]] double distanceTo(std::uint32_t triangle, const Point& p) const {
    const Triangle& t = triangles_[triangle];
    return squaredToTriangle(p, pointAt(mesh_.positions, t.a), pointAt(mesh_.positions, t.b),
                             pointAt(mesh_.positions, t.c));
  }

  // Depth is log2 of the triangle count: the halves are equal.
  void search(std::uint32_t index, const Point& p, double enough, double& best, std::uint32_t& found) const {
    const Node& node = nodes_[index];
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end && best > enough; ++i) {
        const double distance = distanceTo(i, p);
        if (distance < best) best = distance, found = i;
      }
      return;
    }
    std::uint32_t near = index + 1, far = node.right;
    double nearDistance = squaredToBox(nodes_[near], p), farDistance = squaredToBox(nodes_[far], p);
    if (farDistance < nearDistance) {
      std::swap(near, far);
      std::swap(nearDistance, farDistance);
    }
    if (nearDistance < best) search(near, p, enough, best, found);
    if (best > enough && farDistance < best) search(far, p, enough, best, found);
  }

  const Mesh& mesh_;
  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace quadmark::detail
