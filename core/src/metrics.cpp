// SPDX-License-Identifier: MIT
#include "quadmark/metrics.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "point_triangle.h"
#include "quadmark/adjacency.h"
#include "surface_distance.h"

namespace quadmark {
namespace {

using detail::Point;
using detail::pointAt;

std::vector<std::uint8_t> usedVertices(const Mesh& mesh) {
  std::vector<std::uint8_t> used(mesh.vertexCount(), 0);
  for (std::uint32_t v : mesh.faceVertices) used[v] = 1;
  return used;
}

struct NormalPair {
  Point before, after;
};

/// Area-weighted normals per welded vertex, not normalised. A polygon counts by its vector area (Newell), the same for
/// any choice of first corner.
std::vector<NormalPair> vertexNormals(const Mesh& mesh, const std::vector<double>& marked, const Welding& welding) {
  std::vector<NormalPair> normals(welding.count);
  const auto areaOf = [&](const std::vector<double>& positions, std::size_t begin, std::size_t end) {
    const Point first = pointAt(positions, mesh.faceVertices[begin]);
    Point area;
    for (std::size_t c = begin + 2; c < end; ++c)
      area = area + cross(pointAt(positions, mesh.faceVertices[c - 1]) - first,
                          pointAt(positions, mesh.faceVertices[c]) - first);
    return area;
  };
  const std::size_t faces = mesh.faceCount();
  for (std::size_t f = 0; f < faces; ++f) {
    const std::size_t begin = mesh.faceBegin(f), end = mesh.faceEnd(f);
    if (end - begin < 3) continue;
    const Point before = areaOf(mesh.positions, begin, end), after = areaOf(marked, begin, end);
    for (std::size_t c = begin; c < end; ++c) {
      NormalPair& normal = normals[welding.weldedOf[mesh.faceVertices[c]]];
      normal.before = normal.before + before;
      normal.after = normal.after + after;
    }
  }
  return normals;
}

void measureDisplacement(const Mesh& original, const std::vector<double>& marked, double diagonal, Distortion& out) {
  const std::vector<std::uint8_t> used = usedVertices(original);
  double count = 0, signal = 0, noise = 0, largest = 0;
  Point sum;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    sum = sum + pointAt(original.positions, v);
    count += 1;
  }
  out.snrDb = std::numeric_limits<double>::infinity();
  if (count == 0) return;
  const Point mean = (1 / count) * sum;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    const Point p = pointAt(original.positions, v);
    const double moved = squared(pointAt(marked, v) - p);
    signal += squared(p - mean);
    noise += moved;
    largest = std::max(largest, moved);
  }
  if (noise > 0) out.snrDb = 10 * std::log10(signal / noise);
  if (diagonal > 0) {
    out.rmsRel = std::sqrt(noise / count) / diagonal;
    out.maxRel = std::sqrt(largest) / diagonal;
  }
}

void measureNormals(const Mesh& original, const std::vector<double>& marked, const Welding& welding,
                    Distortion& out) {
  constexpr double kPi = 3.14159265358979323846;
  const std::vector<NormalPair> normals = vertexNormals(original, marked, welding);
  double count = 0, squares = 0, sum = 0;
  for (const auto& [before, after] : normals) {
    if (!(squared(before) > 0) || !(squared(after) > 0)) continue;
    // atan2 of sine and cosine is exact for the tiny angles met here, where acos is not.
    count += 1;
    if (before.x == after.x && before.y == after.y && before.z == after.z) continue;
    const double angle = std::atan2(std::sqrt(squared(cross(before, after))), dot(before, after));
    squares += angle * angle;
    sum += angle;
  }
  const double rms = count > 0 ? std::sqrt(squares / count) : 0;
  out.normalPsnrDb = rms > 0 ? 20 * std::log10(kPi / rms) : std::numeric_limits<double>::infinity();
  out.meanNormalDeg = count > 0 ? sum / count * 180 / kPi : 0;
}

}  // namespace

Distortion distortion(const Mesh& original, const Mesh& marked) {
  return distortion(original, marked.positions, weldVertices(original).takeWelding(), boundingDiagonal(original));
}

Distortion distortion(const Mesh& original, const std::vector<double>& marked, const Welding& welding,
                      double diagonal) {
  assert(original.positions.size() == marked.size());
  Distortion out;
  measureDisplacement(original, marked, diagonal, out);
  measureNormals(original, marked, welding, out);
  if (diagonal > 0) out.hausdorffRel = detail::hausdorffLocal(original, marked, welding) / diagonal;
  return out;
}

double bitErrorRate(std::span<const std::uint8_t> expected, std::span<const std::uint8_t> read,
                    std::span<const std::uint8_t> erased) {
  assert(expected.size() == read.size() && (erased.empty() || erased.size() == read.size()));
  if (expected.empty()) return 0;
  std::size_t halves = 0;  // in half errors, so that the sum stays exact
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!erased.empty() && erased[i] != 0)
      halves += 1;
    else if ((expected[i] != 0) != (read[i] != 0))
      halves += 2;
  }
  return 0.5 * static_cast<double>(halves) / static_cast<double>(expected.size());
}

}  // namespace quadmark
