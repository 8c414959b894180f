// SPDX-License-Identifier: MIT
// Candidates of each good fine cell, cheapest displacement first, without storing all of them.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "constellation.h"

namespace quadmark::robust {

/// What it would cost to make a cell of a diamond.
struct Candidate {
  float edgeRatio, spanRatio;    ///< Ratios
  float edgeLength, spanLength;  ///< file units
  float gap;                     ///< file units
  float reluctance;              ///< factor on the cost: above 1 where simplification would collapse a vertex soon
};

/// Queues of the good cells for one generation: near candidates (within kNear fine cells) by cost, then far ones.
/// Of the many pairs of candidate and good cell only the cheapest, some `wanted` per good cell, are kept.
class DiamondQueues {
 public:
  static constexpr int kNear = 8, kFar = 24;

  /// @param goodCells  FineCell::number of each, ascending.
  DiamondQueues(const std::vector<Candidate>& candidates, const DeltaClass& shape,
                const std::vector<std::uint32_t>& goodCells, std::uint32_t wanted);

  /// Pairs of a good cell, and how many of them, the first ones, are near.
  [[nodiscard]] std::size_t size(std::size_t goodCell) const {
    return nearCount(goodCell) + queues_[2 * goodCell + 1].pairs.size();
  }
  [[nodiscard]] std::size_t nearCount(std::size_t goodCell) const { return queues_[2 * goodCell].pairs.size(); }
  /// The candidate of a pair: index into those given.
  [[nodiscard]] std::uint32_t candidate(std::size_t goodCell, std::size_t i) const {
    const std::size_t near = nearCount(goodCell);
    return static_cast<std::uint32_t>(i < near ? queues_[2 * goodCell].pairs[i]
                                               : queues_[2 * goodCell + 1].pairs[i - near]);
  }

 private:
  struct Queue {
    // The cost's bits, which order as it does, above the candidate's index. The cost is the square of the displacement
    // relative to the shorter diagonal, times reluctance squared.
    std::vector<std::uint64_t> pairs;
    float limit = std::numeric_limits<float>::infinity();  // dearer pairs have no chance any more
    std::size_t pruneAt = 0;                               // pairs

    // Forgets all but the `wanted` cheapest, and those that share a bin with the dearest of these.
    void prune(std::uint32_t wanted);
    void reserve(std::size_t kept);
  };
  std::vector<Queue> queues_;  // of each good cell: near, far
};

}  // namespace quadmark::robust
