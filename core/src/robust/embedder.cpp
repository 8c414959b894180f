// SPDX-License-Identifier: MIT
#include "quadmark/robust/embedder.h"

#include <algorithm>

#include "distortion_budget.h"
#include "embed_diamonds.h"
#include "embed_rings.h"
#include "ground.h"
#include "median.h"
#include "parallel.h"
#include "quadmark/random.h"
#include "quadmark/trig.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

struct Preset {
  RingLimits ring;
  DiamondLimits diamond;
  double mostStep;     ///< of layer A's lattice, ring radii
  double maxError;     ///< of the diagonal
  double concealment;  ///< jitter of cells that were not flat, of the diagonal
  double budget;       ///< of the mean distortion that `standard` may cause
};

double cosineOf(double degrees) {
  return sinCosTurns(degrees / 360).cos;
}

// What each strength spends. Distortion and survival of each are in docs/robust.md.
Preset presetOf(Strength strength) {
  struct Row {
    double step, crease, ringTurn, gap, sharp, cellTurn, farQuota, mostFar, maxError, concealment, budget;
  };
  static constexpr Row kRows[] = {
      {0.5, 12, 5, 0.012, 35, 4, 0.03, 6, 2e-3, 1e-5, 0.5},     // invisible
      {0.7, 25, 10, 0.05, 35, 10, 0.075, 10, 6e-3, 1e-5, 1},  // standard
      {0.9, 35, 20, 0.1, 60, 20, 0.135, 100, 1.5e-2, 0, 1e9},  // strong
  };
  const Row& row = kRows[static_cast<int>(strength)];
  Preset out;
  out.ring.creaseCosine = cosineOf(row.crease);
  out.ring.turnCosine = cosineOf(row.ringTurn);
  out.diamond.mostGap = row.gap;
  out.diamond.sharpCosine = cosineOf(row.sharp);
  out.diamond.turnCosine = cosineOf(row.cellTurn);
  out.diamond.farQuota = row.farQuota;
  out.diamond.mostFar = row.mostFar;
  out.mostStep = row.step;
  out.maxError = row.maxError;
  out.concealment = row.concealment;
  out.budget = row.budget;
  return out;
}

// What the whole mark may do at `standard`: vertex normals turn by half a degree; surfaces lie .006 % of the diagonal
// apart, on coarse meshes more, as these are farther from the smooth surface that they approximate: .01 % where there are
// about 10 000 vertices, and one part in as many as there are below.
constexpr double kMeanTurn = 0.0087, kSurfaceRms = 5.9e-5, kSurfaceRmsCoarse = 9.8e-5;
constexpr double kCoarse = 10000, kCoarseEnd = 12500;  // vertices

double surfaceRmsFor(double vertices) {
  if (vertices <= kCoarse) return kSurfaceRmsCoarse * kCoarse / vertices;
  const double fall = std::min(1.0, kCoarseEnd / vertices);
  return std::max(kSurfaceRms, kSurfaceRmsCoarse * fall * fall);
}

// Shares do not add up exactly: aim a little lower, and look again.
constexpr double kBudgetShare = 0.98;
constexpr int kBudgetRounds = 6;

DistortionLimits limitsOf(const Preset& preset, const Surface& surface, double diagonal) {
  const double rms = surfaceRmsFor(std::max(1u, surface.vertexCount()));
  return {preset.budget * kMeanTurn, preset.budget * rms * diagonal};
}

// Exactly flat quadrilaterals are a beacon that needs no key. Cells get a gap of the size that 14-bit quantization gives
// them anyway, along their normals so that the ratios stay; those that were flatter before get back about half of what they had.
void conceal(const std::vector<WrittenCell>& cells, const Prf& prf, double amplitude, std::vector<double>& positions) {
  for (const WrittenCell& cell : cells) {
    const double most = std::min(amplitude, 0.5 * static_cast<double>(cell.naturalGap));
    const Diamond& q = cell.diamond;
    Random random(prf(std::uint64_t{cell.meaning} << 32 | q.b));
    const Vec3 normal =
        normalized(cross(at(positions, q.c) - at(positions, q.a), at(positions, q.d) - at(positions, q.b)));
    for (const std::uint32_t v : {q.a, q.b, q.c, q.d})
      put(positions, v, at(positions, v) + random.uniform(-most, most) * normal);
  }
}

// Half the noise of 14-bit quantization, of the extent: the mark's natural enemy sets the scale of fine cells.
constexpr double kQuantizationSigma = 1.76e-5;

