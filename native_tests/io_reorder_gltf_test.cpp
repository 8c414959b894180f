// SPDX-License-Identifier: MIT
// Changing the order of a glTF's vertices: what moves together, in every container, and what keeps its order.
#include <gtest/gtest.h>

#include "io/gltf_container.h"
#include "io/gltf_document.h"
#include "models.h"
#include "reorder_checks.h"

namespace quadmark::test {
namespace {

/// Everything a corner of a triangle reads, by primitive: the bytes of all attributes and morph targets.
std::vector<std::string> cornerData(const FileBytes& file, const Resources& resources) {
  const io::GltfContainer container = *io::openGltf(file);
  const JsonValue root = *parseJson(container.json(file));
  const io::GltfDocument document = *io::readGltfDocument(container.json(file), container.jsonBegin);
  const auto bytesAt = [&](std::uint64_t accessorIndex, std::uint64_t element) {
    const io::GltfAccessor& accessor = document.accessors.at(accessorIndex);
    const io::GltfView& view = document.views.at(accessor.view);
    const io::GltfBuffer& buffer = document.buffers.at(view.buffer);
    const io::Bytes bytes =
        buffer.hasUri
            ? io::Bytes(resources.at(textOf(file).substr(buffer.uri.begin, buffer.uri.end - buffer.uri.begin)))
            : container.bin(file);
    const std::uint64_t stride = view.byteStride != 0 ? view.byteStride : accessor.elementBytes();
    const std::uint64_t begin = view.byteOffset + accessor.byteOffset + element * stride;
    return bytes.subspan(static_cast<std::size_t>(begin), accessor.elementBytes());
  };
  std::vector<std::string> corners;
  root.find("meshes").forEachElement([&](JsonValue mesh) {
    mesh.find("primitives").forEachElement([&](JsonValue primitive) {
      const std::uint64_t indices = *primitive.find("indices").asUnsigned();
      for (std::uint64_t i = 0; i < document.accessors.at(indices).count; ++i) {
        const io::Bytes raw = bytesAt(indices, i);
        std::uint64_t vertex = 0;
        for (std::size_t k = raw.size(); k-- > 0;) vertex = vertex << 8 | raw[k];
        std::string corner;
        const auto add = [&](JsonValue set) {
          set.forEachMember([&](std::string_view name, JsonValue accessor) {
            corner += std::string(name) + "=" + std::string(io::asText(bytesAt(*accessor.asUnsigned(), vertex))) + ";";
          });
        };
        add(primitive.find("attributes"));
        primitive.find("targets").forEachElement(add);
        corners.push_back(corner);
      }
    });
  });
  return corners;
}

/// Two primitives over one array of nine vertices: POSITION, NORMAL and joints interleaved, UV and a morph target
/// apart; 16-bit and 8-bit indices with bounds. Edits replace a text of the JSON.
struct RichGltf {
  std::string json = R"({"asset":{"version":"2.0"},
 "buffers":[{URI"byteLength":LENGTH}],
 "bufferViews":[{"buffer":0,"byteLength":288,"byteStride":32},{"buffer":0,"byteOffset":288,"byteLength":72},
  {"buffer":0,"byteOffset":360,"byteLength":108},{"buffer":0,"byteOffset":468,"byteLength":24},
  {"buffer":0,"byteOffset":492,"byteLength":12},{"buffer":0,"byteOffset":504,"byteLength":36}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":9,"type":"VEC3","min":[0,0,-1],"max":[2,2,0.75]},
  {"bufferView":0,"byteOffset":12,"componentType":5126,"count":9,"type":"VEC3"},
  {"bufferView":0,"byteOffset":24,"componentType":5121,"count":9,"type":"VEC4"},
  {"bufferView":1,"componentType":5126,"count":9,"type":"VEC2"},
  {"bufferView":2,"componentType":5126,"count":9,"type":"VEC3","min":[0,0,0],"max":[9,9,9]},
  {"bufferView":3,"componentType":5123,"count":12,"type":"SCALAR","min":[0],"max":[5]},
  {"bufferView":4,"componentType":5121,"count":12,"type":"SCALAR","min":[3],"max":[ 8 ]},
  {"bufferView":5,"componentType":5126,"count":9,"type":"SCALAR"}],
 "meshes":[{"primitives":[
  {"attributes":{"POSITION":0,"NORMAL":1,"JOINTS_0":2,"TEXCOORD_0":3},"targets":[{"POSITION":4}],"indices":5},
  {"attributes":{"POSITION":0,"NORMAL":1,"JOINTS_0":2,"TEXCOORD_0":3},"targets":[{"POSITION":4}],"indices":6}]}],
 "nodes":[{"mesh":0}]})";
  FileBytes bin;

