// SPDX-License-Identifier: MIT
#include "quadmark/robust/reader.h"

#include <algorithm>
#include <map>
#include <utility>

#include "diamond_votes.h"
#include "ground.h"
#include "quadmark/robust/demapper.h"
#include "ring_votes.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

// Vertex noise assumed, of the largest extent, likeliest first.
constexpr double kRingSigmas[] = {1e-4, 4e-4, 1e-3, 2e-5};
constexpr double kDiamondSigmas[] = {1e-5, 1.8e-5, 3e-6, 4e-8, 4e-5, 8e-5};
// Noise at which lattice steps are compared where no level is given: a tolerant one, as sharper peaks may be missed.
constexpr double kStepSigma = 4e-4;
constexpr double kSharpenings[] = {0.1, 0.3, 0.6, 1.0};
constexpr std::uint8_t kHeadOnlyClasses[] = {0, 1, 2}, kSplitClasses[] = {3, 4, 5};

// Cells are unflattened by noise along their normals of up to 1e-5 of the diagonal; where no more noise than that is
// assumed, the ratios have seen less of it. (Of 1, 0.5, 0.35 and 0.25: finer is better on exact coordinates, and loses
// simplification with 14 and 15 bits on dense models.)
constexpr double kConcealmentSigma = 1e-5, kQuietPlane = 0.5;
double planeShare(double sigma) { return sigma <= kConcealmentSigma ? kQuietPlane : 1; }

// Calls visit(hypothesis) for all, likeliest first, until it returns true.
template <class Visit>
bool forEachHypothesis(const ReadLimits& limits, const Visit& visit) {
  std::uint32_t number = 0;
  const int sharings = limits.trySplit ? 2 : 1;
  const auto offer = [&](Hypothesis h, int sharing) {
    h.sharing = static_cast<Sharing>(sharing);
    h.number = ++number;
    return visit(h);
  };
  const auto ring = [](double sigma, int rank, double sharpening) {
    Hypothesis h;
    h.ringSigma = sigma, h.ringRank = static_cast<std::uint8_t>(rank), h.sharpening = sharpening;
    return h;
  };
  const auto diamonds = [](double sigma, std::uint8_t deltaClass) {
    Hypothesis h;
    h.layers = Layers::diamonds, h.diamondSigma = sigma, h.deltaClass = deltaClass;
    return h;
  };
  const auto classes = [](int sharing) -> const std::uint8_t(&)[3] {
    return sharing == 0 ? kHeadOnlyClasses : kSplitClasses;
  };
  for (int sharing = 0; sharing < sharings; ++sharing)
    for (const double sigma : kRingSigmas)
      if (offer(ring(sigma, 0, 0), sharing)) return true;
  for (int late = 0; late < 2; ++late)
    for (int sharing = 0; sharing < sharings; ++sharing)
      for (const std::uint8_t deltaClass : classes(sharing))
        for (std::size_t i = late == 0 ? 0 : 2; i < (late == 0 ? 2 : std::size(kDiamondSigmas)); ++i)
          if (offer(diamonds(kDiamondSigmas[i], deltaClass), sharing)) return true;
  if (!limits.tryHarder) return false;
  for (int sharing = 0; sharing < sharings; ++sharing)
    for (int rank = 1; rank < static_cast<int>(std::size(kRingSteps)); ++rank)
      for (const double sigma : kRingSigmas)
        if (offer(ring(sigma, rank, 0), sharing)) return true;
  for (int sharing = 0; sharing < sharings; ++sharing)
    for (const double ringSigma : {1e-4, 4e-4})
      for (const std::uint8_t deltaClass : classes(sharing))
        for (const double sigma : kDiamondSigmas) {
          Hypothesis h = diamonds(sigma, deltaClass);
          h.layers = Layers::both, h.ringSigma = ringSigma;
          if (offer(h, sharing)) return true;
        }
  for (const double sharpening : kSharpenings)
    for (int sharing = 0; sharing < sharings; ++sharing)
      for (const double sigma : kRingSigmas)
        if (offer(ring(sigma, 0, sharpening), sharing)) return true;
  const auto offerMirrored = [&](Hypothesis h, int sharing) {
    h.mirrored = true;
    return offer(h, sharing);
  };
  for (int sharing = 0; sharing < sharings; ++sharing) {
    for (int i = 0; i < 2; ++i)
      if (offerMirrored(ring(kRingSigmas[i], 0, 0), sharing)) return true;
    for (const std::uint8_t deltaClass : classes(sharing))
      for (int i = 0; i < 2; ++i)
        if (offerMirrored(diamonds(kDiamondSigmas[i], deltaClass), sharing)) return true;
  }
  return false;
}

}  // namespace

