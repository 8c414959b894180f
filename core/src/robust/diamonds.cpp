// SPDX-License-Identifier: MIT
#include "diamonds.h"

#include <algorithm>

#include "sorting.h"

namespace quadmark::robust {
namespace {

// One number each, for there are six per vertex. The lower end is the bucket.
class HalfEdge {
 public:
  HalfEdge() = default;
  HalfEdge(std::uint32_t high, bool down, std::uint32_t opposite)
      : packed_(std::uint64_t{high} << 33 | std::uint64_t{down} << 32 | opposite) {}
  // The other end.
  [[nodiscard]] std::uint32_t high() const { return static_cast<std::uint32_t>(packed_ >> 33); }
  // Third corner of its triangle, or kNoVertex in a polygon.
  [[nodiscard]] std::uint32_t opposite() const { return static_cast<std::uint32_t>(packed_); }
  // By the other end; then those whose triangle runs along them from the lower end to the higher before the others.
  bool operator<(const HalfEdge& other) const { return packed_ < other.packed_; }

 private:
  std::uint64_t packed_ = 0;
};

// Half-edges bucketed by their lower end.
std::vector<HalfEdge> bucketEdges(const Surface& surface, std::vector<std::uint32_t>& offsets) {
  const auto forEach = [&](const auto& visit) {
    for (std::uint32_t f = 0; f < surface.faceCount(); ++f) {
      const auto face = surface.face(f);
      const std::size_t sides = face.size();
      for (std::size_t k = 0; k < sides; ++k)
        visit(face[k], face[(k + 1) % sides], sides == 3 ? face[(k + 2) % 3] : kNoVertex);
    }
  };
  offsets.assign(surface.vertexCount() + 1, 0);
  forEach([&](std::uint32_t x, std::uint32_t y, std::uint32_t) { ++offsets[std::min(x, y) + 1]; });
  for (std::size_t v = 1; v < offsets.size(); ++v) offsets[v] += offsets[v - 1];
  std::vector<HalfEdge> edges(offsets.back());
  std::vector<std::uint32_t> cursor(offsets.begin(), offsets.end() - 1);
  forEach([&](std::uint32_t x, std::uint32_t y, std::uint32_t opposite) {
    edges[cursor[std::min(x, y)]++] = {std::max(x, y), x > y, opposite};
  });
  return edges;
}

}  // namespace

std::vector<Diamond> collectDiamonds(const Surface& surface) {
  std::vector<std::uint32_t> offsets;
  std::vector<HalfEdge> edges = bucketEdges(surface, offsets);
  std::vector<Diamond> out;
  out.reserve(edges.size() / 2);
  for (std::uint32_t v = 0; v < surface.vertexCount(); ++v) {
    const auto begin = edges.begin() + offsets[v], end = edges.begin() + offsets[v + 1];
    sortShort(begin, end);
    for (auto e = begin; e != end;) {
      auto next = e;
      while (next != end && next->high() == e->high()) ++next;
      if (next - e == 2) {
        const std::uint32_t one = e->opposite(), other = (e + 1)->opposite();
        if (one != other && one != kNoVertex && other != kNoVertex) out.push_back({one, v, other, e->high()});
      }
      e = next;
    }
  }
  for (std::uint32_t f = 0; f < surface.faceCount(); ++f) {
    const auto face = surface.face(f);
    if (face.size() != 4 || face[0] == face[2] || face[1] == face[3]) continue;
    out.push_back({face[1], face[2], face[3], face[0]});
  }
  return out;
}

bool diamondShape(const std::vector<double>& positions, const Diamond& diamond, DiamondShape& out) {
  const Vec3 a = at(positions, diamond.a), b = at(positions, diamond.b);
  const Vec3 u = at(positions, diamond.c) - a, v = at(positions, diamond.d) - b, w = a - b;
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 1e-4 * uu * vv)) return false;
  out.alongSpan = (uv * vw - vv * uw) / determinant;
  out.alongEdge = (uu * vw - uv * uw) / determinant;
  const double s = out.alongSpan, e = out.alongEdge;
  if (!(s > 0 && s < 1 && e > 0 && e < 1)) return false;
  out.gap = w + s * u - e * v;
  out.gapLength = length(out.gap);
  out.edgeLength = std::sqrt(vv);
  out.spanLength = std::sqrt(uu);
  out.gapGain = std::sqrt((1 - s) * (1 - s) + s * s + (1 - e) * (1 - e) + e * e);
  const double sine = std::sqrt(determinant / (uu * vv));
  out.edgeGain = out.gapGain / (out.edgeLength * sine);
  out.spanGain = out.gapGain / (out.spanLength * sine);
  return true;
}

}  // namespace quadmark::robust
