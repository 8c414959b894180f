// SPDX-License-Identifier: MIT
#include "torus_surface.h"

#include <cmath>
#include <utility>

namespace quadmark::lab {
namespace {

/// The shortest way between two values of period 1.
double shortest(double difference) {
  return difference - std::floor(difference + 0.5);
}

}  // namespace

TorusSurface::TorusSurface(std::uint32_t columns, std::uint32_t rows, SurfaceFunction shape, Random& random)
    : shape_(std::move(shape)), columns_(columns), rows_(rows) {
  for (std::uint32_t column = 0; column < columns; ++column)
    for (std::uint32_t row = 0; row < rows; ++row) {
      points_.push_back(
          {(column + random.uniform(-0.25, 0.25)) / columns_, (row + random.uniform(-0.25, 0.25)) / rows_});
      places_.push_back(shape_(points_.back()));
    }
  // Both triangles of a cell, and by arithmetic on cell numbers the half-edge on the other side of each of theirs:
  // 0: bottom a->b, 1: right b->c, 2: diagonal c->a, 3: diagonal a->c, 4: top c->d, 5: left d->a.
  const auto cell = [&](std::uint32_t column, std::uint32_t row) { return (column % columns) * rows + row % rows; };
  corner_.reserve(6 * points_.size());
  twin_.reserve(6 * points_.size());
  for (std::uint32_t column = 0; column < columns; ++column)
    for (std::uint32_t row = 0; row < rows; ++row) {
      const std::uint32_t self = 6 * cell(column, row);
      const std::uint32_t a = cell(column, row), b = cell(column + 1, row), c = cell(column + 1, row + 1),
                          d = cell(column, row + 1);
      corner_.insert(corner_.end(), {a, b, c, a, c, d});
      twin_.insert(twin_.end(), {6 * cell(column, row + rows - 1) + 4, 6 * cell(column + 1, row) + 5, self + 3,
                                 self + 2, 6 * cell(column, row + 1) + 0, 6 * cell(column + columns - 1, row) + 1});
    }
  outgoing_.resize(points_.size());
  for (std::uint32_t h = 0; h < corner_.size(); ++h) outgoing_[corner_[h]] = h;
  valence_.assign(points_.size(), 6);
}

template <class Visit>
void TorusSurface::forEachSpoke(std::uint32_t vertex, const Visit& visit) const {
  const std::uint32_t first = outgoing_[vertex];
  std::uint32_t h = first;
  do {
    visit(h);
    h = twin_[previous(h)];
  } while (h != first);
}

/// Twice the signed area in units of grid cells.
double TorusSurface::parameterArea(SurfacePoint a, SurfacePoint b, SurfacePoint c) const {
  const double bu = columns_ * shortest(b.u - a.u), bv = rows_ * shortest(b.v - a.v);
  const double cu = columns_ * shortest(c.u - a.u), cv = rows_ * shortest(c.v - a.v);
  return bu * cv - bv * cu;
}

/// Cosine of the angle between the triangles a b left and b a right: 1 is flat.
double TorusSurface::foldCosine(std::uint32_t a, std::uint32_t b, std::uint32_t left, std::uint32_t right) const {
  const Vec3 edge = places_[b] - places_[a];
  const Vec3 one = cross(edge, places_[left] - places_[a]), other = cross(places_[right] - places_[a], edge);
  const double scale = length(one) * length(other);
  return scale > 0 ? dot(one, other) / scale : -1;
}

bool TorusSurface::wantsFlip(std::uint32_t h) const {
  const std::uint32_t g = twin_[h], a = corner_[h], b = corner_[g], c = corner_[previous(h)], d = corner_[previous(g)];
  if (valence_[a] <= 4 || valence_[b] <= 4 || valence_[c] >= 8 || valence_[d] >= 8) return false;
  // Delaunay: the angles opposite the edge must not exceed 180 degrees together, sin(alpha + beta) >= 0.
  const Vec3 ac = places_[a] - places_[c], bc = places_[b] - places_[c];
  const Vec3 ad = places_[a] - places_[d], bd = places_[b] - places_[d];
  const double sine = length(cross(ac, bc)) * dot(ad, bd) + dot(ac, bc) * length(cross(ad, bd));
  const double scale = length(ac) * length(bc) * length(ad) * length(bd);
  if (!(sine < -1e-9 * scale)) return false;
  // In a sharp groove the flatter choice of the two looks right, whatever the angles.
  if (foldCosine(c, d, b, a) < foldCosine(a, b, c, d) - 0.05) return false;
  if (parameterArea(points_[c], points_[d], points_[b]) < 0.02 ||
      parameterArea(points_[d], points_[c], points_[a]) < 0.02)
    return false;
  bool joined = false;
  forEachSpoke(c, [&](std::uint32_t spoke) { joined = joined || corner_[next(spoke)] == d; });
  return !joined;
}

void TorusSurface::flip(std::uint32_t h) {
  // a b c + b a d become c d b + d c a.
  const std::uint32_t g = twin_[h], hn = next(h), hp = previous(h), gn = next(g), gp = previous(g);
  const std::uint32_t a = corner_[h], b = corner_[g], c = corner_[hp], d = corner_[gp];
  const std::uint32_t bc = twin_[hn], ca = twin_[hp], ad = twin_[gn], db = twin_[gp];
  corner_[h] = c, corner_[hn] = d, corner_[hp] = b;
  corner_[g] = d, corner_[gn] = c, corner_[gp] = a;
  const auto pair = [&](std::uint32_t x, std::uint32_t y) { twin_[x] = y, twin_[y] = x; };
  pair(hn, db);
  pair(hp, bc);
  pair(gn, ca);
  pair(gp, ad);
  outgoing_[c] = h, outgoing_[d] = g, outgoing_[b] = hp, outgoing_[a] = gp;
  --valence_[a], --valence_[b], ++valence_[c], ++valence_[d];
}

void TorusSurface::flipToDelaunay(int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    bool flipped = false;
    for (std::uint32_t h = 0; h < corner_.size(); ++h) {
      if (h > twin_[h] || !wantsFlip(h)) continue;
      flip(h);
      flipped = true;
    }
    if (!flipped) return;
  }
}

