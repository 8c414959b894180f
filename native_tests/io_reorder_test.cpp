// SPDX-License-Identifier: MIT
// Changing the order of a file's vertices: every variant of PLY, glTF in every container, and what has to stay put.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "io/gltf_container.h"
#include "io/gltf_document.h"
#include "io_fixtures.h"
#include "models.h"
#include "quadmark/io/model.h"

namespace quadmark::test {
namespace {

using Order = std::vector<std::uint32_t>;

std::unique_ptr<Model> readOk(const FileBytes& file, const Resources& resources = {}) {
  Result<std::unique_ptr<Model>> model = readModel(file, resources);
  EXPECT_TRUE(model.ok()) << model.error().message;
  return model.ok() ? std::move(model).value() : nullptr;
}

OrderFreedom freedomOf(const FileBytes& file, const Resources& resources = {}) {
  const auto model = readOk(file, resources);
  Result<OrderFreedom> freedom = model->orderFreedom(file, resources);
  EXPECT_TRUE(freedom.ok()) << freedom.error().message;
  return freedom.ok() ? std::move(freedom).value() : OrderFreedom{};
}

/// Every range rotated and its neighbours exchanged: no vertex of a range of 4 or more stays.
Order mixedOrder(std::size_t vertexCount, const std::vector<VertexRange>& ranges) {
  Order order(vertexCount);
  std::iota(order.begin(), order.end(), 0u);
  for (const VertexRange& range : ranges) {
    const auto begin = order.begin() + range.first, end = begin + range.count;
    std::rotate(begin, begin + range.count / 2, end);
    for (std::uint32_t i = 0; i + 1 < range.count; i += 2) std::swap(begin[i], begin[i + 1]);
  }
  return order;
}

Order inverse(const Order& order) {
  Order out(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) out[order[i]] = static_cast<std::uint32_t>(i);
  return out;
}

PatchedFile reorderOk(const FileBytes& file, const Order& order, const Resources& resources = {}) {
  const auto model = readOk(file, resources);
  Result<PatchedFile> reordered = model->reorder(file, resources, order);
  EXPECT_TRUE(reordered.ok()) << reordered.error().message;
  return reordered.ok() ? std::move(reordered).value() : PatchedFile{};
}

Resources merged(const Resources& resources, const PatchedFile& file) {
  Resources all = file.resources;
  all.insert(resources.begin(), resources.end());
  return all;
}

/// Corner by corner, the positions of all faces.
std::vector<double> cornerPositions(const Mesh& mesh) {
  std::vector<double> out;
  for (const std::uint32_t v : mesh.faceVertices) {
    out.insert(out.end(), mesh.positions.begin() + 3 * v, mesh.positions.begin() + 3 * v + 3);
  }
  return out;
}

/// Reorders and checks what holds for every file: same faces, vertices where `order` says, and the way back.
PatchedFile checkReorder(const FileBytes& file, const Resources& resources = {}) {
  const auto before = readOk(file, resources);
  const OrderFreedom freedom = freedomOf(file, resources);
  const Order order = mixedOrder(before->mesh().vertexCount(), freedom.ranges);
  PatchedFile out = reorderOk(file, order, resources);
  const Resources all = merged(resources, out);
  const auto after = readOk(out.bytes, all);
  if (after == nullptr) return out;
  EXPECT_EQ(cornerPositions(after->mesh()), cornerPositions(before->mesh()));
  EXPECT_EQ(after->mesh().faceOffsets, before->mesh().faceOffsets);
  EXPECT_EQ(after->mesh().groups, before->mesh().groups);
  for (std::size_t v = 0; v < order.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(after->mesh().positions[3 * v + axis], before->mesh().positions[3 * order[v] + axis]);
    }
  }
  EXPECT_GT(out.bytesChanged, 0u);
  const PatchedFile back = reorderOk(out.bytes, inverse(order), all);
  EXPECT_EQ(back.bytes, file);
  for (const auto& [uri, bytes] : back.resources) EXPECT_EQ(bytes, resources.at(uri)) << uri;
  EXPECT_EQ(back.bytesChanged, out.bytesChanged);
  Order same(order.size());
  std::iota(same.begin(), same.end(), 0u);
  const PatchedFile unchanged = reorderOk(file, same, resources);
  EXPECT_EQ(unchanged.bytes, file);
  EXPECT_TRUE(unchanged.resources.empty());
  EXPECT_EQ(unchanged.bytesChanged, 0u);
  return out;
}

bool mentions(const std::vector<std::string>& warnings, const std::string& what) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& w) { return w.find(what) != w.npos; });
}

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

/// Everything a corner of a triangle reads, by primitive: the bytes of all attributes and morph targets.
std::vector<std::string> cornerData(const FileBytes& file, const Resources& resources) {
  const io::GltfContainer container = *io::openGltf(file);
  const io::JsonValue root = *io::parseJson(container.json(file));
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
  root.find("meshes").forEachElement([&](io::JsonValue mesh) {
    mesh.find("primitives").forEachElement([&](io::JsonValue primitive) {
      const std::uint64_t indices = *primitive.find("indices").asUnsigned();
      for (std::uint64_t i = 0; i < document.accessors.at(indices).count; ++i) {
        const io::Bytes raw = bytesAt(indices, i);
        std::uint64_t vertex = 0;
        for (std::size_t k = raw.size(); k-- > 0;) vertex = vertex << 8 | raw[k];
        std::string corner;
        const auto add = [&](io::JsonValue set) {
          set.forEachMember([&](std::string_view name, io::JsonValue accessor) {
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

TEST(ReorderPly, KeepsRealModelsWhole) {
  for (const char* name : {"bunny.ply", "beast-quads.ply", "igea-tristrips.ply", "ogre.ply"}) {
    SCOPED_TRACE(name);
    if (const std::optional<FileBytes> file = modelBytes(name)) checkReorder(*file);
  }
}

}  // namespace
}  // namespace quadmark::test
