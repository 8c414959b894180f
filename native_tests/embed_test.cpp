// SPDX-License-Identifier: MIT
#include "quadmark/embed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "fixtures.h"

namespace quadmark {
namespace {

using namespace test;

const Key kKey = testKey(8, 8);
const std::vector<std::uint8_t> kBits = logo(8, 8).bits;

double displacement(const Mesh& a, const Mesh& b, std::size_t v) {
  double sum = 0;
  for (std::size_t i = 3 * v; i < 3 * v + 3; ++i)
    sum += (a.positions[i] - b.positions[i]) * (a.positions[i] - b.positions[i]);
  return std::sqrt(sum);
}

// Large models: hundreds of copies outvote what a few accidental flat sets say, so the surface is left alone.
TEST(EmbedMesh, TiltsNothingWhereCopiesAbound) {
  const Mesh mesh = lab::sculpture(20000);
  MarkedMesh report;
  const Mesh output = marked(mesh, kKey, kBits, &report);
  ASSERT_GE(report.leastRepeats, 256u);
  EXPECT_EQ(report.repairs, 0u);
  EXPECT_TRUE(report.guarantees.all());
  std::size_t flat = 0;
  const WeldedMesh welded = weld(output);
  forEachCoplanarSet(welded, welded.positions, kKey.params.k, roundingOf(output.precision), {kExactUnits, 0}, {},
                     [&](const Quad&) { ++flat; });
  EXPECT_GT(flat, report.cells);  // there were some to break
  EXPECT_TRUE(isExact(readMark(output, kKey), kBits));
}

TEST(EmbedMesh, ReadsBackExactlyFromEveryKindOfMesh) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    SCOPED_TRACE(name);
    MarkedMesh report;
    const Mesh output = marked(mesh, kKey, kBits, &report);
    EXPECT_TRUE(report.guarantees.all());
    const Extraction read = readMark(output, kKey);
    EXPECT_TRUE(isExact(read, kBits));
    EXPECT_EQ(read.verdict, Verdict::match) << read.falsePositive;
    EXPECT_EQ(report.payloadBits, 64u);
    EXPECT_EQ(report.capacityBits, std::uint64_t{6} * report.cells);  // Eq. (6): 3 (H - L + 1) bits a cell
    EXPECT_DOUBLE_EQ(report.repeats, report.cells / 11.0);
    EXPECT_GE(report.leastRepeats, 1u);
    EXPECT_LE(report.leastRepeats, report.repeats);
  }
}

TEST(EmbedMesh, ReadsBackExactlyInDoublePrecision) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    SCOPED_TRACE(name);
    const Mesh output = marked(asFloat64(mesh), kKey, kBits);
    EXPECT_TRUE(readsExactly(output, kKey, kBits));
    EXPECT_TRUE(readsExactly(mapped(output, "CB"), kKey, kBits));
    EXPECT_TRUE(readsExactly(lab::reorder(output, 3), kKey, kBits));
  }
}

TEST(EmbedMesh, WritesValuesThatTheFileCanHold) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    SCOPED_TRACE(name);
    const Mesh output = marked(mesh, kKey, kBits);
    for (double x : output.positions) ASSERT_EQ(x, nearestFloat32(x));
    EXPECT_TRUE(validate(output).ok());
  }
}

TEST(EmbedMesh, IsDeterministic) {
  const Mesh mesh = lab::machinedPart(3000);
  EXPECT_EQ(embedMesh(mesh, kBits, kKey)->positions, embedMesh(mesh, kBits, kKey)->positions);
  EXPECT_NE(embedMesh(mesh, kBits, kKey)->positions, embedMesh(mesh, kBits, strangersKey(kKey, 1))->positions);
}

TEST(EmbedMesh, KeepsTwinsTogether) {
  const Mesh mesh = lab::seamed(4);
  const Mesh output = marked(mesh, kKey, kBits);
  const WeldedMesh before = weld(mesh), after = weld(output);
  EXPECT_EQ(after.vertexCount(), before.vertexCount());
  EXPECT_EQ(after.weldedOf, before.weldedOf);
  std::size_t movedTwins = 0;
  std::vector<std::uint32_t> seen(before.vertexCount(), kNoVertex);
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    std::uint32_t& first = seen[before.weldedOf[v]];
    if (first == kNoVertex) first = v;
    else movedTwins += displacement(mesh, output, v) > 0;
    EXPECT_EQ(displacement(mesh, output, v), displacement(mesh, output, first));
  }
  EXPECT_GT(movedTwins, 0u);  // the seam takes part
}

