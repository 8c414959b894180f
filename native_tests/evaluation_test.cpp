// SPDX-License-Identifier: MIT
// What the evaluation measures with: attacks by their spelling, payloads as schemes get them, readings as they are judged.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "../bench/attack_chain.h"
#include "../bench/evaluation/trial.h"
#include "quadmark/adjacency.h"
#include "quadmark/lab/generate.h"
#include "quadmark/verdict.h"

namespace quadmark::bench {
namespace {

Mesh attacked(const Mesh& mesh, const std::string& attacks, std::uint64_t seed = 1) {
  const auto chain = parseAttacks(attacks);
  EXPECT_TRUE(chain) << attacks;
  auto damaged = apply(*chain, mesh, seed);
  EXPECT_TRUE(damaged) << damaged.error().message;
  return std::move(*damaged);
}

TEST(EvaluationAttacks, AreReadFromTheirSpelling) {
  const auto chain = parseAttacks("affine::CB+smooth:0.03:laplacian:10+reorder+quantize:14:per-axis");
  ASSERT_TRUE(chain);
  ASSERT_EQ(chain->steps.size(), 4u);
  EXPECT_EQ(chain->steps[0].kind, "affine");
  EXPECT_EQ(chain->steps[0].variant, "CB");
  EXPECT_EQ(chain->steps[1].amount, 0.03);
  EXPECT_EQ(chain->steps[1].variant, "laplacian");
  EXPECT_EQ(chain->steps[1].iterations, 10);
  EXPECT_EQ(chain->steps[2].kind, "reorder");
  EXPECT_EQ(chain->steps[3].amount, 14);
  EXPECT_TRUE(parseAttacks("none")->steps.empty());
}

TEST(EvaluationAttacks, RefuseWhatIsNoAttack) {
  for (const char* text : {"", ":1", "noise:x", "noise:1e", "noise:nan", "crop:0.5:y:", "crop:0.5:y:1:2", "noise:1++reorder"})
    EXPECT_FALSE(parseAttacks(text)) << text;
  for (const char* text : {"unheard:1", "digits:0", "digits:2.5", "subdivide:4", "none+reorder"}) {
    const auto refused = apply(*parseAttacks(text), lab::cube(), 1);
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().code, ErrorCode::badOption) << text;
  }
}

TEST(EvaluationAttacks, LirisNoiseIsRelativeToTheMeanDistanceFromTheCentre) {
  Mesh sphere = lab::icosphere(4);  // all distances are its radius, whose diagonal is 2 sqrt(3) times as long
  for (std::size_t i = 0; i < sphere.positions.size(); i += 3) sphere.positions[i] += 4;
  roundToPrecision(sphere);
  const double radius = boundingDiagonal(sphere) / (2 * std::sqrt(3.0)), amplitude = 0.01;
  const Mesh noisy = attacked(sphere, "liris-noise:0.01");
  double most = 0;
  for (std::size_t i = 0; i < sphere.positions.size(); ++i)
    most = std::max(most, std::fabs(noisy.positions[i] - sphere.positions[i]));
  EXPECT_LE(most, 1.001 * amplitude * radius);
  EXPECT_GE(most, 0.98 * amplitude * radius);
}

TEST(EvaluationAttacks, TextKeepsAsManyDigitsAsAsked) {
  Mesh mesh = lab::bumpyGrid(9, 9, 3);
  mesh.precision = Precision::float64;
  for (double& x : mesh.positions) x = x / 3 + 1e-9;
  const Mesh text = attacked(mesh, "digits:3");
  EXPECT_NE(text.positions, mesh.positions);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    EXPECT_NEAR(text.positions[i], mesh.positions[i], 0.0051 * std::fabs(mesh.positions[i]));
  EXPECT_EQ(attacked(mesh, "digits:17").positions, mesh.positions);
}

TEST(EvaluationAttacks, SubdivisionSplitsEveryFaceAndKeepsSeamsClosed) {
  for (const Mesh& mesh : {lab::cube(), lab::quadSphere(3), lab::polygonMix(2), lab::seamed(1), lab::nonManifold()}) {
    const WeldedMesh before = weld(mesh);
    std::size_t corners = mesh.faceVertices.size(), triangles = 0, edges = 0;
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) triangles += mesh.faceEnd(f) - mesh.faceBegin(f) == 3 ? 1 : 0;
    for (std::uint32_t v = 0; v < before.vertexCount(); ++v) edges += before.neighboursOf(v).size();
    const Mesh fine = attacked(mesh, "subdivide:1");
    ASSERT_TRUE(validate(fine));
    EXPECT_EQ(fine.faceCount(), corners + triangles);
    EXPECT_EQ(weld(fine).vertexCount(), before.vertexCount() + edges / 2 + mesh.faceCount() - triangles);
    EXPECT_TRUE(std::equal(mesh.positions.begin(), mesh.positions.end(), fine.positions.begin()));
    EXPECT_EQ(attacked(mesh, "subdivide:2").positions, attacked(fine, "subdivide:1").positions);
  }
}

