// SPDX-License-Identifier: MIT
// Gao et al. 2010 against what its successor says of it (Gao, Zhang, Huang, Deng, ACM TOMM 8(2S), 2012, sections 2 and 3):
// invariant under similarity transforms and not under other affine maps, linearly tunable, of high capacity, without
// resistance to file attacks.
#include <gtest/gtest.h>

#include "peers_trial.h"
#include "quadmark/lab/generate.h"

namespace quadmark {
namespace {

using namespace test;

void expectWhatIsSaid(const Mesh& mesh) {
  const auto peer = bench::gaoSimilarity();
  const PeerTrial trial(*peer, mesh, {}, randomPayload(5, 16, 16));
  EXPECT_EQ(trial.errorRate(trial.marked), 0);
  EXPECT_EQ(trial.errorRate(lab::affine(trial.marked, similarityMap())), 0);
  EXPECT_EQ(trial.after({"affine", 0, "RE"}), 0);
  EXPECT_EQ(trial.after({"affine", 0, "R"}), 0);
  EXPECT_EQ(trial.after({"noise", 1e-5}), 0);
  EXPECT_GT(trial.after({"noise", 1e-2}), 0.35);
  for (std::uint64_t seed : {1, 2, 3}) EXPECT_NEAR(trial.after({"reorder", 0, "", 1, seed}), 0.5, 0.1);
  EXPECT_GT(trial.after({"crop", 0.5}), 0.35);
  EXPECT_GT(trial.after({"simplify", 0.3}), 0.3);
}

TEST(PeersGao, HoldsWhatItsSuccessorSays) {
  expectWhatIsSaid(lab::sculpture(20000));
  if (const auto bunny = realMesh("bunny.glb")) expectWhatIsSaid(*bunny);
}

TEST(PeersGao, LosesAFullPayloadToAffineMaps) {
  const Mesh mesh = lab::sculpture(20000);
  const auto peer = bench::gaoSimilarity();
  const PeerTrial trial(*peer, mesh, "strength=0.01", randomPayload(5, 64, 64));
  EXPECT_LT(trial.errorRate(trial.marked), 0.001);
  EXPECT_LT(trial.errorRate(lab::affine(trial.marked, similarityMap())), 0.001);
  for (const char* map : {"NS", "SH", "CB"}) EXPECT_GT(trial.after({"affine", 0, map}), 0.15) << map;
}

TEST(PeersGao, DistortionIsLinearInTheStrength) {
  const Mesh mesh = lab::sculpture(8000);
  const auto peer = bench::gaoSimilarity();
  const double unit = PeerTrial(*peer, mesh, "strength=0.005").rmsRel();
  EXPECT_NEAR(PeerTrial(*peer, mesh, "strength=0.01").rmsRel() / unit, 2, 0.1);
  EXPECT_NEAR(PeerTrial(*peer, mesh, "strength=0.02").rmsRel() / unit, 4, 0.3);
}

TEST(PeersGao, HasAboutOneBitForEveryTwoOrThreeVertices) {
  const Mesh mesh = lab::sculpture(8000);
  const auto peer = bench::gaoSimilarity();
  const PeerTrial trial(*peer, mesh);
  const double perBit = static_cast<double>(mesh.vertexCount()) / static_cast<double>(trial.mark.capacityBits);
  EXPECT_GT(perBit, 2);
  EXPECT_LT(perBit, 3);
  EXPECT_EQ(trial.errorRate(trial.marked), 0);
}

}  // namespace
}  // namespace quadmark