TEST(EmbedMesh, MovesSeamGroupsIndependently) {
  Mesh mesh = lab::twoComponents(2);
  mesh.groups.resize(mesh.vertexCount());
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) mesh.groups[v] = v < mesh.vertexCount() / 2 ? 0 : 1;
  EXPECT_TRUE(readsExactly(marked(mesh, kKey, kBits), kKey, kBits));
}

TEST(EmbedMesh, LeavesUnreferencedVerticesAlone) {
  Mesh mesh = lab::sculpture(3000);
  const std::size_t used = mesh.vertexCount();
  for (std::size_t v = 0; v < 300; ++v)  // some on top of used ones, some far away
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(v % 2 == 0 ? mesh.positions[3 * v + k] : -1e6);
  const Mesh output = marked(mesh, kKey, kBits);
  for (std::size_t v = used; v < mesh.vertexCount(); ++v) ASSERT_EQ(displacement(mesh, output, v), 0) << v;
  EXPECT_TRUE(readsExactly(output, kKey, kBits));
  // Far-away loose points do not change the scale either.
  Mesh bare = lab::sculpture(3000);
  const Mesh bareOutput = marked(bare, kKey, kBits);
  EXPECT_TRUE(std::equal(bareOutput.positions.begin(), bareOutput.positions.end(), output.positions.begin()));
}

TEST(EmbedMesh, MovesLittleBesidesTheVerticesOfItsCells) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    SCOPED_TRACE(name);
    MarkedMesh report;
    const Mesh output = marked(mesh, kKey, kBits, &report);
    const WeldedMesh welded = weld(mesh);
    const Searched found = searched(mesh, kKey.params);
    std::vector<std::uint8_t> inCell(welded.vertexCount(), 0);
    for (const Quad& q : found.cells)
      for (std::uint32_t v : {q.a, q.b, q.c, q.d}) inCell[v] = 1;
    std::set<std::uint32_t> others;
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
      if (inCell[welded.weldedOf[v]] == 0 && displacement(mesh, output, v) > 0) others.insert(welded.weldedOf[v]);
    // Only the breaking of unwanted flat sets lifts a vertex that belongs to no cell, one at a time.
    EXPECT_LE(others.size(), report.repairs);
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
      if (others.count(welded.weldedOf[v]) != 0) {
        EXPECT_LE(displacement(mesh, output, v), 2 * kKey.params.lambda * boundingDiagonal(mesh));
      }
  }
}

TEST(EmbedMesh, StaysWithinItsDisplacementLimits) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    SCOPED_TRACE(name);
    const Mesh output = marked(mesh, kKey, kBits);
    const WeldedMesh welded = weld(mesh);
    const double lambda = kKey.params.lambda * boundingDiagonal(mesh);
    double sum = 0;
    std::size_t moved = 0;
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
      const std::uint32_t w = welded.weldedOf[v];
      std::vector<std::uint32_t> ball;
      ASSERT_TRUE(neighbourhood(welded, w, 2, ball));  // a cell's vertices are at most two edges apart
      double reach = 0;
      for (std::uint32_t n : ball) {
        double d2 = 0;
        for (int k = 0; k < 3; ++k) {
          const double d = welded.positions[3 * std::size_t{n} + k] - welded.positions[3 * std::size_t{w} + k];
          d2 += d * d;
        }
        reach = std::max(reach, std::sqrt(d2));
      }
      const double d = displacement(mesh, output, v);
      // Flattening and tilting by lambda at most, and a ratio by some tenths (Eq. (4)) of a diagonal within reach.
      ASSERT_LE(d, 2 * lambda + 0.4 * reach) << "vertex " << v;
      if (d > 0) sum += d / reach, ++moved;
    }
    ASSERT_GT(moved, 0u);
    EXPECT_LT(sum / static_cast<double>(moved), 0.1);  // and a few hundredths on average
  }
}

