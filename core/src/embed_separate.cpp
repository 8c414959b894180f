// SPDX-License-Identifier: MIT
// Making the cells the only coplanar sets of their neighbourhoods (D20).
//
// On CAD models whole faces are flat: every set of four of their vertices is coplanar, and a decoder that finds them in
// another order, or with other diagonals after an affine map, reads something else. Instead of hoping that it does not,
// each unwanted coplanar set is broken: a free vertex is lifted, or a whole cell is tilted by a tiny affine map, which
// keeps its own plane and ratios exactly while it leaves the planes of its neighbours.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "embedder.h"
#include "sorting.h"

namespace quadmark {
namespace {

constexpr double kUnwantedUnits = 5;  // somewhat more than the decoder's kExactUnits
// Far beyond the decoder's tolerance, still only some 1e-5 of the model. Tried: 200 units; in flat regions each tilt then
// brings about as many new accidental sets as it breaks, and the rounds do not converge.
constexpr double kTiltUnits = 600;
constexpr int kRounds = 16;
// Breaking them is left out where each piece has this many copies and the unwanted sets are this few beside the cells: some
// false votes among so many decide nothing, and most large scans need no tilting at all.
constexpr std::uint32_t kPlentyOfCopies = 256;
constexpr std::size_t kFewBesideCells = 4;

double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Uniform in [-1.5, -0.5] or [0.5, 1.5]: never small.
double awayFromZero(std::uint64_t random) {
  const double u = static_cast<double>(random >> 12) * 0x1p-52 + 0.5;
  return (random & 1) != 0 ? u : -u;
}

struct Frame {
  double o[3], u[3], w[3], n[3], radius;
};

// Plane of a quadrilateral: crossing point, unit axes, unit normal.
Frame frameOf(const Quad& q, const double* positions) {
  Frame f{};
  const double *a = positions + 3 * std::size_t{q.a}, *b = positions + 3 * std::size_t{q.b},
               *c = positions + 3 * std::size_t{q.c}, *d = positions + 3 * std::size_t{q.d};
  double e[3], g[3];
  for (int k = 0; k < 3; ++k) e[k] = c[k] - a[k], g[k] = d[k] - b[k], f.o[k] = 0.25 * (a[k] + b[k] + c[k] + d[k]);
  f.n[0] = e[1] * g[2] - e[2] * g[1], f.n[1] = e[2] * g[0] - e[0] * g[2], f.n[2] = e[0] * g[1] - e[1] * g[0];
  const double length = std::sqrt(dot(e, e)), normal = std::sqrt(dot(f.n, f.n));
  for (int k = 0; k < 3; ++k) f.u[k] = e[k] / length, f.n[k] /= normal;
  f.w[0] = f.n[1] * f.u[2] - f.n[2] * f.u[1], f.w[1] = f.n[2] * f.u[0] - f.n[0] * f.u[2],
  f.w[2] = f.n[0] * f.u[1] - f.n[1] * f.u[0];
  f.radius = 0.5 * q.longerDiagonal();
  return f;
}

// By their vertices in turn. CAD models have many.
void sortSets(std::span<std::array<std::uint32_t, 4>> sets) {
  std::vector<KeyedIndex> order(sets.size());
  for (const std::size_t half : {2, 0}) {  // what is equal in the first half keeps the order of the second
    for (std::uint32_t i = 0; i < sets.size(); ++i)
      order[i] = {std::uint64_t{sets[i][half]} << 32 | sets[i][half + 1], i};
    sortByKey(order);
    const std::vector<std::array<std::uint32_t, 4>> before(sets.begin(), sets.end());
    for (std::size_t i = 0; i < sets.size(); ++i) sets[i] = before[order[i].index];
  }
}

}  // namespace

void Embedder::tilt(PlannedCell& cell, std::uint64_t salt) {
  const Quad& q = cell.quad;
  const Frame f = frameOf(q, positions_.data());
  const double amplitude =
      std::min(kTiltUnits * rounding_.unit(q, positions_.data()), 0.1 * key_.params.lambda * diagonal_);
  const double alpha = amplitude * awayFromZero(pad_.decoy(3 * salt)), beta = amplitude * awayFromZero(pad_.decoy(3 * salt + 1)),
               gamma = amplitude * awayFromZero(pad_.decoy(3 * salt + 2));
  for (std::uint32_t v : {q.a, q.b, q.c, q.d}) {
    double* p = &positions_[3 * std::size_t{v}];
    const double r[3] = {p[0] - f.o[0], p[1] - f.o[1], p[2] - f.o[2]};
    const double height = alpha * dot(r, f.u) / f.radius + beta * dot(r, f.w) / f.radius + gamma;
    for (int k = 0; k < 3; ++k) p[k] += height * f.n[k];
  }
  settleCell(cell);
}

void Embedder::breakSet(const Quad& set, std::uint64_t salt, std::vector<std::uint8_t>& movedCell,
                        std::vector<std::uint32_t>& changed) {
  const std::array<std::uint32_t, 4> vertices = {set.a, set.b, set.c, set.d};
  for (std::uint32_t v : vertices) {
    if (cellOf_[v] != kNoVertex || isFixed(v)) continue;
    const Frame f = frameOf(set, positions_.data());
    const double height =
        std::min(kTiltUnits * rounding_.unit(set, positions_.data()), 0.1 * key_.params.lambda * diagonal_) *
        awayFromZero(pad_.decoy(3 * salt));
    for (int k = 0; k < 3; ++k) positions_[3 * std::size_t{v} + k] += height * f.n[k];
    round(v);
    changed.push_back(v);
    return;
  }
  // All four belong to cells or cannot move: tilt a cell, unless one has moved in this round.
  for (std::uint32_t v : vertices)
    if (cellOf_[v] != kNoVertex && movedCell[cellOf_[v]] != 0) return;
  std::uint32_t cell = kNoVertex;
  for (std::size_t i = 0; i < 4 && cell == kNoVertex; ++i) cell = cellOf_[vertices[(salt + i) % 4]];
  if (cell == kNoVertex) return;
  movedCell[cell] = 1;
  tilt(cells_[cell], salt);
  const Quad& q = cells_[cell].quad;
  changed.insert(changed.end(), {q.a, q.b, q.c, q.d});
}

bool Embedder::isCell(const Quad& set) const {
  const std::uint32_t ids[4] = {set.a, set.b, set.c, set.d};
  return haveOneOwner(ids, cellOf_);
}

// Brings flatSets_ up to date after a round: sets with a changed vertex are as `found` has them, all others as before.
void Embedder::updateFlatSets(const std::vector<Quad>& found, const std::vector<std::uint8_t>& isChanged) {
  if (!isChanged.empty())
    std::erase_if(flatSets_, [&](const VertexSet& set) {
      return std::any_of(set.begin(), set.end(), [&](std::uint32_t v) { return isChanged[v] != 0; });
    });
  const auto known = static_cast<std::ptrdiff_t>(flatSets_.size());
  for (const Quad& quad : found) {
    VertexSet set = {quad.a, quad.b, quad.c, quad.d};
    sortShort(set.begin(), set.end());
    if (!std::binary_search(flatSets_.begin(), flatSets_.begin() + known, set)) flatSets_.push_back(set);
  }
  sortSets(std::span(flatSets_).subspan(static_cast<std::size_t>(known)));
  std::vector<VertexSet> all(flatSets_.size());
  std::merge(flatSets_.begin(), flatSets_.begin() + known, flatSets_.begin() + known, flatSets_.end(), all.begin());
  flatSets_.swap(all);
}

bool Embedder::areHarmless(std::size_t unwanted) const {
  return *std::min_element(copies_.begin(), copies_.end()) >= kPlentyOfCopies && unwanted <= cells_.size() / kFewBesideCells;
}

void Embedder::separate() {
  std::vector<std::uint32_t> seeds;
  std::vector<std::uint8_t> movedCell(cells_.size()), isChanged;
  std::uint64_t salt = 1;
  for (int round = 0;; ++round) {
    std::vector<Quad> unwanted;
    forEachCoplanarSet(welded_, positions_, key_.params.k, rounding_, {kUnwantedUnits, 1.0}, {},
                       [&](const Quad& set) { unwanted.push_back(set); }, round == 0 ? nullptr : &seeds, &cellOf_);
    updateFlatSets(unwanted, isChanged);
    flatSetsKnown_ = true;
    // The last look is only to know what remains.
    if (unwanted.empty() || round == kRounds || areHarmless(unwanted.size())) return;
    std::fill(movedCell.begin(), movedCell.end(), std::uint8_t{0});
    isChanged.assign(welded_.vertexCount(), 0);
    std::vector<std::uint32_t> changed;
    for (const Quad& set : unwanted) {
      bool touched = false;
      for (std::uint32_t v : {set.a, set.b, set.c, set.d}) touched = touched || isChanged[v] != 0;
      if (touched) continue;  // probably broken already; the next round looks again
      const std::size_t before = changed.size();
      breakSet(set, salt++, movedCell, changed);
      for (std::size_t i = before; i < changed.size(); ++i) isChanged[changed[i]] = 1;
      if (changed.size() > before) ++report_.repairs;
    }
    // Look again only where something moved.
    std::vector<std::uint8_t> isSeed = isChanged;
    std::vector<std::uint32_t> around;
    for (std::uint32_t v : changed) {
      if (!neighbourhood(welded_, v, key_.params.k, around)) continue;
      for (std::uint32_t w : around) isSeed[w] = 1;
    }
    seeds.clear();
    for (std::uint32_t v = 0; v < isSeed.size(); ++v)
      if (isSeed[v] != 0) seeds.push_back(v);
  }
}

}  // namespace quadmark
