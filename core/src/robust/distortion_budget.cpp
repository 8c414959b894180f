// SPDX-License-Identifier: MIT
#include "distortion_budget.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "parallel.h"
#include "point_triangle.h"
#include "release.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

using detail::Point;
using detail::pointAt;

std::vector<Vec3> unitNormals(const Surface& surface, const std::vector<double>& positions) {
  std::vector<Vec3> normals(surface.vertexCount());
  for (std::uint32_t f = 0; f < surface.faceCount(); ++f) {
    const auto face = surface.face(f);
    const Vec3 area = areaVector(face, positions);
    for (const std::uint32_t v : face) normals[v] += area;
  }
  for (Vec3& normal : normals) normal = normalized(normal);
  return normals;
}

// Squared distance of a point from the faces around a vertex, which are the nearest for displacements this small. Most
// often it lies over one of them, and is then known to be farther from the sides of the others.
double squaredToFan(const Point& p, const Surface& surface, std::span<const std::uint32_t> faces,
                    const std::vector<double>& positions) {
  struct Outside {
    double least;
    std::uint32_t a, b, c;
  };
  std::array<Outside, kMaxRing> outside;
  std::size_t count = 0;
  double best = 1e300;
  const auto lookAtSides = [&](const Outside& o) {
    if (o.least >= best) return;
    best = std::min(best, detail::squaredToSides(p, pointAt(positions, o.a), pointAt(positions, o.b), pointAt(positions, o.c)));
  };
  for (const std::uint32_t f : faces) {
    const auto face = surface.face(f);
    for (std::size_t c = 2; c < face.size(); ++c) {
      const detail::OverTriangle over = detail::overTriangle(p, pointAt(positions, face[0]), pointAt(positions, face[c - 1]),
                                                             pointAt(positions, face[c]));
      const Outside triangle = {over.squared, face[0], face[c - 1], face[c]};
      if (over.inside)
        best = std::min(best, over.squared);
      else if (count < outside.size())
        outside[count++] = triangle;
      else
        lookAtSides(triangle);
    }
  }
  for (std::size_t i = 0; i < count; ++i) lookAtSides(outside[i]);
  return best;
}

// Drops the dearest per vote until the sum of the others is at most `limit`.
template <class Cost>
void dropDearest(const std::vector<Expense>& expenses, double limit, const Cost& cost,
                 std::vector<std::uint8_t>& dropped) {
  double sum = 0;
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < expenses.size(); ++i)
    if (dropped[i] == 0) sum += cost(expenses[i]), order.push_back(i);
  if (sum <= limit) return;
  sortCompactly(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double x = cost(expenses[a]) * expenses[b].votes, y = cost(expenses[b]) * expenses[a].votes;
    return x != y ? x > y : a < b;
  });
  for (std::size_t i = 0; i < order.size() && sum > limit; ++i) {
    sum -= cost(expenses[order[i]]);
    dropped[order[i]] = 1;
  }
}

}  // namespace

ChangeMeter::ChangeMeter(const Surface& surface, const FacesAround& facesAround)
    : surface_(surface), facesAround_(facesAround), normals_(unitNormals(surface, surface.welded.positions)) {}

void ChangeMeter::measure(const std::vector<double>& positions) {
  const std::vector<double>& original = surface_.welded.positions;
  const std::uint32_t count = surface_.vertexCount();
  turns_ = 0;
  turnOf_.assign(count, 0.0f);
  squareOf_.assign(count, 0.0f);
  std::vector<float> moved(count);
  for (std::uint32_t v = 0; v < count; ++v) {
    const Vec3 d = at(positions, v) - at(original, v);
    moved[v] = static_cast<float>(dot(d, d));
  }
  std::vector<double> squares(count, 0.0);
  forEachInParts(count, [&](std::size_t v) {
    if (!(moved[v] > 0)) return;
    const auto faces = facesAround_.of(static_cast<std::uint32_t>(v));
    squares[v] = 0.5 * (squaredToFan(pointAt(original, v), surface_, faces, positions) +
                        squaredToFan(pointAt(positions, v), surface_, faces, original));
    squareOf_[v] = static_cast<float>(squares[v]);
  });
  squares_ = std::accumulate(squares.begin(), squares.end(), 0.0);
  release(squares);
  const std::vector<Vec3> after = unitNormals(surface_, positions);
  for (std::uint32_t v = 0; v < count; ++v) {
    const double turn = length(after[v] - normals_[v]);
    if (!(turn > 0)) continue;
    turns_ += turn;
    // All corners of the faces around, not only neighbours: a polygon's normal depends on each of them.
    double total = 0;
    for (const std::uint32_t f : facesAround_.of(v))
      for (const std::uint32_t w : surface_.face(f)) total += static_cast<double>(moved[w]);
    if (!(total > 0)) continue;
    for (const std::uint32_t f : facesAround_.of(v))
      for (const std::uint32_t w : surface_.face(f))
        if (moved[w] > 0) turnOf_[w] += static_cast<float>(turn * static_cast<double>(moved[w]) / total);
  }
}

std::vector<std::uint8_t> expensesToDrop(const std::vector<Expense>& expenses, double turnLimit, double squareLimit) {
  std::vector<std::uint8_t> dropped(expenses.size(), 0);
  dropDearest(expenses, turnLimit, [](const Expense& e) { return e.turn; }, dropped);
  dropDearest(expenses, squareLimit, [](const Expense& e) { return e.square; }, dropped);
  return dropped;
}

}  // namespace quadmark::robust
