// SPDX-License-Identifier: MIT
#include "face_collector.h"

#include <algorithm>

namespace quadmark::io {

void FaceCollector::reserve(std::size_t corners) {
  const std::size_t needed = mesh_.faceVertices.size() + corners;
  if (needed <= mesh_.faceVertices.capacity()) return;
  const std::size_t grown = mesh_.faceVertices.capacity() + mesh_.faceVertices.capacity() / 2;
  mesh_.faceVertices.reserve(std::max(needed, grown));
}

void FaceCollector::endPolygon() {
  const std::size_t end = mesh_.faceVertices.size();
  const std::size_t corners = end - open_;
  if (corners < 3) {
    mesh_.faceVertices.resize(open_);
    ++dropped_;
    return;
  }
  if (mesh_.faceOffsets.empty() && corners != 3) {
    mesh_.faceOffsets.reserve(open_ / 3 + 2);
    for (std::size_t begin = 0; begin <= open_; begin += 3) {
      mesh_.faceOffsets.push_back(static_cast<std::uint32_t>(begin));
    }
  }
  if (!mesh_.faceOffsets.empty()) mesh_.faceOffsets.push_back(static_cast<std::uint32_t>(end));
  open_ = end;
}

void FaceCollector::stripVertex(std::uint32_t vertex) {
  const std::uint32_t a = previous_[0], b = previous_[1];
  if (stripLength_ >= 2 && a != b && b != vertex && a != vertex) {
    const bool odd = stripLength_ % 2 != 0;
    addTriangle(odd ? b : a, odd ? a : b, vertex);
  }
  previous_[0] = b;
  previous_[1] = vertex;
  ++stripLength_;
}

}  // namespace quadmark::io
