// SPDX-License-Identifier: MIT
#include "quadmark/extract.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures.h"

namespace quadmark {
namespace {

using namespace test;

const Key kKey = testKey(8, 8);
const std::vector<std::uint8_t> kBits = logo(8, 8).bits;

TEST(ExtractMesh, SurvivesVertexAndFaceReordering) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    SCOPED_TRACE(name);
    const Mesh output = marked(mesh, kKey, kBits);
    for (int seed = 0; seed < repetitions(50); ++seed)
      ASSERT_TRUE(readsExactly(lab::reorder(output, static_cast<std::uint64_t>(seed)), kKey, kBits)) << "seed " << seed;
  }
}

TEST(ExtractMesh, SurvivesTheAffineAttacksInFloat32) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    const Mesh output = marked(mesh, kKey, kBits);
    for (const std::string& attack : affineNames()) {
      SCOPED_TRACE(name + " " + attack);
      EXPECT_TRUE(readsExactly(mapped(output, attack), kKey, kBits));
    }
  }
}

TEST(ExtractMesh, DoesNotSeeTheOrderOfVerticesAtAll) {
  const Mesh output = marked(lab::machinedPart(3000), kKey, kBits);
  const Mesh noisy = lab::noise(output, 1e-6, 3);  // so that it is not all certain
  const Extraction a = readMark(noisy, kKey);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Extraction b = readMark(lab::reorder(noisy, seed), kKey);
    EXPECT_EQ(a.bits, b.bits);
    EXPECT_EQ(a.erased, b.erased);
    EXPECT_EQ(a.confidence, b.confidence);
    EXPECT_EQ(a.cells, b.cells);
    EXPECT_EQ(a.falsePositive, b.falsePositive);
  }
}

TEST(ExtractMesh, IsDeterministic) {
  const Mesh noisy = lab::noise(marked(lab::sculpture(3000), kKey, kBits), 1e-5, 3);
  const Extraction a = readMark(noisy, kKey), b = readMark(noisy, kKey);
  EXPECT_EQ(a.bits, b.bits);
  EXPECT_EQ(a.confidence, b.confidence);
  EXPECT_EQ(a.falsePositive, b.falsePositive);
}

TEST(ExtractMesh, FindsNothingWithAWrongKey) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    SCOPED_TRACE(name);
    const Mesh output = marked(mesh, kKey, kBits);
    for (std::uint32_t i = 0; i < 5; ++i) {
      const Extraction read = readMark(output, strangersKey(kKey, i));
      EXPECT_NE(read.verdict, Verdict::match);
      EXPECT_GT(read.falsePositive, kMatchProbability);
    }
    EXPECT_EQ(readMark(output, strangersKey(kKey, 0)).verdict, Verdict::none);
  }
}

TEST(ExtractMesh, FindsNothingInUnmarkedMeshes) {
  for (const auto& [name, mesh] : allMeshes()) {
    SCOPED_TRACE(name);
    const Extraction read = readMark(mesh, kKey);
    EXPECT_EQ(read.verdict, Verdict::none) << read.falsePositive;
    EXPECT_EQ(read.bits.size(), 64u);
  }
  EXPECT_EQ(readMark(Mesh{}, kKey).verdict, Verdict::none);
}

TEST(ExtractMesh, CarriesAnId) {
  const Key key = idKey();
  std::vector<std::uint8_t> bits(64);
  for (int i = 0; i < 64; ++i) bits[i] = static_cast<std::uint8_t>((0x0123456789abcdefu >> (63 - i)) & 1);
  const Mesh output = marked(lab::sculpture(3000), key, bits);
  EXPECT_TRUE(readsExactly(output, key, bits));
  EXPECT_TRUE(readsExactly(mapped(output, "CB"), key, bits));
}

TEST(ExtractMesh, CarriesImagesOfAnyShape) {
  for (const auto& [w, h] : {std::pair{30u, 5u}, {5u, 30u}, {1u, 40u}, {17u, 9u}, {2u, 1u}, {16u, 16u}}) {
    SCOPED_TRACE(std::to_string(w) + " x " + std::to_string(h));
    const Key key = testKey(w, h);
    const std::vector<std::uint8_t> bits = logo(w, h).bits;
    const Mesh output = marked(lab::sculpture(3000), key, bits);
    EXPECT_TRUE(readsExactly(output, key, bits));
    EXPECT_TRUE(readsExactly(lab::reorder(output, 5), key, bits));
  }
}

