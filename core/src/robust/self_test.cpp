// SPDX-License-Identifier: MIT
#include "quadmark/robust/self_test.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "quadmark/adjacency.h"
#include "quadmark/random.h"
#include "quadmark/robust/mark.h"
#include "quadmark/robust/mesh_source.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

struct Box {
  double low[3] = {0, 0, 0};
  double extent = 0;  ///< the largest side
};

Box boxOf(const Mesh& mesh) {
  Box box;
  for (int k = 0; k < 3; ++k) {
    double low = 0, high = 0;
    bool first = true;
    for (const std::uint32_t v : mesh.faceVertices) {
      const double x = mesh.positions[3 * std::size_t{v} + k];
      low = first || x < low ? x : low;
      high = first || x > high ? x : high;
      first = false;
    }
    box.low[k] = low;
    box.extent = std::max(box.extent, high - low);
  }
  return box;
}

Mesh quantized(Mesh mesh, int bits) {
  const Box box = boxOf(mesh);
  const double step = box.extent / ((1 << bits) - 1);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const double low = box.low[i % 3];
    mesh.positions[i] = low + step * std::floor((mesh.positions[i] - low) / step + 0.5);
  }
  roundToPrecision(mesh);
  return mesh;
}

// Twins must move together: noise is drawn per welded vertex.
Mesh shaken(Mesh mesh, double deviation) {
  const WeldedMesh welded = weld(mesh);
  const double amplitude = deviation * boundingDiagonal(mesh);
  Random random(1);
  std::vector<double> offset(3 * std::size_t{welded.vertexCount()});
  for (double& value : offset) {
    double sum = -6;  // twelve uniform numbers are Gaussian enough
    for (int i = 0; i < 12; ++i) sum += random.uniform();
    value = amplitude * sum;
  }
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    if (welded.weldedOf[v] != kNoVertex)
      for (std::size_t k = 0; k < 3; ++k) mesh.positions[3 * v + k] += offset[3 * std::size_t{welded.weldedOf[v]} + k];
  roundToPrecision(mesh);
  return mesh;
}

// Half-edge collapses of the shortest edges, no two of them next to each other.
Mesh collapsed(Mesh mesh, double share) {
  const WeldedMesh welded = weld(mesh);
  struct Edge {
    double squared;
    std::uint32_t from, to;
  };
  std::vector<Edge> edges;
  for (std::uint32_t v = 0; v < welded.vertexCount(); ++v)
    for (const std::uint32_t w : welded.neighboursOf(v)) {
      double squared = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double d = welded.positions[3 * std::size_t{v} + k] - welded.positions[3 * std::size_t{w} + k];
        squared += d * d;
      }
      if (v < w) edges.push_back({squared, v, w});
    }
  sortCompactly(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::pair(a.squared, std::pair(a.from, a.to)) < std::pair(b.squared, std::pair(b.from, b.to));
  });
  std::vector<std::uint8_t> touched(welded.vertexCount(), 0);
  auto left = static_cast<std::size_t>(share * welded.vertexCount());
  std::vector<std::uint32_t> goesTo(welded.vertexCount(), kNoVertex);
  for (const Edge& e : edges) {
    if (left == 0) break;
    if (touched[e.from] != 0 || touched[e.to] != 0) continue;
    goesTo[e.from] = e.to;
    for (const std::uint32_t end : {e.from, e.to})
      for (const std::uint32_t w : welded.neighboursOf(end)) touched[w] = 1;
    --left;
  }
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const std::uint32_t w = welded.weldedOf[v];
    if (w == kNoVertex || goesTo[w] == kNoVertex) continue;
    for (std::size_t k = 0; k < 3; ++k) mesh.positions[3 * v + k] = welded.positions[3 * std::size_t{goesTo[w]} + k];
  }
  return mesh;  // corners that coincide now are one vertex to every reader
}

// The faces whose first corner lies in the lower half along the longest side.
Mesh halved(const Mesh& mesh) {
  const Box box = boxOf(mesh);
  std::vector<std::pair<double, std::size_t>> order;
  int axis = 0;
  double widest = -1;
  for (int k = 0; k < 3; ++k) {
    double high = box.low[k];
    for (const std::uint32_t v : mesh.faceVertices) high = std::max(high, mesh.positions[3 * std::size_t{v} + k]);
    if (high - box.low[k] > widest) {
      widest = high - box.low[k];
      axis = k;
    }
  }
  for (std::size_t f = 0; f < mesh.faceCount(); ++f)
    order.emplace_back(mesh.positions[3 * std::size_t{mesh.faceVertices[mesh.faceBegin(f)]} + axis], f);
  sortCompactly(order.begin(), order.end());
  order.resize((order.size() + 1) / 2);
  Mesh out = mesh;
  out.faceVertices.clear();
  out.faceOffsets.assign(mesh.faceOffsets.empty() ? 0 : 1, 0);
  for (const auto& [position, f] : order) {
    for (std::size_t c = mesh.faceBegin(f); c < mesh.faceEnd(f); ++c) out.faceVertices.push_back(mesh.faceVertices[c]);
    if (!mesh.faceOffsets.empty()) out.faceOffsets.push_back(static_cast<std::uint32_t>(out.faceVertices.size()));
  }
  return out;
}

}  // namespace

SelfTest readBack(const Mesh& mesh, const PayloadBits& payload, const SchemeKeys& keys, std::shared_ptr<Ground> ground) {
  MeshReader reader(mesh, keys.geometry, headCode(), std::move(ground));
  MeshSource source(reader);
  const auto reading = readMark(source, {keys});
  SelfTest out;
  out.falsePositive = reading->falsePositive;
  out.read = reading->verdict == Verdict::match && reading->frame == payload.frame &&
             (payload.body.empty() || (reading->body && reading->body->exact));
  return out;
}

std::vector<SelfTest> selfTest(const Mesh& marked, const PayloadBits& payload, const SchemeKeys& keys) {
  std::vector<SelfTest> tests;
  const auto run = [&](const char* name, const Mesh& damaged) {
    tests.push_back(readBack(damaged, payload, keys));
    tests.back().name = name;
  };
  run("quantize14", quantized(marked, 14));
  run("quantize11", quantized(marked, 11));
  run("noise3e-4", shaken(marked, 3e-4));
  run("collapse10", collapsed(marked, 0.1));
  run("collapse10quantize14", quantized(collapsed(marked, 0.1), 14));
  run("crop50", halved(marked));
  return tests;
}

}  // namespace quadmark::robust
