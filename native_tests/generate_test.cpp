// SPDX-License-Identifier: MIT
#include "quadmark/lab/generate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh_checks.h"
#include "quadmark/adjacency.h"
#include "quadmark/random.h"

namespace quadmark {
namespace {

using namespace lab;
using namespace testing;

struct Named {
  const char* name;
  Mesh mesh;
};

std::vector<Named> closedSpheres() {
  return {{"cube", cube()}, {"quadSphere", quadSphere(3)}, {"icosphere", icosphere(3)}, {"polygonMix", polygonMix(1)}};
}

std::vector<Named> allFixtures() {
  std::vector<Named> all = closedSpheres();
  for (Named more :
       {Named{"sculpture", sculpture(2000)}, Named{"part", machinedPart(2000)}, Named{"bumpyGrid", bumpyGrid(9, 7, 1)},
        Named{"flatGrid", flatGrid(9, 7)}, Named{"fan", fan(60)}, Named{"nonManifold", nonManifold()},
        Named{"twoComponents", twoComponents(1)}, Named{"seamed", seamed(1)}})
    all.push_back(std::move(more));
  return all;
}

/// For every inner edge, the volume its two triangles span, relative to the cube of the edge across them.
std::vector<double> flatness(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> opposite;
  for (std::size_t c = 0; c < mesh.faceVertices.size(); ++c) {
    const std::size_t f = 3 * (c / 3);
    const std::uint32_t a = mesh.faceVertices[c], b = mesh.faceVertices[f + (c + 1) % 3];
    opposite[{std::min(a, b), std::max(a, b)}].push_back(mesh.faceVertices[f + (c + 2) % 3]);
  }
  std::vector<double> result;
  for (const auto& [edge, tips] : opposite) {
    if (tips.size() != 2) continue;
    double d[3][3];
    const std::uint32_t others[3] = {edge.second, tips[0], tips[1]};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        d[i][axis] =
            mesh.positions[3 * std::size_t{others[i]} + axis] - mesh.positions[3 * std::size_t{edge.first} + axis];
    const double volume = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) +
                          d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
                          d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
    double across = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) across += (d[1][axis] - d[2][axis]) * (d[1][axis] - d[2][axis]);
    result.push_back(std::fabs(volume) / (across * std::sqrt(across)));
  }
  return result;
}

TEST(Random, MatchesThePublishedSequence) {
  Random random(1234567);  // SplitMix64's reference output, as listed at rosettacode.org
  EXPECT_EQ(random.next(), 6457827717110365317u);
  EXPECT_EQ(random.next(), 3203168211198807973u);
  EXPECT_EQ(random.next(), 9817491932198370423u);
}

TEST(Random, DrawsEvenlyBelowAnyLimit) {
  Random random(5);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) ++counts[random.below(7)];
  for (int count : counts) EXPECT_NEAR(count, 10000, 500);
  EXPECT_EQ(random.below(1), 0u);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform();
    EXPECT_TRUE(x >= 0 && x < 1);
  }
}

TEST(Generate, EveryModelIsAValidMesh) {
  for (const Named& model : allFixtures()) {
    SCOPED_TRACE(model.name);
    EXPECT_TRUE(validate(model.mesh).ok());
    EXPECT_GT(model.mesh.faceCount(), 0u);
    Mesh rounded = model.mesh;
    roundToPrecision(rounded);
    EXPECT_EQ(rounded.positions, model.mesh.positions);
  }
}

TEST(Generate, SpheresAreClosedAndTurnedOutwards) {
  for (const Named& model : closedSpheres()) {
    SCOPED_TRACE(model.name);
    EXPECT_TRUE(isClosedAndOriented(model.mesh));
    EXPECT_EQ(eulerCharacteristic(model.mesh), 2);
    EXPECT_GT(signedVolume(model.mesh), 0);
  }
}

TEST(Generate, CubeHasTheVolumeEight) {
  EXPECT_EQ(cube().vertexCount(), 8u);
  EXPECT_EQ(cube().faceCount(), 12u);
  EXPECT_DOUBLE_EQ(signedVolume(cube()), 8);
}

