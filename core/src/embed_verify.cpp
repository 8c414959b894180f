// SPDX-License-Identifier: MIT
// Verification after writing (D20): the decoder reads the output, a reordered copy and an affine copy.
#include <algorithm>
#include <cmath>

#include "embedder.h"
#include "quadmark/extract.h"

namespace quadmark {

// The paper's affine attacks that round anew: R (45 degrees about x, then y), NS, SH and CB. RE and S are exact in
// binary floating point.
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
    return std::vector<AffineMap>{rotation, scale, shear, combined};
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
  std::sort(bad.begin(), bad.end());
  bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
  return bad;
}

// Breaks every set that votes for a piece it does not carry, and rewrites the cells of the pieces that suffer. What a
// rewrite does to the rounding is a matter of luck, so it is tried again until the decoder is satisfied.
void Embedder::repair(const std::vector<std::uint32_t>& bad, const Extraction& read, std::uint64_t& salt) {
  std::vector<std::uint8_t> isBad(pieces_.size(), 0), moved(cells_.size(), 0);
  for (std::uint32_t piece : bad) isBad[piece] = 1;
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

// One check: reads `positions` (connectivity `welded`), repairs if asked to. True when exact.
bool Embedder::check(const WeldedMesh& welded, const std::vector<double>& positions, bool mayRepair,
                     std::uint64_t& salt) {
  const std::vector<std::uint32_t> bad = badPieces(extractMesh(welded, positions, rounding_, key_));
  if (bad.empty()) return true;
  if (mayRepair) {
    ExtractOptions options;
    options.keepReadings = true;
    repair(bad, extractMesh(welded, positions, rounding_, key_, options), salt);
  }
  return false;
}

std::vector<double> Embedder::mapped(const AffineMap& map) const {
  std::vector<double> out(positions_.size());
  for (std::size_t v = 0; v < positions_.size(); v += 3) applyRounded(map, &positions_[v], &out[v]);
  return out;
}

bool Embedder::readsReordered() const {
  Mesh copy;
  copy.precision = mesh_.precision;
  const std::size_t vertices = mesh_.vertexCount(), faces = mesh_.faceCount();
  // Blocks of 1024 in scattered order, each back to front with a stride: far from the file's order, near enough in memory.
  const auto shuffled = [](std::size_t count, const auto& visit) {
    constexpr std::uint64_t kBlock = 1024;
    std::uint64_t blocks = 1;
    while (blocks * kBlock < count) blocks *= 2;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const std::uint64_t block = (i * 0x9e3779b97f4a7c15u + 0x7f4a7c15u) & (blocks - 1);  // odd factor: a permutation
      for (std::uint64_t k = 0; k < kBlock; ++k) {
        const std::uint64_t at = block * kBlock + ((kBlock - 1 - k) * 397 & (kBlock - 1));
        if (at < count) visit(static_cast<std::size_t>(at));
      }
    }
  };
  std::vector<std::uint32_t> newIndex(vertices);
  std::uint32_t next = 0;
  copy.positions.reserve(mesh_.positions.size());
  shuffled(vertices, [&](std::size_t v) {
    newIndex[v] = next++;
    const std::uint32_t w = welded_.weldedOf[v];
    const double* p = w == kNoVertex ? &mesh_.positions[3 * v] : &positions_[3 * std::size_t{w}];
    copy.positions.insert(copy.positions.end(), p, p + 3);
    if (!mesh_.groups.empty()) copy.groups.push_back(mesh_.groups[v]);
  });
  copy.faceVertices.reserve(mesh_.faceVertices.size());
  if (!mesh_.faceOffsets.empty()) copy.faceOffsets.push_back(0);
  shuffled(faces, [&](std::size_t f) {
    const std::size_t begin = mesh_.faceBegin(f), size = mesh_.faceEnd(f) - begin;
    for (std::size_t corner = 0; corner < size; ++corner)
      copy.faceVertices.push_back(newIndex[mesh_.faceVertices[begin + (corner + 1) % size]]);
    if (!mesh_.faceOffsets.empty()) copy.faceOffsets.push_back(static_cast<std::uint32_t>(copy.faceVertices.size()));
  });
  std::vector<std::uint32_t>().swap(newIndex);
  const WeldedMesh welded = weld(copy);
  copy = Mesh{};
  return badPieces(extractMesh(welded, welded.positions, rounding_, key_)).empty();
}

Status Embedder::verify(const MeshProgress& progress) {
  constexpr int kAttempts = 12;
  std::uint64_t salt = std::uint64_t{1} << 32;  // apart from separate()'s
  // With many copies of each piece one affine map stands for all; with few, each rounds in its own way.
  const std::vector<AffineMap>& all = verificationMaps();
  const std::vector<AffineMap> maps = scarce_ ? all : std::vector<AffineMap>{all.back()};
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (progress && !progress("verify", 0.6 + 0.03 * attempt))
      return Error{ErrorCode::aborted, "cancelled while verifying"};
    const bool mayRepair = attempt + 1 < kAttempts;
    report_.guarantees.unattacked = check(welded_, positions_, mayRepair, salt);
    report_.guarantees.affine = true;
    bool moved = !report_.guarantees.unattacked && mayRepair;
    for (const AffineMap& map : maps) {
      const bool exact = check(welded_, mapped(map), mayRepair, salt);
      if (&map == &maps.back()) report_.guarantees.affine = exact;
      moved = moved || (!exact && mayRepair);
    }
    if (!moved) break;
  }
  report_.guarantees.reordered = readsReordered();
  return okStatus();
}

}  // namespace quadmark
