// SPDX-License-Identifier: MIT
// The promise behind every verdict: under keys that have nothing to do with a model, "false-positive probability <= p"
// comes up in a share p of the cases at most, and "match" never.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures.h"

namespace quadmark {
namespace {

using namespace test;

// The share of n trials may exceed p by three standard deviations of a binomial, and by one trial.
void expectCalibrated(const std::vector<double>& probabilities, const std::string& name) {
  const auto n = static_cast<double>(probabilities.size());
  for (const double p : {1e-1, 1e-2, 1e-3}) {
    double count = 0;
    for (double q : probabilities) count += q <= p;
    EXPECT_LE(count, p * n + 3 * std::sqrt(n * p * (1 - p)) + 1) << name << " at " << p;
  }
}

void expectNoMatch(const Mesh& mesh, const Key& key, int trials, const std::string& name,
                   const std::vector<std::uint8_t>& reference = {}) {
  const WeldedMesh welded = weld(mesh);
  ExtractOptions options;
  options.reference = reference;
  std::vector<double> probabilities;
  int none = 0;
  for (int i = 0; i < trials; ++i) {
    const Extraction read = extractMesh(welded, welded.positions, roundingOf(mesh.precision),
                                        strangersKey(key, static_cast<std::uint32_t>(i)), options);
    EXPECT_NE(read.verdict, Verdict::match) << name << ", key " << i << ": " << read.falsePositive;
    none += read.verdict == Verdict::none;
    probabilities.push_back(read.falsePositive);
  }
  EXPECT_GE(none, trials - 1 - trials / 100) << name;
  expectCalibrated(probabilities, name);
}

TEST(FalsePositives, AreNoMoreThanClaimedForWrongKeysOnAMarkedModel) {
  const Key key = testKey(8, 8);
  const std::vector<std::uint8_t> bits = logo(8, 8).bits;
  expectNoMatch(marked(lab::sculpture(1500), key, bits), key, repetitions(1000), "sculpture");
}

TEST(FalsePositives, AreNoMoreThanClaimedForWrongKeysWithAReference) {
  const Key key = testKey(8, 8);
  const std::vector<std::uint8_t> bits = logo(8, 8).bits;
  expectNoMatch(marked(lab::sculpture(1500), key, bits), key, repetitions(1000), "sculpture", bits);
}

TEST(FalsePositives, AreNoMoreThanClaimedOnUnmarkedModels) {
  const Key key = testKey(8, 8);
  expectNoMatch(lab::sculpture(1000), key, repetitions(400), "sculpture");
  expectNoMatch(lab::machinedPart(600), key, repetitions(200), "machinedPart");  // flat sets everywhere
  expectNoMatch(lab::quadSphere(3), key, repetitions(200), "quadSphere");        // and many alike
  expectNoMatch(lab::flatGrid(10, 10), key, repetitions(200), "flatGrid");
}

}  // namespace
}  // namespace quadmark
