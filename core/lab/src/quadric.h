// SPDX-License-Identifier: MIT
// Error quadrics: the weighted sum of squared distances to planes, as a function of a point (Garland and Heckbert
// 1997).
#pragma once

#include "quadmark/vec3.h"

namespace quadmark::lab {

struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< A
  double x = 0, y = 0, z = 0, c = 0;                      ///< p' A p + 2 (x, y, z)' p + c
  double weight = 0;

  /// Adds weight * (normal . p + offset)^2 for a unit normal.
  void addPlane(const Vec3& n, double offset, double w) {
    xx += w * n.x * n.x;
    xy += w * n.x * n.y;
    xz += w * n.x * n.z;
    yy += w * n.y * n.y;
    yz += w * n.y * n.z;
    zz += w * n.z * n.z;
    x += w * n.x * offset;
    y += w * n.y * offset;
    z += w * n.z * offset;
    c += w * offset * offset;
    weight += w;
  }

  Quadric& operator+=(const Quadric& b) {
    xx += b.xx, xy += b.xy, xz += b.xz, yy += b.yy, yz += b.yz, zz += b.zz;
    x += b.x, y += b.y, z += b.z, c += b.c, weight += b.weight;
    return *this;
  }

  [[nodiscard]] Vec3 timesA(const Vec3& p) const {
    return {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z, xz * p.x + yz * p.y + zz * p.z};
  }

  [[nodiscard]] double at(const Vec3& p) const { return dot(p, timesA(p)) + 2 * (x * p.x + y * p.y + z * p.z) + c; }

  /// The point of least error; false where it is not well determined (flat or cylindrical surroundings).
  [[nodiscard]] bool minimum(Vec3& p) const {
    const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
    const double cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
    const double determinant = xx * cxx + xy * cxy + xz * cxz;
    const double scale = xx + yy + zz;
    if (!(determinant > 1e-12 * scale * scale * scale)) return false;
    const double f = -1 / determinant;
    p = {f * (cxx * x + cxy * y + cxz * z), f * (cxy * x + cyy * y + cyz * z), f * (cxz * x + cyz * y + czz * z)};
    return true;
  }
};

}  // namespace quadmark::lab
