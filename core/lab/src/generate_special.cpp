// SPDX-License-Identifier: MIT
// Fixtures that stress connectivity: mixed polygons, non-manifold places, several components, seams.
#include <algorithm>

#include "noise_field.h"
#include "quadmark/lab/generate.h"
#include "quadmark/random.h"

namespace quadmark::lab {
namespace {

Mesh bumpySphere(int subdivisions, std::uint64_t seed) {
  Mesh mesh = icosphere(subdivisions);
  mesh.positions = roughened(mesh.positions, 0.15, 0.4, seed);
  mesh.positions = roughened(mesh.positions, 0.02, 0.07, seed + 1);
  roundToPrecision(mesh);
  return mesh;
}

void addMesh(Mesh& mesh, const Mesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertexCount());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (std::uint32_t v : other.faceVertices) mesh.faceVertices.push_back(base + v);
}

void addFace(Mesh& mesh, std::initializer_list<std::uint32_t> face) {
  mesh.faceVertices.insert(mesh.faceVertices.end(), face);
  mesh.faceOffsets.push_back(static_cast<std::uint32_t>(mesh.faceVertices.size()));
}

/// The faces around each vertex of a closed triangle mesh, each list in turning order.
std::vector<std::vector<std::uint32_t>> orderedRings(const Mesh& mesh) {
  // (face, next corner's vertex, previous corner's vertex) as seen from each vertex
  struct Spoke {
    std::uint32_t face, next, previous;
  };
  std::vector<std::vector<Spoke>> spokes(mesh.vertexCount());
  for (std::size_t c = 0; c < mesh.faceVertices.size(); ++c) {
    const std::size_t f = c / 3;
    spokes[mesh.faceVertices[c]].push_back({static_cast<std::uint32_t>(f), mesh.faceVertices[3 * f + (c + 1) % 3],
                                            mesh.faceVertices[3 * f + (c + 2) % 3]});
  }
  std::vector<std::vector<std::uint32_t>> rings(mesh.vertexCount());
  for (std::size_t v = 0; v < spokes.size(); ++v) {
    std::size_t current = 0;
    for (std::size_t i = 0; i < spokes[v].size(); ++i) {
      rings[v].push_back(spokes[v][current].face);
      for (std::size_t j = 0; j < spokes[v].size(); ++j)
        if (spokes[v][j].next == spokes[v][current].previous) {
          current = j;
          break;
        }
    }
  }
  return rings;
}

}  // namespace

Mesh polygonMix(std::uint64_t seed) {
  // The dual of a geodesic sphere: 12 pentagons, the rest hexagons. Some hexagons are cut in different ways.
  const Mesh sphere = icosphere(3);
  Mesh mesh;
  for (std::size_t f = 0; f < sphere.faceCount(); ++f) {
    Vec3 sum;
    for (std::size_t i = 0; i < 3; ++i) sum += at(sphere.positions, sphere.faceVertices[3 * f + i]);
    append(mesh.positions, normalized(sum));
  }
  mesh.positions = roughened(mesh.positions, 0.15, 0.4, seed);
  mesh.positions = roughened(mesh.positions, 0.03, 0.05, seed + 1);
  mesh.faceOffsets.push_back(0);
  Random random(seed);
  for (const std::vector<std::uint32_t>& ring : orderedRings(sphere)) {
    const auto first = random.below(static_cast<std::uint32_t>(ring.size()));
    const auto r = [&](std::uint32_t i) { return ring[(first + i) % ring.size()]; };
    if (ring.size() == 5) {
      addFace(mesh, {r(0), r(1), r(2), r(3), r(4)});
      continue;
    }
    switch (random.below(4)) {
      case 0:
        addFace(mesh, {r(0), r(1), r(2), r(3), r(4), r(5)});
        break;
      case 1:
        addFace(mesh, {r(0), r(1), r(2), r(3)});
        addFace(mesh, {r(3), r(4), r(5), r(0)});
        break;
      case 2:
        addFace(mesh, {r(0), r(1), r(2), r(3), r(4)});
        addFace(mesh, {r(4), r(5), r(0)});
        break;
      default:
        addFace(mesh, {r(0), r(2), r(4)});
        addFace(mesh, {r(0), r(1), r(2)});
        addFace(mesh, {r(2), r(3), r(4)});
        addFace(mesh, {r(4), r(5), r(0)});
    }
  }
  roundToPrecision(mesh);
  return mesh;
}

