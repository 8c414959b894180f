// SPDX-License-Identifier: MIT
// Files made to hurt: random damage, counts that lie, small files that ask for large results. What the tests require is
// a clean answer; that no byte outside is touched is the sanitizers' part.
#include <gtest/gtest.h>

#include <chrono>

#include "io_allocations.h"
#include "io_fixtures.h"
#include "io_gltf_matrix.h"

namespace quadmark::test {
namespace {

struct Bits {
  std::uint64_t state;
  std::uint64_t next() {
    state = 6364136223846793005u * state + 1442695040888963407u;
    return state >> 33;
  }
};

/// Reads, and where that works patches: every outcome is fine, a crash or an invalid mesh is not.
void exercise(const FileBytes& file, const Resources& resources = {}) {
  static_cast<void>(externalUris(file));
  Result<std::unique_ptr<Model>> model = readModel(file, resources);
  if (!model.ok()) {
    EXPECT_FALSE(model.error().message.empty());
    EXPECT_NE(model.error().code, ErrorCode::internal) << model.error().message;
    return;
  }
  ASSERT_TRUE(validate((*model)->mesh()).ok()) << validate((*model)->mesh()).error().message;
  Mesh moved = (*model)->mesh();
  for (double& value : moved.positions) value = value * 0.75 + 0.1;
  roundToPrecision(moved);
  const Result<PatchedFile> patched = (*model)->patch(file, resources, moved.positions);
  if (!patched.ok()) {
    EXPECT_EQ(patched.error().code, ErrorCode::unsupportedFile) << patched.error().message;
    return;
  }
  Resources changed = resources;
  for (const auto& [uri, bytes] : patched->resources) changed[uri] = bytes;
  Result<std::unique_ptr<Model>> again = readModel(patched->bytes, changed);
  if (!again.ok() && again.error().code == ErrorCode::badMesh) return;  // tiny extents vanish beside the shift
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ((*again)->mesh().positions, moved.positions);
  EXPECT_EQ((*again)->mesh().faceVertices, moved.faceVertices);
}

std::vector<FileBytes> seeds() {
  std::vector<FileBytes> files;
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const bool extras : {false, true}) {
      PlySpec spec;
      spec.encoding = encoding;
      spec.extras = extras;
      spec.faces = extras ? gridPolygons() : gridTriangles();
      files.push_back(makePly(spec));
    }
  }
  PlySpec strips;
  strips.strips = true;
  strips.faces = {{0, 3, 1, 4, 4, 5, -1, 6, 3, 7, 4}};
  files.push_back(makePly(strips));
  files.push_back(gridGltf().glb());
  Mesh square;
  square.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0.5, 0, 1, 0};
  square.faceVertices = {0, 1, 2, 0, 2, 3};
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
  files.push_back(bytesOf(gridGltf("\"uri\":\"a.bin\",").json));
  files.push_back(bytesOf(gridGltf("\"uri\":\"data:;base64," + base64(gridGltf().bin) + "\",").json));
  return files;
}

