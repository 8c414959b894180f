// SPDX-License-Identifier: MIT
// Which piece goes into which cell: round robin (D17), along a space-filling curve, cheapest fit inside small windows.
//
// Along a Morton curve each run of n cells carries each of the n pieces once, so every piece is repeated equally often
// and its copies are spread over the model: a crop loses copies evenly. Inside a window of kWindow neighbouring cells
// the pieces may be exchanged, which costs nothing in balance and saves most of the distortion: of 64 pieces one
// nearly fits the ratios a cell has anyway.
#include <algorithm>
#include <array>
#include <deque>

#include "concat.h"
#include "embedder.h"
#include "sorting.h"

namespace quadmark {
namespace {

constexpr std::size_t kWindow = 32;
constexpr std::size_t kScarceRepeats = 8;

using Row = std::array<double, kWindow>;  // one number for each of a window's pieces

// For each label met in a window, the ratio that each of the window's pieces asks for: what makes the cost table a plain
// loop over numbers.
class LabelRows {
 public:
  template <class RatioOf>
  const Row& find(std::uint32_t prefix1, std::uint32_t prefix2, const RatioOf& ratioOf) {
    const std::uint64_t label = std::uint64_t{prefix1} << 32 | prefix2;
    const auto at = std::find(labels_.begin(), labels_.end(), label);
    const auto row = static_cast<std::size_t>(at - labels_.begin());
    if (at == labels_.end()) {
      labels_.push_back(label);
      rows_.emplace_back();
      for (std::size_t j = 0; j < kWindow; ++j) rows_.back()[j] = ratioOf(j);
    }
    return rows_[row];
  }

 private:
  std::vector<std::uint64_t> labels_;
  std::deque<Row> rows_;
};

constexpr double kIllegal = 1e30;

// A diagonal of a cell: its ratio, and what a step of it costs.
struct Side {
  double ratio, weight;
};

// Lowers costs to those of the ratios to1 and to2 where these are far enough apart and not too large. A loop over
// numbers alone, without branches, so that it vectorises.
void lowerCosts(const Row& to1, const Row& to2, Side side1, Side side2, double leastApart, double largest, Row& costs) {
  for (std::size_t j = 0; j < kWindow; ++j) {
    const double d1 = (to1[j] - side1.ratio) * side1.weight, d2 = (to2[j] - side2.ratio) * side2.weight;
    const double cost = d1 * d1 + d2 * d2;
    const double apart = to2[j] - to1[j] >= leastApart ? cost : kIllegal;
    const double legal = to2[j] <= largest ? apart : kIllegal;
    costs[j] = legal < costs[j] ? legal : costs[j];
  }
}

std::uint64_t spread(std::uint64_t x) {  // two zero bits between the lower 21 bits
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffffu;
  x = (x | x << 16) & 0x1f0000ff0000ffu;
  x = (x | x << 8) & 0x100f00f00f00f00fu;
  x = (x | x << 4) & 0x10c30c30c30c30c3u;
  return (x | x << 2) & 0x1249249249249249u;
}

}  // namespace

double Embedder::coarseness(const Quad& quad) const {
  const double unit = rounding_.unit(quad, positions_.data());
  const double digit = std::min(codec_.indexSlot().cellWidth(), codec_.pieceSlot().cellWidth());
  return unit / std::min(quad.lengthAC, quad.lengthBD) / digit;
}

Status Embedder::assign() {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < cells_.size(); ++i) {
    const Quad& q = cells_[i].quad;
    if (coarseness(q) > kMaxCoarseness) {
      ++report_.unusableCells;
      continue;
    }
    const double r1 = std::min(q.ratioAC, q.ratioBD), r2 = std::max(q.ratioAC, q.ratioBD);
    if (pad_.carries(codec_.indexSlot().read(r1).prefix, codec_.pieceSlot().read(r2).prefix))
      order.push_back(i);
    else
      planDecoy(cells_[i], i);
  }
  report_.cells = static_cast<std::uint32_t>(order.size());
  const auto pieces = static_cast<std::uint32_t>(pieces_.size());
  if (order.size() < pieces) {
    const std::uint64_t capacity = 3ull * codec_.pieceSlot().digitCount() * order.size();
    return Error{
        ErrorCode::capacity,
        concat(
            "the payload of ", bits_.size(), " bits needs ", pieces, " cells, the model offers ", order.size(),
            " usable ones (", capacity, " bits) of ", cells_.size(), " found in ", welded_.vertexCount(), " vertices",
            (report_.unusableCells == 0
                 ? std::string()
                 : concat("; ", report_.unusableCells, " are too small for the precision of the file's coordinates")))};
  }

  scarce_ = order.size() < kScarceRepeats * pieces;

