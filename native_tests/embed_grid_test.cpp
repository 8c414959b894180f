// SPDX-License-Identifier: MIT
// Marking models whose positions are integers (KHR_mesh_quantization): on their grid with all guarantees, or not at all.
#include <cmath>

#include "fixtures.h"

namespace quadmark::test {
namespace {

const CoordinateGrid kUint8{1, 0, 255}, kInt8Normalized{127, -127, 127}, kUint16{1, 0, 65535}, kInt16{1, -32768, 32767},
    kInt16Normalized{32767, -32767, 32767}, kUint16Normalized{65535, 0, 65535};

/// The mesh moved and scaled to fill a grid, as quantizers do it.
Mesh onGrid(Mesh mesh, const CoordinateGrid& grid) {
  double low[3] = {1e300, 1e300, 1e300}, side = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) low[i % 3] = std::min(low[i % 3], mesh.positions[i]);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) side = std::max(side, mesh.positions[i] - low[i % 3]);
  const double range = (grid.high - grid.low) / grid.divisor;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i] = grid.low / grid.divisor + (mesh.positions[i] - low[i % 3]) / side * range;
  mesh.grids = {grid};
  mesh.gridOf.assign(mesh.vertexCount(), 1);
  roundToPrecision(mesh);
  return mesh;
}

std::vector<std::uint8_t> idBits(std::uint64_t id = 0x0123456789abcdef) {
  std::vector<std::uint8_t> bits(64);
  for (int i = 0; i < 64; ++i) bits[i] = static_cast<std::uint8_t>(id >> (63 - i) & 1);
  return bits;
}

TEST(CoordinateGrid, RoundsToTheNearestCodeAndClamps) {
  for (const CoordinateGrid& grid : {kUint8, kInt8Normalized, kUint16, kInt16, kInt16Normalized, kUint16Normalized}) {
    for (double code = grid.low; code <= grid.high; code += 1) {
      const double x = code / grid.divisor;
      ASSERT_EQ(nearestOnGrid(grid, x), x) << code;
      ASSERT_EQ(nearestOnGrid(grid, x + 0.49 * grid.step()), x) << code;
      ASSERT_EQ(nearestOnGrid(grid, x - 0.49 * grid.step()), x) << code;
    }
    EXPECT_EQ(nearestOnGrid(grid, 1e9), grid.high / grid.divisor);
    EXPECT_EQ(nearestOnGrid(grid, -1e9), grid.low / grid.divisor);
  }
}

TEST(MeshValidate, RefusesGridsThatDoNotExist) {
  Mesh mesh = onGrid(lab::cube(), kUint8);
  EXPECT_TRUE(validate(mesh).ok());
  mesh.gridOf[3] = 2;
  EXPECT_EQ(validate(mesh).error().code, ErrorCode::badMesh);
  mesh.gridOf.pop_back();
  EXPECT_EQ(validate(mesh).error().code, ErrorCode::badMesh);
}

TEST(Weld, FixesVerticesWhoseTwinsCannotStoreTheSamePositions) {
  Mesh mesh = lab::flatGrid(2, 2);
  mesh.grids = {kInt16, kInt16Normalized, {1, 0, 0}};
  mesh.gridOf.assign(mesh.vertexCount(), 1);
  mesh.gridOf[1] = 3;  // nothing but zero can be stored
  mesh.positions.insert(mesh.positions.end(), mesh.positions.begin(), mesh.positions.begin() + 3);  // a twin of vertex 0
  mesh.gridOf.push_back(2);
  mesh.faceVertices.insert(mesh.faceVertices.end(), {static_cast<std::uint32_t>(mesh.vertexCount() - 1), 1, 2});
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.gridOf[welded.weldedOf[0]], kFixed);
  EXPECT_EQ(welded.gridOf[welded.weldedOf[1]], kFixed);
  EXPECT_EQ(welded.gridOf[welded.weldedOf[2]], 1);
  EXPECT_EQ(welded.halfStep[welded.weldedOf[0]], 0.5);  // of the coarser one
  EXPECT_TRUE(weld(lab::cube()).gridOf.empty());
}