TEST(EvaluationAttacks, AreDecidedBySeedAndNumberOfTheOrder) {
  const Mesh mesh = lab::sculpture(600);
  EXPECT_EQ(attacked(mesh, "reorder:1").faceVertices, attacked(mesh, "reorder:1").faceVertices);
  EXPECT_NE(attacked(mesh, "reorder:1").faceVertices, attacked(mesh, "reorder:2").faceVertices);
  EXPECT_NE(attacked(mesh, "noise:0.01", 1).positions, attacked(mesh, "noise:0.01", 2).positions);
  EXPECT_NE(attacked(mesh, "noise:0.01+noise:0.01").positions, attacked(mesh, "noise:0.01").positions);
}

// Says what it is told to, whatever the mesh.
class Parrot : public Scheme {
 public:
  std::string name() const override { return "parrot"; }
  std::string usualSettings() const override { return "-"; }
  Result<TrialMark> mark(const Mesh& mesh, const TrialPayload& payload, std::uint64_t, const std::string&) const override {
    heard = payload.bits;
    return TrialMark{mesh.positions, 0, 1};
  }
  TrialReading read(const Mesh&, const TrialPayload&, std::uint64_t, const std::string&) const override { return says; }
  mutable Bits heard;
  TrialReading says;
};

class EvaluationTrial : public testing::Test {
 protected:
  EvaluationTrial() : trial(makeTrial("robust", "", "image:16", 3).value()) {
    trial.scheme = &parrot;
    EXPECT_TRUE(markTrial(trial, mesh));
    parrot.says.bits = parrot.heard;
  }
  void flip(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) parrot.says.bits[i] ^= 1;
  }
  Mesh mesh = lab::cube();
  Parrot parrot;
  Trial trial;
};

TEST_F(EvaluationTrial, WhitensWhatTheSchemeGets) {
  const auto ones = [](const Bits& bits) { return std::count(bits.begin(), bits.end(), 1); };
  EXPECT_LT(ones(trial.payload.bits), 96);  // of 256: the emblem is mostly white
  EXPECT_GT(ones(parrot.heard), 96);
  EXPECT_LT(ones(parrot.heard), 160);
  EXPECT_NE(makeTrial("robust", "", "image:16", 4)->whitened.bits, parrot.heard);
  EXPECT_EQ(readTrial(trial, mesh).bits, trial.payload.bits);
}

TEST_F(EvaluationTrial, TakesTheBinomialTailWhereASchemeClaimsNothing) {
  flip(20);
  const Judgement some = readTrial(trial, mesh);
  EXPECT_EQ(some.outcome, "match");
  EXPECT_EQ(some.bitErrorRate, 20 / 256.0);
  EXPECT_EQ(some.claim, referenceProbability(256, 236));
  flip(120);
  EXPECT_EQ(readTrial(trial, mesh).outcome, "lost");
  parrot.says.claim = 1e-7;
  EXPECT_EQ(readTrial(trial, mesh).outcome, "match");
}

TEST_F(EvaluationTrial, CountsAnUnreadBitAsHalfAWrongOne) {
  parrot.says.unread = Bits(256, 0);
  std::fill_n(parrot.says.unread.begin(), 64, 1);
  const Judgement some = readTrial(trial, mesh);
  EXPECT_EQ(some.outcome, "match");
  EXPECT_EQ(some.bitErrorRate, 0.125);
  EXPECT_EQ(some.unread, 0.25);
  EXPECT_EQ(some.claim, referenceProbability(192, 192));
  EXPECT_TRUE(std::all_of(some.bits.begin(), some.bits.begin() + 64, [](std::uint8_t bit) { return bit == 0; }));
}

TEST_F(EvaluationTrial, IsExactOnlyWhereThatIsKnown) {
  EXPECT_EQ(readTrial(trial, mesh).outcome, "exact");
  parrot.says.claim = 1e-3;
  EXPECT_EQ(readTrial(trial, mesh).outcome, "lost");  // by luck
  parrot.says.certain = true;
  EXPECT_EQ(readTrial(trial, mesh).outcome, "exact");
  flip(1);
  EXPECT_EQ(readTrial(trial, mesh).outcome, "wrong");
  parrot.says.bits.clear();
  EXPECT_EQ(readTrial(trial, mesh).outcome, "wrong");
  parrot.says.certain = false;
  const Judgement nothing = readTrial(trial, mesh);
  EXPECT_EQ(nothing.outcome, "lost");
  EXPECT_EQ(nothing.bitErrorRate, 0.5);
}

TEST(EvaluationSchemes, OfTheProductReadTheirMarksAndNoOthers) {
  const Mesh model = lab::sculpture(8000);
  for (const auto& [scheme, payload] : {std::pair{"robust", "id"}, {"robust", "image:12"}, {"paper", "image:16"}, {"paper", "id"}}) {
    SCOPED_TRACE(std::string(scheme) + " " + payload);
    const auto trial = makeTrial(scheme, "", payload, 1), other = makeTrial(scheme, "", payload, 2);
    const auto marked = markTrial(*trial, model);
    ASSERT_TRUE(marked) << marked.error().message;
    EXPECT_EQ(readTrial(*trial, marked->mesh).outcome, "exact");
    EXPECT_EQ(readTrial(*other, marked->mesh).outcome, "lost");
    EXPECT_EQ(readTrial(*trial, model).outcome, "lost");
  }
}

}  // namespace
}  // namespace quadmark::bench
