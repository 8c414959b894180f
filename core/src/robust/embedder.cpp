// SPDX-License-Identifier: MIT
#include "quadmark/robust/embedder.h"

#include <algorithm>

#include "creases.h"
#include "ground.h"
#include "median.h"
#include "parallel.h"
#include "presets.h"
#include "quadmark/random.h"
#include "raise_cells.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

// Shares do not add up exactly: aim a little lower, and look again.
constexpr double kBudgetShare = 0.98;
constexpr int kBudgetRounds = 6;
// Less than this share of both limits is little: spheres and machined parts, which use .15 to .45.
constexpr double kSlackShare = 0.47;

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

// Both layers on one surface.
class Embedder {
 public:
  Embedder(const Mesh& mesh, const CodedPayload& payload, const RobustKeys& keys, const Preset& preset, double diagonal)
      : mesh_(mesh),
        payload_(payload),
        sharing_(payload.hasBody() ? Sharing::split : Sharing::headOnly),
        preset_(preset),
        diagonal_(diagonal),
        ground_(groundOf(mesh, keys)),
        surface_(ground_->surface),
        carriers_(ground_->carriers),
        original_(surface_.welded.positions),
        positions_(original_),
        ringCode_(keys),
        jitter_(keys.assignment),
        diamonds_(collectDiamonds(surface_)),
        creased_(findCreases()),
        deltaClass_(chooseDelta(diamonds_, original_, payload.bodyInformation())),
        constellation_(deltaClass_, keys, sharing_, payload.headCode(), payload.bodyCode()) {}

  // Layer B, off the carriers but across their rings: A is written on the result, so neither sees the other.
  void writeCells() {
    std::vector<std::uint8_t> occupied(surface_.vertexCount(), 0);
    for (const std::uint32_t v : carriers_.vertex) occupied[v] = 1;
    DiamondCandidates candidates = findCandidates(surface_, std::move(diamonds_), constellation_.shape(), preset_.diamond,
                                                  creased_, occupied, positions_);
    forgetRings(surface_);
    if (!facesAround_) facesAround_ = std::make_unique<FacesAround>(surface_);
    // Its normals are memory that the queues need, and only a limit on sliding asks for them this early.
    if (!change_ && preset_.diamond.maxSlide < diagonal_) change_ = std::make_unique<ChangeMeter>(surface_, *facesAround_);
    cells_ = embedDiamonds(surface_, *facesAround_, std::move(candidates), constellation_, payload_, preset_.diamond,
                           change_.get(), occupied, positions_);
    if (!change_) change_ = std::make_unique<ChangeMeter>(surface_, *facesAround_);
    // Bodies have no places to spare for it (images in part:12000:2, 110 readings: one won, seven lost).
    if (hasRoom_ && !payload_.hasBody())
      raiseCells(surface_, *facesAround_, cells_.cells, std::size_t{preset_.standing} * constellation_.groups(),
                 preset_.diamond, coarsestStep(), *change_, positions_);
    conceal(cells_.cells, jitter_, preset_.concealment * diagonal_, positions_);
  }

  // Layer A. Where both together are more than the preset allows, the dearest parts go; where they are much less, cells
  // may come from farther and be raised. Then A is written again.
  void writeCarriers() {
    const DistortionLimits limits = limitsOf(preset_, surface_.vertexCount(), diagonal_);
    dropped_.assign(carriers_.count(), 0);
    for (int round = 0;; ++round) {
      const SymmetricTensor tensor = edgeTensor(surface_, positions_);
      if (round == 0)
        preset_.ring.step = std::min(preset_.mostStep, chooseRingStep(carriers_, positions_, tensor, diagonal_));
      written_ = embedRings(carriers_, ringCode_, payload_, tensor, preset_.ring, *change_, dropped_, positions_);
      if (round == kBudgetRounds || preset_.budget > 1) return;
      change_->measure(positions_);
      if (round == 0 && preset_.slackQuota > 1 && isWithin(limits, kSlackShare))
        writeMoreCells();
      else if (isWithin(limits, 1))
        return;
      else
        giveUp(limits);
    }
  }

