// SPDX-License-Identifier: MIT
// The fuzzers' seeds, and the inputs that once broke something (fuzz/found/<target>/), in every ordinary test run.
#include <gtest/gtest.h>

#include <filesystem>

#include "fuzz/exercise.h"
#include "fuzz/seeds.h"
#include "io_allocations.h"
#include "models.h"

namespace quadmark::test {
namespace {

struct Target {
  const char* name;
  Problem (*exercise)(Bytes);
  std::vector<FileBytes> seeds;
};

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {{"ply", exerciseModel, plySeeds()}, {"gltf", exerciseModel, gltfSeeds()},
                                          {"drc", exerciseModel, drcSeeds()}, {"key", exerciseKey, keySeeds()},
                                          {"png", exercisePng, pngSeeds()},   {"mesh", exerciseMesh, meshSeeds()}};
  return all;
}

void expectClean(const Target& target, const FileBytes& file) {
#if QM_COUNT_ALLOCATIONS
  resetLargestAllocation();
#endif
  EXPECT_EQ(target.exercise(file), "");
#if QM_COUNT_ALLOCATIONS
  EXPECT_LE(largestAllocation(), 8 * file.size() + (64u << 20));
#endif
}

TEST(Fuzzing, BeginsWithSoundFiles) {
  for (const Target& target : targets()) {
    for (std::size_t i = 0; i < target.seeds.size(); ++i) {
      SCOPED_TRACE(std::string(target.name) + " seed " + std::to_string(i));
      expectClean(target, target.seeds[i]);
      const FileBytes& seed = target.seeds[i];
      if (target.exercise == static_cast<Problem (*)(Bytes)>(exerciseModel)) {
        EXPECT_TRUE(readModel(seed, seedResources()).ok());
      }
    }
  }
}

TEST(Fuzzing, FoundNothingThatStillBreaks) {
  const std::filesystem::path found = std::string(QUADMARK_SOURCE_DIR) + "/native_tests/fuzz/found";
  for (const Target& target : targets()) {
    if (!std::filesystem::exists(found / target.name)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(found / target.name)) {
      SCOPED_TRACE(entry.path().string());
      const std::optional<FileBytes> file = readFile(entry.path().string());
      ASSERT_TRUE(file.has_value());
      expectClean(target, *file);
    }
  }
}

}  // namespace
}  // namespace quadmark::test
