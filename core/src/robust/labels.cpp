// SPDX-License-Identifier: MIT
// Colour refinement (Weisfeiler and Leman 1968) over ordered rings. Tried, on seven models: depth 2 leaves near-regular
// meshes with a third of the carriers; depth 6 gains 3 % more and loses twice as many at borders.
#include "labels.h"

#include "quadmark/random.h"

namespace quadmark::robust {
namespace {

std::uint64_t combine(std::uint64_t a, std::uint64_t b) {
  return Random::mix((a ^ Random::mix(b + 0x9e3779b97f4a7c15u)) + 0x9e3779b97f4a7c15u);
}

}  // namespace

bool canonicalRing(std::span<const std::uint32_t> ring, std::span<const std::uint64_t> names, std::uint32_t* order,
                   std::uint64_t& hash) {
  const std::size_t n = ring.size();
  // Both senses, each twice in a row, so that every rotation is a window.
  std::uint64_t forward[2 * kMaxRing], backward[2 * kMaxRing];
  for (std::size_t k = 0; k < n; ++k) {
    forward[k] = forward[k + n] = names[ring[k]];
    backward[n - 1 - k] = backward[2 * n - 1 - k] = forward[k];
  }
  const std::uint64_t* best = forward;
  std::size_t bestStart = 0, ties = 1;
  bool mirrored = false;
  for (int sense = 0; sense < 2; ++sense) {
    for (std::size_t start = sense == 0 ? 1 : 0; start < n; ++start) {
      const std::uint64_t* candidate = (sense == 0 ? forward : backward) + start;
      std::size_t k = 0;
      while (k < n && candidate[k] == best[k]) ++k;
      if (k == n) {
        ++ties;
      } else if (candidate[k] < best[k]) {
        best = candidate, bestStart = start, mirrored = sense == 1, ties = 1;
      }
    }
  }
  hash = Random::mix(n);
  for (std::size_t k = 0; k < n; ++k) {
    hash = combine(hash, best[k]);
    const std::size_t at = (bestStart + k) % n;
    order[k] = ring[mirrored ? n - 1 - at : at];
  }
  return ties == 1;
}

Labels refineLabels(const Surface& surface) {
  const std::uint32_t count = surface.vertexCount();
  std::vector<std::uint64_t> current(count), next(count);
  for (std::uint32_t v = 0; v < count; ++v) current[v] = surface.cornerCounts[v];
  std::uint32_t order[kMaxRing];
  for (int level = 1; level <= kLabelDepth; ++level) {
    for (std::uint32_t v = 0; v < count; ++v) {
      const auto ring = surface.ring(v);
      next[v] = 0;
      bool complete = !ring.empty();
      for (std::size_t k = 0; complete && k < ring.size() && level > 1; ++k) complete = current[ring[k]] != 0;
      if (complete) canonicalRing(ring, current, order, next[v]);
    }
    current.swap(next);
  }
  return {std::move(current), std::move(next)};
}

}  // namespace quadmark::robust
