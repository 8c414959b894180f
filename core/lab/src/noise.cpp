// SPDX-License-Identifier: MIT
#include "mesh_tools.h"
#include "quadmark/random.h"

namespace quadmark::lab {
namespace {

template <class Affected>
Mesh noiseWhere(const Mesh& mesh, const WeldedMesh& welded, double amplitude, std::uint64_t seed,
                const Affected& affected) {
  const double size = amplitude * length(boxOf(welded.positions).size());
  Random random(seed);
  std::vector<double> moved = welded.positions;
  for (std::size_t v = 0; v < welded.vertexCount(); ++v) {
    const Vec3 p = at(welded.positions, v);
    const double dx = random.uniform(-size, size), dy = random.uniform(-size, size), dz = random.uniform(-size, size);
    if (affected(p)) put(moved, v, p + Vec3{dx, dy, dz});
  }
  Mesh out = mesh;
  putWelded(out, welded, moved);
  return out;
}

}  // namespace

Mesh noise(const Mesh& mesh, double amplitude, std::uint64_t seed) {
  return noiseWhere(mesh, weld(mesh), amplitude, seed, [](const Vec3&) { return true; });
}

Mesh localNoise(const Mesh& mesh, double amplitude, double share, std::uint64_t seed) {
  const WeldedMesh welded = weld(mesh);
  const std::size_t count = shareOf(share, welded.vertexCount());
  if (count == 0) return mesh;
  const Vec3 direction = randomDirection(Random::mix(seed + 1));  // apart from the noise's own numbers
  const HeightKey limit = lowestKeys(welded, direction, count);
  return noiseWhere(mesh, welded, amplitude, seed, [&](const Vec3& p) { return !(limit < heightKey(p, direction)); });
}

}  // namespace quadmark::lab
