// SPDX-License-Identifier: MIT
// What wrong keys read from unmarked models and from other keys' marks. QUADMARK_TRIALS sets the number of keys; 10000
// take a few hours.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "quadmark/exact_math.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/robust/demapper.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/robust/evidence.h"
#include "quadmark/robust/mesh_source.h"
#include "robust_simulation.h"

namespace quadmark::robust {
namespace {

using namespace lab;

SchemeKeys keysOf(std::uint64_t seed) {
  std::vector<std::uint8_t> secret(32, 9);
  for (int i = 0; i < 8; ++i) secret[i] = static_cast<std::uint8_t>(seed >> (8 * i));
  return *deriveKeys(secret, "");
}

int trials(int usual) {
  const char* wanted = std::getenv("QUADMARK_TRIALS");
  return wanted != nullptr ? std::max(1, std::atoi(wanted)) : usual;
}

// Meshes without a mark of the keys that are tried.
std::vector<Mesh> innocents() {
  const Mesh plain = sculpture(3000);
  Mesh marked = plain;
  const SchemeKeys others = keysOf(1);
  auto embedding = embedRobust(plain, encode(*bitsOf(std::uint64_t{1}, BodyRate::half, 1, others), others), others.geometry);
  EXPECT_TRUE(embedding);
  marked.positions = embedding->positions;
  return {plain, marked, machinedPart(2500), bumpyGrid(50, 50, 1), quantize(marked, 12, Grid::common)};
}

TEST(RobustFalsePositives, WrongKeysFindNothing) {
  const int count = trials(4);
  int frames = 0;
  for (const Mesh& mesh : innocents())
    for (int trial = 0; trial < count; ++trial) {
      const SchemeKeys keys = keysOf(1000 + static_cast<std::uint64_t>(trial));
      MeshReader reader(mesh, keys.geometry, headCode());
      MeshSource source(reader);
      const auto reading = readMark(source, {keys, Payload{Random::mix(static_cast<std::uint64_t>(trial))}});
      ASSERT_TRUE(reading);
      EXPECT_NE(reading->verdict, Verdict::match);
      frames += reading->framed ? 1 : 0;
    }
  // Each search offers some 150 hypotheses, 64 candidates each, to a tag of 24 bits.
  EXPECT_LE(frames, 2 + count * 5 * 6e-4 * 3);
}

// The bounds of evidence.h on real geometry: small probabilities are as rare as they claim, for each layer.
TEST(RobustFalsePositives, LayersAreCalibrated) {
  const int count = trials(60);
  std::array<std::array<int, 2>, 3> below{};  // ring votes, ring ratios, diamond ratios; at 0.1 and 0.01
  int tests = 0;
  for (const Mesh& mesh : innocents())
    for (int trial = 0; trial < count; ++trial) {
      const SchemeKeys keys = keysOf(5000 + static_cast<std::uint64_t>(trial));
      MeshReader reader(mesh, keys.geometry, headCode());
      const CodedPayload expected =
          encode(*bitsOf(Random::mix(static_cast<std::uint64_t>(trial)), BodyRate::half, 1, keys), keys);
      Hypothesis ring, diamonds;
      ring.ringSigma = 1e-4;
      diamonds.layers = Layers::diamonds;
      diamonds.diamondSigma = 1.8e-5;
      const double chances[3] = {logChance(reader.ringAgreement(expected)),
                                 logChance(Demapper(reader.headBits(ring)).ratios(), expected.head),
                                 logChance(Demapper(reader.headBits(diamonds)).ratios(), expected.head)};
      for (std::size_t i = 0; i < 3; ++i) {
        below[i][0] += exactExp(chances[i]) <= 0.1 ? 1 : 0;
        below[i][1] += exactExp(chances[i]) <= 0.01 ? 1 : 0;
      }
      ++tests;
    }
  for (std::size_t i = 0; i < 3; ++i) {
    const double n = tests;
    RecordProperty("below_0.1_of_" + std::to_string(i), below[i][0]);
    RecordProperty("below_0.01_of_" + std::to_string(i), below[i][1]);
    EXPECT_LE(below[i][0], 0.1 * n + 4 * std::sqrt(0.1 * n)) << i;
    EXPECT_LE(below[i][1], 0.01 * n + 4 * std::sqrt(0.01 * n)) << i;
  }
  if (tests >= 300) {
    EXPECT_GE(below[0][0], tests / 30);  // the exact tail is not only safe but close
  }
}

}  // namespace
}  // namespace quadmark::robust
