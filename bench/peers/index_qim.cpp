// SPDX-License-Identifier: MIT
// Quantization index modulation of coordinates in file order: what a developer writes who takes the idea of B. Chen, G. W.
// Wornell (Quantization index modulation: a class of provably good methods for digital watermarking and information
// embedding, IEEE Transactions on Information Theory 47(4), 2001) to the vertex array of a GLB. Vertex i carries bit i mod
// n, in each of its coordinates.
//
// Decided here:
// - Coordinates are taken in the model's box, in units of its longest side, so that shifting and scaling do no harm. Marking
//   never moves a coordinate that touches the box and moves none out of it: the box of the marked model is the same to the
//   last bit.
// - Twins take the bit of the first of them, and only that one is read.
// - Votes are weighted by how near a coordinate is to the middle of its cell.
// - Noise moves the corners of the box. The reader tries, axis by axis, ends up to two steps off and takes those with the
//   clearest votes. As a shift by a whole cell inverts every bit as clearly, sixteen more bits, always 0, are written.
// Strength: the step, as a share of the longest side. Vertices move by about one step (root mean square): 2.5e-4 stays below
// LIRIS's geometric limit.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "peer_mesh.h"
#include "qim.h"
#include "welded_peer.h"

namespace quadmark::bench {
namespace {

struct Box {
  std::array<double, 3> low{}, high{};
  double side = 0;  // the longest

  explicit Box(const std::vector<double>& positions) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      double &least = low[i % 3], &most = high[i % 3];
      least = i < 3 ? positions[i] : std::min(least, positions[i]);
      most = i < 3 ? positions[i] : std::max(most, positions[i]);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) side = std::max(side, high[axis] - low[axis]);
  }
};

// A coordinate that does not touch the box, from its lower end.
struct Inside {
  std::uint32_t vertex;  // of the file
  double x;
};

// Where the marked model's box was: its coordinates are low + scale * x.
struct Ends {
  double low = 0, scale = 1;
};

Ends clearestEnds(const std::vector<Inside>& inside, double room, double step, const KeyedBits& bits) {
  constexpr int kSteps = 2, kParts = 4;
  constexpr std::size_t kEnough = 4000;  // coordinates are looked at; more would only take time
  const std::size_t stride = inside.size() / kEnough + 1;
  Ends best;
  double clearest = 0;
  // Nearest ends first, which win where nothing is clear.
  for (int far = 0; far <= kSteps * kParts; ++far) {
    for (int low = -far; low <= far; ++low) {
      for (int high = -far; high <= far; ++high) {
        if (std::max(std::abs(low), std::abs(high)) != far) continue;
        const Ends ends{low * step / kParts, 1 + (high - low) * step / kParts / room};
        BitVotes votes(bits);
        for (std::size_t i = 0; i < inside.size(); i += stride)
          votes.add(inside[i].vertex, qimVote(ends.low + ends.scale * inside[i].x, step));
        const double clear = votes.clearness();
        if (clear > clearest) {
          clearest = clear;
          best = ends;
        }
      }
    }
  }
  return best;
}

class IndexQim final : public WeldedPeer {
 public:
  std::string name() const override { return "index-qim"; }
  PeerInfo info() const override {
    return {"B. Chen, G. W. Wornell",
            "Quantization index modulation (of coordinates, in file order)",
            "common practice after IEEE Transactions on Information Theory 47(4)",
            2001,
            true,
            "a coordinate of a vertex",
            describe(settings()),
            "coordinates are relative to the bounding box, which marking never changes; twins carry the first one's bit",
            "exact while errors stay below a quarter of the step and the order of vertices is kept; lost after reordering"};
  }

 protected:
  std::vector<Setting> settings() const override { return {{"strength", 2.5e-4, 1e-6, 0.05}}; }
  std::size_t pilots() const override { return kPilots; }

  void write(const Work& work, const Bits& written, std::vector<double>& moved, TrialMark& mark) const override {
    const std::vector<std::uint32_t> first = firstTwins(work.welded);
    const Box box(moved);
    const double step = work.values[0] * box.side;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const std::size_t axis = i % 3;
      const double room = box.high[axis] - box.low[axis], cells = std::floor(room / step);
      if (moved[i] == box.low[axis] || moved[i] == box.high[axis] || cells < 2) continue;
      const bool one = work.bits.held(written, first[i / 3]);
      moved[i] = box.low[axis] + qimNearest(moved[i] - box.low[axis], step, one, 0, cells - 1);
      ++mark.carriers;
    }
  }

  void vote(const Work& work, BitVotes& votes) const override {
    const std::vector<double>& positions = work.welded.positions;
    const std::vector<std::uint32_t> first = firstTwins(work.welded);
    const Box box(positions);
    if (!(box.side > 0)) return;
    const double step = work.values[0] * box.side;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<Inside> inside;
      for (std::size_t w = 0; w < first.size(); ++w) {
        const double x = positions[3 * w + axis];
        if (x > box.low[axis] && x < box.high[axis]) inside.push_back({first[w], x - box.low[axis]});
      }
      const Ends ends = clearestEnds(inside, box.high[axis] - box.low[axis], step, work.bits);
      for (const Inside& c : inside) votes.add(c.vertex, qimVote(ends.low + ends.scale * c.x, step));
    }
  }
};

}  // namespace

std::unique_ptr<Peer> indexQim() {
  return std::make_unique<IndexQim>();
}

}  // namespace quadmark::bench
