// SPDX-License-Identifier: MIT
// The parts between a mesh and coded bits, one by one: rings, labels, frames, lattices, diamonds, constellation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/random.h"
#include "robust/carriers.h"
#include "robust/constellation.h"
#include "robust/creases.h"
#include "robust/diamonds.h"
#include "robust/distortion_budget.h"
#include "robust/far_names.h"
#include "robust/labels.h"
#include "robust/lattice.h"
#include "robust/surface.h"
#include "robust/survival.h"
#include "robust_geometry_keys.h"

namespace quadmark::robust {
namespace {

// Every face of a mesh turned over: what a tool does that bakes a mirroring transform.
Mesh turnedOver(Mesh mesh) {
  for (std::size_t f = 0; f < mesh.faceCount(); ++f)
    std::reverse(mesh.faceVertices.begin() + static_cast<std::ptrdiff_t>(mesh.faceBegin(f)),
                 mesh.faceVertices.begin() + static_cast<std::ptrdiff_t>(mesh.faceEnd(f)));
  return mesh;
}

TEST(RobustSurface, OrdersClosedFansAndLeavesBordersOut) {
  const Surface closed = makeSurface(lab::icosphere(2));
  const WeldedMesh edges = weld(lab::icosphere(2));
  for (std::uint32_t v = 0; v < closed.vertexCount(); ++v) {
    const auto ring = closed.ring(v);
    ASSERT_EQ(ring.size(), edges.neighboursOf(v).size());
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const auto around = edges.neighboursOf(ring[k]);
      const std::uint32_t next = ring[(k + 1) % ring.size()];
      EXPECT_TRUE(std::binary_search(around.begin(), around.end(), next)) << "successive ring vertices share an edge";
    }
  }
  const Surface open = makeSurface(lab::bumpyGrid(5, 4, 1));
  std::uint32_t rings = 0;
  for (std::uint32_t v = 0; v < open.vertexCount(); ++v) rings += !open.ring(v).empty();
  EXPECT_EQ(rings, 3u * 2u);
  const Surface bowTie = makeSurface(lab::nonManifold());
  for (std::uint32_t v = 0; v < bowTie.vertexCount(); ++v) EXPECT_TRUE(bowTie.ring(v).size() != 1);
}

TEST(RobustSurface, DropsDegenerateFacesAndRepeatedCorners) {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0};
  mesh.faceOffsets = {0, 4, 7, 11};
  mesh.faceVertices = {0, 1, 4, 2, 0, 1, 4, 0, 1, 2, 3};  // a quad with twins, a triangle that is a line, a quad
  const Surface surface = makeSurface(mesh);
  ASSERT_EQ(surface.faceCount(), 2u);
  EXPECT_EQ(surface.face(0).size(), 3u);
  EXPECT_EQ(surface.face(1).size(), 4u);
}

TEST(RobustSurface, SharpeningUndoesSmoothing) {
  const Mesh mesh = lab::sculpture(2000);
  const Mesh smooth = lab::smoothLaplacian(mesh, 0.03, 3);
  const std::vector<double> back = sharpened(makeSurface(smooth), 0.09);
  double before = 0, after = 0;
  for (std::size_t i = 0; i < back.size(); ++i) {
    before += std::fabs(smooth.positions[i] - mesh.positions[i]);
    after += std::fabs(back[i] - mesh.positions[i]);
  }
  EXPECT_LT(after, 0.15 * before);
}

