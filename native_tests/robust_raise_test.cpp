// SPDX-License-Identifier: MIT
// Cells that are raised out of a simplifier's way.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "robust/raise_cells.h"
#include "robust/surface.h"

namespace quadmark::robust {
namespace {

// Diamonds with whole rings between them.
std::vector<WrittenCell> scatteredCells(const Surface& surface, std::size_t count) {
  std::vector<std::uint8_t> taken(surface.vertexCount(), 0);
  std::vector<WrittenCell> out;
  for (const Diamond& q : collectDiamonds(surface)) {
    const std::uint32_t vertex[] = {q.a, q.b, q.c, q.d};
    const bool isFree = std::none_of(std::begin(vertex), std::end(vertex), [&](auto v) { return taken[v] != 0; });
    if (out.size() == count || !isFree) continue;
    for (const std::uint32_t v : vertex)
      for (const std::uint32_t near : surface.ring(v)) {
        taken[near] = 1;
        for (const std::uint32_t w : surface.ring(near)) taken[w] = 1;
      }
    out.push_back({q, 0, 0});
  }
  return out;
}

// How many cells are whole after what `gltf-transform optimize` does.
std::size_t survivors(Mesh mesh, const Surface& surface, const std::vector<WrittenCell>& cells,
                      const std::vector<double>& positions) {
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    for (std::size_t k = 0; k < 3; ++k) mesh.positions[3 * v + k] = positions[3 * surface.welded.weldedOf[v] + k];
  lab::VertexOrigin origin;
  static_cast<void>(lab::simplifyMeshopt(mesh, 0, &origin, 1e-4));
  std::set<std::uint32_t> kept;
  for (const std::uint32_t v : origin) kept.insert(surface.welded.weldedOf[v]);
  return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), [&](const WrittenCell& cell) {
    const Diamond& q = cell.diamond;
    return kept.count(q.a) + kept.count(q.b) + kept.count(q.c) + kept.count(q.d) == 4;
  }));
}

TEST(RobustRaise, MakesCellsOutlastASimplifierAsTheyAre) {
  const Mesh mesh = lab::icosphere(6);
  const Surface surface = makeSurface(mesh);
  const FacesAround facesAround(surface);
  const ChangeMeter change(surface, facesAround);
  const std::vector<double>& original = surface.welded.positions;
  const std::vector<WrittenCell> cells = scatteredCells(surface, 100);
  ASSERT_EQ(cells.size(), 100u);
  EXPECT_LT(survivors(mesh, surface, cells, original), 10u);

  std::vector<double> positions = original;
  raiseCells(surface, facesAround, cells, 70, {}, 0, change, positions);
  std::size_t raised = 0;
  for (const WrittenCell& cell : cells) {
    DiamondShape before, after;
    ASSERT_TRUE(diamondShape(original, cell.diamond, before) && diamondShape(positions, cell.diamond, after));
    EXPECT_NEAR(after.alongEdge, before.alongEdge, 1e-9);
    EXPECT_NEAR(after.alongSpan, before.alongSpan, 1e-9);
    EXPECT_NEAR(after.gapLength, before.gapLength, 1e-12);
    const double height = length(at(positions, cell.diamond.a) - at(original, cell.diamond.a));
    EXPECT_LT(height, 1e-3 * largestExtent(original));
    raised += height > 0;
  }
  EXPECT_EQ(raised, 70u) << "those wanted, as none stood before";
  EXPECT_GT(survivors(mesh, surface, cells, positions), 35u) << "half of them, as faces around change, too";

  std::vector<double> again = positions;
  raiseCells(surface, facesAround, cells, 70, {}, 0, change, again);
  EXPECT_EQ(again, positions) << "those that stand count";
}

TEST(RobustRaise, KeepsPlanesAndLimits) {
  const Mesh mesh = lab::icosphere(6);
  Mesh plane = lab::bumpyGrid(60, 60, 1);  // slanted, so that no coordinate is exact
  for (std::size_t v = 0; v < plane.vertexCount(); ++v)
    plane.positions[3 * v + 2] = 0.3 * plane.positions[3 * v] + 0.7 * plane.positions[3 * v + 1];
  roundToPrecision(plane);
  const Mesh coarse = lab::quantize(plane, 12, lab::Grid::common);
  const auto unmoved = [](const Mesh& of, const DiamondLimits& limits, double grain = 0) {
    const Surface surface = makeSurface(of);
    const FacesAround facesAround(surface);
    const ChangeMeter change(surface, facesAround);
    std::vector<double> positions = surface.welded.positions;
    raiseCells(surface, facesAround, scatteredCells(surface, 20), 20, limits, grain, change, positions);
    return positions == surface.welded.positions;
  };
  EXPECT_FALSE(unmoved(mesh, {}));
  EXPECT_TRUE(unmoved(plane, {}));
  EXPECT_FALSE(unmoved(coarse, {})) << "steps of a grid look like a rough surface";
  EXPECT_TRUE(unmoved(coarse, {}, largestExtent(coarse.positions) / 4095));
  EXPECT_TRUE(unmoved(mesh, {.maxMove = 1e-5}));
  EXPECT_TRUE(unmoved(mesh, {.turnCosine = 0.999999})) << "faces would turn by more than .08 degrees";
  EXPECT_TRUE(unmoved(mesh, {.maxSlide = 1e-7}));
}

// Every plane of a part, also beside fillets and bores whose cells are raised.
TEST(RobustRaise, PlanesOfPartsStayPlanes) {
  const Mesh mesh = lab::machinedPart(12000, 2);
  const Surface surface = makeSurface(mesh);
  const FacesAround facesAround(surface);
  const ChangeMeter change(surface, facesAround);
  std::vector<double> positions = surface.welded.positions;
  raiseCells(surface, facesAround, scatteredCells(surface, 400), 400, {}, 0, change, positions);
  std::size_t raised = 0, flat = 0;
  for (std::uint32_t v = 0; v < surface.vertexCount(); ++v) {
    const double height = length(at(positions, v) - at(surface.welded.positions, v));
    raised += height > 0;
    double bend = 0;
    for (const std::uint32_t f : facesAround.of(v))
      bend = std::max(bend, length(normalized(areaVector(surface.face(f), surface.welded.positions)) - change.normal(v)));
    if (bend > 1e-3) continue;
    ++flat;
    EXPECT_EQ(height, 0) << "vertex " << v;
  }
  EXPECT_GT(raised, 40u);
  EXPECT_GT(flat, 5000u);
}

}  // namespace
}  // namespace quadmark::robust
