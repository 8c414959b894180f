// SPDX-License-Identifier: MIT
// Models by name, at about the size asked for.
#include "quadmark/lab/generate.h"

#include <algorithm>
#include <cmath>

namespace quadmark::lab {
namespace {

constexpr std::size_t kMaxVertices = 20'000'000;

/// The side of a square grid of about this many vertices.
int gridSide(std::size_t vertices) {
  return std::max(2, static_cast<int>(std::sqrt(static_cast<double>(vertices)) + 0.5));
}

/// The subdivision level whose vertex count, perLevelZero * 4^level, comes nearest from below or meets it.
int level(std::size_t vertices, std::size_t perLevelZero) {
  int result = 0;
  while ((perLevelZero << (2 * (result + 1))) <= vertices + vertices / 8) ++result;
  return result;
}

struct Model {
  const char* name;
  Mesh (*make)(std::size_t vertices, std::uint64_t seed);
};

constexpr Model kModels[] = {
    {"sculpture", [](std::size_t n, std::uint64_t seed) { return sculpture(n, seed); }},
    {"part", [](std::size_t n, std::uint64_t seed) { return machinedPart(n, seed); }},
    {"cube", [](std::size_t, std::uint64_t) { return cube(); }},
    {"quad-sphere", [](std::size_t n, std::uint64_t) { return quadSphere(level(n, 6)); }},
    {"icosphere", [](std::size_t n, std::uint64_t) { return icosphere(level(n, 10)); }},
    {"bumpy-grid", [](std::size_t n, std::uint64_t seed) { return bumpyGrid(gridSide(n), gridSide(n), seed); }},
    {"flat-grid", [](std::size_t n, std::uint64_t) { return flatGrid(gridSide(n), gridSide(n)); }},
    {"polygon-mix", [](std::size_t, std::uint64_t seed) { return polygonMix(seed); }},
    {"fan", [](std::size_t n, std::uint64_t) { return fan(static_cast<int>(std::max<std::size_t>(n, 4)) - 1); }},
    {"non-manifold", [](std::size_t, std::uint64_t) { return nonManifold(); }},
    {"two-components", [](std::size_t, std::uint64_t seed) { return twoComponents(seed); }},
    {"seamed", [](std::size_t, std::uint64_t seed) { return seamed(seed); }},
};

}  // namespace

Result<Mesh> generate(const std::string& name, std::size_t vertices, std::uint64_t seed) {
  if (vertices > kMaxVertices)
    return Error{ErrorCode::badOption,
                 "generate: " + std::to_string(vertices) + " vertices are more than " + std::to_string(kMaxVertices)};
  std::string known;
  for (const Model& model : kModels) {
    if (name == model.name) return model.make(vertices, seed);
    known += (known.empty() ? "" : ", ") + std::string(model.name);
  }
  return Error{ErrorCode::badOption, "generate: model \"" + name + "\" is not one of " + known};
}

}  // namespace quadmark::lab
