// SPDX-License-Identifier: MIT
// The dependency rule over the #include lines of the core.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

// Files that are parts of a module of another name; embed_assign belongs to embed without being listed.
std::string partOf(const std::string& stem) {
  static const std::map<std::string, std::string> parts = {
      {"embedder", "embed"},         {"ring_sets", "cells"},     {"hausdorff", "metrics"},
      {"point_triangle", "metrics"}, {"key_file", "key_file"},   {"surface_distance", "metrics"},
      {"triangle_tree", "metrics"},
      {"exact_math", "exact_math"},  {"stb_image", "stb_image"}, {"stb_image_write", "stb_image"}};
  const auto found = parts.find(stem);
  return found != parts.end() ? found->second : stem.substr(0, stem.find('_'));
}

// core/include/quadmark/io/ply.h -> "io", core/src/ring_sets.h -> "cells": a folder is one module.
std::string moduleOf(const std::string& path) {
  const std::size_t slash = path.find('/');
  if (slash != path.npos) return path.substr(0, slash);
  return partOf(path.substr(0, path.find('.')));
}

class Architecture : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef __EMSCRIPTEN__
    GTEST_SKIP() << "the same source text is checked by the native run; Emscripten's raw file system lists no folders";
#endif
  }
};

struct Include {
  std::string file, module, target;
};

// All quoted includes of one tree; `root` is cut from the paths and "quadmark/" from the targets.
std::vector<Include> includesUnder(const std::string& root) {
  std::vector<Include> out;
  for (const auto& entry : fs::recursive_directory_iterator(std::string(QUADMARK_SOURCE_DIR) + "/" + root)) {
    if (!entry.is_regular_file()) continue;
    const std::string file = fs::relative(entry.path(), std::string(QUADMARK_SOURCE_DIR) + "/" + root).generic_string();
    std::ifstream stream(entry.path());
    for (std::string line; std::getline(stream, line);) {
      if (line.rfind("#include \"", 0) != 0) continue;
      std::string target = line.substr(10, line.find('"', 10) - 10);
      const bool isPublic = target.rfind("quadmark/", 0) == 0;
      if (isPublic) target = target.substr(9);
      // A private header is named relative to its own folder.
      const std::string module = moduleOf(file);
      out.push_back({root + "/" + file, module, !isPublic && file.find('/') != file.npos ? module : moduleOf(target)});
    }
  }
  return out;
}

std::vector<Include> coreIncludes() {
  std::vector<Include> all = includesUnder("core/include/quadmark"), sources = includesUnder("core/src");
  all.insert(all.end(), sources.begin(), sources.end());
  return all;
}

// What each module may include besides itself, in the order of the pipeline: nothing includes what comes later.
const std::map<std::string, std::set<std::string>>& allowed() {
  static const std::set<std::string> everything = {"result", "mesh",   "random",    "prf",    "exact_math", "base64",
                                                   "key",    "image",  "adjacency", "quad",   "digits",     "payload",
                                                   "cells",  "purity", "verdict",   "embed",  "extract",    "metrics",
                                                   "io",     "report", "quadmark",  "robust", "vec3",       "trig",
                                                   "json",   "sorting", "concat"};
  static const std::map<std::string, std::set<std::string>> rules = {
      {"result", {}},
      {"concat", {}},
      {"release", {}},
      {"random", {}},
      {"prf", {}},
      {"exact_math", {}},
      {"base64", {}},
      {"number", {"concat"}},
      {"json", {"result", "number", "concat"}},
      {"quad", {}},
      {"mesh", {"result", "concat"}},
      {"stb", {"stb_image"}},
      {"image", {"result", "stb", "concat"}},
      {"key", {"result", "concat"}},
      {"key_file", {"key", "base64", "json", "number", "concat"}},
      {"sorting", {}},
      {"threads", {}},
      {"parallel", {"threads"}},
      {"adjacency", {"mesh", "sorting"}},
      {"digits", {"key"}},
      {"payload", {"key", "prf"}},
      {"verdict", {"exact_math"}},
      {"purity", {"digits"}},
      {"cells", {"adjacency", "key", "quad"}},
      {"extract",
       {"adjacency", "quad", "cells", "digits", "key", "payload", "purity", "verdict", "exact_math", "sorting"}},
      {"embed",
       {"adjacency", "quad", "cells", "digits", "key", "mesh", "result", "payload", "extract", "sorting", "concat", "release"}},
      {"metrics", {"mesh", "adjacency", "parallel"}},
      {"vec3", {}},
      {"trig", {}},
      {"robust",
       {"result", "mesh", "prf", "random", "exact_math", "verdict", "adjacency", "vec3", "trig", "key", "image"}},
      {"io", {"mesh", "adjacency", "result"}},
      {"report", everything},
      {"quadmark", everything},
  };
  return rules;
}

TEST_F(Architecture, IncludesOnlyWhatComesEarlierInThePipeline) {
  const std::vector<Include> includes = coreIncludes();
  EXPECT_GT(includes.size(), 60u);  // the files were found
  for (const Include& i : includes) {
    ASSERT_EQ(allowed().count(i.module), 1u) << i.file << ": no rule for module " << i.module;
    EXPECT_TRUE(i.target == i.module || allowed().at(i.module).count(i.target) == 1)
        << i.file << " includes " << i.target;
  }
}

TEST_F(Architecture, KeepsFilesAwayFromTheScheme) {
  for (const Include& i : coreIncludes())
    EXPECT_TRUE(i.target != "io" || i.module == "io" || i.module == "quadmark" || i.module == "report") << i.file;
}

TEST_F(Architecture, KeepsTheLabOutOfTheCore) {
  for (const Include& i : coreIncludes()) EXPECT_NE(i.target, "lab") << i.file;
}

TEST_F(Architecture, HasNoCyclesBetweenItsRules) {
  // Depth-first: a rule that led back to its own module would make the order meaningless.
  for (const auto& [start, direct] : allowed()) {
    if (start == "report" || start == "quadmark") continue;  // the top: may include anything
    std::set<std::string> seen;
    std::vector<std::string> stack(direct.begin(), direct.end());
    while (!stack.empty()) {
      const std::string module = stack.back();
      stack.pop_back();
      if (!seen.insert(module).second || allowed().count(module) == 0) continue;
      const auto& next = allowed().at(module);
      stack.insert(stack.end(), next.begin(), next.end());
    }
    EXPECT_EQ(seen.count(start), 0u) << start;
  }
}

// What is bit-equal on every platform must not depend on these (house rule; see docs/design.md).
TEST_F(Architecture, DecidesWithoutLibraryRandomnessOrUnorderedContainers) {
  for (const std::string tree : {"core/src", "core/include/quadmark", "core/lab/src"})
    for (const auto& entry : fs::recursive_directory_iterator(std::string(QUADMARK_SOURCE_DIR) + "/" + tree)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream stream(entry.path());
      for (std::string line; std::getline(stream, line);) {
        const std::size_t comment = line.find("//");
        const std::string code = line.substr(0, comment);
        for (const char* banned : {"std::shuffle", "#include <random>", "unordered_map<", "unordered_set<",
                                   "std::ranges", "std::pow(", "std::cbrt(", "std::hypot(", "std::fma("})
          EXPECT_EQ(code.find(banned), code.npos) << entry.path() << ": " << line;
      }
    }
}

}  // namespace
