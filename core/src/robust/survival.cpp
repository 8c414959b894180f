// SPDX-License-Identifier: MIT
#include "survival.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "parallel.h"

namespace quadmark::robust {
namespace {

// How far a vertex's faces are, root mean square, from the neighbour that it could collapse to most cheaply: what
// simplifiers sort by. 0 where there is no closed fan.
std::vector<float> collapseCosts(const Surface& surface, const std::vector<double>& positions) {
  std::vector<float> out(surface.vertexCount(), 0.0f);
  forEachInParts(surface.vertexCount(), [&](std::size_t v) {
    const auto ring = surface.ring(static_cast<std::uint32_t>(v));
    if (ring.empty()) return;
    const Vec3 p = at(positions, v);
    CollapseFan fan;
    const std::size_t n = ring.size();
    for (std::size_t k = 0; k < n; ++k)
      fan.add(cross(at(positions, ring[k]) - p, at(positions, ring[(k + 1) % n]) - p));
    if (!fan.hasArea()) return;
    double best = 1e300;
    for (const std::uint32_t u : ring) best = std::min(best, fan.cost(at(positions, u) - p));
    out[v] = static_cast<float>(std::sqrt(best));
  });
  return out;
}

}  // namespace

Survival::Survival(const Surface& surface, const std::vector<double>& positions)
    : cost_(collapseCosts(surface, positions)) {
  std::vector<float> order = cost_;
  for (std::size_t i = 0; i < std::size(kShares) && !order.empty(); ++i) {
    const auto place = order.begin() + static_cast<std::ptrdiff_t>(kShares[i] * static_cast<double>(order.size()));
    std::nth_element(order.begin(), place, order.end());
    limits_[i] = *place;
  }
}

float Survival::reluctance(const Diamond& diamond) const {
  const float least = std::min({cost_[diamond.a], cost_[diamond.b], cost_[diamond.c], cost_[diamond.d]});
  float out = 1;
  for (const float limit : limits_)
    if (least < limit) out *= 2;
  return out;
}

}  // namespace quadmark::robust
