// SPDX-License-Identifier: MIT
// Colour refinement (Weisfeiler and Leman 1968) over ordered rings.
//
// Tried, coded bit error rate of layer A on bunny / fandisk / beast after meshoptimizer to .9 and 12 bits: depth 4 for
// all .43 / .26 / .38; the rule here .11 / .11 / .24; level 1 where four ring vertices are irregular .39 / .25 / .42
// (too few distinct names); any level with a unique order, however regular, .11 / .16 / .28. Depth 2 for all leaves
// near-regular meshes with a third of the carriers; depth 6 gains 3 % and loses twice as many at borders.
#include "labels.h"

#include "far_names.h"
#include "parallel.h"
#include "quadmark/random.h"

namespace quadmark::robust {
namespace {

std::uint64_t combine(std::uint64_t a, std::uint64_t b) {
  return Random::mix((a ^ Random::mix(b + 0x9e3779b97f4a7c15u)) + 0x9e3779b97f4a7c15u);
}

// Per vertex, the irregular vertices seen from its ring's rings, with repetition.
std::vector<std::uint16_t> irregularAround(const Surface& surface) {
  std::vector<std::uint16_t> near(surface.vertexCount(), 0), out(surface.vertexCount(), 0);
  const auto ofRings = [&](std::vector<std::uint16_t>& sums, const auto& termOf) {
    forEachInParts(surface.vertexCount(), [&](std::size_t v) {
      for (const std::uint32_t n : surface.ring(static_cast<std::uint32_t>(v)))
        sums[v] = static_cast<std::uint16_t>(sums[v] + termOf(n));
    });
  };
  ofRings(near, [&](std::uint32_t n) { return isRegular(surface, n) ? 0 : 1; });
  ofRings(out, [&](std::uint32_t n) { return near[n]; });
  return out;
}

// By level: so many make a name at this level distinctive enough. Level 1 never is.
constexpr std::uint16_t kEnoughIrregular[kLabelDepth] = {0xffff, 0xffff, 5, 2};

}  // namespace

bool canonicalRing(std::span<const std::uint32_t> ring, std::span<const std::uint64_t> names, std::uint32_t* order,
                   std::uint64_t& hash) {
  const std::size_t n = ring.size();
  // Twice in a row, so that every rotation is a window.
  std::uint64_t sequence[2 * kMaxRing];
  for (std::size_t k = 0; k < n; ++k) sequence[k] = sequence[k + n] = names[ring[k]];
  std::size_t best = 0, ties = 1;
  for (std::size_t start = 1; start < n; ++start) {
    std::size_t k = 0;
    while (k < n && sequence[start + k] == sequence[best + k]) ++k;
    if (k == n) {
      ++ties;
    } else if (sequence[start + k] < sequence[best + k]) {
      best = start, ties = 1;
    }
  }
  hash = Random::mix(n);
  for (std::size_t k = 0; k < n; ++k) {
    hash = combine(hash, sequence[best + k]);
    order[k] = ring[(best + k) % n];
  }
  return ties == 1;
}

bool Labels::orderRing(const Surface& surface, std::uint32_t vertex, std::uint32_t* order) const {
  std::uint64_t hash = 0;
  return canonicalRing(surface.ring(vertex), names[depth[vertex] - 1], order, hash);
}

Labels refineLabels(const Surface& surface) {
  const std::uint32_t count = surface.vertexCount();
  Labels out;
  out.depth.assign(count, 0);
  std::vector<std::uint64_t> current(surface.cornerCounts.begin(), surface.cornerCounts.end()), next(count);
  const std::vector<std::uint16_t> irregular = irregularAround(surface);
  out.label.assign(count, 0);
  std::vector<std::uint8_t> named(count, 0);  // by the last level
  for (int level = 1; level <= kLabelDepth; ++level) {
    forEachInParts(count, [&](std::size_t v) {
      const auto ring = surface.ring(static_cast<std::uint32_t>(v));
      next[v] = 0;
      bool complete = !ring.empty();
      for (std::size_t k = 0; complete && k < ring.size() && level > 1; ++k) complete = current[ring[k]] != 0;
      if (!complete) return;
      std::uint32_t order[kMaxRing];
      const bool unique = canonicalRing(ring, current, order, next[v]);
      if (level == kLabelDepth) named[v] = unique;
      const bool enough = level == kLabelDepth || (unique && irregular[v] >= kEnoughIrregular[level]);
      if (out.depth[v] != 0 || !enough) return;
      out.depth[v] = static_cast<std::uint8_t>(level);
      out.label[v] = combine(next[v], static_cast<std::uint64_t>(level));
    });
    out.names[level - 1] = std::move(current);
    current = std::move(next);
    next.assign(count, 0);
  }
  // What no neighbourhood names is named from afar, or not at all.
  out.names[kLabelDepth] = farNames(surface);
  if (out.names[kLabelDepth].empty()) return out;
  for (std::uint32_t v = 0; v < count; ++v) {
    const bool local = out.label[v] != 0 && (out.depth[v] < kLabelDepth || named[v] != 0);
    if (local || surface.ring(v).empty()) continue;
    std::uint32_t order[kMaxRing];
    std::uint64_t hash = 0;
    const bool unique = canonicalRing(surface.ring(v), out.names[kLabelDepth], order, hash);
    out.depth[v] = kLabelDepth + 1;
    out.label[v] = unique ? combine(hash, kLabelDepth + 1) : 0;
  }
  return out;
}

}  // namespace quadmark::robust
