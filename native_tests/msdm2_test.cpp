// SPDX-License-Identifier: MIT
// The curvature and the visual distortion of bench/distortion, by what their papers say of them.
#include "msdm2.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "curvature.h"
#include "measures.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/metrics.h"
#include "quadmark/random.h"

namespace quadmark {
namespace {

using namespace lab;

using bench::msdm2;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

bench::SurfaceGraph graphOf(const Mesh& mesh) {
  return bench::surfaceGraph(mesh, weld(mesh));
}

Mesh scaled(Mesh mesh, double factor, double shift) {
  for (double& x : mesh.positions) x = factor * x + shift;
  mesh.precision = Precision::float64;
  return mesh;
}

TEST(Curvature, IsTheReciprocalRadiusOnSpheres) {
  for (const double radius : {1.0, 4.0}) {
    const Mesh sphere = scaled(icosphere(4), radius, 0);
    EXPECT_NEAR(median(bench::meanCurvature(graphOf(sphere), 0.3 * radius)), 1 / radius, 0.05 / radius);
  }
}

// A tube is bent in one direction only: half of what a sphere has.
TEST(Curvature, IsHalfTheReciprocalRadiusOnTubes) {
  Mesh tube = bumpyGrid(200, 40, 1);
  for (std::size_t v = 0; v < tube.vertexCount(); ++v) {
    const double angle = 3 * static_cast<double>(v % 200) / 199, along = static_cast<double>(v / 200) * 3 / 199;
    tube.positions[3 * v] = 2 * std::cos(angle);
    tube.positions[3 * v + 1] = 2 * std::sin(angle);
    tube.positions[3 * v + 2] = 2 * along;
  }
  tube.precision = Precision::float64;
  EXPECT_NEAR(median(bench::meanCurvature(graphOf(tube), 0.2)), 0.25, 0.02);
}

TEST(Curvature, VanishesOnPlanes) {
  for (const double k : bench::meanCurvature(graphOf(flatGrid(20, 20)), 3)) EXPECT_EQ(k, 0);
}

TEST(Curvature, DoesNotDependOnTheSenseInWhichAllFacesWind) {
  const Mesh mesh = sculpture(1500);
  Mesh turned = mesh;
  for (std::size_t f = 0; f < turned.faceCount(); ++f)
    std::swap(turned.faceVertices[3 * f], turned.faceVertices[3 * f + 1]);
  const std::vector<double> before = bench::meanCurvature(graphOf(mesh), 0.2);
  const std::vector<double> after = bench::meanCurvature(graphOf(turned), 0.2);
  ASSERT_EQ(before.size(), after.size());
  // Corners were exchanged, so vertices are met, and numbered, in another order.
  std::vector<double> a = before, b = after;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  for (std::size_t v = 0; v < a.size(); ++v) EXPECT_NEAR(a[v], b[v], 1e-9);
}

TEST(Msdm2, IsNothingForEqualMeshes) {
  for (const Mesh& mesh : {sculpture(2000), machinedPart(2000), polygonMix(1), nonManifold(), seamed(1), cube()})
    EXPECT_NEAR(msdm2(mesh, mesh), 0, 1e-12);
}

// Its paper: the value lies in 0 .. 1.
TEST(Msdm2, StaysBelowOneForWhatHasLittleInCommon) {
  const double far = msdm2(sculpture(2000), noise(sculpture(2000), 0.02, 1));
  EXPECT_GT(far, 0.3);
  EXPECT_LT(far, 1);
}

TEST(Msdm2, IsTheSameBothWays) {
  const Mesh before = sculpture(3000), after = noise(before, 1e-3, 1);
  EXPECT_DOUBLE_EQ(msdm2(before, after), msdm2(after, before));
}

TEST(Msdm2, DoesNotDependOnPlaceAndSize) {
  const Mesh before = sculpture(3000), after = noise(before, 1e-3, 1);
  EXPECT_NEAR(msdm2(scaled(before, 12, 3), scaled(after, 12, 3)), msdm2(before, after), 1e-6);
}

// Both meshes turned by 90 degrees, so that the bounding box stays as long.
TEST(Msdm2, DoesNotDependOnRotation) {
  const Mesh before = sculpture(3000), after = noise(before, 1e-3, 1);
  const Affine turn = {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0};
  EXPECT_NEAR(msdm2(affine(before, turn), affine(after, turn)), msdm2(before, after), 1e-6);
}

TEST(Msdm2, DoesNotDependOnTheOrderOfVerticesAndFaces) {
  const Mesh before = sculpture(3000), after = noise(before, 1e-3, 1);
  EXPECT_NEAR(msdm2(before, reorder(after, 5)), msdm2(before, after), 1e-9);
  EXPECT_NEAR(msdm2(before, reorder(before, 5)), 0, 1e-9);
}

// A mesh that another triangulation represents without any change of shape looks the same: what MSDM2 brought.
TEST(Msdm2, ComparesMeshesOfDifferentConnectivity) {
  const Mesh before = sculpture(6000);
  const double simplified = msdm2(before, simplifyQem(before, 0.9)), rough = msdm2(before, noise(before, 2e-3, 1));
  EXPECT_GT(simplified, 0);
  EXPECT_LT(simplified, rough);
}

TEST(Msdm2, GrowsWithNoise) {
  const Mesh before = sculpture(4000);
  double last = 0;
  for (const double amplitude : {1e-4, 3e-4, 1e-3, 3e-3}) {
    const double value = msdm2(before, noise(before, amplitude, 1));
    EXPECT_GT(value, last) << amplitude;
    last = value;
  }
}

TEST(Msdm2, GrowsWithSmoothingAndWithCoarserGrids) {
  const Mesh before = sculpture(4000);
  EXPECT_LT(msdm2(before, smoothLaplacian(before, 0.1, 2)), msdm2(before, smoothLaplacian(before, 0.1, 20)));
  EXPECT_LT(msdm2(before, quantize(before, 12, Grid::common)), msdm2(before, quantize(before, 9, Grid::common)));
}

// Visual masking, the reason for structural measures (section 4 of the paper): noise shows less on a rough surface than
// on a smooth one, while the root mean square error is the same.
TEST(Msdm2, CountsNoiseOnSmoothSurfacesMore) {
  const auto relief = [](double height) {
    Mesh mesh = flatGrid(70, 70);
    mesh.precision = Precision::float64;
    Random random(3);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
      const double x = mesh.positions[3 * v], y = mesh.positions[3 * v + 1];
      mesh.positions[3 * v + 2] = 4 * std::sin(x / 25) * std::sin(y / 25) + height * (2 * random.uniform() - 1);
    }
    return mesh;
  };
  const auto disturbed = [](Mesh mesh) {
    Random random(8);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) mesh.positions[3 * v + 2] += 0.1 * (2 * random.uniform() - 1);
    return mesh;
  };
  const Mesh smooth = relief(0), rough = relief(0.5);
  const double onSmooth = msdm2(smooth, disturbed(smooth)), onRough = msdm2(rough, disturbed(rough));
  EXPECT_GT(onSmooth, 1.5 * onRough);
}