TEST(RobustLabels, DependOnConnectivityAlone) {
  const Mesh mesh = lab::sculpture(3000);
  lab::VertexOrigin origin;
  const Mesh shuffled = turnedOver(lab::reorder(lab::noise(mesh, 1e-3, 1), 9, &origin));
  const Surface a = makeSurface(mesh);
  Surface b = makeSurface(shuffled);
  const Labels la = refineLabels(a), other = refineLabels(b);
  std::uint32_t same = 0;
  for (std::uint32_t v = 0; v < shuffled.vertexCount(); ++v)
    same += other.label[b.welded.weldedOf[v]] == la.label[a.welded.weldedOf[origin[v]]] ? 1 : 0;
  EXPECT_LT(same, a.vertexCount() / 20) << "the winding is part of the connectivity";
  turnOver(b);
  const Labels lb = refineLabels(b);
  std::set<std::uint64_t> distinct;
  for (std::uint32_t v = 0; v < shuffled.vertexCount(); ++v) {
    EXPECT_EQ(lb.label[b.welded.weldedOf[v]], la.label[a.welded.weldedOf[origin[v]]]);
    distinct.insert(lb.label[v]);
  }
  EXPECT_GT(distinct.size(), a.vertexCount() / 2) << "irregular connectivity tells most vertices apart";
}

TEST(RobustLabels, NameRegularGridsFromAfar) {
  const Mesh mesh = lab::bumpyGrid(40, 30, 1);
  lab::VertexOrigin origin;
  const Mesh shuffled = lab::reorder(mesh, 3, &origin);
  const Surface a = makeSurface(mesh), b = makeSurface(shuffled);
  const std::vector<std::uint64_t> names = farNames(a), again = farNames(b);
  ASSERT_EQ(names.size(), a.vertexCount());
  for (std::uint32_t v = 0; v < shuffled.vertexCount(); ++v)
    EXPECT_EQ(again[b.welded.weldedOf[v]], names[a.welded.weldedOf[origin[v]]]);
  const Carriers carriers = selectCarriers(a, Prf(keysOf(1).select));
  EXPECT_GT(carriers.count(), a.vertexCount() / 12);
  std::set<std::uint64_t> labels(carriers.label.begin(), carriers.label.end());
  EXPECT_GT(labels.size(), carriers.count() / 4u) << "a grid repeats a name only where it is symmetric";
  EXPECT_TRUE(farNames(makeSurface(lab::sculpture(2000))).empty()) << "irregular meshes need none";
}

TEST(RobustLabels, OutlastVerticesThatBecomeOne) {
  const int columns = 70;
  const Mesh mesh = lab::bumpyGrid(columns, 60, 1);
  const Surface before = makeSurface(mesh);
  Mesh merged = mesh;
  for (const std::uint32_t v : {columns * 20 + 30, columns * 40 + 12, columns * 33 + 50})
    for (std::uint32_t k = 0; k < 3; ++k) merged.positions[3 * v + k] = merged.positions[3 * (v + 1) + k];
  const Surface after = makeSurface(merged);
  ASSERT_EQ(after.vertexCount() + 3, before.vertexCount());
  const std::vector<std::uint64_t> names = farNames(before), left = farNames(after);
  std::uint32_t same = 0;
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
    same += names[before.welded.weldedOf[v]] == left[after.welded.weldedOf[v]];
  // Ways that lead over them are a step shorter; everything else is as far from the corners as before.
  EXPECT_GT(same, mesh.vertexCount() / 2);
}

TEST(RobustLabels, NameComponentsWithoutALoneIrregularVertex) {
  Mesh both = lab::quadSphere(5);
  const auto first = static_cast<std::uint32_t>(both.vertexCount());
  const Mesh cube = lab::cube();  // all corners irregular, and neighbours
  both.positions.insert(both.positions.end(), cube.positions.begin(), cube.positions.end());
  for (std::size_t i = 3 * std::size_t{first}; i < both.positions.size(); ++i) both.positions[i] += 10;
  for (std::size_t f = 0; f < cube.faceCount(); ++f) {
    for (std::size_t c = cube.faceBegin(f); c < cube.faceEnd(f); ++c) both.faceVertices.push_back(first + cube.faceVertices[c]);
    both.faceOffsets.push_back(static_cast<std::uint32_t>(both.faceVertices.size()));
  }
  const Surface surface = makeSurface(both);
  const std::vector<std::uint64_t> names = farNames(surface), alone = farNames(makeSurface(lab::quadSphere(5)));
  ASSERT_EQ(names.size(), alone.size() + 8);
  for (std::uint32_t v = 0; v < first; ++v) EXPECT_EQ(names[surface.welded.weldedOf[v]], alone[v]);
  for (std::uint32_t v = first; v < both.vertexCount(); ++v) {
    std::uint64_t nothingNear = surface.cornerCounts[surface.welded.weldedOf[v]];
    for (int k = 0; k < 3; ++k) nothingNear = Random::mix(nothingNear * 0x9e3779b97f4a7c15u);
    EXPECT_NE(names[surface.welded.weldedOf[v]], nothingNear);
  }
}

