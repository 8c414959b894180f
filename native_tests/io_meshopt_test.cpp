// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "io/gltf_container.h"
#include "io/meshopt.h"
#include "io_allocations.h"
#include "io_fixtures.h"
#include "io_streams.h"
#include "quadmark/random.h"

namespace quadmark::test {
namespace {

using io::decodeMeshopt;
using io::MeshoptFilter;
using io::MeshoptLayout;
using io::MeshoptMode;

/// The triangles as the mode TRIANGLES gives them back: some begin with another corner, which the mode permits.
const std::vector<std::vector<int>>& turnedTriangles() {
  static const std::vector<std::vector<int>> faces = {{0, 1, 4}, {0, 4, 3}, {4, 1, 2}, {4, 2, 5},
                                                      {3, 4, 6}, {6, 4, 7}, {4, 5, 8}, {4, 8, 7}};
  return faces;
}

FileBytes plainOf(const Golden& entry, const std::string& indexType = "ushort") {
  BufferBuilder buffer;
  if (entry.layout.mode == MeshoptMode::attributes) {
    buffer.floats(gridPositions());
  } else {
    buffer.indices(indexType, entry.layout.mode == MeshoptMode::indices ? gridTriangles() : turnedTriangles());
  }
  return buffer.bytes;
}

TEST(Meshopt, DecodesEveryCodec) {
  for (const Golden& entry : golden()) {
    SCOPED_TRACE(entry.name);
    const auto plain = decodeMeshopt(entry.stream, entry.layout, "view");
    ASSERT_TRUE(plain.ok()) << plain.error().message;
    EXPECT_EQ(*plain, plainOf(entry));
  }
}

TEST(Meshopt, DecodesIndicesOf32Bits) {
  for (const char* name : {"triangles", "indices"}) {
    MeshoptLayout layout = goldenOf(name).layout;
    layout.byteStride = 4;
    const auto plain = decodeMeshopt(goldenOf(name).stream, layout, "view");
    ASSERT_TRUE(plain.ok());
    EXPECT_EQ(*plain, plainOf(goldenOf(name), "uint"));
  }
}

TEST(Meshopt, RefusesStreamsOfAnyOtherLength) {
  for (const Golden& entry : golden()) {
    SCOPED_TRACE(entry.name);
    FileBytes stream = entry.stream;
    stream.push_back(0);
    EXPECT_FALSE(decodeMeshopt(stream, entry.layout, "view").ok());
    for (std::size_t length = 0; length < entry.stream.size(); ++length) {
      const FileBytes prefix(entry.stream.begin(), entry.stream.begin() + static_cast<std::ptrdiff_t>(length));
      EXPECT_FALSE(decodeMeshopt(prefix, entry.layout, "view").ok()) << length;
    }
  }
}

TEST(Meshopt, RefusesOtherLayoutsAndCodecs) {
  for (const Golden& entry : golden()) {
    SCOPED_TRACE(entry.name);
    for (const std::uint32_t stride : {0u, 1u, 3u, 10u, 260u}) {
      MeshoptLayout layout = entry.layout;
      layout.byteStride = stride;
      EXPECT_EQ(decodeMeshopt(entry.stream, layout, "bufferView 7").error().code, ErrorCode::badFile) << stride;
    }
    MeshoptLayout layout = entry.layout;
    layout.count += 300;
    EXPECT_FALSE(decodeMeshopt(entry.stream, layout, "view").ok());
    FileBytes stream = entry.stream;
    stream[0] ^= 2;
    const auto other = decodeMeshopt(stream, entry.layout, "bufferView 7");
    ASSERT_FALSE(other.ok());
    EXPECT_NE(other.error().message.find("bufferView 7: the meshopt data is broken"), std::string::npos);
  }
  MeshoptLayout layout = golden()[0].layout;
  layout.filter = MeshoptFilter::octahedral;
  EXPECT_EQ(decodeMeshopt(golden()[0].stream, layout, "view").error().code, ErrorCode::unsupportedFile);
}

TEST(Meshopt, SurvivesDamagedStreams) {
  Random random(7);
  for (const Golden& entry : golden()) {
    for (int round = 0; round < 2000; ++round) {
      FileBytes stream = entry.stream;
      for (int i = 0; i < 3; ++i) {
        stream[random.below(static_cast<std::uint32_t>(stream.size()))] = static_cast<std::uint8_t>(random.below(256));
      }
      const auto plain = decodeMeshopt(stream, entry.layout, "view");
      EXPECT_EQ(plain.ok() ? plain->size() : 0, plain.ok() ? entry.layout.count * entry.layout.byteStride : 0);
    }
  }
}

std::string goldenName(const ::testing::TestParamInfo<std::tuple<const char*, const char*, const char*>>& info) {
  return replaced(std::string(std::get<0>(info.param)) + "_" + std::get<1>(info.param) + "_" + std::get<2>(info.param),
                  " ", "_");
}

/// The grid with compressed views: extension, vertex stream, index stream.
class CompressedGrid : public ::testing::TestWithParam<std::tuple<const char*, const char*, const char*>> {
 protected:
  void SetUp() override {
    const auto [extension, vertexStream, indexStream] = GetParam();
    GridGltf grid = meshoptGrid(extension, vertexStream, indexStream);
    json_ = std::move(grid.json);
    bin_ = std::move(grid.bin);
    extension_ = extension;
  }

