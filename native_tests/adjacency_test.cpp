// SPDX-License-Identifier: MIT
#include "quadmark/adjacency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "fixtures.h"

namespace quadmark {
namespace {

using Place = std::array<double, 4>;  // position and seam group: what a welded vertex is known by
using Edges = std::map<Place, std::set<Place>>;

Place placeOf(const Mesh& mesh, std::uint32_t v) {
  const double* p = &mesh.positions[3 * std::size_t{v}];
  return {p[0] + 0.0, p[1] + 0.0, p[2] + 0.0, mesh.groups.empty() ? 0.0 : mesh.groups[v]};  // -0 + 0 = +0
}

// The definition taken literally (D1, D2): places joined by an edge of some face.
Edges edgesByDefinition(const Mesh& mesh) {
  Edges edges;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const std::size_t begin = mesh.faceBegin(f), count = mesh.faceEnd(f) - begin;
    for (std::size_t i = 0; i < count; ++i) {
      const Place a = placeOf(mesh, mesh.faceVertices[begin + i]);
      const Place b = placeOf(mesh, mesh.faceVertices[begin + (i + 1) % count]);
      edges[a], edges[b];
      if (a != b) edges[a].insert(b), edges[b].insert(a);
    }
  }
  return edges;
}

// Place per welded vertex, checking that all mesh vertices of one welded vertex share it.
std::vector<Place> placesOf(const Mesh& mesh, const WeldedMesh& welded) {
  std::vector<Place> places(welded.vertexCount());
  std::vector<std::uint8_t> named(places.size(), 0);
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    const std::uint32_t w = welded.weldedOf[v];
    if (w == kNoVertex) continue;
    if (named[w] != 0) {
      EXPECT_EQ(places[w], placeOf(mesh, v));
    }
    places[w] = placeOf(mesh, v);
    named[w] = 1;
    for (int k = 0; k < 3; ++k) EXPECT_EQ(welded.positions[3 * std::size_t{w} + k], places[w][k]);
  }
  EXPECT_EQ(std::count(named.begin(), named.end(), 1), static_cast<std::ptrdiff_t>(places.size()));
  return places;
}

void expectEdgesByDefinition(const Mesh& mesh) {
  const WeldedMesh welded = weld(mesh);
  const std::vector<Place> places = placesOf(mesh, welded);
  const Edges expected = edgesByDefinition(mesh);
  ASSERT_EQ(std::set<Place>(places.begin(), places.end()).size(), places.size());  // welded to the end
  ASSERT_EQ(places.size(), expected.size());
  for (std::uint32_t w = 0; w < places.size(); ++w) {
    const auto neighbours = welded.neighboursOf(w);
    EXPECT_TRUE(std::is_sorted(neighbours.begin(), neighbours.end()));
    std::set<Place> found;
    for (std::uint32_t n : neighbours) found.insert(places[n]);
    EXPECT_EQ(found.size(), neighbours.size());  // unique
    EXPECT_EQ(found, expected.at(places[w]));    // undirected by construction of `expected`
  }
}

TEST(Weld, FindsTheEdgesOfTheDefinitionOnEveryFixture) {
  for (const auto& [name, mesh] : test::allMeshes()) {
    SCOPED_TRACE(name);
    expectEdgesByDefinition(mesh);
    expectEdgesByDefinition(lab::reorder(mesh, 7));
  }
}

TEST(Weld, NumbersVerticesByFirstAppearance) {
  const Mesh mesh = lab::seamed(4);
  const WeldedMesh welded = weld(mesh);
  EXPECT_LT(welded.vertexCount(), mesh.vertexCount());  // the seam has twins
  std::uint32_t next = 0;
  for (std::uint32_t w : welded.weldedOf) {
    ASSERT_LE(w, next);
    if (w == next) ++next;
  }
  EXPECT_EQ(next, welded.vertexCount());
}

TEST(Weld, UsesTheBoundaryEdgesOfPolygonsOnly) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 2, 0, 0, 3, 1, 0, 2, 2, 0, 0, 2, 0, 5, 5, 5};
  mesh.faceVertices = {0, 1, 2, 3, 4};
  mesh.faceOffsets = {0, 5};
  const WeldedMesh welded = weld(mesh);
  ASSERT_EQ(welded.vertexCount(), 5u);
  EXPECT_EQ(welded.weldedOf[5], kNoVertex);  // no face uses it
  for (std::uint32_t w = 0; w < 5; ++w) {
    ASSERT_EQ(welded.neighboursOf(w).size(), 2u);
    EXPECT_EQ(welded.neighboursOf(w)[0], std::min((w + 1) % 5, (w + 4) % 5));
    EXPECT_EQ(welded.neighboursOf(w)[1], std::max((w + 1) % 5, (w + 4) % 5));
  }
}

