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

#include "parallel.h"
#include "point_triangle.h"
#include "quadmark/adjacency.h"
#include "quadmark/metrics.h"
#include "surface_distance.h"
#include "triangle_tree.h"

namespace quadmark {
namespace {

using detail::Point;
using detail::pointAt;
using detail::squaredToTriangle;
using detail::TriangleTree;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Squared distance from p to one face, fanned from its first corner, or `best` where that is less.
double squaredToFace(const Point& p, const Mesh& mesh, const std::vector<double>& positions, std::size_t face, double best) {
  const std::size_t begin = mesh.faceBegin(face), end = mesh.faceEnd(face);
  const Point a = pointAt(positions, mesh.faceVertices[begin]);
  for (std::size_t c = begin + 2; c < end; ++c)
    best = std::min(best, squaredToTriangle(p, a, pointAt(positions, mesh.faceVertices[c - 1]),
                                            pointAt(positions, mesh.faceVertices[c]), best));
  return best;
}

/// Both directions of hausdorffLocal(): samples of either surface against the faces of the other one around the same
/// place.
class LocalDistance {
 public:
  /// @param worst  distances up to this one need not be found; squared
  LocalDistance(const Mesh& mesh, const Welding& welding, const FaceRings& rings, const std::vector<double>& other, double worst)
      : mesh_(mesh), welding_(welding), rings_(rings), other_(other), worst_(worst) {}

  /// The largest squared distance so far.
  [[nodiscard]] double worst() const { return worst_; }

  void sampleVertex(std::size_t vertex) {
    const std::uint32_t around[] = {welding_.weldedOf[vertex]};
    sample(pointAt(mesh_.positions, vertex), pointAt(other_, vertex), around, kNoVertex);
  }

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
    const auto corner = [&](std::size_t c) { return welding_.weldedOf[mesh_.faceVertices[c]]; };
    const auto middle = [&](const std::vector<double>& positions, std::size_t c, std::size_t d) {
      return 0.5 * (pointAt(positions, mesh_.faceVertices[c]) + pointAt(positions, mesh_.faceVertices[d]));
    };
    const auto centre = [&](const std::vector<double>& positions, std::size_t c) {
      return 1.0 / 3 * (pointAt(positions, mesh_.faceVertices[begin]) + pointAt(positions, mesh_.faceVertices[c - 1]) +
                        pointAt(positions, mesh_.faceVertices[c]));
    };
    for (std::size_t c = begin, d = end - 1; c < end; d = c++) {
      const std::uint32_t ends[] = {corner(c), corner(d)};
      sample(middle(mesh_.positions, c, d), middle(other_, c, d), ends, face);
    }
    for (std::size_t c = begin + 2; c < end; ++c) {
      const std::uint32_t corners[] = {corner(begin), corner(c - 1), corner(c)};
      sample(centre(mesh_.positions, c), centre(other_, c), corners, face);
    }
  }

 private:
  /// The same place on both surfaces: their distance is an upper bound for both directions.
  /// @param own  the face it lies in, most often the nearest one, or kNoVertex
  void sample(const Point& here, const Point& there, std::span<const std::uint32_t> around, std::size_t own) {
    const double bound = squared(there - here);
    if (bound <= worst_) return;
    distance(here, bound, other_, around, own);
    distance(there, bound, mesh_.positions, around, own);
  }

  /// From p, at most `best` away, to the faces at the vertices `around` of the surface with these positions.
  void distance(const Point& p, double best, const std::vector<double>& to, std::span<const std::uint32_t> around,
                std::size_t own) {
    if (own != kNoVertex) best = squaredToFace(p, mesh_, to, own, best);
    if (best <= worst_) return;
    for (std::uint32_t vertex : around)
      for (std::uint32_t face : rings_.facesOf(vertex)) {
        best = squaredToFace(p, mesh_, to, face, best);
        if (best <= worst_) return;
      }
    worst_ = best;
  }

  const Mesh& mesh_;
  const Welding& welding_;
  const FaceRings& rings_;
  const std::vector<double>& other_;
  double worst_;
};

/// Samples of `from` against `tree`: `worst` rises to the largest squared distance.
void oneSided(const Mesh& from, const TriangleTree& tree, int samplesPerFace, double& worst) {
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

double detail::hausdorffLocal(const Mesh& a, const std::vector<double>& b, const Welding& welding) {
  const FaceRings rings = faceRings(a, welding.weldedOf, welding.count);
  // Of each welded vertex one that makes it up: twins move alike, or their own faces tell.
  std::vector<std::uint32_t> vertices(welding.count);
  for (std::size_t v = a.vertexCount(); v-- > 0;)
    if (welding.weldedOf[v] != kNoVertex) vertices[welding.weldedOf[v]] = static_cast<std::uint32_t>(v);
  double worst = largestInParts(vertices.size(), [&](std::size_t begin, std::size_t end) {
    LocalDistance distance(a, welding, rings, b, 0);
    for (std::size_t i = begin; i < end; ++i) distance.sampleVertex(vertices[i]);
    return distance.worst();
  });
  worst = largestInParts(a.faceCount(), [&](std::size_t begin, std::size_t end) {
    LocalDistance distance(a, welding, rings, b, worst);
    for (std::size_t f = begin; f < end; ++f) distance.sampleFace(f);
    return distance.worst();
  });
  return std::sqrt(worst);
}

double hausdorffLocal(const Mesh& a, const Mesh& b) {
  return detail::hausdorffLocal(a, b.positions, weldVertices(a).takeWelding());
}

double hausdorff(const Mesh& a, const Mesh& b, int samplesPerFace) {
  const TriangleTree treeA(a), treeB(b);
  if (treeA.empty() || treeB.empty()) return treeA.empty() && treeB.empty() ? 0 : kInfinity;
  double worst = 0;
  oneSided(a, treeB, samplesPerFace, worst);
  oneSided(b, treeA, samplesPerFace, worst);
  return std::sqrt(worst);
}

}  // namespace quadmark
