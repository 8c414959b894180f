// SPDX-License-Identifier: MIT
#include "fuzz/seeds.h"

#include "fixtures.h"
#include "io_gltf_matrix.h"
#include "io_streams.h"
#include "io_textured.h"

namespace quadmark::test {
namespace {

std::vector<Mesh> smallMeshes() {
  return {lab::cube(),        lab::bumpyGrid(6, 5, 3), lab::flatGrid(4, 4),
          lab::polygonMix(1), lab::nonManifold(),      lab::seamed(2),
          lab::fan(7),        lab::quadSphere(1),      lab::icosphere(1)};
}

/// Two meshes whose primitives are strips, fans and triangles without indices over one interleaved view, with a second
/// buffer, a morph target, a skin and an instance.
FileBytes manyFeatures() {
  BufferBuilder buffer;
  for (std::size_t v = 0; v < gridPositions().size(); v += 3) {
    buffer.floats({gridPositions()[v], gridPositions()[v + 1], gridPositions()[v + 2], 0, 0, 1});
  }
  for (const int index : {0, 3, 1, 4, 2, 5, 5, 8}) appendScalar(buffer.bytes, "uchar", index, io::ByteOrder::little);
  const std::string json = replaced(R"({"asset":{"version":"2.0"},"extensionsUsed":["EXT_mesh_gpu_instancing"],
 "buffers":[{"byteLength":LENGTH},{"uri":"a.bin","byteLength":156}],
 "bufferViews":[{"buffer":0,"byteLength":216,"byteStride":24},{"buffer":0,"byteOffset":216,"byteLength":8},
  {"buffer":1,"byteLength":108}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":9,"type":"VEC3","min":[0,0,-1],"max":[2,2,0.75]},
  {"bufferView":0,"byteOffset":12,"componentType":5126,"count":9,"type":"VEC3"},
  {"bufferView":1,"componentType":5121,"count":8,"type":"SCALAR"},
  {"bufferView":2,"componentType":5126,"count":9,"type":"VEC3"},
  {"bufferView":0,"byteOffset":24,"componentType":5126,"count":6,"type":"VEC3"}],
 "meshes":[{"name":"a","primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2,"mode":5},
   {"attributes":{"POSITION":4},"mode":6},{"attributes":{"POSITION":0},"mode":1}]},
  {"primitives":[{"attributes":{"POSITION":3},"targets":[{"POSITION":1}]}],"weights":[0.5]}],
 "skins":[{"joints":[0]}],
 "nodes":[{"mesh":0,"name":"\ud83d\udc30"},{"mesh":1,"skin":0,
  "extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":1}}}},{"mesh":0,"scale":[2,2,2]}],
 "animations":[{"channels":[],"samplers":[{"input":2,"output":1}]}]})",
                                    "LENGTH", std::to_string(buffer.bytes.size()));
  return makeGlb(json, buffer.bytes);
}

/// Integer and sparse positions of every kind.
std::vector<FileBytes> quantizedAndSparse() {
  Mesh square;
  square.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0.5, 0, 1, 0};
  square.faceVertices = {0, 1, 2, 0, 2, 3};
  std::vector<FileBytes> files;
  for (const char* component : {"float", "char", "ushort"}) {
    for (const SparseUse sparse : {SparseUse::none, SparseUse::overBase, SparseUse::alone}) {
      MatrixSpec spec;
      spec.component = component;
      spec.normalized = component[0] == 'c';
      spec.sparse = sparse;
      spec.mode = 4 + static_cast<int>(files.size() % 3);
      const Mesh codes = asCodes(square, spec);
      files.push_back(MatrixWriter(spec, codes, codes).write().file);
    }
  }
  return files;
}

}  // namespace

Resources seedResources() {
  return {{"a.bin", gridGltf().bin}};
}

