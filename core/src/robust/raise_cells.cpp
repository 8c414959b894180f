// SPDX-License-Identifier: MIT
#include "raise_cells.h"

#include <algorithm>

#include "survival.h"

namespace quadmark::robust {
namespace {

// What web builds let a simplifier do, of the extent, and half as much again: faces around a cell change, too, and errors
// add up. (Of 1.3, 1.5, 1.8 and 2.2e-4: more keeps single cells better, but fewer can be raised so far.)
constexpr double kCost = 1.5e-4;
constexpr double kStep = 0.35 * kCost;   // between the heights that are tried, of the extent
constexpr int kSteps = 8;                // heights, on either side
constexpr double kTurnCosine = 0.98481;  // 10 degrees
constexpr double kFlat = 0.00175;        // slope of an edge out of its plane, 0.1 degrees

class Raiser {
 public:
  Raiser(const Surface& surface, const FacesAround& facesAround, const DiamondLimits& limits, double grain,
         const ChangeMeter& change, std::vector<double>& positions)
      : surface_(surface),
        facesAround_(facesAround),
        limits_(limits),
        grain_(grain),
        change_(change),
        extent_(largestExtent(positions)),
        positions_(positions) {}

  [[nodiscard]] bool stands(const Diamond& q) const {
    for (const std::uint32_t v : {q.a, q.b, q.c, q.d})
      if (!stands(v)) return false;
    return true;
  }

  // By the least of the heights that will do; false, with everything as it was, where none does.
  bool raise(const Diamond& q) {
    const std::uint32_t vertex[4] = {q.a, q.b, q.c, q.d};
    Vec3 old[4];
    for (int k = 0; k < 4; ++k) {
      if (facesAround_.of(vertex[k]).size() > kMaxRing || isFlat(vertex[k])) return false;
      old[k] = at(positions_, vertex[k]);
    }
    const Vec3 normal = normalized(cross(old[2] - old[0], old[3] - old[1]));
    bool isOpen[2] = {true, true};  // sides: what is too high stays so farther up
    for (int step = 1; step <= kSteps; ++step)
      for (int side = 0; side < 2; ++side) {
        if (!isOpen[side]) continue;
        const Vec3 move = ((side == 0 ? step : -step) * kStep * extent_) * normal;
        for (int k = 0; k < 4; ++k) put(positions_, vertex[k], old[k] + move);
        isOpen[side] = isAllowed(q);
        if (isOpen[side] && stands(q)) return true;
      }
    for (int k = 0; k < 4; ++k) put(positions_, vertex[k], old[k]);
    return false;
  }

 private:
  [[nodiscard]] bool stands(std::uint32_t v) const {
    const auto faces = facesAround_.of(v);
    if (faces.size() > kMaxRing) return false;
    CollapseFan fan;
    for (const std::uint32_t f : faces) fan.add(areaVector(surface_.face(f), positions_));
    if (!fan.hasArea()) return false;
    const Vec3 p = at(positions_, v);
    const double least = kCost * extent_ * kCost * extent_;
    for (const std::uint32_t f : faces)
      for (const std::uint32_t u : surface_.face(f))
        if (u != v && fan.cost(at(positions_, u) - p) < least) return false;
    return true;
  }

  // Whether the faces around a vertex lay in one plane before embedding, as far as coordinates can tell.
  [[nodiscard]] bool isFlat(std::uint32_t v) const {
    const std::vector<double>& original = surface_.welded.positions;
    const Vec3 p = at(original, v), &normal = change_.normal(v);
    for (const std::uint32_t f : facesAround_.of(v))
      for (const std::uint32_t u : surface_.face(f)) {
        const Vec3 way = at(original, u) - p;
        const double height = dot(way, normal), most = kFlat * length(way) + grain_;
        if (height > most || -height > most) return false;
      }
    return true;
  }

  [[nodiscard]] bool isAllowed(const Diamond& q) const {
    for (const std::uint32_t v : {q.a, q.b, q.c, q.d}) {
      const Vec3 move = at(positions_, v) - at(surface_.welded.positions, v);
      if (length(move) > limits_.maxMove) return false;
      if (slideOf(move, change_.normal(v)) > limits_.maxSlide) return false;
    }
    return !anyFaceTurns(surface_, facesAround_, q, std::max(kTurnCosine, limits_.turnCosine), positions_);
  }

  const Surface& surface_;
  const FacesAround& facesAround_;
  const DiamondLimits& limits_;
  const double grain_;
  const ChangeMeter& change_;
  const double extent_;
  std::vector<double>& positions_;
};

}  // namespace

void raiseCells(const Surface& surface, const FacesAround& facesAround, const std::vector<WrittenCell>& cells,
                std::size_t wanted, const DiamondLimits& limits, double grain, const ChangeMeter& change,
                std::vector<double>& positions) {
  Raiser raiser(surface, facesAround, limits, grain, change, positions);
  std::size_t standing = 0;
  std::vector<std::uint32_t> low;
  for (std::uint32_t i = 0; i < cells.size() && standing < wanted; ++i)
    if (raiser.stands(cells[i].diamond))
      ++standing;
    else
      low.push_back(i);
  for (std::size_t k = 0; k < low.size() && standing < wanted; ++k)
    if (raiser.raise(cells[low[k]].diamond)) ++standing;
}

}  // namespace quadmark::robust
