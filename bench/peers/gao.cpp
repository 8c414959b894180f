// SPDX-License-Identifier: MIT
// X. Gao, C. Zhang and others 2010: high capacity watermarking by similarity-transformation invariants of four-point sets,
// the predecessor of the product's scheme `paper`. Its text was not to be had. What is known of it is what X. Gao, C. Zhang,
// Y. Huang, Z. Deng say in "A robust high-capacity affine-transformation-invariant scheme for watermarking 3D geometric
// models", ACM TOMM 8(2S), 2012, sections 2 and 3: the invariants are the ratios in which the diagonals of a virtual,
// projected quadrilateral cut each other; none of the four points is moved to make it; the ratios are unchanged by rotation,
// shift and uniform scaling but not by other affine maps; distortion can be tuned linearly; the capacity is high; the mark
// "cannot resist file attacks", which are reordering of vertices or faces.
//
// Decided here:
// - The four points of a set are those of two triangles at an edge a-b, with c and d across it. d is projected onto the plane
//   of a, b, c. Sets are taken greedily in the order of the vertices and share no vertex; that uses the connectivity alone,
//   so that no geometric attack can upset the count. Here lies the weakness against file attacks.
// - The set number i carries the bits 2i and 2i + 1 of the repeated payload, in its two ratios (about one bit for every
//   two to three vertices).
// - A bit is the parity of a ratio in steps (qim.h). The end nearer to the crossing moves along its diagonal: the plane, the
//   crossing and the other ratio stay as they are.
// - Ratios outside of 0.1 .. 0.9 carry nothing. Votes are weighted by the length of a step.
// With this much repetition 64 bits survive affine maps on smooth meshes, whose sets are nearly flat: more than the authors
// claim, and left so. A payload that is written only once or twice does not.
// Strength: the step of the ratio; displacement is proportional to it.
#include <algorithm>
#include <cmath>
#include <optional>

#include "qim.h"
#include "quadmark/vec3.h"
#include "triangles.h"
#include "welded_peer.h"

namespace quadmark::bench {
namespace {

constexpr double kLowest = 0.1, kHighest = 0.9;

struct FourPoints {
  std::uint32_t a, b, c, d;
};

std::vector<FourPoints> fourPointSets(const Triangles& triangles, const WeldedMesh& welded) {
  std::vector<FourPoints> sets;
  Bits used(welded.vertexCount(), 0);
  for (std::uint32_t a = 0; a < welded.vertexCount(); ++a) {
    for (const std::uint32_t b : welded.neighboursOf(a)) {
      if (used[a] != 0) break;
      if (used[b] != 0) continue;
      std::vector<std::uint32_t> across;
      triangles.acrossEdge(a, b, [&](std::uint32_t v) { across.push_back(v); });
      if (across.size() != 2 || across[0] == across[1] || used[across[0]] != 0 || used[across[1]] != 0) continue;
      const auto [c, d] = std::minmax(across[0], across[1]);
      sets.push_back({a, b, c, d});
      for (const std::uint32_t v : {a, b, c, d}) used[v] = 1;
    }
  }
  return sets;
}

// One diagonal of the quadrilateral a, c, b, d', d' = d projected.
struct Diagonal {
  Vec3 from, to;
  double ratio = 0;  // of from..crossing to the whole

