// SPDX-License-Identifier: MIT
// The grid of io_fixtures.h as foreign encoders compress it.
#pragma once

#include "io/meshopt.h"
#include "io_fixtures.h"

namespace quadmark::test {

using io::MeshoptFilter;
using io::MeshoptLayout;
using io::MeshoptMode;

/// The grid as the encoder of the npm package draco3dgltf 1.5.7 writes it, without quantization. The first has
/// metadata, and texture coordinates i / 32 with the unique id 1.
inline const FileBytes& sequentialGrid() {
  static const FileBytes bytes = fromHex(
      "445241434f0202010000800002016e0407000000046e616d6504677269640008090100010400040301020402050403040604070604050804"
      "0807010200090300000309020001000000000000000000000000003e0000803f00000000000000bf00000040000000000000803e00000000"
      "0000803f0000403f0000883f0000803f00000000000000400000803f000080be0000000000000040000000000000803f000000400000003f"
      "0000004000000040000080bf000000000000003d0000803d0000c03d0000003e0000203e0000403e0000603e0000803e0000903e0000a03e"
      "0000b03e0000c03e0000d03e0000e03e0000f03e0000003f0000083f");
  return bytes;
}
inline const FileBytes& edgebreakerGrid() {
  static const FileBytes bytes = fromHex(
      "445241434f02020101000000090800080000036fdb16ff011101ff0000010009030000000000883f0000803f00000000000000000000803f"
      "0000403f00000000000000000000003e0000803f00000000000000bf00000040000000000000803e000000400000803f000080be00000040"
      "00000040000080bf0000803f000000400000003f000000000000004000000000");
  return bytes;
}

/// The grid in a GLB, its triangles compressed; a second primitive and a fallback if wanted.
struct DracoGrid {
  std::string json =
      R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_materials_unlit","KHR_draco_mesh_compression"],
 "extensionsRequired":["KHR_draco_mesh_compression"],"buffers":[{"byteLength":BIN}],
 "bufferViews":[{"buffer":0,"byteLength":STREAM}],
 "accessors":[{"componentType":5126,"count":9,"type":"VEC3","min":[0,0,-1],"max":[2,2,0.75]},
  {"componentType":5123,"count":24,"type":"SCALAR"},{"componentType":5126,"count":9,"type":"VEC2"}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"mode":4,"extensions":{
  "KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0,"TEXCOORD_0":1}}, "EXT_other":{}}}]}]})";
  FileBytes bin = sequentialGrid();

  FileBytes glb() const {
    FileBytes padded = bin;
    while (padded.size() % 4 != 0) padded.push_back(0);
    const std::string text =
        replaced(replaced(json, "BIN", std::to_string(padded.size())), "STREAM", std::to_string(bin.size()));
    return makeGlb(text, padded);
  }
};

/// The grid's data as the encoder of the npm package meshoptimizer 1.3.0 compresses it.
struct Golden {
  const char* name;
  const char* mode;
  const char* filter;
  MeshoptLayout layout;
  FileBytes stream;
};

inline const std::vector<Golden>& golden() {
  static const std::vector<Golden> all = {
      {"vertex codec 0",
       "ATTRIBUTES",
       "NONE",
       {MeshoptMode::attributes, MeshoptFilter::none, 9, 12},
       fromHex("a00000013cf3c000ffffeff0ffff013bef80007e7f7e7f7e000001030c0000ffff01030800007e0000010ffcc000ff7f7ffffff"
               "f013e"
               "ffc000fdfe7d83847eff000000000000000000000000000000000000000000000000000000000000003e")},
      {"vertex codec 1",
       "ATTRIBUTES",
       "NONE",
       {MeshoptMode::attributes, MeshoptFilter::none, 9, 12},
       fromHex("a1da6ae9007800ff10f0ff007f017f7f007f7f010048007f01012828800000040607fdfafafc020000000000000000000000000"
               "0000000"
               "000000003e010122")},
      {"exponential filter",
       "ATTRIBUTES",
       "EXPONENTIAL",
       {MeshoptMode::attributes, MeshoptFilter::exponential, 9, 12},
       fromHex("a000000133ff0000807f88077f800128618000000001030000008001020800000000013fffc000ffff40bf7f8080ff013612800"
               "00400"
               "00000000000000000000000000000000000000000000e9000000e9000040e7")},
      {"triangles",
       "TRIANGLES",
       "NONE",
       {MeshoptMode::triangles, MeshoptFilter::none, 24, 2},
       fromHex("e1fe0d300f5e1e4e010f0804007687566778a9866589689801690000")},
      {"indices",
       "INDICES",
       "NONE",
       {MeshoptMode::indices, MeshoptFilter::none, 24, 2},
       fromHex("d100040c0e1002060408060c02020408060c0206040c0e100200000000")},
  };
  return all;
}

inline const Golden& goldenOf(std::string_view name) {
  for (const Golden& entry : golden()) {
    if (entry.name == name) return entry;
  }
  return golden()[0];
}

/// A compressed view; plainOffset is where its bytes would be in the placeholder.
inline std::string meshoptView(const Golden& entry, std::size_t plainOffset, std::size_t offset) {
  std::string json = R"({"buffer":1,"byteOffset":PLAIN,"byteLength":LENGTH,"target":TARGET, "extensions" :{"NAME":{
      "buffer":0,"byteOffset":OFFSET,"byteLength":STREAM,"byteStride":STRIDE,"count":COUNT,"mode":"MODE"FILTER}}})";
  const auto put = [&](const char* what, std::size_t value) { json = replaced(json, what, std::to_string(value)); };
  put("PLAIN", plainOffset);
  put("LENGTH", entry.layout.count * entry.layout.byteStride);
  put("TARGET", entry.layout.mode == MeshoptMode::attributes ? 34962 : 34963);
  put("OFFSET", offset);
  put("STREAM", entry.stream.size());
  put("STRIDE", entry.layout.byteStride);
  put("COUNT", entry.layout.count);
  json = replaced(json, "MODE", entry.mode);
  const bool states = std::string_view(entry.filter) != "NONE" || entry.layout.mode != MeshoptMode::attributes;
  return replaced(json, "FILTER", states ? ",\"filter\":\"" + std::string(entry.filter) + "\"" : "");
}