  RichGltf() {
    BufferBuilder buffer;
    for (int v = 0; v < 9; ++v) {
      const double* p = &gridPositions()[3 * v];
      buffer.floats({p[0], p[1], p[2], 0.1 * v, 1, -0.5 * v});
      for (int k = 0; k < 4; ++k) buffer.bytes.push_back(static_cast<std::uint8_t>(10 * v + k));
      for (int k = 0; k < 4; ++k) buffer.bytes.push_back(0xee);  // nobody's: stays in place
    }
    for (int v = 0; v < 9; ++v) buffer.floats({v + 0.25, v + 0.5});
    for (int v = 0; v < 9; ++v) buffer.floats({double(v), 9.0 - v, 1});
    const auto& t = gridTriangles();
    buffer.indices("ushort", {t[0], t[1], t[2], t[3]});
    buffer.indices("uchar", {t[4], t[5], t[6], t[7]});
    for (int v = 0; v < 9; ++v) buffer.floats({100.0 + v});
    bin = buffer.bytes;
    json = replaced(json, "LENGTH", std::to_string(bin.size()));
  }
  RichGltf& edit(const std::string& what, const std::string& by) {
    EXPECT_NE(json.find(what), json.npos) << what;
    json = replaced(json, what, by);
    return *this;
  }
  FileBytes glb() const { return makeGlb(replaced(json, "URI", ""), bin); }
  FileBytes gltf(const std::string& uri) const { return bytesOf(replaced(json, "URI", "\"uri\":\"" + uri + "\",")); }
};

std::string jsonOf(const FileBytes& file) {
  return std::string((*io::openGltf(file)).json(file));
}

TEST(ReorderGltf, KeepsAttributesAndMorphTargetsAtTheirVertices) {
  const FileBytes file = RichGltf().glb();
  EXPECT_TRUE(freedomOf(file).warnings.empty());
  const PatchedFile out = checkReorder(file);
  EXPECT_EQ(cornerData(out.bytes, {}), cornerData(file, {}));
  // Gaps between elements, and what no primitive uses, stay in place.
  const io::Bytes before = io::openGltf(file)->bin(file), after = io::openGltf(out.bytes)->bin(out.bytes);
  for (std::size_t v = 0; v < 9; ++v) EXPECT_EQ(io::load<std::uint32_t>(&after[32 * v + 28]), 0xeeeeeeeeu);
  EXPECT_TRUE(std::equal(before.begin() + 504, before.end(), after.begin() + 504));
}

TEST(ReorderGltf, KeepsTheBoundsOfIndicesTrue) {
  const FileBytes file = RichGltf().glb();
  const Order order = mixedOrder(9, {{0, 9}});
  const Order newOf = inverse(order);
  const FileBytes out = reorderOk(file, order).bytes;
  const auto extent = [&](int first, int last) {
    std::vector<std::uint32_t> used;
    for (int face = first; face < last; ++face) {
      for (const int v : gridTriangles()[face]) used.push_back(newOf[v]);
    }
    return std::pair(std::to_string(*std::min_element(used.begin(), used.end())),
                     std::to_string(*std::max_element(used.begin(), used.end())));
  };
  const auto [low1, high1] = extent(0, 4);
  const auto [low2, high2] = extent(4, 8);
  std::string expected =
      replaced(jsonOf(file), R"("min":[0],"max":[5])", "\"min\":[" + low1 + "],\"max\":[" + high1 + "]");
  expected = replaced(expected, R"("min":[3],"max":[ 8 ])", "\"min\":[" + low2 + "],\"max\":[ " + high2 + " ]");
  EXPECT_NE(expected, jsonOf(file));
  EXPECT_EQ(jsonOf(out), expected);
}

