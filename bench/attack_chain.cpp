// SPDX-License-Identifier: MIT
#include "attack_chain.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <utility>

#include "quadmark/random.h"

namespace quadmark::bench {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) parts.emplace_back();
    else parts.back() += c;
  }
  return parts;
}

Result<lab::AttackSpec> parseStep(const std::string& step) {
  const Error wrong{ErrorCode::badOption, "attack \"" + step + "\" is not kind:amount[:variant[:iterations]]"};
  const std::vector<std::string> parts = split(step, ':');
  if (parts.size() > 4 || parts[0].empty()) return wrong;
  lab::AttackSpec spec;
  spec.kind = parts[0];
  char* end = nullptr;
  if (parts.size() > 1 && !parts[1].empty()) {
    // strtod also takes "0x1e" and "nan", which no attack does.
    spec.amount = std::strtod(parts[1].c_str(), &end);
    if (*end != '\0' || !std::isfinite(spec.amount)) return wrong;
  }
  if (parts.size() > 2) spec.variant = parts[2];
  if (parts.size() > 3) {
    spec.iterations = static_cast<int>(std::strtol(parts[3].c_str(), &end, 10));
    if (parts[3].empty() || *end != '\0') return wrong;
  }
  return spec;
}

// The amplitude of lab::noise() that is `amount` mean distances to the centre.
double lirisAmplitude(const Mesh& mesh, double amount) {
  std::vector<std::uint8_t> used(mesh.vertexCount(), 0);
  for (const std::uint32_t v : mesh.faceVertices) used[v] = 1;
  double centre[3] = {0, 0, 0}, count = 0, distances = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    for (int k = 0; k < 3; ++k) centre[k] += mesh.positions[3 * v + k];
    ++count;
  }
  const double diagonal = boundingDiagonal(mesh);
  if (count == 0 || diagonal == 0) return 0;
  for (double& x : centre) x /= count;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    double square = 0;
    for (int k = 0; k < 3; ++k) square += (mesh.positions[3 * v + k] - centre[k]) * (mesh.positions[3 * v + k] - centre[k]);
    distances += std::sqrt(square);
  }
  return amount * distances / count / diagonal;
}

Mesh throughText(Mesh mesh, int digits) {
  for (double& x : mesh.positions) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", digits, x);
    x = std::strtod(text, nullptr);
  }
  roundToPrecision(mesh);
  return mesh;
}

Mesh subdivided(const Mesh& mesh) {
  Mesh out;
  out.positions = mesh.positions;
  out.groups = mesh.groups;
  out.precision = mesh.precision;
  // Seam twins have edges, and so middles, of their own: equal sums in either order, so twins again.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto addVertex = [&](const double* p, std::uint32_t like) {
    out.positions.insert(out.positions.end(), p, p + 3);
    if (!out.groups.empty()) out.groups.push_back(mesh.groups[like]);
    return static_cast<std::uint32_t>(out.vertexCount() - 1);
  };
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto edge = std::minmax(a, b);
    const auto at = middles.find(edge);
    if (at != middles.end()) return at->second;
    double p[3];
    for (int k = 0; k < 3; ++k) p[k] = (mesh.positions[3 * a + k] + mesh.positions[3 * b + k]) / 2;
    return middles[edge] = addVertex(p, a);
  };
  if (!mesh.faceOffsets.empty()) out.faceOffsets.push_back(0);
  const auto addFace = [&](std::initializer_list<std::uint32_t> corners) {
    out.faceVertices.insert(out.faceVertices.end(), corners);
    if (!mesh.faceOffsets.empty()) out.faceOffsets.push_back(static_cast<std::uint32_t>(out.faceVertices.size()));
  };
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const std::size_t begin = mesh.faceBegin(f), n = mesh.faceEnd(f) - begin;
    std::vector<std::uint32_t> corner(n), after(n);
    for (std::size_t i = 0; i < n; ++i) {
      corner[i] = mesh.faceVertices[begin + i];
      after[i] = middle(corner[i], mesh.faceVertices[begin + (i + 1) % n]);
    }
    if (n == 3) {
      for (std::size_t i = 0; i < 3; ++i) addFace({corner[i], after[i], after[(i + 2) % 3]});
      addFace({after[0], after[1], after[2]});
      continue;
    }
    double p[3] = {0, 0, 0};
    for (const std::uint32_t v : corner)
      for (int k = 0; k < 3; ++k) p[k] += mesh.positions[3 * v + k] / static_cast<double>(n);
    const std::uint32_t centre = addVertex(p, corner[0]);
    for (std::size_t i = 0; i < n; ++i) addFace({corner[i], after[i], centre, after[(i + n - 1) % n]});
  }
  roundToPrecision(out);
  return out;
}

Result<Mesh> applyStep(const Mesh& mesh, lab::AttackSpec spec, std::uint64_t seed) {
  const auto whole = [&](int low, int high) { return spec.amount >= low && spec.amount <= high && spec.amount == std::floor(spec.amount); };
  if (spec.kind == "liris-noise") {
    spec.kind = "noise";
    spec.amount = lirisAmplitude(mesh, spec.amount);
  } else if (spec.kind == "digits") {
    if (!whole(1, 17)) return Error{ErrorCode::badOption, "digits: the amount is a whole number, 1..17"};
    return throughText(mesh, static_cast<int>(spec.amount));
  } else if (spec.kind == "subdivide") {
    if (!whole(1, 3)) return Error{ErrorCode::badOption, "subdivide: the amount is a whole number, 1..3"};
    if (!mesh.gridOf.empty()) return Error{ErrorCode::badMesh, "subdivide: vertices on integer grids have no middles"};
    Mesh out = subdivided(mesh);
    for (int i = 1; i < static_cast<int>(spec.amount); ++i) out = subdivided(out);
    return out;
  }
  spec.seed = spec.kind == "reorder" ? Random::mix(seed + static_cast<std::uint64_t>(std::fabs(spec.amount))) : seed;
  return lab::attack(mesh, spec);
}

}  // namespace

Result<AttackChain> parseAttacks(const std::string& text) {
  AttackChain chain{text, {}};
  if (text == "none") return chain;
  for (const std::string& step : split(text, '+')) {
    auto spec = parseStep(step);
    if (!spec) return spec.error();
    chain.steps.push_back(std::move(*spec));
  }
  return chain;
}

Result<Mesh> apply(const AttackChain& chain, const Mesh& mesh, std::uint64_t seed) {
  Mesh out = mesh;
  for (std::size_t i = 0; i < chain.steps.size(); ++i) {
    auto next = applyStep(out, chain.steps[i], Random::mix(seed + i));
    if (!next) return next.error();
    out = std::move(*next);
  }
  return out;
}

}  // namespace quadmark::bench
