// SPDX-License-Identifier: MIT
// Builds a mesh's face list from polygons and triangle strips as they stream out of a file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quadmark/mesh.h"

namespace quadmark::io {

/// Appends faces to a mesh. Stays with the compact all-triangle form until the first other polygon arrives.
/// The caller has checked every vertex index.
class FaceCollector {
 public:
  explicit FaceCollector(Mesh& mesh) : mesh_(mesh), open_(mesh.faceVertices.size()) {}

  /// Makes room for that many further corners, with geometric growth over many small calls.
  void reserve(std::size_t corners);

  void addCorner(std::uint32_t vertex) { mesh_.faceVertices.push_back(vertex); }

  /// Ends a polygon whose corners were added one by one. Polygons below 3 corners are dropped and counted.
  void endPolygon();

  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.faceVertices.insert(mesh_.faceVertices.end(), {a, b, c});
    endPolygon();
  }

  /// Triangle strips: vertex by vertex; degenerate triangles (stitches) are left out, winding alternates.
  void stripVertex(std::uint32_t vertex);
  void restartStrip() { stripLength_ = 0; }

  /// True when 32-bit corner offsets no longer suffice.
  [[nodiscard]] bool overflows() const { return mesh_.faceVertices.size() > kLargestCornerCount; }
  [[nodiscard]] std::uint64_t droppedPolygons() const { return dropped_; }

  static constexpr std::uint64_t kLargestCornerCount = 0xffffffff;

 private:
  Mesh& mesh_;
  std::size_t open_;  // first corner of the polygon under construction
  std::uint64_t dropped_ = 0;
  std::uint64_t stripLength_ = 0;
  std::uint32_t previous_[2] = {0, 0};
};

}  // namespace quadmark::io