TEST(ExtractMesh, CarriesImagesWithoutVariety) {
  for (const bool value : {false, true}) {
    const std::vector<std::uint8_t> bits(64, value);
    const Extraction read = readMark(marked(lab::sculpture(3000), kKey, bits), kKey);
    EXPECT_TRUE(isExact(read, bits));
    EXPECT_EQ(read.verdict, Verdict::match);
  }
}

TEST(ExtractMesh, WorksWithTwoRings) {
  Key key = kKey;
  key.params.k = 2;
  for (const auto& [name, mesh] : {NamedMesh{"polygonMix", lab::polygonMix(5)}, {"sculpture", lab::sculpture(1500)}}) {
    SCOPED_TRACE(name);
    const Mesh output = marked(mesh, key, kBits);
    EXPECT_TRUE(readsExactly(output, key, kBits));
    EXPECT_TRUE(readsExactly(lab::reorder(output, 1), key, kBits));
    EXPECT_TRUE(readsExactly(mapped(output, "CB"), key, kBits));
    EXPECT_EQ(readMark(output, strangersKey(key, 3)).verdict, Verdict::none);
  }
}

TEST(ExtractMesh, WorksWithoutTolerance) {
  Key key = kKey;
  key.params.tau = 0;
  const Mesh output = marked(lab::sculpture(3000), key, kBits);
  const Extraction read = readMark(output, key);
  EXPECT_TRUE(isExact(read, kBits));
  EXPECT_EQ(read.passes, 1);
  EXPECT_TRUE(readsExactly(mapped(output, "CB"), key, kBits));
  EXPECT_EQ(readMark(lab::noise(output, 1e-3, 1), key).passes, 1);
  EXPECT_GT(readMark(lab::noise(output, 1e-3, 1), kKey).passes, 1);
}

TEST(ExtractMesh, UsesAReference) {
  const Mesh mesh = lab::sculpture(3000), output = marked(mesh, kKey, kBits);
  ExtractOptions options;
  options.reference = kBits;
  const Extraction good = readMark(output, kKey, options);
  EXPECT_NEAR(good.referenceProbability * 0x1p64, 1, 1e-9);  // 64 of 64 coins
  EXPECT_LE(good.falsePositive, 2 * std::min(good.agreementProbability, good.referenceProbability));
  EXPECT_EQ(good.verdict, Verdict::match);

  std::vector<std::uint8_t> inverse = kBits;
  for (std::uint8_t& bit : inverse) bit = bit == 0;
  options.reference = inverse;
  EXPECT_EQ(readMark(output, kKey, options).referenceProbability, 1);

  options.reference = kBits;
  const Extraction wrongKey = readMark(output, strangersKey(kKey, 4), options);
  EXPECT_EQ(wrongKey.verdict, Verdict::none);
  EXPECT_GT(wrongKey.referenceProbability, 1e-4);
  EXPECT_EQ(readMark(mesh, kKey, options).verdict, Verdict::none);
  EXPECT_EQ(readMark(output, kKey).referenceProbability, 1);  // none given
}

TEST(ExtractMesh, KeepsItsReadingsWhenAsked) {
  const Mesh output = marked(lab::sculpture(3000), kKey, kBits);
  ExtractOptions options;
  options.keepReadings = true;
  const Extraction read = readMark(output, kKey, options);
  const WeldedMesh welded = weld(output);
  std::vector<std::uint8_t> used(welded.vertexCount(), 0);
  std::uint32_t voting = 0;
  for (const CellReading& r : read.readings) {
    EXPECT_GE(r.purity, 0);
    EXPECT_LE(r.purity, 1);
    if (r.weight <= 0) continue;
    ++voting;
    Quad quad;
    ASSERT_TRUE(makeQuad(r.vertices, welded.positions.data(), kMinTriangleReading, quad));
    EXPECT_EQ(r.reading.state, ReadingState::ok);
    EXPECT_LT(r.reading.index, 11u);
    for (std::uint32_t v : r.vertices) EXPECT_EQ(used[v]++, 0) << "vertex votes twice";
  }
  EXPECT_EQ(voting, read.cells);
  EXPECT_EQ(read.piecesRead, 11u);
  EXPECT_TRUE(readMark(output, kKey).readings.empty());
}

