// SPDX-License-Identifier: MIT
#include "diamond_votes.h"

#include <algorithm>

#include "likelihood.h"
#include "median.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

constexpr double kFarthest = 4;   // gaps of more standard deviations than this are no cells
constexpr double kBlurred = 0.7;  // cells whose ratios are known worse than this many fine cells say nothing
constexpr double kMostPerDiamond = 2.5;
constexpr double kMostPerCell = 25;

// ln(1 + x) for x >= 0, Pade; more than the bound on a diamond's vote beyond x = 50.
double logOnePlus(double x) {
  return x > 50 ? 3.9 : x * (6 + x) / (6 + 4 * x);
}

// Likelihood of a ratio under each of the three nearest fine-cell centres, per fine cell.
struct Blur {
  double density[3];
  double sum;
  Blur(double cells, std::uint32_t cell, double gain, double sigma, double delta) {
    const double s = std::sqrt(gain * sigma / delta * (gain * sigma / delta) + 1e-6), offset = cells - cell - 0.5;
    sum = 0;
    for (int d = -1; d <= 1; ++d) {
      const double z = (offset - d) / s;
      density[d + 1] = gaussian(z * z) / (s * kRootTwoPi);
      sum += density[d + 1];
    }
  }
};

}  // namespace

DiamondVotes::DiamondVotes(const Surface& surface, const std::vector<double>& positions,
                           std::span<const double> sigmas) {
  for (const double sigma : sigmas) limits_.push_back(kFarthest * sigma);
  sortCompactly(limits_.begin(), limits_.end());
  const std::vector<Diamond> diamonds = collectDiamonds(surface);
  const auto sectionOf = [&](float gap) {
    std::uint8_t s = 0;
    while (s < limits_.size() && gap > limits_[s]) ++s;
    return s;
  };
  // Two passes over the shapes, counting and placing, so that no second copy of the arrays is needed.
  sections_.assign(limits_.size() + 2, 0);
  const auto forEach = [&](const auto& visit) {
    DiamondShape shape;
    for (const Diamond& diamond : diamonds) {
      if (!diamondShape(positions, diamond, shape)) continue;
      if (!isUsable(ratiosOf(shape))) continue;
      visit(shape, static_cast<float>(shape.gapLength / shape.gapGain));
    }
  };
  forEach([&](const DiamondShape&, float gap) { ++sections_[sectionOf(gap) + 1]; });
  for (std::size_t s = 1; s < sections_.size(); ++s) sections_[s] += sections_[s - 1];
  const std::uint32_t count = sections_.back();
  for (auto* column : {&gap_, &edge_, &span_, &edgeGain_, &spanGain_}) column->resize(count);
  bin_.resize(count);
  std::vector<std::uint32_t> cursor(sections_.begin(), sections_.end() - 1);
  forEach([&](const DiamondShape& shape, float gap) {
    const std::uint32_t i = cursor[sectionOf(gap)]++;
    gap_[i] = gap;
    const Ratios ratios = ratiosOf(shape);
    edge_[i] = static_cast<float>(ratios.edge);
    span_[i] = static_cast<float>(ratios.span);
    edgeGain_[i] = static_cast<float>(shape.edgeGain);
    spanGain_[i] = static_cast<float>(shape.spanGain);
    constexpr double kBinsPerUnit = kBins / (0.5 - kLeastRatio);
    const auto edgeBin = static_cast<std::uint32_t>((edge_[i] - kLeastRatio) * kBinsPerUnit);
    const auto spanBin = static_cast<std::uint32_t>((span_[i] - kLeastRatio) * kBinsPerUnit);
    bin_[i] = static_cast<std::uint8_t>(std::min(kBins - 1, edgeBin) * 2 * kBins + std::min(2 * kBins - 1, spanBin));
  });
  if (count == 0) return;
  scale_ = std::max(medianOf(gap_) / 0.693, 1e-300);
}

// Where unmarked diamonds lie in the plane of ratios: those clearly not flat under this noise.
std::vector<float> DiamondVotes::background(double sigma) const {
  std::vector<float> bins(2 * kBins * kBins, 1.0f);
  double total = 2 * kBins * kBins;
  const double from = kFarthest * sigma, to = std::max(40 * sigma, scale_);
  for (std::size_t i = 0; i < gap_.size(); ++i)
    if (gap_[i] > from && gap_[i] < to) ++bins[bin_[i]], ++total;
  for (float& bin : bins) bin = static_cast<float>(std::max(0.2, bin / total * (2 * kBins * kBins)));
  return bins;
}

