// SPDX-License-Identifier: MIT
// R. Ohbuchi, H. Masuda, M. Aono: Watermarking three-dimensional polygonal models, ACM Multimedia 1997, pages 261-272; the
// same authors: Watermarking three-dimensional polygonal models through geometric and topological modifications, IEEE
// Journal on Selected Areas in Communications 16(4), 1998. The algorithm "tetrahedral volume ratio embedding".
//
// A spanning tree over the vertices, grown from a starting place over edges of triangles, gives a sequence of tetrahedra:
// two triangles at an edge, of which the later one brings a new vertex. The ratios of their volumes to a common denominator
// volume are unchanged by affine maps. Each new vertex moves along the normal of the earlier triangle until its ratio says
// its symbol; vertices placed before do not move again. The sequence is repeated over the mesh against cropping.
//
// The papers leave open, and here is decided:
// - Starting places and the repetition: the mesh is cut into patches (patches.h) with one tree each. Seeds and the order in
//   which a tree grows come from names of the connectivity, so that reordering does no harm; the papers try starting edges
//   and depend on the order of the file.
// - The denominator is not one tetrahedron, which may be flat, but the sum of all at the edges of the seed. Neither the
//   seed nor its neighbours move.
// - A symbol is one bit: the parity of the ratio's magnitude in steps (qim.h). Magnitudes also survive reflection.
// - A tetrahedron over a sliver, whose vertex would move by more than a quarter of the edge for one step, is passed over.
// - Votes are weighted by the length of a step, for noise moves vertices, not ratios.
// Strength: the step, as a share of the denominator.
#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>

#include "patches.h"
#include "qim.h"
#include "quadmark/vec3.h"
#include "triangles.h"
#include "welded_peer.h"

namespace quadmark::bench {
namespace {

constexpr std::uint32_t kSpacing = 8;
constexpr double kLargestMove = 0.25;  // of the edge, for one step

// A vertex over the triangle a, b, c, with which its own triangle shares the edge a-b.
struct Tetrahedron {
  std::uint32_t vertex, a, b, c;
  std::uint64_t carrier;

  // Six times the volume over the length of the cross product is the height.
  [[nodiscard]] Vec3 base(const std::vector<double>& positions) const {
    return cross(at(positions, b) - at(positions, a), at(positions, c) - at(positions, a));
  }
  [[nodiscard]] double volume(const std::vector<double>& positions) const {
    return dot(base(positions), at(positions, vertex) - at(positions, a));
  }
};

struct Tree {
  std::vector<Tetrahedron> denominator;  // only their volumes are used
  std::vector<Tetrahedron> carriers;     // in the order in which they are written

  [[nodiscard]] double denominatorVolume(const std::vector<double>& positions) const {
    double sum = 0;
    for (const Tetrahedron& t : denominator) sum += std::abs(t.volume(positions));
    return sum;
  }
};

// Grows trees in the patches of one mesh.
class Grower {
 public:
  Grower(const Triangles& triangles, std::size_t vertices) : triangles_(triangles), rank_(vertices, kNoVertex) {}

  Tree grow(const Patch& patch) {
    for (std::uint32_t i = 0; i < patch.vertices.size(); ++i) rank_[patch.vertices[i]] = i;
    placed_.assign(patch.vertices.size(), 0);
    Tree tree;
    for (std::size_t i = 0; i < patch.rings.size() && patch.rings[i] < 2; ++i) placed_[i] = 1;
    const std::uint32_t seed = patch.vertices[0];
    for (const std::uint32_t t : triangles_.around(seed)) reachFrom(triangles_.all[t]);
    addDenominator(tree, seed, patch);
    while (!reached_.empty()) {
      const auto [vertex, a, b, c] = reached_.top();
      reached_.pop();
      if (placed_[vertex] != 0) continue;
      placed_[vertex] = 1;
      const std::vector<std::uint32_t>& members = patch.vertices;
      tree.carriers.push_back({members[vertex], members[a], members[b], members[c], patch.name + vertex});
      for (const std::uint32_t t : triangles_.around(members[vertex])) reachFrom(triangles_.all[t]);
    }
    for (const std::uint32_t v : patch.vertices) rank_[v] = kNoVertex;
    return tree;
  }

 private:
  bool isPlaced(std::uint32_t vertex) const { return rank_[vertex] != kNoVertex && placed_[rank_[vertex]] != 0; }