// "Exact where every bit is repeated at least 16 times; elsewhere at most half the share of bits that lost all their
// copies, plus 0.5 %." A bit is lost with the last surviving cell of its piece.
TEST(ExtractMesh, KeepsTheCropRule) {
  const Key key = testKey(24, 24);
  const std::vector<std::uint8_t> bits = logo(24, 24).bits;
  for (const std::size_t size : {std::size_t{3000}, std::size_t{12000}}) {
    MarkedMesh report;
    const Mesh output = marked(lab::sculpture(size), key, bits, &report);
    for (const double fraction : {0.1, 0.3, 0.5, 0.7})
      for (int axis = 0; axis < 4; ++axis) {
        SCOPED_TRACE(std::to_string(size) + " " + std::to_string(fraction) + " axis " + std::to_string(axis));
        lab::VertexOrigin origin;
        const Mesh cropped = lab::crop(output, fraction, axis, 5, &origin);
        // Which pieces still have an intact cell, by what the whole model showed.
        ExtractOptions options;
        options.keepReadings = true;
        std::vector<std::uint8_t> kept(output.vertexCount(), 0);
        for (std::uint32_t v : origin) kept[v] = 1;
        const WeldedMesh welded = weld(output);
        std::vector<std::uint8_t> keptWelded(welded.vertexCount(), 0);
        for (std::uint32_t v = 0; v < output.vertexCount(); ++v)
          if (kept[v] != 0 && welded.weldedOf[v] != kNoVertex) keptWelded[welded.weldedOf[v]] = 1;
        std::vector<std::uint8_t> alive(96, 0);
        for (const CellReading& r : readMark(output, key, options).readings)
          if (r.weight > 0 &&
              std::all_of(r.vertices, r.vertices + 4, [&](std::uint32_t v) { return keptWelded[v] != 0; }))
            alive[r.reading.index] = 1;
        const double lost = static_cast<double>(std::count(alive.begin(), alive.end(), 0)) / 96;
        const Extraction read = readMark(cropped, key);
        const double ber = bitErrorRate(bits, read.bits, read.erased);
        EXPECT_LE(ber, 0.5 * lost + 0.005);
        if (report.leastRepeats >= 16 && fraction <= 0.5) {
          EXPECT_EQ(ber, 0);
        }
      }
  }
}

TEST(ExtractMesh, SurvivesMeshoptimizersSimplification) {
  const Key key = testKey(24, 24);
  const std::vector<std::uint8_t> bits = logo(24, 24).bits;
  const Mesh output = marked(lab::sculpture(20000), key, bits);
  const Extraction read = readMark(lab::simplifyMeshopt(output, 0.7), key);
  EXPECT_TRUE(isExact(read, bits));
  EXPECT_EQ(read.verdict, Verdict::match);
}

TEST(ExtractMesh, LosesConfidenceBeforeItLies) {
  const Mesh output = marked(lab::sculpture(3000), kKey, kBits);
  const Extraction clean = readMark(output, kKey), garbage = readMark(lab::noise(output, 1e-2, 4), kKey);
  const auto mean = [](const Extraction& e) {
    double sum = 0;
    for (float c : e.confidence) sum += c;
    return sum / static_cast<double>(e.confidence.size());
  };
  EXPECT_GT(mean(clean), 0.99);
  EXPECT_LT(mean(garbage), 0.6);
  EXPECT_EQ(garbage.verdict, Verdict::none);
  for (std::size_t i = 0; i < 64; ++i)
    EXPECT_TRUE(garbage.erased[i] == 0 || garbage.bits[i] == 0);
}

}  // namespace
}  // namespace quadmark
