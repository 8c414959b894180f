// SPDX-License-Identifier: MIT
// Changing the order of a PLY's vertices in every variant, and what holds for any format.
#include <gtest/gtest.h>

#include "models.h"
#include "reorder_checks.h"

namespace quadmark::test {
namespace {

TEST(ReorderPly, KeepsFacesAndRecordsInEveryVariant) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* coordinate : {"float", "double"}) {
      for (const char* index : {"char", "uchar", "short", "ushort", "int", "uint"}) {
        for (const bool extras : {false, true}) {
          for (const char* lineBreak : {"\n", "\r\n", "\r"}) {
            SCOPED_TRACE(std::string(encoding) + " " + coordinate + " " + index + (extras ? " extras" : ""));
            PlySpec spec;
            spec.encoding = encoding;
            spec.coordinate = coordinate;
            spec.index = index;
            spec.extras = extras;
            spec.lineBreak = lineBreak;
            spec.list = extras ? "vertex_index" : "vertex_indices";
            spec.faces = gridPolygons();
            const FileBytes file = makePly(spec);
            const FileBytes out = checkReorder(file).bytes;
            EXPECT_EQ(out.size(), file.size());
            EXPECT_TRUE(freedomOf(file).warnings.empty());
          }
        }
      }
    }
  }
}

TEST(ReorderPly, KeepsTheRestartsOfStrips) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* index : {"char", "short", "int"}) {
      SCOPED_TRACE(std::string(encoding) + " " + index);
      PlySpec spec;
      spec.encoding = encoding;
      spec.index = index;
      spec.strips = true;
      spec.faces = {{0, 1, 3, 4, -1, 1, 2, 4, 5}, {3, 4, 6, 7, -1, 4, 5, 7, 8}};
      checkReorder(makePly(spec));
    }
  }
  PlySpec spec;  // the restart of unsigned indices
  spec.encoding = "binary_little_endian";
  spec.index = "uint";
  spec.strips = true;
  spec.faces = {{0, 1, 3, 4, -1, 1, 2, 4, 5}};
  checkReorder(makePly(spec));
}

TEST(ReorderPly, MovesWholeTextRowsAndKeepsTheirSpelling) {
  const std::string text =
      "ply\nformat ascii 1.0\ncomment kept\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nelement face 2\nproperty list uchar int vertex_indices\nelement edge 2\n"
      "property int vertex1\nproperty int vertex2\nproperty uchar crease\nend_header\n"
      "0 0.0 -0 1\n1e0  0 0\t2 \n0 +1 0.50 3\r\n1.000 1 0 4\n3 0 1 2\n3 +1 3 02\n0 1 7\n3 2 0\ntail\n";
  const FileBytes out = reorderOk(bytesOf(text), {3, 2, 1, 0}).bytes;
  const std::string expected =
      text.substr(0, text.find("0 0.0")) +
      "1.000 1 0 4\n0 +1 0.50 3 \n1e0  0 0\t2\r\n0 0.0 -0 1\n3 3 2 1\n3 2 0 1\n3 2 7\n0 1 0\ntail\n";
  EXPECT_EQ(textOf(out), expected);
}

TEST(ReorderPly, KeepsRowsApartWhereTheLastHasNoLineBreak) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\nproperty float "
      "x\n"
      "property float y\nproperty float z\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0.25";
  const std::string out = textOf(reorderOk(bytesOf(text), {2, 0, 1}).bytes);
  EXPECT_EQ(out.substr(out.find("end_header")), "end_header\n3 1 2 0\n0 1 0.25\n0 0 0\n1 0 0");
}

TEST(ReorderPly, FollowsIndicesThatMakeTextRowsLonger) {
  PlySpec spec;  // 9 used vertices and 5 more: numbers of one and of two digits change places, before and behind
  for (int i = 0; i < 15; ++i) spec.positions.push_back(i);
  const FileBytes file = makePly(spec);
  const PatchedFile out = checkReorder(file);
  EXPECT_GT(out.bytes.size(), file.size());
}