void TorusSurface::relax(double jitter, Random& random) {
  for (std::uint32_t vertex = 0; vertex < points_.size(); ++vertex) {
    const SurfacePoint self = points_[vertex];
    double weight = 0, u = 0, v = 0, reachU = 0, reachV = 0;
    forEachSpoke(vertex, [&](std::uint32_t h) {
      const std::uint32_t i = corner_[next(h)], j = corner_[previous(h)];
      const double area = length(cross(places_[i] - places_[vertex], places_[j] - places_[vertex]));
      const double iu = shortest(points_[i].u - self.u), iv = shortest(points_[i].v - self.v);
      const double ju = shortest(points_[j].u - self.u), jv = shortest(points_[j].v - self.v);
      weight += area;
      u += area * (iu + ju) / 3;
      v += area * (iv + jv) / 3;
      reachU += std::fabs(iu);
      reachV += std::fabs(iv);
    });
    const double moveU = random.uniform(-jitter, jitter), moveV = random.uniform(-jitter, jitter);
    if (!(weight > 0)) continue;
    const SurfacePoint moved{self.u + 0.5 * u / weight + moveU * reachU / valence_[vertex],
                             self.v + 0.5 * v / weight + moveV * reachV / valence_[vertex]};
    bool valid = true;
    forEachSpoke(vertex, [&](std::uint32_t h) {
      valid = valid && parameterArea(moved, points_[corner_[next(h)]], points_[corner_[previous(h)]]) > 0.05;
    });
    if (!valid) continue;
    points_[vertex] = moved;
    places_[vertex] = shape_(moved);
  }
}

Mesh TorusSurface::mesh() const {
  Mesh mesh;
  mesh.positions.reserve(3 * places_.size());
  for (const Vec3& p : places_) append(mesh.positions, p);
  mesh.faceVertices = corner_;
  return mesh;
}

}  // namespace quadmark::lab