TEST(HostileFiles, SurviveRandomDamage) {
  const Resources resources = {{"a.bin", gridGltf().bin}};
  const std::string interesting = "0123456789-.e,:[]{}\" \n\xff";
  Bits bits{2024};
  for (const FileBytes& seed : seeds()) {
    for (int round = 0; round < 3000; ++round) {
      FileBytes file = seed;
      for (std::uint64_t edits = 1 + bits.next() % 3; edits > 0; --edits) {
        const std::size_t at = bits.next() % file.size();
        switch (bits.next() % 5) {
          case 0:
            file[at] = static_cast<std::uint8_t>(bits.next());
            break;
          case 1:
            file[at] = static_cast<std::uint8_t>(interesting[bits.next() % interesting.size()]);
            break;
          case 2:
            file.erase(file.begin() + static_cast<std::ptrdiff_t>(at));
            break;
          case 3:
            file.insert(file.begin() + static_cast<std::ptrdiff_t>(at),
                        static_cast<std::uint8_t>(interesting[bits.next() % interesting.size()]));
            break;
          default: {  // copy a piece over another one
            const std::size_t from = bits.next() % file.size();
            for (std::size_t i = 0; i < 6 && at + i < file.size() && from + i < file.size(); ++i)
              file[at + i] = file[from + i];
          }
        }
        if (file.empty()) file.push_back('p');
      }
      exercise(file, resources);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
}

#if QM_COUNT_ALLOCATIONS
/// The largest single allocation while a file is read.
std::size_t largestAllocationFor(const FileBytes& file) {
  resetLargestAllocation();
  const Result<std::unique_ptr<Model>> model = readModel(file);
  return largestAllocation();
}

TEST(HostileFiles, DoNotMakeTheReaderAllocateWhatTheyClaim) {
  std::vector<FileBytes> files;
  const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
  for (const char* encoding : {"ascii", "binary_little_endian"}) {
    for (const char* count : {"4294967295", "1000000000", "9223372036854775807"}) {
      const std::string start = std::string("ply\nformat ") + encoding + " 1.0\nelement vertex ";
      const std::string faces = "property list uint int vertex_indices\nend_header\n";
      files.push_back(bytesOf(start + count + "\n" + vertex + "element face 1\n" + faces + std::string(200, '0')));
      files.push_back(bytesOf(start + "3\n" + vertex + "element face " + count + "\n" + faces + std::string(200, '0')));
      files.push_back(bytesOf(start + "3\n" + vertex + "element nothing " + count + "\nelement face 1\n" + faces +
                              "0 0 0 1 0 0 0 1 0 4000000000 1 2 3"));
    }
  }
  for (const char* count : {"\"count\":4294967295", "\"count\":1000000000"}) {
    const GridGltf grid = gridGltf();
    files.push_back(makeGlb(replaced(grid.json, "\"count\":9", count), grid.bin));
    files.push_back(makeGlb(replaced(grid.json, "\"count\":24", count), grid.bin));
  }
  for (const FileBytes& file : files) {
    EXPECT_LT(largestAllocationFor(file), 100000u) << textOf(file).substr(0, 200);
    EXPECT_FALSE(readModel(file).ok());
  }
}

TEST(HostileFiles, AllocateInProportionToTheirSize) {
  // Many small entries of any kind: no entry may cost more than some multiple of its text.
  const GridGltf grid = gridGltf();
  for (const auto& [array, entry] :
       {std::pair{"\"nodes\":[", "{\"mesh\":0},"}, std::pair{"\"accessors\":[{\"bufferView\":0", "{},"},
        std::pair{"\"bufferViews\":[", "{},"}, std::pair{"\"buffers\":[", "{},"}, std::pair{"\"meshes\":[", "{},"},
        std::pair{"\"primitives\":[", R"({"attributes":{"POSITION":0}},)"}}) {
    std::string many;
    for (int i = 0; i < 20000; ++i) many += entry;
    const std::string key(array);
    const std::string head = key.substr(0, key.find('[') + 1);
    const FileBytes file = makeGlb(replaced(grid.json, key, head + many + key.substr(head.size())), grid.bin);
    EXPECT_LT(largestAllocationFor(file), 60 * file.size()) << key;
  }
}
#endif

TEST(HostileFiles, AreRefusedWhenTheyReuseDataWithoutEnd) {
  // 2000 index accessors over the same bytes, all different: 2000 * 65000 corners from a file of 300 kB.
  BufferBuilder buffer;
  buffer.floats(gridPositions());
  buffer.bytes.resize(buffer.bytes.size() + 66000, 1);
  std::string accessors, primitives;
  for (int i = 0; i < 2000; ++i) {
    accessors += R"(,{"bufferView":1,"byteOffset":)" + std::to_string(i % 1000) + R"(,"componentType":5121,"count":)" +
                 std::to_string(65000 - i / 1000) + R"(,"type":"SCALAR"})";
    primitives += R"({"attributes":{"POSITION":0},"mode":5,"indices":)" + std::to_string(i + 2) + "},";
  }
  std::string json = replaced(replaced(gridGltf().json, ":48", ":66000"), "156", std::to_string(buffer.bytes.size()));
  json = replaced(json, R"("type":"SCALAR"})", R"("type":"SCALAR"})" + accessors);
  json = replaced(json, "\"primitives\":[", "\"primitives\":[" + primitives);
  const auto begin = std::chrono::steady_clock::now();
  const Result<std::unique_ptr<Model>> model = readModel(makeGlb(json, buffer.bytes));
  ASSERT_FALSE(model.ok());
  EXPECT_EQ(model.error().code, ErrorCode::tooLarge) << model.error().message;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(HostileFiles, AreRefusedAboveTheEntryLimits) {
  std::string many;
  for (int i = 0; i < (1 << 20) + 1; ++i) many += "0,";
  for (const char* key : {"buffers", "bufferViews", "accessors"}) {
    const Result<std::unique_ptr<Model>> model = readModel(
        bytesOf(replaced(gridGltf().json, std::string("\"") + key + "\":[", std::string("\"") + key + "\":[" + many)));
    ASSERT_FALSE(model.ok());
    EXPECT_EQ(model.error().code, ErrorCode::tooLarge);
    EXPECT_NE(model.error().message.find(key), std::string::npos);
  }
}

}  // namespace
}  // namespace quadmark::test
