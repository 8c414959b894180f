// SPDX-License-Identifier: MIT
#include "quadmark/lab/attacks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "mesh_checks.h"
#include "quadmark/adjacency.h"
#include "quadmark/lab/generate.h"

namespace quadmark {
namespace {

using namespace lab;
using namespace testing;

struct Named {
  const char* name;
  Mesh mesh;
};

std::vector<Named> variedMeshes() {
  return {{"sculpture", sculpture(1500)},
          {"part", machinedPart(1500)},
          {"polygonMix", polygonMix(1)},
          {"seamed", seamed(1)},
          {"nonManifold", nonManifold()},
          {"bumpyGrid", bumpyGrid(20, 20, 1)},
          {"fan", fan(40)},
          {"quadSphere", quadSphere(3)}};
}

/// Every attack once, at a middling strength.
std::vector<AttackSpec> allSpecs() {
  std::vector<AttackSpec> specs;
  for (const char* map : {"R", "NS", "RE", "S", "SH", "CB"}) specs.push_back({"affine", 0, map});
  specs.push_back({"reorder"});
  for (const char* axis : {"x", "y", "z", "random"}) specs.push_back({"crop", 0.4, axis});
  specs.push_back({"noise", 0.002});
  specs.push_back({"local-noise", 0.002});
  for (const char* grid : {"common", "per-axis"}) specs.push_back({"quantize", 10, grid});
  for (const char* method : {"taubin", "laplacian"}) specs.push_back({"smooth", 0.4, method, 3});
  for (const char* method : {"meshopt", "qem"}) specs.push_back({"simplify", 0.3, method});
  specs.push_back({"deform", 0.8});
  return specs;
}

/// The welded surface as a set of faces, each a cyclic sequence of positions from its smallest one on.
std::multiset<std::vector<Position>> surfaceOf(const Mesh& mesh) {
  std::multiset<std::vector<Position>> faces;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    std::vector<Position> face;
    for (std::size_t c = mesh.faceBegin(f); c < mesh.faceEnd(f); ++c)
      face.push_back(positionOf(mesh, mesh.faceVertices[c]));
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    faces.insert(face);
  }
  return faces;
}

TEST(Attack, GivesValidMeshesAndLeavesTheInputAlone) {
  for (const Named& model : variedMeshes())
    for (const AttackSpec& spec : allSpecs()) {
      SCOPED_TRACE(std::string(model.name) + ": " + spec.kind + " " + spec.variant);
      const std::uint64_t before = contentHash(model.mesh);
      const Result<Mesh> attacked = attack(model.mesh, spec);
      ASSERT_TRUE(attacked.ok()) << attacked.error().message;
      EXPECT_TRUE(validate(*attacked).ok());
      EXPECT_GT(attacked->faceCount(), 0u);
      EXPECT_NE(contentHash(*attacked), before);
      EXPECT_EQ(contentHash(model.mesh), before);
      Mesh rounded = *attacked;
      roundToPrecision(rounded);
      EXPECT_EQ(rounded.positions, attacked->positions);
    }
}

TEST(Attack, KeepsTwinsTogether) {
  const Mesh mesh = seamed(1);
  const WeldedMesh welded = weld(mesh);
  ASSERT_LT(welded.vertexCount(), mesh.vertexCount());
  for (const AttackSpec& spec : allSpecs()) {
    SCOPED_TRACE(spec.kind + " " + spec.variant);
    const Mesh attacked = *attack(mesh, spec);
    if (attacked.vertexCount() == mesh.vertexCount() && spec.kind != "reorder") {
      std::map<std::uint32_t, Position> firstTwin;
      for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
        ASSERT_EQ(firstTwin.emplace(welded.weldedOf[v], positionOf(attacked, v)).first->second,
                  positionOf(attacked, v));
    }
    // Whatever moved or went: the surface has no crack, welded edges have two faces (or border a crop).
    if (spec.kind == "crop") continue;
    Mesh joined = attacked;
    const WeldedMesh after = weld(attacked);
    for (std::uint32_t& v : joined.faceVertices) v = after.weldedOf[v];
    joined.positions = after.positions;
    EXPECT_TRUE(isClosedAndOriented(joined));
  }
}

TEST(Attack, TreatsTwinsOfDifferentGroupsApart) {
  Mesh mesh = bumpyGrid(6, 6, 1);
  const std::size_t count = mesh.vertexCount();
  const std::vector<double> positions = mesh.positions;
  const std::vector<std::uint32_t> faces = mesh.faceVertices;
  mesh.positions.insert(mesh.positions.end(), positions.begin(), positions.end());
  for (std::uint32_t v : faces) mesh.faceVertices.push_back(v + static_cast<std::uint32_t>(count));
  mesh.groups.assign(2 * count, 0);
  std::fill(mesh.groups.begin() + static_cast<std::ptrdiff_t>(count), mesh.groups.end(), 5u);
  const Mesh moved = noise(mesh, 0.01, 1);
  EXPECT_EQ(moved.groups, mesh.groups);
  EXPECT_NE(positionOf(moved, 3), positionOf(moved, count + 3));
  VertexOrigin origin;
  const Mesh shuffled = reorder(mesh, 2, &origin);
  for (std::size_t v = 0; v < origin.size(); ++v) EXPECT_EQ(shuffled.groups[v], mesh.groups[origin[v]]);
}

TEST(Affine, MapsAsWritten) {
  const Mesh mesh = bumpyGrid(5, 5, 1);
  const Affine map{1, 2, 3, 4, 0.5, -1, 0, 2, 0, 0, 2, -1};
  Mesh wide = mesh;
  wide.precision = Precision::float64;
  const Mesh moved = affine(wide, map);
  const Position p = positionOf(mesh, 7), q = positionOf(moved, 7);
  EXPECT_DOUBLE_EQ(q[0], p[0] + 2 * p[1] + 3 * p[2] + 4);
  EXPECT_DOUBLE_EQ(q[1], 0.5 * p[0] - p[1] + 2);
  EXPECT_DOUBLE_EQ(q[2], 2 * p[2] - 1);
}

TEST(Affine, KnowsThePapersMaps) {
  Mesh unit;
  unit.positions = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  unit.faceVertices = {0, 1, 2};
  unit.precision = Precision::float64;
  const auto expectImages = [&](const char* name, const std::vector<double>& images) {
    SCOPED_TRACE(name);
    const Mesh moved = affine(unit, *paperAffine(name));
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(moved.positions[i], images[i], 1e-12) << i;
  };
  const double h = std::sqrt(0.5);
  expectImages("S", {0.5, 0, 0, 0, 0.5, 0, 0, 0, 0.5});
  expectImages("NS", {0.5, 0, 0, 0, 1.5, 0, 0, 0, 2});
  expectImages("RE", {-1, 0, 0, 0, 1, 0, 0, 0, 1});
  expectImages("SH", {1, 0, 0, 1.5, 1, 0, 0, 0, 1});
  expectImages("R", {h, 0, -h, 0.5, h, 0.5, 0.5, -h, 0.5});  // x -> x, then y: x goes towards -z
  Mesh step = unit;
  for (const char* name : {"R", "NS", "RE", "S", "SH"}) step = affine(step, *paperAffine(name));
  expectImages("CB", step.positions);
  EXPECT_EQ(paperAffine("XY").error().code, ErrorCode::badOption);
}

TEST(Affine, PreservesRatiosOnALine) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 3, 1, -2, 0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) mesh.positions[6 + i] = 0.3 * mesh.positions[3 + i];
  mesh.faceVertices = {0, 1, 2};
  mesh.precision = Precision::float64;
  const Mesh moved = affine(mesh, *paperAffine("CB"));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(moved.positions[6 + i] - moved.positions[i], 0.3 * (moved.positions[3 + i] - moved.positions[i]),
                1e-14);
}