// Moving the whole surface smoothly changes distances a lot and its look hardly: the argument of the paper's
// introduction against the root mean square error.
TEST(Msdm2, CountsASmoothDeformationLessThanNoiseOfASmallerError) {
  const Mesh before = sculpture(4000), bent = deform(before, 0.03, 1), rough = noise(before, 2e-3, 1);
  EXPECT_GT(distortion(before, bent).rmsRel, distortion(before, rough).rmsRel);
  EXPECT_LT(msdm2(before, bent), 0.5 * msdm2(before, rough));
}

TEST(Measures, AgreeWithTheCoreAndAreNothingForEqualMeshes) {
  const Mesh before = sculpture(2000), after = noise(before, 1e-3, 1);
  const bench::Measures none = bench::measure(before, before.positions), some = bench::measure(before, after.positions);
  EXPECT_EQ(none.rmsRel + none.hausdorffRel + none.maxRel + none.normalsDeg, 0);
  EXPECT_TRUE(std::isinf(none.snrDb) && std::isinf(none.psnrDb));
  const Distortion d = distortion(before, after);
  EXPECT_EQ(some.snrDb, d.snrDb);
  EXPECT_EQ(some.psnrDb, d.normalPsnrDb);
  EXPECT_GT(some.rmsRel, 0);
  // Surfaces are nearer than their vertices, which also slide.
  EXPECT_LT(some.rmsRel, d.rmsRel);
  EXPECT_LE(some.rmsRel, some.hausdorffRel);
}

}  // namespace
}  // namespace quadmark