TEST(EmbedMesh, NeverFailsSilentlyFarFromTheOrigin) {
  int embedded = 0, refused = 0;
  for (const auto& [name, original] : {NamedMesh{"polygonMix", lab::polygonMix(5)},
                                       {"bumpyGrid", lab::bumpyGrid(28, 28, 3)},
                                       {"nonManifold", lab::nonManifold()},
                                       {"machinedPart", lab::machinedPart(1000)},
                                       {"sculpture", lab::sculpture(1000)}})
    for (const double offset : {1e2, 1e3, 1e4, 1e6})
      for (const Precision precision : {Precision::float32, Precision::float64}) {
        SCOPED_TRACE(name + " at " + std::to_string(offset));
        Mesh mesh = original;
        mesh.precision = precision;
        const double shift = offset * boundingDiagonal(mesh);
        mesh = lab::affine(mesh, {1, 0, 0, shift, 0, 1, 0, -shift, 0, 0, 1, 0.5 * shift});
        const Result<MarkedMesh> result = embedMesh(mesh, kBits, kKey);
        if (!result) {
          ++refused;
          EXPECT_TRUE(result.error().code == ErrorCode::capacity || result.error().code == ErrorCode::badMesh);
          EXPECT_NE(result.error().message.find_first_of("0123456789"), std::string::npos) << result.error().message;
          continue;
        }
        ++embedded;
        const Mesh output = withPositions(mesh, result->positions);
        EXPECT_TRUE(readsExactly(output, kKey, kBits));
        EXPECT_TRUE(result->guarantees.unattacked);
        EXPECT_TRUE(result->guarantees.reordered);
        EXPECT_EQ(readMark(output, kKey).verdict, Verdict::match);
      }
  EXPECT_GT(embedded, 10);
  EXPECT_GT(refused, 0);  // float32 at 10^6 sizes has lost all shape
}

TEST(EmbedMesh, RefusesWhatDoesNotFitWithTheNumbers) {
  const Result<MarkedMesh> small = embedMesh(lab::cube(), kBits, kKey);
  ASSERT_FALSE(small.ok());
  EXPECT_EQ(small.error().code, ErrorCode::capacity);
  EXPECT_NE(small.error().message.find("64 bits needs 11 cells"), std::string::npos) << small.error().message;
  EXPECT_NE(small.error().message.find("8 vertices"), std::string::npos) << small.error().message;

  const Key large = testKey(90, 90);
  const Result<MarkedMesh> result = embedMesh(lab::sculpture(1500), logo(90, 90).bits, large);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::capacity);
  EXPECT_NE(result.error().message.find("8100"), std::string::npos) << result.error().message;
  EXPECT_NE(result.error().message.find("900"), std::string::npos) << result.error().message;
}

TEST(EmbedMesh, RefusesMeshesWithoutExtentAndPayloadsOfAnotherSize) {
  Mesh point;
  point.positions.assign(9, 2.5);
  point.faceVertices = {0, 1, 2};
  EXPECT_EQ(embedMesh(point, kBits, kKey).error().code, ErrorCode::badMesh);
  EXPECT_EQ(embedMesh(Mesh{}, kBits, kKey).error().code, ErrorCode::badMesh);
  const Result<MarkedMesh> wrongSize = embedMesh(lab::sculpture(1500), std::vector<std::uint8_t>(63), kKey);
  ASSERT_FALSE(wrongSize.ok());
  EXPECT_EQ(wrongSize.error().code, ErrorCode::badOption);
  EXPECT_NE(wrongSize.error().message.find("63"), std::string::npos) << wrongSize.error().message;
}

TEST(EmbedMesh, StopsAtAnyStageWhenToldTo) {
  const Mesh mesh = lab::sculpture(3000);
  std::vector<std::string> stages;
  double last = 0;
  ASSERT_TRUE(embedMesh(mesh, kBits, kKey, [&](const char* stage, double done) {
    EXPECT_GE(done, last);
    EXPECT_LE(done, 1);
    last = done;
    stages.push_back(stage);
    return true;
  }).ok());
  ASSERT_GE(stages.size(), 3u);
  for (std::size_t stop = 0; stop < stages.size(); ++stop) {
    std::size_t calls = 0;
    const Result<MarkedMesh> result = embedMesh(mesh, kBits, kKey, [&](const char*, double) { return calls++ < stop; });
    ASSERT_FALSE(result.ok()) << stages[stop];
    EXPECT_EQ(result.error().code, ErrorCode::aborted);
    EXPECT_EQ(calls, stop + 1);  // and asks no further
  }
}

TEST(EmbedMesh, MarksAMarkedMeshAgainForAnotherKey) {
  const Key second = strangersKey(kKey, 77);
  const std::vector<std::uint8_t> other(64, 1);
  const Mesh once = marked(lab::sculpture(3000), kKey, kBits);
  const Mesh twice = marked(once, second, other);
  EXPECT_TRUE(readsExactly(twice, second, other));
}

}  // namespace
}  // namespace quadmark