TEST(RobustSurvival, PrefersWhatSimplifiersKeep) {
  const Mesh mesh = lab::sculpture(6000);
  const Surface surface = makeSurface(mesh);
  const Survival survival(surface, surface.welded.positions);
  lab::VertexOrigin origin;
  static_cast<void>(lab::simplifyMeshopt(mesh, 0.6, &origin));
  std::set<std::uint32_t> kept;
  for (const std::uint32_t v : origin) kept.insert(surface.welded.weldedOf[v]);
  double survivors[2] = {0, 0}, all[2] = {0, 0};
  for (const Diamond& q : collectDiamonds(surface)) {
    const int eager = survival.reluctance(q) == 1;
    all[eager] += 1;
    survivors[eager] += kept.count(q.a) + kept.count(q.b) + kept.count(q.c) + kept.count(q.d) == 4;
  }
  EXPECT_GT(survivors[1] / all[1], 1.5 * survivors[0] / all[0]);
}

TEST(RobustBudget, ChargesAMovedVertexWithWhatItDid) {
  const Surface surface = makeSurface(lab::flatGrid(9, 9));
  const FacesAround facesAround(surface);
  ChangeMeter change(surface, facesAround);
  std::vector<double> positions = surface.welded.positions;
  change.measure(positions);
  EXPECT_EQ(change.turns(), 0);
  EXPECT_EQ(change.squares(), 0);

  // One vertex inside, slid in the plane: nothing to see. Then lifted by a tenth of an edge.
  const std::uint32_t v = 40;
  ASSERT_EQ(surface.ring(v).size(), 6u);
  const double edge = length(at(positions, surface.ring(v)[0]) - at(positions, v));
  positions[3 * v] += 0.1 * edge;
  change.measure(positions);
  EXPECT_NEAR(change.turns(), 0, 1e-9);
  EXPECT_NEAR(change.squares(), 0, 1e-20);
  const double height = 0.1 * edge;
  positions = surface.welded.positions;
  positions[3 * v + 2] += height;
  change.measure(positions);
  EXPECT_NEAR(change.turnOf(v), change.turns(), 1e-6 * change.turns());
  EXPECT_GT(change.turns(), 6 * 0.02) << "all six neighbours turn";
  // From the lifted vertex to the plane it is the height, from its old place to the lifted faces a little less.
  EXPECT_NEAR(change.squareOf(v), change.squares(), 1e-6 * change.squares());
  EXPECT_LT(change.squares(), height * height);
  EXPECT_GT(change.squares(), 0.9 * height * height);
}

TEST(RobustBudget, GivesUpWhatCostsMostPerVote) {
  const std::vector<Expense> expenses = {{4, 1, 2}, {5, 1, 4}, {1, 1, 2}, {4, 9, 2}};
  EXPECT_EQ(expensesToDrop(expenses, 14, 12), (std::vector<std::uint8_t>{0, 0, 0, 0}));
  EXPECT_EQ(expensesToDrop(expenses, 13, 12), (std::vector<std::uint8_t>{1, 0, 0, 0})) << "ties: the first";
  EXPECT_EQ(expensesToDrop(expenses, 6, 12), (std::vector<std::uint8_t>{1, 0, 0, 1}));
  EXPECT_EQ(expensesToDrop(expenses, 14, 3), (std::vector<std::uint8_t>{0, 0, 0, 1}));
  EXPECT_EQ(expensesToDrop(expenses, 0, 0), (std::vector<std::uint8_t>{1, 1, 1, 1}));
}