TEST(Weld, TakesNegativeZeroForZero) {
  Mesh mesh;
  mesh.positions = {0.0, 0, 0, 1, 0, 0, 0, 1, 0, -0.0, -0.0, 0, -0.0, 1, -0.0, -1, 0, 0};
  mesh.faceVertices = {0, 1, 2, 3, 4, 5};
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.vertexCount(), 4u);
  EXPECT_EQ(welded.weldedOf[0], welded.weldedOf[3]);
  EXPECT_EQ(welded.weldedOf[2], welded.weldedOf[4]);
}

TEST(Weld, KeepsSeamGroupsApart) {
  Mesh mesh = lab::seamed(4);
  const std::uint32_t together = weld(mesh).vertexCount();
  mesh.groups.assign(mesh.vertexCount(), 9);
  EXPECT_EQ(weld(mesh).vertexCount(), together);  // one group, whatever its number
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) mesh.groups[v] = static_cast<std::uint32_t>(v % 2);
  expectEdgesByDefinition(mesh);
  EXPECT_GT(weld(mesh).vertexCount(), together);
}

TEST(Weld, AcceptsNonManifoldEdgesAndDegenerateFaces) {
  Mesh mesh;
  // Three faces on edge 0-1, one of them twice, one collapsed to an edge, one to a point.
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1};
  mesh.faceVertices = {0, 1, 2, 1, 0, 3, 0, 1, 4, 0, 1, 4, 2, 2, 3, 4, 4, 4};
  expectEdgesByDefinition(mesh);
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.neighboursOf(0).size(), 4u);
  EXPECT_EQ(welded.neighboursOf(2).size(), 3u);  // 0, 1 and, by the collapsed face, 3
  Mesh empty;
  EXPECT_EQ(weld(empty).vertexCount(), 0u);
}

TEST(FaceRings, ListTheFacesOfEachVertexOnce) {
  for (const auto& [name, mesh] : test::allMeshes()) {
    SCOPED_TRACE(name);
    const WeldedMesh welded = weld(mesh);
    const FaceRings rings = faceRings(mesh, welded);
    std::vector<std::set<std::uint32_t>> expected(welded.vertexCount());
    for (std::uint32_t f = 0; f < mesh.faceCount(); ++f)
      for (std::size_t c = mesh.faceBegin(f); c < mesh.faceEnd(f); ++c)
        expected[welded.weldedOf[mesh.faceVertices[c]]].insert(f);
    for (std::uint32_t w = 0; w < welded.vertexCount(); ++w) {
      const auto faces = rings.facesOf(w);
      EXPECT_TRUE(std::is_sorted(faces.begin(), faces.end()));
      EXPECT_EQ(std::set<std::uint32_t>(faces.begin(), faces.end()), expected[w]);
      EXPECT_EQ(faces.size(), expected[w].size());
    }
  }
}

// Breadth-first search with a depth limit, the other way to say Eq. (1).
std::set<std::uint32_t> ballByDefinition(const WeldedMesh& welded, std::uint32_t centre, int k) {
  std::map<std::uint32_t, int> depth = {{centre, 0}};
  std::vector<std::uint32_t> queue = {centre};
  for (std::size_t i = 0; i < queue.size(); ++i)
    if (depth[queue[i]] < k)
      for (std::uint32_t n : welded.neighboursOf(queue[i]))
        if (depth.emplace(n, depth[queue[i]] + 1).second) queue.push_back(n);
  return {queue.begin(), queue.end()};
}

TEST(Neighbourhood, IsEverythingWithinKEdges) {
  for (const auto& [name, mesh] : test::allMeshes()) {
    SCOPED_TRACE(name);
    const WeldedMesh welded = weld(mesh);
    std::vector<std::uint32_t> members;
    for (int k = 1; k <= 3; ++k)
      for (std::uint32_t v = 0; v < welded.vertexCount(); v += 1 + welded.vertexCount() / 50) {
        ASSERT_TRUE(neighbourhood(welded, v, k, members));
        EXPECT_EQ(members.front(), v);
        const std::set<std::uint32_t> unique(members.begin(), members.end());
        EXPECT_EQ(unique.size(), members.size());
        EXPECT_EQ(unique, ballByDefinition(welded, v, k));
      }
  }
}

TEST(Neighbourhood, StopsAtTheLimitForLargerRings) {
  const WeldedMesh welded = weld(lab::fan(static_cast<int>(kMaxNeighbourhood) + 50));
  std::vector<std::uint32_t> members;
  EXPECT_TRUE(neighbourhood(welded, 0, 1, members));  // a ring itself is never cut
  EXPECT_EQ(members.size(), kMaxNeighbourhood + 51);
  EXPECT_FALSE(neighbourhood(welded, 1, 2, members));
  const WeldedMesh small = weld(lab::fan(60));
  EXPECT_TRUE(neighbourhood(small, 1, 2, members));
  EXPECT_EQ(members.size(), 61u);
}

}  // namespace
}  // namespace quadmark