TEST(Generate, SphereMeshesHaveTheirValences) {
  const Mesh sphere = icosphere(3);
  EXPECT_EQ(sphere.vertexCount(), 642u);
  const std::vector<int> valence = valences(sphere);
  EXPECT_EQ(std::count(valence.begin(), valence.end(), 5), 12);
  EXPECT_EQ(std::count(valence.begin(), valence.end(), 6), 630);

  const Mesh quads = quadSphere(3);
  EXPECT_EQ(quads.vertexCount(), 386u);
  for (std::size_t f = 0; f < quads.faceCount(); ++f) ASSERT_EQ(quads.faceEnd(f) - quads.faceBegin(f), 4u);
  const std::vector<int> quadValence = valences(quads);
  EXPECT_EQ(std::count(quadValence.begin(), quadValence.end(), 3), 8);
  EXPECT_EQ(std::count(quadValence.begin(), quadValence.end(), 4), 378);
}

TEST(Generate, SculptureIsAClosedIrregularKnot) {
  for (std::size_t size : {500u, 5000u, 35000u}) {
    SCOPED_TRACE(size);
    const Mesh mesh = sculpture(size);
    EXPECT_NEAR(static_cast<double>(mesh.vertexCount()), static_cast<double>(size), 0.05 * static_cast<double>(size));
    EXPECT_TRUE(isClosedAndOriented(mesh));
    EXPECT_EQ(eulerCharacteristic(mesh), 0);
    EXPECT_GT(signedVolume(mesh), 0);
    const std::vector<int> valence = valences(mesh);
    EXPECT_EQ(*std::min_element(valence.begin(), valence.end()), 4);
    EXPECT_EQ(*std::max_element(valence.begin(), valence.end()), 8);
    const auto sixes = static_cast<double>(std::count(valence.begin(), valence.end(), 6));
    EXPECT_LT(sixes, 0.6 * static_cast<double>(mesh.vertexCount()));
    EXPECT_EQ(weld(mesh).vertexCount(), mesh.vertexCount());
  }
}

TEST(Generate, SculptureHasNoNaturalCoplanarQuadrilaterals) {
  const std::vector<double> volumes = flatness(sculpture(20000));
  EXPECT_LE(std::count_if(volumes.begin(), volumes.end(), [](double v) { return v < 1e-7; }), 2);
}

TEST(Generate, PartHasExactlyFlatRegions) {
  const Mesh mesh = machinedPart(6500);
  EXPECT_TRUE(isClosedAndOriented(mesh));
  EXPECT_EQ(eulerCharacteristic(mesh), 0);  // the bore
  EXPECT_GT(signedVolume(mesh), 0);
  EXPECT_NEAR(static_cast<double>(mesh.vertexCount()), 6500, 350);
  const std::vector<double> volumes = flatness(mesh);
  const auto flat = static_cast<double>(std::count(volumes.begin(), volumes.end(), 0.0));
  EXPECT_GT(flat, 0.6 * static_cast<double>(volumes.size()));
  EXPECT_LT(flat, 0.98 * static_cast<double>(volumes.size()));  // creases and the fillet
  int slanted = 0;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const auto x = static_cast<float>(mesh.positions[3 * v]), y = static_cast<float>(mesh.positions[3 * v + 1]);
    slanted += x + y == 4.0f;
  }
  EXPECT_GT(slanted, 50);
}

TEST(Generate, PolygonMixHasFacesOfThreeToSixCorners) {
  const Mesh mesh = polygonMix(1);
  std::array<int, 8> counts{};
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) ++counts[mesh.faceEnd(f) - mesh.faceBegin(f)];
  for (std::size_t corners : {3u, 4u, 5u, 6u}) EXPECT_GT(counts[corners], 50) << corners;
}

TEST(Generate, GridsHaveABorder) {
  const Mesh flat = flatGrid(5, 4), bumpy = bumpyGrid(5, 4, 3);
  EXPECT_EQ(flat.vertexCount(), 20u);
  EXPECT_EQ(bumpy.faceVertices, flat.faceVertices);
  EXPECT_EQ(eulerCharacteristic(flat), 1);
  for (std::size_t v = 0; v < flat.vertexCount(); ++v) EXPECT_EQ(flat.positions[3 * v + 2], 0);
  int border = 0;
  for (const auto& [edge, use] : edgeUses(flat)) border += use.up + use.down == 1;
  EXPECT_EQ(border, 2 * (4 + 3));
}

TEST(Generate, FanHasOnePoleOfHighValence) {
  const std::vector<int> valence = valences(fan(60));
  EXPECT_EQ(valence[0], 60);
  for (std::size_t v = 1; v < valence.size(); ++v) EXPECT_EQ(valence[v], 3);
}

