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

/// Both directions of hausdorffLocal(): samples of either surface against the faces of the other one around the same
/// place.
class LocalDistance {
 public:
  LocalDistance(const Mesh& mesh, const WeldedMesh& welded, const std::vector<double>& other)
      : mesh_(mesh), welded_(welded), rings_(faceRings(mesh, welded)), other_(other) {}

  /// The largest squared distance.
  [[nodiscard]] double run() {
    // First mesh vertex of each welded one: twins move alike, or their own faces tell.
    std::vector<std::uint8_t> seen(welded_.vertexCount(), 0);
    for (std::size_t v = 0; v < mesh_.vertexCount(); ++v) {
      const std::uint32_t w = welded_.weldedOf[v];
      if (w == kNoVertex || seen[w] != 0) continue;
      seen[w] = 1;
      const std::uint32_t alone[] = {w};
      sample(pointAt(mesh_.positions, v), pointAt(other_, v), alone);
    }
    for (std::size_t f = 0; f < mesh_.faceCount(); ++f) sampleFace(f);
    return worst_;
  }

 private:
  /// Middles of the boundary edges and of the fanned triangles. The middle of two or three points moves no farther than
  /// the one of them that moves farthest, so most faces of a marked model are passed over.
  void sampleFace(std::size_t face) {
    const std::size_t begin = mesh_.faceBegin(face), end = mesh_.faceEnd(face);
    double farthest = 0;
    for (std::size_t c = begin; c < end; ++c) {
      const std::uint32_t v = mesh_.faceVertices[c];
      farthest = std::max(farthest, squared(pointAt(other_, v) - pointAt(mesh_.positions, v)));
    }
    if (farthest <= worst_) return;
    const auto corner = [&](std::size_t c) { return welded_.weldedOf[mesh_.faceVertices[c]]; };
    const auto middle = [&](const std::vector<double>& positions, std::size_t c, std::size_t d) {
      return 0.5 * (pointAt(positions, mesh_.faceVertices[c]) + pointAt(positions, mesh_.faceVertices[d]));
    };
    const auto centre = [&](const std::vector<double>& positions, std::size_t c) {
      return 1.0 / 3 * (pointAt(positions, mesh_.faceVertices[begin]) + pointAt(positions, mesh_.faceVertices[c - 1]) +
                        pointAt(positions, mesh_.faceVertices[c]));
    };
    for (std::size_t c = begin, d = end - 1; c < end; d = c++) {
      const std::uint32_t ends[] = {corner(c), corner(d)};
      sample(middle(mesh_.positions, c, d), middle(other_, c, d), ends);
    }
    for (std::size_t c = begin + 2; c < end; ++c) {
      const std::uint32_t corners[] = {corner(begin), corner(c - 1), corner(c)};
      sample(centre(mesh_.positions, c), centre(other_, c), corners);
    }
  }

  /// The same place on both surfaces: their distance is an upper bound for both directions.
  void sample(const Point& here, const Point& there, std::span<const std::uint32_t> around) {
    const double bound = squared(there - here);
    if (bound <= worst_) return;
    distance(here, bound, other_, around);
    distance(there, bound, mesh_.positions, around);
  }

  /// From p, at most `best` away, to the faces at the vertices `around` of the surface with these positions.
  void distance(const Point& p, double best, const std::vector<double>& to, std::span<const std::uint32_t> around) {
    if (best <= worst_) return;
    for (std::uint32_t vertex : around)
      for (std::uint32_t face : rings_.facesOf(vertex)) {
        best = std::min(best, squaredToFace(p, mesh_, to, face));
        if (best <= worst_) return;
      }
    worst_ = best;
  }

  const Mesh& mesh_;
  const WeldedMesh& welded_;
  const FaceRings rings_;
  const std::vector<double>& other_;
  double worst_ = 0;
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
  return std::sqrt(LocalDistance(a, welded, b).run());
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
