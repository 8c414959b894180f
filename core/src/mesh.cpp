// SPDX-License-Identifier: MIT
#include "quadmark/mesh.h"

#include <cmath>
#include <limits>

#include "concat.h"

namespace quadmark {
namespace {

Error badMesh(std::string message) {
  return Error{ErrorCode::badMesh, std::move(message)};
}

Status validatePositions(const Mesh& mesh) {
  if (mesh.positions.size() % 3 != 0) {
    return badMesh(concat("positions: ", mesh.positions.size(), " numbers are not a multiple of 3"));
  }
  if (mesh.vertexCount() > std::numeric_limits<std::uint32_t>::max()) {
    return badMesh("positions: more vertices than 32-bit indices can name");
  }
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!std::isfinite(mesh.positions[i])) {
      return badMesh(concat("vertex ", i / 3, ", component ", "xyz"[i % 3], " is not finite"));
    }
  }
  return okStatus();
}

Status validateOffsets(const Mesh& mesh) {
  if (mesh.faceOffsets.empty()) {
    if (mesh.faceVertices.size() % 3 == 0) return okStatus();
    return badMesh(concat("faces: ", mesh.faceVertices.size(), " corners are not a multiple of 3"));
  }
  if (mesh.faceOffsets.front() != 0) return badMesh("face 0 does not begin at corner 0");
  for (std::size_t face = 0; face + 1 < mesh.faceOffsets.size(); ++face) {
    const std::uint64_t begin = mesh.faceOffsets[face];
    const std::uint64_t end = mesh.faceOffsets[face + 1];
    if (end < begin + 3) return badMesh(concat("face ", face, " has fewer than 3 corners"));
  }
  if (mesh.faceOffsets.back() != mesh.faceVertices.size()) {
    return badMesh(concat("faces: the last offset is ", mesh.faceOffsets.back(), ", there are ",
                          mesh.faceVertices.size(), " corners"));
  }
  return okStatus();
}

}  // namespace

Status validate(const Mesh& mesh) {
  if (Status status = validatePositions(mesh); !status) return status;
  if (Status status = validateOffsets(mesh); !status) return status;
  const std::size_t vertexCount = mesh.vertexCount();
  for (std::size_t corner = 0; corner < mesh.faceVertices.size(); ++corner) {
    if (mesh.faceVertices[corner] >= vertexCount) {
      return badMesh(
          concat("corner ", corner, ": vertex ", mesh.faceVertices[corner], " of ", vertexCount, " vertices"));
    }
  }
  if (!mesh.groups.empty() && mesh.groups.size() != vertexCount) {
    return badMesh(concat("groups: ", mesh.groups.size(), " entries for ", vertexCount, " vertices"));
  }
  if (mesh.grids.size() > 250) return badMesh("grids: more than 250");
  if (!mesh.gridOf.empty() && mesh.gridOf.size() != vertexCount) {
    return badMesh(concat("grids: ", mesh.gridOf.size(), " entries for ", vertexCount, " vertices"));
  }
  for (std::size_t vertex = 0; vertex < mesh.gridOf.size(); ++vertex) {
    if (mesh.gridOf[vertex] <= mesh.grids.size()) continue;
    return badMesh(concat("vertex ", vertex, ": grid ", mesh.gridOf[vertex], " of ", mesh.grids.size()));
  }
  return okStatus();
}

double boundingDiagonal(const Mesh& mesh) {
  if (mesh.faceVertices.empty()) return 0;
  // Six plain variables: as arrays the compiler keeps them in memory, at three times the cost.
  const double* first = &mesh.positions[3 * std::size_t{mesh.faceVertices[0]}];
  double lowX = first[0], lowY = first[1], lowZ = first[2], highX = lowX, highY = lowY, highZ = lowZ;
  for (const std::uint32_t vertex : mesh.faceVertices) {
    const double* position = &mesh.positions[3 * std::size_t{vertex}];
    const double x = position[0], y = position[1], z = position[2];
    if (x < lowX) lowX = x;
    if (x > highX) highX = x;
    if (y < lowY) lowY = y;
    if (y > highY) highY = y;
    if (z < lowZ) lowZ = z;
    if (z > highZ) highZ = z;
  }
  const double extent[3] = {highX - lowX, highY - lowY, highZ - lowZ};
  double largest = 0;
  for (const double side : extent) {
    if (side > largest) largest = side;
  }
  // Squares of very small or very large extents would leave the range of a double, so the largest side becomes the unit
  // then. The usual range is left alone: a division would cost a rounding.
  const bool squaresAreSafe = largest > 1e-120 && largest < 1e120;
  if (largest == 0 || !std::isfinite(largest)) return largest;
  const double unit = squaresAreSafe ? 1 : largest;
  double sum = 0;
  for (const double side : extent) sum += (side / unit) * (side / unit);
  return unit * std::sqrt(sum);
}

double nearestOnGrid(const CoordinateGrid& grid, double x) {
  const double code = std::floor(x * grid.divisor + 0.5);
  return (code < grid.low ? grid.low : code > grid.high ? grid.high : code) / grid.divisor;
}

void roundToPrecision(Mesh& mesh) {
  const bool narrow = mesh.precision == Precision::float32;
  if (mesh.gridOf.empty() && !narrow) return;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    double& value = mesh.positions[i];
    if (const CoordinateGrid* grid = mesh.grid(i / 3)) {
      value = nearestOnGrid(*grid, value);
    } else if (narrow) {
      const double rounded = nearestFloat32(value);
      value = rounded;
    }
  }
}

}  // namespace quadmark
