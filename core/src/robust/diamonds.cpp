// SPDX-License-Identifier: MIT
#include "diamonds.h"

#include <algorithm>

#include "sorting.h"

namespace quadmark::robust {
namespace {

struct HalfEdge {
  std::uint32_t high;      // the other end; the lower one is the bucket
  std::uint32_t opposite;  // third corner of its triangle, or kNoVertex in a polygon
  bool down;               // its triangle runs along it from the higher end to the lower
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
    edges[cursor[std::min(x, y)]++] = {std::max(x, y), opposite, x > y};
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
    sortShort(begin, end, [](const HalfEdge& x, const HalfEdge& y) {
      if (x.high != y.high) return x.high < y.high;
      return x.down != y.down ? y.down : x.opposite < y.opposite;
    });
    for (auto e = begin; e != end;) {
      auto next = e;
      while (next != end && next->high == e->high) ++next;
      const bool pair = next - e == 2 && e->opposite != (e + 1)->opposite && e->opposite != kNoVertex &&
                        (e + 1)->opposite != kNoVertex;
      if (pair) out.push_back({e->opposite, v, (e + 1)->opposite, e->high});
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