TEST(Reorder, IsAPermutationOfTheSameSurface) {
  for (const Named& model : variedMeshes()) {
    SCOPED_TRACE(model.name);
    VertexOrigin origin;
    const Mesh mixed = reorder(model.mesh, 7, &origin);
    ASSERT_EQ(origin.size(), model.mesh.vertexCount());
    for (std::size_t v = 0; v < origin.size(); ++v) ASSERT_EQ(positionOf(mixed, v), positionOf(model.mesh, origin[v]));
    EXPECT_EQ(std::set<std::uint32_t>(origin.begin(), origin.end()).size(), origin.size());
    EXPECT_EQ(surfaceOf(mixed), surfaceOf(model.mesh));
    EXPECT_NE(mixed.faceVertices, model.mesh.faceVertices);
    EXPECT_NE(contentHash(reorder(model.mesh, 8)), contentHash(mixed));
  }
}

TEST(Crop, RemovesTheShareOnOneSide) {
  const Mesh mesh = sculpture(3000);
  for (int axis : {0, 1, 2}) {
    VertexOrigin origin;
    const Mesh half = crop(mesh, 0.4, axis, 1, &origin);
    EXPECT_NEAR(static_cast<double>(half.vertexCount()), 0.6 * static_cast<double>(mesh.vertexCount()), 1);
    EXPECT_LT(half.faceCount(), mesh.faceCount() * 6 / 10);
    std::vector<std::uint8_t> kept(mesh.vertexCount(), 0);
    for (std::size_t v = 0; v < origin.size(); ++v) {
      kept[origin[v]] = 1;
      ASSERT_EQ(positionOf(half, v), positionOf(mesh, origin[v]));
    }
    double highestRemoved = -1e9, lowestKept = 1e9;
    for (std::size_t v = 0; v < kept.size(); ++v) {
      const double x = mesh.positions[3 * v + static_cast<std::size_t>(axis)];
      (kept[v] ? lowestKept = std::min(lowestKept, x) : highestRemoved = std::max(highestRemoved, x));
    }
    EXPECT_LE(highestRemoved, lowestKept);
  }
}

