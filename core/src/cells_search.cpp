// SPDX-License-Identifier: MIT
// The embedder's search for embedding cells: natural coplanar sets first, else construction by projection.
#include <algorithm>
#include <cmath>

#include "quadmark/cells.h"
#include "ring_sets.h"

namespace quadmark {
namespace {

struct Point {
  double v[3];
};

// Four points and where they shall go.
struct Flattened {
  std::uint32_t vertex[4];
  Point to[4];

  [[nodiscard]] const double* position(std::uint32_t w, const double* positions) const {
    for (int i = 0; i < 4; ++i)
      if (vertex[i] == w) return to[i].v;
    return positions + 3 * std::size_t{w};
  }
};

// Twice the vector area of a face (Newell), summed corner by corner.
struct FaceNormal {
  double x = 0, y = 0, z = 0;
  void add(const double* p, const double* q) {
    x += (p[1] - q[1]) * (p[2] + q[2]);
    y += (p[2] - q[2]) * (p[0] + q[0]);
    z += (p[0] - q[0]) * (p[1] + q[1]);
  }
};

// Makes a nearly flat quadrilateral flat at the least total displacement: the gap between its diagonals is closed by
// moving each end in proportion to its share of the crossing point.
// Tried: projecting one vertex onto the plane of the others, as the paper does. Its displacement h is about twice the
// gap, so it spends four times the energy: 2 dB of the bunny's SNR at 8100 bits.
Flattened flatten(const Quad& q, const double* positions) {
  Flattened out{{q.a, q.b, q.c, q.d}, {}};
  const double s = q.ratioAC, t = q.ratioBD;
  const double sum = (1 - s) * (1 - s) + s * s + (1 - t) * (1 - t) + t * t;
  const double share[4] = {(1 - s) / sum, -(1 - t) / sum, s / sum, -t / sum};
  for (int k = 0; k < 3; ++k) {
    const auto at = [&](std::uint32_t w) { return positions[3 * std::size_t{w} + k]; };
    const double between = (at(q.b) + t * (at(q.d) - at(q.b))) - (at(q.a) + s * (at(q.c) - at(q.a)));
    for (int i = 0; i < 4; ++i) out.to[i].v[k] = at(out.vertex[i]) + share[i] * between;
  }
  return out;
}

class Searcher {
 public:
  Searcher(const Mesh& mesh, WeldedMesh& welded, const PaperParams& params, double diagonal,
           const Rounding& rounding)
      : mesh_(mesh), welded_(welded), rings_(faceRings(mesh, welded)), params_(params),
        lambda_(params.lambda * diagonal), rounding_(rounding), used_(welded.vertexCount(), 0) {
    for (std::size_t w = 0; w < welded.gridOf.size(); ++w) used_[w] = welded.gridOf[w] == kFixed;
  }

  SearchResult run() {
    for (std::uint32_t v = 0; v < welded_.vertexCount(); ++v) seed(v);
    return std::move(out_);
  }

 private:
  static constexpr int kMaxRefusals = 4;

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
    keepNearest(members_, v, welded_.positions.data(), kMaxMembersWriting);
    ring_.load(members_, v, welded_.positions.data(), true);
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
    double gridHalfStep = 0;
    for (std::uint32_t w : members_) gridHalfStep = std::max(gridHalfStep, rounding_.halfStepOf(w));
    const double tolerance = 1e-7 * std::sqrt(4 * ring_.radius2()) +
                             kExactUnits * (rounding_.relative * ring_.magnitude() + gridHalfStep);
    ring_.forEach(4 * tolerance * ring_.radius2(), [&](int i, int j, int k, int l, double determinant) {
      // |e x f| of the diagonals is at most twice the largest triangle's normal, so this never rejects too much.
      const double largest = largestNormal2(i, j, k, l);
      if (determinant * determinant > 4 * tolerance * tolerance * largest) return;
      const std::uint32_t ids[4] = {ring_.vertex(i), ring_.vertex(j), ring_.vertex(k), ring_.vertex(l)};
      Quad quad;
      if (!makeQuad(ids, welded_.positions.data(), kMinTriangleWriting, quad)) return;
      if (quad.gap > kExactUnits * rounding_.unit(quad, welded_.positions.data())) return;
      if (found && !(quad.diagonalSum() > best.diagonalSum())) return;
      best = quad;
      found = true;
    });
    return found;
  }

