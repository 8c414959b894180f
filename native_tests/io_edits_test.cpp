// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "io/data_uri.h"
#include "io/gltf_edits.h"
#include "io/json_edits.h"
#include "io_fixtures.h"

namespace quadmark::test {
namespace {

using io::GltfContainer;
using io::GltfEdits;
using io::JsonEdits;

/// The text after `edit(edits, root)`.
template <class Edit>
std::string edited(const std::string& text, const Edit& edit) {
  const Result<JsonValue> root = parseJson(text);
  EXPECT_TRUE(root.ok());
  JsonEdits edits(text);
  edit(edits, *root);
  const auto applied = edits.apply();
  return applied.ok() ? applied->text : "error: " + applied.error().message;
}

TEST(JsonEdits, KeepTheSpellingOfEverythingElse) {
  const std::string text = "{ \"a\" :1e0,\r\n\"b\\u0020\":[ 1 ,\t2.50 ], \"a\":null }";
  EXPECT_EQ(edited(text, [](JsonEdits&, JsonValue) {}), text);
  EXPECT_EQ(edited(text, [](JsonEdits& edits, JsonValue root) { edits.setMember(root, "b ", "0"); }),
            "{ \"a\" :1e0,\r\n\"b\\u0020\":0, \"a\":null }");
}

TEST(JsonEdits, AddMembersAndElementsAtTheEnd) {
  EXPECT_EQ(edited(R"({"a":1 })", [](JsonEdits& e, JsonValue v) { e.setMember(v, "b", "2"); }), R"({"a":1,"b":2 })");
  EXPECT_EQ(edited("{ }", [](JsonEdits& e, JsonValue v) { e.setMember(v, "b", "2"); }), R"({"b":2 })");
  EXPECT_EQ(edited("[ ]",
                   [](JsonEdits& e, JsonValue v) {
                     e.addElement(v, "1");
                     e.addElement(v, "2");
                   }),
            "[1,2 ]");
  EXPECT_EQ(edited("[0]",
                   [](JsonEdits& e, JsonValue v) {
                     e.addElement(v, "1");
                     e.addElement(v, "2");
                   }),
            "[0,1,2]");
}

TEST(JsonEdits, RemoveWhateverItemsTogetherWithTheirCommas) {
  const std::string text = "[ 0 , 1 , 2 , 3 ]";
  for (unsigned removed = 0; removed < 16; ++removed) {
    for (const bool adds : {false, true}) {
      const std::string out = edited(text, [&](JsonEdits& edits, JsonValue array) {
        for (unsigned i = 0; i < 4; ++i) {
          if ((removed >> i & 1) != 0) edits.removeElement(array, i);
        }
        if (adds) edits.addElement(array, "4");
      });
      SCOPED_TRACE(out);
      std::vector<std::uint64_t> expected, found;
      for (unsigned i = 0; i < 5; ++i) {
        if (i == 4 ? adds : (removed >> i & 1) == 0) expected.push_back(i);
      }
      const Result<JsonValue> parsed = parseJson(out);
      ASSERT_TRUE(parsed.ok());
      parsed->forEachElement([&](JsonValue value) { found.push_back(value.asUnsigned().value_or(99)); });
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(JsonEdits, RemoveARepeatedMemberAltogether) {
  const std::string text = R"({"x":1,"a":2,"x":3})";
  EXPECT_EQ(edited(text, [](JsonEdits& e, JsonValue v) { e.removeMember(v, "x"); }), R"({"a":2})");
  EXPECT_EQ(edited(text, [](JsonEdits& e, JsonValue v) { e.removeMember(v, "y"); }), text);
}

TEST(JsonEdits, RefuseToOverlap) {
  const std::string out = edited(R"({"a":{"b":1}})", [](JsonEdits& edits, JsonValue root) {
    edits.replace(root.find("a").text(), "0");
    edits.replace(root.find("a").find("b").text(), "2");
  });
  EXPECT_EQ(out, "error: self-check: text edits overlap");
}

/// A file after appending `data` as a view with stride 12, read as text and container.
struct Appended {
  FileBytes bytes;
  GltfContainer container;
  std::uint32_t view = 0;
  JsonValue root;
  std::uint64_t bytesChanged = 0;

  /// The bytes of the new view.
  FileBytes data() const {
    const JsonValue json = element("bufferViews", view);
    const std::uint64_t offset = json.find("byteOffset").asUnsigned().value_or(0);
    const std::uint64_t length = json.find("byteLength").asUnsigned().value_or(0);
    const JsonValue buffer = element("buffers", json.find("buffer").asUnsigned().value_or(99));
    EXPECT_EQ(json.find("byteStride").text(), "12");
    EXPECT_EQ(json.find("target").text(), "34962");
    EXPECT_EQ(offset % 4, 0u);
    EXPECT_LE(offset + length, buffer.find("byteLength").asUnsigned().value_or(0));
    FileBytes source;
    if (const JsonValue uri = buffer.find("uri")) {
      const std::string_view spelled = uri.text().substr(1, uri.text().size() - 2);
      source = *io::decodeDataUri(spelled, "buffer");
    } else {
      const io::Bytes bin = container.bin(bytes);
      source.assign(bin.begin(), bin.end());
    }
    EXPECT_LE(offset + length, source.size());
    return {source.begin() + static_cast<std::ptrdiff_t>(offset),
            source.begin() + static_cast<std::ptrdiff_t>(offset + length)};
  }

  JsonValue element(const char* array, std::uint64_t index) const {
    JsonValue found;
    std::uint64_t at = 0;
    root.find(array).forEachElement([&](JsonValue value) {
      if (at++ == index) found = value;
    });
    return found;
  }
};

Appended append(const FileBytes& file, const FileBytes& data) {
  Appended out;
  const Result<GltfContainer> container = io::openGltf(file);
  EXPECT_TRUE(container.ok());
  Result<GltfEdits> edits = GltfEdits::of(file, *container);
  EXPECT_TRUE(edits.ok());
  edits->appendBytes(FileBytes{1, 2, 3});  // the view behind it must be aligned all the same
  out.view = edits->appendView(data, 12, 34962);
  Result<io::AssembledGltf> assembled = edits->assemble();
  EXPECT_TRUE(assembled.ok()) << assembled.error().message;
  out.bytes = assembled->bytes;
  out.bytesChanged = assembled->bytesChanged;
  const Result<GltfContainer> now = io::openGltf(out.bytes);
  EXPECT_TRUE(now.ok()) << now.error().message;
  out.container = *now;
  EXPECT_EQ(assembled->binBegin, now->hasBin ? now->binBegin : 0);
  const Result<JsonValue> root = parseJson(out.container.json(out.bytes));
  EXPECT_TRUE(root.ok());
  out.root = *root;
  return out;
}

const FileBytes kData = {9, 8, 7, 6, 5, 4, 3, 2, 1, 0, 1, 2};

TEST(GltfEdits, ExtendTheBinChunkOfAGlb) {
  GridGltf grid = gridGltf();
  FileBytes file = makeGlb(grid.json, grid.bin);
  // An unknown chunk behind the BIN chunk, and a byte behind the end of the GLB.
  const FileBytes tail = {4, 0, 0, 0, 'T', 'E', 'S', 'T', 'd', 'a', 't', 'a'};
  file.insert(file.end(), tail.begin(), tail.end());
  io::store(&file[8], static_cast<std::uint32_t>(file.size()));
  file.push_back('!');
  const Appended out = append(file, kData);
  EXPECT_EQ(out.data(), kData);
  EXPECT_EQ(out.view, 2u);
  EXPECT_EQ(io::load<std::uint32_t>(&out.bytes[8]), out.bytes.size() - 1);
  EXPECT_EQ(FileBytes(out.bytes.end() - 13, out.bytes.end() - 1), tail);
  EXPECT_EQ(out.bytes.back(), '!');
  const io::Bytes bin = out.container.bin(out.bytes);
  EXPECT_EQ(bin.size(), grid.bin.size() + 4 + 12);
  EXPECT_TRUE(std::equal(grid.bin.begin(), grid.bin.end(), bin.begin()));
  EXPECT_TRUE(readModel(out.bytes).ok());
  EXPECT_GE(out.bytesChanged, 16u);
}

TEST(GltfEdits, PadABinChunkOfUnevenLength) {
  GridGltf grid = gridGltf();
  FileBytes file = makeGlb(grid.json, grid.bin);
  file.push_back(77);
  const std::size_t binHeader = file.size() - 1 - grid.bin.size() - 8;
  io::store(&file[binHeader], static_cast<std::uint32_t>(grid.bin.size() + 1));
  io::store(&file[8], static_cast<std::uint32_t>(file.size()));
  const Appended out = append(file, kData);
  EXPECT_EQ(out.data(), kData);
  EXPECT_EQ(out.container.bin(out.bytes)[grid.bin.size()], 77);
  EXPECT_EQ(out.container.bin(out.bytes).size() % 4, 0u);
}

TEST(GltfEdits, GiveAGlbWithoutBuffersABinChunk) {
  const FileBytes file = makeGlb(R"({"asset":{"version":"2.0"}})");
  const Appended out = append(file, kData);
  EXPECT_TRUE(out.container.hasBin);
  EXPECT_EQ(out.view, 0u);
  EXPECT_EQ(out.data(), kData);
  EXPECT_FALSE(out.element("buffers", 0).find("uri"));
}

TEST(GltfEdits, AppendADataUriWhereThereCanBeNoBinChunk) {
  const GridGltf external = gridGltf(R"("uri":"grid.bin",)");
  for (const FileBytes& file : {bytesOf("\xef\xbb\xbf" + external.json + "\n"), makeGlb(external.json)}) {
    const Appended out = append(file, kData);
    EXPECT_EQ(out.data(), kData);
    EXPECT_FALSE(out.container.hasBin);
    EXPECT_EQ(out.root.find("buffers").elementCount(), 2u);
    EXPECT_EQ(out.element("buffers", 0).text(), R"({"uri":"grid.bin","byteLength":156})");
    EXPECT_TRUE(readModel(out.bytes, {{"grid.bin", external.bin}}).ok());
  }
  EXPECT_EQ(append(bytesOf(R"({"asset":{"version":"2.0"}})"), kData).data(), kData);
}

TEST(GltfEdits, ChangeNothingWithoutEdits) {
  for (const FileBytes& file : {gridGltf().glb(), makeGlb("{}   "), bytesOf(" {} ")}) {
    const Result<GltfContainer> container = io::openGltf(file);
    Result<GltfEdits> edits = GltfEdits::of(file, *container);
    const auto assembled = edits->assemble();
    ASSERT_TRUE(assembled.ok());
    EXPECT_EQ(assembled->bytes, file);
    EXPECT_EQ(assembled->bytesChanged, 0u);
  }
}

}  // namespace
}  // namespace quadmark::test