TEST(RobustCarriers, AreTheSameIndependentSetInEveryOrder) {
  const Mesh mesh = lab::sculpture(3000);
  lab::VertexOrigin origin;
  const Mesh shuffled = lab::reorder(mesh, 4, &origin);
  const Surface a = makeSurface(mesh), b = makeSurface(shuffled);
  const Prf select(keysOf(1).select);
  const Carriers ca = selectCarriers(a, select), cb = selectCarriers(b, select);
  ASSERT_GT(ca.count(), a.vertexCount() / 12);
  ASSERT_EQ(ca.count(), cb.count());
  std::vector<std::uint32_t> indexInA(a.vertexCount(), kNoVertex);
  for (std::uint32_t i = 0; i < ca.count(); ++i) indexInA[ca.vertex[i]] = i;
  for (std::uint32_t i = 0; i < cb.count(); ++i) {
    const std::uint32_t j = indexInA[origin[cb.vertex[i]]];
    ASSERT_NE(j, kNoVertex);
    ASSERT_EQ(ca.ring(j).size(), cb.ring(i).size());
    for (std::size_t k = 0; k < ca.ring(j).size(); ++k) {
      EXPECT_EQ(ca.ring(j)[k], origin[cb.ring(i)[k]]) << "the canonical order is the same";
      EXPECT_EQ(indexInA[ca.ring(j)[k]], kNoVertex) << "no two carriers are neighbours";
    }
  }
}

TEST(RobustCarriers, OtherKeysSelectOthers) {
  const Surface surface = makeSurface(lab::sculpture(3000));
  const Carriers a = selectCarriers(surface, Prf(keysOf(1).select)), b = selectCarriers(surface, Prf(keysOf(2).select));
  std::vector<std::uint32_t> both;
  std::set_intersection(a.vertex.begin(), a.vertex.end(), b.vertex.begin(), b.vertex.end(), std::back_inserter(both));
  EXPECT_LT(both.size(), a.vertex.size() / 3);
}

TEST(RobustFrame, IsCovariantUnderEveryAffineMap) {
  const Mesh mesh = lab::sculpture(2000);
  for (const char* name : {"R", "NS", "RE", "SH", "CB"}) {
    SCOPED_TRACE(name);
    Mesh moved = mesh;
    moved.precision = Precision::float64;
    moved = lab::affine(moved, *lab::paperAffine(name));
    const Surface a = makeSurface(mesh), b = makeSurface(moved);
    const Carriers carriers = selectCarriers(a, Prf(keysOf(1).select));
    const SymmetricTensor ta = edgeTensor(a, a.welded.positions), tb = edgeTensor(b, b.welded.positions);
    for (std::uint32_t i = 0; i < carriers.count(); ++i) {
      RingFrame fa, fb;
      if (!ringFrame(a.welded.positions, carriers.ring(i), ta, fa)) continue;
      if (!ringFrame(b.welded.positions, carriers.ring(i), tb, fb)) continue;
      const RingCoordinates pa = coordinatesIn(fa, at(a.welded.positions, carriers.vertex[i]));
      const RingCoordinates pb = coordinatesIn(fb, at(b.welded.positions, carriers.vertex[i]));
      EXPECT_NEAR(pa.alpha, pb.alpha, 1e-9);
      EXPECT_NEAR(pa.beta, pb.beta, 1e-9);
    }
  }
}

TEST(RobustFrame, RebuildsThePointFromItsCoordinates) {
  const Surface surface = makeSurface(lab::sculpture(2000));
  const SymmetricTensor tensor = edgeTensor(surface, surface.welded.positions);
  RingFrame frame;
  ASSERT_TRUE(ringFrame(surface.welded.positions, surface.ring(7), tensor, frame));
  const Vec3 p = at(surface.welded.positions, 7), q = pointAt(frame, coordinatesIn(frame, p));
  EXPECT_NEAR(length(p - q), 0, 1e-14);
}