std::vector<FileBytes> plySeeds() {
  std::vector<FileBytes> files;
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const bool extras : {false, true}) {
      PlySpec spec;
      spec.encoding = encoding;
      spec.extras = extras;
      spec.faces = extras ? gridPolygons() : gridTriangles();
      files.push_back(makePly(spec));
      spec.coordinate = "double";
      spec.index = "ushort";
      spec.count = "uint";
      spec.lineBreak = "\r\n";
      spec.list = "vertex_index";
      files.push_back(makePly(spec));
    }
  }
  PlySpec strips;
  strips.strips = true;
  strips.faces = {{0, 3, 1, 4, 4, 5, -1, 6, 3, 7, 4}};
  files.push_back(makePly(strips));
  for (const Mesh& mesh : smallMeshes()) files.push_back(lab::writePly(mesh));
  return files;
}

std::vector<FileBytes> gltfSeeds() {
  std::vector<FileBytes> files = {gridGltf().glb(), bytesOf(gridGltf("\"uri\":\"a.bin\",").json),
                                  bytesOf(gridGltf("\"uri\":\"data:;base64," + base64(gridGltf().bin) + "\",").json),
                                  manyFeatures()};
  for (FileBytes& file : quantizedAndSparse()) files.push_back(std::move(file));
  const std::string moved = R"({"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":{"texCoord":0,"scale":[2,0.5]}}})";
  const std::string inside = R"({"uri":"data:image/png;base64,)" + base64(png()) + R"("})";
  for (const Textured& spec : {Textured{}, Textured{.component = "ushort", .texture = moved, .compressed = true},
                               Textured{.component = "uchar", .image = inside, .slot = "sheenColorTexture"}})
    files.push_back(planeFile(spec, planePositions()));
  files.push_back(DracoGrid{}.glb());
  DracoGrid edgebreaker;
  edgebreaker.json = replaced(replaced(edgebreaker.json, ",\"TEXCOORD_0\":2", ""), ",\"TEXCOORD_0\":1", "");
  edgebreaker.bin = edgebreakerGrid();
  files.push_back(edgebreaker.glb());
  for (const char* vertices : {"vertex codec 0", "vertex codec 1", "exponential filter"}) {
    for (const char* indices : {"triangles", "indices"}) {
      files.push_back(meshoptGrid("EXT_meshopt_compression", vertices, indices).glb());
    }
  }
  for (const Mesh& mesh : smallMeshes()) {
    if (mesh.faceOffsets.empty()) files.push_back(lab::writeGlb(mesh));
  }
  return files;
}

std::vector<FileBytes> drcSeeds() {
  return {sequentialGrid(), edgebreakerGrid()};
}

std::vector<FileBytes> keySeeds() {
  std::vector<FileBytes> files = {bytesOf(formatKey(testKey(24, 24))), bytesOf(formatKey(idKey()))};
  Key key = testKey(90, 90, 3);
  key.owner = "Zo\xc3\xab \"quoted\" \\ \x01";
  key.params.keyedCells = key.params.scrambleOrder = true;
  files.push_back(bytesOf(formatKey(key)));
  return files;
}

std::vector<FileBytes> pngSeeds() {
  const std::vector<float> levels = {0, 0.25f, 0.5f, 0.75f, 1, 0.1f};
  return {encodePng(logo(24, 24)), encodePng(logo(7, 3), std::vector<std::uint8_t>(21, 1)),
          encodeGreyPng(3, 2, levels)};
}

std::vector<FileBytes> meshSeeds() {
  std::vector<FileBytes> files;
  for (std::uint8_t kind = 0; kind < 6; ++kind) {
    for (const Mesh& mesh : {lab::icosphere(1), lab::bumpyGrid(9, 9, 3), lab::flatGrid(7, 7)}) {
      FileBytes file = {kind, static_cast<std::uint8_t>(mesh.vertexCount() - 3),
                        static_cast<std::uint8_t>(mesh.faceCount() - 1)};
      for (const std::uint32_t vertex : mesh.faceVertices) file.push_back(static_cast<std::uint8_t>(vertex));
      for (const double value : mesh.positions) {
        const char* type = (kind & 2) != 0 ? "char" : (kind & 4) != 0 ? "double" : "float";
        appendScalar(file, type, (kind & 2) != 0 ? value * 8 : value, io::ByteOrder::little);
      }
      files.push_back(std::move(file));
    }
  }
  return files;
}

}  // namespace quadmark::test