TEST(ReorderPly, KeepsTheOrderWhereAnIndexTypeIsTooNarrow) {
  PlySpec spec;
  spec.encoding = "binary_little_endian";
  spec.index = "uchar";
  while (spec.positions.size() < 3 * 256) spec.positions.push_back(1);
  EXPECT_EQ(freedomOf(makePly(spec)).ranges.size(), 1u);
  checkReorder(makePly(spec));
  for (int axis = 0; axis < 3; ++axis) spec.positions.push_back(1);
  const OrderFreedom freedom = freedomOf(makePly(spec));
  EXPECT_TRUE(freedom.ranges.empty());
  EXPECT_TRUE(
      mentions(freedom.warnings, "element \"face\", property \"vertex_indices\" cannot hold every vertex index"));
}

TEST(ReorderPly, SaysWhichReferencesItCannotFollow) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty list uchar int multi_texture_vertex_indices\nelement edge 1\n"
      "property int v1\nproperty int v2\nelement cap 1\nproperty int apex_vertex\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 0 1 2\n0 1\n2\n";
  const OrderFreedom freedom = freedomOf(bytesOf(text));
  ASSERT_EQ(freedom.warnings.size(), 3u);
  EXPECT_TRUE(
      mentions(freedom.warnings, "element \"edge\", property \"v1\" may hold vertex indices and is left as it is"));
  EXPECT_TRUE(mentions(freedom.warnings, "element \"cap\", property \"apex_vertex\""));
  const std::string out = textOf(reorderOk(bytesOf(text), {2, 0, 1}).bytes);
  EXPECT_EQ(out.substr(out.find("3 1 2 0")), "3 1 2 0 3 0 1 2\n0 1\n2\n");
}

TEST(ReorderFile, RefusesWhatIsNoOrderOfTheFile) {
  for (const FileBytes& file : {makePly(PlySpec{}), gridGltf().glb()}) {
    const auto model = readOk(file);
    const Order good = mixedOrder(9, {{0, 9}});
    Order twice = good, outside = good, shorter = good;
    twice[0] = twice[1];
    outside[3] = 9;
    shorter.pop_back();
    for (const Order& order : {twice, outside, shorter, Order{}}) {
      const auto refused = model->reorder(file, {}, order);
      ASSERT_FALSE(refused.ok());
      EXPECT_EQ(refused.error().code, ErrorCode::badOption);
      EXPECT_EQ(refused.error().message.substr(0, 7), "order: ");
    }
    FileBytes another = file;
    another.push_back(' ');
    EXPECT_EQ(model->reorder(another, {}, good).error().code, ErrorCode::badOption);
    EXPECT_EQ(model->orderFreedom(another, {}).error().code, ErrorCode::badOption);
  }
}

TEST(CountChangedBytes, AgreesWithWhatPatchCounts) {
  std::vector<double> positions = gridPositions();
  positions[3 * 8 + 2] = -1.1f;  // bounds change too
  positions[3 * 4] = 1.12345f;
  std::vector<FileBytes> files = {gridGltf().glb()};
  for (const char* encoding : {"ascii", "binary_big_endian"}) {
    PlySpec spec;
    spec.encoding = encoding;
    files.push_back(makePly(spec));
  }
  for (const FileBytes& file : files) {
    const auto patched = readOk(file)->patch(file, {}, positions);
    ASSERT_TRUE(patched.ok());
    EXPECT_GT(patched->bytesChanged, 0u);
    EXPECT_EQ(countChangedBytes(file, {}, *patched), patched->bytesChanged);
  }
}

TEST(ReorderPly, KeepsRealModelsWhole) {
  for (const char* name : {"bunny.ply", "beast-quads.ply", "igea-tristrips.ply", "ogre.ply"}) {
    SCOPED_TRACE(name);
    if (const std::optional<FileBytes> file = modelBytes(name)) checkReorder(*file);
  }
}

}  // namespace
}  // namespace quadmark::test
