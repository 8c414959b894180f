// SPDX-License-Identifier: MIT
#include "diamond_queues.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace quadmark::robust {
namespace {

// Sliding along a diagonal moves texture but hardly the surface, so it counts less than closing the gap.
constexpr double kSlideWeight = 0.1;

// Bins of a cost: the leading bits of a float, which grow with it.
constexpr std::uint32_t kCostBins = 512;
std::uint32_t costBin(float cost) {
  std::uint32_t bits;
  std::memcpy(&bits, &cost, sizeof bits);
  const std::uint32_t lowest = 0x36800000u >> 19;  // 2^-18; 16 bins per octave
  bits >>= 19;
  return bits < lowest ? 0 : std::min(bits - lowest, kCostBins - 1);
}

// Per pair of a candidate and a good cell within reach: visit(good cell, cost, far).
template <class Visit>
void forEachPair(const Candidate& c, const DeltaClass& shape, const std::vector<std::uint32_t>& cellNumber,
                 const Visit& visit) {
  const int side = static_cast<int>(shape.side), reach = DiamondQueues::kFar;
  const int edgeCell = static_cast<int>(fineCell(c.edgeRatio, shape));
  const int spanCell = static_cast<int>(fineCell(c.spanRatio, shape));
  const double shorter = std::min(c.edgeLength, c.spanLength), gap2 = static_cast<double>(c.gap) * c.gap;
  for (int e = std::max(0, edgeCell - reach); e <= std::min(side - 1, edgeCell + reach); ++e) {
    const double alongEdge = (fineCentre(e, shape) - c.edgeRatio) * c.edgeLength;
    const bool farEdge = std::abs(e - edgeCell) > DiamondQueues::kNear;
    const std::uint32_t* row = cellNumber.data() + static_cast<std::size_t>(e) * shape.side;
    for (int s = std::max(0, spanCell - reach); s <= std::min(side - 1, spanCell + reach); ++s) {
      if (row[s] == Constellation::kNone) continue;
      const double alongSpan = (fineCentre(s, shape) - c.spanRatio) * c.spanLength;
      const double slide = alongEdge * alongEdge + alongSpan * alongSpan;
      const auto cost = static_cast<float>(c.reluctance * std::sqrt(kSlideWeight * slide + gap2) / shorter);
      visit(row[s], cost, farEdge || std::abs(s - spanCell) > DiamondQueues::kNear);
    }
  }
}

}  // namespace

DiamondQueues::DiamondQueues(const std::vector<Candidate>& candidates, const DeltaClass& shape,
                             const std::vector<std::uint32_t>& goodCells, std::uint32_t wanted) {
  const std::size_t good = goodCells.size();
  std::vector<std::uint32_t> cellNumber(shape.side * shape.side, Constellation::kNone);
  for (std::size_t i = 0; i < good; ++i) cellNumber[goodCells[i]] = static_cast<std::uint32_t>(i);

  // 1. How many pairs of each cost there are, to find each queue's dearest cost.
  std::vector<std::uint32_t> histogram(good * 2 * kCostBins, 0);
  const auto row = [&](std::uint32_t cell, bool far) { return (std::size_t{cell} * 2 + far) * kCostBins; };
  for (const Candidate& c : candidates)
    forEachPair(c, shape, cellNumber,
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
    forEachPair(candidates[i], shape, cellNumber, [&](std::uint32_t cell, float cost, bool far) {
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
