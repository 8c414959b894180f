// SPDX-License-Identifier: MIT
// The two peers that count vertices in file order: QIM of coordinates and least significant bits with an HMAC. What they
// can do follows from their definitions.
#include <gtest/gtest.h>

#include <cmath>

#include "peers_trial.h"
#include "quadmark/lab/generate.h"

namespace quadmark {
namespace {

using namespace test;

// Chen, Wornell 2001: errors below a quarter of the distance of two cells of one bit (here: half a step) do no harm.
TEST(PeersIndexQim, IsExactWhileErrorsStayBelowHalfAStep) {
  const Mesh mesh = lab::sculpture(12000);
  const auto peer = bench::indexQim();
  const PeerTrial trial(*peer, mesh, "strength=0.001", randomPayload(5, 32, 32));
  EXPECT_EQ(trial.errorRate(trial.marked), 0);
  for (const double bits : {16, 14, 12, 11}) {  // of 11, half a step is a quarter of a thousandth of the side
    EXPECT_EQ(trial.after({"quantize", bits}), 0) << bits;
    EXPECT_EQ(trial.after({"quantize", bits, "per-axis"}), 0) << bits;
  }
  EXPECT_EQ(trial.after({"noise", 2e-4}), 0);
  EXPECT_GT(trial.after({"noise", 5e-3}), 0.3);
  EXPECT_GT(trial.after({"quantize", 6}), 0.3);
}

TEST(PeersIndexQim, FollowsShiftAndScaleAndNothingElse) {
  const Mesh mesh = lab::sculpture(12000);
  const auto peer = bench::indexQim();
  const PeerTrial trial(*peer, mesh, {}, randomPayload(5, 16, 16));
  EXPECT_EQ(trial.errorRate(lab::affine(trial.marked, {2.5, 0, 0, 7, 0, 2.5, 0, -3, 0, 0, 2.5, 1})), 0);
  EXPECT_NEAR(trial.errorRate(lab::affine(trial.marked, similarityMap())), 0.5, 0.15);
  EXPECT_NEAR(trial.after({"reorder"}), 0.5, 0.15);
  EXPECT_NEAR(trial.after({"crop", 0.1}), 0.5, 0.15);
  EXPECT_NEAR(trial.after({"simplify", 0.1}), 0.5, 0.15);
}

TEST(PeersIndexQim, LeavesTheBoxAsItIs) {
  const Mesh mesh = lab::sculpture(3000);
  const auto peer = bench::indexQim();
  const PeerTrial trial(*peer, mesh, "strength=0.01");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low[2] = {9, 9}, high[2] = {-9, -9};
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      for (int which : {0, 1}) {
        const double x = (which == 0 ? mesh : trial.marked).positions[3 * v + axis];
        low[which] = std::min(low[which], x);
        high[which] = std::max(high[which], x);
      }
    }
    EXPECT_EQ(low[0], low[1]);
    EXPECT_EQ(high[0], high[1]);
  }
}

std::optional<bool> certain(const PeerTrial& trial, const Mesh& mesh) {
  bench::TrialPayload asked = trial.payload;
  asked.bits.clear();
  return trial.peer.read(mesh, asked, trial.key, trial.settings).certain;
}

TEST(PeersLsbHmac, DetectsEveryChange) {
  const Mesh mesh = lab::sculpture(3000);
  const auto peer = bench::lsbHmac();
  const PeerTrial trial(*peer, mesh);
  EXPECT_EQ(certain(trial, trial.marked), true);
  EXPECT_EQ(certain(trial, mesh), false);
  for (const std::size_t i : {std::size_t{0}, std::size_t{4711}, mesh.positions.size() - 1}) {
    Mesh changed = trial.marked;
    changed.positions[i] = std::nextafter(static_cast<float>(changed.positions[i]), 9.0f);
    EXPECT_EQ(certain(trial, changed), false) << i;
    EXPECT_EQ(trial.errorRate(changed), 0) << i;  // one touched coordinate does not hide the payload
  }
  Mesh turned = trial.marked;
  std::swap(turned.faceVertices[0], turned.faceVertices[1]);
  EXPECT_EQ(certain(trial, turned), false);
  Mesh without = trial.marked;
  without.faceVertices.resize(without.faceVertices.size() - 3);
  EXPECT_EQ(certain(trial, without), false);
  EXPECT_EQ(certain(trial, lab::reorder(trial.marked, 1)), false);
}

TEST(PeersLsbHmac, MovesNothingByMoreThanItsLastBit) {
  const Mesh mesh = lab::sculpture(3000);
  const auto peer = bench::lsbHmac();
  const PeerTrial trial(*peer, mesh);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto before = static_cast<float>(mesh.positions[i]);
    const auto after = static_cast<float>(trial.mark.positions[i]);
    ASSERT_EQ(static_cast<double>(after), trial.mark.positions[i]);
    ASSERT_TRUE(after == before || after == std::nextafter(before, 9.0f) || after == std::nextafter(before, -9.0f)) << i;
  }
}

TEST(PeersLsbHmac, StaysOnIntegerGrids) {
  Mesh mesh = lab::sculpture(3000);
  mesh.grids = {{1, 0, 65535}};
  mesh.gridOf.assign(mesh.vertexCount(), 1);
  for (double& x : mesh.positions) x = std::floor(std::fabs(x) * 30000);
  const auto peer = bench::lsbHmac();
  const PeerTrial trial(*peer, mesh);
  EXPECT_EQ(trial.marked.positions, trial.mark.positions);
  EXPECT_EQ(trial.errorRate(trial.marked), 0);
  EXPECT_EQ(certain(trial, trial.marked), true);
}

TEST(PeersLsbHmac, IsLostWhereCoordinatesAreRounded) {
  const auto peer = bench::lsbHmac();
  const PeerTrial trial(*peer, lab::sculpture(3000));
  EXPECT_NEAR(trial.after({"quantize", 16}), 0.5, 0.25);
  EXPECT_NEAR(trial.after({"noise", 1e-5}), 0.5, 0.25);
  EXPECT_NEAR(trial.errorRate(lab::affine(trial.marked, similarityMap())), 0.5, 0.25);
}

}  // namespace
}  // namespace quadmark
