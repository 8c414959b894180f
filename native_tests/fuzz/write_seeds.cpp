// SPDX-License-Identifier: MIT
//   quadmark_fuzz_seeds DIRECTORY    writes the seeds of every target to DIRECTORY/<target>/
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "fuzz/seeds.h"

int main(int argc, char** argv) {
  using namespace quadmark::test;
  if (argc != 2) {
    std::fputs("usage: quadmark_fuzz_seeds DIRECTORY\n", stderr);
    return 2;
  }
  const std::pair<const char*, std::vector<FileBytes>> targets[] = {{"ply", plySeeds()}, {"gltf", gltfSeeds()},
                                                                    {"drc", drcSeeds()}, {"key", keySeeds()},
                                                                    {"png", pngSeeds()}, {"mesh", meshSeeds()}};
  for (const auto& [target, seeds] : targets) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / target;
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      std::ofstream stream(folder / ("seed-" + std::to_string(i)), std::ios::binary);
      stream.write(reinterpret_cast<const char*>(seeds[i].data()), static_cast<std::streamsize>(seeds[i].size()));
      if (!stream) {
        std::fprintf(stderr, "quadmark_fuzz_seeds: cannot write to %s\n", folder.c_str());
        return 1;
      }
    }
  }
  return 0;
}
