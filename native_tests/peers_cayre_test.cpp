// SPDX-License-Identifier: MIT
// Cayre et al. 2003 against what surveys say of spectral marks (Wang, Lavoue, Denis, Baskurt, IEEE Transactions on Multimedia
// 10(8), 2008): spread over low and middle frequencies they withstand noise, smoothing, quantization and similarity transforms
// well; they need the connectivity, so that simplification is fatal.
#include <gtest/gtest.h>

#include "../bench/peers/principal_frame.h"
#include "peers_trial.h"
#include "quadmark/lab/generate.h"

namespace quadmark {
namespace {

using namespace test;

void expectWhatSurveysSay(const Mesh& mesh) {
  const auto peer = bench::cayreSpectral();
  const PeerTrial trial(*peer, mesh);
  EXPECT_LT(trial.rmsRel(), 1e-3);
  EXPECT_EQ(trial.errorRate(trial.marked), 0);
  EXPECT_EQ(trial.errorRate(lab::affine(trial.marked, similarityMap())), 0);
  EXPECT_EQ(trial.after({"affine", 0, "RE"}), 0);
  EXPECT_EQ(trial.after({"noise", 2e-4}), 0);
  EXPECT_EQ(trial.after({"quantize", 11, "per-axis"}), 0);
  EXPECT_EQ(trial.after({"smooth", 0.03, "laplacian", 10}), 0);
  EXPECT_GT(trial.after({"noise", 0.02}), 0.3);
  EXPECT_GT(trial.after({"simplify", 0.3}), 0.3);
}

TEST(PeersCayre, HoldsWhatSurveysSay) {
  expectWhatSurveysSay(lab::sculpture(5000));
  if (const auto part = realMesh("fandisk.glb")) expectWhatSurveysSay(*part);
}

TEST(PeersCayre, TheBandBuysRobustness) {
  const Mesh mesh = lab::sculpture(3000);
  const auto peer = bench::cayreSpectral();
  const PeerTrial high(*peer, mesh, "strength=0.1"), all(*peer, mesh, "strength=0.9");
  EXPECT_LT(2 * high.rmsRel(), all.rmsRel());
  EXPECT_GT(high.after({"noise", 0.003}), all.after({"noise", 0.003}));
}

TEST(PeersCayre, AxesFollowTheModel) {
  const Mesh mesh = lab::sculpture(3000), turned = lab::affine(mesh, similarityMap());
  const Eigen::Matrix3d before = bench::principalAxes(mesh.positions), after = bench::principalAxes(turned.positions);
  EXPECT_TRUE((before * before.transpose()).isIdentity(1e-9));
  const lab::Affine map = similarityMap();
  for (int axis = 0; axis < 3; ++axis) {
    for (int row = 0; row < 3; ++row) {
      double expected = 0;
      for (int i = 0; i < 3; ++i) expected += map[static_cast<std::size_t>(4 * row + i)] * before(axis, i) / 1.7;
      EXPECT_NEAR(after(axis, row), expected, 1e-4);
    }
  }
}

}  // namespace
}  // namespace quadmark
