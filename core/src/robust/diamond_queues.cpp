// SPDX-License-Identifier: MIT
#include "diamond_queues.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace quadmark::robust {
namespace {

// Sliding along a diagonal moves texture but hardly the surface, so it counts less than closing the gap.
constexpr float kSlideWeight = 0.1f;

// Bins of a cost: its leading bits. 16 bins per octave from 2^-32 on.
constexpr int kBinShift = 19;
constexpr std::uint32_t kCostBins = 512, kLowestBin = 0x2f800000u >> kBinShift;
std::uint32_t costBin(std::uint64_t pair) {
  const auto bin = static_cast<std::uint32_t>(pair >> (32 + kBinShift));
  return bin < kLowestBin ? 0 : std::min(bin - kLowestBin, kCostBins - 1);
}
std::uint32_t bitsOf(float cost) {
  std::uint32_t bits;
  std::memcpy(&bits, &cost, sizeof bits);
  return bits;
}
float leastOfBin(std::uint32_t bin) {
  if (bin == kCostBins) return std::numeric_limits<float>::infinity();
  const std::uint32_t bits = (bin + kLowestBin) << kBinShift;
  float cost;
  std::memcpy(&cost, &bits, sizeof cost);
  return cost;
}

}  // namespace

void DiamondQueues::Queue::prune(std::uint32_t wanted) {
  std::array<std::uint32_t, kCostBins> histogram{};
  for (const std::uint64_t pair : pairs) ++histogram[costBin(pair)];
  std::uint32_t kept = 0, bin = 0;
  for (; bin < kCostBins && kept < wanted; ++bin) kept += histogram[bin];
  limit = leastOfBin(bin);
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), [&](std::uint64_t pair) { return costBin(pair) >= bin; }),
              pairs.end());
}

// Half as many more as are kept: few prunings for little memory.
void DiamondQueues::Queue::reserve(std::size_t kept) {
  pruneAt = kept + kept / 2 + 1;
  pairs.reserve(pruneAt);
}

DiamondQueues::DiamondQueues(const std::vector<Candidate>& candidates, const DeltaClass& shape,
                             const std::vector<std::uint32_t>& goodCells, std::uint32_t wanted)
    : queues_(2 * goodCells.size()) {
  for (Queue& queue : queues_) queue.reserve(wanted);
  // Where the good cells from each number on begin: those of a row within reach are neighbours in the list.
  std::vector<std::uint32_t> firstFrom(shape.cells() + 1);
  for (std::uint32_t number = 0, g = 0; number <= shape.cells(); ++number) {
    firstFrom[number] = g;
    if (g < goodCells.size() && goodCells[g] == number) ++g;
  }
  const int rows = static_cast<int>(shape.side), columns = static_cast<int>(shape.spanSide());
  std::vector<float> edgeCentres, spanCentres;
  for (int row = 0; row < rows; ++row) edgeCentres.push_back(static_cast<float>(edgeCentre(row, shape)));
  for (int column = 0; column < columns; ++column)
    spanCentres.push_back(static_cast<float>(spanCentre(column, shape)));

  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    const Candidate& c = candidates[i];
    const FineCell own = fineCell(c.edgeRatio, c.spanRatio, shape);
    const int ownRow = static_cast<int>(own.edge), ownColumn = static_cast<int>(own.span);
    // Costs are squares: only their order counts, and a pair is looked at some hundred times per vertex.
    const float shorter = std::min(c.edgeLength, c.spanLength), scale = c.reluctance / shorter;
    const float edgeWeight = kSlideWeight * c.edgeLength * c.edgeLength * scale * scale;
    const float spanWeight = kSlideWeight * c.spanLength * c.spanLength * scale * scale;
    const float gapCost = c.gap * c.gap * scale * scale;
    const int left = std::max(0, ownColumn - kFar), right = std::min(columns, ownColumn + kFar + 1);
    const int bottom = std::min(rows, ownRow + kFar + 1);
    for (int row = std::max(0, ownRow - kFar); row < bottom; ++row) {
      const float edge = edgeCentres[row] - c.edgeRatio, edgeCost = edgeWeight * edge * edge;
      const bool rowIsFar = std::abs(row - ownRow) > kNear;
      const std::uint32_t end = firstFrom[row * columns + right];
      for (std::uint32_t g = firstFrom[row * columns + left]; g < end; ++g) {
        const int column = static_cast<int>(goodCells[g]) - row * columns;
        const float span = spanCentres[column] - c.spanRatio;
        const float cost = edgeCost + spanWeight * span * span + gapCost;
        Queue& queue = queues_[2 * g + (rowIsFar || std::abs(column - ownColumn) > kNear)];
        if (!(cost < queue.limit)) continue;
        queue.pairs.push_back(std::uint64_t{bitsOf(cost)} << 32 | i);
        if (queue.pairs.size() < queue.pruneAt) continue;
        queue.prune(wanted);
        queue.reserve(std::max<std::size_t>(queue.pairs.size(), wanted));
      }
    }
  }
  for (Queue& queue : queues_) {
    queue.prune(wanted);
    std::sort(queue.pairs.begin(), queue.pairs.end());
  }
}

}  // namespace quadmark::robust
