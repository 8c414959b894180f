// SPDX-License-Identifier: MIT
// Files made to hurt: random damage, counts that lie, small files that ask for large results. What the tests require is
// a clean answer; that no byte outside is touched is the sanitizers' part.
#include <gtest/gtest.h>

#include <chrono>

#include "fixtures.h"
#include "fuzz/exercise.h"
#include "fuzz/seeds.h"
#include "io_allocations.h"

namespace quadmark::test {
namespace {

struct Bits {
  std::uint64_t state;
  std::uint64_t next() {
    state = 6364136223846793005u * state + 1442695040888963407u;
    return state >> 33;
  }
};

TEST(HostileFiles, SurviveRandomDamage) {
  const std::string interesting = "0123456789-.e,:[]{}\" \n\xff";
  Bits bits{2024};
  std::vector<FileBytes> seeds = plySeeds();
  for (FileBytes& seed : gltfSeeds()) seeds.push_back(std::move(seed));
  for (const FileBytes& seed : seeds) {
    for (int round = repetitions(400); round > 0; --round) {
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
      ASSERT_EQ(exerciseModel(file), "");
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
