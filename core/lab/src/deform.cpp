// SPDX-License-Identifier: MIT
#include <algorithm>

#include "mesh_tools.h"
#include "quadmark/random.h"
#include "quadmark/trig.h"

namespace quadmark::lab {
namespace {

/// Rodrigues' rotation of p about a unit axis.
Vec3 rotate(const Vec3& p, const Vec3& axis, const SinCos& angle) {
  return angle.cos * p + angle.sin * cross(axis, p) + ((1 - angle.cos) * dot(axis, p)) * axis;
}

Vec3 longestAxis(const Vec3& size) {
  if (size.x >= size.y && size.x >= size.z) return {1, 0, 0};
  return size.y >= size.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
}

}  // namespace

Mesh deform(const Mesh& mesh, double amount, std::uint64_t seed) {
  const WeldedMesh welded = weld(mesh);
  if (welded.vertexCount() == 0) return mesh;
  const Box box = boxOf(welded.positions);
  const Vec3 along = longestAxis(box.size());
  const double median = lowestKeys(welded, along, (welded.vertexCount() + 1) / 2).height;
  const double reach = dot(box.high, along) - median;
  if (!(reach > 0)) return mesh;

  Random random(seed);
  const Vec3 across = normalized(cross(along, randomDirection(random.next())));
  const double twist = random.below(2) == 0 ? 0.5 * amount : -0.5 * amount;
  Vec3 pivot = box.centre();
  pivot += (median - dot(pivot, along)) * along;

  std::vector<double> moved = welded.positions;
  for (std::size_t v = 0; v < welded.vertexCount(); ++v) {
    const Vec3 p = at(welded.positions, v);
    const double t = (dot(p, along) - median) / reach;
    if (!(t > 0)) continue;
    // Quintic fall-off: two continuous derivatives at the anchor, so that the seam does not show in the shading.
    const double weight = t * t * t * (t * (6 * t - 15) + 10);
    const Vec3 twisted = rotate(p - pivot, along, sinCos(twist * weight));
    put(moved, v, pivot + rotate(twisted, across, sinCos(amount * weight)));
  }
  Mesh out = mesh;
  putWelded(out, welded, moved);
  return out;
}

}  // namespace quadmark::lab