TEST(ReorderGltf, WritesExternalBuffersAndDataUris) {
  const RichGltf rich;
  const Resources resources = {{"a b.bin", rich.bin}, {"unrelated.png", {1, 2, 3}}};
  const PatchedFile external = checkReorder(rich.gltf("a%20b.bin"), resources);
  ASSERT_EQ(external.resources.size(), 1u);
  const FileBytes inside = rich.gltf("data:application/octet-stream;base64," + base64(rich.bin));
  const PatchedFile embedded = checkReorder(inside);
  EXPECT_TRUE(embedded.resources.empty());
  const FileBytes glb = rich.glb();
  const PatchedFile chunk = checkReorder(glb);
  const io::Bytes bin = io::openGltf(chunk.bytes)->bin(chunk.bytes);
  EXPECT_EQ(external.resources.at("a b.bin"), FileBytes(bin.begin(), bin.end()));
  EXPECT_NE(textOf(embedded.bytes).find(base64(external.resources.at("a b.bin"))), std::string::npos);
}

TEST(ReorderGltf, MovesIdenticalAccessorsOnce) {
  // The second primitive names the same bytes through accessors of its own.
  RichGltf rich;
  rich.edit(R"({"bufferView":5,"componentType":5126,"count":9,"type":"SCALAR"})",
            R"({"bufferView":0,"componentType":5126,"count":9,"type":"VEC3","min":[0,0,-1],"max":[2,2,0.75]},
               {"bufferView":3,"componentType":5123,"count":12,"type":"SCALAR"})");
  rich.edit(R"("targets":[{"POSITION":4}],"indices":6)", R"("targets":[{"POSITION":4}],"indices":8)");
  const std::size_t second = rich.json.rfind("\"POSITION\":0,");
  rich.json.replace(second, 13, "\"POSITION\":7,");
  const PatchedFile out = checkReorder(rich.glb());
  EXPECT_EQ(cornerData(out.bytes, {}), cornerData(rich.glb(), {}));
}