CellScores DiamondVotes::score(const DeltaClass& shape, double sigma, double plane) const {
  CellScores out;
  out.score.assign(shape.cells(), 0.0f);
  const auto level = std::lower_bound(limits_.begin(), limits_.end(), kFarthest * sigma) - limits_.begin();
  const std::uint32_t end = sections_[std::min<std::size_t>(level + 1, sections_.size() - 1)];
  if (count() < 8 || end == 0) return out;
  const std::vector<float> bins = background(sigma);

  // 1. Per flat diamond, how much better "a cell of some mark" explains it than chance, fine cells not yet looked at.
  std::vector<float> odds(end, 0.0f);
  const auto flatness = [&](std::uint32_t i) {
    const double z = gap_[i] / sigma;
    const double marked = gaussian(z * z) * 2 / (sigma * kRootTwoPi), chance = 1 / (scale_ + gap_[i]);
    return marked / chance / bins[bin_[i]];
  };
  const double blur = plane * sigma;
  const auto usable = [&](std::uint32_t i, FineCell& cell) {
    cell = fineCell(edge_[i], span_[i], shape);
    return cell.isIn(shape) && edgeGain_[i] * blur <= kBlurred * shape.delta &&
           spanGain_[i] * blur <= kBlurred * shape.delta;
  };
  for (std::uint32_t i = 0; i < end; ++i) {
    FineCell cell;
    if (!usable(i, cell)) continue;
    const Blur edge(edgePlace(edge_[i], shape), cell.edge, edgeGain_[i], blur, shape.delta);
    const Blur span(spanPlace(span_[i], shape), cell.span, spanGain_[i], blur, shape.delta);
    odds[i] = static_cast<float>(flatness(i) * edge.sum * span.sum);
  }

  // 2. The share of marked diamonds, a scalar, by expectation maximisation.
  double share = 0.03;
  for (int step = 0; step < 8; ++step) {
    double sum = 0;
    for (std::uint32_t i = 0; i < end; ++i) sum += share * odds[i] / (1 - share + share * odds[i]);
    share = std::clamp(sum / count(), 1e-6, 0.5);
  }
  out.share = share;

  // 3. Votes for the nearest fine cells.
  const double prior = share / (1 - share) * (1u << shape.symbol);
  for (std::uint32_t i = 0; i < end; ++i) {
    FineCell cell;
    if (prior * odds[i] < 0.003 || !usable(i, cell)) continue;
    const Blur edge(edgePlace(edge_[i], shape), cell.edge, edgeGain_[i], blur, shape.delta);
    const Blur span(spanPlace(span_[i], shape), cell.span, spanGain_[i], blur, shape.delta);
    const double flat = prior * flatness(i);
    for (std::uint32_t e = cell.edge == 0 ? 1 : 0; e < 3 && cell.edge + e <= shape.side; ++e)
      for (std::uint32_t s = cell.span == 0 ? 1 : 0; s < 3 && cell.span + s <= shape.spanSide(); ++s) {
        const double x = flat * edge.density[e] * span.density[s];
        if (x < 0.003) continue;
        float& score = out.score[FineCell{cell.edge + e - 1, cell.span + s - 1}.number(shape)];
        score += static_cast<float>(std::min(logOnePlus(x), kMostPerDiamond));
      }
  }
  for (float& score : out.score) score = std::min(score, static_cast<float>(kMostPerCell));
  return out;
}

void DiamondVotes::addSymbols(const Constellation& constellation, const CellScores& scores, Stream stream,
                              SoftBits& out) {
  const std::uint32_t symbols = constellation.symbols(), bits = constellation.shape().symbol;
  std::vector<float> byMeaning(std::size_t{constellation.groups()} * symbols, 0.0f);
  for (std::uint32_t cell = 0; cell < scores.score.size(); ++cell)
    if (const std::uint32_t meaning = constellation.meaning(cell); meaning != Constellation::kNone)
      byMeaning[meaning] = scores.score[cell];
  out.symbolBits = bits;
  for (std::uint32_t g = 0; g < constellation.groups(); ++g) {
    if (constellation.slot(g, 0).stream != stream) continue;
    for (std::uint32_t t = 0; t < bits; ++t) out.bitOf.push_back(constellation.slot(g, t).bit);
    const auto first = byMeaning.begin() + static_cast<std::ptrdiff_t>(std::size_t{g} * symbols);
    out.score.insert(out.score.end(), first, first + symbols);
  }
}

void addDiamondEvidence(const Surface& surface, const Constellation& constellation, const CodedPayload& payload,
                        double sigma, std::vector<float>& perVertex) {
  const std::vector<std::uint32_t> good = constellation.goodSymbols(payload);
  const DeltaClass& shape = constellation.shape();
  DiamondShape s;
  for (const Diamond& q : collectDiamonds(surface)) {
    if (!diamondShape(surface.welded.positions, q, s)) continue;
    const double z = s.gapLength / (s.gapGain * sigma);
    if (z > kFarthest) continue;
    const Ratios ratios = ratiosOf(s);
    const FineCell cell = fineCell(ratios.edge, ratios.span, shape);
    if (!cell.isIn(shape)) continue;
    const std::uint32_t meaning = constellation.meaning(cell.number(shape));
    if (meaning == Constellation::kNone) continue;
    if (good[meaning / constellation.symbols()] != meaning % constellation.symbols()) continue;
    for (const std::uint32_t v : {q.a, q.b, q.c, q.d})
      perVertex[v] = std::max(perVertex[v], static_cast<float>(gaussian(z * z)));
  }
}

}  // namespace quadmark::robust