// The coarsest noise any diamond of the middle sees; cells of five times that are read reliably. A body gets the coarsest
// cells that leave half as many slots again as it has bits, before coding.
std::uint8_t chooseDelta(const std::vector<Diamond>& diamonds, const std::vector<double>& positions,
                         std::size_t bodyBits) {
  std::vector<float> blur(diamonds.size(), -1.0f);
  const double sigma = kQuantizationSigma * largestExtent(positions);
  forEachInParts(diamonds.size(), [&](std::size_t i) {
    DiamondShape s;
    if (diamondShape(positions, diamonds[i], s) && isUsable(ratiosOf(s)))
      blur[i] = static_cast<float>(std::max(s.edgeGain, s.spanGain) * sigma);
  });
  blur.erase(std::remove(blur.begin(), blur.end(), -1.0f), blur.end());
  const double median = medianOf(std::move(blur));
  if (bodyBits == 0) return 5 * median <= kDeltas[0].delta ? 0 : 5 * median <= kDeltas[1].delta ? 1 : 2;
  for (const std::uint8_t c : {std::uint8_t{3}, std::uint8_t{4}}) {
    const std::size_t slots = std::size_t{kDeltas[c].groups()} * kDeltas[c].symbol * (16 - kHeadSixteenths) / 16;
    if (2 * slots >= 3 * bodyBits) return c;
  }
  return 5;
}

// Undoes the dearest cells, and marks the dearest carriers, until what is left should keep within the limits; all
// carriers return to where they were, to be written anew. False where nothing had to go.
bool giveUp(const Surface& surface, ChangeMeter& change, const Carriers& carriers, const DistortionLimits& limits,
            std::uint32_t symbolBits, const std::vector<std::uint32_t>& written, std::vector<WrittenCell>& cells,
            std::vector<std::uint8_t>& droppedCarriers, std::vector<double>& positions) {
  const std::vector<double>& original = surface.welded.positions;
  change.measure(positions);
  const double turns = limits.turn * surface.vertexCount();
  const double squares = limits.surfaceRms * limits.surfaceRms * surface.vertexCount();
  if (change.turns() <= turns && change.squares() <= squares) return false;
  std::vector<Expense> expenses;
  for (const std::uint32_t i : written)
    expenses.push_back({change.turnOf(carriers.vertex[i]), change.squareOf(carriers.vertex[i]), 2});
  for (const WrittenCell& cell : cells) {
    Expense e{0, 0, static_cast<double>(symbolBits)};
    const Diamond& q = cell.diamond;
    for (const std::uint32_t v : {q.a, q.b, q.c, q.d}) e.turn += change.turnOf(v), e.square += change.squareOf(v);
    expenses.push_back(e);
  }
  const std::vector<std::uint8_t> dropped = expensesToDrop(expenses, kBudgetShare * turns, kBudgetShare * squares);
  for (std::size_t i = 0; i < written.size(); ++i) {
    droppedCarriers[written[i]] |= dropped[i];
    put(positions, carriers.vertex[written[i]], at(original, carriers.vertex[written[i]]));
  }
  std::vector<WrittenCell> kept;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Diamond& q = cells[i].diamond;
    if (dropped[written.size() + i] == 0)
      kept.push_back(cells[i]);
    else
      for (const std::uint32_t v : {q.a, q.b, q.c, q.d}) put(positions, v, at(original, v));
  }
  cells = std::move(kept);
  return true;
}

std::uint32_t countSet(const std::vector<std::uint8_t>& flags) {
  return static_cast<std::uint32_t>(std::count(flags.begin(), flags.end(), 1));
}

}  // namespace

const char* strengthName(Strength strength) {
  return strength == Strength::invisible ? "invisible" : strength == Strength::standard ? "standard" : "strong";
}

Result<Strength> strengthFrom(std::string_view name) {
  for (const Strength strength : {Strength::invisible, Strength::standard, Strength::strong})
    if (name == strengthName(strength)) return strength;
  return Error{ErrorCode::badOption, "strength: expected \"invisible\", \"standard\" or \"strong\""};
}