struct MeshReader::State {
  const Mesh& mesh;
  RobustKeys keys;
  StreamCode head;
  std::shared_ptr<Ground> ground;
  double extent = 0;
  RingCode ringCode;
  ReaderCoverage coverage;
  bool mirrored = false;  // what follows is of the surface turned over
  std::map<double, RingVotes> ringVotes;                                // by sharpening
  std::map<std::pair<double, double>, std::vector<double>> stepsByFit;  // by sharpening and sigma
  std::unique_ptr<DiamondVotes> diamondVotes;
  std::map<std::pair<std::uint8_t, double>, CellScores> scores;  // by delta class and sigma

  State(const Mesh& m, const RobustKeys& k, StreamCode h, std::shared_ptr<Ground> known)
      : mesh(m),
        keys(k),
        head(std::move(h)),
        ground(known && moveTo(known->surface, m) ? std::move(known) : groundOf(m, k)),
        ringCode(k) {
    extent = largestExtent(ground->surface.welded.positions);
    coverage.vertices = ground->surface.vertexCount();
    coverage.carriers = ground->carriers.count();
    const RingVotes& votes = rings(0);
    coverage.labels = votes.labelCount();
    coverage.ringPositions = votes.positionsHit({Sharing::headOnly, Stream::head, head.bits});
  }

  // One side at a time: the other one is rarely asked for, and would double the memory.
  void turn(bool wanted) {
    if (mirrored == wanted) return;
    mirrored = wanted;
    ringVotes.clear();
    stepsByFit.clear();
    forgetCells();
    ground.reset();
    ground = groundOf(mesh, keys, mirrored);
  }

  void forgetCells() {
    diamondVotes.reset();
    scores.clear();
  }

  const RingVotes& rings(double sharpening) {
    const auto found = ringVotes.find(sharpening);
    if (found != ringVotes.end()) return found->second;
    Surface& surface = ground->surface;
    if (sharpening > 0) {
      forgetCells();  // they are not asked for beside these, and are as much memory
      rememberRings(surface);
    }
    const std::vector<double> positions = sharpening > 0 ? sharpened(surface, sharpening) : surface.welded.positions;
    return ringVotes
        .emplace(sharpening, RingVotes(ground->carriers, ringCode, positions, edgeTensor(surface, positions)))
        .first->second;
  }

  // The lattice step of a rank by fit. @param sigma  of the extent.
  double ringStep(double sharpening, double sigma, std::size_t rank) {
    const auto [place, isNew] = stepsByFit.try_emplace({sharpening, sigma});
    if (isNew) {
      std::vector<std::pair<double, double>> fits;  // ascending by -fit, then by step
      for (const double step : kRingSteps) fits.push_back({-rings(sharpening).fit({step, sigma * extent}), step});
      sortCompactly(fits.begin(), fits.end());
      for (const auto& fit : fits) place->second.push_back(fit.second);
    }
    return place->second[std::min(rank, std::size(kRingSteps) - 1)];
  }

  const CellScores& cells(std::uint8_t deltaClass, double sigma) {
    if (!diamondVotes) {
      forgetRings(ground->surface);  // as little beside those
      std::vector<double> sigmas;
      for (const double s : kDiamondSigmas) sigmas.push_back(s * extent);
      diamondVotes = std::make_unique<DiamondVotes>(ground->surface, ground->surface.welded.positions, sigmas);
      coverage.diamonds = diamondVotes->count();
    }
    const auto [place, isNew] = scores.try_emplace({deltaClass, sigma});
    if (isNew) place->second = diamondVotes->score(kDeltas[deltaClass], sigma * extent, planeShare(sigma));
    coverage.diamondShare = std::max(coverage.diamondShare, place->second.share);
    return place->second;
  }

  SoftBits bits(const Hypothesis& h, Stream stream, const StreamCode& body) {
    turn(h.mirrored);
    const StreamSelection selection{h.sharing, stream, stream == Stream::head ? head.bits : body.bits};
    SoftBits out{std::vector<float>(selection.bits, 0.0f)};
    if (selection.bits == 0) return out;
    if (h.layers != Layers::diamonds)
      rings(h.sharpening)
          .addRatios({ringStep(h.sharpening, h.ringSigma, h.ringRank), h.ringSigma * extent}, selection, out.single);
    if (h.layers != Layers::ring)
      DiamondVotes::addSymbols(Constellation(h.deltaClass, keys, h.sharing, head, body),
                               cells(h.deltaClass, h.diamondSigma), stream, out);
    return out;
  }
};

