// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "io/allowed_spans.h"
#include "io/data_uri.h"
#include "io_fixtures.h"
#include "models.h"

namespace quadmark::test {
namespace {

std::unique_ptr<Model> readOk(const FileBytes& file, const Resources& resources = {}) {
  Result<std::unique_ptr<Model>> model = readModel(file, resources);
  EXPECT_TRUE(model.ok()) << model.error().message;
  return model.ok() ? std::move(model).value() : nullptr;
}

PatchedFile patchOk(const FileBytes& file, const std::vector<double>& positions, const Resources& resources = {}) {
  const auto model = readOk(file, resources);
  Result<PatchedFile> patched = model->patch(file, resources, positions);
  EXPECT_TRUE(patched.ok()) << patched.error().message;
  return patched.ok() ? std::move(patched).value() : PatchedFile{};
}

std::uint64_t countDifferent(const FileBytes& a, const FileBytes& b) {
  EXPECT_EQ(a.size(), b.size());
  std::uint64_t different = 0;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) different += a[i] != b[i] ? 1 : 0;
  return different;
}

/// The grid with an inner vertex moved: no bound changes.
std::vector<double> movedInside() {
  std::vector<double> positions = gridPositions();
  positions[3 * 4] = 1.1f;
  positions[3 * 4 + 2] = -0.3f;
  return positions;
}

/// The grid with bounds that change: z of vertex 8 (min) and x of all vertices at 2 (max).
std::vector<double> movedBounds() {
  std::vector<double> positions = gridPositions();
  positions[3 * 8 + 2] = -1.1f;
  for (const std::size_t vertex : {2, 5, 8}) positions[3 * vertex] = 1.9f;
  return positions;
}

FileBytes binWith(const std::vector<double>& positions) {
  FileBytes bin = gridGltf().bin;
  for (std::size_t i = 0; i < positions.size(); ++i) io::store(&bin[4 * i], static_cast<float>(positions[i]));
  return bin;
}

/// The grid's JSON as the patch must leave it for movedBounds().
std::string withMovedBounds(std::string json) {
  return replaced(replaced(json, "[0, 0.0,-1.000]", "[0, 0.0,-1.1]"), "[2,2e0 ,0.75]", "[1.9,2e0 ,0.75]");
}

TEST(PatchGltf, LeavesTheFileAloneWhenNothingMoves) {
  std::vector<double> positions = gridPositions();
  for (double& value : positions) value = value == 0 ? -0.0 : value;
  const FileBytes glb = gridGltf().glb();
  EXPECT_EQ(patchOk(glb, positions).bytes, glb);
  EXPECT_EQ(patchOk(glb, positions).bytesChanged, 0u);

  const GridGltf outside = gridGltf("\"uri\":\"a.bin\",");
  const PatchedFile patched = patchOk(bytesOf(outside.json), positions, {{"a.bin", outside.bin}});
  EXPECT_EQ(textOf(patched.bytes), outside.json);
  EXPECT_TRUE(patched.resources.empty());

  const FileBytes inside = bytesOf(gridGltf("\"uri\":\"data:;base64," + base64(outside.bin) + "\",").json);
  EXPECT_EQ(patchOk(inside, positions).bytes, inside);
}

TEST(PatchGltf, ChangesOnlyComponentsWhenBoundsStay) {
  const GridGltf file = gridGltf();
  const PatchedFile patched = patchOk(file.glb(), movedInside());
  EXPECT_EQ(patched.bytes, makeGlb(file.json, binWith(movedInside())));
  EXPECT_EQ(patched.bytesChanged, countDifferent(file.glb(), patched.bytes));
  EXPECT_EQ(readOk(patched.bytes)->mesh().positions, movedInside());
}

TEST(PatchGltf, RewritesOnlyBoundsThatChangeAndKeepsAllOtherText) {
  const GridGltf file = gridGltf();
  const PatchedFile patched = patchOk(file.glb(), movedBounds());
  EXPECT_EQ(patched.bytes, makeGlb(withMovedBounds(file.json), binWith(movedBounds())));
  EXPECT_EQ(readOk(patched.bytes)->mesh().positions, movedBounds());
  EXPECT_GE(patched.bytesChanged, 5u);
}

TEST(PatchGltf, PadsTheJsonChunkForEveryTextLength) {
  for (int blanks = 0; blanks < 8; ++blanks) {
    SCOPED_TRACE(blanks);
    const GridGltf file = gridGltf();
    std::string json = file.json;
    json.insert(1, static_cast<std::size_t>(blanks), ' ');
    const PatchedFile patched = patchOk(makeGlb(json, file.bin), movedBounds());
    EXPECT_EQ(patched.bytes, makeGlb(withMovedBounds(json), binWith(movedBounds())));
    EXPECT_EQ(patched.bytes.size() % 4, 0u);
    EXPECT_EQ(io::load<std::uint32_t>(&patched.bytes[8]), patched.bytes.size());
  }
}

TEST(PatchGltf, KeepsBoundsThatWereWrongOrBroken) {
  for (const std::string& bounds :
       {std::string(R"("min":[0,0,-7],"max":[2,2,7])"), std::string(R"("min":[0,0],"max":"x")"),
        std::string(R"("min":[null,[0],-1.000],"max":{})")}) {
    const GridGltf file = gridGltf();
    const std::string json = replaced(file.json, R"("min":[0, 0.0,-1.000],"max":[2,2e0 ,0.75])", bounds);
    EXPECT_EQ(patchOk(makeGlb(json, file.bin), movedInside()).bytes, makeGlb(json, binWith(movedInside())));
    const PatchedFile patched = patchOk(makeGlb(json, file.bin), movedBounds());
    const std::string expected = replaced(replaced(json, "-1.000", "-1.1"), R"("min":[0,0,-7],"max":[2,2,7])",
                                          R"("min":[0,0,-1.1],"max":[1.9,2,7])");
    EXPECT_EQ(patched.bytes, makeGlb(expected, binWith(movedBounds())));
  }
}

TEST(PatchGltf, EditsTheLastOfRepeatedKeys) {
  const GridGltf file = gridGltf();
  const std::string json = replaced(file.json, "\"min\":[0, 0.0,-1.000]", "\"min\":[5,5,5],\"min\":[0, 0.0,-1.000]");
  const PatchedFile patched = patchOk(makeGlb(json, file.bin), movedBounds());
  EXPECT_EQ(patched.bytes, makeGlb(withMovedBounds(json), binWith(movedBounds())));
}

TEST(PatchGltf, ReturnsChangedExternalBuffersUnderTheCallersName) {
  const GridGltf file = gridGltf("\"uri\":\"my%20grid.bin\",");
  FileBytes longer = file.bin;
  longer.insert(longer.end(), {1, 2, 3});  // what follows byteLength is kept
  const PatchedFile patched = patchOk(bytesOf(file.json), movedBounds(), {{"my grid.bin", longer}, {"other.bin", {1}}});
  ASSERT_EQ(patched.resources.size(), 1u);
  FileBytes expected = binWith(movedBounds());
  expected.insert(expected.end(), {1, 2, 3});
  EXPECT_EQ(patched.resources.at("my grid.bin"), expected);
  EXPECT_EQ(textOf(patched.bytes), withMovedBounds(file.json));
}

TEST(PatchGltf, ReencodesDataUrisInPlaceKeepingTheSpellingOfTheRest) {
  const std::string encoded = replaced(base64(gridGltf().bin), "/", "\\/");
  const GridGltf file = gridGltf("\"uri\":\"data:application\\/octet-stream;base64," + encoded + "\",");
  const PatchedFile patched = patchOk(bytesOf(file.json), movedBounds());
  EXPECT_EQ(readOk(patched.bytes)->mesh().positions, movedBounds());
  EXPECT_TRUE(patched.resources.empty());
  const std::string text = textOf(patched.bytes);
  const std::size_t begin = text.find("base64,") + 7;
  const std::string payload = text.substr(begin, text.find('"', begin) - begin);
  EXPECT_EQ(replaced(payload, "\\/", "/"), base64(binWith(movedBounds())));
  EXPECT_EQ(replaced(text, payload, encoded), withMovedBounds(file.json));
}

TEST(DataUri, KeepsUnusedBitsAndEscapesOfUnchangedQuads) {
  const std::string spelled = "data:;base64,AQ\\u0049D\\/\\/8EBR==";  // the last quad's unused bits are not zero
  const auto before = io::decodeDataUri(spelled, "buffer 0");
  ASSERT_TRUE(before.ok()) << before.error().message;
  EXPECT_EQ(*before, (FileBytes{1, 2, 3, 255, 255, 4, 5}));
  EXPECT_EQ(*io::recodeDataUri(spelled, *before, "buffer 0"), spelled);
  EXPECT_EQ(*io::recodeDataUri(spelled, FileBytes{1, 2, 3, 255, 255, 4, 9}, "buffer 0"),
            "data:;base64,AQ\\u0049D\\/\\/8ECQ==");
  EXPECT_EQ(*io::recodeDataUri(spelled, FileBytes{1, 2, 3, 255, 0, 4, 5}, "buffer 0"),
            "data:;base64,AQ\\u0049D\\/wAEBR==");
}

TEST(PatchGltf, WritesInterleavedComponentsOnly) {
  BufferBuilder before, after;
  for (std::size_t v = 0; v < 9; ++v) {
    for (BufferBuilder* buffer : {&before, &after}) {
      const std::vector<double>& positions = buffer == &before ? gridPositions() : movedBounds();
      buffer->floats({positions[3 * v], positions[3 * v + 1], positions[3 * v + 2], 7.5, -8});
    }
  }
  const std::size_t indices = before.indices("ushort", gridTriangles());
  after.indices("ushort", gridTriangles());
  std::string json = gridGltf().json;
  json = replaced(json, R"("byteLength":108,"target":34962)", R"("byteLength":180,"byteStride":20)");
  json = replaced(json, "\"byteOffset\":108", "\"byteOffset\":" + std::to_string(indices));
  json = replaced(json, "156", std::to_string(before.bytes.size()));
  // Texture coordinates share the stride: neighbours, not a conflict.
  json = replaced(json, R"("type":"SCALAR"})",
                  R"("type":"SCALAR"},{"bufferView":0,"byteOffset":12,"componentType":5126,"count":9,"type":"VEC2"})");
  json = replaced(json, R"("POSITION":0)", R"("TEXCOORD_0":2,"POSITION":0)");
  EXPECT_EQ(patchOk(makeGlb(json, before.bytes), movedBounds()).bytes, makeGlb(withMovedBounds(json), after.bytes));
}

std::string shared(const std::string& use, const std::string& moreAccessors = "") {
  std::string json = gridGltf().json;
  json = replaced(json, R"("type":"SCALAR"})", R"("type":"SCALAR"})" + moreAccessors);
  return replaced(json, R"("nodes":[)", use + R"("nodes":[)");
}

TEST(PatchGltf, RefusesPositionsThatOtherDataShares) {
  const std::string copy = R"(,{"bufferView":0,"componentType":5126,"count":9,"type":"VEC3"})";
  const std::string shifted = R"(,{"bufferView":0,"byteOffset":4,"componentType":5126,"count":4,"type":"VEC2"})";
  for (const std::string& json :
       {replaced(gridGltf().json, R"("POSITION":0)", R"("NORMAL":0,"POSITION":0)"),
        replaced(gridGltf().json, R"("indices":1,)", R"("indices":1,"targets":[{"POSITION":0}],)"),
        replaced(shared("", copy), R"("POSITION":0)", R"("NORMAL":2,"POSITION":0)"), shared("", shifted),
        shared(R"("animations":[{"samplers":[{"input":0,"output":0}]}],)"),
        shared(R"("images":[{"bufferView":0}],)")}) {
    const FileBytes file = makeGlb(json, gridGltf().bin);
    const auto model = readOk(file);
    ASSERT_EQ(model->info().warnings.size(), 1u);
    EXPECT_NE(model->info().warnings[0].find("marking this file will be refused"), std::string::npos);
    const Result<PatchedFile> patched = model->patch(file, {}, movedInside());
    ASSERT_FALSE(patched.ok());
    EXPECT_EQ(patched.error().code, ErrorCode::unsupportedFile);
    EXPECT_NE(patched.error().message.find("accessor 0 (POSITION) shares bytes with"), std::string::npos)
        << patched.error().message;
  }
}

TEST(PatchGltf, RefusesPositionsOverCompressedData) {
  const auto file = readFile(std::string(QUADMARK_SOURCE_DIR) +
                             "/native_tests/fuzz/found/gltf/positions-over-compressed-indices.glb");
  ASSERT_TRUE(file.has_value());
  const auto model = readOk(*file);
  const Result<PatchedFile> patched = model->patch(*file, {}, model->mesh().positions);
  ASSERT_FALSE(patched.ok());
  EXPECT_EQ(patched.error().code, ErrorCode::unsupportedFile);
  EXPECT_NE(patched.error().message.find("shares bytes with bufferView 1, which holds compressed data"), std::string::npos)
      << patched.error().message;
}

TEST(PatchGltf, KeepsTheBoundsOfAllWindowsTrue) {
  // Accessor 2 shows the last row to a second primitive, accessor 3 the whole grid as points.
  std::string json = gridGltf().json;
  json = replaced(
      json, R"("type":"SCALAR"})",
      R"("type":"SCALAR"},{"bufferView":0,"byteOffset":72,"componentType":5126,"count":3,"type":"VEC3","min":[0,2,-1],"max":[2,2,1]},)"
      R"({"bufferView":0,"componentType":5126,"count":9,"type":"VEC3","min":[0,0,-1],"max":[2,2,1]})");
  json = replaced(json, R"("primitives":[)",
                  R"("primitives":[{"attributes":{"POSITION":2}},{"attributes":{"POSITION":3},"mode":0},)");
  const PatchedFile patched = patchOk(makeGlb(json, gridGltf().bin), [] {
    std::vector<double> positions = gridPositions();
    positions[3 * 8 + 2] = -2;   // in all three
    positions[3 * 6 + 1] = 2.5;  // in all three
    positions[0] = -0.5;         // not in accessor 2
    return positions;
  }());
  const std::string text = textOf(patched.bytes);
  EXPECT_NE(text.find(R"("min":[-0.5, 0.0,-2],"max":[2,2.5 ,0.75])"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("min":[0,2,-2],"max":[2,2.5,1])"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("min":[-0.5,0,-2],"max":[2,2.5,1])"), std::string::npos) << text;
}

TEST(PatchGltf, RefusesOtherBytesAndPositionsThatDoNotFit) {
  const GridGltf file = gridGltf("\"uri\":\"a.bin\",");
  const auto model = readOk(bytesOf(file.json), {{"a.bin", file.bin}});
  const auto code = [&](const FileBytes& bytes, const Resources& resources, std::vector<double> positions) {
    const Result<PatchedFile> patched = model->patch(bytes, resources, positions);
    return patched.ok() ? ErrorCode::internal : patched.error().code;
  };
  EXPECT_EQ(code(bytesOf(file.json + " "), {{"a.bin", file.bin}}, movedInside()), ErrorCode::badOption);
  EXPECT_EQ(code(bytesOf(file.json), {}, movedInside()), ErrorCode::badFile);
  EXPECT_EQ(code(bytesOf(file.json), {{"a.bin", FileBytes(20)}}, movedInside()), ErrorCode::badFile);
  std::vector<double> positions = movedInside();
  positions[0] = 0.1;
  EXPECT_EQ(code(bytesOf(file.json), {{"a.bin", file.bin}}, positions), ErrorCode::badOption);
  positions.pop_back();
  EXPECT_EQ(code(bytesOf(file.json), {{"a.bin", file.bin}}, positions), ErrorCode::badOption);
}

TEST(AllowedSpans, ContainsExactlyItsRuns) {
  io::AllowedSpans spans;
  spans.add(100, 20, 12, 3);  // 100..111, 120..131, 140..151
  spans.add(112, 20, 4, 2);   // 112..115, 132..135
  spans.add(10, 12, 12, 2);   // 10..33
  spans.finish();
  std::string picture;
  for (std::uint64_t at = 0; at < 160; ++at) picture += spans.contains(at) ? '#' : '.';
  std::string expected(160, '.');
  const auto mark = [&](int begin, int end) { std::fill(expected.begin() + begin, expected.begin() + end, '#'); };
  mark(10, 34), mark(100, 116), mark(120, 136), mark(140, 152);
  EXPECT_EQ(picture, expected);
}

TEST(AllowedSpans, ReportsTheFirstDifferenceOutside) {
  io::AllowedSpans spans;
  spans.add(64, 12, 12, 1);
  spans.finish();
  FileBytes before(200), after(200);
  after[70] = 1;
  EXPECT_EQ(*io::countDifferences(before, after, spans), 1u);
  after[76] = 1;
  const auto refused = io::countDifferences(before, after, spans);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::internal);
  EXPECT_NE(refused.error().message.find("byte 76"), std::string::npos);
  EXPECT_EQ(io::countDifferences(before, FileBytes(199), spans).error().code, ErrorCode::internal);
}

}  // namespace
}  // namespace quadmark::test
