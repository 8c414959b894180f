// SPDX-License-Identifier: MIT
#include "quadmark/quad.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadmark {
namespace {

// Plain arrays of double: in wasm they are about twice as fast as small Eigen vectors and round alike everywhere.
struct Vec {
  double x, y, z;
};
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec at(const double* p) { return {p[0], p[1], p[2]}; }

bool before(const double* p, const double* q) {
  if (p[0] != q[0]) return p[0] < q[0];
  if (p[1] != q[1]) return p[1] < q[1];
  return p[2] < q[2];
}

// 4 area^2 < (2 minTriangle * longest edge^2)^2
bool nearlyCollinear(Vec p, Vec q, Vec r, double minTriangle) {
  const Vec u = q - p, v = r - p, w = r - q, n = cross(u, v);
  const double longest = std::max(dot(u, u), std::max(dot(v, v), dot(w, w)));
  const double limit = 2 * minTriangle * longest;
  return dot(n, n) <= limit * limit;
}

constexpr double kInside = 1e-3;  // a crossing nearer than this to an end of a diagonal counts as not convex

}  // namespace

bool makeQuad(const double* const points[4], double minTriangle, Quad& out) {
  // Sorted by position, the arithmetic below does not see in which order the caller found the points.
  int order[4] = {0, 1, 2, 3};
  const auto sortPair = [&](int i, int j) {
    if (before(points[order[j]], points[order[i]])) std::swap(order[i], order[j]);
  };
  sortPair(0, 1), sortPair(2, 3), sortPair(0, 2), sortPair(1, 3), sortPair(1, 2);
  const Vec p[4] = {at(points[order[0]]), at(points[order[1]]), at(points[order[2]]), at(points[order[3]])};

  static constexpr int kPairings[3][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}};
  for (const auto& pairing : kPairings) {
    const Vec p0 = p[pairing[0]], p1 = p[pairing[1]], q0 = p[pairing[2]], q1 = p[pairing[3]];
    const Vec e = p1 - p0, f = q1 - q0, w = q0 - p0;
    const double ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), we = dot(w, e), wf = dot(w, f);
    const double determinant = ee * ff - ef * ef;
    if (!(determinant > 1e-10 * ee * ff)) continue;
    const double s = (we * ff - ef * wf) / determinant, t = (we * ef - ee * wf) / determinant;
    if (!(s > kInside && s < 1 - kInside && t > kInside && t < 1 - kInside)) continue;
    if (nearlyCollinear(p[0], p[1], p[2], minTriangle) || nearlyCollinear(p[0], p[1], p[3], minTriangle) ||
        nearlyCollinear(p[0], p[2], p[3], minTriangle) || nearlyCollinear(p[1], p[2], p[3], minTriangle))
      return false;
    const Vec between = {s * e.x - w.x - t * f.x, s * e.y - w.y - t * f.y, s * e.z - w.z - t * f.z};
    const bool nearFirst = s <= 0.5, nearSecond = t <= 0.5;
    out.a = static_cast<std::uint32_t>(order[pairing[nearFirst ? 0 : 1]]);
    out.c = static_cast<std::uint32_t>(order[pairing[nearFirst ? 1 : 0]]);
    out.b = static_cast<std::uint32_t>(order[pairing[nearSecond ? 2 : 3]]);
    out.d = static_cast<std::uint32_t>(order[pairing[nearSecond ? 3 : 2]]);
    out.ratioAC = nearFirst ? s : 1 - s;
    out.ratioBD = nearSecond ? t : 1 - t;
    out.lengthAC = std::sqrt(ee);
    out.lengthBD = std::sqrt(ff);
    out.gap = std::sqrt(dot(between, between));
    return true;
  }
  return false;
}

bool makeQuad(const std::uint32_t ids[4], const double* positions, double minTriangle, Quad& out) {
  const double* points[4];
  for (int i = 0; i < 4; ++i) points[i] = positions + 3 * std::size_t{ids[i]};
  if (!makeQuad(points, minTriangle, out)) return false;
  out.a = ids[out.a], out.b = ids[out.b], out.c = ids[out.c], out.d = ids[out.d];
  return true;
}

void writeRatios(const Quad& quad, double ratioAC, double ratioBD, double* positions) {
  double* a = positions + 3 * std::size_t{quad.a};
  double* b = positions + 3 * std::size_t{quad.b};
  const double* c = positions + 3 * std::size_t{quad.c};
  const double* d = positions + 3 * std::size_t{quad.d};
  double onAC[3], onBD[3], o[3];
  for (int k = 0; k < 3; ++k) {
    onAC[k] = a[k] + quad.ratioAC * (c[k] - a[k]);
    onBD[k] = b[k] + quad.ratioBD * (d[k] - b[k]);
    o[k] = 0.5 * (onAC[k] + onBD[k]);
  }
  // With o midway between the diagonals and c, d fixed, both diagonals pass through o afterwards: exactly coplanar.
  for (int k = 0; k < 3; ++k) {
    a[k] = (o[k] - ratioAC * c[k]) / (1 - ratioAC);
    b[k] = (o[k] - ratioBD * d[k]) / (1 - ratioBD);
  }
}

}  // namespace quadmark