TEST(ReorderGltf, KeepsTheOrderOfWhatItDoesNotUnderstand) {
  const std::string second = R"("indices":6})";
  const struct {
    const char* what;
    std::string from, to, obstacle;
  } cases[] = {
      {"no indices", R"(,"indices":6)", "", "mesh 0 primitive 1 has no indices"},
      {"sparse", R"({"bufferView":1,)",
       R"({"sparse":{"count":1,"indices":{"bufferView":5,"componentType":5121},"values":{"bufferView":5}},"bufferView":1,)",
       "accessor 3 is sparse"},
      {"another count", R"({"bufferView":1,"componentType":5126,"count":9)",
       R"({"bufferView":1,"componentType":5126,"count":8)", "accessor 3 has 8 elements for 9 vertices"},
      {"compressed", R"("byteOffset":360,)", R"("extensions":{"EXT_meshopt_compression":{}},"byteOffset":360,)",
       "accessor 4 is compressed by EXT_meshopt_compression"},
      {"no data", R"({"bufferView":2,"componentType")", R"({"componentType")", "accessor 4 has no data"},
      {"too long", R"("byteLength":72)", R"("byteLength":64)", "accessor 3 does not fit into its bufferView"},
      {"a matrix", R"({"bufferView":1,"componentType":5126,"count":9,"type":"VEC2"})",
       R"({"bufferView":1,"componentType":5121,"count":9,"type":"MAT2"})", "accessor 3 holds matrices"},
      {"a skin's matrices", R"("nodes")", R"("skins":[{"joints":[0],"inverseBindMatrices":1}],"nodes")",
       "accessor 1 has other uses, too"},
      {"an animation", R"("nodes")", R"("animations":[{"channels":[],"samplers":[{"input":7,"output":4}]}],"nodes")",
       "accessor 4 has other uses, too"},
      {"an instance's data", R"("nodes":[{)",
       R"("nodes":[{"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1}}},)",
       "accessor 1 has other uses, too"},
      {"an attribute of a primitive without positions", R"("meshes":[{)",
       R"("meshes":[{"primitives":[{"attributes":{"NORMAL":1}}]},{)", "accessor 1 has other uses, too"},
      {"indices as an attribute", R"("JOINTS_0":2)", R"("JOINTS_0":5)", "accessor 5 has other uses, too"},
      {"an unknown extension", second, R"("indices":6,"extensions":{"CESIUM_primitive_outline":{"indices":5}}})",
       "mesh 0 primitive 1 has the extension \"CESIUM_primitive_outline\""},
      {"a mesh extension", R"("meshes":[{)", R"("meshes":[{"extensions":{"EXT_mesh_manifold":{}},)",
       "mesh 0 primitive 0 has the extension \"EXT_mesh_manifold\""},
      {"an accessor over other elements", R"({"bufferView":5,"componentType":5126,"count":9,"type":"SCALAR"})",
       R"({"bufferView":2,"componentType":5126,"count":27,"type":"SCALAR"})", "other data lies in the same bytes"},
      {"an accessor of the same bytes", R"({"bufferView":5,"componentType":5126,"count":9,"type":"SCALAR"})",
       R"({"bufferView":3,"componentType":5123,"count":12,"type":"SCALAR"})",
       "accessor 7 reads the same bytes for another purpose"},
      {"an image", R"("nodes")", R"("images":[{"bufferView":1}],"nodes")", "other data lies in the same bytes"},
      {"a broken reference", R"("NORMAL":1)", R"("NORMAL":99)", "a reference to an accessor is broken"},
      {"a missing buffer", R"({"buffer":0,"byteOffset":360,)", R"({"buffer":1,"byteOffset":360,)",
       "accessor 4 lies in a buffer that was not given"}};
  for (const auto& test : cases) {
    SCOPED_TRACE(test.what);
    RichGltf rich;
    rich.edit(test.from, test.to);
    if (std::string(test.what) == "a missing buffer")
      rich.edit(R"("buffers":[)", R"("buffers":[ )").edit("540}]", R"(540},{"uri":"other.bin","byteLength":900}])");
    const OrderFreedom freedom = freedomOf(rich.glb());
    EXPECT_TRUE(freedom.ranges.empty());
    ASSERT_EQ(freedom.warnings.size(), 1u);
    EXPECT_EQ(freedom.warnings[0], "accessor 0 (POSITION): the order of its 9 vertices is kept: " + test.obstacle);
    const auto refused = readOk(rich.glb())->reorder(rich.glb(), {}, mixedOrder(9, {{0, 9}}));
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::badOption);
  }
}

TEST(ReorderGltf, SetsFreeWhatQualifiesAndKeepsTheRest) {
  // The second primitive gets positions of its own: the accessor that was the morph target.
  RichGltf rich;
  rich.edit(R"("targets":[{"POSITION":4}],"indices":5)", R"("indices":5)");
  const std::size_t second = rich.json.rfind(R"({"attributes")");
  rich.json.replace(second, rich.json.find("\n \"nodes\"") - second, R"({"attributes":{"POSITION":4,"_ID":7}}]}],)");
  const FileBytes file = rich.glb();
  const OrderFreedom freedom = freedomOf(file);
  ASSERT_EQ(freedom.ranges.size(), 1u);
  EXPECT_EQ(freedom.ranges[0].first, 0u);
  EXPECT_EQ(freedom.ranges[0].count, 9u);
  ASSERT_EQ(freedom.warnings.size(), 1u);
  EXPECT_EQ(freedom.warnings[0],
            "accessor 4 (POSITION): the order of its 9 vertices is kept: mesh 0 primitive 1 has no indices");
  checkReorder(file);
  // A vertex may not leave its range.
  Order order(18);
  std::iota(order.begin(), order.end(), 0u);
  std::swap(order[3], order[12]);
  EXPECT_EQ(readOk(file)->reorder(file, {}, order).error().message,
            "order: entry 3 is vertex 12, which is outside 0..8");
  // Attributes shared by both arrays keep both.
  RichGltf shared;
  shared.json = replaced(rich.json, "\"_ID\":7}", "\"NORMAL\":1},\"indices\":6");
  EXPECT_TRUE(freedomOf(shared.glb()).ranges.empty());
  // Indices of their own set both free.
  RichGltf both;
  both.json = replaced(rich.json, "\"_ID\":7}", "\"_ID\":7},\"indices\":6");
  EXPECT_EQ(freedomOf(both.glb()).ranges.size(), 2u);
  EXPECT_EQ(cornerData(checkReorder(both.glb()).bytes, {}), cornerData(both.glb(), {}));
}

