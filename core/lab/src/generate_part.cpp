// SPDX-License-Identifier: MIT
// A bracket as a CAD system exports it: a plate of straight and round sides, a hub with a bore, a chamfer and a fillet.
#include <algorithm>

#include "mesh_tools.h"
#include "quadmark/lab/generate.h"
#include "quadmark/random.h"
#include "quadmark/trig.h"

namespace quadmark::lab {
namespace {

constexpr double kBore = 0.7, kChamfer = 0.1, kHub = 1.2, kFillet = 0.25, kTop = 1.6, kPlate = 0.8;

/// Onto a grid of 2^-16: sums and differences of such numbers are exact in float32 at this size, so that slanted walls
/// are as exactly flat as upright ones.
double snapped(double x) {
  return std::floor(x * 65536 + 0.5) / 65536;
}

/// A point of the plate's outline, and along which side it may slide: `slide` is zero at corners and on the arc.
struct OutlinePoint {
  Vec3 place, slide;
};

/// Outline of the plate, counter-clockwise, about `count` points: straight sides x = 3, x + y = 4, y = 2, y = -2,
/// x - y = 4 and a half circle around (-1, 0).
std::vector<OutlinePoint> outline(double count) {
  constexpr double kCorners[][2] = {{-1, -2}, {2, -2}, {3, -1}, {3, 1}, {2, 2}, {-1, 2}};
  constexpr double kPerimeter = 3 + 1.4142 + 2 + 1.4142 + 3 + 6.2832;
  std::vector<OutlinePoint> points;
  for (std::size_t i = 0; i + 1 < std::size(kCorners); ++i) {
    const Vec3 from{kCorners[i][0], kCorners[i][1], 0}, way = Vec3{kCorners[i + 1][0], kCorners[i + 1][1], 0} - from;
    const int pieces = std::max(2, static_cast<int>(count * length(way) / kPerimeter + 0.5));
    for (int j = 0; j < pieces; ++j) {
      // The same snapped number goes into both coordinates: the point stays on the side's line exactly.
      const double along = snapped(std::max(std::fabs(way.x), std::fabs(way.y)) * j / pieces);
      const Vec3 unit{way.x > 0 ? 1.0 : way.x < 0 ? -1.0 : 0.0, way.y > 0 ? 1.0 : way.y < 0 ? -1.0 : 0.0, 0};
      points.push_back({from + along * unit, j == 0 ? Vec3{} : unit});
    }
  }
  const int pieces = std::max(6, static_cast<int>(count * 6.2832 / kPerimeter + 0.5));
  for (int j = 0; j < pieces; ++j) {
    const SinCos angle = sinCosTurns(0.25 + 0.5 * j / pieces);
    points.push_back({{snapped(2 * angle.cos - 1), snapped(2 * angle.sin), 0}, {}});
  }
  return points;
}

/// One loop around the bore: every outline direction at distance `radius`, or the outline itself blended in by `outer`.
struct Loop {
  double radius, height, outer;
  enum class Freedom { none, inPlane, upright } freedom = Freedom::none;  ///< where inner vertices may be shifted to
};

/// The section's loops from the bore's bottom up, over the hub, the plate, down the outer wall and back underneath.
std::vector<Loop> section(double spacing) {
  std::vector<Loop> loops;
  const auto run = [&](Loop from, Loop to, double length, int least, Loop::Freedom freedom) {
    const int pieces = std::max(least, static_cast<int>(length / spacing + 0.5));
    for (int i = 0; i < pieces; ++i) {
      const double t = static_cast<double>(i) / pieces;
      loops.push_back({from.radius + t * (to.radius - from.radius),
                       snapped(from.height + t * (to.height - from.height)), from.outer + t * (to.outer - from.outer),
                       i == 0 ? Loop::Freedom::none : freedom});
    }
  };
  const double neck = kPlate + kFillet, foot = kHub + kFillet;
  run({kBore, 0, 0}, {kBore, kTop - kChamfer, 0}, kTop - kChamfer, 2, Loop::Freedom::upright);
  run({kBore, kTop - kChamfer, 0}, {kBore + kChamfer, kTop, 0}, 1.4 * kChamfer, 1, Loop::Freedom::none);
  run({kBore + kChamfer, kTop, 0}, {kHub, kTop, 0}, kHub - kBore - kChamfer, 2, Loop::Freedom::inPlane);
  run({kHub, kTop, 0}, {kHub, neck, 0}, kTop - neck, 2, Loop::Freedom::upright);
  const int arcPieces = std::max(3, static_cast<int>(1.57 * kFillet / spacing + 0.5));
  for (int i = 0; i < arcPieces; ++i) {
    const SinCos angle = sinCosTurns(0.25 * i / arcPieces);
    loops.push_back({foot - kFillet * angle.cos, snapped(neck - kFillet * angle.sin), 0});
  }
  run({foot, kPlate, 0}, {foot, kPlate, 1}, 1.1, 3, Loop::Freedom::inPlane);
  run({foot, kPlate, 1}, {foot, 0, 1}, kPlate, 2, Loop::Freedom::upright);
  run({kBore, 0, 1}, {kBore, 0, 0}, 1.7, 3, Loop::Freedom::inPlane);
  return loops;
}

}  // namespace

Mesh machinedPart(std::size_t vertices, std::uint64_t seed) {
  constexpr double kPerimeter = 14, kSection = 8;  // mean lengths both ways
  const double count = static_cast<double>(std::max<std::size_t>(vertices, 300));
  const double spacing = std::sqrt(kPerimeter * kSection / count);
  const std::vector<Loop> loops = section(spacing);
  const std::vector<OutlinePoint> points = outline(count / static_cast<double>(loops.size()));
  const auto rows = static_cast<std::uint32_t>(loops.size()), columns = static_cast<std::uint32_t>(points.size());

  Random random(seed);
  Mesh mesh;
  const auto placeOf = [&](const Loop& loop, const OutlinePoint& point) {
    const Vec3 inner = (loop.radius / length(point.place)) * point.place;
    return Vec3{snapped(inner.x + loop.outer * (point.place.x - inner.x)),
                snapped(inner.y + loop.outer * (point.place.y - inner.y)), loop.height};
  };
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const Loop& loop = loops[row];
      const OutlinePoint& point = points[column];
      Vec3 p = placeOf(loop, point);
      // CAD meshers leave flat regions irregular: shift by up to a fifth of the way to the neighbours.
      const Vec3 beside = placeOf(loop, points[(column + 1) % columns]) - p;
      const Vec3 ahead = placeOf(loops[(row + 1) % rows], point) - p;
      const double room = 0.2 * std::min(length(beside), length(ahead));
      const double s = random.uniform(-room, room), t = random.uniform(-room, room);
      if (loop.freedom == Loop::Freedom::inPlane) p = {snapped(p.x + s), snapped(p.y + t), p.z};
      if (loop.freedom == Loop::Freedom::upright) {
        p.z = snapped(p.z + s);
        if (loop.outer == 1) p += snapped(0.7 * t) * point.slide;
      }
      append(mesh.positions, p);
    }
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t nextRow = (row + 1) % rows, nextColumn = (column + 1) % columns;
      const std::uint32_t a = row * columns + column, b = row * columns + nextColumn,
                          c = nextRow * columns + nextColumn, d = nextRow * columns + column;
      if (random.below(2) == 0)
        mesh.faceVertices.insert(mesh.faceVertices.end(), {a, c, b, a, d, c});
      else
        mesh.faceVertices.insert(mesh.faceVertices.end(), {a, d, b, b, d, c});
    }
  roundToPrecision(mesh);
  return mesh;
}

}  // namespace quadmark::lab