Result<RobustEmbedding> embedRobust(const Mesh& mesh, const CodedPayload& payload, const RobustKeys& keys,
                                    const EmbedOptions& options) {
  if (payload.head.empty()) return Error{ErrorCode::badOption, "payload: the head is empty"};
  for (const auto& [name, cap] : {std::pair{"maxError", options.maxErrorRel}, {"maxSlide", options.maxSlideRel}})
    if (!(cap >= 0 && cap <= 1))
      return Error{ErrorCode::badOption, std::string(name) + " is not within 0..1"};
  const double diagonal = boundingDiagonal(mesh);
  if (!(diagonal > 0)) return Error{ErrorCode::badMesh, "the model has no extent"};
  const auto cancelled = [&](const char* stage, double done) {
    return options.progress && !options.progress(stage, done);
  };
  const Error aborted{ErrorCode::aborted, "cancelled by the caller"};

  Preset preset = presetOf(options.strength);
  // The jitter comes on top of a cell's own displacement.
  const double maxError = options.maxErrorRel > 0 ? options.maxErrorRel : preset.maxError;
  preset.concealment = std::min(preset.concealment, maxError / 4);
  preset.ring.maxMove = maxError * diagonal;
  preset.diamond.maxMove = (maxError - 2 * preset.concealment) * diagonal;
  if (options.maxSlideRel > 0) preset.ring.maxSlide = preset.diamond.maxSlide = options.maxSlideRel * diagonal;
  if (cancelled("surface", 0)) return aborted;
  const std::shared_ptr<Ground> ground = groundOf(mesh, keys);
  Surface& surface = ground->surface;
  const Carriers& carriers = ground->carriers;
  std::vector<double> positions = surface.welded.positions;
  RobustEmbedding out;

  // 1. Layer B, off the carriers but across their rings: A is written on the result, so neither sees the other.
  if (cancelled("diamonds", 0.3)) return aborted;
  std::vector<Diamond> diamonds = collectDiamonds(surface);
  const Sharing sharing = payload.hasBody() ? Sharing::split : Sharing::headOnly;
  out.deltaClass = chooseDelta(diamonds, positions, payload.bodyInformation());
  const Constellation constellation(out.deltaClass, keys, sharing, payload.headCode(), payload.bodyCode());
  std::vector<std::uint8_t> occupied(surface.vertexCount(), 0);
  for (const std::uint32_t v : carriers.vertex) occupied[v] = 1;
  DiamondCandidates candidates =
      findCandidates(surface, std::move(diamonds), constellation.shape(), preset.diamond, occupied, positions);
  forgetRings(surface);
  const FacesAround facesAround(surface);
  DiamondEmbedding cells =
      embedDiamonds(surface, facesAround, std::move(candidates), constellation, payload, preset.diamond, occupied,
                    positions);
  conceal(cells.cells, Prf(keys.assignment), preset.concealment * diagonal, positions);

  // 2. Layer A. Where both together are more than the preset allows, the dearest parts go, and A is written again.
  if (cancelled("rings", 0.8)) return aborted;
  const RingCode code(keys);
  const DistortionLimits limits = limitsOf(preset, surface, diagonal);
  ChangeMeter change(surface, facesAround);
  std::vector<std::uint8_t> droppedCarriers(carriers.count(), 0);
  std::vector<std::uint32_t> written;
  for (int round = 0;; ++round) {
    const SymmetricTensor tensor = edgeTensor(surface, positions);
    if (round == 0)
      preset.ring.step = std::min(preset.mostStep, chooseRingStep(carriers, positions, tensor, diagonal));
    written = embedRings(carriers, code, payload, tensor, preset.ring, droppedCarriers, positions);
    if (round == kBudgetRounds || preset.budget > 1) break;
    if (!giveUp(surface, change, carriers, limits, constellation.shape().symbol, written, cells.cells,
                droppedCarriers, positions))
      break;
  }

  // 3. Back to the file's vertices and precision.
  out.positions = mesh.positions;
  out.displacement.assign(mesh.vertexCount(), 0.0f);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const std::uint32_t w = surface.welded.weldedOf[v];
    if (w == kNoVertex) continue;
    const Vec3 from = at(surface.welded.positions, w), to = at(positions, w);
    if (from.x == to.x && from.y == to.y && from.z == to.z) continue;
    const bool single = mesh.precision == Precision::float32;
    const double exact[3] = {to.x, to.y, to.z};
    for (int k = 0; k < 3; ++k) out.positions[3 * v + k] = single ? nearestFloat32(exact[k]) : exact[k];
    const Vec3 move = at(out.positions, v) - from, &normal = change.normal(w);
    out.displacement[v] = static_cast<float>(length(move));
    out.largestSlide = std::max(out.largestSlide, length(move - dot(move, normal) * normal));
  }

  // 4. Counts.
  out.selected = carriers.count();
  out.carriers = static_cast<std::uint32_t>(written.size());
  std::vector<std::uint64_t> labels;
  std::vector<std::uint8_t> ringHit[2], diamondHit[2];
  for (auto* hit : {ringHit, diamondHit}) {
    hit[0].assign(payload.head.size(), 0);
    hit[1].assign(payload.body.size(), 0);
  }
  for (const std::uint32_t i : written) {
    labels.push_back(carriers.label[i]);
    for (int k = 0; k < 2; ++k) {
      const RingSlot slot = code.slot(carriers.label[i], k);
      auto& hit = ringHit[slot.stream(sharing) == Stream::body];
      hit[slot.index % hit.size()] = 1;
    }
  }
  sortCompactly(labels.begin(), labels.end());
  out.labels = static_cast<std::uint32_t>(std::unique(labels.begin(), labels.end()) - labels.begin());
  for (const WrittenCell& cell : cells.cells)
    for (std::uint32_t t = 0; t < constellation.shape().symbol; ++t) {
      const Constellation::Slot& slot = constellation.slot(cell.meaning / constellation.symbols(), t);
      diamondHit[slot.stream == Stream::body][slot.bit] = 1;
    }
  out.cells = static_cast<std::uint32_t>(cells.cells.size());
  out.symbolBits = constellation.shape().symbol;
  out.vetoed = cells.vetoed;
  out.goodCells = constellation.groups();
  out.ringPositions = countSet(ringHit[0]);
  for (std::size_t i = 0; i < ringHit[0].size(); ++i) out.headPositions += ringHit[0][i] | diamondHit[0][i];
  out.ringBodyPositions = countSet(ringHit[1]);
  out.diamondPositions = countSet(diamondHit[0]);
  out.diamondBodyPositions = countSet(diamondHit[1]);
  out.diagonal = diagonal;
  out.ground = ground;
  return out;
}

}  // namespace quadmark::robust
