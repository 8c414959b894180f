// SPDX-License-Identifier: MIT
#include "chance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "trial.h"

namespace quadmark::bench {
namespace {

constexpr std::uint64_t kMarks = 4;              // keys 1 .. 4
constexpr std::uint64_t kFirstReader = 1000000;  // key of trial 0

Result<std::vector<Mesh>> innocents(const std::string& mark, const Mesh& model) {
  if (mark.empty()) return std::vector<Mesh>{model};
  std::vector<Mesh> marked;
  for (std::uint64_t key = 1; key <= kMarks; ++key) {
    const auto trial = makeTrial(mark, "", "id", key);
    if (!trial) return trial.error();
    auto one = markTrial(*trial, model);
    if (!one) return one.error();
    marked.push_back(std::move(one->mesh));
  }
  return marked;
}

int binOf(double claim) {
  return claim >= 1 ? 0 : static_cast<int>(std::floor(-10 * std::log10(std::max(claim, 1e-300))));
}

}  // namespace

Result<ChanceBins> countChance(const ChanceTrials& trials, const Mesh& model) {
  const auto meshes = innocents(trials.mark, model);
  if (!meshes) return meshes.error();
  ChanceBins out;
  for (std::uint64_t i = trials.first; i < trials.first + trials.count; ++i) {
    const auto trial = makeTrial(trials.scheme, trials.settings, "id", kFirstReader + i);
    if (!trial) return trial.error();
    const Judgement judgement = readTrial(*trial, (*meshes)[i % meshes->size()]);
    ChanceBin& bin = out[binOf(judgement.claim)];
    ++bin.trials;
    bin.matches += judgement.outcome == "lost" ? 0 : 1;
  }
  return out;
}

}  // namespace quadmark::bench