  std::array<double, 3> low, high;
  low.fill(1e300), high.fill(-1e300);
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], positions_[i]);
    high[i % 3] = std::max(high[i % 3], positions_[i]);
  }
  std::vector<KeyedIndex> curve;
  curve.reserve(order.size());
  for (std::uint32_t i : order) {
    const double* p = &positions_[3 * std::size_t{cells_[i].quad.a}];
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k)
      code |= spread(static_cast<std::uint64_t>((p[k] - low[k]) / diagonal_ * 65535)) << k;
    curve.push_back({code, i});
  }
  sortByKey(curve);
  for (std::size_t i = 0; i < curve.size(); ++i) order[i] = curve[i].index;
  // Where many cells are coarse, each piece gets one of the finest cells first, so that none depends on coarse ones alone.
  const auto fine = std::count_if(order.begin(), order.end(),
                                  [&](std::uint32_t i) { return coarseness(cells_[i].quad) <= kFineCoarseness; });
  if (static_cast<std::size_t>(fine) < 2 * std::size_t{pieces} && order.size() > pieces) {
    std::vector<double> all;
    for (std::uint32_t i : order) all.push_back(coarseness(cells_[i].quad));
    std::vector<double> sorted = all;
    std::nth_element(sorted.begin(), sorted.begin() + pieces - 1, sorted.end());
    const double limit = sorted[pieces - 1];
    std::vector<std::uint32_t> fineOnes, others;
    for (std::uint32_t i : order) (coarseness(cells_[i].quad) <= limit ? fineOnes : others).push_back(i);
    std::copy(others.begin(), others.end(), std::copy(fineOnes.begin(), fineOnes.end(), order.begin()));
  }

  copies_.assign(pieces, 0);
  for (std::size_t block = 0; block < order.size(); block += pieces)
    for (std::uint32_t first = 0; first < pieces; first += kWindow) {
      if (block + first >= order.size()) break;
      const std::size_t count = std::min({kWindow, std::size_t{pieces - first}, order.size() - block - first});
      assignWindow({order.data() + block + first, count}, first);
    }
  return adoptOrphans(order);
}

// A piece whose every cell refused it (no legal ratio pair near enough) takes a cell from one of the richest pieces.
Status Embedder::adoptOrphans(const std::vector<std::uint32_t>& order) {
  for (std::uint32_t piece = 0; piece < copies_.size(); ++piece) {
    if (copies_[piece] > 0) continue;
    bool adopted = false;
    for (std::uint32_t least = *std::max_element(copies_.begin(), copies_.end()); least >= 2 && !adopted; --least)
      for (std::uint32_t cell : order) {
        const std::uint32_t former = cells_[cell].piece;
        if (former == kNoPiece || copies_[former] != least) continue;
        PlannedCell changed = cells_[cell];
        if (!plan(changed, piece)) continue;
        cells_[cell] = changed;
        --copies_[former];
        ++copies_[piece];
        adopted = true;
        break;
      }
    if (!adopted)
      return Error{ErrorCode::capacity, concat("piece ", piece, " of ", copies_.size(), " fits into none of the ",
                                               order.size(), " usable cells")};
  }
  return okStatus();
}

// Greedy from the cheapest pair, then pairwise exchanges: within a per cent or two of the optimal assignment on real
// models at a fraction of the Hungarian method's cubic cost.
void Embedder::assignWindow(std::span<std::uint32_t> cells, std::uint32_t firstPiece) {
  const std::size_t n = cells.size();
  for (const std::uint32_t cell : cells) __builtin_prefetch(&cells_[cell].quad.ratioAC);  // far apart in memory
  std::array<float, kWindow * kWindow> cost;
  const DigitSlot &index = codec_.indexSlot(), &piece = codec_.pieceSlot();
  LabelRows rows;
  for (std::size_t i = 0; i < n; ++i) {
    const Quad& q = cells_[cells[i]].quad;
    const bool acFirst = q.ratioAC <= q.ratioBD;
    const Side ac = {q.ratioAC, q.lengthAC}, bd = {q.ratioBD, q.lengthBD};
    const Side side1 = acFirst ? ac : bd, side2 = acFirst ? bd : ac;
    const std::uint32_t natural1 = index.read(side1.ratio).prefix, natural2 = piece.read(side2.ratio).prefix;
    Row best, to1;
    best.fill(kIllegal);
    // The present prefixes and their neighbours; plan() will look further. Among them the order of the ratios decides.
    for (std::uint32_t p1 = natural1 - (natural1 > 0); p1 <= natural1 + 1; ++p1) {
      const double from = index.centre(p1, firstPiece), step = index.cellWidth();
      for (std::size_t j = 0; j < kWindow; ++j) to1[j] = from + static_cast<double>(static_cast<int>(j)) * step;
      for (std::uint32_t p2 = std::max(natural2 - (natural2 > 0), p1); p2 <= natural2 + 1; ++p2) {
        const Row& to2 = rows.find(p1, p2, [&](std::size_t j) {
          return j < n ? piece.centre(p2, padded_(static_cast<std::uint32_t>(firstPiece + j), p1, p2)) : 1.0;
        });
        lowerCosts(to1, to2, side1, side2, codec_.leastApart(), piece.maxRatio(), best);
      }
    }
    for (std::size_t j = 0; j < n; ++j) cost[i * n + j] = static_cast<float>(best[j]);
  }
  std::array<std::uint32_t, kWindow> chosen;
  std::array<bool, kWindow> taken{};
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t best = n;
    for (std::size_t j = 0; j < n; ++j)
      if (!taken[j] && (best == n || cost[i * n + j] < cost[i * n + best])) best = j;
    taken[best] = true;
    chosen[i] = static_cast<std::uint32_t>(best);
  }
  bool improved = true;
  for (int round = 0; improved && round < 8; ++round) {
    improved = false;
    for (std::size_t i = 0; i + 1 < n; ++i)
      for (std::size_t k = i + 1; k < n; ++k) {
        const float now = cost[i * n + chosen[i]] + cost[k * n + chosen[k]];
        const float swapped = cost[i * n + chosen[k]] + cost[k * n + chosen[i]];
        if (swapped < now) {
          std::swap(chosen[i], chosen[k]);
          improved = true;
        }
      }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t p = firstPiece + chosen[i];
    if (plan(cells_[cells[i]], p)) {
      ++copies_[p];
    } else {
      ++report_.unusableCells;
      --report_.cells;
    }
  }
}

}  // namespace quadmark
