// SPDX-License-Identifier: MIT
#include "quadmark/extract_parts.h"

#include <algorithm>

#include "sorting.h"

namespace quadmark {
namespace {

constexpr double kModelWeight = 0.5, kSeamsWeight = 0.25, kComponentsWeight = 0.25;
constexpr std::size_t kMostComponents = 64;         // by then the weight is below 1 / 16 000
constexpr std::uint32_t kLeastComponentVertices = 100;  // 20 cells: too few for a match

// Components that could carry a mark, largest first; ties by their least position.
std::vector<std::vector<std::uint32_t>> largestComponents(const WeldedMesh& welded) {
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> componentOf = components(welded, count);
  if (count < 2) return {};
  std::vector<std::uint32_t> size(count, 0);
  for (std::uint32_t component : componentOf) ++size[component];
  std::vector<std::vector<std::uint32_t>> members;
  std::vector<std::uint32_t> place(count, kNoVertex);
  for (std::uint32_t v = 0; v < welded.vertexCount(); ++v) {
    const std::uint32_t component = componentOf[v];
    if (size[component] < kLeastComponentVertices) continue;
    if (place[component] == kNoVertex) {
      place[component] = static_cast<std::uint32_t>(members.size());
      members.emplace_back();
      members.back().reserve(size[component]);
    }
    members[place[component]].push_back(v);
  }
  const auto at = [&](std::uint32_t v) { return &welded.positions[3 * std::size_t{v}]; };
  const auto before = [&](std::uint32_t v, std::uint32_t w) { return std::lexicographical_compare(at(v), at(v) + 3, at(w), at(w) + 3); };
  struct Ranked {
    std::size_t size;
    std::uint32_t least, index;
  };
  std::vector<Ranked> ranked;
  for (std::uint32_t i = 0; i < members.size(); ++i)
    ranked.push_back({members[i].size(), *std::min_element(members[i].begin(), members[i].end(), before), i});
  sortCompactly(ranked.begin(), ranked.end(), [&](const Ranked& a, const Ranked& b) {
    if (a.size != b.size) return a.size > b.size;
    if (before(a.least, b.least) || before(b.least, a.least)) return before(a.least, b.least);
    return a.index < b.index;
  });
  std::vector<std::vector<std::uint32_t>> out;
  for (std::size_t i = 0; i < std::min(ranked.size(), kMostComponents); ++i)
    out.push_back(std::move(members[ranked[i].index]));
  return out;
}

class PartsReader {
 public:
  PartsReader(const WeldedMesh& welded, Precision precision, const Key& key, const ExtractOptions& options)
      : welded_(welded), precision_(precision), key_(key), options_(options) {}

  PartsExtraction run() {
    best_.extraction = extractMesh(welded_, welded_.positions, roundingOf(precision_, welded_), key_, options_);
    best_.partVertices = welded_.vertexCount();
    weigh(best_.extraction, kModelWeight);
    if (settled()) return std::move(best_);

    std::vector<std::uint32_t> origin;
    const WeldedMesh closed = closeSeams(welded_, origin);
    if (closed.vertexCount() < welded_.vertexCount()) consider(closed, origin, Part::closedSeams, kSeamsWeight);
    if (settled()) return std::move(best_);

    const std::vector<std::vector<std::uint32_t>> parts = largestComponents(welded_);
    for (std::size_t i = 0; i < parts.size() && !settled(); ++i) {
      const auto rank = static_cast<double>(i + 1);
      consider(subMesh(welded_, parts[i]), parts[i], Part::component, kComponentsWeight / (rank * (rank + 1)));
    }
    return std::move(best_);
  }

 private:
  [[nodiscard]] bool settled() const {
    return best_.extraction.cancelled || best_.extraction.verdict == Verdict::match;
  }

  // A reading's own doubt ("cells of some mark, too few to say whose") stays a doubt.
  static void weigh(Extraction& extraction, double weight) {
    extraction.falsePositive = std::min(1.0, extraction.falsePositive / weight);
    const bool doubt = extraction.verdict == Verdict::inconclusive || extraction.falsePositive <= kDoubtProbability;
    extraction.verdict = extraction.falsePositive <= kMatchProbability ? Verdict::match
                         : doubt                                       ? Verdict::inconclusive
                                                                       : Verdict::none;
  }

  // @param origin  for each vertex of the part, one of the model.
  void consider(const WeldedMesh& part, const std::vector<std::uint32_t>& origin, Part kind, double weight) {
    Extraction read = extractMesh(part, part.positions, roundingOf(precision_, part), key_, options_);
    ++best_.tried;
    if (read.cancelled) best_.extraction.cancelled = true;
    weigh(read, weight);
    // Of what is no match the whole model's picture stays, with the least bound of all.
    if (read.verdict != Verdict::match) {
      Extraction& whole = best_.extraction;
      whole.falsePositive = std::min(whole.falsePositive, read.falsePositive);
      if (whole.falsePositive <= kDoubtProbability) whole.verdict = Verdict::inconclusive;
      return;
    }
    for (CellReading& reading : read.readings)
      for (std::uint32_t& v : reading.vertices) v = origin[v];
    best_.extraction = std::move(read);
    best_.part = kind;
    best_.partVertices = part.vertexCount();
  }

  const WeldedMesh& welded_;
  const Precision precision_;
  const Key& key_;
  const ExtractOptions& options_;
  PartsExtraction best_;
};

}  // namespace

const char* partName(Part part) {
  return part == Part::model ? "model" : part == Part::closedSeams ? "closedSeams" : "component";
}

PartsExtraction extractParts(const WeldedMesh& welded, Precision precision, const Key& key,
                             const ExtractOptions& options) {
  return PartsReader(welded, precision, key, options).run();
}

}  // namespace quadmark
