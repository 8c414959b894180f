// SPDX-License-Identifier: MIT
// Facts about meshes that tests ask for: edge use, orientation, valences, volume, a hash of the exact content.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "quadmark/mesh.h"

namespace quadmark::testing {

/// How often each undirected edge is passed from its lower to its higher end, and the other way round.
struct EdgeUse {
  int up = 0, down = 0;
};
using EdgeUses = std::map<std::pair<std::uint32_t, std::uint32_t>, EdgeUse>;

inline EdgeUses edgeUses(const Mesh& mesh) {
  EdgeUses uses;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f)
    for (std::size_t c = mesh.faceBegin(f); c < mesh.faceEnd(f); ++c) {
      const std::uint32_t a = mesh.faceVertices[c];
      const std::uint32_t b = mesh.faceVertices[c + 1 == mesh.faceEnd(f) ? mesh.faceBegin(f) : c + 1];
      if (a < b)
        ++uses[{a, b}].up;
      else
        ++uses[{b, a}].down;
    }
  return uses;
}

/// Every edge is used by exactly two faces that run through it in opposite directions.
inline bool isClosedAndOriented(const Mesh& mesh) {
  for (const auto& [edge, use] : edgeUses(mesh))
    if (edge.first == edge.second || use.up != 1 || use.down != 1) return false;
  return true;
}

/// Vertices in use - edges + faces: 2 for a sphere, 0 for a torus.
inline long eulerCharacteristic(const Mesh& mesh) {
  const std::set<std::uint32_t> used(mesh.faceVertices.begin(), mesh.faceVertices.end());
  return static_cast<long>(used.size()) - static_cast<long>(edgeUses(mesh).size()) +
         static_cast<long>(mesh.faceCount());
}

inline std::vector<int> valences(const Mesh& mesh) {
  std::vector<int> valence(mesh.vertexCount(), 0);
  for (const auto& [edge, use] : edgeUses(mesh)) ++valence[edge.first], ++valence[edge.second];
  return valence;
}

/// Enclosed volume of a closed mesh; positive when faces run counter-clockwise seen from outside.
inline double signedVolume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f)
    for (std::size_t c = mesh.faceBegin(f) + 2; c < mesh.faceEnd(f); ++c) {
      const double* p = &mesh.positions[3 * std::size_t{mesh.faceVertices[mesh.faceBegin(f)]}];
      const double* q = &mesh.positions[3 * std::size_t{mesh.faceVertices[c - 1]}];
      const double* r = &mesh.positions[3 * std::size_t{mesh.faceVertices[c]}];
      sum +=
          p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
    }
  return sum / 6;
}

using Position = std::array<double, 3>;
inline Position positionOf(const Mesh& mesh, std::size_t vertex) {
  return {mesh.positions[3 * vertex], mesh.positions[3 * vertex + 1], mesh.positions[3 * vertex + 2]};
}

/// FNV-1a over every bit of the positions and faces: equal numbers on every platform, or the build is not bit-equal.
inline std::uint64_t contentHash(const Mesh& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](std::uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8) hash = (hash ^ ((word >> shift) & 0xff)) * 0x100000001b3u;
  };
  for (double x : mesh.positions) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    add(bits);
  }
  for (std::uint32_t offset : mesh.faceOffsets) add(offset);
  for (std::uint32_t v : mesh.faceVertices) add(v);
  return hash;
}

}  // namespace quadmark::testing
