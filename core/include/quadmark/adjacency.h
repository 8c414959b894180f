// SPDX-License-Identifier: MIT
// Welded vertices and their undirected neighbours: the view of a mesh on which neighbourhoods are built (D1, D2).
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "quadmark/mesh.h"

namespace quadmark {

/// No welded vertex: the mark of a vertex that no face refers to.
inline constexpr std::uint32_t kNoVertex = 0xffffffffu;

/// Entry of WeldedMesh::gridOf: no other position than the present one can be stored for all twins alike.
inline constexpr std::uint8_t kFixed = 255;

/// Which vertices are one: those with bit-equal positions (-0 counts as +0) inside one seam group.
struct Welding {
  std::vector<std::uint32_t> weldedOf;  ///< welded vertex per mesh vertex, or kNoVertex where no face refers to it
  std::uint32_t count = 0;              ///< welded vertices
};

/// Welded vertices, numbered in the order of their first appearance in the vertex array, and their neighbours.
struct WeldedMesh {
  std::vector<double> positions;             ///< 3 per welded vertex, file units
  std::vector<std::uint32_t> weldedOf;       ///< as in Welding
  std::vector<std::uint32_t> edgeOffsets;    ///< welded vertices + 1: where each one's neighbours begin
  std::vector<std::uint32_t> neighbours;     ///< unique, ascending per vertex, never the vertex itself
  std::vector<std::uint8_t> gridOf;          ///< as Mesh::gridOf, or kFixed; empty if no vertex has a grid
  std::vector<double> halfStep;              ///< of the coarsest grid of the twins, 0 without one; empty with gridOf

  [[nodiscard]] std::uint32_t vertexCount() const {
    return static_cast<std::uint32_t>(positions.size() / 3);
  }
  /// Takes `weldedOf` away.
  [[nodiscard]] Welding takeWelding() { return {std::move(weldedOf), vertexCount()}; }
  [[nodiscard]] std::span<const std::uint32_t> neighboursOf(std::uint32_t vertex) const {
    return {neighbours.data() + edgeOffsets[vertex], edgeOffsets[vertex + 1] - edgeOffsets[vertex]};
  }
};

/// Welds and collects unique undirected edges. Polygons contribute their boundary edges only. Accepts any
/// connectivity; degenerate faces add whatever distinct edges they have.
/// @param mesh  must validate().
/// Deterministic. Cost: linear, about 0.2 microseconds and at most 110 bytes per vertex while it runs.
[[nodiscard]] WeldedMesh weld(const Mesh& mesh);

/// The same without edges and grids.
[[nodiscard]] WeldedMesh weldVertices(const Mesh& mesh);

/// The connected component of each vertex, numbered in the order of their lowest vertices.
/// @param count  gets their number.
[[nodiscard]] std::vector<std::uint32_t> components(const WeldedMesh& welded, std::uint32_t& count);

/// The part of a mesh that some vertices make up, in their order; without weldedOf and gridOf.
[[nodiscard]] WeldedMesh subMesh(const WeldedMesh& welded, const std::vector<std::uint32_t>& vertices);

/// Welds twins that quantization has moved apart: vertices without an edge between them that are nearer than 5e-4 of the
/// bounding-box diagonal and than a quarter of every edge at either of them. The first by position stands for a
/// cluster, so the outcome does not depend on numbers. Seam groups are ignored.
/// @param origin  gets, for each vertex of the result, the vertex that stands for it. Without weldedOf and gridOf.
/// Cost: about 2 microseconds per vertex.
[[nodiscard]] WeldedMesh closeSeams(const WeldedMesh& welded, std::vector<std::uint32_t>& origin);

/// Do any two of these positions coincide within one group?
/// @param positions  3 per vertex.
/// @param groups     per vertex, or empty.
[[nodiscard]] bool hasTwins(const std::vector<double>& positions, const std::vector<std::uint32_t>& groups);

/// Faces around each welded vertex, for flip checks: corner lists in face order, duplicates removed.
struct FaceRings {
  std::vector<std::uint32_t> offsets;  ///< welded vertices + 1
  std::vector<std::uint32_t> faces;
  [[nodiscard]] std::span<const std::uint32_t> facesOf(std::uint32_t vertex) const {
    return {faces.data() + offsets[vertex], offsets[vertex + 1] - offsets[vertex]};
  }
};
[[nodiscard]] FaceRings faceRings(const Mesh& mesh, const std::vector<std::uint32_t>& weldedOf, std::uint32_t count);
[[nodiscard]] inline FaceRings faceRings(const Mesh& mesh, const WeldedMesh& welded) {
  return faceRings(mesh, welded.weldedOf, welded.vertexCount());
}

/// Neighbourhoods of more vertices than this are not built for k > 1 (a hub with a million spokes would cost a million
/// squared).
inline constexpr std::size_t kMaxNeighbourhood = 4096;

/// N^k(v) of the paper's Eq. (1): v and everything within k edges of it, v first, then ring by ring.
/// @param out  cleared first.
/// @return false, with `out` incomplete, when k > 1 and the neighbourhood exceeds kMaxNeighbourhood.
[[nodiscard]] bool neighbourhood(const WeldedMesh& welded, std::uint32_t vertex, int k, std::vector<std::uint32_t>& out);

}  // namespace quadmark
