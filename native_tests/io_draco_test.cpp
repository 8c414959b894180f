// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "io/draco_codec.h"
#include "io/gltf_container.h"
#include "io_allocations.h"
#include "io_fixtures.h"
#include "io_streams.h"
#include "models.h"
#include "quadmark/io/drc.h"
#include "quadmark/random.h"

namespace quadmark::test {
namespace {

constexpr std::uint64_t kLimit = std::uint64_t{64} << 20;

/// Its triangles as sets of corners, whatever the numbers of the points.
std::vector<std::vector<double>> trianglesOf(const Mesh& mesh) {
  std::vector<std::vector<double>> triangles;
  for (std::size_t face = 0; face < mesh.faceCount(); ++face) {
    std::vector<std::vector<double>> corners;
    for (std::size_t corner = mesh.faceBegin(face); corner < mesh.faceEnd(face); ++corner) {
      const double* p = &mesh.positions[3 * std::size_t{mesh.faceVertices[corner]}];
      corners.emplace_back(p, p + 3);
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.emplace_back();
    for (const std::vector<double>& corner : corners) {
      triangles.back().insert(triangles.back().end(), corner.begin(), corner.end());
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

Mesh gridMesh() {
  return (*readModel(gridGltf().glb()))->mesh();
}

TEST(ReadDrc, GivesTheTrianglesOfBothMethods) {
  for (const FileBytes& file : {sequentialGrid(), edgebreakerGrid()}) {
    const auto model = readModel(file);
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_EQ((*model)->info().format, FileFormat::drc);
    EXPECT_EQ((*model)->info().variant, "Draco 2.2");
    EXPECT_EQ(trianglesOf((*model)->mesh()), trianglesOf(gridMesh()));
  }
}

TEST(ReadDrc, KeepsTheOrderOfSequentialFiles) {
  const auto model = readModel(sequentialGrid());
  EXPECT_EQ((*model)->mesh().positions, gridPositions());
  EXPECT_EQ((*model)->mesh().faceVertices, gridMesh().faceVertices);
}

TEST(ReadDrc, RefusesToMark) {
  const auto model = readModel(edgebreakerGrid());
  const Status markable = (*model)->checkMarkable();
  ASSERT_FALSE(markable.ok());
  EXPECT_EQ(markable.error().code, ErrorCode::unsupportedFile);
  EXPECT_NE(markable.error().message.find("mark the PLY, glTF or GLB"), std::string::npos);
  EXPECT_EQ((*model)->patch(edgebreakerGrid(), {}, (*model)->mesh().positions).error().code,
            ErrorCode::unsupportedFile);
}

void expectRefused(FileBytes file, std::size_t at, std::uint8_t value, ErrorCode code, const char* part) {
  file[at] = value;
  const auto model = readModel(file);
  ASSERT_FALSE(model.ok()) << part;
  EXPECT_EQ(model.error().code, code) << model.error().message;
  EXPECT_NE(model.error().message.find(part), std::string::npos) << model.error().message;
}

TEST(ReadDrc, RefusesWhatItCannotReadByName) {
  expectRefused(edgebreakerGrid(), 6, 1, ErrorCode::unsupportedFile, "Draco bitstream version 2.1");
  expectRefused(edgebreakerGrid(), 7, 0, ErrorCode::unsupportedFile, "point cloud");
  expectRefused(edgebreakerGrid(), 8, 2, ErrorCode::badFile, "unknown Draco method 2");
  expectRefused(edgebreakerGrid(), 11, 1, ErrorCode::unsupportedFile, "predictive edgebreaker");
  expectRefused(edgebreakerGrid(), 13, 200, ErrorCode::badFile, "broken");
}

TEST(ReadDrc, RefusesTruncatedFiles) {
  for (const FileBytes& whole : {sequentialGrid(), edgebreakerGrid()}) {
    for (std::size_t length = 5; length < whole.size(); ++length) {
      const auto model = readModel(FileBytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
      ASSERT_FALSE(model.ok()) << length;
      EXPECT_EQ(model.error().code, ErrorCode::badFile) << length << ": " << model.error().message;
    }
  }
}

TEST(ReadDrc, SurvivesDamagedFiles) {
  Random random(11);
  for (const FileBytes& whole : {sequentialGrid(), edgebreakerGrid()}) {
    for (int round = 0; round < 3000; ++round) {
      FileBytes file = whole;
      for (int i = 0; i < 2; ++i) {
        file[5 + random.below(static_cast<std::uint32_t>(file.size() - 5))] =
            static_cast<std::uint8_t>(random.below(256));
      }
#if QM_COUNT_ALLOCATIONS
      resetLargestAllocation();
#endif
      const auto model = readModel(file);
      ASSERT_TRUE(!model.ok() || validate((*model)->mesh()).ok());
#if QM_COUNT_ALLOCATIONS
      ASSERT_LE(largestAllocation(), 8 * file.size() + kLimit);
#endif
    }
  }
}

TEST(ReadDrc, AllocatesNoMoreThanItsBytesAllow) {
  // Edgebreaker with four thousand million triangles and as many symbols.
  FileBytes file = fromHex(
      "445241434f020201010000"
      "00"
      "ffffffff0f"
      "ffffffff0f"
      "00"
      "ffffffff0f"
      "00");
  const auto model = readModel(file);
  ASSERT_FALSE(model.ok());
  EXPECT_EQ(model.error().code, ErrorCode::tooLarge);
}

TEST(DecodeDraco, GivesAttributesAsAsked) {
  const auto mesh = io::decodeDraco(sequentialGrid(), {{1, 5126, 2}, {0, 5122, 3}}, kLimit, "here");
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_EQ(mesh->pointCount, 9u);
  for (std::size_t i = 0; i < 18; ++i) {
    EXPECT_EQ(io::load<float>(&mesh->values[0][4 * i]), static_cast<float>(i) / 32);
  }
  EXPECT_EQ(mesh->values[1].size(), 9u * 6);
  EXPECT_EQ(io::decodeDraco(sequentialGrid(), {{7, 5126, 2}}, kLimit, "here").error().message,
            "here: the Draco data has no attribute 7");
  EXPECT_EQ(io::decodeDraco(sequentialGrid(), {{1, 5126, 3}}, kLimit, "here").error().message,
            "here: attribute 1 of the Draco data has 2 components, expected 3");
}

TEST(DracoGltf, IsReadAsThePlainOne) {
  const auto model = readModel(DracoGrid{}.glb());
  ASSERT_TRUE(model.ok()) << model.error().message;
  EXPECT_EQ((*model)->mesh().positions, gridPositions());
  EXPECT_EQ((*model)->mesh().faceVertices, gridMesh().faceVertices);
  EXPECT_TRUE((*model)->info().warnings.empty());
  DracoGrid edgebreaker;
  edgebreaker.bin = edgebreakerGrid();
  const auto other = readModel(edgebreaker.glb());
  ASSERT_TRUE(other.ok()) << other.error().message;
  EXPECT_EQ(trianglesOf((*other)->mesh()), trianglesOf(gridMesh()));
}

TEST(DracoGltf, IsReadWhateverItsAccessorsClaim) {
  DracoGrid grid;
  grid.json = replaced(replaced(grid.json, "\"count\":9", "\"count\":7"), "\"count\":24", "\"count\":3");
  const auto model = readModel(grid.glb());
  ASSERT_TRUE(model.ok()) << model.error().message;
  EXPECT_EQ((*model)->mesh().positions, gridPositions());
}

TEST(DracoGltf, StaysAsItIsWhenNothingMoves) {
  const FileBytes file = DracoGrid{}.glb();
  const auto model = readModel(file);
  const auto patched = (*model)->patch(file, {}, gridPositions());
  ASSERT_TRUE(patched.ok()) << patched.error().message;
  EXPECT_EQ(patched->bytes, file);
  EXPECT_TRUE(patched->warnings.empty());
}

TEST(DracoGltf, GetsPlainAccessorsWhenMarked) {
  const FileBytes file = DracoGrid{}.glb();
  const auto model = readModel(file);
  const auto patched = (*model)->patch(file, {}, movedGrid());
  ASSERT_TRUE(patched.ok()) << patched.error().message;
  ASSERT_EQ(patched->warnings.size(), 1u);
  EXPECT_NE(patched->warnings[0].find("no longer compressed by KHR_draco_mesh_compression"), std::string::npos);
  const auto back = readModel(patched->bytes);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ((*back)->mesh().positions, movedGrid());
  EXPECT_EQ((*back)->mesh().faceVertices, (*model)->mesh().faceVertices);

  const auto container = io::openGltf(patched->bytes);
  const std::string text(container->json(patched->bytes));
  EXPECT_NE(text.find(R"("extensionsUsed":["KHR_materials_unlit"],)"), std::string::npos) << text;
  EXPECT_EQ(text.find("draco"), std::string::npos);
  EXPECT_EQ(text.find("extensionsRequired"), std::string::npos);
  EXPECT_NE(text.find(R"({"attributes":{"POSITION":3,"TEXCOORD_0":4},"indices":5,"mode":4,"extensions":{)"),
            std::string::npos);
  EXPECT_NE(text.find("\"extensions\":{\n  \"EXT_other\":{}}"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("count":9,"type":"VEC3","min":[0,0,-1.25],"max":[2,2,0.75]})"), std::string::npos) << text;
  const io::Bytes bin = container->bin(patched->bytes);
  EXPECT_EQ(FileBytes(bin.begin(), bin.begin() + static_cast<std::ptrdiff_t>(sequentialGrid().size())),
            sequentialGrid());
  // Texture coordinates follow the positions.
  const std::size_t uv = (sequentialGrid().size() + 3) / 4 * 4 + 108;
  for (std::size_t i = 0; i < 18; ++i) EXPECT_EQ(io::load<float>(&bin[uv + 4 * i]), static_cast<float>(i) / 32);
}

TEST(DracoGltf, ServesPrimitivesThatShareAStream) {
  DracoGrid grid;
  const std::size_t begin = grid.json.find("{\"attributes\""), end = grid.json.rfind("]}]}");
  const std::string primitive = grid.json.substr(begin, end - begin);
  grid.json.insert(end, "," + replaced(primitive, "\"mode\":4,", ""));
  const FileBytes file = grid.glb();
  const auto model = readModel(file);
  ASSERT_TRUE(model.ok()) << model.error().message;
  EXPECT_EQ((*model)->mesh().vertexCount(), 9u);
  EXPECT_EQ((*model)->mesh().faceCount(), 8u);
  const auto patched = (*model)->patch(file, {}, movedGrid());
  ASSERT_TRUE(patched.ok()) << patched.error().message;
  EXPECT_NE(patched->warnings[0].find("2 primitives"), std::string::npos);
  EXPECT_EQ(textOf(patched->bytes).find("draco"), std::string::npos);
  EXPECT_EQ((*readModel(patched->bytes))->mesh().positions, movedGrid());
}

TEST(DracoGltf, IsRefusedWithThePlaceOfTheFault) {
  const auto refusal = [](const std::string& what, const std::string& by) {
    DracoGrid grid;
    grid.json = replaced(grid.json, what, by);
    const auto model = readModel(grid.glb());
    EXPECT_FALSE(model.ok()) << by;
    return model.ok() ? "" : model.error().message;
  };
  const std::string place = "mesh 0 primitive 0 KHR_draco_mesh_compression";
  EXPECT_EQ(refusal("\"bufferView\":0,", "").substr(0, place.size() + 18), place + " has no bufferView");
  EXPECT_EQ(refusal("\"POSITION\":0,\"TEXCOORD_0\":1", "\"TEXCOORD_0\":1"), place + " attributes has no POSITION");
  EXPECT_EQ(refusal("\"POSITION\":0,\"TEXCOORD_0\":1", "\"POSITION\":5"),
            "mesh 0 primitive 0: the Draco data has no attribute 5");
  EXPECT_EQ(refusal("\"byteLength\":STREAM", "\"byteLength\":100"), "mesh 0 primitive 0: the Draco data is broken");
}

TEST(RealModels, AreReadBehindDraco) {
  if (const auto file = modelBytes("Box_Draco.glb")) {
    const auto model = readModel(*file);
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_EQ((*model)->mesh().vertexCount(), 24u);
    EXPECT_EQ((*model)->mesh().faceCount(), 12u);
    std::vector<double> moved = (*model)->mesh().positions;
    moved[0] = moved[0] * 0.75;
    const auto patched = (*model)->patch(*file, {}, moved);
    ASSERT_TRUE(patched.ok()) << patched.error().message;
    EXPECT_EQ((*readModel(patched->bytes))->mesh().positions, moved);
  }
  if (const auto file = modelBytes("bunny_gltf.drc")) {
    const auto model = readModel(*file);
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_EQ((*model)->mesh().vertexCount(), 34834u);
    EXPECT_EQ((*model)->mesh().faceCount(), 69451u);
  }
}

}  // namespace
}  // namespace quadmark::test
