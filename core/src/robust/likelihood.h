// SPDX-License-Identifier: MIT
// Densities that decisions need, from + - * / alone.
#pragma once

namespace quadmark::robust {

inline constexpr double kRootTwoPi = 2.5066282746310002;

/// exp(-x / 2) for x >= 0, to a few per cent: a decision needs no more, and no libm.
inline double gaussian(double x) {
  double q = 1 - x / 32;
  if (q <= 0) return 0;
  q *= q, q *= q, q *= q, q *= q;
  return q;
}

}  // namespace quadmark::robust
