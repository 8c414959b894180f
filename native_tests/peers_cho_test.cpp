// SPDX-License-Identifier: MIT
// Cho, Prost, Jung 2007 against published figures. Those of Wang et al. (A benchmark for 3D mesh watermarking, SMI 2010;
// Robust and blind mesh watermarking based on volume moments, Computers & Graphics 35, 2011) are means over LIRIS's Venus
// with 64 bits at rms 0.012 % of the diagonal: noise of 0.05 / 0.1 / 0.3 / 0.5 % of the mean distance to the centre gives
// bit error rates of 0 / .01 / .10 / .24, 11 / 10 / 9 / 8 bits per axis 0 / .02 / .06 / .18, 5 / 10 / 30 steps of smoothing
// .06 / .16 / .34; affine maps and cropping are fatal.
#include <gtest/gtest.h>

#include <cmath>

#include "peers_trial.h"
#include "quadmark/adjacency.h"
#include "quadmark/lab/generate.h"
#include "quadmark/vec3.h"

namespace quadmark {
namespace {

using namespace test;

// The unit of LIRIS's noise, as a fraction of the diagonal.
double meanDistanceRel(const Mesh& mesh) {
  const WeldedMesh welded = weld(mesh);
  Vec3 centre;
  for (std::uint32_t v = 0; v < welded.vertexCount(); ++v) centre += at(welded.positions, v);
  centre = (1.0 / welded.vertexCount()) * centre;
  double sum = 0;
  for (std::uint32_t v = 0; v < welded.vertexCount(); ++v) sum += length(at(welded.positions, v) - centre);
  return sum / welded.vertexCount() / boundingDiagonal(mesh);
}

void expectPublishedFigures(const bench::Peer& peer, const Mesh& mesh, const std::string& settings) {
  const PeerTrial trial(peer, mesh, settings);
  const double tolerance = 0.05;  // three bits of 64
  EXPECT_NEAR(100 * trial.rmsRel(), 0.012, 0.003);
  EXPECT_EQ(trial.errorRate(trial.marked), 0);
  EXPECT_EQ(trial.errorRate(lab::affine(trial.marked, similarityMap())), 0);
  EXPECT_EQ(trial.after({"reorder"}), 0);
  const double unit = meanDistanceRel(mesh);
  for (const auto& [percent, published] : {std::pair{0.05, 0.0}, {0.1, 0.01}, {0.3, 0.10}, {0.5, 0.24}})
    EXPECT_LE(trial.after({"noise", percent / 100 * unit}), published + tolerance) << percent;
  for (const auto& [bits, published] : {std::pair{11, 0.0}, {10, 0.02}, {9, 0.06}, {8, 0.18}})
    EXPECT_LE(trial.after({"quantize", static_cast<double>(bits), "per-axis"}), published + tolerance) << bits;
  for (const auto& [steps, published] : {std::pair{5, 0.06}, {10, 0.16}, {30, 0.34}})
    EXPECT_LE(trial.after({"smooth", 0.03, "laplacian", steps}), published + tolerance) << steps;
  for (const char* map : {"NS", "SH", "CB"}) EXPECT_GT(trial.after({"affine", 0, map}), 0.25) << map;
  for (const double share : {0.1, 0.3, 0.5}) EXPECT_GT(trial.after({"crop", share}), 0.25) << share;
  // The mark is not for free: it dies where the published one does.
  EXPECT_GT(trial.after({"noise", 0.02 * unit}), 0.1);
}

TEST(PeersCho, MeanAgreesWithPublishedFigures) {
  expectPublishedFigures(*bench::choMean(), lab::sculpture(20000), "strength=0.02");
  if (const auto bunny = realMesh("bunny.glb")) expectPublishedFigures(*bench::choMean(), *bunny, "strength=0.02");
}

TEST(PeersCho, VarianceAgreesWithPublishedFigures) {
  expectPublishedFigures(*bench::choVariance(), lab::sculpture(20000), "strength=0.04");
  if (const auto bunny = realMesh("bunny.glb")) expectPublishedFigures(*bench::choVariance(), *bunny, "strength=0.04");
}

TEST(PeersCho, StrengthBuysRobustness) {
  const Mesh mesh = lab::sculpture(20000);
  for (const auto& peer : {bench::choMean(), bench::choVariance()}) {
    const PeerTrial weak(*peer, mesh, "strength=0.02"), strong(*peer, mesh, "strength=0.12");
    EXPECT_LT(weak.rmsRel(), strong.rmsRel() / 2);
    EXPECT_GT(weak.after({"noise", 0.003}), strong.after({"noise", 0.003}));
  }
}

// The bins move with the centre of a mark that is written once; papers after it name this the causality problem.
TEST(PeersCho, MarksOfManyKeysAreReadWithoutError) {
  const Mesh mesh = lab::sculpture(5000);
  const auto peer = bench::choMean();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PeerTrial trial(*peer, mesh, {}, randomPayload(seed));
    EXPECT_EQ(trial.errorRate(trial.marked), 0) << seed;
  }
}

}  // namespace
}  // namespace quadmark