TEST(Crop, KeepsAllFacesBetweenSurvivors) {
  const Mesh grid = flatGrid(6, 6), rest = crop(grid, 0.5, 1);
  EXPECT_EQ(rest.vertexCount(), 18u);
  EXPECT_EQ(rest.faceCount(), 2u * 5 * 2);
  EXPECT_EQ(crop(grid, 0, 1).faceVertices, grid.faceVertices);
  EXPECT_EQ(crop(grid, 1, 1).vertexCount(), 0u);
  const Mesh polygons = crop(polygonMix(1), 0.3, 0);
  EXPECT_EQ(polygons.faceOffsets.back(), polygons.faceVertices.size());
  EXPECT_TRUE(validate(polygons).ok());
}

TEST(Crop, DoesNotDependOnVertexOrder) {
  const Mesh mesh = machinedPart(2000);
  EXPECT_EQ(surfaceOf(crop(mesh, 0.37, 2)), surfaceOf(crop(reorder(mesh, 3), 0.37, 2)));
  EXPECT_EQ(surfaceOf(crop(mesh, 0.37, 3, 9)), surfaceOf(crop(reorder(mesh, 3), 0.37, 3, 9)));
  EXPECT_NE(surfaceOf(crop(mesh, 0.37, 3, 9)), surfaceOf(crop(mesh, 0.37, 3, 10)));
}

TEST(Noise, StaysWithinItsAmplitudeAndFillsIt) {
  Mesh mesh = sculpture(3000);
  mesh.precision = Precision::float64;
  const double limit = 0.01 * boundingDiagonal(mesh);
  const Mesh moved = noise(mesh, 0.01, 4);
  double largest = 0, squares = 0, sum = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double d = moved.positions[i] - mesh.positions[i];
    largest = std::max(largest, std::fabs(d));
    squares += d * d;
    sum += d;
  }
  const auto count = static_cast<double>(mesh.positions.size());
  EXPECT_LE(largest, limit * (1 + 1e-12));
  EXPECT_GT(largest, 0.99 * limit);
  EXPECT_NEAR(std::sqrt(squares / count), limit / std::sqrt(3.0), 0.02 * limit);
  EXPECT_NEAR(sum / count, 0, 0.03 * limit);
}

TEST(Noise, LeavesUnusedVerticesWhereTheyAre) {
  Mesh mesh = cube();
  mesh.positions.insert(mesh.positions.end(), {7, 8, 9});
  EXPECT_EQ(positionOf(noise(mesh, 0.1, 1), 8), (Position{7, 8, 9}));
  EXPECT_LE(std::fabs(noise(mesh, 0.1, 1).positions[0] + 1), 0.1 * std::sqrt(12.0) + 1e-6);
}