  // Step (3): the set with the least projection of one of its points onto the plane of the other three, up to lambda
  // (D7). Sets whose flattening would turn a face over are passed over.
  bool construct(Quad& best) {
    const double* positions = welded_.positions.data();
    std::uint32_t refused[kMaxRefusals][4];
    for (int refusals = 0; refusals < kMaxRefusals; ++refusals) {
      double bestH2 = lambda_ * lambda_;
      bool found = false;
      Quad chosen;
      // Twice the area of a triangle in a ball of radius R is at most 2.6 R^2.
      ring_.forEach(2.6 * lambda_ * ring_.radius2(), [&](int i, int j, int k, int l, double determinant) {
        const double volume2 = determinant * determinant, largest = largestNormal2(i, j, k, l);
        if (!(volume2 <= bestH2 * largest)) return;
        const double h2 = volume2 / largest;
        const std::uint32_t ids[4] = {ring_.vertex(i), ring_.vertex(j), ring_.vertex(k), ring_.vertex(l)};
        for (int r = 0; r < refusals; ++r)
          if (std::equal(ids, ids + 4, refused[r])) return;
        Quad quad;
        // The gap of a sharply folded set exceeds its h, and flattening moves points by up to 0.7 gaps.
        if (!makeQuad(ids, positions, kMinTriangleWriting, quad) || quad.gap > lambda_) return;
        const double r1 = std::min(quad.ratioAC, quad.ratioBD);
        if (found && h2 == bestH2 && !(r1 < std::min(chosen.ratioAC, chosen.ratioBD))) return;  // ties by smaller r1
        bestH2 = h2;
        chosen = quad;
        std::copy(ids, ids + 4, refused[refusals]);
        found = true;
      });
      if (!found) return false;
      const Flattened flat = flatten(chosen, positions);
      const double* points[4] = {flat.to[0].v, flat.to[1].v, flat.to[2].v, flat.to[3].v};
      if (!makeQuad(points, kMinTriangleWriting, best) || flips(flat)) continue;
      for (std::uint32_t* id : {&best.a, &best.b, &best.c, &best.d}) *id = flat.vertex[*id];
      for (int i = 0; i < 4; ++i) std::copy(flat.to[i].v, flat.to[i].v + 3, &welded_.positions[3 * std::size_t{flat.vertex[i]}]);
      return true;
    }
    return false;
  }

  // Would any face at the four points point the other way?
  [[nodiscard]] bool flips(const Flattened& flat) const {
    for (std::uint32_t vertex : flat.vertex)
      for (std::uint32_t face : rings_.facesOf(vertex))
        if (turnsOver(face, flat)) return true;
    return false;
  }

  [[nodiscard]] bool turnsOver(std::uint32_t face, const Flattened& flat) const {
    const double* positions = welded_.positions.data();
    const auto vertexAt = [&](std::size_t corner) { return welded_.weldedOf[mesh_.faceVertices[corner]]; };
    const std::size_t begin = mesh_.faceBegin(face), end = mesh_.faceEnd(face);
    FaceNormal before, after;
    const std::uint32_t last = vertexAt(end - 1);
    const double *p = positions + 3 * std::size_t{last}, *moved = flat.position(last, positions);
    for (std::size_t corner = begin; corner < end; ++corner) {
      const std::uint32_t vertex = vertexAt(corner);
      const double *q = positions + 3 * std::size_t{vertex}, *movedQ = flat.position(vertex, positions);
      before.add(p, q);
      after.add(moved, movedQ);
      p = q;
      moved = movedQ;
    }
    return before.x * after.x + before.y * after.y + before.z * after.z < 0;
  }

  double largestNormal2(int i, int j, int k, int l) const {
    return std::max(std::max(ring_.normal2(i, j, k), ring_.normal2(i, j, l)),
                    std::max(ring_.normal2(i, k, l), ring_.normal2(j, k, l)));
  }

  const Mesh& mesh_;
  WeldedMesh& welded_;
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

SearchResult searchCells(const Mesh& mesh, WeldedMesh& welded, const PaperParams& params, double diagonal,
                         const Rounding& rounding) {
  return Searcher(mesh, welded, params, diagonal, rounding).run();
}

}  // namespace quadmark