  [[nodiscard]] RobustEmbedding result() const {
    RobustEmbedding out;
    placeVertices(out);
    count(out);
    out.diagonal = diagonal_;
    out.ground = ground_;
    return out;
  }

 private:
  // The vertices on creases, for cells; for carriers, which look at their own fans, the limit.
  std::vector<std::uint8_t> findCreases() {
    const std::vector<float> bends = edgeBends(diamonds_, original_);
    const double typical = medianOf(bends);
    const double ofRing = creaseBend(typical, preset_.ringCrease, preset_.ofRoughness);
    preset_.ring.creaseCosine = 1 - 0.5 * ofRing * ofRing;
    return creaseVertices(surface_.vertexCount(), diamonds_, bends,
                          creaseBend(typical, preset_.cellCrease, preset_.ofRoughness));
  }

  // Of the grids that coordinates lie on; 0 where there is none.
  [[nodiscard]] double coarsestStep() const {
    double out = 0;
    for (const CoordinateGrid& grid : mesh_.grids) out = std::max(out, grid.step());
    return out;
  }

  // Limits of means as those of the sums that a ChangeMeter takes.
  [[nodiscard]] double turnSum(const DistortionLimits& limits) const { return limits.turn * surface_.vertexCount(); }
  [[nodiscard]] double squareSum(const DistortionLimits& limits) const {
    return limits.surfaceRms * limits.surfaceRms * surface_.vertexCount();
  }
  [[nodiscard]] bool isWithin(const DistortionLimits& limits, double share) const {
    return change_->turns() <= share * turnSum(limits) && change_->squares() <= share * share * squareSum(limits);
  }

  // All anew, with more candidates from farther: smooth surfaces whose diamonds are all alike have few near most good
  // cells. (Nine spheres and machined parts, keys 1 to 3, of 378 readings exact: 252 without, 269 with twice and 273
  // with three times the quota, for 1 and 1.5 dB of sliding. Models that use more of their budget gain nothing by it.)
  void writeMoreCells() {
    hasRoom_ = true;
    preset_.diamond.farQuota *= preset_.slackQuota;
    preset_.diamond.mostFar *= preset_.slackQuota;
    positions_ = original_;
    diamonds_ = collectDiamonds(surface_);
    rememberRings(surface_);
    writeCells();
  }

  // Undoes the dearest cells, and marks the dearest carriers, until what is left should keep within the limits; all
  // carriers return to where they were, to be written anew.
  void giveUp(const DistortionLimits& limits) {
    std::vector<Expense> expenses;
    for (const std::uint32_t i : written_)
      expenses.push_back({change_->turnOf(carriers_.vertex[i]), change_->squareOf(carriers_.vertex[i]), 2.0 * carriers_.bits[i]});
    for (const WrittenCell& cell : cells_.cells) {
      Expense e{0, 0, static_cast<double>(constellation_.shape().symbol)};
      const Diamond& q = cell.diamond;
      for (const std::uint32_t v : {q.a, q.b, q.c, q.d}) e.turn += change_->turnOf(v), e.square += change_->squareOf(v);
      expenses.push_back(e);
    }
    const std::vector<std::uint8_t> dropped =
        expensesToDrop(expenses, kBudgetShare * turnSum(limits), kBudgetShare * squareSum(limits));
    for (std::size_t i = 0; i < written_.size(); ++i) {
      dropped_[written_[i]] |= dropped[i];
      put(positions_, carriers_.vertex[written_[i]], at(original_, carriers_.vertex[written_[i]]));
    }
    std::vector<WrittenCell> kept;
    for (std::size_t i = 0; i < cells_.cells.size(); ++i) {
      const Diamond& q = cells_.cells[i].diamond;
      if (dropped[written_.size() + i] == 0)
        kept.push_back(cells_.cells[i]);
      else
        for (const std::uint32_t v : {q.a, q.b, q.c, q.d}) put(positions_, v, at(original_, v));
    }
    cells_.cells = std::move(kept);
  }

