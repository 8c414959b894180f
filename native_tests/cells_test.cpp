// SPDX-License-Identifier: MIT
#include "quadmark/cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "fixtures.h"

namespace quadmark {
namespace {

using test::Searched;
using test::searched;

using Ids = std::array<std::uint32_t, 4>;

Ids sortedIds(const Quad& q) {
  Ids ids = {q.a, q.b, q.c, q.d};
  std::sort(ids.begin(), ids.end());
  return ids;
}

PaperParams paramsWith(double lambda, int k = 1) {
  PaperParams p;
  p.lambda = lambda;
  p.k = k;
  return p;
}

// All sets of all neighbourhoods tried one by one.
std::set<Ids> setsByDefinition(const WeldedMesh& welded, int k, const Rounding& rounding, const GapLimit& limit) {
  std::set<Ids> found;
  std::vector<std::uint32_t> m;
  for (std::uint32_t v = 0; v < welded.vertexCount(); ++v) {
    if (!neighbourhood(welded, v, k, m)) continue;
    EXPECT_LE(m.size(), kMaxMembersReading);  // the fixtures here need no cut
    for (std::size_t a = 0; a < m.size(); ++a)
      for (std::size_t b = a + 1; b < m.size(); ++b)
        for (std::size_t c = b + 1; c < m.size(); ++c)
          for (std::size_t d = c + 1; d < m.size(); ++d) {
            const std::uint32_t ids[4] = {m[a], m[b], m[c], m[d]};
            Quad q;
            if (!makeQuad(ids, welded.positions.data(), kMinTriangleReading, q)) continue;
            if (limit.admits(q, rounding.unit(q, welded.positions.data()))) found.insert(sortedIds(q));
          }
  }
  return found;
}

std::set<Ids> setsFound(const WeldedMesh& welded, int k, const Rounding& rounding, const GapLimit& limit) {
  std::set<Ids> found;
  forEachCoplanarSet(welded, welded.positions, k, rounding, limit, {}, [&](const Quad& q) {
    EXPECT_TRUE(found.insert(sortedIds(q)).second) << "visited twice";
  });
  return found;
}

TEST(ForEachCoplanarSet, FindsExactlyTheSetsOfTheDefinition) {
  for (const auto& [name, mesh] : {test::NamedMesh{"flatGrid", lab::flatGrid(8, 8)},
                                   {"cube", lab::cube()},
                                   {"bumpyGrid", lab::bumpyGrid(12, 12, 3)},
                                   {"machinedPart", lab::machinedPart(500)},
                                   {"quadSphere", lab::quadSphere(2)},
                                   {"polygonMix", lab::polygonMix(5)},
                                   {"seamed", lab::seamed(4)}}) {
    SCOPED_TRACE(name);
    const WeldedMesh welded = weld(mesh);
    const Rounding rounding = roundingOf(mesh.precision);
    for (const GapLimit& limit : {GapLimit{}, GapLimit{1, 0}, GapLimit{1e6, 1e-3}, GapLimit{200, 1}})
      EXPECT_EQ(setsFound(welded, 1, rounding, limit), setsByDefinition(welded, 1, rounding, limit)) << limit.units;
  }
  const WeldedMesh grid = weld(lab::bumpyGrid(7, 7, 2));
  const GapLimit wide{1e6, 1e-2};
  EXPECT_EQ(setsFound(grid, 2, roundingOf(Precision::float32), wide),
            setsByDefinition(grid, 2, roundingOf(Precision::float32), wide));
}

TEST(ForEachCoplanarSet, SkipsMarkedVerticesAndKeepsToItsSeeds) {
  const WeldedMesh welded = weld(lab::flatGrid(8, 8));
  const Rounding rounding = roundingOf(Precision::float32);
  std::vector<std::uint8_t> skip(welded.vertexCount(), 0);
  for (std::size_t v = 0; v < skip.size(); v += 3) skip[v] = 1;
  std::set<Ids> expected, found;
  for (const Ids& ids : setsFound(welded, 1, rounding, {}))
    if (std::none_of(ids.begin(), ids.end(), [&](std::uint32_t v) { return skip[v] != 0; })) expected.insert(ids);
  forEachCoplanarSet(welded, welded.positions, 1, rounding, {}, skip,
                     [&](const Quad& q) { found.insert(sortedIds(q)); });
  EXPECT_EQ(found, expected);
  EXPECT_FALSE(found.empty());

  std::vector<std::uint32_t> members;
  ASSERT_TRUE(neighbourhood(welded, 27, 1, members));
  const std::vector<std::uint32_t> seeds = {27};
  std::size_t count = 0;
  forEachCoplanarSet(welded, welded.positions, 1, rounding, {}, {}, [&](const Quad& q) {
    ++count;
    for (std::uint32_t v : {q.a, q.b, q.c, q.d}) EXPECT_NE(std::find(members.begin(), members.end(), v), members.end());
  }, &seeds);
  EXPECT_GT(count, 0u);
}

TEST(SearchCells, GivesDisjointFlatConvexCellsInsideNeighbourhoods) {
  for (const auto& [name, mesh] : test::roomyMeshes()) {
    SCOPED_TRACE(name);
    const WeldedMesh welded = weld(mesh);
    const Rounding rounding = roundingOf(mesh.precision);
    const Searched found = searched(mesh, paramsWith(1e-3));
    EXPECT_GT(found.cells.size(), 10u);
    EXPECT_LE(found.naturalCells, found.cells.size());
    std::vector<std::uint8_t> used(welded.vertexCount(), 0);
    std::vector<std::set<std::uint32_t>> balls(welded.vertexCount());
    for (std::uint32_t v = 0; v < balls.size(); ++v) {
      const auto n = welded.neighboursOf(v);
      balls[v].insert(n.begin(), n.end());
      balls[v].insert(v);
    }
    for (const Quad& cell : found.cells) {
      Quad now;
      const Ids ids = sortedIds(cell);
      ASSERT_TRUE(makeQuad(ids.data(), found.positions.data(), 0.99 * kMinTriangleWriting, now));
      EXPECT_LE(now.gap, kExactUnits * rounding.unit(now, found.positions.data()));
      EXPECT_EQ(now.a, cell.a);  // named and measured as they stand after construction
      EXPECT_EQ(now.b, cell.b);
      EXPECT_EQ(now.ratioAC, cell.ratioAC);
      EXPECT_EQ(now.ratioBD, cell.ratioBD);
      for (std::uint32_t v : ids) EXPECT_EQ(used[v]++, 0) << "vertex of two cells";
      // Some vertex has all four within one edge of itself.
      bool together = false;
      for (std::uint32_t centre : balls[ids[0]])
        together = together ||
                   std::all_of(ids.begin(), ids.end(), [&](std::uint32_t v) { return balls[centre].count(v) != 0; });
      EXPECT_TRUE(together);
    }
    for (std::uint32_t v = 0; v < welded.vertexCount(); ++v)
      for (std::uint32_t i = 3 * v; used[v] == 0 && i < 3 * v + 3; ++i)
        EXPECT_EQ(found.positions[i], welded.positions[i]);
  }
}

TEST(SearchCells, MovesNoVertexFartherThanLambda) {
  for (const auto& [name, mesh] : test::roomyMeshes())
    for (const double lambda : {1e-2, 1e-3, 1e-4}) {
      SCOPED_TRACE(name);
      const double limit = lambda * boundingDiagonal(mesh);
      const WeldedMesh welded = weld(mesh);
      const Searched found = searched(mesh, paramsWith(lambda));
      for (std::size_t v = 0; v < welded.positions.size(); v += 3) {
        double moved2 = 0;
        for (int k = 0; k < 3; ++k)
          moved2 +=
              (found.positions[v + k] - welded.positions[v + k]) * (found.positions[v + k] - welded.positions[v + k]);
        ASSERT_LE(std::sqrt(moved2), limit * (1 + 1e-9));
      }
    }
}

TEST(SearchCells, FindsFewerCellsWithASmallerLambda) {
  const Mesh mesh = lab::sculpture(3000);
  const std::size_t wide = searched(mesh, paramsWith(1e-2)).cells.size(),
                    usual = searched(mesh, paramsWith(1e-3)).cells.size(),
                    tight = searched(mesh, paramsWith(1e-5)).cells.size(),
                    none = searched(mesh, paramsWith(1e-12)).cells.size();
  EXPECT_GE(wide, usual);
  EXPECT_GT(usual, tight);
  EXPECT_GT(tight, none);
  EXPECT_GT(usual, mesh.vertexCount() / 10);
}

TEST(SearchCells, FindsNaturalCellsOnFlatFaces) {
  const Mesh mesh = lab::flatGrid(12, 12);
  const Searched found = searched(mesh, paramsWith(1e-3));
  EXPECT_EQ(found.naturalCells, found.cells.size());
  EXPECT_GT(found.cells.size(), 15u);
  EXPECT_EQ(found.positions, weld(mesh).positions);  // nothing had to move
  EXPECT_EQ(searched(lab::sculpture(1500), paramsWith(1e-3)).naturalCells, 0u);
}

TEST(SearchCells, ReachesFartherWithALargerNeighbourhood) {
  const Mesh mesh = lab::polygonMix(5);  // mostly valence 3: rings of four points
  EXPECT_GT(searched(mesh, paramsWith(1e-3, 2)).cells.size(), searched(mesh, paramsWith(1e-3, 1)).cells.size());
}

TEST(Rounding, IsHalfAUnitOfTheLargestCoordinate) {
  const double positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, -1000, 1, 0};
  Quad q;
  q.a = 0, q.b = 1, q.c = 2, q.d = 3, q.lengthAC = 1, q.lengthBD = 2;
  EXPECT_EQ(roundingOf(Precision::float32).unit(q, positions), 1000.0 / 16777216);
  EXPECT_EQ(roundingOf(Precision::float64).unit(q, positions), 2e-8);  // the floor of D4
}

}  // namespace
}  // namespace quadmark
