// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "mesh_checks.h"
#include "quadmark/io/model.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"

namespace quadmark {
namespace {

using namespace lab;
using namespace testing;

Mesh readBack(const std::vector<std::uint8_t>& file) {
  Result<std::unique_ptr<Model>> model = readModel(file);
  EXPECT_TRUE(model.ok()) << (model.ok() ? "" : model.error().message);
  return model.ok() ? (*model)->mesh() : Mesh{};
}

TEST(WritePly, BringsEveryMeshBack) {
  for (const Mesh& mesh : {sculpture(800), polygonMix(1), bumpyGrid(7, 5, 1), cube()}) {
    const Mesh back = readBack(writePly(mesh));
    EXPECT_EQ(back.positions, mesh.positions);
    EXPECT_EQ(back.precision, Precision::float32);
    EXPECT_EQ(back.faceVertices, mesh.faceVertices);
    ASSERT_EQ(back.faceCount(), mesh.faceCount());
    for (std::size_t f = 0; f < mesh.faceCount(); ++f) ASSERT_EQ(back.faceEnd(f), mesh.faceEnd(f));
  }
}

TEST(WritePly, WritesDoublesAndHugeFaces) {
  Mesh mesh = cube();
  mesh.precision = Precision::float64;
  mesh.positions[0] = -1.000000000000001;
  EXPECT_EQ(readBack(writePly(mesh)).positions, mesh.positions);

  Mesh disc = fan(300);
  disc.faceVertices.clear();
  for (std::uint32_t v = 1; v <= 300; ++v) disc.faceVertices.push_back(v);
  disc.faceOffsets = {0, 300};
  const Mesh back = readBack(writePly(disc));
  EXPECT_EQ(back.faceVertices, disc.faceVertices);
}

TEST(WritePly, HasTheExpectedBytes) {
  Mesh mesh;
  mesh.positions = {1, 0, 0, 0, 2, 0, 0, 0, -0.5};
  mesh.faceVertices = {0, 1, 2};
  const std::vector<std::uint8_t> file = writePly(mesh);
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  ASSERT_EQ(file.size(), header.size() + 36 + 13);
  EXPECT_EQ(std::string(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(header.size())), header);
  const std::vector<std::uint8_t> first{0, 0, 0x80, 0x3f}, last{3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0};
  EXPECT_TRUE(std::equal(first.begin(), first.end(), file.begin() + static_cast<std::ptrdiff_t>(header.size())));
  EXPECT_TRUE(std::equal(last.begin(), last.end(), file.end() - 13));
}

TEST(WriteGlb, BringsTriangleMeshesBack) {
  for (const Mesh& mesh : {sculpture(800), bumpyGrid(7, 5, 1), nonManifold()}) {
    const Mesh back = readBack(writeGlb(mesh));
    EXPECT_EQ(back.positions, mesh.positions);
    EXPECT_EQ(back.faceVertices, mesh.faceVertices);
  }
}

TEST(WriteGlb, FansPolygons) {
  const Mesh mesh = quadSphere(2), back = readBack(writeGlb(mesh));
  EXPECT_EQ(back.positions, mesh.positions);
  EXPECT_EQ(back.faceCount(), 2 * mesh.faceCount());
  EXPECT_TRUE(isClosedAndOriented(back));
}

TEST(WriteGlb, GivesEachGroupItsMesh) {
  Mesh mesh = twoComponents(1);
  mesh.groups.assign(mesh.vertexCount(), 7);
  std::fill(mesh.groups.begin(), mesh.groups.begin() + 642, 9u);
  const std::vector<std::uint8_t> file = writeGlb(mesh);
  Result<std::unique_ptr<Model>> model = readModel(file);
  ASSERT_TRUE(model.ok());
  EXPECT_EQ((*model)->info().meshes, 2u);
  EXPECT_EQ((*model)->info().nodes, 2u);
  EXPECT_EQ((*model)->mesh().vertexCount(), mesh.vertexCount());
  EXPECT_EQ((*model)->mesh().faceCount(), mesh.faceCount());
  EXPECT_EQ((*model)->mesh().positions[0], mesh.positions[3 * 642]);  // the lower group comes first
}

TEST(WriteGlb, HasAWholeContainer) {
  const std::vector<std::uint8_t> file = writeGlb(cube());
  const auto word = [&](std::size_t at) {
    return std::uint32_t{file[at]} | std::uint32_t{file[at + 1]} << 8 | std::uint32_t{file[at + 2]} << 16 |
           std::uint32_t{file[at + 3]} << 24;
  };
  EXPECT_EQ(word(0), 0x46546c67u);
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), file.size());
  const std::uint32_t json = word(12);
  EXPECT_EQ(json % 4, 0u);
  EXPECT_EQ(word(20 + json), 8u * 12 + 36 * 4);
  const std::string text(file.begin() + 20, file.begin() + 20 + json);
  EXPECT_NE(text.find("\"min\":[-1,-1,-1],\"max\":[1,1,1]"), std::string::npos) << text;
}

}  // namespace
}  // namespace quadmark
