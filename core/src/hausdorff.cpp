// SPDX-License-Identifier: MIT
// Hausdorff distances after P. Cignoni, C. Rocchini, R. Scopigno, "Metro: measuring error on simplified surfaces",
// 1998.
//
// Both keep only the largest distance found so far: a sample is done with as soon as any triangle is known to be no
// farther than that, which is the first one tried for nearly all samples.
// Tried for hausdorff(): a uniform grid over the triangles, as in Metro. Models of which half is missing make the
// search walk through empty cells; the box tree answers those in microseconds too.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "point_triangle.h"
#include "quadmark/adjacency.h"
#include "quadmark/metrics.h"
#include "surface_distance.h"

namespace quadmark {
namespace {

using detail::Point;
using detail::squaredToTriangle;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Point pointAt(const std::vector<double>& positions, std::size_t vertex) {
  const double* p = &positions[3 * vertex];
  return {p[0], p[1], p[2]};
}

/// Squared distance from p to one face, fanned from its first corner.
double squaredToFace(const Point& p, const Mesh& mesh, const std::vector<double>& positions, std::size_t face) {
  const std::size_t begin = mesh.faceBegin(face), end = mesh.faceEnd(face);
  const Point a = pointAt(positions, mesh.faceVertices[begin]);
  double best = kInfinity;
  for (std::size_t c = begin + 2; c < end; ++c)
    best = std::min(best, squaredToTriangle(p, a, pointAt(positions, mesh.faceVertices[c - 1]),
                                            pointAt(positions, mesh.faceVertices[c])));
  return best;
}

/// One direction of hausdorffLocal(): samples of `from` against the faces of `to`, both on `mesh`'s connectivity.
class LocalDistance {
 public:
  LocalDistance(const Mesh& mesh, const WeldedMesh& welded, const FaceRings& rings, const std::vector<double>& from,
                const std::vector<double>& to, double& worst)
      : mesh_(mesh), welded_(welded), rings_(rings), from_(from), to_(to), worst_(worst) {}

  void run() {
    // First mesh vertex of each welded one: twins move alike, or their own faces tell.
    std::vector<std::uint32_t> vertexOf(welded_.vertexCount());
    for (std::size_t v = mesh_.vertexCount(); v > 0; --v)
      if (welded_.weldedOf[v - 1] != kNoVertex) vertexOf[welded_.weldedOf[v - 1]] = static_cast<std::uint32_t>(v - 1);
    for (std::uint32_t a = 0; a < welded_.vertexCount(); ++a) {
      const Point here = pointAt(from_, vertexOf[a]), there = pointAt(to_, vertexOf[a]);
      const std::uint32_t alone[] = {a};
      sample(here, there, alone);
      for (std::uint32_t b : welded_.neighboursOf(a)) {
        if (b < a) continue;
        const std::uint32_t ends[] = {a, b};
        sample(0.5 * (here + pointAt(from_, vertexOf[b])), 0.5 * (there + pointAt(to_, vertexOf[b])), ends);
      }
    }
    for (std::size_t f = 0; f < mesh_.faceCount(); ++f)
      for (std::size_t c = mesh_.faceBegin(f) + 2; c < mesh_.faceEnd(f); ++c) {
        const std::uint32_t i = mesh_.faceVertices[mesh_.faceBegin(f)], j = mesh_.faceVertices[c - 1],
                            k = mesh_.faceVertices[c];
        const std::uint32_t corners[] = {welded_.weldedOf[i], welded_.weldedOf[j], welded_.weldedOf[k]};
        sample(1.0 / 3 * (pointAt(from_, i) + pointAt(from_, j) + pointAt(from_, k)),
               1.0 / 3 * (pointAt(to_, i) + pointAt(to_, j) + pointAt(to_, k)), corners);
      }
  }

 private:
  /// @param there  the same place on the other surface: its distance is an upper bound.
  void sample(const Point& here, const Point& there, std::span<const std::uint32_t> around) {
    double best = squared(there - here);
    if (best <= worst_) return;
    for (std::uint32_t vertex : around)
      for (std::uint32_t face : rings_.facesOf(vertex)) {
        best = std::min(best, squaredToFace(here, mesh_, to_, face));
        if (best <= worst_) return;
      }
    worst_ = best;
  }

