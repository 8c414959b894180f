// SPDX-License-Identifier: MIT
// Quantization index modulation of a number (Chen, Wornell 2001): cells of one step, numbered from 0 up; the parity of its
// cell is the bit of a number, and the middle of a cell is where a bit is safest.
#pragma once

#include <algorithm>
#include <cmath>

namespace quadmark::bench {

/// The middle of the cell with this bit that is nearest to x, among the cells `from` .. `to` (whole numbers; at least two).
[[nodiscard]] inline double qimNearest(double x, double step, bool bit, double from = -1e15, double to = 1e15) {
  const double wanted = bit ? 1 : 0, cell = std::clamp(std::floor(x / step), from, to);
  const auto parity = [](double c) { return c - 2 * std::floor(c / 2); };
  if (parity(cell) == wanted) return (cell + 0.5) * step;
  const bool up = cell + 1 <= to && (cell - 1 < from || x / step - cell >= 0.5);
  return (cell + (up ? 1.5 : -0.5)) * step;
}

/// What x says: 1 in the middle of a cell of 1, -1 in one of 0, nearly nothing at a border.
[[nodiscard]] inline double qimVote(double x, double step) {
  const double cell = std::floor(x / step), inside = x / step - cell;
  const double sureness = 1 - std::abs(2 * inside - 1);
  return cell - 2 * std::floor(cell / 2) == 1 ? sureness : -sureness;
}

/// How much a vote counts whose step has this length, for noise moves vertices and the longer step survives more of it. Above
/// 1e-4 of the diagonal all count nearly alike.
[[nodiscard]] inline double lengthWeight(double stepLength, double diagonal) {
  const double clear = 1e-4 * diagonal;
  return stepLength * stepLength / (stepLength * stepLength + clear * clear);
}

}  // namespace quadmark::bench
