// SPDX-License-Identifier: MIT
#include "diamond_queues.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace quadmark::robust {
namespace {

// Sliding along a diagonal moves texture but hardly the surface, so it counts less than closing the gap.
constexpr float kSlideWeight = 0.1f;

// Bins of a cost: the leading bits of a float, which grow with it.
constexpr std::uint32_t kCostBins = 512;
std::uint32_t costBin(float cost) {
  std::uint32_t bits;
  std::memcpy(&bits, &cost, sizeof bits);
  const std::uint32_t lowest = 0x2f800000u >> 19;  // 2^-32; 16 bins per octave
  bits >>= 19;
  return bits < lowest ? 0 : std::min(bits - lowest, kCostBins - 1);
}

struct GoodCell {
  int edgeCell, spanCell;
  float edgeCentre, spanCentre;
};

// Per pair of a candidate and a good cell within reach: visit(good cell, cost, far). Costs are squares: only their
// order counts, and a pair is looked at some hundred times per vertex.
template <class Visit>
void forEachPair(const Candidate& c, const DeltaClass& shape, const std::vector<GoodCell>& good, const Visit& visit) {
  const FineCell own = fineCell(c.edgeRatio, c.spanRatio, shape);
  const int edgeCell = static_cast<int>(own.edge), spanCell = static_cast<int>(own.span);
  const float shorter = std::min(c.edgeLength, c.spanLength), scale = c.reluctance / shorter;
  const float edgeWeight = kSlideWeight * c.edgeLength * c.edgeLength * scale * scale;
  const float spanWeight = kSlideWeight * c.spanLength * c.spanLength * scale * scale;
  const float gapCost = c.gap * c.gap * scale * scale;
  for (std::uint32_t i = 0; i < good.size(); ++i) {
    const int away = std::max(std::abs(good[i].edgeCell - edgeCell), std::abs(good[i].spanCell - spanCell));
    if (away > DiamondQueues::kFar) continue;
    const float edge = good[i].edgeCentre - c.edgeRatio, span = good[i].spanCentre - c.spanRatio;
    visit(i, edgeWeight * edge * edge + spanWeight * span * span + gapCost, away > DiamondQueues::kNear);
  }
}

}  // namespace

DiamondQueues::DiamondQueues(const std::vector<Candidate>& candidates, const DeltaClass& shape,
                             const std::vector<std::uint32_t>& goodCells, std::uint32_t wanted) {
  const std::size_t good = goodCells.size();
  std::vector<GoodCell> cells;
  for (const std::uint32_t cell : goodCells) {
    const auto [edge, span] = FineCell::ofNumber(cell, shape);
    cells.push_back({static_cast<int>(edge), static_cast<int>(span), static_cast<float>(edgeCentre(edge, shape)),
                     static_cast<float>(spanCentre(span, shape))});
  }

  // 1. How many pairs of each cost there are, to find each queue's dearest cost.
  std::vector<std::uint32_t> histogram(good * 2 * kCostBins, 0);
  const auto row = [&](std::uint32_t cell, bool far) { return (std::size_t{cell} * 2 + far) * kCostBins; };
  for (const Candidate& c : candidates)
    forEachPair(c, shape, cells,
                [&](std::uint32_t cell, float cost, bool far) { ++histogram[row(cell, far) + costBin(cost)]; });
  std::vector<std::uint32_t> lastBin(good * 2, 0), cursor(good * 2, 0);
  ranges_.resize(good);
  std::uint32_t total = 0;
  for (std::uint32_t cell = 0; cell < good; ++cell) {
    ranges_[cell].begin = total;
    for (int far = 0; far < 2; ++far) {
      std::uint32_t kept = 0, bin = 0;
      for (; bin < kCostBins && kept < wanted; ++bin) kept += histogram[row(cell, far != 0) + bin];
      lastBin[2 * cell + far] = bin;
      cursor[2 * cell + far] = total;
      total += kept;
      (far == 0 ? ranges_[cell].far : ranges_[cell].end) = total;
    }
  }

  // 2. The pairs themselves, sorted per queue.
  entries_.resize(total);
  for (std::uint32_t i = 0; i < candidates.size(); ++i)
    forEachPair(candidates[i], shape, cells, [&](std::uint32_t cell, float cost, bool far) {
      const std::size_t queue = 2 * std::size_t{cell} + far;
      if (costBin(cost) < lastBin[queue]) entries_[cursor[queue]++] = {cost, i};
    });
  const auto cheaper = [](const QueueEntry& a, const QueueEntry& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.candidate < b.candidate;
  };
  for (const Range& r : ranges_) {
    std::sort(entries_.begin() + r.begin, entries_.begin() + r.far, cheaper);
    std::sort(entries_.begin() + r.far, entries_.begin() + r.end, cheaper);
  }
}

}  // namespace quadmark::robust
