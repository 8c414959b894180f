// SPDX-License-Identifier: MIT
#include "mesh_tools.h"

#include <algorithm>

#include "quadmark/random.h"

namespace quadmark::lab {

Box boxOf(const std::vector<double>& positions) {
  Box box;
  if (positions.empty()) return box;
  box.low = box.high = at(positions, 0);
  for (std::size_t v = 1; v < positions.size() / 3; ++v) {
    const Vec3 p = at(positions, v);
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

void putWelded(Mesh& mesh, const WeldedMesh& welded, const std::vector<double>& weldedPositions) {
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    if (welded.weldedOf[v] != kNoVertex) put(mesh.positions, v, at(weldedPositions, welded.weldedOf[v]));
  roundToPrecision(mesh);
}

Mesh keepVertices(const Mesh& mesh, const std::vector<std::uint8_t>& marked, VertexOrigin* origin) {
  Mesh out;
  out.precision = mesh.precision;
  if (origin) origin->clear();
  std::vector<std::uint32_t> numberOf(mesh.vertexCount(), kNoVertex);
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    if (!marked[v]) continue;
    numberOf[v] = count++;
    append(out.positions, at(mesh.positions, v));
    if (!mesh.groups.empty()) out.groups.push_back(mesh.groups[v]);
    if (origin) origin->push_back(static_cast<std::uint32_t>(v));
  }
  const bool polygons = !mesh.faceOffsets.empty();
  if (polygons) out.faceOffsets.push_back(0);
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    bool whole = true;
    for (std::size_t c = mesh.faceBegin(f); c < mesh.faceEnd(f) && whole; ++c)
      whole = marked[mesh.faceVertices[c]] != 0;
    if (!whole) continue;
    for (std::size_t c = mesh.faceBegin(f); c < mesh.faceEnd(f); ++c)
      out.faceVertices.push_back(numberOf[mesh.faceVertices[c]]);
    if (polygons) out.faceOffsets.push_back(static_cast<std::uint32_t>(out.faceVertices.size()));
  }
  return out;
}

std::vector<std::uint32_t> fannedTriangles(const Mesh& mesh) {
  if (mesh.faceOffsets.empty()) return mesh.faceVertices;
  std::vector<std::uint32_t> triangles;
  triangles.reserve(mesh.faceVertices.size() * 3 / 2);
  for (std::size_t f = 0; f < mesh.faceCount(); ++f)
    for (std::size_t c = mesh.faceBegin(f) + 2; c < mesh.faceEnd(f); ++c)
      triangles.insert(triangles.end(),
                       {mesh.faceVertices[mesh.faceBegin(f)], mesh.faceVertices[c - 1], mesh.faceVertices[c]});
  return triangles;
}

std::vector<std::uint8_t> borderVertices(const Mesh& mesh, const WeldedMesh& welded) {
  // Faces per edge, kept at the edge's place in the neighbour list of its lower end.
  std::vector<std::uint8_t> faces(welded.neighbours.size(), 0);
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const std::size_t begin = mesh.faceBegin(f), end = mesh.faceEnd(f);
    for (std::size_t c = begin; c < end; ++c) {
      std::uint32_t a = welded.weldedOf[mesh.faceVertices[c]];
      std::uint32_t b = welded.weldedOf[mesh.faceVertices[c + 1 == end ? begin : c + 1]];
      if (a == b) continue;
      if (a > b) std::swap(a, b);
      const auto list = welded.neighboursOf(a);
      const auto place = std::lower_bound(list.begin(), list.end(), b) - list.begin();
      std::uint8_t& count = faces[welded.edgeOffsets[a] + static_cast<std::size_t>(place)];
      if (count < 2) ++count;
    }
  }
  std::vector<std::uint8_t> border(welded.vertexCount(), 0);
  for (std::uint32_t a = 0; a < welded.vertexCount(); ++a)
    for (std::uint32_t e = welded.edgeOffsets[a]; e < welded.edgeOffsets[a + 1]; ++e)
      if (faces[e] == 1) border[a] = border[welded.neighbours[e]] = 1;
  return border;
}

Vec3 randomDirection(std::uint64_t seed) {
  Random random(seed);
  for (;;) {  // rejection from the cube: 52 % of the draws serve
    const Vec3 p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const double square = dot(p, p);
    if (square <= 1 && square > 0.01) return normalized(p);
  }
}

HeightKey lowestKeys(const WeldedMesh& welded, const Vec3& direction, std::size_t count) {
  std::vector<HeightKey> keys(welded.vertexCount());
  for (std::size_t v = 0; v < keys.size(); ++v) keys[v] = heightKey(at(welded.positions, v), direction);
  const auto last = keys.begin() + static_cast<std::ptrdiff_t>(count - 1);
  std::nth_element(keys.begin(), last, keys.end());  // only the key is used, never the order the rest ends up in
  return *last;
}

std::size_t shareOf(double share, std::size_t count) {
  const double wanted = share * static_cast<double>(count) + 0.5;
  return wanted < 1 ? 0 : std::min(count, static_cast<std::size_t>(wanted));
}

}  // namespace quadmark::lab
