// SPDX-License-Identifier: MIT
// An irregular triangulation of a closed surface of the torus' kind, kept valid in its parameter square while vertices
// are moved and edges flipped. What makes generated models look like scans instead of grids.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/random.h"
#include "quadmark/vec3.h"

namespace quadmark::lab {

/// A place on the surface: both numbers have period 1.
struct SurfacePoint {
  double u = 0, v = 0;
};
using SurfaceFunction = std::function<Vec3(SurfacePoint)>;

class TorusSurface {
 public:
  /// A regular grid, shifted at random by up to a quarter of its spacing. @param columns, rows  >= 8, along u and v.
  TorusSurface(std::uint32_t columns, std::uint32_t rows, SurfaceFunction shape, Random& random);

  /// Flips edges towards Delaunay's condition in space; keeps valences within 4..8. Cost: linear per pass.
  void flipToDelaunay(int passes);

  /// Moves each vertex halfway to the area-weighted middle of its faces, then at random by up to `jitter` of the mean
  /// distance to its neighbours. Moves that would turn a face over in the parameter square are left out.
  void relax(double jitter, Random& random);

  /// Triangles turned as the parameter square is.
  [[nodiscard]] Mesh mesh() const;

 private:
  // Half-edge h runs from corner_[h] to corner_[next(h)]; three in a row are a triangle.
  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t previous(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  [[nodiscard]] double parameterArea(SurfacePoint a, SurfacePoint b, SurfacePoint c) const;
  [[nodiscard]] double foldCosine(std::uint32_t a, std::uint32_t b, std::uint32_t left, std::uint32_t right) const;
  [[nodiscard]] bool wantsFlip(std::uint32_t h) const;
  void flip(std::uint32_t h);
  template <class Visit>
  void forEachSpoke(std::uint32_t vertex, const Visit& visit) const;

  SurfaceFunction shape_;
  double columns_, rows_;
  std::vector<SurfacePoint> points_;
  std::vector<Vec3> places_;
  std::vector<std::uint32_t> corner_, twin_, outgoing_;
  std::vector<std::uint8_t> valence_;
};

}  // namespace quadmark::lab