TEST(RobustFrame, RefusesRingsWithoutArea) {
  const std::vector<double> line = {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0};
  const std::uint32_t ring[] = {0, 1, 2, 3};
  SymmetricTensor unit;
  unit.xx = unit.yy = unit.zz = 1;
  RingFrame frame;
  EXPECT_FALSE(ringFrame(line, ring, unit, frame));
}

TEST(RobustLattice, WritesTheNearestPointAndReadsItBack) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-1, 1), offset = random.uniform();
    const bool bit = (random.next() & 1) != 0;
    const double y = nearestLatticePoint(x, 0.5, offset, phaseOf(bit ? 1 : 0, 1));
    EXPECT_LE(std::fabs(y - x), 0.25 + 1e-12);
    EXPECT_NEAR(latticeVote(y, 0.5, offset), bit ? -1 : 1, 1e-9);
    EXPECT_NEAR(latticeVote(y + 0.0625, 0.5, offset), bit ? -0.5 : 0.5, 1e-9);
  }
}

TEST(RobustLattice, NeighbouringPointsOfSeveralBitsDifferInOne) {
  Random random(4);
  for (std::uint32_t bits = 2; bits <= kMostRingBits; ++bits) {
    std::set<std::uint32_t> values;
    const std::uint32_t points = 1u << bits;
    for (std::uint32_t k = 0; k < points; ++k) {
      const std::uint32_t value = valueOfPoint(k, bits), changed = value ^ valueOfPoint((k + 1) % points, bits);
      values.insert(value);
      EXPECT_EQ(changed & (changed - 1), 0u) << "Gray: one bit";
      const double x = random.uniform(-1, 1), offset = random.uniform();
      const double y = nearestLatticePoint(x, 0.7, offset, phaseOf(value, bits));
      EXPECT_LE(std::fabs(y - x), 0.35 + 1e-12);
      for (std::uint32_t t = 0; t < bits; ++t) EXPECT_EQ(bitVote(y, 0.7, offset, t) < 0, (value >> t & 1) != 0);
    }
    EXPECT_EQ(values.size(), points);
    EXPECT_LT(*values.rbegin(), points);
  }
}

TEST(RobustCarriers, HoldMoreBitsWhereNamesAreFewAndRepeat) {
  const Prf select(keysOf(1).select);
  for (const auto& [mesh, most] : {std::pair{lab::icosphere(5), 5}, {lab::quadSphere(5), 3}, {lab::quadSphere(6), 1},
                                   {lab::icosphere(6), 2}, {lab::sculpture(3000), 1}}) {
    const Carriers carriers = selectCarriers(makeSurface(mesh), select);
    std::map<std::uint64_t, std::pair<int, int>> names;  // copies, bits
    for (std::uint32_t i = 0; i < carriers.count(); ++i) {
      auto& [copies, bits] = names[carriers.label[i]];
      if (copies++ == 0) bits = carriers.bits[i];
      EXPECT_EQ(bits, carriers.bits[i]) << "carriers of one name hold as many";
    }
    int largest = 0;
    for (const auto& [label, name] : names) {
      largest = std::max(largest, name.second);
      EXPECT_TRUE(name.second == 1 || name.first >= 16);
    }
    EXPECT_EQ(largest, most) << mesh.vertexCount();
  }
}

