// SPDX-License-Identifier: MIT
// Three doubles with the few operations that geometry here needs. Plain arithmetic in a fixed order, so that native
// and wasm builds round alike (Eigen's reductions do not promise an order).
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace quadmark {

struct Vec3 {
  double x = 0, y = 0, z = 0;

  Vec3& operator+=(const Vec3& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  friend Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
  friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
};

inline double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
/// The zero vector stays what it is.
inline Vec3 normalized(const Vec3& a) {
  const double l = length(a);
  return l > 0 ? (1 / l) * a : a;
}

inline Vec3 at(const std::vector<double>& positions, std::size_t vertex) {
  const double* p = &positions[3 * vertex];
  return {p[0], p[1], p[2]};
}
inline void put(std::vector<double>& positions, std::size_t vertex, const Vec3& p) {
  positions[3 * vertex] = p.x;
  positions[3 * vertex + 1] = p.y;
  positions[3 * vertex + 2] = p.z;
}
inline void append(std::vector<double>& positions, const Vec3& p) {
  for (double x : {p.x, p.y, p.z}) positions.push_back(x);
}

}  // namespace quadmark
