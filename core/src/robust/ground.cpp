// SPDX-License-Identifier: MIT
#include "ground.h"

namespace quadmark::robust {

std::shared_ptr<Ground> groundOf(const Mesh& mesh, const RobustKeys& keys, bool mirrored) {
  auto out = std::make_shared<Ground>();
  out->surface = makeSurface(mesh);
  if (mirrored) turnOver(out->surface);
  out->carriers = selectCarriers(out->surface, Prf(keys.select));
  return out;
}

bool moveTo(Surface& surface, const Mesh& copy) {
  WeldedMesh& welded = surface.welded;
  std::vector<std::uint32_t> groups(copy.groups.empty() ? 0 : surface.vertexCount());
  std::vector<std::uint8_t> placed(surface.vertexCount(), 0);
  for (std::size_t v = 0; v < copy.vertexCount(); ++v) {
    const std::uint32_t w = welded.weldedOf[v];
    if (w == kNoVertex) continue;
    const Vec3 to = at(copy.positions, v), there = at(welded.positions, w);
    if (placed[w] != 0 && !(to.x == there.x && to.y == there.y && to.z == there.z)) return false;
    placed[w] = 1;
    put(welded.positions, w, to);
    if (!groups.empty()) groups[w] = copy.groups[v];
  }
  return !hasTwins(welded.positions, groups);
}

}  // namespace quadmark::robust