TEST(EmbedOnGrid, ReadsBackExactlyFromSixteenBitsAndStaysOnTheGrid) {
  const Key key = idKey();
  for (const NamedMesh& named : roomyMeshes()) {
    for (const CoordinateGrid& grid : {kUint16, kInt16Normalized}) {
      SCOPED_TRACE(named.name + " " + std::to_string(grid.divisor));
      const Mesh mesh = onGrid(named.mesh, grid);
      MarkedMesh report;
      const Mesh out = marked(mesh, key, idBits(), &report);
      EXPECT_TRUE(report.guarantees.all());
      EXPECT_NE(out.positions, mesh.positions);
      Mesh rounded = out;
      roundToPrecision(rounded);
      EXPECT_EQ(rounded.positions, out.positions);
      EXPECT_TRUE(readsExactly(out, key, idBits()));
      EXPECT_EQ(readMark(out, key).verdict, Verdict::match);
      EXPECT_EQ(weld(out).weldedOf, weld(mesh).weldedOf);  // twins stayed twins, and nothing else became one
    }
  }
}

TEST(EmbedOnGrid, ReadsBackFromFloatsThatADecoderMakesOfTheIntegers) {
  const Key key = idKey();
  Mesh out = marked(onGrid(lab::sculpture(3000), kInt16Normalized), key, idBits());
  out.gridOf.clear();
  for (double& x : out.positions) x = x * 0.37 + 0.011;
  roundToPrecision(out);
  EXPECT_TRUE(readsExactly(out, key, idBits()));
  EXPECT_EQ(readMark(out, key).verdict, Verdict::match);
}

TEST(EmbedOnGrid, RefusesForCapacityWithNumbersWhereTheGridIsTooCoarse) {
  const Key key = idKey();
  for (const CoordinateGrid& grid : {kUint8, kInt8Normalized}) {
    const auto refused = embedMesh(onGrid(lab::sculpture(3000), grid), idBits(), key);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::capacity);
    EXPECT_NE(refused.error().message.find("too small for the precision"), std::string::npos) << refused.error().message;
  }
  const auto refused = embedMesh(onGrid(lab::sculpture(3000), {1, 0, 4095}), idBits(), key);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::capacity);
  EXPECT_NE(refused.error().message.find("the positions are integers, about "), std::string::npos)
      << refused.error().message;
}

TEST(EmbedOnGrid, NeverWritesAMarkThatItsGridCannotHold) {
  const Key key = idKey();
  int written = 0, refused = 0;
  for (const int bits : {9, 10, 11, 12, 13, 14, 15}) {
    for (const NamedMesh& named : {NamedMesh{"machinedPart", lab::machinedPart(1500)}, {"seamed", lab::seamed(4)}}) {
      const Mesh mesh = onGrid(named.mesh, {1, 0, std::floor(std::pow(2.0, bits)) - 1});
      const Result<MarkedMesh> result = embedMesh(mesh, idBits(), key);
      if (result.ok()) {
        ++written;
        EXPECT_TRUE(readsExactly(withPositions(mesh, result->positions), key, idBits())) << named.name << bits;
      } else {
        ++refused;
        EXPECT_EQ(result.error().code, ErrorCode::capacity) << named.name << bits;
      }
    }
  }
  EXPECT_GT(written, 2);
  EXPECT_GT(refused, 2);
}

TEST(EmbedOnGrid, LeavesFixedVerticesAlone) {
  const Key key = idKey();
  Mesh mesh = onGrid(lab::bumpyGrid(28, 28, 3), kUint16);
  mesh.grids.push_back({1, 0, 0});
  mesh.gridOf[400] = 2;
  for (int axis = 0; axis < 3; ++axis) mesh.positions[3 * 400 + axis] = 0;
  const Mesh out = marked(mesh, key, idBits());
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(out.positions[3 * 400 + axis], 0);
  EXPECT_TRUE(readsExactly(out, key, idBits()));
}

}  // namespace
}  // namespace quadmark::test
