// SPDX-License-Identifier: MIT
#include "quadmark/mesh.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace quadmark {
namespace {

Mesh square() {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 3, 0, 0, 3, 4, 0, 0, 4, 0};
  mesh.faceVertices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

void expectBadMesh(const Mesh& mesh, const std::string& place) {
  const Status status = validate(mesh);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::badMesh);
  EXPECT_NE(status.error().message.find(place), std::string::npos) << status.error().message;
}

TEST(ErrorCode, HasAStableUniqueNameForEachCode) {
  std::set<std::string> names;
  for (int code = 0; code <= static_cast<int>(ErrorCode::internal); ++code) {
    const std::string name(errorCodeName(static_cast<ErrorCode>(code)));
    EXPECT_FALSE(name.empty());
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos);
    EXPECT_TRUE(names.insert(name).second) << name;
  }
  EXPECT_EQ(errorCodeName(ErrorCode::unsupportedFile), "unsupported_file");
  EXPECT_EQ(errorCodeName(ErrorCode::badFile), "bad_file");
  EXPECT_EQ(errorCodeName(ErrorCode::tooLarge), "too_large");
}

TEST(MeshValidate, AcceptsTrianglesPolygonsAndUnusedVertices) {
  Mesh mesh = square();
  EXPECT_TRUE(validate(mesh).ok());
  mesh.faceOffsets = {0, 3, 6};
  EXPECT_TRUE(validate(mesh).ok());
  mesh.faceVertices = {0, 1, 2, 3};
  mesh.faceOffsets = {0, 4};
  mesh.positions.insert(mesh.positions.end(), {9, 9, 9});
  EXPECT_TRUE(validate(mesh).ok());
  EXPECT_EQ(mesh.faceCount(), 1u);
  EXPECT_EQ(mesh.faceEnd(0), 4u);
  mesh.groups.assign(5, 7);
  EXPECT_TRUE(validate(mesh).ok());
  EXPECT_TRUE(validate(Mesh{}).ok());
}

TEST(MeshValidate, NamesTheFirstOffendingPlace) {
  Mesh mesh = square();
  mesh.positions[7] = std::numeric_limits<double>::quiet_NaN();
  expectBadMesh(mesh, "vertex 2, component y");
  mesh.positions[7] = std::numeric_limits<double>::infinity();
  expectBadMesh(mesh, "vertex 2, component y");

  mesh = square();
  mesh.faceVertices[4] = 4;
  expectBadMesh(mesh, "corner 4");
  mesh = square();
  mesh.faceVertices.pop_back();
  expectBadMesh(mesh, "5 corners");
  mesh = square();
  mesh.positions.pop_back();
  expectBadMesh(mesh, "11 numbers");
  mesh = square();
  mesh.groups = {0, 0, 1};
  expectBadMesh(mesh, "groups");
}

TEST(MeshValidate, RefusesOffsetsThatDoNotCoverTheCorners) {
  Mesh mesh = square();
  for (const std::vector<std::uint32_t>& offsets :
       {std::vector<std::uint32_t>{0, 3}, {0, 3, 7}, {1, 3, 6}, {0, 6, 3}, {0, 2, 6}, {0, 6, 6}, {0}}) {
    mesh.faceOffsets = offsets;
    EXPECT_FALSE(validate(mesh).ok()) << offsets.size();
  }
}

TEST(MeshBoundingDiagonal, CoversOnlyVerticesThatFacesUse) {
  Mesh mesh = square();
  EXPECT_EQ(boundingDiagonal(mesh), 5.0);
  mesh.positions.insert(mesh.positions.end(), {100, 100, 100});
  EXPECT_EQ(boundingDiagonal(mesh), 5.0);
  mesh.faceVertices.clear();
  EXPECT_EQ(boundingDiagonal(mesh), 0.0);
}

TEST(MeshBoundingDiagonal, StaysRightWhereSquaresLeaveTheRangeOfADouble) {
  for (const double unit : {1e200, 1e-200, 1e-308}) {
    Mesh mesh = square();
    for (double& value : mesh.positions) value *= unit;
    EXPECT_NEAR(boundingDiagonal(mesh) / unit, 5.0, 1e-12);
  }
}

TEST(MeshRoundToPrecision, RoundsToTheNearestFloatAndKeepsDoubles) {
  Mesh mesh = square();
  mesh.positions[0] = 0.1;
  mesh.positions[1] = 16777217.0;  // halfway between two floats: to the even one
  mesh.positions[2] = 16777219.0;
  roundToPrecision(mesh);
  EXPECT_EQ(mesh.positions[0], 0.100000001490116119384765625);
  EXPECT_EQ(mesh.positions[1], 16777216.0);
  EXPECT_EQ(mesh.positions[2], 16777220.0);
  mesh.precision = Precision::float64;
  mesh.positions[0] = 0.1;
  roundToPrecision(mesh);
  EXPECT_EQ(mesh.positions[0], 0.1);
}

}  // namespace
}  // namespace quadmark
