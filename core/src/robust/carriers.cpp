// SPDX-License-Identifier: MIT
#include "carriers.h"

#include <algorithm>
#include <array>

#include "lattice.h"
#include "parallel.h"
#include "quadmark/trig.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

// Cosine and sine of k / n turns for every ring size.
const SinCos* turns(std::size_t n) {
  static const auto table = [] {
    std::array<std::array<SinCos, kMaxRing>, kMaxRing + 1> t{};
    for (std::size_t size = kMinRing; size <= kMaxRing; ++size)
      for (std::size_t k = 0; k < size; ++k)
        t[size][k] = sinCosTurns(static_cast<double>(k) / static_cast<double>(size));
    return t;
  }();
  return table[n].data();
}

// Bits per coordinate, the fewest that give the model enough places. Only names from afar may hold several: they change
// with every cut of the connectivity anyway, while a local name's carriers are fewer after a crop, which must not change
// how the others are read.
void assignBits(const Labels& labels, Carriers& out) {
  out.bits.assign(out.count(), 1);
  const auto isFar = [&](std::uint32_t carrier) { return labels.depth[out.vertex[carrier]] > kLabelDepth; };
  std::vector<KeyedIndex> order(out.count());
  bool anyFar = false;
  for (std::uint32_t i = 0; i < out.count(); ++i) {
    anyFar = anyFar || isFar(i);
    order[i] = {out.label[i], i};
  }
  if (!anyFar) return;
  sortByKey(order);
  std::size_t places = 0;
  for (std::uint32_t bits = 1; bits <= kMostRingBits && places < kEnoughRingPlaces; ++bits) {
    places = 0;
    for (std::size_t first = 0, next = 0; first < order.size(); first = next) {
      while (next < order.size() && order[next].key == order[first].key) ++next;
      const std::uint32_t most = isFar(order[first].index) ? mostRingBits(next - first) : 1, held = std::min(bits, most);
      places += 2 * held;
      for (std::size_t i = first; i < next; ++i) out.bits[order[i].index] = static_cast<std::uint8_t>(held);
    }
  }
}

}  // namespace

Carriers selectCarriers(const Surface& surface, const Prf& select) {
  const Labels labels = refineLabels(surface);
  const std::uint32_t count = surface.vertexCount();
  std::vector<std::uint64_t> rank(count, 0);
  forEachInParts(count, [&](std::size_t v) {
    if (labels.label[v] != 0) rank[v] = select(labels.label[v]);
  });
  Carriers out;
  out.ringOffsets.push_back(0);
  std::uint32_t order[kMaxRing];
  for (std::uint32_t v = 0; v < count; ++v) {
    if (labels.label[v] == 0) continue;
    const auto ring = surface.ring(v);
    bool highest = true;
    for (std::size_t k = 0; highest && k < ring.size(); ++k) highest = rank[ring[k]] < rank[v];
    if (!highest || !labels.orderRing(surface, v, order)) continue;
    out.vertex.push_back(v);
    out.label.push_back(labels.label[v]);
    out.rings.insert(out.rings.end(), order, order + ring.size());
    out.ringOffsets.push_back(static_cast<std::uint32_t>(out.rings.size()));
  }
  assignBits(labels, out);
  return out;
}

bool ringFrame(const std::vector<double>& positions, std::span<const std::uint32_t> ring, const SymmetricTensor& tensor,
               RingFrame& frame) {
  const double share = 1.0 / static_cast<double>(ring.size());
  const SinCos* turn = turns(ring.size());
  Vec3 sum, cosine, sine;
  for (const std::uint32_t v : ring) sum += at(positions, v);
  frame.origin = share * sum;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec3 d = at(positions, ring[k]) - frame.origin;
    cosine += turn[k].cos * d;
    sine += turn[k].sin * d;
  }
  frame.e1 = 2 * share * cosine;
  frame.e2 = 2 * share * sine;
  const Vec3 normal = cross(frame.e1, frame.e2);
  const double area = length(normal);
  if (!(area > 1e-14 * (dot(frame.e1, frame.e1) + dot(frame.e2, frame.e2)))) return false;
  const Vec3 axis = tensor.times(normal);
  const double scale = length(axis);
  if (!(scale > 0)) return false;
  frame.radius = std::sqrt(area);
  frame.e3 = (frame.radius / scale) * axis;
  return dot(normal, frame.e3) > 1e-3 * area * frame.radius;
}

RingCoordinates coordinatesIn(const RingFrame& frame, const Vec3& point) {
  const Vec3 d = point - frame.origin, c23 = cross(frame.e2, frame.e3);
  const double volume = dot(frame.e1, c23);
  return {dot(d, c23) / volume, dot(d, cross(frame.e3, frame.e1)) / volume, dot(d, cross(frame.e1, frame.e2)) / volume};
}

Vec3 pointAt(const RingFrame& frame, const RingCoordinates& c) {
  return frame.origin + c.alpha * frame.e1 + c.beta * frame.e2 + c.gamma * frame.e3;
}

}  // namespace quadmark::robust