MeshReader::MeshReader(const Mesh& mesh, const RobustKeys& keys, StreamCode head, std::shared_ptr<Ground> ground)
    : state_(std::make_unique<State>(mesh, keys, std::move(head), std::move(ground))) {}
MeshReader::~MeshReader() = default;
MeshReader::MeshReader(MeshReader&&) noexcept = default;

bool MeshReader::search(const ReadLimits& limits, const AcceptHead& accept) {
  return forEachHypothesis(limits, [&](const Hypothesis& h) { return accept(headBits(h), h); });
}

std::vector<Hypothesis> MeshReader::hypotheses(const ReadLimits& limits) {
  std::vector<Hypothesis> out;
  forEachHypothesis(limits, [&](const Hypothesis& h) {
    out.push_back(h);
    return false;
  });
  return out;
}

SoftBits MeshReader::headBits(const Hypothesis& hypothesis) {
  return state_->bits(hypothesis, Stream::head, {});
}

SoftBits MeshReader::bodyBits(const Hypothesis& hypothesis, const StreamCode& body) {
  return state_->bits(hypothesis, Stream::body, body);
}

Agreement MeshReader::ringAgreement(const CodedPayload& expected, double sharpening, bool mirrored) {
  Agreement out;
  state_->turn(mirrored);
  const Sharing sharing = expected.hasBody() ? Sharing::split : Sharing::headOnly;
  const RingVotes& votes = state_->rings(sharpening);
  const double step = state_->ringStep(sharpening, kStepSigma, 0);
  votes.countAgreement(step, {sharing, Stream::head, 0}, expected.head, out);
  votes.countAgreement(step, {sharing, Stream::body, 0}, expected.body, out);
  return out;
}

Agreement MeshReader::diamondAgreement(const CodedPayload& expected, const Hypothesis& hypothesis) {
  Agreement out;
  Hypothesis h = hypothesis;
  h.layers = Layers::diamonds;
  h.sharing = expected.hasBody() ? Sharing::split : Sharing::headOnly;
  const auto count = [&](const SoftBits& soft, const std::vector<std::uint8_t>& bits) {
    const Demapper demapper(soft);
    const std::vector<float>& ratios = demapper.ratios();
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (ratios[i] == 0) continue;
      ++out.votes;
      out.agreeing += (ratios[i] < 0) == (bits[i] != 0);
    }
  };
  count(headBits(h), expected.head);
  if (expected.hasBody()) count(bodyBits(h, expected.bodyCode()), expected.body);
  return out;
}

std::vector<float> MeshReader::evidence(const CodedPayload& payload, const Hypothesis& hypothesis) {
  State& s = *state_;
  s.turn(hypothesis.mirrored);
  std::vector<float> perWelded(s.ground->surface.vertexCount(), 0.0f);
  const double sigma = hypothesis.layers == Layers::diamonds ? kStepSigma : hypothesis.ringSigma;
  const double step = s.ringStep(hypothesis.sharpening, sigma, hypothesis.ringRank);
  const std::vector<float> perCarrier = s.rings(hypothesis.sharpening).agreementPerCarrier(step, payload);
  for (std::size_t i = 0; i < perCarrier.size(); ++i) perWelded[s.ground->carriers.vertex[i]] = perCarrier[i];
  if (hypothesis.layers != Layers::ring) {
    const Sharing sharing = payload.hasBody() ? Sharing::split : Sharing::headOnly;
    const Constellation constellation(hypothesis.deltaClass, s.keys, sharing, payload.headCode(), payload.bodyCode());
    addDiamondEvidence(s.ground->surface, constellation, payload, hypothesis.diamondSigma * s.extent, perWelded);
  }
  std::vector<float> out(s.mesh.vertexCount(), 0.0f);
  for (std::size_t v = 0; v < out.size(); ++v)
    if (s.ground->surface.welded.weldedOf[v] != kNoVertex) out[v] = perWelded[s.ground->surface.welded.weldedOf[v]];
  return out;
}

const ReaderCoverage& MeshReader::coverage() const {
  return state_->coverage;
}

}  // namespace quadmark::robust