TEST(RobustCreases, StandOutFromTheirSurface) {
  // A roof folded by a right angle, a flat pair, and a pair with a triangle that is a line.
  const std::vector<double> positions = {0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 2, 0, 0};
  const std::vector<Diamond> diamonds = {{0, 1, 3, 2}, {0, 1, 4, 2}, {5, 1, 0, 2}};
  const std::vector<float> bends = edgeBends(diamonds, positions);
  EXPECT_NEAR(bends[0], std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(bends[1], 0, 1e-6);
  EXPECT_EQ(bends[2], 0);
  const std::vector<std::uint8_t> creased = creaseVertices(6, diamonds, bends, 0.5);
  EXPECT_EQ(creased, (std::vector<std::uint8_t>{0, 1, 1, 0, 0, 0})) << "the ends of the fold";

  // Coordinates whose products overflow bend nothing, rather than being no numbers to sort.
  std::vector<double> huge = positions;
  for (double& x : huge) x *= 1e160;
  for (const float bend : edgeBends(diamonds, huge)) EXPECT_EQ(bend, 0);

  EXPECT_EQ(creaseBend(0.1, 0.4, 5), 0.4) << "a smooth surface";
  EXPECT_DOUBLE_EQ(creaseBend(kRoughBend + 0.02, 0.4, 5), 0.5) << "a rough one";
  EXPECT_EQ(creaseBend(0.9, 0.4, 5), 1) << "60 degrees at most";
  EXPECT_EQ(creaseBend(0.9, 1.2, 5), 1.2) << "unless more is allowed anyway";
}

TEST(RobustDiamonds, MeasureWhereDiagonalsMeet) {
  const std::vector<double> positions = {0, 0, 0.1, 0, 1, 0, 4, 0, 0.1, 0, -3, 0};  // a, b, c, d: a-c lies 0.1 above
  DiamondShape shape;
  ASSERT_TRUE(diamondShape({0, 0, 0.1, 1, 1, 0, 4, 0, 0.1, 1, -3, 0}, {0, 1, 2, 3}, shape));
  EXPECT_NEAR(shape.alongSpan, 0.25, 1e-12);
  EXPECT_NEAR(shape.alongEdge, 0.25, 1e-12);
  EXPECT_NEAR(shape.gapLength, 0.1, 1e-12);
  EXPECT_NEAR(shape.edgeLength, 4, 1e-12);
  EXPECT_FALSE(diamondShape(positions, {0, 1, 2, 3}, shape)) << "the diagonals meet at an end: not convex";
}

TEST(RobustDiamonds, HaveTheSameRatiosWhicheverWayTheyAreNumbered) {
  const Mesh mesh = lab::sculpture(1000);
  // Vertices by place, so that edges run from the lower to the higher number the other way about.
  const auto shapes = [](const Mesh& m) {
    const Surface surface = makeSurface(m);
    std::vector<std::pair<double, double>> out;
    DiamondShape s;
    for (const Diamond& q : collectDiamonds(surface))
      if (diamondShape(surface.welded.positions, q, s)) out.push_back({ratiosOf(s).edge, ratiosOf(s).span});
    std::sort(out.begin(), out.end());
    return out;
  };
  const auto before = shapes(mesh), after = shapes(lab::reorder(mesh, 4));
  ASSERT_EQ(before.size(), after.size());
  int upper = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(before[i].first, after[i].first, 1e-9);
    EXPECT_NEAR(before[i].second, after[i].second, 1e-9);
    EXPECT_LE(before[i].first, 0.5);
    upper += before[i].second > 0.5 ? 1 : 0;
  }
  EXPECT_NEAR(upper / static_cast<double>(before.size()), 0.5, 0.1) << "both halves of the span are in use";
}

TEST(RobustRatioPlane, CellsLieAroundTheirCentres) {
  for (const DeltaClass& shape : kDeltas) {
    EXPECT_LE(shape.least + shape.side * shape.delta, 0.5 + 1e-9);
    EXPECT_GE(shape.least + (shape.side + 1) * shape.delta, 0.5 - 1e-9);
    for (std::uint32_t number = 0; number < shape.cells(); ++number) {
      const FineCell cell = FineCell::ofNumber(number, shape);
      EXPECT_EQ(cell.number(shape), number);
      const double edge = edgeCentre(cell.edge, shape), span = spanCentre(cell.span, shape);
      for (const double off : {-0.49, 0.49}) {
        const FineCell found = fineCell(edge + off * shape.delta, span - off * shape.delta, shape);
        EXPECT_TRUE(found.isIn(shape));
        EXPECT_EQ(found.number(shape), number);
      }
    }
    EXPECT_FALSE(fineCell(shape.least - 0.01, 0.5, shape).isIn(shape));
    EXPECT_FALSE(fineCell(0.4, shape.least - 0.01, shape).isIn(shape));
    EXPECT_FALSE(fineCell(0.4, 1.01 - shape.least, shape).isIn(shape));
  }
}

