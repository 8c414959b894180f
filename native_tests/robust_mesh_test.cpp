// SPDX-License-Identifier: MIT
// Coded bits into a mesh and back: what each layer survives, what the embedder must not do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures.h"
#include "quadmark/metrics.h"
#include "quadmark/random.h"
#include "quadmark/robust/demapper.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/robust/reader.h"
#include "robust/distortion_budget.h"
#include "robust/presets.h"
#include "robust/surface.h"
#include "robust_geometry_keys.h"

namespace quadmark::robust {
namespace {

CodedPayload payloadOf(std::uint64_t seed, int bodyBits = 0) {
  CodedPayload out;
  Random random(seed);
  for (int i = 0; i < 276; ++i) {
    out.head.push_back(static_cast<std::uint8_t>(random.next() & 1));
    out.headGenerator.push_back(static_cast<std::uint8_t>(i % 3));
  }
  for (int i = 0; i < bodyBits; ++i) {
    out.body.push_back(static_cast<std::uint8_t>(random.next() & 1));
    out.bodyGenerator.push_back(static_cast<std::uint8_t>(i % 2));
  }
  return out;
}

Mesh marked(const Mesh& mesh, const CodedPayload& payload, const EmbedOptions& options = {}) {
  Mesh out = mesh;
  out.positions = embedRobust(mesh, payload, keysOf(1), options).value().positions;
  return out;
}

// Share of coded bits that a set of ratios gets wrong; unknown ones count half.
double errorRate(const std::vector<float>& ratios, const std::vector<std::uint8_t>& bits) {
  double wrong = 0;
  for (std::size_t i = 0; i < bits.size(); ++i) wrong += ratios[i] == 0 ? 0.5 : (ratios[i] < 0) != (bits[i] != 0);
  return wrong / static_cast<double>(bits.size());
}

// The least error rate of the head over all hypotheses of some layers.
double bestErrorRate(const Mesh& mesh, const CodedPayload& payload, Layers layers, const RobustKeys& keys = keysOf(1),
                     double sharpening = 0) {
  MeshReader reader(mesh, keys, payload.headCode());
  double best = 1;
  for (const Hypothesis& h : MeshReader::hypotheses({.trySplit = payload.hasBody()}))
    if (h.layers == layers && h.sharpening == sharpening && !h.mirrored &&
        h.sharing == (payload.hasBody() ? Sharing::split : Sharing::headOnly))
      best = std::min(best, errorRate(Demapper(reader.headBits(h)).ratios(), payload.head));
  return best;
}

TEST(RobustMesh, BothLayersReadBack) {
  const CodedPayload payload = payloadOf(1);
  for (const Mesh& mesh : {lab::sculpture(8000), lab::machinedPart(8000)}) {
    const Mesh copy = marked(mesh, payload, {.strength = Strength::strong});
    EXPECT_LT(bestErrorRate(copy, payload, Layers::ring), 0.08);
    EXPECT_LT(bestErrorRate(copy, payload, Layers::diamonds), 0.08);
    EXPECT_NEAR(bestErrorRate(copy, payload, Layers::ring, keysOf(2)), 0.5, 0.12) << "another key reads noise";
    EXPECT_NEAR(bestErrorRate(mesh, payload, Layers::ring), 0.5, 0.12) << "an unmarked model reads noise";
  }
}

TEST(RobustMesh, RingsSurviveNoiseQuantizationAndAffineMaps) {
  const CodedPayload payload = payloadOf(2);
  const Mesh copy = marked(lab::sculpture(8000), payload);
  EXPECT_LT(bestErrorRate(lab::noise(copy, 3e-4, 1), payload, Layers::ring), 0.1);
  EXPECT_LT(bestErrorRate(lab::quantize(copy, 11, lab::Grid::common), payload, Layers::ring), 0.1);
  EXPECT_LT(bestErrorRate(lab::affine(lab::reorder(copy, 3), *lab::paperAffine("CB")), payload, Layers::ring), 0.1);
}

// Icosphere and quad sphere repeat each name 60 and 24 times, so names are few: too few for one bit per coordinate.
TEST(RobustMesh, RingsOfSymmetricSurfacesSurviveNoiseAndSmoothing) {
  const CodedPayload payload = payloadOf(12);
  for (const Mesh& mesh : {lab::icosphere(5), lab::quadSphere(5)}) {
    const Mesh copy = marked(mesh, payload);
    EXPECT_LT(bestErrorRate(lab::noise(copy, 1e-3, 1), payload, Layers::ring), 0.28);
    EXPECT_LT(bestErrorRate(lab::quantize(copy, 10, lab::Grid::common), payload, Layers::ring), 0.28);
    EXPECT_LT(bestErrorRate(lab::smoothLaplacian(copy, 0.03, 10), payload, Layers::ring, keysOf(1), 0.3), 0.28);
  }
}

TEST(RobustMesh, RoughSurfacesHaveRoomForBothLayers) {
  const Mesh rough = lab::smoothLaplacian(lab::bumpyGrid(120, 120, 3), 0.03, 10);
  const RobustEmbedding out = embedRobust(rough, payloadOf(13), keysOf(1)).value();
  EXPECT_GT(out.carriers, out.selected / 3);
  EXPECT_GT(out.cells, 5 * out.goodCells);
}

TEST(RobustMesh, DiamondsSurviveSimplification) {
  const CodedPayload payload = payloadOf(3);
  const Mesh copy = marked(lab::sculpture(12000), payload, {.strength = Strength::strong});
  EXPECT_LT(bestErrorRate(lab::simplifyMeshopt(copy, 0.7), payload, Layers::diamonds), 0.12);
  const Mesh both = lab::quantize(lab::simplifyMeshopt(copy, 0.9), 14, lab::Grid::common);
  EXPECT_LT(bestErrorRate(both, payload, Layers::diamonds), 0.15);
}

// All that a simplifier with an error limit leaves of a part and a dense sphere are creases and what is raised.
TEST(RobustMesh, RaisedCellsSurviveWhatLeavesLittle) {
  const CodedPayload payload = payloadOf(14);
  const auto optimized = [](const Mesh& mesh) {
    return lab::quantize(lab::simplifyMeshopt(mesh, 0, nullptr, 1e-4), 14, lab::Grid::common);
  };
  for (const Mesh& mesh : {lab::machinedPart(12000, 2), lab::icosphere(6)}) {
    const Mesh copy = marked(mesh, payload, {.strength = Strength::strong});
    EXPECT_LT(bestErrorRate(optimized(copy), payload, Layers::diamonds), 0.2);
    EXPECT_GT(bestErrorRate(optimized(mesh), payload, Layers::diamonds), 0.35) << "unmarked";
  }
  EXPECT_LT(bestErrorRate(optimized(marked(lab::icosphere(6), payload)), payload, Layers::diamonds), 0.25) << "standard";
}

TEST(RobustMesh, ABodyIsReadBesideItsHead) {
  const CodedPayload payload = payloadOf(4, 400);
  const Mesh copy = marked(lab::sculpture(16000), payload, {.strength = Strength::strong});
  EXPECT_LT(bestErrorRate(copy, payload, Layers::ring), 0.12);
  MeshReader reader(copy, keysOf(1), payload.headCode());
  const Hypothesis ring{Layers::ring, Sharing::split, 0, 1e-4, 0, 0, 1};
  EXPECT_LT(errorRate(Demapper(reader.bodyBits(ring, payload.bodyCode())).ratios(), payload.body), 0.12);
  // Without the body's length nothing of it is claimed.
  EXPECT_TRUE(reader.bodyBits(ring, {}).single.empty());
}

// Baking a node of negative scale into its mesh mirrors it and turns its faces over, so that they look outward again.
TEST(RobustMesh, MirroredCopiesAreReadWhateverBecameOfTheirWinding) {
  const CodedPayload payload = payloadOf(7);
  Mesh mirrored = marked(lab::sculpture(8000), payload);
  for (std::size_t i = 0; i < mirrored.positions.size(); i += 3) mirrored.positions[i] *= -1;
  EXPECT_LT(bestErrorRate(mirrored, payload, Layers::ring), 0.1);
  EXPECT_LT(bestErrorRate(mirrored, payload, Layers::diamonds), 0.1);
  for (std::size_t f = 0; f < mirrored.faceCount(); ++f)
    std::reverse(mirrored.faceVertices.begin() + mirrored.faceBegin(f), mirrored.faceVertices.begin() + mirrored.faceEnd(f));
  EXPECT_GT(bestErrorRate(mirrored, payload, Layers::ring), 0.4);
  EXPECT_GT(bestErrorRate(mirrored, payload, Layers::diamonds), 0.4);
  MeshReader reader(mirrored, keysOf(1), payload.headCode());
  double best[2] = {1, 1};
  int tried = 0;
  for (const Hypothesis& h : MeshReader::hypotheses({.trySplit = false})) {
    if (!h.mirrored) continue;
    double& least = best[h.layers == Layers::diamonds];
    least = std::min(least, errorRate(Demapper(reader.headBits(h)).ratios(), payload.head));
    ++tried;
  }
  EXPECT_EQ(tried, 8);
  EXPECT_LT(best[0], 0.1);
  EXPECT_LT(best[1], 0.1);
  // Turning back gives what was there before.
  const Hypothesis ring{Layers::ring, Sharing::headOnly, 0, 1e-4};
  MeshReader fresh(mirrored, keysOf(1), payload.headCode());
  EXPECT_EQ(reader.headBits(ring).single, fresh.headBits(ring).single);
}

TEST(RobustMesh, QuadsAreReadAsQuadsAndCut) {
  const Mesh quads = lab::noise(lab::quadSphere(5), 2e-3, 1);
  const CodedPayload payload = payloadOf(5);
  const Mesh copy = marked(quads, payload);
  EXPECT_LT(bestErrorRate(copy, payload, Layers::diamonds), 0.1);
  Mesh cut = copy;
  cut.faceOffsets.clear();
  cut.faceVertices.clear();
  for (std::size_t f = 0; f < copy.faceCount(); ++f)
    for (const int corner : {0, 1, 2, 0, 2, 3})
      cut.faceVertices.push_back(copy.faceVertices[copy.faceBegin(f) + corner]);
  EXPECT_LT(bestErrorRate(cut, payload, Layers::diamonds), 0.1);
  // Faces that begin elsewhere are cut the other way as often as not: half of the cells are left.
  EXPECT_LT(bestErrorRate(lab::reorder(copy, 2), payload, Layers::diamonds), 0.3);
}

TEST(RobustMesh, SearchStopsWhereTheCallerAcceptsAndCountsWhatItTried) {
  const CodedPayload payload = payloadOf(6);
  const Mesh copy = marked(lab::sculpture(4000), payload);
  MeshReader reader(copy, keysOf(1), payload.headCode());
  std::uint32_t calls = 0;
  EXPECT_TRUE(reader.search({}, [&](const SoftBits& head, const Hypothesis& h) {
    EXPECT_EQ(head.single.size(), 276u);
    EXPECT_EQ(h.number, ++calls);
    return calls == 12;
  }));
  EXPECT_EQ(calls, 12u);
  calls = 0;
  MeshReader again(copy, keysOf(1), payload.headCode());
  EXPECT_FALSE(again.search({}, [&](const SoftBits&, const Hypothesis&) { return ++calls == 0; }));
  EXPECT_EQ(calls, MeshReader::hypotheses({}).size());
}

TEST(RobustMesh, VotesAgreeWithThePayloadAndWithNoOther) {
  const CodedPayload payload = payloadOf(7), other = payloadOf(8);
  const Mesh copy = marked(lab::sculpture(8000), payload, {.strength = Strength::strong});
  MeshReader reader(copy, keysOf(1), payload.headCode());
  const Agreement ring = reader.ringAgreement(payload), wrong = reader.ringAgreement(other);
  EXPECT_GT(ring.votes, 500u);
  EXPECT_GT(ring.agreeing, 0.65 * ring.votes) << "the votes of carriers that the embedder had to leave are chance";
  EXPECT_NEAR(static_cast<double>(wrong.agreeing) / wrong.votes, 0.5, 0.1);
  std::uint32_t best = 0;
  for (const Hypothesis& h : MeshReader::hypotheses({.trySplit = false}))
    if (h.layers == Layers::diamonds) best = std::max(best, reader.diamondAgreement(payload, h).agreeing);
  EXPECT_GT(best, 200u);
}

TEST(RobustMesh, EvidenceIsWhereTheMarkIs) {
  const CodedPayload payload = payloadOf(9);
  const Mesh mesh = lab::sculpture(6000);
  const Mesh copy = marked(mesh, payload);
  MeshReader reader(copy, keysOf(1), payload.headCode());
  const Hypothesis both{Layers::both, Sharing::headOnly, 0, 1e-4, 1e-5, 0, 1};
  const std::vector<float> evidence = reader.evidence(payload, both);
  ASSERT_EQ(evidence.size(), copy.vertexCount());
  double moved = 0, still = 0, movedCount = 0, stillCount = 0;
  for (std::size_t v = 0; v < evidence.size(); ++v) {
    EXPECT_LE(std::fabs(evidence[v]), 1.0f);
    const bool same = std::equal(&copy.positions[3 * v], &copy.positions[3 * v] + 3, &mesh.positions[3 * v]);
    (same ? still : moved) += evidence[v];
    (same ? stillCount : movedCount) += 1;
  }
  EXPECT_GT(moved / movedCount, 0.7);
  EXPECT_LT(std::fabs(still / stillCount), 0.2);
}

TEST(RobustMesh, TwinsStayTogetherAndNumbersStayFloat32) {
  for (const Mesh& mesh : {lab::seamed(1), lab::polygonMix(1), lab::nonManifold(), lab::twoComponents(1)}) {
    const RobustEmbedding out = embedRobust(mesh, payloadOf(1), keysOf(1)).value();
    ASSERT_EQ(out.positions.size(), mesh.positions.size());
    const WeldedMesh before = weld(mesh);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(out.positions[3 * v + k], nearestFloat32(out.positions[3 * v + k]));
        std::size_t first = 0;
        while (before.weldedOf[first] != before.weldedOf[v]) ++first;
        if (before.weldedOf[v] != kNoVertex) {
          EXPECT_EQ(out.positions[3 * v + k], out.positions[3 * first + k]);
        }
      }
  }
}

TEST(RobustMesh, CapsDisplacement) {
  const Mesh mesh = lab::sculpture(5000);
  const double diagonal = boundingDiagonal(mesh);
  const RobustEmbedding free = embedRobust(mesh, payloadOf(1), keysOf(1)).value();
  const RobustEmbedding capped = embedRobust(mesh, payloadOf(1), keysOf(1), {.maxErrorRel = 5e-4}).value();
  const float most = *std::max_element(capped.displacement.begin(), capped.displacement.end());
  EXPECT_LE(most, 5e-4 * diagonal * (1 + 1e-6));
  EXPECT_GT(*std::max_element(free.displacement.begin(), free.displacement.end()), most);
  EXPECT_LT(capped.cells + capped.carriers, free.cells + free.carriers);
  EXPECT_GT(capped.carriers, 0u);
  const RobustEmbedding still = embedRobust(mesh, payloadOf(1), keysOf(1), {.maxSlideRel = 5e-4}).value();
  EXPECT_LE(still.largestSlide, (5e-4 + 1e-5) * diagonal) << "but for the jitter that conceals cells";
  EXPECT_GT(free.largestSlide, 2 * still.largestSlide);
  EXPECT_GT(still.carriers, 0u);
}

// Mean turn of vertex normals as reports measure it; distance of the surfaces at their vertices. Parts have room left, which
// raised cells use up.
TEST(RobustMesh, KeepsWithinTheBudgetOfItsStrength) {
  for (const Mesh& mesh : {lab::sculpture(7000), lab::bumpyGrid(80, 80, 1), lab::quadSphere(5), lab::machinedPart(5000),
                           lab::machinedPart(8000)}) {
    const double allowed[] = {0.25, 0.5};
    for (const Strength strength : {Strength::invisible, Strength::standard}) {
      const Mesh after = marked(mesh, payloadOf(1), {.strength = strength});
      const Distortion d = distortion(mesh, after);
      EXPECT_LE(d.meanNormalDeg, allowed[static_cast<int>(strength)]) << mesh.vertexCount();
      EXPECT_GT(d.meanNormalDeg, 0) << mesh.vertexCount();
      const Surface before = makeSurface(mesh);
      const FacesAround facesAround(before);
      ChangeMeter change(before, facesAround);
      change.measure(makeSurface(after).welded.positions);
      const double rms = std::sqrt(change.squares() / before.vertexCount());
      EXPECT_LE(rms, limitsOf(presetOf(strength), before.vertexCount(), boundingDiagonal(mesh)).surfaceRms);
      EXPECT_GT(rms, 0);
    }
  }
}

TEST(RobustMesh, RefusesWhatCannotBeMarked) {
  const Mesh mesh = lab::cube();
  EXPECT_EQ(embedRobust(mesh, {}, keysOf(1)).error().code, ErrorCode::badOption);
  EXPECT_EQ(embedRobust(mesh, payloadOf(1), keysOf(1), {.maxErrorRel = -1}).error().code, ErrorCode::badOption);
  Mesh point;
  point.positions = {1, 1, 1};
  point.faceVertices = {0, 0, 0};
  EXPECT_EQ(embedRobust(point, payloadOf(1), keysOf(1)).error().code, ErrorCode::badMesh);
  const auto cancelled = embedRobust(lab::sculpture(1000), payloadOf(1), keysOf(1),
                                     {.progress = [](const char*, double) { return false; }});
  EXPECT_EQ(cancelled.error().code, ErrorCode::aborted);
  // Too little to carry anything is no error: the counts say so.
  EXPECT_LT(embedRobust(mesh, payloadOf(1), keysOf(1)).value().cells, 3u);
}

TEST(RobustMesh, EmbeddingIsTheSameEveryTime) {
  const Mesh mesh = lab::sculpture(3000);
  EXPECT_EQ(marked(mesh, payloadOf(1)).positions, marked(mesh, payloadOf(1)).positions);
}

}  // namespace
}  // namespace quadmark::robust
