// SPDX-License-Identifier: MIT
// Ohbuchi, Masuda, Aono 1997 against what its authors claim (sections 3 and 4 of the JSAC version, and survey remarks of
// Gao et al. 2012): exact after any affine map, after cropping by repetition; destroyed by randomization of coordinates and
// by changes of the connectivity.
#include <gtest/gtest.h>

#include <algorithm>

#include "../bench/peers/patches.h"
#include "peers_trial.h"
#include "quadmark/lab/generate.h"

namespace quadmark {
namespace {

using namespace test;

void expectClaims(const Mesh& mesh) {
  const auto peer = bench::ohbuchiTvr();
  const PeerTrial trial(*peer, mesh, {}, randomPayload(5, 16, 16));
  EXPECT_EQ(trial.errorRate(trial.marked), 0);
  EXPECT_EQ(trial.errorRate(lab::affine(trial.marked, similarityMap())), 0);
  for (const char* map : {"R", "NS", "RE", "S", "SH", "CB"}) EXPECT_EQ(trial.after({"affine", 0, map}), 0) << map;
  EXPECT_EQ(trial.after({"reorder"}), 0);
  for (const double share : {0.1, 0.3, 0.5}) EXPECT_EQ(trial.after({"crop", share}), 0) << share;
  EXPECT_EQ(trial.after({"noise", 1e-5}), 0);
  EXPECT_GT(trial.after({"noise", 3e-3}), 0.35);
  EXPECT_GT(trial.after({"quantize", 8}), 0.35);
  EXPECT_GT(trial.after({"simplify", 0.3}), 0.35);
}

TEST(PeersOhbuchi, HoldsWhatItsAuthorsClaim) {
  expectClaims(lab::sculpture(20000));
  if (const auto bunny = realMesh("bunny.glb")) expectClaims(*bunny);
}

TEST(PeersOhbuchi, StrengthBuysRobustness) {
  const Mesh mesh = lab::sculpture(6000);
  const auto peer = bench::ohbuchiTvr();
  const PeerTrial small(*peer, mesh, "strength=0.01"), large(*peer, mesh, "strength=0.1");
  EXPECT_LT(4 * small.rmsRel(), large.rmsRel());
  EXPECT_EQ(small.errorRate(small.marked), 0);
  EXPECT_GT(small.after({"noise", 5e-4}), 0.2);
  EXPECT_EQ(large.after({"noise", 1e-4}), 0);
  EXPECT_LT(large.after({"noise", 5e-4}), small.after({"noise", 5e-4}));
}

TEST(PeersOhbuchi, HasNoRoomWhereEverythingIsFlat) {
  const auto peer = bench::ohbuchiTvr();
  const auto mark = peer->mark(lab::flatGrid(60, 60), randomPayload(1), 1, {});
  ASSERT_FALSE(mark);
  EXPECT_EQ(mark.error().code, ErrorCode::capacity);
}

// Which patch every vertex is in, by what does not depend on numbers: the patch's name.
std::vector<std::uint64_t> patchNames(const WeldedMesh& welded, const std::vector<bench::Patch>& patches) {
  std::vector<std::uint64_t> names(welded.vertexCount(), 0);
  for (const bench::Patch& patch : patches) {
    for (const std::uint32_t v : patch.vertices) names[v] = patch.name;
  }
  return names;
}

TEST(PeersPatches, HoldEveryVertexOnceAndAreConnected) {
  for (const Mesh& mesh : {lab::sculpture(5000), lab::machinedPart(3000), lab::twoComponents(1), lab::nonManifold()}) {
    const WeldedMesh welded = weld(mesh);
    std::vector<int> times(welded.vertexCount(), 0);
    for (const bench::Patch& patch : bench::patchesOf(welded, 8)) {
      ASSERT_EQ(patch.vertices.size(), patch.rings.size());
      EXPECT_EQ(patch.rings[0], 0u);
      for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
        ++times[patch.vertices[i]];
        if (i == 0) continue;
        EXPECT_GE(patch.rings[i], patch.rings[i - 1]);
        bool reached = false;
        for (std::size_t j = 0; j < i && !reached; ++j) {
          const auto near = welded.neighboursOf(patch.vertices[i]);
          reached = patch.rings[j] + 1 == patch.rings[i] && std::count(near.begin(), near.end(), patch.vertices[j]) > 0;
        }
        EXPECT_TRUE(reached);
      }
    }
    EXPECT_EQ(std::count(times.begin(), times.end(), 1), welded.vertexCount());
  }
}

TEST(PeersPatches, StayWhatTheyAreWhenVerticesAreReorderedAndMostlyWhenSomeAreCutOff) {
  const Mesh mesh = lab::sculpture(8000);
  const WeldedMesh welded = weld(mesh);
  const auto before = patchNames(welded, bench::patchesOf(welded, 8));
  const auto share = [&](const Mesh& changed, const lab::VertexOrigin& origin) {
    const WeldedMesh weldedAfter = weld(changed);
    const auto after = patchNames(weldedAfter, bench::patchesOf(weldedAfter, 8));
    double same = 0, all = 0;
    for (std::size_t v = 0; v < origin.size(); ++v) {
      if (weldedAfter.weldedOf[v] == kNoVertex) continue;
      all += 1;
      same += after[weldedAfter.weldedOf[v]] == before[welded.weldedOf[origin[v]]] ? 1 : 0;
    }
    return same / all;
  };
  lab::VertexOrigin origin;
  const Mesh reordered = lab::reorder(mesh, 3, &origin);
  EXPECT_EQ(share(reordered, origin), 1);
  const Mesh cropped = lab::crop(mesh, 0.4, 1, 1, &origin);
  EXPECT_GT(share(cropped, origin), 0.5);
}

}  // namespace
}  // namespace quadmark
