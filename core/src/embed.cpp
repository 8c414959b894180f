// SPDX-License-Identifier: MIT
#include "quadmark/embed.h"

#include <algorithm>
#include <cmath>

#include "concat.h"
#include "embedder.h"

namespace quadmark {
namespace {

// Square of Eq. (4): how far the near end of a diagonal of this length moves.
double displacement2(double from, double to, double length) {
  const double step = (from - to) / (1 - to) * length;
  return step * step;
}

}  // namespace

Embedder::Embedder(const Mesh& mesh, std::span<const std::uint8_t> bits, const Key& key)
    : mesh_(mesh), bits_(bits), key_(key), pad_(key), pieces_(toPieces(bits, key)),
      codec_(key.params, pieceCount(key.params)), welded_(weld(mesh)), positions_(welded_.positions),
      rounding_(roundingOf(mesh.precision, welded_)), diagonal_(boundingDiagonal(mesh)), padded_(pad_, pieces_, codec_.pieceSlot().digitCount()) {}

Status Embedder::search() {
  if (!(diagonal_ > 0)) return Error{ErrorCode::badMesh, "the model has no extent: all its vertices coincide"};
  SearchResult found = searchCells(mesh_, welded_, key_.params, diagonal_, rounding_);
  report_.naturalCells = found.naturalCells;
  cells_.reserve(found.cells.size());
  cellOf_.assign(welded_.vertexCount(), kNoVertex);
  for (const Quad& quad : found.cells) {
    for (std::uint32_t v : {quad.a, quad.b, quad.c, quad.d}) cellOf_[v] = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back({quad, kNoPiece, false, quad.ratioAC, quad.ratioBD});
  }
  return okStatus();
}

std::uint32_t PadCache::operator()(std::uint32_t index, std::uint32_t prefix1, std::uint32_t prefix2) {
  const std::uint64_t label = std::uint64_t{prefix1} << 32 | prefix2;
  Entry& entry = entries_[(label * 0x9e3779b97f4a7c15u + index * 0xd6e8feb86659fd93u) >> 44 & (kEntries - 1)];
  if (entry.label != label || entry.index != index)
    entry = {label, index, octalDigits(pieces_[index] ^ pad_(index, prefix1, prefix2), digits_)};
  return entry.octal;
}

// The pad, hence the code, depends on the label, that is on the two prefixes, so every label near the present ratios is
// a candidate of its own (D11, D12). Instead of always keeping the prefix as the paper does, the cheapest legal one is
// taken: the decoder needs an ordered pair of ratios, not the natural ones. Which diagonal carries the index is free
// too: the decoder goes by size alone.
bool Embedder::plan(PlannedCell& cell, std::uint32_t piece) {
  const Quad& q = cell.quad;
  const DigitSlot &slot1 = codec_.indexSlot(), &slot2 = codec_.pieceSlot();
  double best = 0;
  bool found = false;
  for (const int reach : {1, 4, 16}) {
    if (found) break;
    for (const bool acFirst : {true, false}) {
      const double from1 = acFirst ? q.ratioAC : q.ratioBD, from2 = acFirst ? q.ratioBD : q.ratioAC;
      const double weight1 = acFirst ? q.lengthAC : q.lengthBD, weight2 = acFirst ? q.lengthBD : q.lengthAC;
      const auto natural1 = static_cast<int>(slot1.read(from1).prefix), natural2 = static_cast<int>(slot2.read(from2).prefix);
      for (int p1 = std::max(0, natural1 - reach); p1 <= natural1 + reach; ++p1) {
        const double r1 = slot1.centre(static_cast<std::uint32_t>(p1), piece);
        if (r1 < kMinRatio || r1 > slot1.maxRatio()) continue;
        const double cost1 = displacement2(from1, r1, weight1);
        if (found && cost1 >= best) continue;
        for (int p2 = std::max(0, natural2 - reach); p2 <= natural2 + reach; ++p2) {
          const auto u1 = static_cast<std::uint32_t>(p1), u2 = static_cast<std::uint32_t>(p2);
          if (!pad_.carries(u1, u2)) continue;
          const double r2 = slot2.centre(u2, padded_(piece, u1, u2));
          if (r2 < kMinRatio || r2 > slot2.maxRatio() || !codec_.ordered(r1, r2)) continue;
          const double cost = cost1 + displacement2(from2, r2, weight2);
          if (found && cost >= best) continue;
          found = true;
          best = cost;
          cell.ratioAC = acFirst ? r1 : r2;
          cell.ratioBD = acFirst ? r2 : r1;
        }
      }
    }
  }
  cell.piece = found ? piece : kNoPiece;
  cell.written = found;
  return found;
}

// Random content in the present label (D24), so that nobody without the key can tell which cells carry pieces. A cell
// for which a few tries find no legal content stays as it is.
void Embedder::planDecoy(PlannedCell& cell, std::uint64_t number) const {
  const Quad& q = cell.quad;
  const DigitSlot &slot1 = codec_.indexSlot(), &slot2 = codec_.pieceSlot();
  const bool acFirst = q.ratioAC <= q.ratioBD;
  const std::uint32_t prefix1 = slot1.read(acFirst ? q.ratioAC : q.ratioBD).prefix,
                      prefix2 = slot2.read(acFirst ? q.ratioBD : q.ratioAC).prefix;
  for (std::uint64_t attempt = 0; attempt < 16 && !cell.written; ++attempt) {
    const std::uint64_t random = pad_.decoy(~(16 * number + attempt));
    const auto index = static_cast<std::uint32_t>((random & 0xffffffff) % codec_.pieces());
    const auto bits = static_cast<std::uint32_t>(random >> 32) & ((1u << codec_.bitsPerPiece()) - 1);
    const double r1 = slot1.centre(prefix1, index), r2 = slot2.centre(prefix2, octalDigits(bits, slot2.digitCount()));
    if (r1 < kMinRatio || r2 > slot2.maxRatio() || !codec_.ordered(r1, r2)) continue;
    cell.ratioAC = acFirst ? r1 : r2;
    cell.ratioBD = acFirst ? r2 : r1;
    cell.written = true;
  }
}

const CoordinateGrid* Embedder::gridOf(std::uint32_t vertex) const {
  const std::uint8_t grid = welded_.gridOf.empty() ? 0 : welded_.gridOf[vertex];
  return grid == 0 || grid == kFixed ? nullptr : &mesh_.grids[grid - 1u];
}

bool Embedder::isFixed(std::uint32_t vertex) const {
  return !welded_.gridOf.empty() && welded_.gridOf[vertex] == kFixed;
}

void Embedder::round(std::uint32_t vertex) {
  const CoordinateGrid* grid = gridOf(vertex);
  if (grid == nullptr && mesh_.precision != Precision::float32) return;
  for (int k = 0; k < 3; ++k) {
    double& x = positions_[3 * std::size_t{vertex} + k];
    x = grid != nullptr ? nearestOnGrid(*grid, x) : nearestFloat32(x);
  }
}

// The coordinate that can be stored `steps` places above x (below for negative numbers).
double Embedder::neighbour(std::uint32_t vertex, double x, int steps) const {
  if (const CoordinateGrid* grid = gridOf(vertex)) return nearestOnGrid(*grid, x + steps * grid->step());
  const float direction = steps < 0 ? -3e38f : 3e38f;
  for (int step = 0; step < std::abs(steps); ++step) x = std::nextafter(static_cast<float>(x), direction);
  return x;
}

// How far the cell at these four points is from reading well: 0 = centre of both digit cells and flat, from 1 upwards
// it is misread or taken for not coplanar.
double Embedder::misfit(const PlannedCell& cell, const double* const points[4], double gridHalfStep) const {
  Quad quad;
  if (!makeQuad(points, kMinTriangleReading, quad)) return 1e9;
  // makeQuad names the near ends afresh; the diagonals are the same unless the points left convex position.
  const bool same = quad.a == 0 || quad.a == 2;
  const double wantAC = same ? cell.ratioAC : cell.ratioBD, wantBD = same ? cell.ratioBD : cell.ratioAC;
  const bool acFirst = cell.ratioAC <= cell.ratioBD;
  const double digitAC = (acFirst == same ? codec_.indexSlot() : codec_.pieceSlot()).cellWidth();
  const double digitBD = (acFirst == same ? codec_.pieceSlot() : codec_.indexSlot()).cellWidth();
  const double off = std::max(std::fabs(quad.ratioAC - wantAC) / digitAC, std::fabs(quad.ratioBD - wantBD) / digitBD);
  return std::max(2 * off, quad.gap / (4 * rounding_.unit(points, quad.longerDiagonal(), gridHalfStep)));
}

double Embedder::misfit(const PlannedCell& cell) const {
  const std::uint32_t ids[4] = {cell.quad.a, cell.quad.b, cell.quad.c, cell.quad.d};
  const double* points[4];
  double gridHalfStep = 0;
  for (int i = 0; i < 4; ++i) {
    points[i] = &positions_[3 * std::size_t{ids[i]}];
    gridHalfStep = std::max(gridHalfStep, rounding_.halfStepOf(ids[i]));
  }
  return misfit(cell, points, gridHalfStep);
}

// The same after each of the affine maps that the verification also looks at, rounded to the file's precision.
double Embedder::misfitAfterMaps(const PlannedCell& cell) const {
  const std::uint32_t ids[4] = {cell.quad.a, cell.quad.b, cell.quad.c, cell.quad.d};
  double worst = misfit(cell);
  for (const AffineMap& map : verificationMaps()) {
    double mapped[4][3];
    const double* points[4] = {mapped[0], mapped[1], mapped[2], mapped[3]};
    for (int i = 0; i < 4; ++i) applyRounded(map, &positions_[3 * std::size_t{ids[i]}], mapped[i]);
    worst = std::max(worst, misfit(cell, points, 0));
    if (worst > 1e8) break;
  }
  return worst;
}

void Embedder::writeCell(PlannedCell& cell) {
  if (!cell.written) return;
  writeRatios(cell.quad, cell.ratioAC, cell.ratioBD, positions_.data());
  settleCell(cell);
}

// D19: rounds the four points; where rounding hurts, goes downhill over neighbouring representable positions. A coarse
// cell of a piece with few copies has to be read after the verification's affine maps as well, each of which rounds
// anew: no amount of voting helps a piece that has one copy.
void Embedder::settleCell(const PlannedCell& cell) {
  const std::uint32_t ids[4] = {cell.quad.a, cell.quad.b, cell.quad.c, cell.quad.d};
  for (std::uint32_t v : ids) round(v);
  const bool onGrid = gridOf(ids[0]) != nullptr;
  if (!onGrid && mesh_.precision != Precision::float32) return;
  // What an affine map rounds is far below a grid's step.
  const bool throughMaps = !onGrid && scarce_ && coarseness(cell.quad) > kFineCoarseness;
  const double good = throughMaps ? 0.5 : 0.15;
  const auto score = [&] { return throughMaps ? misfitAfterMaps(cell) : misfit(cell); };
  const auto descend = [&](double best) {
    for (int sweep = 0; sweep < 6 && best > good; ++sweep) {
      const double before = best;
      for (int move = 0; move < 48 && best > good; ++move) {
        double& x = positions_[3 * std::size_t{ids[move / 12]} + move / 4 % 3];
        const double kept = x;
        const int steps = 1 + move / 2 % 2;
        x = neighbour(ids[move / 12], x, move % 2 == 0 ? -steps : steps);
        const double now = score();
        if (now < best)
          best = now;
        else
          x = kept;
      }
      if (!(best < before)) break;
    }
    return best;
  };
  double best = descend(score());
  // Downhill ends in one of many hollows; a few jumps of some units in the last place find a better one.
  for (int jump = 1; throughMaps && best > 0.8 && jump <= 24; ++jump) {
    double kept[12];
    for (int i = 0; i < 12; ++i) {
      double& x = positions_[3 * std::size_t{ids[i / 3]} + i % 3];
      kept[i] = x;
      x = neighbour(ids[i / 3], x,
                    static_cast<int>(pad_.decoy((std::uint64_t{ids[0]} << 32) + 64 * jump + i) % 9) - 4);
    }
    const double now = descend(score());
    if (now < best) {
      best = now;
    } else {
      for (int i = 0; i < 12; ++i) positions_[3 * std::size_t{ids[i / 3]} + i % 3] = kept[i];
    }
  }
}

Result<MarkedMesh> Embedder::run(const MeshProgress& progress) {
  const auto report = [&](const char* stage, double done) { return !progress || progress(stage, done); };
  if (!report("search", 0.1)) return Error{ErrorCode::aborted, "cancelled while searching cells"};
  if (Status s = search(); !s) return s.error();
  if (!report("write", 0.4)) return Error{ErrorCode::aborted, "cancelled while writing"};
  if (Status s = assign(); !s) return s.error();
  padded_.release();
  for (PlannedCell& cell : cells_) writeCell(cell);
  separate();
  if (Status s = verify(progress); !s) return s.error();
  if (Status s = refuseUnreadableGrid(); !s) return s.error();
  return result();
}

// A float file whose mark is weak gets a warning, because its owner may prefer a weak mark. On a coarse grid nearly every
// set of four points is flat and the mark drowns: that is no mark at all, so it is not written.
Status Embedder::refuseUnreadableGrid() const {
  if (report_.guarantees.all() || std::all_of(welded_.gridOf.begin(), welded_.gridOf.end(), [](std::uint8_t grid) {
        return grid == 0 || grid == kFixed;
      }))
    return okStatus();
  double step = 0;
  for (double half : welded_.halfStep) step = std::max(step, 2 * half);
  return Error{ErrorCode::capacity,
               concat("the positions are integers, about ", static_cast<std::uint64_t>(diagonal_ / step),
                      " steps along the model's diagonal, too coarse for this mark: of the ", pieces_.size(),
                      " pieces for ", bits_.size(), " bits, in ", report_.cells, " cells, ", unreadPieces_,
                      " do not read back from the output or from an affine copy; store the positions as floats, or in ",
                      "more bits, before marking")};
}

MarkedMesh Embedder::result() {
  MarkedMesh out = std::move(report_);
  out.positions = mesh_.positions;
  for (std::size_t v = 0; v < mesh_.vertexCount(); ++v) {
    const std::uint32_t w = welded_.weldedOf[v];
    if (w == kNoVertex) continue;
    for (int k = 0; k < 3; ++k)
      // Equal values keep the original's bits: -0 must not become +0.
      if (out.positions[3 * v + k] != positions_[3 * std::size_t{w} + k])
        out.positions[3 * v + k] = positions_[3 * std::size_t{w} + k];
  }
  out.payloadBits = static_cast<std::uint32_t>(bits_.size());
  out.capacityBits = 3ull * codec_.pieceSlot().digitCount() * out.cells;
  out.repeats = static_cast<double>(out.cells) / static_cast<double>(pieces_.size());
  out.leastRepeats = *std::min_element(copies_.begin(), copies_.end());
  out.diagonal = diagonal_;
  out.welding = welded_.takeWelding();
  return out;
}

Result<MarkedMesh> embedMesh(const Mesh& mesh, std::span<const std::uint8_t> bits, const Key& key,
                             const MeshProgress& progress) {
  if (bits.size() != key.params.bitCount())
    return Error{ErrorCode::badOption,
                 concat("the payload has ", bits.size(), " bits, the key is for ", key.params.bitCount())};
  return Embedder(mesh, bits, key).run(progress);
}

}  // namespace quadmark