  [[nodiscard]] bool usable() const { return ratio > kLowest && ratio < kHighest; }
};

struct Quadrilateral {
  Diagonal ab, cd;
  Vec3 height;  // of d over the plane
};

// Nothing where the points are collinear or the diagonals parallel.
std::optional<Quadrilateral> quadrilateral(const std::vector<double>& positions, const FourPoints& set) {
  const Vec3 a = at(positions, set.a), b = at(positions, set.b), c = at(positions, set.c), d = at(positions, set.d);
  const Vec3 normal = cross(b - a, c - a);
  const double square = dot(normal, normal);
  if (!(square > 0)) return std::nullopt;
  Quadrilateral out;
  out.height = (dot(normal, d - a) / square) * normal;
  const Vec3 foot = d - out.height;
  // a + s (b - a) = c + t (foot - c), solved in the plane.
  const double det = dot(normal, cross(b - a, foot - c));
  if (det == 0) return std::nullopt;
  out.ab = {a, b, dot(normal, cross(c - a, foot - c)) / det};
  out.cd = {c, foot, dot(normal, cross(c - a, b - a)) / det};
  return out;
}

class Gao final : public WeldedPeer {
 public:
  std::string name() const override { return "gao-similarity"; }
  PeerInfo info() const override {
    return {"X. Gao, C. Zhang and others",
            "High-capacity watermarking by similarity-transformation invariants of four-point sets",
            "as described by its successor in ACM TOMM 8(2S), 2012; the text itself was not to be had",
            2010,
            true,
            "the ratios in which the diagonals of a projected quadrilateral cut each other",
            describe(settings()),
            "two triangles at an edge make a set, sets follow the order of vertices, one bit a ratio by quantization",
            "its successor's words: exact after similarity transforms, not after other affine maps or reordering; "
            "distortion is linear in the strength; high capacity"};
  }

 protected:
  std::vector<Setting> settings() const override { return {{"strength", 0.03, 1e-5, 0.2}}; }

  void write(const Work& work, const Bits& written, std::vector<double>& moved, TrialMark& mark) const override {
    const std::vector<FourPoints> sets = fourPointSets(Triangles(work.mesh, work.welded), work.welded);
    const auto one = [&](std::uint64_t carrier) { return work.bits.held(written, carrier); };
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const auto quad = quadrilateral(moved, sets[i]);
      if (!quad || !quad->ab.usable() || !quad->cd.usable()) continue;
      const Diagonal ab = withRatio(quad->ab, one(2 * i), work.values[0]);
      const Diagonal cd = withRatio(quad->cd, one(2 * i + 1), work.values[0]);
      put(moved, sets[i].a, ab.from);
      put(moved, sets[i].b, ab.to);
      put(moved, sets[i].c, cd.from);
      put(moved, sets[i].d, cd.to + quad->height);
      mark.carriers += 2;
    }
    mark.capacityBits = mark.carriers;
  }

  void vote(const Work& work, BitVotes& votes) const override {
    const std::vector<FourPoints> sets = fourPointSets(Triangles(work.mesh, work.welded), work.welded);
    const double diagonal = boundingDiagonal(work.mesh), step = work.values[0];
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const auto quad = quadrilateral(work.welded.positions, sets[i]);
      if (!quad || !quad->ab.usable() || !quad->cd.usable()) continue;
      std::uint64_t carrier = 2 * i;
      for (const Diagonal& d : {quad->ab, quad->cd})
        votes.add(carrier++, lengthWeight(step * length(d.to - d.from), diagonal) * qimVote(d.ratio, step));
    }
  }

 private:
  // The diagonal with a ratio of this bit; its nearer end has moved.
  static Diagonal withRatio(const Diagonal& diagonal, bool one, double step) {
    const double from = std::ceil(kLowest / step), to = std::floor(kHighest / step) - 1;
    const double ratio = qimNearest(diagonal.ratio, step, one, from, to);
    const Vec3 crossing = diagonal.from + diagonal.ratio * (diagonal.to - diagonal.from);
    Diagonal out = diagonal;
    if (diagonal.ratio < 0.5) {
      out.from = crossing - (ratio / (1 - ratio)) * (diagonal.to - crossing);
    } else {
      out.to = crossing + ((1 - ratio) / ratio) * (crossing - diagonal.from);
    }
    return out;
  }
};

}  // namespace

std::unique_ptr<Peer> gaoSimilarity() {
  return std::make_unique<Gao>();
}

}  // namespace quadmark::bench
