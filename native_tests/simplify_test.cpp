// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh_checks.h"
#include "quadmark/adjacency.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/metrics.h"

namespace quadmark {
namespace {

using namespace lab;
using namespace testing;

double relativeHausdorff(const Mesh& a, const Mesh& b) {
  return hausdorff(a, b) / boundingDiagonal(a);
}

std::size_t borderEdges(const Mesh& mesh) {
  std::size_t count = 0;
  for (const auto& [edge, use] : edgeUses(mesh)) count += use.up + use.down == 1;
  return count;
}

TEST(SimplifyMeshopt, ReachesItsTargetAndKeepsSurvivorsExactly) {
  const Mesh mesh = sculpture(5000);
  for (double keep : {0.9, 0.7, 0.5, 0.1}) {
    SCOPED_TRACE(keep);
    VertexOrigin origin;
    const Mesh simple = simplifyMeshopt(mesh, keep, &origin);
    EXPECT_NEAR(static_cast<double>(simple.faceCount()), keep * static_cast<double>(mesh.faceCount()),
                0.01 * static_cast<double>(mesh.faceCount()));
    ASSERT_EQ(origin.size(), simple.vertexCount());
    for (std::size_t v = 0; v < origin.size(); ++v) ASSERT_EQ(positionOf(simple, v), positionOf(mesh, origin[v]));
    EXPECT_TRUE(isClosedAndOriented(simple));
  }
}

TEST(SimplifyMeshopt, KeepsEverythingAtOne) {
  const Mesh mesh = sculpture(1000);
  EXPECT_EQ(contentHash(simplifyMeshopt(mesh, 1)), contentHash(mesh));
}

TEST(SimplifyMeshopt, FansPolygonsAndDropsUnusedVertices) {
  Mesh mesh = polygonMix(1);
  mesh.positions.insert(mesh.positions.end(), {9, 9, 9});
  const Mesh simple = simplifyMeshopt(mesh, 0.5);
  EXPECT_TRUE(simple.faceOffsets.empty());
  EXPECT_TRUE(validate(simple).ok());
  const std::set<std::uint32_t> used(simple.faceVertices.begin(), simple.faceVertices.end());
  EXPECT_EQ(used.size(), simple.vertexCount());
}

TEST(SimplifyMeshopt, KeepsGroupsAndDoublePrecision) {
  Mesh mesh = sculpture(1000);
  mesh.precision = Precision::float64;
  for (double& x : mesh.positions) x *= 1.0000000001;
  mesh.groups.assign(mesh.vertexCount(), 4);
  VertexOrigin origin;
  const Mesh simple = simplifyMeshopt(mesh, 0.6, &origin);
  EXPECT_EQ(simple.groups, std::vector<std::uint32_t>(simple.vertexCount(), 4));
  for (std::size_t v = 0; v < origin.size(); ++v) ASSERT_EQ(positionOf(simple, v), positionOf(mesh, origin[v]));
}

TEST(SimplifyQem, ReachesItsTargetAndStaysClosed) {
  const Mesh mesh = sculpture(5000);
  for (double keep : {0.9, 0.5, 0.1, 0.03}) {
    SCOPED_TRACE(keep);
    const Mesh simple = simplifyQem(mesh, keep);
    EXPECT_NEAR(static_cast<double>(simple.vertexCount()), keep * static_cast<double>(mesh.vertexCount()), 1);
    EXPECT_TRUE(isClosedAndOriented(simple));
    EXPECT_EQ(eulerCharacteristic(simple), 0);
    EXPECT_NEAR(signedVolume(simple), signedVolume(mesh), (keep < 0.1 ? 0.25 : 0.08) * signedVolume(mesh));
  }
}

TEST(SimplifyQem, StaysNearTheSurface) {
  const Mesh mesh = sculpture(20000);
  const double half = relativeHausdorff(mesh, simplifyQem(mesh, 0.5)),
               tenth = relativeHausdorff(mesh, simplifyQem(mesh, 0.1));
  EXPECT_GT(half, 0);
  EXPECT_LT(half, 0.002);
  EXPECT_LT(half, tenth);
  EXPECT_LT(tenth, 0.01);
}

TEST(SimplifyQem, PlacesVerticesOptimally) {
  // On a sphere the best places lie outside the chords: better than any choice among the old vertices.
  const Mesh sphere = icosphere(4);
  const Mesh simple = simplifyQem(sphere, 0.1);
  EXPECT_NEAR(signedVolume(simple), signedVolume(sphere), 0.02 * signedVolume(sphere));
  std::size_t moved = 0;
  std::set<Position> old;
  for (std::size_t v = 0; v < sphere.vertexCount(); ++v) old.insert(positionOf(sphere, v));
  for (std::size_t v = 0; v < simple.vertexCount(); ++v) moved += old.count(positionOf(simple, v)) == 0;
  EXPECT_GT(moved, simple.vertexCount() / 2);
}

TEST(SimplifyQem, LeavesUntouchedVerticesExactly) {
  const Mesh mesh = sculpture(3000);
  const Mesh simple = simplifyQem(mesh, 0.95);
  std::set<Position> old;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) old.insert(positionOf(mesh, v));
  std::size_t kept = 0;
  for (std::size_t v = 0; v < simple.vertexCount(); ++v) kept += old.count(positionOf(simple, v));
  EXPECT_GT(static_cast<double>(kept), 0.85 * static_cast<double>(mesh.vertexCount()));
}

TEST(SimplifyQem, KeepsFlatSurfacesFlatAndBordersInPlace) {
  const Mesh grid = flatGrid(20, 20), simple = simplifyQem(grid, 0.1);
  EXPECT_NEAR(static_cast<double>(simple.vertexCount()), 40, 1);
  EXPECT_LT(hausdorff(grid, simple), 1e-5);  // the outline too
  const Mesh part = machinedPart(4000), simplePart = simplifyQem(part, 0.3);
  EXPECT_LT(relativeHausdorff(part, simplePart), 0.002);
  EXPECT_TRUE(isClosedAndOriented(simplePart));
}

TEST(SimplifyQem, HoldsABumpyBorder) {
  const Mesh grid = bumpyGrid(30, 30, 1), simple = simplifyQem(grid, 0.5);
  EXPECT_EQ(eulerCharacteristic(simple), 1);
  EXPECT_GT(borderEdges(simple), 60u);
  for (const auto& [edge, use] : edgeUses(simple)) {
    ASSERT_LE(use.up, 1);
    ASSERT_LE(use.down, 1);
  }
}

TEST(SimplifyQem, TurnsNoFaceOver) {
  const Mesh grid = flatGrid(25, 25), simple = simplifyQem(grid, 0.2);
  for (std::size_t f = 0; f < simple.faceCount(); ++f) {
    const Position a = positionOf(simple, simple.faceVertices[3 * f]),
                   b = positionOf(simple, simple.faceVertices[3 * f + 1]),
                   c = positionOf(simple, simple.faceVertices[3 * f + 2]);
    EXPECT_GT((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]), 0);
  }
}