  const Mesh& mesh_;
  const WeldedMesh& welded_;
  const FaceRings& rings_;
  const std::vector<double>&from_, &to_;
  double& worst_;
};

/// Triangles in a binary tree of boxes, split at the median of the longest side.
class BoxTree {
 public:
  explicit BoxTree(const Mesh& mesh) : mesh_(mesh) {
    for (std::size_t f = 0; f < mesh.faceCount(); ++f)
      for (std::size_t c = mesh.faceBegin(f) + 2; c < mesh.faceEnd(f); ++c)
        triangles_.push_back({mesh.faceVertices[mesh.faceBegin(f)], mesh.faceVertices[c - 1], mesh.faceVertices[c]});
    if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
  }

  [[nodiscard]] bool empty() const { return triangles_.empty(); }

  /// Squared distance to the nearest triangle; any value <= `enough` once one is known to be that near.
  /// @param hint  a triangle to try first: the one found for a neighbouring point. Receives the one found here.
  [[nodiscard]] double nearest(const Point& p, double enough, std::uint32_t& hint) const {
    double best = distanceTo(hint, p);
    if (best > enough) search(0, p, enough, best, hint);
    return best;
  }

 private:
  static constexpr std::uint32_t kLeaf = 8;
  struct Triangle {
    std::uint32_t a, b, c;
  };
  struct Node {
    double low[3], high[3];
    std::uint32_t begin, end, right;  // right == 0: a leaf; the left child follows its parent
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node node{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, begin, end, 0};
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

/// Samples of `from` against `tree`: `worst` rises to the largest squared distance.
void oneSided(const Mesh& from, const BoxTree& tree, int samplesPerFace, double& worst) {
  std::uint32_t last = 0;
  const auto sample = [&](const Point& p) { worst = std::max(worst, tree.nearest(p, worst, last)); };
  std::vector<std::uint8_t> used(from.vertexCount(), 0);
  for (std::uint32_t v : from.faceVertices) used[v] = 1;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) sample(pointAt(from.positions, v));
  for (std::size_t f = 0; f < from.faceCount(); ++f)
    for (std::size_t c = from.faceBegin(f) + 2; c < from.faceEnd(f); ++c) {
      const Point a = pointAt(from.positions, from.faceVertices[from.faceBegin(f)]);
      const Point ab = pointAt(from.positions, from.faceVertices[c - 1]) - a;
      const Point ac = pointAt(from.positions, from.faceVertices[c]) - a;
      for (int i = 0; i < samplesPerFace; ++i) {
        // The plastic number's additive sequence, folded onto the triangle: even for any count, the middle included.
        double s = 1.0 / 3 + 0.75487766624669276 * i, t = 1.0 / 3 + 0.56984029099805327 * i;
        s -= std::floor(s);
        t -= std::floor(t);
        if (s + t > 1) s = 1 - s, t = 1 - t;
        sample(a + s * ab + t * ac);
      }
    }
}

}  // namespace

double detail::hausdorffLocal(const Mesh& a, const std::vector<double>& b, const WeldedMesh& welded) {
  const FaceRings rings = faceRings(a, welded);
  double worst = 0;
  LocalDistance(a, welded, rings, a.positions, b, worst).run();
  LocalDistance(a, welded, rings, b, a.positions, worst).run();
  return std::sqrt(worst);
}

double hausdorffLocal(const Mesh& a, const Mesh& b) {
  return detail::hausdorffLocal(a, b.positions, weld(a));
}

double hausdorff(const Mesh& a, const Mesh& b, int samplesPerFace) {
  const BoxTree treeA(a), treeB(b);
  if (treeA.empty() || treeB.empty()) return treeA.empty() && treeB.empty() ? 0 : kInfinity;
  double worst = 0;
  oneSided(a, treeB, samplesPerFace, worst);
  oneSided(b, treeA, samplesPerFace, worst);
  return std::sqrt(worst);
}

}  // namespace quadmark
