// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "io_fixtures.h"

namespace quadmark::test {
namespace {

std::unique_ptr<Model> readOk(const FileBytes& file, const Resources& resources = {}) {
  Result<std::unique_ptr<Model>> model = readModel(file, resources);
  EXPECT_TRUE(model.ok()) << model.error().message;
  return model.ok() ? std::move(model).value() : nullptr;
}

void expectRefused(const FileBytes& file, ErrorCode code, const std::string& place, const Resources& resources = {}) {
  const Result<std::unique_ptr<Model>> model = readModel(file, resources);
  ASSERT_FALSE(model.ok()) << place;
  EXPECT_EQ(errorCodeName(model.error().code), errorCodeName(code)) << model.error().message;
  EXPECT_NE(model.error().message.find(place), std::string::npos) << model.error().message;
}

std::vector<std::uint32_t> flat(const std::vector<std::vector<int>>& faces) {
  std::vector<std::uint32_t> corners;
  for (const auto& face : faces) corners.insert(corners.end(), face.begin(), face.end());
  return corners;
}

/// The grid's GLB with one thing in the JSON replaced.
FileBytes with(const std::string& what, const std::string& by) {
  GridGltf file = gridGltf();
  EXPECT_NE(file.json.find(what), std::string::npos) << what;
  return makeGlb(replaced(file.json, what, by), file.bin);
}

TEST(ReadGltf, ReadsAGlbWithItsBinChunk) {
  const auto model = readOk(gridGltf().glb());
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->mesh().positions, gridPositions());
  EXPECT_EQ(model->mesh().faceVertices, flat(gridTriangles()));
  EXPECT_TRUE(model->mesh().faceOffsets.empty());
  EXPECT_TRUE(model->mesh().groups.empty());
  EXPECT_EQ(model->mesh().precision, Precision::float32);
  EXPECT_EQ(model->vertexMesh(), std::vector<std::uint32_t>(9, 0));
  EXPECT_EQ(model->info().format, FileFormat::glb);
  EXPECT_EQ(model->info().variant, "glTF 2.0");
  EXPECT_EQ(model->info().extensionsUsed, std::vector<std::string>{"KHR_materials_unlit"});
  EXPECT_EQ(model->info().meshes, 1u);
  EXPECT_EQ(model->info().primitives, 1u);
  EXPECT_EQ(model->info().nodes, 1u);
  ASSERT_EQ(model->nodes().size(), 1u);
  EXPECT_EQ(model->nodes()[0].name, "grid \xc3\xa9");
  EXPECT_TRUE(model->info().warnings.empty());
}

TEST(ReadGltf, ReadsExternalBuffersUnderTheSpellingsOfTheirUri) {
  const GridGltf file = gridGltf(R"("uri":"./my%20data\/grid.bin",)");
  for (const char* key : {"./my%20data/grid.bin", "./my data/grid.bin", "my%20data/grid.bin", "my data/grid.bin"}) {
    SCOPED_TRACE(key);
    const auto model = readOk(bytesOf(file.json), {{key, file.bin}});
    ASSERT_NE(model, nullptr);
    EXPECT_EQ(model->mesh().positions, gridPositions());
    EXPECT_EQ(model->info().format, FileFormat::gltf);
  }
  expectRefused(bytesOf(file.json), ErrorCode::badFile, "buffer 0: the file \"./my%20data/grid.bin\" was not given");
  EXPECT_EQ(*externalUris(bytesOf(file.json)), std::vector<std::string>{"./my%20data/grid.bin"});
}

TEST(ReadGltf, ReadsDataUrisInEverySpelling) {
  const GridGltf plain = gridGltf();
  const std::string encoded = base64(plain.bin);
  std::string unpadded = encoded;
  while (unpadded.back() == '=') unpadded.pop_back();
  for (const std::string& uri :
       {"data:application/octet-stream;base64," + encoded, "data:application/gltf-buffer;base64," + encoded,
        "DATA:;BASE64," + encoded, "data:application\\/octet-stream;base64," + replaced(encoded, "/", "\\/"),
        "data:;base64," + unpadded, "data:;base64," + replaced(encoded, "=", "%3D"),
        "data:;base64," + replaced(encoded, "A", "\\u0041")}) {
    SCOPED_TRACE(uri.substr(0, 60));
    const GridGltf file = gridGltf("\"uri\":\"" + uri + "\",");
    const auto model = readOk(bytesOf("\xef\xbb\xbf\n " + file.json));
    ASSERT_NE(model, nullptr);
    EXPECT_EQ(model->mesh().positions, gridPositions());
    EXPECT_TRUE(externalUris(bytesOf(file.json))->empty());
  }
  const auto refused = [&](const std::string& uri, ErrorCode code, const std::string& place) {
    expectRefused(bytesOf(gridGltf("\"uri\":\"" + uri + "\",").json), code, place);
  };
  refused("data:text/plain,abc", ErrorCode::unsupportedFile, "buffer 0: the data URI is not base64");
  refused("data:;base64", ErrorCode::unsupportedFile, "not base64");
  refused("data:;base64,AAA*", ErrorCode::badFile, "broken at character 16");
  refused("data:;base64,AA=A", ErrorCode::badFile, "broken");
  refused("data:;base64,AAAAA", ErrorCode::badFile, "single digit");
  refused("data:;base64,AAAA", ErrorCode::badFile, "byteLength is 156, the data URI has 3 bytes");
}

TEST(ReadGltf, ReadsIndicesOfEveryWidthAndNone) {
  for (const auto& [type, code] :
       {std::pair{"uchar", "5121"}, std::pair{"ushort", "5123"}, std::pair{"uint", "5125"}}) {
    GridGltf file = gridGltf();
    BufferBuilder buffer;
    buffer.floats(gridPositions());
    buffer.indices(type, gridTriangles());
    file.json =
        replaced(replaced(replaced(file.json, "5123", code), ":48", ":" + std::to_string(buffer.bytes.size() - 108)),
                 "156", std::to_string(buffer.bytes.size()));
    EXPECT_EQ(readOk(makeGlb(file.json, buffer.bytes))->mesh().faceVertices, flat(gridTriangles())) << type;
  }
  const auto soup = readOk(with("\"indices\":1,", ""));
  EXPECT_EQ(soup->mesh().faceVertices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(ReadGltf, ExpandsStripsAndFansWithTheirWinding) {
  const std::vector<std::vector<int>> stream = {{0, 3, 1, 4, 4, 5}};
  BufferBuilder buffer;
  buffer.floats(gridPositions());
  buffer.indices("ushort", stream);
  const auto facesOf = [&](const std::string& mode) {
    std::string json = replaced(gridGltf().json, "\"indices\":1", "\"indices\":1,\"mode\":" + mode);
    json = replaced(replaced(replaced(json, "\"count\":24", "\"count\":6"), ":48", ":12"), "156", "120");
    return readOk(makeGlb(json, buffer.bytes))->mesh().faceVertices;
  };
  EXPECT_EQ(facesOf("5"), (std::vector<std::uint32_t>{0, 3, 1, 1, 3, 4}));
  EXPECT_EQ(facesOf("6"), (std::vector<std::uint32_t>{0, 3, 1, 0, 1, 4, 0, 4, 5}));
  EXPECT_EQ(facesOf("4"), (std::vector<std::uint32_t>{0, 3, 1, 4, 4, 5}));
}

TEST(ReadGltf, ReadsInterleavedPositionsAtTheirStride) {
  BufferBuilder buffer;
  for (std::size_t v = 0; v < 9; ++v) {
    buffer.floats({9, 9, 9});
    buffer.floats({gridPositions()[3 * v], gridPositions()[3 * v + 1], gridPositions()[3 * v + 2]});
    buffer.floats({8});
  }
  const std::size_t indices = buffer.indices("ushort", gridTriangles());
  std::string json = gridGltf().json;
  json = replaced(json, R"("byteLength":108,"target":34962)", R"("byteLength":252,"byteStride":28)");
  json = replaced(json, "\"byteOffset\":108", "\"byteOffset\":" + std::to_string(indices));
  json = replaced(json, R"("bufferView":0,"componentType":5126)",
                  R"("bufferView":0,"byteOffset":12,"componentType":5126)");
  json = replaced(json, "156", std::to_string(buffer.bytes.size()));
  EXPECT_EQ(readOk(makeGlb(json, buffer.bytes))->mesh().positions, gridPositions());
}

/// Two meshes of one triangle each over a buffer of six positions.
std::string twoMeshes(const std::string& accessors, const std::string& meshes) {
  return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":72}],"bufferViews":[{"buffer":0,"byteLength":72}],"accessors":[)" +
         accessors + R"(],"meshes":[)" + meshes +
         R"(],"nodes":[{"mesh":1,"name":"b"},{"name":"empty"},{"mesh":0},{"mesh":1}]})";
}
std::string accessor(int byteOffset, int count) {
  return R"({"bufferView":0,"byteOffset":)" + std::to_string(byteOffset) + R"(,"componentType":5126,"count":)" +
         std::to_string(count) + R"(,"type":"VEC3"})";
}
std::string meshOf(const std::string& positions) {
  return R"({"primitives":[{"attributes":{"POSITION":)" + replaced(positions, ",", R"(}},{"attributes":{"POSITION":)") +
         "}}]}";
}
FileBytes sixPositions() {
  BufferBuilder buffer;
  buffer.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1});
  return buffer.bytes;
}

TEST(ReadGltf, NumbersMeshesAsGroups) {
  const auto model = readOk(
      makeGlb(twoMeshes(accessor(36, 3) + "," + accessor(0, 3), meshOf("0") + "," + meshOf("1")), sixPositions()));
  EXPECT_EQ(model->mesh().groups, (std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(model->vertexMesh(), (std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(model->mesh().positions[2], 1);  // arrays come in the order of first use, not of bytes
  EXPECT_EQ(model->mesh().faceVertices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  ASSERT_EQ(model->nodes().size(), 3u);
  EXPECT_EQ(model->nodes()[0].node, 0u);
  EXPECT_EQ(model->nodes()[0].mesh, 1u);
  EXPECT_EQ(model->nodes()[0].name, "b");
  EXPECT_EQ(model->nodes()[2].node, 3u);
  EXPECT_EQ(model->info().nodes, 4u);
}

TEST(ReadGltf, ReadsSharedPositionsOnceAndJoinsTheirMeshesToOneGroup) {
  // The same accessor, another accessor of the same bytes, and one shifted by whole elements.
  for (const std::string& second : {std::string("0"), std::string("1"), std::string("2")}) {
    const std::string accessors = accessor(0, 6) + "," + accessor(0, 6) + "," + accessor(36, 3);
    const auto model = readOk(makeGlb(twoMeshes(accessors, meshOf("0") + "," + meshOf(second)), sixPositions()));
    EXPECT_EQ(model->mesh().vertexCount(), 6u);
    EXPECT_TRUE(model->mesh().groups.empty());
    EXPECT_EQ(model->vertexMesh(), std::vector<std::uint32_t>(6, 0));
  }
  const auto chained = readOk(
      makeGlb(twoMeshes(accessor(0, 4) + "," + accessor(36, 3), meshOf("0") + "," + meshOf("1")), sixPositions()));
  EXPECT_EQ(chained->mesh().vertexCount(), 6u);
  EXPECT_TRUE(chained->mesh().groups.empty());
  EXPECT_EQ(chained->vertexMesh(), (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1}));
  EXPECT_EQ(chained->mesh().faceVertices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
}

TEST(ReadGltf, TakesTheSameFacesOfTwoPrimitivesOnce) {
  const auto model = readOk(makeGlb(twoMeshes(accessor(0, 6), meshOf("0,0") + "," + meshOf("0")), sixPositions()));
  EXPECT_EQ(model->mesh().faceCount(), 2u);
  EXPECT_EQ(model->info().primitives, 3u);
}

TEST(ReadGltf, ReadsPositionsThatOverlapWithAnotherLayoutButRefusesToPatchThem) {
  const std::string other = replaced(accessor(0, 6), "5126", "5122");
  for (const std::string& second : {accessor(4, 3), other}) {
    const FileBytes file =
        makeGlb(twoMeshes(accessor(0, 3) + "," + second, meshOf("0") + "," + meshOf("1")), sixPositions());
    const auto model = readOk(file);
    ASSERT_NE(model, nullptr);
    ASSERT_EQ(model->info().warnings.size(), 1u);
    const Result<PatchedFile> patched = model->patch(file, {}, model->mesh().positions);
    ASSERT_FALSE(patched.ok());
    EXPECT_EQ(patched.error().code, ErrorCode::unsupportedFile);
    EXPECT_NE(patched.error().message.find("accessor 0 and accessor 1 hold positions that overlap"), std::string::npos)
        << patched.error().message;
  }
}

TEST(ReadGltf, TreatsTwoBuffersOfTheSameFileAsOne) {
  std::string json = twoMeshes(accessor(0, 6) + "," + replaced(accessor(0, 6), "\"bufferView\":0", "\"bufferView\":1"),
                               meshOf("0") + "," + meshOf("1"));
  json = replaced(json, R"([{"byteLength":72}])",
                  R"([{"byteLength":72,"uri":"a.bin"},{"byteLength":72,"uri":"./a.bin"}])");
  json = replaced(json, R"("bufferViews":[)", R"("bufferViews":[{"buffer":1,"byteLength":72},)");
  const auto model = readOk(bytesOf(json), {{"a.bin", sixPositions()}});
  EXPECT_EQ(model->mesh().vertexCount(), 6u);
}

TEST(ReadGltf, PassesPointsLinesAndPrimitivesWithoutPositionThrough) {
  const std::string points =
      R"({"attributes":{"POSITION":0},"mode":0},{"attributes":{"POSITION":77},"mode":1},{"attributes":{}},)";
  const auto model = readOk(with(R"("primitives":[)", R"("primitives":[)" + points));
  EXPECT_EQ(model->info().warnings, (std::vector<std::string>{"mesh 0 primitive 0: POINTS are passed through",
                                                              "mesh 0 primitive 1: LINES are passed through",
                                                              "mesh 0 primitive 2: no POSITION, passed through"}));
  EXPECT_EQ(model->mesh().faceCount(), 8u);
  expectRefused(with("\"indices\":1", "\"mode\":3"), ErrorCode::badMesh, "no triangles");
  expectRefused(with("\"POSITION\"", "\"NORMAL\""), ErrorCode::badMesh, "no triangles");
  expectRefused(bytesOf(R"({"asset":{"version":"2.0"}})"), ErrorCode::badMesh, "no triangles");
}

TEST(ReadGltf, ReadsFilesWhoseOtherPartsAreBroken) {
  const std::string others =
      R"({"bufferView":99,"componentType":1,"count":-1,"type":"VEC9"},7,null,{"bufferView":2,"componentType":5126,"count":4000000000,"type":"MAT4"})";
  std::string json =
      replaced(gridGltf().json, R"("count":24,"type":"SCALAR"})", R"("count":24,"type":"SCALAR"},)" + others);
  json = replaced(
      json, R"("byteOffset":108,"byteLength":48})",
      R"("byteOffset":108,"byteLength":48},{"buffer":5},{},"x",{"buffer":0,"byteOffset":155,"byteLength":99})");
  json = replaced(
      json, R"("nodes":[)",
      R"("images":[{"uri":"x.png"},{"bufferView":4},{"bufferView":3}],"skins":5,"animations":[{"samplers":7}],"nodes":[)");
  const auto model = readOk(makeGlb(json, gridGltf().bin));
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->mesh().faceCount(), 8u);
}

TEST(ReadGltf, RefusesWhatThisVersionCannotHandleByName) {
  expectRefused(with("\"indices\":1", R"("indices":1,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0}})"),
                ErrorCode::badFile, "mesh 0 primitive 0 KHR_draco_mesh_compression attributes");
  for (const std::string name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    expectRefused(with("\"target\":34962", "\"extensions\":{\"" + name + "\":{}}"), ErrorCode::badFile,
                  "bufferView 0 " + name + " has no buffer");
    expectRefused(with(R"("byteLength":48)", R"("byteLength":48,"extensions":{")" + name + "\":{}}"),
                  ErrorCode::badFile, "bufferView 1 " + name + " has no buffer");
  }
  expectRefused(with("\"version\":\"2.0\"", "\"version\":\"1.0\""), ErrorCode::unsupportedFile, "glTF version \"1.0\"");
  const auto required =
      readOk(with("\"extensionsUsed\"", R"("extensionsRequired":["VENDOR_unknown"],"extensionsUsed")"));
  EXPECT_NE(required, nullptr);
}

TEST(ReadGltf, RefusesContradictionsNamingThePlace) {
  expectRefused(with("\"count\":9", "\"count\":10"), ErrorCode::badFile,
                "accessor 0: byteOffset 0 with 10 elements exceeds bufferView 0 (108 bytes)");
  expectRefused(with("\"count\":9", "\"count\":4294967295"), ErrorCode::badFile, "accessor 0");
  expectRefused(with("\"count\":9", "\"count\":4294967305"), ErrorCode::badFile, "accessor 0 count");  // 9 modulo 2^32
  expectRefused(with("\"count\":9", "\"count\":18446744073709551625"), ErrorCode::badFile, "accessor 0 count");
  expectRefused(with("\"count\":9", "\"count\":-9"), ErrorCode::badFile, "accessor 0 count");
  expectRefused(with("\"count\":9", "\"count\":0"), ErrorCode::badFile, "accessor 0: count is 0");
  expectRefused(with("\"count\":9", "\"count\":8"), ErrorCode::badFile,
                "mesh 0 primitive 0: index 8 at position 20 exceeds accessor 0 (8 vertices)");
  expectRefused(with("\"count\":9,", ""), ErrorCode::badFile, "accessor 0 has no count");
  expectRefused(with("\"count\":24", "\"count\":25"), ErrorCode::badFile, "accessor 1");
  expectRefused(with("\"bufferView\":0", "\"bufferView\":2"), ErrorCode::badFile,
                "accessor 0 refers to bufferView 2 of 2");
  expectRefused(with("\"byteOffset\":108", "\"byteOffset\":109"), ErrorCode::badFile,
                "bufferView 1 with byteOffset 109");
  expectRefused(with("\"byteOffset\":108", "\"byteOffset\":4294967404"), ErrorCode::badFile, "bufferView 1 byteOffset");
  expectRefused(with("\"byteLength\":108", "\"byteLength\":1e300"), ErrorCode::badFile, "bufferView 0 byteLength");
  expectRefused(with("{\"buffer\":0,\"byteLength\":108", "{\"buffer\":1,\"byteLength\":108"), ErrorCode::badFile,
                "bufferView 0 refers to buffer 1 of 1");
  expectRefused(with("\"target\":34962", "\"byteStride\":8"), ErrorCode::badFile, "overlap at the byteStride 8");
  expectRefused(with("\"target\":34962", "\"byteStride\":13"), ErrorCode::badFile,
                "bufferView 0 has the byteStride 13");
  expectRefused(with("\"byteLength\":156", "\"byteLength\":157"), ErrorCode::badFile,
                "buffer 0: byteLength is 157, the BIN chunk has 156 bytes");
  expectRefused(with("\"indices\":1", "\"indices\":2"), ErrorCode::badFile, "mesh 0 primitive 0 indices");
  expectRefused(with("\"POSITION\":0", "\"POSITION\":2"), ErrorCode::badFile, "mesh 0 primitive 0 POSITION");
  expectRefused(with("\"POSITION\":0", "\"POSITION\":\"0\""), ErrorCode::badFile, "mesh 0 primitive 0 POSITION");
  expectRefused(with("\"POSITION\":0", "\"POSITION\":1"), ErrorCode::badFile, "is not a VEC3 of floats or of 8- or 16-bit integers");
  expectRefused(with("\"indices\":1", "\"indices\":0"), ErrorCode::badFile, "is not a SCALAR of unsigned integers");
  expectRefused(with("\"mesh\":0", "\"mesh\":1"), ErrorCode::badFile, "node 0 refers to mesh 1 of 1");
  expectRefused(with("\"VEC3\"", "\"VEC\""), ErrorCode::badFile, "accessor 0 has the unknown type \"VEC\"");
  expectRefused(with("5123", "5124"), ErrorCode::badFile, "accessor 1 has the unknown componentType 5124");
  expectRefused(with("{\"version\":\"2.0\"", "{\"version\":2"), ErrorCode::badFile, "asset.version is missing");
  expectRefused(makeGlb(gridGltf().json), ErrorCode::badFile, "buffer 0: the GLB has no BIN chunk");
  expectRefused(bytesOf(gridGltf().json), ErrorCode::badFile, "buffer 0 has no uri");
}

TEST(ReadGltf, RefusesPositionsThatAreNotFiniteNamingTheVertex) {
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    GridGltf file = gridGltf();
    io::store(&file.bin[4 * 13], static_cast<float>(value));
    expectRefused(file.glb(), ErrorCode::badMesh, "accessor 0: vertex 4, component y is not finite");
  }
  GridGltf flat = gridGltf();
  std::fill(flat.bin.begin(), flat.bin.begin() + 108, 0);
  expectRefused(flat.glb(), ErrorCode::badMesh, "at one point");
}

TEST(ReadGltf, RefusesEveryTruncation) {
  const FileBytes glb = gridGltf().glb();
  for (std::size_t size = 0; size < glb.size(); ++size) {
    const Result<std::unique_ptr<Model>> model =
        readModel(FileBytes(glb.begin(), glb.begin() + static_cast<std::ptrdiff_t>(size)));
    ASSERT_FALSE(model.ok()) << size;
    ASSERT_EQ(model.error().code, ErrorCode::badFile) << model.error().message;
  }
  const GridGltf outside = gridGltf("\"uri\":\"a.bin\",");
  for (std::size_t size = 0; size < outside.json.size(); ++size) {
    const Result<std::unique_ptr<Model>> model =
        readModel(bytesOf(outside.json.substr(0, size)), {{"a.bin", outside.bin}});
    ASSERT_FALSE(model.ok()) << size;
    ASSERT_EQ(model.error().code, ErrorCode::badFile) << model.error().message;
  }
  for (std::size_t size = 0; size < outside.bin.size(); ++size) {
    const FileBytes cut(outside.bin.begin(), outside.bin.begin() + static_cast<std::ptrdiff_t>(size));
    expectRefused(bytesOf(outside.json), ErrorCode::badFile, "buffer 0: byteLength is 156", {{"a.bin", cut}});
  }
  const GridGltf inside = gridGltf("\"uri\":\"data:;base64," + base64(gridGltf().bin) + "\",");
  for (std::size_t size = 0; size < inside.json.size(); ++size) {
    ASSERT_FALSE(readModel(bytesOf(inside.json.substr(0, size))).ok()) << size;
  }
}

TEST(ReadGltf, RefusesBrokenContainers) {
  const FileBytes glb = gridGltf().glb();
  const auto changed = [&](std::size_t at, std::uint32_t value) {
    FileBytes file = glb;
    io::store(&file[at], value);
    return file;
  };
  const std::uint32_t jsonBytes = io::load<std::uint32_t>(&glb[12]);
  expectRefused(changed(0, 0x46546c66), ErrorCode::badFile, "not a PLY, glTF, GLB or DRC");
  expectRefused(changed(4, 1), ErrorCode::unsupportedFile, "GLB version 1");
  expectRefused(changed(8, static_cast<std::uint32_t>(glb.size() + 1)), ErrorCode::badFile, "GLB: the header says");
  expectRefused(changed(8, 11), ErrorCode::badFile, "GLB: the header says 11");
  expectRefused(changed(8, 12), ErrorCode::badFile, "no JSON chunk");
  expectRefused(changed(12, 0xffffffff), ErrorCode::badFile, "GLB chunk 0: 4294967295 bytes are claimed");
  expectRefused(changed(16, 0x004e4942), ErrorCode::badFile, "the first chunk is not JSON");
  expectRefused(changed(20 + jsonBytes, 157), ErrorCode::badFile, "GLB chunk 1: 157 bytes are claimed");
  expectRefused(changed(24 + jsonBytes, 0x12345678), ErrorCode::badFile, "no BIN chunk");
  expectRefused(makeGlb("[]"), ErrorCode::badFile, "not an object");
  expectRefused(makeGlb("{"), ErrorCode::badFile, "JSON byte 4");
  expectRefused(bytesOf("{\"asset\":" + std::string(100000, '[')), ErrorCode::badFile, "nested too deep");
}

TEST(ReadGltf, KeepsUnknownChunksAndBytesAfterTheEnd) {
  FileBytes glb = gridGltf().glb();
  appendScalar(glb, "uint", 4, io::ByteOrder::little);
  appendScalar(glb, "uint", 0x58585858, io::ByteOrder::little);
  appendScalar(glb, "uint", 7, io::ByteOrder::little);
  io::store(&glb[8], static_cast<std::uint32_t>(glb.size()));
  EXPECT_TRUE(readOk(glb)->info().warnings.empty());
  glb.push_back('x');
  const auto model = readOk(glb);
  EXPECT_EQ(model->info().warnings, std::vector<std::string>{"1 bytes after the GLB's end are kept as they are"});
  EXPECT_EQ(model->patch(glb, {}, model->mesh().positions)->bytes, glb);
}

TEST(ExternalUris, ListsBuffersOnceInFileOrder) {
  const std::string json =
      R"({"buffers":[{"uri":"b.bin"},{"uri":"data:;base64,AAAA"},{},{"uri":"a%20b.bin"},{"uri":"b.bin"},{"uri":7}],"images":[{"uri":"c.png"}]})";
  EXPECT_EQ(*externalUris(bytesOf(json)), (std::vector<std::string>{"b.bin", "a%20b.bin"}));
  EXPECT_EQ(*externalUris(makeGlb(json)), (std::vector<std::string>{"b.bin", "a%20b.bin"}));
  EXPECT_TRUE(externalUris(makePly(PlySpec{}))->empty());
  EXPECT_EQ(externalUris(bytesOf("{")).error().code, ErrorCode::badFile);
}

}  // namespace
}  // namespace quadmark::test