Mesh nonManifold() {
  // Three pages bound along one spine, so that each spine edge has three faces ...
  constexpr std::uint32_t kRows = 12, kColumns = 10;
  Mesh mesh;
  for (std::uint32_t row = 0; row < kRows; ++row) append(mesh.positions, {0, 0, 0.1 * row});
  constexpr double kPages[3][2] = {{1, 0}, {-0.5, 0.875}, {-0.5, -0.875}};
  for (const auto& page : kPages) {
    const auto base = static_cast<std::uint32_t>(mesh.vertexCount());
    for (std::uint32_t column = 1; column < kColumns; ++column)
      for (std::uint32_t row = 0; row < kRows; ++row)
        append(mesh.positions, {0.1 * column * page[0], 0.1 * column * page[1], 0.1 * row});
    const auto vertex = [&](std::uint32_t column, std::uint32_t row) {
      return column == 0 ? row : base + (column - 1) * kRows + row;
    };
    for (std::uint32_t column = 0; column + 1 < kColumns; ++column)
      for (std::uint32_t row = 0; row + 1 < kRows; ++row) {
        const std::uint32_t a = vertex(column, row), b = vertex(column + 1, row), c = vertex(column + 1, row + 1),
                            d = vertex(column, row + 1);
        mesh.faceVertices.insert(mesh.faceVertices.end(), {a, b, c, a, c, d});
      }
  }
  // ... and a cone that touches the top of the spine with its tip alone: a bow-tie vertex.
  const std::uint32_t tip = kRows - 1, rim = static_cast<std::uint32_t>(mesh.vertexCount());
  constexpr double kCircle[8][2] = {{1, 0},  {0.7, 0.7},   {0, 1},  {-0.7, 0.7},
                                    {-1, 0}, {-0.7, -0.7}, {0, -1}, {0.7, -0.7}};
  for (const auto& p : kCircle) append(mesh.positions, {0.2 * p[0], 0.2 * p[1], 1.1 + 0.3});
  for (std::uint32_t i = 0; i < 8; ++i)
    mesh.faceVertices.insert(mesh.faceVertices.end(), {tip, rim + i, rim + (i + 1) % 8});
  mesh.positions = roughened(mesh.positions, 0.03, 0.12, 3);
  roundToPrecision(mesh);
  return mesh;
}

Mesh twoComponents(std::uint64_t seed) {
  Mesh mesh = bumpySphere(3, seed);
  Mesh other = bumpySphere(3, seed + 1000);
  for (std::size_t v = 0; v < other.vertexCount(); ++v)
    put(other.positions, v, 0.6 * at(other.positions, v) + Vec3{2.5, 0.3, -0.2});
  addMesh(mesh, other);
  roundToPrecision(mesh);
  return mesh;
}

Mesh seamed(std::uint64_t seed) {
  Mesh mesh = bumpySphere(3, seed);
  // Faces on the far side of x = 0 get copies of the vertices they share with the near side, as texture seams do.
  const auto farSide = [&](std::size_t f) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += mesh.positions[3 * std::size_t{mesh.faceVertices[3 * f + i]}];
    return sum > 0;
  };
  std::vector<std::uint8_t> isFar(mesh.faceCount()), near(mesh.vertexCount(), 0);
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    isFar[f] = farSide(f);
    for (std::size_t i = 0; i < 3; ++i)
      if (!isFar[f]) near[mesh.faceVertices[3 * f + i]] = 1;
  }
  std::vector<std::uint32_t> copyOf(near.size(), 0);  // 0: none yet; the first vertex is never a copy
  for (std::size_t c = 0; c < mesh.faceVertices.size(); ++c) {
    std::uint32_t& v = mesh.faceVertices[c];
    if (!isFar[c / 3] || !near[v]) continue;
    if (copyOf[v] == 0) {
      copyOf[v] = static_cast<std::uint32_t>(mesh.vertexCount());
      append(mesh.positions, at(mesh.positions, v));
    }
    v = copyOf[v];
  }
  return mesh;
}

}  // namespace quadmark::lab