TEST(LocalNoise, MovesTheShareOnOneSideOfAPlane) {
  const Mesh mesh = sculpture(3000), moved = localNoise(mesh, 0.01, 0.3, 4);
  std::size_t changed = 0;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) changed += positionOf(mesh, v) != positionOf(moved, v);
  EXPECT_NEAR(static_cast<double>(changed), 0.3 * static_cast<double>(mesh.vertexCount()), 2);
  // One side: nearly every edge has both ends moved or neither.
  std::size_t mixed = 0, edges = 0;
  for (const auto& [edge, use] : edgeUses(mesh)) {
    mixed += (positionOf(mesh, edge.first) != positionOf(moved, edge.first)) !=
             (positionOf(mesh, edge.second) != positionOf(moved, edge.second));
    ++edges;
  }
  EXPECT_LT(static_cast<double>(mixed), 0.1 * static_cast<double>(edges));
  EXPECT_EQ(localNoise(mesh, 0.01, 0, 4).positions, mesh.positions);
}

TEST(Quantize, LandsOnTheGrid) {
  Mesh mesh = sculpture(2000);
  mesh.precision = Precision::float64;
  double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], mesh.positions[i]);
    high[i % 3] = std::max(high[i % 3], mesh.positions[i]);
  }
  const double longest = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  for (Grid grid : {Grid::common, Grid::perAxis}) {
    const Mesh rounded = quantize(mesh, 8, grid);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const double step = (grid == Grid::common ? longest : high[i % 3] - low[i % 3]) / 255;
      const double level = (rounded.positions[i] - low[i % 3]) / step;
      ASSERT_NEAR(level, std::floor(level + 0.5), 1e-9);
      ASSERT_LE(std::fabs(rounded.positions[i] - mesh.positions[i]), 0.5 * step * (1 + 1e-9));
    }
    EXPECT_EQ(quantize(rounded, 8, grid).positions.size(), rounded.positions.size());
  }
  std::set<double> levels;
  const Mesh coarse = quantize(mesh, 1, Grid::perAxis);
  for (std::size_t i = 0; i < coarse.positions.size(); i += 3) levels.insert(coarse.positions[i]);
  EXPECT_EQ(levels.size(), 2u);
}

TEST(Quantize, LeavesAFlatAxisAlone) {
  const Mesh flat = flatGrid(5, 5);
  EXPECT_EQ(quantize(flat, 2, Grid::perAxis).positions, quantize(flat, 2, Grid::common).positions);
  for (std::size_t v = 0; v < flat.vertexCount(); ++v)
    EXPECT_EQ(quantize(flat, 3, Grid::perAxis).positions[3 * v + 2], 0);
}

TEST(Smooth, MovesTowardsTheMeanOfTheNeighbours) {
  Mesh grid = flatGrid(3, 3);
  grid.positions[3 * 4 + 2] = 1;  // a peak in the middle; its neighbours are the border
  EXPECT_EQ(positionOf(smoothLaplacian(grid, 0.25, 1), 4), (Position{1, 1, 0.75}));
  const Mesh done = smoothLaplacian(grid, 0.25, 2);
  EXPECT_EQ(done.positions[3 * 4 + 2], 0.5625);
  for (std::size_t v : {0u, 1u, 2u, 3u, 5u, 6u, 7u, 8u}) EXPECT_EQ(positionOf(done, v), positionOf(grid, v)) << v;
  EXPECT_EQ(smoothLaplacian(grid, 0.25, 0).positions, grid.positions);
  // Taubin: 0.75 of the height after lambda; mu = -0.25 / 0.975 brings back a share of it.
  Mesh wide = grid;
  wide.precision = Precision::float64;
  EXPECT_NEAR(smoothTaubin(wide, 0.25, 1).positions[3 * 4 + 2], 0.75 * (1 + 0.25 / 0.975), 1e-12);
}

TEST(Smooth, ShrinksBySmoothingButHardlyByTaubin) {
  const Mesh sphere = icosphere(3);
  const double volume = signedVolume(sphere);
  EXPECT_LT(signedVolume(smoothLaplacian(sphere, 0.5, 10)), 0.95 * volume);
  EXPECT_NEAR(signedVolume(smoothTaubin(sphere, 0.5, 10)), volume, 0.01 * volume);
}