  // Back to the file's vertices and precision.
  void placeVertices(RobustEmbedding& out) const {
    out.positions = mesh_.positions;
    out.displacement.assign(mesh_.vertexCount(), 0.0f);
    for (std::size_t v = 0; v < mesh_.vertexCount(); ++v) {
      const std::uint32_t w = surface_.welded.weldedOf[v];
      if (w == kNoVertex) continue;
      const Vec3 from = at(original_, w), to = at(positions_, w);
      if (from.x == to.x && from.y == to.y && from.z == to.z) continue;
      const bool single = mesh_.precision == Precision::float32;
      const double exact[3] = {to.x, to.y, to.z};
      for (int k = 0; k < 3; ++k) out.positions[3 * v + k] = single ? nearestFloat32(exact[k]) : exact[k];
      const Vec3 move = at(out.positions, v) - from, &normal = change_->normal(w);
      out.displacement[v] = static_cast<float>(length(move));
      out.largestSlide = std::max(out.largestSlide, slideOf(move, normal));
    }
  }

  void count(RobustEmbedding& out) const {
    out.selected = carriers_.count();
    out.carriers = static_cast<std::uint32_t>(written_.size());
    std::vector<std::uint64_t> labels;
    constexpr std::uint8_t kRing = 1, kDiamond = 2;
    std::vector<std::uint8_t> hit[2];  // by stream: which layers hold each coded bit
    hit[0].assign(payload_.head.size(), 0);
    hit[1].assign(payload_.body.size(), 0);
    for (const std::uint32_t i : written_) {
      labels.push_back(carriers_.label[i]);
      for (int k = 0; k < 2; ++k) {
        const RingPlace place = ringCode_.place(carriers_.label[i], k, carriers_.bits[i]);
        for (std::uint32_t t = 0; t < carriers_.bits[i]; ++t) {
          auto& of = hit[place.slot[t].stream(sharing_) == Stream::body];
          of[place.slot[t].index % of.size()] |= kRing;
        }
      }
    }
    for (const WrittenCell& cell : cells_.cells)
      for (std::uint32_t t = 0; t < constellation_.shape().symbol; ++t) {
        const Constellation::Slot& slot = constellation_.slot(cell.meaning / constellation_.symbols(), t);
        hit[slot.stream == Stream::body][slot.bit] |= kDiamond;
      }
    sortCompactly(labels.begin(), labels.end());
    out.labels = static_cast<std::uint32_t>(std::unique(labels.begin(), labels.end()) - labels.begin());
    out.cells = static_cast<std::uint32_t>(cells_.cells.size());
    out.symbolBits = constellation_.shape().symbol;
    out.vetoed = cells_.vetoed;
    out.goodCells = constellation_.groups();
    out.deltaClass = deltaClass_;
    for (const std::uint8_t layers : hit[0]) {
      out.ringPositions += layers & kRing;
      out.diamondPositions += layers / kDiamond;
      out.headPositions += layers != 0;
    }
    for (const std::uint8_t layers : hit[1]) {
      out.ringBodyPositions += layers & kRing;
      out.diamondBodyPositions += layers / kDiamond;
    }
  }

  const Mesh& mesh_;
  const CodedPayload& payload_;
  const Sharing sharing_;
  Preset preset_;
  const double diagonal_;
  const std::shared_ptr<Ground> ground_;
  Surface& surface_;
  const Carriers& carriers_;
  const std::vector<double>& original_;
  std::vector<double> positions_;
  const RingCode ringCode_;
  const Prf jitter_;
  std::vector<Diamond> diamonds_;  // until candidates are made of them
  const std::vector<std::uint8_t> creased_;
  const std::uint8_t deltaClass_;
  const Constellation constellation_;
  std::unique_ptr<FacesAround> facesAround_;
  DiamondEmbedding cells_;
  std::unique_ptr<ChangeMeter> change_;
  bool hasRoom_ = preset_.budget > 1;   // whether there are no limits, or the mark is far from them
  std::vector<std::uint8_t> dropped_;   // per carrier
  std::vector<std::uint32_t> written_;  // carriers
};

}  // namespace

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
  Embedder embedder(mesh, payload, keys, preset, diagonal);
  if (cancelled("diamonds", 0.3)) return aborted;
  embedder.writeCells();
  if (cancelled("rings", 0.8)) return aborted;
  embedder.writeCarriers();
  return embedder.result();
}

}  // namespace quadmark::robust
