// SPDX-License-Identifier: MIT
#include "surface_rms.h"

#include <algorithm>
#include <cmath>

#include "point_triangle.h"
#include "quadmark/adjacency.h"

namespace quadmark::bench {
namespace {

using detail::Point;
using detail::pointAt;

// Mean squared distance from the vertices of `from` to the surface of `to`.
double meanSquare(const Mesh& mesh, const WeldedMesh& welded, const FaceRings& rings, const std::vector<double>& from,
                  const std::vector<double>& to) {
  double sum = 0;
  std::vector<std::uint8_t> done(welded.vertexCount(), 0);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const std::uint32_t w = welded.weldedOf[v];
    if (w == kNoVertex || done[w] != 0) continue;
    done[w] = 1;
    const Point p = pointAt(from, v), same = pointAt(to, v);
    if (p.x == same.x && p.y == same.y && p.z == same.z) continue;
    double best = 1e300;
    const auto scan = [&](std::uint32_t around) {
      for (const std::uint32_t f : rings.facesOf(around))
        for (std::size_t c = mesh.faceBegin(f) + 2; c < mesh.faceEnd(f); ++c)
          best = std::min(best, detail::squaredToTriangle(p, pointAt(to, mesh.faceVertices[mesh.faceBegin(f)]),
                                                          pointAt(to, mesh.faceVertices[c - 1]),
                                                          pointAt(to, mesh.faceVertices[c])));
    };
    scan(w);
    for (const std::uint32_t n : welded.neighboursOf(w)) scan(n);
    sum += best;
  }
  return sum / std::max(1u, welded.vertexCount());
}

}  // namespace

SurfaceRms surfaceRms(const Mesh& mesh, const std::vector<double>& marked) {
  const WeldedMesh welded = weld(mesh);
  const FaceRings rings = faceRings(mesh, welded);
  const double there = meanSquare(mesh, welded, rings, mesh.positions, marked);
  const double back = meanSquare(mesh, welded, rings, marked, mesh.positions);
  const double diagonal = boundingDiagonal(mesh);
  return {std::sqrt((there + back) / 2) / diagonal, std::sqrt(std::max(there, back)) / diagonal};
}

}  // namespace quadmark::bench