TEST(Generate, NonManifoldHasAnEdgeOfThreeFacesAndABowTie) {
  const Mesh mesh = nonManifold();
  int triple = 0;
  for (const auto& [edge, use] : edgeUses(mesh)) triple += use.up + use.down == 3;
  EXPECT_EQ(triple, 11);
  EXPECT_EQ(valences(mesh)[11], 1 + 3 + 8);  // end of the spine: the spine, the edges of three pages, the cone
}

TEST(Generate, TwoComponentsAreApart) {
  const Mesh mesh = twoComponents(2);
  std::vector<std::uint32_t> root(mesh.vertexCount());
  for (std::uint32_t v = 0; v < root.size(); ++v) root[v] = v;
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v];
    return v;
  };
  for (const auto& [edge, use] : edgeUses(mesh)) root[find(edge.first)] = find(edge.second);
  std::set<std::uint32_t> roots;
  for (std::uint32_t v = 0; v < root.size(); ++v) roots.insert(find(v));
  EXPECT_EQ(roots.size(), 2u);
}

TEST(Generate, SeamedHasTwinsThatWeldToAClosedSurface) {
  const Mesh mesh = seamed(1);
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.vertexCount(), 642u);
  EXPECT_GT(mesh.vertexCount(), 660u);
  EXPECT_FALSE(isClosedAndOriented(mesh));
  Mesh joined = mesh;
  for (std::uint32_t& v : joined.faceVertices) v = welded.weldedOf[v];
  joined.positions = welded.positions;
  EXPECT_TRUE(isClosedAndOriented(joined));
}

TEST(Generate, SeedsMakeDifferentModels) {
  EXPECT_NE(contentHash(sculpture(1000, 1)), contentHash(sculpture(1000, 2)));
  EXPECT_NE(contentHash(machinedPart(1000, 1)), contentHash(machinedPart(1000, 2)));
  EXPECT_EQ(contentHash(sculpture(1000, 1)), contentHash(sculpture(1000, 1)));
}

// The same numbers natively and as wasm: generators use nothing that rounds differently. A deliberate change of a
// generator changes its number here.
TEST(Generate, IsBitEqualOnEveryPlatform) {
  EXPECT_EQ(contentHash(sculpture(2000)), 0x9d84651220332ec5u);
  EXPECT_EQ(contentHash(machinedPart(2000)), 0x19b87880389da24fu);
  EXPECT_EQ(contentHash(icosphere(3)), 0x8dc7bbbaf1e04b29u);
  EXPECT_EQ(contentHash(quadSphere(3)), 0x8333147032fe40d7u);
  EXPECT_EQ(contentHash(bumpyGrid(20, 20, 1)), 0x9429961feb711ad2u);
  EXPECT_EQ(contentHash(polygonMix(1)), 0xb745f4dbd13acf54u);
  EXPECT_EQ(contentHash(fan(60)), 0x2c67a08f3b9698aau);
  EXPECT_EQ(contentHash(nonManifold()), 0x135346e7c9f1f3e0u);
  EXPECT_EQ(contentHash(twoComponents(1)), 0x6ab1a7b75d4e8536u);
  EXPECT_EQ(contentHash(seamed(1)), 0xdf2e6969d97e4d10u);
}

TEST(Generate, FindsModelsByName) {
  for (const char* name : {"sculpture", "part", "cube", "quad-sphere", "icosphere", "bumpy-grid", "flat-grid",
                           "polygon-mix", "fan", "non-manifold", "two-components", "seamed"}) {
    SCOPED_TRACE(name);
    const Result<Mesh> mesh = generate(name, 1000, 1);
    ASSERT_TRUE(mesh.ok());
    EXPECT_TRUE(validate(*mesh).ok());
  }
  EXPECT_NEAR(static_cast<double>(generate("bumpy-grid", 1000, 1)->vertexCount()), 1000, 60);
  EXPECT_EQ(generate("icosphere", 642, 1)->vertexCount(), 642u);
}

TEST(Generate, RefusesUnknownNamesAndSizes) {
  const Result<Mesh> unknown = generate("teapot", 1000, 1);
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().code, ErrorCode::badOption);
  EXPECT_NE(unknown.error().message.find("teapot"), std::string::npos);
  EXPECT_NE(unknown.error().message.find("sculpture"), std::string::npos);
  const Result<Mesh> huge = generate("sculpture", std::size_t{1} << 31, 1);
  ASSERT_FALSE(huge.ok());
  EXPECT_EQ(huge.error().code, ErrorCode::badOption);
}

}  // namespace
}  // namespace quadmark
