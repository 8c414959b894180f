// SPDX-License-Identifier: MIT
// Verification after writing (D20): the decoder reads the output, a reordered copy and an affine copy.
#include <algorithm>
#include <cmath>
#include <utility>

#include "embedder.h"
#include "quadmark/extract.h"
#include "release.h"
#include "sorting.h"

namespace quadmark {

// The paper's affine attacks: R (45 degrees about x, then y), NS, SH and CB round anew. RE rounds nothing but exchanges
// the order of positions, by which the decoder breaks ties. S is exact in every respect.
const std::vector<Embedder::AffineMap>& Embedder::verificationMaps() {
  static const std::vector<AffineMap> maps = [] {
    const double c = std::sqrt(0.5);
    const AffineMap rotation = {c, 0.5, 0.5, 0, c, -c, -c, 0.5, 0.5};
    const AffineMap scale = {0.5, 0, 0, 0, 1.5, 0, 0, 0, 2};
    const AffineMap shear = {1, 1.5, 0, 0, 1, 0, 0, 0, 1};
    AffineMap combined = rotation;
    for (int column = 0; column < 3; ++column) {
      // NS, then RE (x -> -x), then S (one half), then SH (x + 1.5 y).
      const double x = -0.5 * 0.5 * combined[column], y = 0.5 * 1.5 * combined[3 + column],
                   z = 0.5 * 2 * combined[6 + column];
      combined[column] = x + 1.5 * y, combined[3 + column] = y, combined[6 + column] = z;
    }
    const AffineMap reflection = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
    return std::vector<AffineMap>{rotation, scale, shear, reflection, combined};
  }();
  return maps;
}

void Embedder::applyRounded(const AffineMap& m, const double* p, double* out) const {
  for (int row = 0; row < 3; ++row) {
    const double value = m[3 * row] * p[0] + m[3 * row + 1] * p[1] + m[3 * row + 2] * p[2];
    out[row] = mesh_.precision == Precision::float32 ? nearestFloat32(value) : value;
  }
}

// Pieces of which a bit is wrong or unread, ascending.
std::vector<std::uint32_t> Embedder::badPieces(const Extraction& read) const {
  const std::vector<std::uint32_t> target = scrambling(key_);
  const auto width = static_cast<std::uint32_t>(codec_.bitsPerPiece());
  std::vector<std::uint32_t> bad;
  for (std::size_t i = 0; i < bits_.size(); ++i)
    if (read.erased[i] || read.bits[i] != bits_[i]) bad.push_back(target[i] / width);
  sortCompactly(bad.begin(), bad.end());
  bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
  return bad;
}

// Breaks every set that votes for a piece it does not carry, and rewrites the cells of the pieces that suffer. What a
// rewrite does to the rounding is a matter of luck, so it is tried again until the decoder is satisfied.
void Embedder::repair(const std::vector<std::uint32_t>& bad, const Extraction& read, std::uint64_t& salt) {
  std::vector<std::uint8_t> isBad(pieces_.size(), 0), moved(cells_.size(), 0);
  for (std::uint32_t piece : bad) isBad[piece] = 1;
  flatSetsKnown_ = false;
  std::vector<std::uint32_t> changed;
  const auto rewrite = [&](std::uint32_t cell) {
    if (moved[cell] != 0) return;
    moved[cell] = 1;
    ++report_.repairs;
    tilt(cells_[cell], salt++);
  };
  for (const CellReading& r : read.readings) {
    if (r.weight <= 0 || isBad[r.reading.index] == 0) continue;
    Quad set;
    if (!makeQuad(r.vertices, positions_.data(), kMinTriangleReading, set)) continue;
    if (!isCell(set)) {
      ++report_.repairs;
      breakSet(set, salt++, moved, changed);
    } else if (cells_[cellOf_[set.a]].piece != r.reading.index) {
      rewrite(cellOf_[set.a]);  // a cell of another piece, misread
    }
  }
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
    if (cells_[cell].piece != kNoPiece && isBad[cells_[cell].piece] != 0) rewrite(cell);
}

// Checks the output itself. Returns the number of bad pieces.
std::size_t Embedder::check(bool mayRepair, std::uint64_t& salt) {
  const std::vector<std::uint32_t> bad = badPieces(read({}));
  if (mayRepair && !bad.empty()) repair(bad, read({.keepReadings = true}), salt);
  return bad.size();
}

// Checks the copy under an affine map. Positions that are float32 in the file are kept as such meanwhile: the copy is
// the largest thing that the verification needs.
std::size_t Embedder::checkMapped(const AffineMap& map, bool mayRepair, std::uint64_t& salt) {
  std::vector<float> kept32;
  std::vector<double> kept64;
  const bool narrow = mesh_.precision == Precision::float32 && mesh_.gridOf.empty();
  if (narrow)
    kept32.assign(positions_.begin(), positions_.end());
  else
    kept64 = positions_;
  for (std::size_t v = 0; v < positions_.size(); v += 3) {
    const double point[3] = {positions_[v], positions_[v + 1], positions_[v + 2]};
    applyRounded(map, point, &positions_[v]);
  }
  const bool known = std::exchange(flatSetsKnown_, false);  // what is flat in the copy is to be found out
  const std::span<const double> halfStep = std::exchange(rounding_.halfStep, {});  // a map leaves nothing on its grid
  Extraction first = read({});
  const std::vector<std::uint32_t> bad = badPieces(first);
  if (mayRepair && !bad.empty()) first = read({.keepReadings = true});
  if (narrow)
    positions_.assign(kept32.begin(), kept32.end());
  else
    positions_.swap(kept64);
  flatSetsKnown_ = known;
  rounding_.halfStep = halfStep;
  if (mayRepair && !bad.empty()) repair(bad, first, salt);
  return bad.size();
}

// Would a reader of the written file weld the same vertices? Not if rounding has made two of them coincide.
bool Embedder::weldsAlike() const {
  std::vector<std::uint32_t> group(mesh_.groups.empty() ? 0 : welded_.vertexCount());
  if (!group.empty())
    for (std::size_t v = 0; v < mesh_.vertexCount(); ++v)
      if (welded_.weldedOf[v] != kNoVertex) group[welded_.weldedOf[v]] = mesh_.groups[v];
  return !hasTwins(positions_, group);
}

// The decoder sees a file only through its welded mesh, so a file with permuted vertices and faces is the same welded
// mesh with other numbers. Giving this one other numbers saves the second weld and all the memory of a second mesh.
// Returns the order, old numbers: blocks of 1024 in scattered order, each back to front with a stride, far from the
// file's order but near in memory. The neighbours keep the old numbers until renumberEdges().
std::vector<std::uint32_t> Embedder::renumberVertices() {
  const std::uint32_t count = welded_.vertexCount();
  constexpr std::uint32_t kBlock = 1024;
  std::vector<std::uint32_t> oldOf, numberOf(count);
  oldOf.reserve(count);
  std::uint32_t blocks = 1;
  while (blocks < (count + kBlock - 1) / kBlock) blocks *= 2;
  for (std::uint32_t i = 0; i < blocks; ++i) {
    const std::uint32_t block = (i * 0x9e3779b1u + 0x7f4a7c15u) & (blocks - 1);  // odd factor: a permutation
    for (std::uint32_t k = 0; k < kBlock; ++k) {
      const std::uint64_t at = std::uint64_t{block} * kBlock + ((kBlock - 1 - k) * 397 & (kBlock - 1));
      if (at < count) oldOf.push_back(static_cast<std::uint32_t>(at));
    }
  }
  for (std::uint32_t number = 0; number < count; ++number) numberOf[oldOf[number]] = number;

  release(cellOf_);
  for (PlannedCell& cell : cells_)
    for (std::uint32_t* v : {&cell.quad.a, &cell.quad.b, &cell.quad.c, &cell.quad.d}) *v = numberOf[*v];
  for (VertexSet& set : flatSets_)
    for (std::uint32_t& v : set) v = numberOf[v];
  for (std::uint32_t& w : welded_.weldedOf)
    if (w != kNoVertex) w = numberOf[w];
  {
    std::vector<double> positions;
    positions.reserve(positions_.size());
    for (std::uint32_t old : oldOf) {
      const double* p = &positions_[3 * std::size_t{old}];
      positions.insert(positions.end(), p, p + 3);
    }
    positions_.swap(positions);
  }
  if (!welded_.halfStep.empty()) {
    std::vector<double> halfStep;
    halfStep.reserve(count);
    for (std::uint32_t old : oldOf) halfStep.push_back(welded_.halfStep[old]);
    welded_.halfStep.swap(halfStep);
    rounding_.halfStep = welded_.halfStep;
  }
  return oldOf;
}

void Embedder::renumberEdges(const std::vector<std::uint32_t>& oldOf) {
  std::vector<std::uint32_t> numberOf(oldOf.size());
  for (std::uint32_t number = 0; number < oldOf.size(); ++number) numberOf[oldOf[number]] = number;
  std::vector<std::uint32_t> offsets, neighbours;
  offsets.reserve(oldOf.size() + 1);
  neighbours.reserve(welded_.neighbours.size());
  for (std::uint32_t old : oldOf) {
    offsets.push_back(static_cast<std::uint32_t>(neighbours.size()));
    for (std::uint32_t neighbour : welded_.neighboursOf(old)) neighbours.push_back(numberOf[neighbour]);
    sortShort(neighbours.begin() + offsets.back(), neighbours.end());
  }
  offsets.push_back(static_cast<std::uint32_t>(neighbours.size()));
  welded_.edgeOffsets.swap(offsets);
  welded_.neighbours.swap(neighbours);
}

// Whether the decoder reads everything from a reordered copy. Nothing can be done with the embedder afterwards.
bool Embedder::checkReordered() {
  const std::vector<std::uint32_t> oldOf = renumberVertices();
  // The known flat sets are nearly always enough, and then the decoder does not ask for neighbours.
  if (flatSetsKnown_) {
    const Extraction fromKnown = read({.exactOnly = true});
    if (!fromKnown.cancelled) return badPieces(fromKnown).empty();
  }
  renumberEdges(oldOf);
  return badPieces(read({})).empty();
}

Extraction Embedder::read(ExtractOptions options) const {
  options.bitsOnly = true;
  // Right after separate() the sets that are flat in the output are known: the cells, and what could not be broken. Other
  // numbers change nothing about that: which sets are flat is decided by makeQuad(), whose arithmetic sees positions only.
  std::vector<VertexSet> sets;
  if (flatSetsKnown_) {
    sets.reserve(flatSets_.size() + cells_.size());
    sets = flatSets_;
    for (const PlannedCell& cell : cells_) sets.push_back({cell.quad.a, cell.quad.b, cell.quad.c, cell.quad.d});
    options.exactSets = sets;
  }
  return extractMesh(welded_, positions_, rounding_, key_, options);
}

Status Embedder::verify(const MeshProgress& progress) {
  constexpr int kAttempts = 12;
  std::uint64_t salt = std::uint64_t{1} << 32;  // apart from separate()'s
  // With many copies of each piece one affine map stands for all; with few, each rounds in its own way.
  const std::vector<AffineMap>& all = verificationMaps();
  const std::vector<AffineMap> maps = scarce_ ? all : std::vector<AffineMap>{all.back()};
  std::size_t fewest = ~std::size_t{0};
  int fruitless = 0;
  for (int attempt = 0; attempt < kAttempts && fruitless < 3; ++attempt) {
    if (progress && !progress("verify", 0.6 + 0.02 * attempt))
      return Error{ErrorCode::aborted, "cancelled while verifying"};
    const bool mayRepair = attempt + 1 < kAttempts;
    const std::size_t badUnattacked = check(mayRepair, salt);
    std::size_t bad = badUnattacked, badAfterMap = 0;
    report_.guarantees.unattacked = bad == 0;
    for (const AffineMap& map : maps) {
      badAfterMap = checkMapped(map, mayRepair, salt);  // the last map is the combined one
      bad += badAfterMap;
    }
    report_.guarantees.affine = badAfterMap == 0;
    unreadPieces_ = std::max(badUnattacked, badAfterMap);
    if (bad == 0) break;
    // Far from the origin a file may be too coarse for its digits; then rewriting only rolls the dice again.
    fruitless = bad < fewest ? 0 : fruitless + 1;
    fewest = std::min(fewest, bad);
  }
  if (fruitless > 0) {
    report_.guarantees.unattacked = check(false, salt) == 0;
    report_.guarantees.affine = checkMapped(maps.back(), false, salt) == 0;
  }
  report_.guarantees.reordered = weldsAlike() && checkReordered();
  return okStatus();
}

}  // namespace quadmark