TEST(RobustDiamonds, AreInteriorEdgesOfTrianglesAndQuadsCutFromTheirFirstCorner) {
  const Mesh sphere = lab::icosphere(2);
  EXPECT_EQ(collectDiamonds(makeSurface(sphere)).size(), 3 * sphere.faceCount() / 2);
  const Mesh quads = lab::quadSphere(2);
  const Surface surface = makeSurface(quads);
  const std::vector<Diamond> cut = collectDiamonds(surface);
  ASSERT_EQ(cut.size(), quads.faceCount());
  for (std::uint32_t f = 0; f < surface.faceCount(); ++f)
    EXPECT_EQ(std::minmax(cut[f].b, cut[f].d), std::minmax(surface.face(f)[0], surface.face(f)[2]));
  EXPECT_EQ(collectDiamonds(makeSurface(lab::bumpyGrid(3, 2, 1))).size(), 3u);  // four triangles in a row
}

TEST(RobustConstellation, HasOneGoodCellPerGroupAndSplitsSlotsByKey) {
  CodedPayload payload;
  Random random(5);
  for (int i = 0; i < 276; ++i) {
    payload.head.push_back(static_cast<std::uint8_t>(random.next() & 1));
    payload.headGenerator.push_back(static_cast<std::uint8_t>(i % 3));
  }
  const Constellation all(1, keysOf(1), Sharing::headOnly, payload.headCode(), payload.bodyCode());
  std::vector<std::uint32_t> meanings;
  for (std::uint32_t cell = 0; cell < all.shape().cells(); ++cell)
    if (all.meaning(cell) != Constellation::kNone) meanings.push_back(all.meaning(cell));
  std::sort(meanings.begin(), meanings.end());
  ASSERT_EQ(meanings.size(), all.groups() * all.symbols());
  for (std::uint32_t i = 0; i < meanings.size(); ++i) EXPECT_EQ(meanings[i], i);
  const std::vector<std::uint32_t> good = all.goodSymbols(payload);
  std::set<std::uint32_t> carried;
  for (std::uint32_t g = 0; g < all.groups(); ++g)
    for (std::uint32_t t = 0; t < all.shape().symbol; ++t) {
      EXPECT_EQ(good[g] >> t & 1u, payload.head[all.slot(g, t).bit]);
      carried.insert(all.slot(g, t).bit);
    }
  EXPECT_EQ(carried.size(), 276u) << "468 slots: each bit has one";
  // 73 slots for the head of a body's constellation: bits of generators 0 and 1 come first.
  payload.body.assign(600, 1);
  const Constellation few(3, keysOf(1), Sharing::split, payload.headCode(), payload.bodyCode());
  for (std::uint32_t g = 0; g < few.groups(); ++g)
    for (std::uint32_t t = 0; t < 3; ++t)
      EXPECT_TRUE(few.slot(g, t).stream != Stream::head || few.slot(g, t).bit % 3 != 2);
  const Constellation split(3, keysOf(1), Sharing::split, payload.headCode(), payload.bodyCode());
  const Constellation blind(3, keysOf(1), Sharing::split, payload.headCode(), {});
  std::uint32_t heads = 0;
  for (std::uint32_t g = 0; g < split.groups(); ++g) {
    heads += split.slot(g, 0).stream == Stream::head;
    EXPECT_EQ(split.slot(g, 0).stream, blind.slot(g, 0).stream) << "the head is found without knowing the body";
    EXPECT_TRUE(split.slot(g, 0).stream == Stream::body || split.slot(g, 0).bit == blind.slot(g, 0).bit);
  }
  EXPECT_NEAR(heads, split.groups() * 3 / 16.0, 1);
}

}  // namespace
}  // namespace quadmark::robust
