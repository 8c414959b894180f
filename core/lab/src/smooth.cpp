// SPDX-License-Identifier: MIT
// Laplacian smoothing, and G. Taubin, "A signal processing approach to fair surface design", SIGGRAPH 1995.
#include "mesh_tools.h"

namespace quadmark::lab {
namespace {

void umbrellaStep(const WeldedMesh& welded, const std::vector<std::uint8_t>& fixed, double factor,
                  const std::vector<double>& from, std::vector<double>& to) {
  for (std::uint32_t v = 0; v < welded.vertexCount(); ++v) {
    const auto neighbours = welded.neighboursOf(v);
    const Vec3 p = at(from, v);
    if (fixed[v] || neighbours.empty()) {
      put(to, v, p);
      continue;
    }
    Vec3 sum;
    for (std::uint32_t n : neighbours) sum += at(from, n);
    put(to, v, p + factor * ((1 / static_cast<double>(neighbours.size())) * sum - p));
  }
}

/// One pass over all vertices per factor, `iterations` times.
Mesh smooth(const Mesh& mesh, const std::vector<double>& factors, int iterations) {
  const WeldedMesh welded = weld(mesh);
  const std::vector<std::uint8_t> fixed = borderVertices(mesh, welded);
  std::vector<double> current = welded.positions, next(current.size());
  for (int i = 0; i < iterations; ++i)
    for (double factor : factors) {
      umbrellaStep(welded, fixed, factor, current, next);
      current.swap(next);
    }
  Mesh out = mesh;
  putWelded(out, welded, current);
  return out;
}

}  // namespace

Mesh smoothLaplacian(const Mesh& mesh, double lambda, int iterations) {
  return smooth(mesh, {lambda}, iterations);
}

Mesh smoothTaubin(const Mesh& mesh, double lambda, int iterations) {
  return smooth(mesh, {lambda, -lambda / (1 - 0.1 * lambda)}, iterations);
}

}  // namespace quadmark::lab
