// SPDX-License-Identifier: MIT
// Candidates of each good fine cell, cheapest displacement first, without storing all of them.
#pragma once

#include <cstdint>
#include <vector>

#include "constellation.h"

namespace quadmark::robust {

/// A diamond that may become a cell.
struct Candidate {
  std::uint32_t diamond;
  float edgeRatio, spanRatio;    ///< Ratios
  float edgeLength, spanLength;  ///< file units
  float gap;                     ///< file units
  float reluctance;              ///< factor on the cost: above 1 where simplification would collapse a vertex soon
};

/// One entry of a good cell's queue.
struct QueueEntry {
  float cost;               ///< square of the displacement relative to the shorter diagonal, times reluctance squared
  std::uint32_t candidate;  ///< index into the candidates given
};

/// Queues of the good cells for one generation: near candidates (within kNear fine cells) by cost, then far ones.
/// Of the many pairs of candidate and good cell only the cheapest, some `wanted` per good cell, are kept.
class DiamondQueues {
 public:
  static constexpr int kNear = 8, kFar = 24;

  struct Range {
    std::uint32_t begin = 0, far = 0, end = 0;  ///< of entries(): near ones, then far ones
  };

  /// @param goodCells  FineCell::number of each.
  DiamondQueues(const std::vector<Candidate>& candidates, const DeltaClass& shape,
                const std::vector<std::uint32_t>& goodCells, std::uint32_t wanted);

  [[nodiscard]] const Range& range(std::size_t goodCell) const { return ranges_[goodCell]; }
  [[nodiscard]] const QueueEntry& entry(std::uint32_t i) const { return entries_[i]; }

 private:
  std::vector<Range> ranges_;
  std::vector<QueueEntry> entries_;
};

}  // namespace quadmark::robust
