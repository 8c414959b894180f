// SPDX-License-Identifier: MIT
#include <numeric>

#include "quadmark/lab/attacks.h"
#include "quadmark/random.h"
#include "quadmark/vec3.h"

namespace quadmark::lab {

Mesh reorder(const Mesh& mesh, std::uint64_t seed, VertexOrigin* origin) {
  Random random(seed);
  std::vector<std::uint32_t> vertexOrder(mesh.vertexCount()), faceOrder(mesh.faceCount());
  std::iota(vertexOrder.begin(), vertexOrder.end(), 0u);
  std::iota(faceOrder.begin(), faceOrder.end(), 0u);
  shuffle(vertexOrder, random);
  shuffle(faceOrder, random);

  Mesh out;
  out.precision = mesh.precision;
  out.positions.reserve(mesh.positions.size());
  out.groups.reserve(mesh.groups.size());
  std::vector<std::uint32_t> numberOf(mesh.vertexCount());
  for (std::uint32_t v : vertexOrder) {
    numberOf[v] = static_cast<std::uint32_t>(out.vertexCount());
    append(out.positions, at(mesh.positions, v));
    if (!mesh.groups.empty()) out.groups.push_back(mesh.groups[v]);
  }
  out.faceVertices.reserve(mesh.faceVertices.size());
  if (!mesh.faceOffsets.empty()) out.faceOffsets.push_back(0);
  for (std::uint32_t f : faceOrder) {
    const std::size_t begin = mesh.faceBegin(f), corners = mesh.faceEnd(f) - begin;
    const std::size_t first = corners == 0 ? 0 : random.below(static_cast<std::uint32_t>(corners));
    for (std::size_t i = 0; i < corners; ++i)
      out.faceVertices.push_back(numberOf[mesh.faceVertices[begin + (first + i) % corners]]);
    if (!mesh.faceOffsets.empty()) out.faceOffsets.push_back(static_cast<std::uint32_t>(out.faceVertices.size()));
  }
  if (origin) *origin = std::move(vertexOrder);
  return out;
}

}  // namespace quadmark::lab