  std::string json_, extension_;
  FileBytes bin_;
};

INSTANTIATE_TEST_SUITE_P(AllCodecs, CompressedGrid,
                         ::testing::Combine(::testing::Values("EXT_meshopt_compression", "KHR_meshopt_compression"),
                                            ::testing::Values("vertex codec 0", "vertex codec 1", "exponential filter"),
                                            ::testing::Values("triangles", "indices")),
                         goldenName);

TEST_P(CompressedGrid, IsReadAsThePlainOne) {
  const auto model = readModel(makeGlb(json_, bin_));
  ASSERT_TRUE(model.ok()) << model.error().message;
  EXPECT_EQ((*model)->mesh().positions, gridPositions());
  std::vector<std::uint32_t> corners;
  const bool turns = goldenOf(std::get<2>(GetParam())).layout.mode == MeshoptMode::triangles;
  for (const std::vector<int>& face : turns ? turnedTriangles() : gridTriangles()) {
    corners.insert(corners.end(), face.begin(), face.end());
  }
  EXPECT_EQ((*model)->mesh().faceVertices, corners);
  EXPECT_TRUE((*model)->info().warnings.empty());

  const std::string external = replaced(json_, "\"buffers\":[{", "\"buffers\":[{\"uri\":\"a.bin\",");
  const auto split = readModel(bytesOf(external), {{"a.bin", bin_}});
  ASSERT_TRUE(split.ok()) << split.error().message;
  EXPECT_EQ((*split)->mesh().positions, gridPositions());
}

TEST_P(CompressedGrid, StaysAsItIsWhenNothingMoves) {
  const FileBytes file = makeGlb(json_, bin_);
  const auto model = readModel(file);
  const auto patched = (*model)->patch(file, {}, gridPositions());
  ASSERT_TRUE(patched.ok()) << patched.error().message;
  EXPECT_EQ(patched->bytes, file);
  EXPECT_TRUE(patched->warnings.empty());
  EXPECT_EQ(patched->bytesChanged, 0u);
}

TEST_P(CompressedGrid, GetsPlainPositionsWhenMarked) {
  const FileBytes file = makeGlb(json_, bin_);
  const auto model = readModel(file);
  const auto patched = (*model)->patch(file, {}, movedGrid());
  ASSERT_TRUE(patched.ok()) << patched.error().message;
  const auto back = readModel(patched->bytes);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ((*back)->mesh().positions, movedGrid());
  EXPECT_EQ((*back)->mesh().faceVertices, (*model)->mesh().faceVertices);
  ASSERT_EQ(patched->warnings.size(), 1u);
  EXPECT_NE(patched->warnings[0].find("no longer compressed by " + extension_), std::string::npos);

  // The text differs in the view, the bounds and the length of the BIN chunk alone; the old chunk is still there.
  const auto container = io::openGltf(patched->bytes);
  const std::size_t end = bin_.size();
  const std::string_view text = container->json(patched->bytes);
  std::string expected = json_;
  const std::size_t begin = expected.find(", \"extensions\"");
  expected.erase(begin, expected.find("}}", begin) + 2 - begin);
  expected =
      replaced(expected, R"({"buffer":1,"byteOffset":0,)", R"({"buffer":0,"byteOffset":)" + std::to_string(end) + ",");
  expected = replaced(expected, R"("min":[0,0,-1],"max":[2,2,0.76])", R"("min":[0,0,-1.25],"max":[2,2,0.75])");
  expected =
      replaced(expected, "[{\"byteLength\":" + std::to_string(end), "[{\"byteLength\":" + std::to_string(end + 108));
  EXPECT_EQ(text.substr(0, text.find_last_not_of(' ') + 1), expected);
  const io::Bytes bin = container->bin(patched->bytes);
  ASSERT_EQ(bin.size(), end + 108);
  EXPECT_EQ(FileBytes(bin.begin(), bin.begin() + static_cast<std::ptrdiff_t>(end)), bin_);
  EXPECT_GE(patched->bytesChanged, 108u);
}

TEST_P(CompressedGrid, GivesTheExtensionUpWithItsLastUse) {
  // Indices plain, no placeholder: nothing else is compressed.
  const std::size_t at = json_.find(", \"extensions\"", json_.find("34963"));
  json_.erase(at, json_.find("}}}", at) + 2 - at);
  const std::size_t placeholder = json_.find(",\"extensions\":{\"" + extension_ + "\":{\"fallback\"");
  json_.erase(placeholder, json_.find("}}}", placeholder) + 2 - placeholder);
  json_ = replaced(json_, "{\"byteLength\":156}", "{\"byteLength\":156,\"uri\":\"b.bin\"}");
  const FileBytes fallback = gridGltf().bin;
  const FileBytes file = makeGlb(json_, bin_);
  const auto model = readModel(file, {{"b.bin", fallback}});
  ASSERT_TRUE(model.ok()) << model.error().message;
  const auto patched = (*model)->patch(file, {{"b.bin", fallback}}, movedGrid());
  ASSERT_TRUE(patched.ok()) << patched.error().message;
  EXPECT_TRUE(patched->resources.empty());
  const std::string text = textOf(patched->bytes);
  EXPECT_EQ(text.find(extension_), std::string::npos);
  EXPECT_NE(text.find(R"("extensionsUsed":["KHR_materials_unlit"],)"), std::string::npos);
  EXPECT_EQ(text.find("extensionsRequired"), std::string::npos);
  EXPECT_EQ((*readModel(patched->bytes, {{"b.bin", fallback}}))->mesh().positions, movedGrid());
}

TEST_P(CompressedGrid, IsRefusedWithThePlaceOfTheFault) {
  const auto refusal = [&](const std::string& what, const std::string& by) {
    const auto model = readModel(makeGlb(replaced(json_, what, by), bin_));
    EXPECT_FALSE(model.ok()) << by;
    return model.ok() ? Error{} : model.error();
  };
  const std::string view = "bufferView 0 " + extension_;
  EXPECT_EQ(refusal("ATTRIBUTES", "POINTS").message, view + " has the unknown mode \"POINTS\"");
  EXPECT_EQ(refusal("\"count\":9,\"mode\"", "\"count\":8,\"mode\"").message,
            view + " decodes to 96 bytes, the view has 108");
  EXPECT_EQ(refusal("\"buffer\":0,\"byteOffset\":0", "\"buffer\":2,\"byteOffset\":0").message,
            view + " refers to buffer 2 of 2");
  EXPECT_NE(
      refusal("\"byteOffset\":0,\"byteLength\":" + std::to_string(goldenOf(std::get<1>(GetParam())).stream.size()),
              "\"byteOffset\":0,\"byteLength\":999")
          .message.find(view + " exceeds buffer 0"),
      std::string::npos);
}

TEST(CompressedGltf, AllocatesNoMoreThanItsBytesAllow) {
  // Codec 1 spends no bytes on constant vertices, so a short stream may claim any number of them.
  const std::string json = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":28},{"byteLength":4294967040}],
 "bufferViews":[{"buffer":1,"byteLength":4294967040,"extensions":{"KHR_meshopt_compression":{
  "buffer":0,"byteLength":28,"byteStride":12,"count":357913920,"mode":"ATTRIBUTES"}}}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":357913920,"type":"VEC3"}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})";
  const FileBytes file = makeGlb(json, FileBytes(28, 0xa1));
#if QM_COUNT_ALLOCATIONS
  resetLargestAllocation();
#endif
  const auto model = readModel(file);
  ASSERT_FALSE(model.ok());
  EXPECT_EQ(model.error().code, ErrorCode::tooLarge);
#if QM_COUNT_ALLOCATIONS
  EXPECT_LT(largestAllocation(), std::size_t{1} << 20);
#endif
}

}  // namespace
}  // namespace quadmark::test
