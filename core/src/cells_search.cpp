// SPDX-License-Identifier: MIT
// The embedder's search for embedding cells: natural coplanar sets first, else construction by projection.
#include <cmath>
#include <limits>

#include "quadmark/cells.h"
#include "ring_sets.h"

namespace quadmark {
namespace {

struct Point {
  double v[3];
};

// Twice the vector area of a face (Newell), with one vertex optionally replaced.
Point faceNormal(const Mesh& mesh, const WeldedMesh& welded, std::uint32_t face, const double* positions,
                 std::uint32_t replaced, const double* replacement) {
  Point n{{0, 0, 0}};
  const std::size_t begin = mesh.faceBegin(face), end = mesh.faceEnd(face);
  const auto at = [&](std::size_t corner) {
    const std::uint32_t w = welded.weldedOf[mesh.faceVertices[corner]];
    return w == replaced ? replacement : positions + 3 * std::size_t{w};
  };
  const double* p = at(end - 1);
  for (std::size_t corner = begin; corner < end; ++corner) {
    const double* q = at(corner);
    n.v[0] += (p[1] - q[1]) * (p[2] + q[2]);
    n.v[1] += (p[2] - q[2]) * (p[0] + q[0]);
    n.v[2] += (p[0] - q[0]) * (p[1] + q[1]);
    p = q;
  }
  return n;
}

class Searcher {
 public:
  Searcher(const Mesh& mesh, const WeldedMesh& welded, const PaperParams& params, double diagonal,
           const Rounding& rounding)
      : mesh_(mesh), welded_(welded), rings_(faceRings(mesh, welded)), params_(params),
        lambda_(params.lambda * diagonal), rounding_(rounding), used_(welded.vertexCount(), 0) {
    out_.positions = welded.positions;
  }

  SearchResult run() {
    for (std::uint32_t v = 0; v < welded_.vertexCount(); ++v) seed(v);
    return std::move(out_);
  }

 private:
  void seed(std::uint32_t v) {
    // Most neighbourhoods of a half-used mesh are too small; count before gathering.
    if (params_.k == 1) {
      std::size_t free = used_[v] ? 0 : 1;
      for (std::uint32_t w : welded_.neighboursOf(v)) free += used_[w] ? 0 : 1;
      if (free < 4) return;
    }
    if (!neighbourhood(welded_, v, params_.k, members_)) return;
    std::erase_if(members_, [&](std::uint32_t w) { return used_[w] != 0; });
    if (members_.size() < 4) return;
    keepNearest(members_, v, out_.positions.data(), kMaxMembersWriting);
    ring_.load(members_, v, out_.positions.data(), true);
    Quad quad;
    if (naturalCell(quad)) {
      ++out_.naturalCells;
      accept(quad);
    } else if (construct(quad)) {
      accept(quad);
    }
  }

  void accept(const Quad& quad) {
    for (std::uint32_t w : {quad.a, quad.b, quad.c, quad.d}) used_[w] = 1;
    out_.cells.push_back(quad);
  }

  // Steps (1) and (2) of section 3.2: among natural coplanar sets the one with the longest diagonals (D6).
  bool naturalCell(Quad& best) {
    bool found = false;
    const double tolerance = 1e-7 * std::sqrt(4 * ring_.radius2()) + kExactUnits * rounding_.relative * magnitude();
    ring_.forEach(4 * tolerance * ring_.radius2(), [&](int i, int j, int k, int l, double determinant) {
      // |e x f| of the diagonals is at most twice the largest triangle's normal, so this never rejects too much.
      const double largest = largestNormal2(i, j, k, l);
      if (determinant * determinant > 4 * tolerance * tolerance * largest) return;
      const std::uint32_t ids[4] = {ring_.vertex(i), ring_.vertex(j), ring_.vertex(k), ring_.vertex(l)};
      Quad quad;
      if (!makeQuad(ids, out_.positions.data(), kMinTriangleWriting, quad)) return;
      if (quad.gap > kExactUnits * rounding_.unit(quad, out_.positions.data())) return;
      if (found && !(quad.diagonalSum() > best.diagonalSum())) return;
      best = quad;
      found = true;
    });
    return found;
  }