TEST(ReorderGltf, KeepsRealModelsWhole) {
  const struct {
    const char* name;
    std::vector<std::string> uris;
    std::size_t ranges;
  } models[] = {
      {"CesiumMan.glb", {}, 1},         {"AnimatedMorphCube/AnimatedMorphCube.gltf", {"AnimatedMorphCube.bin"}, 1},
      {"Fox/Fox.gltf", {"Fox.bin"}, 0}, {"riggedMesh.glb", {}, 1},
      {"shaderBall.glb", {}, 1},        {"SheenCloth.glb", {}, 1}};
  for (const auto& [name, uris, ranges] : models) {
    SCOPED_TRACE(name);
    const std::optional<FileBytes> file = modelBytes(name);
    if (!file) continue;
    const Resources resources = modelResources(name, uris);
    const OrderFreedom freedom = freedomOf(*file, resources);
    EXPECT_GE(freedom.ranges.size(), ranges);
    for (const std::string& warning : freedom.warnings) std::fprintf(stderr, "%s: %s\n", name, warning.c_str());
    if (freedom.ranges.empty()) continue;
    const PatchedFile out = checkReorder(*file, resources);
    EXPECT_EQ(cornerData(out.bytes, merged(resources, out)), cornerData(*file, resources));
  }
}

TEST(ReorderGltf, FollowsTwoBuffersOfOneFile) {
  RichGltf rich;
  rich.edit(R"({"buffer":0,"byteOffset":288,)", R"({"buffer":1,"byteOffset":288,)");
  rich.edit(R"({"buffer":0,"byteOffset":468,)", R"({"buffer":1,"byteOffset":468,)");
  rich.edit("540}]", R"(540},{"uri":"rich.bin","byteLength":540}])");
  const Resources resources = {{"rich.bin", rich.bin}};
  const FileBytes file = rich.gltf("rich.bin");
  const PatchedFile out = checkReorder(file, resources);
  EXPECT_EQ(cornerData(out.bytes, out.resources), cornerData(file, resources));
}

TEST(ReorderGltf, SurvivesEveryChangedDigit) {
  const FileBytes good = RichGltf().glb();
  const io::GltfContainer container = *io::openGltf(good);
  std::size_t reordered = 0, refused = 0;
  for (std::size_t at = container.jsonBegin; at < container.jsonEnd; ++at) {
    if (good[at] < '0' || good[at] > '9') continue;
    for (const char digit : {'0', '1', '2', '3', '5', '7', '9'}) {
      FileBytes file = good;
      file[at] = static_cast<std::uint8_t>(digit);
      const auto model = readModel(file);
      if (!model.ok()) continue;
      const auto freedom = (*model)->orderFreedom(file, {});
      ASSERT_TRUE(freedom.ok()) << freedom.error().message;
      const Order order = mixedOrder((*model)->mesh().vertexCount(), freedom->ranges);
      const auto out = (*model)->reorder(file, {}, order);
      ASSERT_TRUE(out.ok()) << out.error().message << " after setting byte " << at << " to " << digit;
      // All that is drawn with all of its attributes is as it was, or nothing moved.
      ++(freedom->ranges.empty() ? refused : reordered);
      if (freedom->ranges.empty()) {
        EXPECT_EQ(out->bytes, file);
      }
    }
  }
  EXPECT_GT(reordered, 300u);
  EXPECT_GT(refused, 200u);
}

}  // namespace
}  // namespace quadmark::test
