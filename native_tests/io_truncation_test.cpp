// SPDX-License-Identifier: MIT
// Files that end too early, as after a broken download: a clear error or, where nothing needed is missing, a clean
// read.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "fuzz/exercise.h"
#include "fuzz/seeds.h"
#include "models.h"
#include "quadmark/random.h"

namespace quadmark::test {
namespace {

/// Reads a copy of its own that is exactly as long as the prefix, so that a sanitizer sees every step behind the end.
void expectCleanAnswer(const FileBytes& whole, std::size_t length, const Resources& resources) {
  const FileBytes file(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
  const Result<std::unique_ptr<Model>> model = readModel(file, resources);
  if (model.ok()) {
    EXPECT_TRUE(validate((*model)->mesh()).ok());
    return;
  }
  EXPECT_NE(model.error().code, ErrorCode::internal) << model.error().message;
  EXPECT_FALSE(model.error().message.empty());
}

constexpr int kPlaces = 200;

TEST(Truncation, OfGeneratedFilesGetsACleanAnswer) {
  std::vector<FileBytes> files = plySeeds();
  for (FileBytes& file : gltfSeeds()) files.push_back(std::move(file));
  Random random(1);
  for (std::size_t i = 0; i < files.size(); ++i) {
    SCOPED_TRACE("seed " + std::to_string(i));
    for (int place = 0; place < kPlaces; ++place) {
      const std::size_t length = random.below(static_cast<std::uint32_t>(files[i].size()));
      SCOPED_TRACE(length);
      expectCleanAnswer(files[i], length, seedResources());
    }
  }
}

TEST(Truncation, OfRealModelsGetsACleanAnswer) {
  const std::filesystem::path directory = modelDirectory();
  if (!std::filesystem::exists(directory)) {
    std::fprintf(stderr, "[  ABSENT  ] real models are not in %s; set QUADMARK_MODELS. This part is not tested.\n",
                 directory.c_str());
    return;
  }
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    const std::string extension = entry.path().extension().string();
    const bool isModel = extension == ".ply" || extension == ".glb" || extension == ".gltf" || extension == ".drc";
    if (isModel) names.push_back(std::filesystem::relative(entry.path(), directory).string());
  }
  std::sort(names.begin(), names.end());
  Random random(2);
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const std::optional<FileBytes> file = modelBytes(name);
    ASSERT_TRUE(file.has_value());
    const Result<std::vector<std::string>> uris = externalUris(*file);
    ASSERT_TRUE(uris.ok());
    Resources resources = modelResources(name, *uris);
    for (int place = 0; place < kPlaces; ++place) {
      const std::size_t length = random.below(static_cast<std::uint32_t>(file->size()));
      SCOPED_TRACE(length);
      expectCleanAnswer(*file, length, resources);
    }
    for (auto& resource : resources) {
      const FileBytes whole = resource.second;
      for (int place = 0; place < kPlaces; ++place) {
        resource.second.resize(random.below(static_cast<std::uint32_t>(whole.size())));
        resource.second.shrink_to_fit();
        expectCleanAnswer(*file, file->size(), resources);
        resource.second = whole;
      }
    }
  }
}

}  // namespace
}  // namespace quadmark::test
