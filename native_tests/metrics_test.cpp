// SPDX-License-Identifier: MIT
#include "quadmark/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh_checks.h"
#include "point_triangle.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"

namespace quadmark {
namespace {

using namespace lab;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Mesh translated(Mesh mesh, double x, double y, double z) {
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    mesh.positions[3 * v] += x;
    mesh.positions[3 * v + 1] += y;
    mesh.positions[3 * v + 2] += z;
  }
  return mesh;
}

TEST(Distortion, IsNothingForEqualMeshes) {
  const Mesh mesh = bumpyGrid(10, 10, 1);
  const Distortion d = distortion(mesh, mesh);
  EXPECT_EQ(d.snrDb, kInfinity);
  EXPECT_EQ(d.normalPsnrDb, kInfinity);
  EXPECT_EQ(d.rmsRel, 0);
  EXPECT_EQ(d.maxRel, 0);
  EXPECT_EQ(d.hausdorffRel, 0);
  EXPECT_EQ(d.meanNormalDeg, 0);
}

TEST(Distortion, MatchesTheCubeComputedByHand) {
  Mesh moved = cube();
  moved.positions[0] += 0.1;
  const Distortion d = distortion(cube(), moved);
  const double diagonal = std::sqrt(12.0);
  EXPECT_NEAR(d.snrDb, 10 * std::log10(24 / 0.01), 1e-9);
  EXPECT_NEAR(d.rmsRel, std::sqrt(0.01 / 8) / diagonal, 1e-12);
  EXPECT_NEAR(d.maxRel, 0.1 / diagonal, 1e-12);
}

TEST(Distortion, IgnoresVerticesNoFaceUses) {
  Mesh mesh = cube();
  mesh.positions.insert(mesh.positions.end(), {100, 200, 300});
  Mesh moved = mesh;
  moved.positions[0] += 0.1;
  moved.positions[24] += 50;
  const Distortion d = distortion(mesh, moved);
  EXPECT_NEAR(d.snrDb, 10 * std::log10(24 / 0.01), 1e-9);
  EXPECT_NEAR(d.maxRel, 0.1 / std::sqrt(12.0), 1e-12);
}

TEST(Distortion, MeasuresTheAngleOfATiltedPlane) {
  const Mesh flat = flatGrid(4, 4);
  Mesh tilted = flat;
  const double angle = 30 * 3.14159265358979323846 / 180;
  for (std::size_t v = 0; v < flat.vertexCount(); ++v) {
    tilted.positions[3 * v + 1] = flat.positions[3 * v + 1] * std::cos(angle);
    tilted.positions[3 * v + 2] = flat.positions[3 * v + 1] * std::sin(angle);
  }
  const Distortion d = distortion(flat, tilted);
  EXPECT_NEAR(d.meanNormalDeg, 30, 1e-9);
  EXPECT_NEAR(d.normalPsnrDb, 20 * std::log10(6), 1e-9);
}

TEST(Distortion, WeighsNormalsByArea) {
  // At vertex 0 two right triangles of area 1/2 and 2 meet at a right angle; the second one is then folded flat.
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -2, 0, 0, 0, 2};
  mesh.faceVertices = {0, 1, 2, 0, 3, 4};
  Mesh folded = mesh;
  folded.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -2, 0, -2, 0, 0};
  const Distortion d = distortion(mesh, folded);
  // Twice the areas, before: (0, 0, 1) + (-4, 0, 0); after: (0, 0, 1) + (0, 0, -4). Vertices 3, 4 turn by 90 degrees.
  const double atOrigin = std::acos(-1 / std::sqrt(17.0)) * 180 / 3.14159265358979323846;
  EXPECT_NEAR(d.meanNormalDeg, (atOrigin + 90 + 90) / 5, 1e-9);
}

TEST(Distortion, HandlesMeshesWithoutFaces) {
  Mesh empty;
  empty.positions = {1, 2, 3};
  const Distortion d = distortion(empty, empty);
  EXPECT_EQ(d.snrDb, kInfinity);
  EXPECT_EQ(d.rmsRel, 0);
}

TEST(HausdorffLocal, IsTheOffsetOfParallelPlanes) {
  EXPECT_DOUBLE_EQ(hausdorffLocal(flatGrid(6, 5), translated(flatGrid(6, 5), 0, 0, 0.5)), 0.5);
}

TEST(HausdorffLocal, IsZeroForSlidingInThePlane) {
  Mesh moved = flatGrid(5, 5);
  moved.positions[3 * 12] += 0.25;
  moved.positions[3 * 12 + 1] -= 0.125;
  EXPECT_EQ(hausdorffLocal(flatGrid(5, 5), moved), 0);
}