/// The grid as glTF with two compressed views, and a placeholder for a buffer.
inline GridGltf meshoptGrid(const std::string& extension, const std::string& vertexStream,
                            const std::string& indexStream) {
  GridGltf grid;
  const Golden& vertices = goldenOf(vertexStream);
  const Golden& indices = goldenOf(indexStream);
  grid.bin = vertices.stream;
  while (grid.bin.size() % 4 != 0) grid.bin.push_back(0);
  const std::size_t indexOffset = grid.bin.size();
  grid.bin.insert(grid.bin.end(), indices.stream.begin(), indices.stream.end());
  while (grid.bin.size() % 4 != 0) grid.bin.push_back(0);
  grid.json =
      R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_materials_unlit","NAME"],"extensionsRequired": ["NAME"],
 "buffers":[{"byteLength":BIN},{"byteLength":156,"extensions":{"NAME":{"fallback":true}}}],
 "bufferViews":[VERTICES,
  INDICES],
 "accessors":[{"bufferView":0,"componentType":5126,"count":9,"type":"VEC3","min":[0,0,-1],"max":[2,2,0.76]},
  {"bufferView":1,"componentType":5123,"count":24,"type":"SCALAR"}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"extras":{"none":null}})";
  grid.json =
      replaced(replaced(grid.json, "BIN", std::to_string(grid.bin.size())), "VERTICES", meshoptView(vertices, 0, 0));
  grid.json = replaced(grid.json, "INDICES]", meshoptView(indices, 108, indexOffset) + "]");
  grid.json = replaced(grid.json, "NAME", extension);
  return grid;
}

}  // namespace quadmark::test