TEST(SimplifyQem, WeldsTwinsAndKeepsGroupsApart) {
  const Mesh simple = simplifyQem(seamed(1), 0.5);
  EXPECT_TRUE(isClosedAndOriented(simple));
  Mesh two = twoComponents(1);
  two.groups.assign(two.vertexCount(), 3);
  EXPECT_EQ(simplifyQem(two, 0.5).groups, std::vector<std::uint32_t>(642, 3));
}

TEST(SimplifyQem, StopsWhereTopologyForbidsMore) {
  const Mesh tiny = simplifyQem(icosphere(2), 0);  // a tetrahedron is the smallest sphere
  EXPECT_EQ(tiny.vertexCount(), 4u);
  EXPECT_TRUE(isClosedAndOriented(tiny));
  const Mesh knot = simplifyQem(sculpture(1000), 0);
  EXPECT_TRUE(isClosedAndOriented(knot));
  EXPECT_EQ(eulerCharacteristic(knot), 0);
  EXPECT_GE(knot.vertexCount(), 7u);  // the smallest torus
}

TEST(SimplifyQem, SurvivesHardConnectivity) {
  for (const Mesh& mesh : {nonManifold(), fan(200), polygonMix(3), cube(), quadSphere(3)}) {
    for (double keep : {0.8, 0.3, 0.0}) {
      const Mesh simple = simplifyQem(mesh, keep);
      EXPECT_TRUE(validate(simple).ok());
      EXPECT_LE(simple.vertexCount(), mesh.vertexCount());
      for (std::size_t f = 0; f < simple.faceCount(); ++f) {
        const std::uint32_t* c = &simple.faceVertices[3 * f];
        ASSERT_TRUE(c[0] != c[1] && c[1] != c[2] && c[2] != c[0]);
      }
    }
  }
  Mesh degenerate = cube();
  degenerate.faceVertices.insert(degenerate.faceVertices.end(), {0, 0, 1, 2, 2, 2});
  EXPECT_TRUE(isClosedAndOriented(simplifyQem(degenerate, 1)));
}

TEST(SimplifyQem, TakesLittleTimeForAMillionFaces) {
  const Mesh mesh = icosphere(7);  // 163 842 vertices; a quadratic step would show here as minutes
  const Mesh simple = simplifyQem(mesh, 0.1);
  EXPECT_NEAR(static_cast<double>(simple.vertexCount()), 16384, 1);
}

}  // namespace
}  // namespace quadmark
