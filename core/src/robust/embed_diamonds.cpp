// SPDX-License-Identifier: MIT
#include "embed_diamonds.h"

#include <algorithm>
#include <array>
#include <utility>

#include "diamond_queues.h"
#include "survival.h"

namespace quadmark::robust {
namespace {

bool isFree(const Diamond& q, const std::vector<std::uint8_t>& occupied) {
  return (occupied[q.a] | occupied[q.b] | occupied[q.c] | occupied[q.d]) == 0;
}

class Writer {
 public:
  Writer(const Surface& surface, const FacesAround& facesAround, const DiamondLimits& limits,
         const ChangeMeter* change, std::vector<std::uint8_t>& occupied, std::vector<double>& positions)
      : surface_(surface),
        facesAround_(facesAround),
        limits_(limits),
        change_(change),
        occupied_(occupied),
        positions_(positions) {}

  // Moves the four vertices by the least total displacement that brings both diagonals to meet at the fine cell's
  // centre. False, with everything as it was, when a face turns or a vertex moves too far.
  bool write(const Diamond& q, double edgeRatio, double spanRatio) {
    const std::array<std::uint32_t, 4> vertex = {q.a, q.b, q.c, q.d};
    std::array<Vec3, 4> old;
    for (int k = 0; k < 4; ++k) old[k] = at(positions_, vertex[k]);
    const double weight[4] = {1 - spanRatio, -(1 - edgeRatio), spanRatio, -edgeRatio};
    Vec3 gap;
    double norm = 0;
    for (int k = 0; k < 4; ++k) gap += weight[k] * old[k], norm += weight[k] * weight[k];
    bool bad = false;
    for (int k = 0; k < 4; ++k) {
      const Vec3 move = (-weight[k] / norm) * gap;
      put(positions_, vertex[k], old[k] + move);
      const double farthest = length(move);
      bad = bad || farthest > limits_.maxMove ||
            (change_ != nullptr && slideOf(move, change_->normal(vertex[k])) > limits_.maxSlide);
    }
    bad = bad || anyFaceTurns(surface_, facesAround_, q, limits_.turnCosine, positions_);
    if (bad) {
      for (int k = 0; k < 4; ++k) put(positions_, vertex[k], old[k]);
      return false;
    }
    for (const std::uint32_t v : vertex) occupied_[v] = 1;
    return true;
  }