TEST(Deform, LeavesTheAnchorExactly) {
  const Mesh mesh = sculpture(3000), bent = deform(mesh, 1.0, 2);
  std::size_t kept = 0;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) kept += positionOf(mesh, v) == positionOf(bent, v);
  EXPECT_GE(kept, mesh.vertexCount() / 2);
  EXPECT_LT(kept, mesh.vertexCount() * 6 / 10);
  EXPECT_EQ(deform(mesh, 0, 2).positions, mesh.positions);
  EXPECT_NE(deform(mesh, 1.0, 3).positions, bent.positions);
}

TEST(Deform, IsSmooth) {
  const Mesh mesh = sculpture(20000), bent = deform(mesh, 0.5, 2);
  double worst = 0;
  for (const auto& [edge, use] : edgeUses(mesh)) {
    double before = 0, after = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double d =
          mesh.positions[3 * std::size_t{edge.first} + axis] - mesh.positions[3 * std::size_t{edge.second} + axis];
      const double e =
          bent.positions[3 * std::size_t{edge.first} + axis] - bent.positions[3 * std::size_t{edge.second} + axis];
      before += d * d;
      after += e * e;
    }
    worst = std::max(worst, std::fabs(std::sqrt(after / before) - 1));
  }
  EXPECT_LT(worst, 1.0);  // no edge torn
}

TEST(Attack, RefusesWhatMakesNoSense) {
  const Mesh mesh = cube();
  const auto expectRefusal = [&](const AttackSpec& spec, const std::string& part) {
    SCOPED_TRACE(part);
    const Result<Mesh> result = attack(mesh, spec);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::badOption);
    EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
  };
  expectRefusal({"melt"}, "attack \"melt\" is not one of affine, reorder");
  expectRefusal({"affine", 0, "Q"}, "affine attack \"Q\"");
  expectRefusal({"crop", 1.5}, "amount 1.5 is outside 0..1");
  expectRefusal({"crop", 0.5, "w"}, "variant \"w\" is not one of y, x, z, random");
  expectRefusal({"noise", -0.1}, "amount -0.1");
  expectRefusal({"noise", std::nan("")}, "amount nan");
  expectRefusal({"local-noise", 2}, "amount 2");
  expectRefusal({"quantize", 0}, "1..30");
  expectRefusal({"quantize", 31}, "1..30");
  expectRefusal({"quantize", 10.5}, "whole number");
  expectRefusal({"quantize", 10, "cubic"}, "common, per-axis");
  expectRefusal({"smooth", 0.5, "taubin", 0}, "iterations 0");
  expectRefusal({"smooth", 7}, "amount 7");
  expectRefusal({"smooth", 0.5, "hc"}, "taubin, laplacian");
  expectRefusal({"simplify", -1}, "amount -1");
  expectRefusal({"simplify", 0.5, "magic"}, "meshopt, qem");
  expectRefusal({"deform", 100}, "radians");
  const Result<Mesh> nothing = attack(mesh, {"crop", 1});
  ASSERT_FALSE(nothing.ok());
  EXPECT_EQ(nothing.error().code, ErrorCode::badMesh);
}

TEST(Attack, DescribesEveryKind) {
  std::set<std::string> described, used;
  for (const AttackInfo& info : attackKinds()) {
    described.insert(info.kind);
    EXPECT_GT(info.description.size(), 10u);
  }
  for (const AttackSpec& spec : allSpecs()) used.insert(spec.kind);
  EXPECT_EQ(described, used);
}

// The same numbers natively and as wasm. A deliberate change of an attack or of sculpture() changes its number here.
TEST(Attack, IsBitEqualOnEveryPlatform) {
  std::uint64_t combined = 0;
  const Mesh mesh = sculpture(2000);
  for (const AttackSpec& spec : allSpecs())
    if (spec.variant != "meshopt") combined = combined * 31 + contentHash(*attack(mesh, spec));
  EXPECT_EQ(combined, 0xb0ce27b01a8f7b7cu);
  EXPECT_EQ(contentHash(simplifyMeshopt(mesh, 0.6)), 0x0c69644568b494d5u);
}

}  // namespace
}  // namespace quadmark