TEST(HausdorffLocal, BoundsTheGlobalDistanceOnTheSameSamples) {
  for (const Mesh& mesh : {bumpyGrid(20, 20, 4), sculpture(1500), polygonMix(2)}) {
    const Mesh moved = noise(mesh, 1e-3, 3);
    const double local = hausdorffLocal(mesh, moved), global = hausdorff(mesh, moved, 0);
    EXPECT_GE(local, global * (1 - 1e-12));
    EXPECT_LE(local, distortion(mesh, moved).maxRel * boundingDiagonal(mesh) * (1 + 1e-12));
    EXPECT_GT(global, 0);
    EXPECT_EQ(hausdorffLocal(mesh, mesh), 0);
    EXPECT_DOUBLE_EQ(local, hausdorffLocal(moved, mesh));
  }
}

TEST(Hausdorff, KnowsTheCornersOfNestedCubes) {
  Mesh outer = cube();
  for (double& x : outer.positions) x *= 1.5;
  EXPECT_NEAR(hausdorff(cube(), outer), std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(hausdorff(outer, cube()), std::sqrt(0.75), 1e-12);
}

TEST(Hausdorff, IgnoresHowASurfaceIsCutIntoFaces) {
  Mesh coarse = flatGrid(2, 2);
  for (double& x : coarse.positions) x *= 8;
  EXPECT_EQ(hausdorff(coarse, flatGrid(9, 9)), 0);
  const Mesh sphere = icosphere(3);
  EXPECT_NEAR(hausdorff(sphere, reorder(sphere, 5)), 0, 1e-15);
}

TEST(Hausdorff, SeesWhatIsMissing) {
  // Half a flat strip of length 8: its far edge is 4 away from what is left.
  EXPECT_DOUBLE_EQ(hausdorff(flatGrid(9, 2), crop(flatGrid(9, 2), 8.0 / 18, 0)), 4);
}

TEST(Hausdorff, AgreesWithBruteForce) {
  const Mesh a = bumpyGrid(14, 11, 1), b = bumpyGrid(12, 13, 2);
  const auto at = [](const Mesh& mesh, std::uint32_t v) {
    return detail::Point{mesh.positions[3 * std::size_t{v}], mesh.positions[3 * std::size_t{v} + 1],
                         mesh.positions[3 * std::size_t{v} + 2]};
  };
  const auto oneSided = [&](const Mesh& from, const Mesh& to) {
    double worst = 0;
    for (std::uint32_t v = 0; v < from.vertexCount(); ++v) {
      double best = kInfinity;
      for (std::size_t f = 0; f < to.faceCount(); ++f)
        best = std::min(
            best, detail::squaredToTriangle(at(from, v), at(to, to.faceVertices[3 * f]),
                                            at(to, to.faceVertices[3 * f + 1]), at(to, to.faceVertices[3 * f + 2])));
      worst = std::max(worst, best);
    }
    return std::sqrt(worst);
  };
  EXPECT_DOUBLE_EQ(hausdorff(a, b, 0), std::max(oneSided(a, b), oneSided(b, a)));
  EXPECT_GE(hausdorff(a, b, 8), hausdorff(a, b, 0));
}

TEST(Hausdorff, IsInfiniteAgainstNothing) {
  EXPECT_EQ(hausdorff(cube(), Mesh{}), kInfinity);
  EXPECT_EQ(hausdorff(Mesh{}, Mesh{}), 0);
}

TEST(PointTriangle, MeasuresToFaceEdgeCornerAndDegenerateTriangles) {
  const detail::Point a{0, 0, 0}, b{2, 0, 0}, c{0, 2, 0};
  EXPECT_DOUBLE_EQ(detail::squaredToTriangle({0.5, 0.5, 3}, a, b, c), 9);
  EXPECT_DOUBLE_EQ(detail::squaredToTriangle({1, -2, 0}, a, b, c), 4);
  EXPECT_DOUBLE_EQ(detail::squaredToTriangle({2, 2, 0}, a, b, c), 2);
  EXPECT_DOUBLE_EQ(detail::squaredToTriangle({-3, -4, 0}, a, b, c), 25);
  EXPECT_DOUBLE_EQ(detail::squaredToTriangle({1, 1, 0}, a, b, b), 1);
  EXPECT_DOUBLE_EQ(detail::squaredToTriangle({0, 3, 4}, a, a, a), 25);
}

TEST(BitErrorRate, CountsErasuresHalf) {
  const std::vector<std::uint8_t> expected{1, 0, 1, 0, 1, 0, 1, 0}, read{1, 0, 1, 0, 0, 0, 0, 1},
      erased{0, 0, 0, 1, 0, 0, 1, 0};
  EXPECT_EQ(bitErrorRate(expected, expected), 0);
  EXPECT_DOUBLE_EQ(bitErrorRate(expected, read), 3.0 / 8);
  EXPECT_DOUBLE_EQ(bitErrorRate(expected, read, erased), (2 + 0.5 + 0.5) / 8);
  EXPECT_EQ(bitErrorRate({}, {}), 0);
}

}  // namespace
}  // namespace quadmark
