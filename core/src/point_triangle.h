// SPDX-License-Identifier: MIT
// Squared distance from a point to a triangle, for the surface distances of metrics.h.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace quadmark::detail {

struct Point {
  double x = 0, y = 0, z = 0;
};
inline Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Point operator+(const Point& a, const Point& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Point operator*(double s, const Point& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline double dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double squared(const Point& a) {
  return dot(a, a);
}

/// @param positions  3 per vertex.
inline Point pointAt(const std::vector<double>& positions, std::size_t vertex) {
  const double* p = &positions[3 * vertex];
  return {p[0], p[1], p[2]};
}

inline double squaredToSegment(const Point& p, const Point& a, const Point& b) {
  const Point ab = b - a, ap = p - a;
  const double length = squared(ab);
  const double t = length > 0 ? std::min(1.0, std::max(0.0, dot(ap, ab) / length)) : 0;
  return squared(ap - t * ab);
}

/// The square of how far a point lies outside an edge of a triangle, in the triangle's plane; 0 inside.
/// @param beyond        the point's barycentric coordinate of the opposite corner, times the squared normal.
/// @param areaTimesEdge  the squared normal times the edge's squared length.
inline double squaredBeyond(double beyond, double areaTimesEdge) {
  return beyond < 0 ? beyond * beyond / areaTimesEdge : 0;
}

/// Where a point lies over a triangle.
struct OverTriangle {
  bool inside = false;  ///< the prism over it
  double squared = 0;   ///< distance: inside the squared one, elsewhere a number that is not above it
};
inline OverTriangle overTriangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a, ap = p - a;
  const Point normal = cross(ab, ac);
  const double area = squared(normal);
  if (!(area > 0)) return {};
  const double v = dot(cross(ap, ac), normal), w = dot(cross(ab, ap), normal);
  const double height = dot(ap, normal), least = height * height / area;
  if (v >= 0 && w >= 0 && v + w <= area) return {true, least};
  return {false, least + std::max({squaredBeyond(v, area * squared(ac)), squaredBeyond(w, area * squared(ab)),
                                   squaredBeyond(area - v - w, area * squared(c - b))})};
}

inline double squaredToSides(const Point& p, const Point& a, const Point& b, const Point& c) {
  return std::min({squaredToSegment(p, a, b), squaredToSegment(p, b, c), squaredToSegment(p, c, a)});
}

/// Degenerate triangles (segments, points) are handled as what they are.
/// @param enough  a distance that is at least this need not be exact: some number that is not below it comes back.
inline double squaredToTriangle(const Point& p, const Point& a, const Point& b, const Point& c, double enough = 1e300) {
  const OverTriangle over = overTriangle(p, a, b, c);
  return over.inside ? over.squared : over.squared >= enough ? enough : squaredToSides(p, a, b, c);
}

}  // namespace quadmark::detail
