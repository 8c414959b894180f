// SPDX-License-Identifier: MIT
#include "embed_rings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "median.h"

namespace quadmark::robust {
namespace {

// Lattice step that is wanted on the surface, of the diagonal: noise of 1e-3 of the diagonal then leaves a third of a
// vote's amplitude.
constexpr double kWantedStep = 0.0027;

// How far to go along `axis` from p to meet the fan of `apex`; the nearest meeting, 0 where the axis misses it.
double toFan(const Vec3& p, const Vec3& axis, const Vec3& apex, const std::vector<double>& positions,
             std::span<const std::uint32_t> ring) {
  double best = 1e300;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec3 b = at(positions, ring[k]) - apex, c = at(positions, ring[(k + 1) % ring.size()]) - apex;
    const Vec3 normal = cross(b, c);
    const double along = dot(normal, axis);
    const double bb = dot(b, b), bc = dot(b, c), cc = dot(c, c), det = bb * cc - bc * bc;
    if (!(det > 0) || along == 0) continue;
    const double t = -dot(normal, p - apex) / along;
    const Vec3 h = p + t * axis - apex;
    const double hb = dot(h, b), hc = dot(h, c);
    const bool inside = (cc * hb - bc * hc) / det >= -1e-9 && (bb * hc - bc * hb) / det >= -1e-9;
    if (inside && std::fabs(t) < std::fabs(best)) best = t;
  }
  return std::fabs(best) < 0.5 ? best : 0;
}

// Would moving the apex turn or shrink a fan triangle too far, or does the fan have a crease?
bool vetoed(const Vec3& from, const Vec3& to, const std::vector<double>& positions, std::span<const std::uint32_t> ring,
            const RingLimits& limits) {
  const std::size_t n = ring.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 b = at(positions, ring[k]), c = at(positions, ring[(k + 1) % n]), d = at(positions, ring[(k + 2) % n]);
    const Vec3 before = cross(b - from, c - from), after = cross(b - to, c - to), next = cross(c - from, d - from);
    const double areaBefore = length(before), areaAfter = length(after);
    if (dot(before, after) < limits.turnCosine * areaBefore * areaAfter) return true;
    if (areaAfter < limits.leastArea * areaBefore) return true;
    if (dot(before, next) < limits.creaseCosine * areaBefore * length(next)) return true;
  }
  return false;
}

}  // namespace

double chooseRingStep(const Carriers& carriers, const std::vector<double>& positions, const SymmetricTensor& tensor,
                      double diagonal) {
  std::vector<float> radii;
  RingFrame frame;
  for (std::uint32_t i = 0; i < carriers.count(); ++i)
    if (ringFrame(positions, carriers.ring(i), tensor, frame)) radii.push_back(static_cast<float>(frame.radius));
  if (radii.empty()) return kRingSteps[0];
  const double median = medianOf(std::move(radii));
  for (const double step : kRingSteps)
    if (step * median >= kWantedStep * diagonal) return step;
  return kRingSteps[std::size(kRingSteps) - 1];
}

std::vector<std::uint32_t> embedRings(const Carriers& carriers, const RingCode& code, const CodedPayload& payload,
                                      const SymmetricTensor& tensor, const RingLimits& limits, const ChangeMeter& change,
                                      const std::vector<std::uint8_t>& dropped, std::vector<double>& positions) {
  const Sharing sharing = payload.hasBody() ? Sharing::split : Sharing::headOnly;
  std::vector<std::uint32_t> written;
  for (std::uint32_t i = 0; i < carriers.count(); ++i) {
    const auto ring = carriers.ring(i);
    RingFrame frame;
    if (dropped[i] != 0 || !ringFrame(positions, ring, tensor, frame)) continue;
    const Vec3 from = at(positions, carriers.vertex[i]);
    RingCoordinates p = coordinatesIn(frame, from);
    if (std::fabs(p.alpha) > limits.maxCoordinate || std::fabs(p.beta) > limits.maxCoordinate) continue;
    double* coordinate[2] = {&p.alpha, &p.beta};
    for (int k = 0; k < 2; ++k) {
      const std::uint32_t bits = carriers.bits[i];
      const RingPlace place = code.place(carriers.label[i], k, bits);
      const double phase = phaseOf(valueAt({place.slot, bits}, payload, sharing), bits);
      *coordinate[k] = nearestLatticePoint(*coordinate[k], limits.step, place.offset, phase);
    }
    Vec3 to = pointAt(frame, p);
    to += toFan(to, frame.e3, from, positions, ring) * frame.e3;
    const Vec3 move = to - from;
    if (length(move) > limits.maxMove || slideOf(move, change.normal(carriers.vertex[i])) > limits.maxSlide) continue;
    if (vetoed(from, to, positions, ring, limits)) continue;
    put(positions, carriers.vertex[i], to);
    written.push_back(i);
  }
  return written;
}

}  // namespace quadmark::robust
