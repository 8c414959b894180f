// SPDX-License-Identifier: MIT
// Fixtures of one surface each: cube, spheres, grids and a fan.
#include <utility>

#include "noise_field.h"
#include "quadmark/lab/generate.h"
#include "quadmark/random.h"
#include "quadmark/trig.h"

namespace quadmark::lab {
namespace {

/// New vertices at edge middles, one per edge whichever side asks first. Open addressing over (low end, high end).
class EdgeMiddles {
 public:
  EdgeMiddles(std::size_t edges, std::vector<double>& positions) : positions_(positions) {
    std::size_t capacity = 16;
    while (capacity < 2 * edges) capacity *= 2;
    slots_.resize(capacity);
  }
  std::uint32_t of(std::uint32_t a, std::uint32_t b) {
    const std::uint64_t edge = (std::uint64_t{a < b ? a : b} << 32) | (a < b ? b : a);
    std::size_t slot = Random::mix(edge) & (slots_.size() - 1);
    while (slots_[slot].used && slots_[slot].edge != edge) slot = (slot + 1) & (slots_.size() - 1);
    if (!slots_[slot].used) {
      slots_[slot] = {edge, static_cast<std::uint32_t>(positions_.size() / 3), true};
      append(positions_, normalized(at(positions_, a) + at(positions_, b)));
    }
    return slots_[slot].vertex;
  }

 private:
  struct Slot {
    std::uint64_t edge = 0;
    std::uint32_t vertex = 0;
    bool used = false;
  };
  std::vector<Slot> slots_;
  std::vector<double>& positions_;
};

void addGridTriangles(Mesh& mesh, int columns, int rows) {
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      const auto a = static_cast<std::uint32_t>(row * columns + column);
      const std::uint32_t b = a + 1, d = a + static_cast<std::uint32_t>(columns), c = d + 1;
      mesh.faceVertices.insert(mesh.faceVertices.end(), {a, b, c, a, c, d});
    }
}

}  // namespace

Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) append(mesh.positions, {i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  mesh.faceVertices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return mesh;
}

Mesh quadSphere(int subdivisions) {
  const int n = 1 << subdivisions;
  const auto side = static_cast<std::size_t>(n + 1);
  // The surface points of an (n + 1)^3 lattice, numbered in lattice order.
  std::vector<std::uint32_t> numberOf(side * side * side, 0);
  Mesh mesh;
  const auto lattice = [&](int i, int j, int k) {
    return (static_cast<std::size_t>(k) * side + static_cast<std::size_t>(j)) * side + static_cast<std::size_t>(i);
  };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        if (i > 0 && i < n && j > 0 && j < n && k > 0 && k < n) continue;
        numberOf[lattice(i, j, k)] = static_cast<std::uint32_t>(mesh.vertexCount());
        const double half = 0.5 * n;
        append(mesh.positions, normalized({i / half - 1, j / half - 1, k / half - 1}));
      }
  mesh.faceOffsets.push_back(0);
  const auto quad = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    mesh.faceVertices.insert(mesh.faceVertices.end(), {numberOf[a], numberOf[b], numberOf[c], numberOf[d]});
    mesh.faceOffsets.push_back(static_cast<std::uint32_t>(mesh.faceVertices.size()));
  };
  for (int v = 0; v < n; ++v)
    for (int u = 0; u < n; ++u) {
      quad(lattice(u, v, 0), lattice(u, v + 1, 0), lattice(u + 1, v + 1, 0), lattice(u + 1, v, 0));
      quad(lattice(u, v, n), lattice(u + 1, v, n), lattice(u + 1, v + 1, n), lattice(u, v + 1, n));
      quad(lattice(u, 0, v), lattice(u + 1, 0, v), lattice(u + 1, 0, v + 1), lattice(u, 0, v + 1));
      quad(lattice(u, n, v), lattice(u, n, v + 1), lattice(u + 1, n, v + 1), lattice(u + 1, n, v));
      quad(lattice(0, u, v), lattice(0, u, v + 1), lattice(0, u + 1, v + 1), lattice(0, u + 1, v));
      quad(lattice(n, u, v), lattice(n, u + 1, v), lattice(n, u + 1, v + 1), lattice(n, u, v + 1));
    }
  roundToPrecision(mesh);
  return mesh;
}

Mesh icosphere(int subdivisions) {
  constexpr double kGolden = 1.61803398874989484820;
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (double one : {-1.0, 1.0})
      for (double golden : {-kGolden, kGolden}) {
        const double p[3] = {0, one, golden};
        const int x = (3 - axis) % 3;
        append(mesh.positions, normalized({p[x], p[(x + 1) % 3], p[(x + 2) % 3]}));
      }
  // Faces: all triples at edge distance, turned outwards.
  const double edgeSquare = 4 / (1 + kGolden * kGolden) * 1.01;
  const auto near = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 d = at(mesh.positions, a) - at(mesh.positions, b);
    return dot(d, d) < edgeSquare;
  };
  for (std::uint32_t a = 0; a < 12; ++a)
    for (std::uint32_t b = a + 1; b < 12; ++b)
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
        const bool outwards = dot(cross(at(mesh.positions, a), at(mesh.positions, b)), at(mesh.positions, c)) > 0;
        mesh.faceVertices.insert(mesh.faceVertices.end(), {a, outwards ? b : c, outwards ? c : b});
      }
  for (int level = 0; level < subdivisions; ++level) {
    EdgeMiddles middles(mesh.faceVertices.size() / 2, mesh.positions);
    std::vector<std::uint32_t> finer;
    finer.reserve(4 * mesh.faceVertices.size());
    for (std::size_t f = 0; f < mesh.faceVertices.size(); f += 3) {
      const std::uint32_t a = mesh.faceVertices[f], b = mesh.faceVertices[f + 1], c = mesh.faceVertices[f + 2];
      const std::uint32_t ab = middles.of(a, b), bc = middles.of(b, c), ca = middles.of(c, a);
      finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    mesh.faceVertices.swap(finer);
  }
  roundToPrecision(mesh);
  return mesh;
}

Mesh bumpyGrid(int columns, int rows, std::uint64_t seed) {
  Mesh mesh = flatGrid(columns, rows);
  Random random(seed);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    put(mesh.positions, v,
        at(mesh.positions, v) +
            Vec3{random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25), random.uniform(-0.5, 0.5)});
  roundToPrecision(mesh);
  return mesh;
}

Mesh flatGrid(int columns, int rows) {
  Mesh mesh;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      append(mesh.positions, {static_cast<double>(column), static_cast<double>(row), 0});
  addGridTriangles(mesh, columns, rows);
  return mesh;
}

Mesh fan(int spokes) {
  Mesh mesh;
  append(mesh.positions, {0, 0, 0.3});
  Random random(7);
  for (int i = 0; i < spokes; ++i) {
    const SinCos angle = sinCosTurns((i + 0.4 * random.uniform()) / spokes);
    const double radius = random.uniform(0.8, 1.2);
    append(mesh.positions, {radius * angle.cos, radius * angle.sin, random.uniform(-0.1, 0.1)});
    const auto next = static_cast<std::uint32_t>((i + 1) % spokes + 1);
    mesh.faceVertices.insert(mesh.faceVertices.end(), {0u, static_cast<std::uint32_t>(i + 1), next});
  }
  roundToPrecision(mesh);
  return mesh;
}

}  // namespace quadmark::lab