  // Step (3): the least projection of one point onto the plane of three others, up to lambda (D7).
  bool construct(Quad& best) {
    double bestH2 = lambda_ * lambda_;
    int moved = -1;
    Point movedTo{};
    bool found = false;
    // Twice the area of a triangle in a ball of radius R is at most 2.6 R^2.
    ring_.forEach(2.6 * lambda_ * ring_.radius2(), [&](int i, int j, int k, int l, double determinant) {
      const double volume2 = determinant * determinant;
      if (volume2 > bestH2 * largestNormal2(i, j, k, l)) return;
      const int index[4] = {i, j, k, l};
      const double opposite[4] = {ring_.normal2(j, k, l), ring_.normal2(i, k, l), ring_.normal2(i, j, l),
                                  ring_.normal2(i, j, k)};
      for (int option = 0; option < 4; ++option) {
        if (!(opposite[option] > 0) || volume2 > bestH2 * opposite[option]) continue;
        const double h2 = volume2 / opposite[option];
        Quad quad;
        Point target;
        if (!project(index, option, target, quad)) continue;
        const double r1 = std::min(quad.ratioAC, quad.ratioBD);
        if (found && h2 == bestH2 && !(r1 < std::min(best.ratioAC, best.ratioBD))) continue;  // ties by smaller r1
        if (flips(ring_.vertex(index[option]), target)) continue;
        bestH2 = h2;
        best = quad;
        moved = index[option];
        movedTo = target;
        found = true;
      }
    });
    if (!found) return false;
    double* p = &out_.positions[3 * std::size_t{ring_.vertex(moved)}];
    for (int k = 0; k < 3; ++k) p[k] = movedTo.v[k];
    return true;
  }

  bool project(const int index[4], int option, Point& target, Quad& quad) const {
    const double* p[4];
    for (int i = 0; i < 4; ++i) p[i] = &out_.positions[3 * std::size_t{ring_.vertex(index[i])}];
    const double* x = p[option];
    const double* q0 = p[option == 0 ? 1 : 0];
    const double* q1 = p[option <= 1 ? 2 : 1];
    const double* q2 = p[option <= 2 ? 3 : 2];
    double u[3], w[3], n[3], d = 0, nn = 0;
    for (int k = 0; k < 3; ++k) u[k] = q1[k] - q0[k], w[k] = q2[k] - q0[k];
    n[0] = u[1] * w[2] - u[2] * w[1], n[1] = u[2] * w[0] - u[0] * w[2], n[2] = u[0] * w[1] - u[1] * w[0];
    for (int k = 0; k < 3; ++k) d += (x[k] - q0[k]) * n[k], nn += n[k] * n[k];
    for (int k = 0; k < 3; ++k) target.v[k] = x[k] - d / nn * n[k];
    const double* projected[4] = {p[0], p[1], p[2], p[3]};
    projected[option] = target.v;
    if (!makeQuad(projected, kMinTriangleWriting, quad)) return false;
    for (std::uint32_t* id : {&quad.a, &quad.b, &quad.c, &quad.d}) *id = ring_.vertex(index[*id]);
    return true;
  }

  bool flips(std::uint32_t vertex, const Point& target) const {
    for (std::uint32_t face : rings_.facesOf(vertex)) {
      const Point before = faceNormal(mesh_, welded_, face, out_.positions.data(), kNoVertex, nullptr);
      const Point after = faceNormal(mesh_, welded_, face, out_.positions.data(), vertex, target.v);
      if (before.v[0] * after.v[0] + before.v[1] * after.v[1] + before.v[2] * after.v[2] < 0) return true;
    }
    return false;
  }

  double largestNormal2(int i, int j, int k, int l) const {
    return std::max(std::max(ring_.normal2(i, j, k), ring_.normal2(i, j, l)),
                    std::max(ring_.normal2(i, k, l), ring_.normal2(j, k, l)));
  }

  double magnitude() const {
    double m = 0;
    for (std::uint32_t w : members_)
      for (int k = 0; k < 3; ++k) m = std::max(m, std::fabs(out_.positions[3 * std::size_t{w} + k]));
    return m;
  }

  const Mesh& mesh_;
  const WeldedMesh& welded_;
  const FaceRings rings_;
  const PaperParams& params_;
  const double lambda_;
  const Rounding rounding_;
  std::vector<std::uint8_t> used_;
  std::vector<std::uint32_t> members_;
  RingSets ring_;
  SearchResult out_;
};

}  // namespace

SearchResult searchCells(const Mesh& mesh, const WeldedMesh& welded, const PaperParams& params, double diagonal,
                         const Rounding& rounding) {
  return Searcher(mesh, welded, params, diagonal, rounding).run();
}

}  // namespace quadmark