  // Across the edges of a triangle whose corners are placed, others come within reach.
  void reachFrom(const Triangle& triangle) {
    if (!std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) { return isPlaced(v); })) return;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3], c = triangle[(i + 2) % 3];
      triangles_.acrossEdge(a, b, [&](std::uint32_t v) {
        if (rank_[v] == kNoVertex || isPlaced(v)) return;
        reached_.emplace(rank_[v], std::min(rank_[a], rank_[b]), std::max(rank_[a], rank_[b]), rank_[c]);
      });
    }
  }

  // Two triangles at each edge of the seed.
  void addDenominator(Tree& tree, std::uint32_t seed, const Patch& patch) const {
    for (std::size_t i = 1; i < patch.rings.size() && patch.rings[i] < 2; ++i) {
      std::vector<std::uint32_t> sides;
      triangles_.acrossEdge(seed, patch.vertices[i], [&](std::uint32_t v) { sides.push_back(v); });
      if (sides.size() == 2) tree.denominator.push_back({sides[0], seed, patch.vertices[i], sides[1], 0});
    }
  }

  using Reached = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;  // ranks: vertex, a, b, c

  const Triangles& triangles_;
  std::vector<std::uint32_t> rank_;  // in the patch, or kNoVertex
  Bits placed_;                      // by rank
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> reached_;
};

class Ohbuchi final : public WeldedPeer {
 public:
  std::string name() const override { return "ohbuchi-tvr"; }
  PeerInfo info() const override {
    return {"R. Ohbuchi, H. Masuda, M. Aono",
            "Watermarking three-dimensional polygonal models (tetrahedral volume ratio)",
            "ACM Multimedia",
            1997,
            true,
            "the volume of the tetrahedron of two triangles at an edge, as a share of one in its patch",
            describe(settings()),
            "one tree a patch, grown in an order that follows from the connectivity; the denominator is the sum of all "
            "tetrahedra around the seed; one bit a ratio by quantization",
            "the authors' claims: exact after affine maps and, repeated, after cropping; lost under noise and after "
            "the connectivity has changed"};
  }

 protected:
  std::vector<Setting> settings() const override { return {{"strength", 0.05, 1e-4, 10}}; }

  void write(const Work& work, const Bits& written, std::vector<double>& moved, TrialMark& mark) const override {
    visit(work, moved, [&](const Tetrahedron& t, const Slot& slot) {
      const bool one = work.bits.held(written, t.carrier);
      const double wanted = qimNearest(std::abs(slot.volume), slot.step, one, 0);
      const double move = (slot.volume < 0 ? -wanted : wanted) - slot.volume;
      const double area = length(slot.base);
      put(moved, t.vertex, at(moved, t.vertex) + (move / (area * area)) * slot.base);
      ++mark.carriers;
    });
    mark.capacityBits = mark.carriers;
  }

  void vote(const Work& work, BitVotes& votes) const override {
    const double diagonal = boundingDiagonal(work.mesh);
    visit(work, work.welded.positions, [&](const Tetrahedron& t, const Slot& slot) {
      const double weight = lengthWeight(slot.step / length(slot.base), diagonal);
      votes.add(t.carrier, weight * qimVote(std::abs(slot.volume), slot.step));
    });
  }

 private:
  struct Slot {
    Vec3 base;
    double volume = 0, step = 0;  // both six times a volume
  };

  // Calls use() for each tetrahedron that carries, in the order of writing; use() may move its vertex.
  template <class Use>
  static void visit(const Work& work, const std::vector<double>& positions, const Use& use) {
    const Triangles triangles(work.mesh, work.welded);
    Grower grower(triangles, work.welded.vertexCount());
    for (const Patch& patch : patchesOf(work.welded, kSpacing)) {
      const Tree tree = grower.grow(patch);
      const double step = work.values[0] * tree.denominatorVolume(positions);
      if (!(step > 0)) continue;
      for (const Tetrahedron& t : tree.carriers) {
        const Slot slot{t.base(positions), t.volume(positions), step};
        const double edge = length(at(positions, t.b) - at(positions, t.a));
        if (step <= kLargestMove * edge * length(slot.base)) use(t, slot);
      }
    }
  }
};

}  // namespace

std::unique_ptr<Peer> ohbuchiTvr() {
  return std::make_unique<Ohbuchi>();
}

}  // namespace quadmark::bench
