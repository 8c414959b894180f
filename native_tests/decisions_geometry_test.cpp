// SPDX-License-Identifier: MIT
// The decisions that the paper leaves open, geometry and neighbourhoods: D1 to D9.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "fixtures.h"

namespace quadmark {
namespace {

using namespace test;

// Four points of one triangle fan: the rim's first four, the pole far away, so that only the rim forms sets.
Mesh tent(const std::vector<double>& rim, double height) {
  Mesh mesh;
  mesh.positions = {0.1, 0.2, height};
  mesh.positions.insert(mesh.positions.end(), rim.begin(), rim.end());
  const auto count = static_cast<std::uint32_t>(rim.size() / 3);
  for (std::uint32_t i = 0; i < count; ++i)
    mesh.faceVertices.insert(mesh.faceVertices.end(), {0, i + 1, (i + 1) % count + 1});
  return mesh;
}

TEST(Decisions, D01TakesAVertexAndEverythingWithinKUniqueUndirectedEdges) {
  // A strip 0-1-2-3-4 of triangles; the edge 1-2 belongs to two faces and counts once.
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 1, 0, 2, 0, 0, 3, 1, 0, 4, 0, 0};
  mesh.faceVertices = {0, 1, 2, 1, 3, 2, 2, 3, 4};
  const WeldedMesh welded = weld(mesh);
  std::vector<std::uint32_t> members;
  ASSERT_TRUE(neighbourhood(welded, 0, 1, members));
  EXPECT_EQ(members, (std::vector<std::uint32_t>{0, 1, 2}));
  ASSERT_TRUE(neighbourhood(welded, 0, 2, members));
  EXPECT_EQ(members, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  ASSERT_TRUE(neighbourhood(welded, 2, 1, members));
  EXPECT_EQ(std::set<std::uint32_t>(members.begin(), members.end()), (std::set<std::uint32_t>{0, 1, 2, 3, 4}));
}

TEST(Decisions, D02MovesAllTwinsAlikeSoThatSeamsStayClosed) {
  const Key key = testKey(8, 8);
  const Mesh mesh = lab::seamed(9), output = marked(mesh, key, logo(8, 8).bits);
  EXPECT_EQ(weld(output).weldedOf, weld(mesh).weldedOf);
  EXPECT_NE(output.positions, mesh.positions);
}

TEST(Decisions, D03MeasuresLambdaInBoundingBoxDiagonals) {
  EXPECT_EQ(PaperParams{}.lambda, 1e-3);
  const Mesh mesh = lab::sculpture(1500);
  const Mesh doubled = mapped(mapped(mesh, "S"), "S");  // scaled by 1/4, exact in binary
  EXPECT_EQ(searched(mesh).cells.size(), searched(doubled).cells.size());
}

TEST(Decisions, D04CallsSetsCoplanarUpToTheRoundingOfTheirOwnFile) {
  EXPECT_EQ(roundingOf(Precision::float32).relative, 0x1p-24);
  EXPECT_EQ(roundingOf(Precision::float64).relative, 0x1p-53);
  // A flat grid tilted out of every axis plane: each coordinate is rounded, its cells are still natural ones,
  for (const double offset : {0.0, 1e3}) {
    const Mesh tilted =
        lab::affine(lab::flatGrid(12, 12), {0.6, 0.3, 0, offset, 0.1, 0.7, 0, 0, 0.37, -0.41, 1, -offset});
    const Searched found = searched(tilted);
    EXPECT_EQ(found.naturalCells, found.cells.size()) << offset;
    EXPECT_GT(found.cells.size(), 15u);
  }
  // and in doubles a deviation of 1e-5 is none of rounding.
  Mesh bent = asFloat64(lab::flatGrid(12, 12));
  for (std::size_t v = 0; v < bent.vertexCount(); ++v)
    bent.positions[3 * v + 2] = 1e-5 * static_cast<double>(v * v % 7);
  EXPECT_LT(searched(bent).naturalCells, searched(bent).cells.size());
}

TEST(Decisions, D05RejectsThinTrianglesAndFourPointsThatAreNotConvex) {
  const std::uint32_t ids[4] = {0, 1, 2, 3};
  Quad q;
  const double square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  EXPECT_TRUE(makeQuad(ids, square, kMinTriangleWriting, q));
  const double dart[] = {0, 0, 0, 1, 0, 0, 0.3, 0.3, 0, 0, 1, 0};
  EXPECT_FALSE(makeQuad(ids, dart, kMinTriangleWriting, q));
  // Areas of 4.5e-4 and 2.5e-3 of the square of the longest edge, 2.
  const double thin[] = {0, 0, 0, 1, -0.0018, 0, 2, 0, 0, 1, 1, 0},
               thick[] = {0, 0, 0, 1, -0.0100, 0, 2, 0, 0, 1, 1, 0};
  EXPECT_FALSE(makeQuad(ids, thin, kMinTriangleWriting, q));
  EXPECT_TRUE(makeQuad(ids, thick, kMinTriangleWriting, q));
}

TEST(Decisions, D06PrefersTheNaturalSetWithTheLongestDiagonals) {
  // Pole and rim: the rim's six corners are flat, the pole is off their plane. The best of the 15 rim sets wins.
  const Mesh mesh = tent({3, 0, 0, 1, 2, 0, -1, 1, 0, -2, -0.5, 0, -0.5, -2, 0, 2, -2, 0}, 5);
  const Searched found = searched(mesh);
  ASSERT_GE(found.cells.size(), 1u);
  EXPECT_EQ(found.naturalCells, found.cells.size());
  const WeldedMesh welded = weld(mesh);
  double longest = 0;
  forEachCoplanarSet(welded, welded.positions, 1, roundingOf(mesh.precision), {}, {}, [&](const Quad& q) {
    Quad strict;
    const std::uint32_t ids[4] = {q.a, q.b, q.c, q.d};
    if (makeQuad(ids, welded.positions.data(), kMinTriangleWriting, strict))
      longest = std::max(longest, q.diagonalSum());
  });
  EXPECT_EQ(found.cells[0].diagonalSum(), longest);
}

TEST(Decisions, D07ConstructsTheSetWithTheLeastProjectionWithinLambda) {
  // A rim of four, one corner lifted by 0.02: the cell is made of the rim and moves by no more than that.
  const Mesh mesh = tent({2, 0, 0, 0, 2, 0.02, -2, 0, 0, 0, -2, 0}, 6);
  PaperParams params;
  params.lambda = 0.01;  // of a diagonal of 8.2
  const Searched found = searched(mesh, params);
  ASSERT_EQ(found.cells.size(), 1u);
  EXPECT_EQ(found.naturalCells, 0u);
  const std::set<std::uint32_t> ids = {found.cells[0].a, found.cells[0].b, found.cells[0].c, found.cells[0].d};
  const WeldedMesh welded = weld(mesh);
  const std::uint32_t pole = welded.weldedOf[0];
  EXPECT_EQ(ids.count(pole), 0u);
  for (std::size_t i = 0; i < welded.positions.size(); ++i)
    EXPECT_LE(std::fabs(found.positions[i] - welded.positions[i]), 0.0201);
  params.lambda = 0.001;  // 0.008: not enough to flatten the rim
  EXPECT_TRUE(searched(mesh, params).cells.empty());
}

TEST(Decisions, D07TurnsNoFaceOver) {
  for (const NamedMesh& named : roomyMeshes())
    for (const double lambda : {1e-3, 2e-2}) {
      SCOPED_TRACE(named.name);
      const Mesh& mesh = named.mesh;  // clang 14 cannot capture a structured binding
      PaperParams params;
      params.lambda = lambda;
      const WeldedMesh welded = weld(mesh);
      const Searched found = searched(mesh, params);
      // Each cell is built with its surroundings as they then are, so the faces turn step by step: all steps together
      // turn hardly any over.
      std::size_t flipped = 0;
      for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
        const auto normal = [&](const std::vector<double>& positions) {
          std::array<double, 3> n{};
          const std::size_t begin = mesh.faceBegin(f), count = mesh.faceEnd(f) - begin;
          for (std::size_t i = 0; i < count; ++i) {
            const double* p = &positions[3 * std::size_t{welded.weldedOf[mesh.faceVertices[begin + i]]}];
            const double* q = &positions[3 * std::size_t{welded.weldedOf[mesh.faceVertices[begin + (i + 1) % count]]}];
            for (int k = 0; k < 3; ++k) n[k] += (p[(k + 1) % 3] - q[(k + 1) % 3]) * (p[(k + 2) % 3] + q[(k + 2) % 3]);
          }
          return n;
        };
        const auto a = normal(welded.positions), b = normal(found.positions);
        flipped += a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < 0;
      }
      EXPECT_LE(flipped, mesh.faceCount() / 200);
    }
}

TEST(Decisions, D08CutsLargeNeighbourhoodsByARuleThatDoesNotSeeTheOrder) {
  EXPECT_EQ(kMaxMembersWriting, 16u);
  EXPECT_GE(kMaxMembersReading, kMaxMembersWriting);
  const auto sets = [](const Mesh& mesh) {
    const WeldedMesh welded = weld(mesh);
    std::multiset<std::array<double, 3>> shapes;
    forEachCoplanarSet(welded, welded.positions, 1, roundingOf(mesh.precision), {1e9, 1e-2}, {},
                       [&](const Quad& q) { shapes.insert({q.gap, q.lengthAC + q.lengthBD, q.ratioAC + q.ratioBD}); });
    return shapes;
  };
  const Mesh pole = lab::fan(60);
  const auto reference = sets(pole);
  EXPECT_GT(reference.size(), 10u);
  EXPECT_LT(reference.size(), 20000u);  // of 521 855 sets of the whole pole
  for (std::uint64_t seed = 1; seed <= 10; ++seed) EXPECT_EQ(sets(lab::reorder(pole, seed)), reference);
  const Mesh huge = lab::fan(20000);  // takes no longer than its vertices ask for
  EXPECT_LT(searched(huge).cells.size(), 20000u);
}

TEST(Decisions, D09LetsUsedVerticesSeedNeighbourhoods) {
  // Some cells of an irregular mesh have no seed but vertices of other cells.
  const Mesh mesh = lab::sculpture(3000);
  const WeldedMesh welded = weld(mesh);
  const Searched found = searched(mesh);
  std::vector<std::uint32_t> cellOf(welded.vertexCount(), kNoVertex);
  for (std::uint32_t i = 0; i < found.cells.size(); ++i)
    for (std::uint32_t v : {found.cells[i].a, found.cells[i].b, found.cells[i].c, found.cells[i].d}) cellOf[v] = i;
  std::size_t byUsedSeedOnly = 0;
  for (std::uint32_t i = 0; i < found.cells.size(); ++i) {
    const Quad& q = found.cells[i];
    bool byFreeOrOwn = false;
    for (std::uint32_t v = 0; v < welded.vertexCount(); ++v) {
      const auto n = welded.neighboursOf(v);
      const auto near = [&](std::uint32_t w) { return w == v || std::binary_search(n.begin(), n.end(), w); };
      if (near(q.a) && near(q.b) && near(q.c) && near(q.d) && (cellOf[v] == i || cellOf[v] == kNoVertex))
        byFreeOrOwn = true;
    }
    byUsedSeedOnly += !byFreeOrOwn;
  }
  EXPECT_GT(byUsedSeedOnly, 0u);
}

}  // namespace
}  // namespace quadmark
