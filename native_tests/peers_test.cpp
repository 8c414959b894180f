// SPDX-License-Identifier: MIT
// What every scheme of bench/peers must hold, whatever its idea.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "peers_trial.h"
#include "quadmark/adjacency.h"
#include "quadmark/lab/generate.h"

namespace quadmark {
namespace {

using namespace test;
using bench::Bits;

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

// Of every shape that tools produce; most are too small for a mark.
std::vector<NamedMesh> strangeMeshes() {
  Mesh loose = lab::icosphere(2);
  loose.positions.insert(loose.positions.begin(), {9, 9, 9});
  for (std::uint32_t& v : loose.faceVertices) ++v;
  Mesh degenerate = lab::bumpyGrid(12, 12, 3);
  degenerate.faceVertices.insert(degenerate.faceVertices.end(), {5, 5, 5, 7, 7, 8});
  return {{"empty", Mesh{}},
          {"cube", lab::cube()},
          {"flat grid", lab::flatGrid(40, 40)},
          {"polygons", lab::polygonMix(1)},
          {"quads", lab::quadSphere(4)},
          {"fan", lab::fan(2000)},
          {"not manifold", lab::nonManifold()},
          {"two components", lab::twoComponents(1)},
          {"sphere", lab::icosphere(4)},
          {"loose vertex", loose},
          {"degenerate faces", degenerate}};
}

TEST(Peers, HaveDifferentNamesAndSayWhoseTheyAre) {
  std::set<std::string> names;
  for (const auto& peer : bench::peers()) {
    SCOPED_TRACE(peer->name());
    EXPECT_TRUE(names.insert(peer->name()).second);
    const bench::PeerInfo info = peer->info();
    for (const std::string& text :
         {info.authors, info.title, info.venue, info.carrier, info.settings, info.decided, info.validation})
      EXPECT_FALSE(text.empty());
    EXPECT_GE(info.year, 1990);
    EXPECT_TRUE(info.blind);
  }
}

TEST(Peers, ReadBackWhatTheyWrote) {
  const Mesh mesh = lab::sculpture(8000);
  for (const auto& peer : bench::peers()) {
    SCOPED_TRACE(peer->name());
    for (const auto& payload : {randomPayload(1), randomPayload(2, 12, 12)}) {
      const PeerTrial trial(*peer, mesh, {}, payload);
      EXPECT_EQ(trial.errorRate(trial.marked), 0);
      EXPECT_GT(trial.rmsRel(), 0);
      EXPECT_LT(trial.rmsRel(), 1e-3);
      EXPECT_GT(trial.mark.carriers, 0u);
    }
  }
}

TEST(Peers, AreDeterministic) {
  const Mesh mesh = lab::sculpture(2000);
  for (const auto& first : bench::peers()) {
    SCOPED_TRACE(first->name());
    const PeerTrial a(*first, mesh), b(*first, mesh);
    EXPECT_EQ(a.marked.positions, b.marked.positions);
  }
}

TEST(Peers, ReadNothingUnderAnotherKeyOrWithoutAMark) {
  const Mesh mesh = lab::sculpture(4000);
  const bench::TrialPayload payload = randomPayload(2, 24, 24);  // 576 bits: one standard deviation is 2 %
  for (const auto& peer : bench::peers()) {
    SCOPED_TRACE(peer->name());
    const PeerTrial trial(*peer, mesh, {}, payload);
    EXPECT_NEAR(trial.errorRate(trial.marked, 8), 0.5, 0.1);
    EXPECT_NEAR(trial.errorRate(mesh), 0.5, 0.1);
  }
}

TEST(Peers, MoveTwinsTogether) {
  Mesh mesh = lab::sculpture(3000);
  // Every tenth face gets vertices of its own, as normals or texture coordinates make tools do.
  for (std::size_t corner = 0; corner < mesh.faceVertices.size(); corner += corner % 3 == 2 ? 28 : 1) {
    const std::uint32_t v = mesh.faceVertices[corner];
    for (int axis = 0; axis < 3; ++axis) mesh.positions.push_back(mesh.positions[3 * v + axis]);
    mesh.faceVertices[corner] = static_cast<std::uint32_t>(mesh.vertexCount() - 1);
  }
  const WeldedMesh welded = weld(mesh);
  ASSERT_LT(welded.vertexCount(), mesh.vertexCount());
  for (const auto& peer : bench::peers()) {
    SCOPED_TRACE(peer->name());
    const PeerTrial trial(*peer, mesh);
    EXPECT_EQ(trial.errorRate(trial.marked), 0);
    std::vector<double> where(3 * welded.vertexCount(), 0);
    Bits seen(welded.vertexCount(), 0);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      const std::uint32_t w = welded.weldedOf[v];
      for (int axis = 0; axis < 3; ++axis) {
        double& first = where[3 * w + axis];
        if (seen[w] == 0) first = trial.marked.positions[3 * v + axis];
        ASSERT_EQ(first, trial.marked.positions[3 * v + axis]) << v;
      }
      seen[w] = 1;
    }
  }
}

TEST(Peers, RefuseWhatHasNoRoomAndAcceptAnyMesh) {
  const bench::TrialPayload payload = randomPayload(1);
  for (const auto& peer : bench::peers()) {
    for (const NamedMesh& strange : strangeMeshes()) {
      SCOPED_TRACE(peer->name() + ", " + strange.name);
      const auto mark = peer->mark(strange.mesh, payload, 1, peer->usualSettings());
      if (mark) {
        EXPECT_EQ(mark->positions.size(), strange.mesh.positions.size());
        for (const double x : mark->positions) ASSERT_TRUE(std::isfinite(x));
      } else {
        EXPECT_EQ(mark.error().code, ErrorCode::capacity) << mark.error().message;
      }
      const bench::TrialReading reading = peer->read(strange.mesh, payload, 1, peer->usualSettings());
      EXPECT_TRUE(reading.bits.empty() || reading.bits.size() == 64);
      EXPECT_TRUE(reading.unread.empty() || reading.unread.size() == reading.bits.size());
    }
    for (const Mesh& tiny : {Mesh{}, lab::cube()}) {
      const auto mark = peer->mark(tiny, payload, 1, {});
      ASSERT_FALSE(mark) << peer->name();
      EXPECT_EQ(mark.error().code, ErrorCode::capacity);
    }
  }
}

TEST(Peers, RefuseSettingsTheyDoNotKnow) {
  const Mesh mesh = lab::icosphere(3);
  for (const auto& peer : bench::peers()) {
    for (const std::string bad : {"colour=3", "strength", "strength=", "strength=1e9", "strength=0.1x", "strength=nan"}) {
      SCOPED_TRACE(peer->name() + ", " + bad);
      const auto mark = peer->mark(mesh, randomPayload(1), 1, bad);
      ASSERT_FALSE(mark);
      EXPECT_EQ(mark.error().code, ErrorCode::badOption);
      EXPECT_TRUE(peer->read(mesh, randomPayload(1), 1, bad).bits.empty());
    }
    bench::TrialPayload incomplete = randomPayload(1);
    incomplete.bits.pop_back();
    EXPECT_EQ(peer->mark(mesh, incomplete, 1, {}).error().code, ErrorCode::badOption);
  }
}

}  // namespace
}  // namespace quadmark
