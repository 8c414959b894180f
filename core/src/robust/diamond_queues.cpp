// SPDX-License-Identifier: MIT
#include "diamond_queues.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "parallel.h"

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

// Twice as many as are kept: few prunings for little memory.
void DiamondQueues::Queue::reserve(std::size_t kept) {
  pruneAt = 2 * kept + 1;
  pairs.reserve(pruneAt);
}

// A pair is looked at some hundred times per vertex, so candidates of one fine cell come together: they reach the same
// queues, whose centres and limits then lie side by side. What a queue keeps does not depend on the order.
DiamondQueues::DiamondQueues(const std::vector<Candidate>& candidates, const DeltaClass& shape,
                             const std::vector<std::uint32_t>& goodCells, std::uint32_t wanted)
    : queues_(2 * goodCells.size()) {
  const auto cellOf = [&](const Candidate& c) { return fineCell(c.edgeRatio, c.spanRatio, shape); };
  // Ratios at the very edge may round into a row or column beyond the last one.
  const std::uint32_t rowLength = shape.spanSide() + 1;
  const auto placeOf = [&](const Candidate& c) {
    const FineCell cell = cellOf(c);
    return std::min(cell.edge, shape.side) * rowLength + std::min(cell.span, shape.spanSide());
  };
  std::vector<std::uint32_t> begin((shape.side + 1) * rowLength + 1, 0), order(candidates.size());
  for (const Candidate& c : candidates) ++begin[placeOf(c)];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  for (std::uint32_t i = 0; i < candidates.size(); ++i) order[--begin[placeOf(candidates[i])]] = i;

  // The queues of some good cells. Every second one, then the others: threads share the crowded middle.
  const std::size_t half = (goodCells.size() + 1) / 2;
  const auto fill = [&](std::size_t first, std::size_t last) {
    struct Good {
      std::uint32_t index;
      FineCell cell;
    };
    std::vector<Good> goods;
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t g = i < half ? 2 * i : 2 * (i - half) + 1;
      goods.push_back({static_cast<std::uint32_t>(g), FineCell::ofNumber(goodCells[g], shape)});
      for (std::size_t q : {2 * g, 2 * g + 1}) queues_[q].reserve(wanted);
    }
    std::vector<Queue*> reached(goods.size());
    std::vector<float> edge(goods.size()), span(goods.size()), limit(goods.size()), cost(goods.size());
    for (std::size_t place = 0; place + 1 < begin.size(); ++place) {
      if (begin[place] == begin[place + 1]) continue;
      const FineCell own = cellOf(candidates[order[begin[place]]]);
      std::size_t count = 0;
      for (const Good& good : goods) {
        const int away = std::max(std::abs(static_cast<int>(good.cell.edge - own.edge)),
                                  std::abs(static_cast<int>(good.cell.span - own.span)));
        if (away > kFar) continue;
        reached[count] = &queues_[2 * good.index + (away > kNear)];
        limit[count] = reached[count]->limit;
        edge[count] = static_cast<float>(edgeCentre(good.cell.edge, shape));
        span[count++] = static_cast<float>(spanCentre(good.cell.span, shape));
      }
      for (std::uint32_t k = begin[place]; k < begin[place + 1]; ++k) {
        const Candidate& c = candidates[order[k]];
        // Costs are squares: only their order counts.
        const float shorter = std::min(c.edgeLength, c.spanLength), scale = c.reluctance / shorter;
        const float edgeWeight = kSlideWeight * c.edgeLength * c.edgeLength * scale * scale;
        const float spanWeight = kSlideWeight * c.spanLength * c.spanLength * scale * scale;
        const float gapCost = c.gap * c.gap * scale * scale;
        for (std::size_t j = 0; j < count; ++j) {
          const float e = edge[j] - c.edgeRatio, s = span[j] - c.spanRatio;
          cost[j] = edgeWeight * e * e + spanWeight * s * s + gapCost;
        }
        for (std::size_t j = 0; j < count; ++j) {
          if (!(cost[j] < limit[j])) continue;
          Queue& queue = *reached[j];
          queue.pairs.push_back(std::uint64_t{bitsOf(cost[j])} << 32 | order[k]);
          if (queue.pairs.size() < queue.pruneAt) continue;
          queue.prune(wanted);
          queue.reserve(std::max<std::size_t>(queue.pairs.size(), wanted));
          limit[j] = queue.limit;
        }
      }
    }
    for (const Good& good : goods)
      for (std::size_t q : {2 * good.index, 2 * good.index + 1}) {
        queues_[q].prune(wanted);
        std::sort(queues_[q].pairs.begin(), queues_[q].pairs.end());
      }
  };
  inParts(goodCells.size(), 1 + goodCells.size() * kLeastPart / (candidates.size() + 1), fill);
}

}  // namespace quadmark::robust