 private:
  const Surface& surface_;
  const FacesAround& facesAround_;
  const DiamondLimits& limits_;
  const ChangeMeter* change_;
  std::vector<std::uint8_t>& occupied_;
  std::vector<double>& positions_;
};

}  // namespace

bool anyFaceTurns(const Surface& surface, const FacesAround& facesAround, const Diamond& diamond, double turnCosine,
                  const std::vector<double>& positions) {
  const std::array<std::uint32_t, 4> vertex = {diamond.a, diamond.b, diamond.c, diamond.d};
  for (int k = 0; k < 4; ++k)
    for (const std::uint32_t f : facesAround.of(vertex[k])) {
      const auto face = surface.face(f);
      // Those at an earlier one of the four have been looked at.
      bool seen = false;
      for (const std::uint32_t v : face)
        for (int j = 0; j < k; ++j) seen |= v == vertex[j];
      if (seen) continue;
      const Vec3 before = areaVector(face, surface.welded.positions), after = areaVector(face, positions);
      if (dot(before, after) < turnCosine * length(before) * length(after)) return true;
    }
  return false;
}

DiamondCandidates findCandidates(const Surface& surface, std::vector<Diamond> diamonds, const DeltaClass& shape,
                                 const DiamondLimits& limits, const std::vector<std::uint8_t>& creased,
                                 const std::vector<std::uint8_t>& occupied, const std::vector<double>& positions) {
  std::vector<Candidate> items;
  const Survival survival(surface, positions);
  DiamondShape s;
  for (const Diamond& q : diamonds) {
    if (!isFree(q, occupied) || !isFree(q, creased)) continue;
    if (!diamondShape(positions, q, s) || s.gapLength > limits.mostGap * std::min(s.edgeLength, s.spanLength)) continue;
    const auto [edge, span] = ratiosOf(s);
    if (!fineCell(edge, span, shape).isIn(shape)) continue;
    diamonds[items.size()] = q;
    items.push_back({static_cast<float>(edge), static_cast<float>(span), static_cast<float>(s.edgeLength),
                     static_cast<float>(s.spanLength), static_cast<float>(s.gapLength), survival.reluctance(q)});
  }
  diamonds.resize(items.size());
  diamonds.shrink_to_fit();
  return {std::move(diamonds), std::move(items)};
}

DiamondEmbedding embedDiamonds(const Surface& surface, const FacesAround& facesAround,
                               DiamondCandidates candidates, const Constellation& constellation,
                               const CodedPayload& payload, const DiamondLimits& limits, const ChangeMeter* change,
                               std::vector<std::uint8_t>& occupied, std::vector<double>& positions) {
  DiamondEmbedding out;
  const DeltaClass& shape = constellation.shape();
  Writer writer(surface, facesAround, limits, change, occupied, positions);
  auto& [diamonds, items] = candidates;

  // 1. The good fine cells: those whose meaning is what the payload says.
  const std::vector<std::uint32_t> goodSymbols = constellation.goodSymbols(payload);
  std::vector<std::uint32_t> goodCells;
  for (std::uint32_t cell = 0; cell < shape.cells(); ++cell) {
    const std::uint32_t meaning = constellation.meaning(cell);
    if (meaning == Constellation::kNone) continue;
    if (goodSymbols[meaning / constellation.symbols()] == meaning % constellation.symbols()) goodCells.push_back(cell);
  }
  const double perCell = static_cast<double>(surface.vertexCount()) / static_cast<double>(goodCells.size());
  const auto farShare =
      static_cast<std::uint32_t>(std::clamp(limits.farQuota * perCell, limits.leastFar, limits.mostFar));
  const auto wanted = static_cast<std::uint32_t>(std::max(32.0, perCell));

  // 2. Generations: queues of the cheapest pairs, served round-robin; then again with the diamonds still free.
  std::vector<std::uint32_t> copies(goodCells.size(), 0);
  constexpr int kGenerations = 6;
  for (int generation = 0; generation < kGenerations; ++generation) {
    const DiamondQueues queues(items, shape, goodCells, wanted);
    std::vector<std::size_t> next(goodCells.size(), 0);
    const std::size_t before = out.cells.size();
    for (bool any = true; any;) {
      any = false;
      for (std::size_t g = 0; g < goodCells.size(); ++g)
        while (next[g] < queues.size(g)) {
          if (next[g] >= queues.nearCount(g) && copies[g] >= farShare) break;
          const std::uint32_t candidate = queues.candidate(g, next[g]++);
          const Diamond& q = diamonds[candidate];
          DiamondShape s;
          if (!isFree(q, occupied) || !diamondShape(positions, q, s)) continue;
          const FineCell cell = FineCell::ofNumber(goodCells[g], shape);
          const double edge = edgeCentre(cell.edge, shape), span = spanCentre(cell.span, shape);
          const bool turned = s.alongEdge >= 0.5;  // as in ratiosOf()
          if (!writer.write(q, turned ? 1 - edge : edge, turned ? 1 - span : span)) {
            ++out.vetoed;
            continue;
          }
          out.cells.push_back({q, constellation.meaning(goodCells[g]), items[candidate].gap});
          ++copies[g];
          any = true;
          break;
        }
    }
    if (out.cells.size() - before <= out.cells.size() / 50) break;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (!isFree(diamonds[i], occupied)) continue;
      diamonds[kept] = diamonds[i];
      items[kept++] = items[i];
    }
    diamonds.resize(kept);
    items.resize(kept);
  }
  return out;
}

}  // namespace quadmark::robust
