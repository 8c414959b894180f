// SPDX-License-Identifier: MIT
#include "quadmark/trig.h"

#include <cmath>

namespace quadmark {

SinCos sinCosTurns(double turns) {
  const double whole = turns - std::floor(turns);                       // [0, 1)
  const int quarter = static_cast<int>(4 * whole + 0.5);                // 0..4: the nearest multiple of a quarter turn
  const double x = 6.283185307179586476925 * (whole - 0.25 * quarter);  // within pi / 4
  const double y = x * x;
  // Taylor: the next terms are below 1e-17 for |x| <= pi / 4.
  const double s =
      x * (1 - y / 6 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72 * (1 - y / 110 * (1 - y / 156 * (1 - y / 210)))))));
  const double c =
      1 -
      y / 2 * (1 - y / 12 * (1 - y / 30 * (1 - y / 56 * (1 - y / 90 * (1 - y / 132 * (1 - y / 182 * (1 - y / 240)))))));
  switch (quarter & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace quadmark
