// SPDX-License-Identifier: MIT
#include "patches.h"

#include <algorithm>
#include <numeric>

#include "quadmark/random.h"

namespace quadmark::bench {
namespace {

constexpr int kRefinements = 6;
constexpr std::uint32_t kFar = 0xffffffffu;

// Ranks of the vertices by name, then by number.
std::vector<std::uint32_t> ranksOf(const std::vector<std::uint64_t>& names, std::vector<std::uint32_t>& byRank) {
  byRank.resize(names.size());
  std::iota(byRank.begin(), byRank.end(), 0u);
  std::stable_sort(byRank.begin(), byRank.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return names[a] < names[b]; });
  std::vector<std::uint32_t> ranks(names.size());
  for (std::uint32_t i = 0; i < byRank.size(); ++i) ranks[byRank[i]] = i;
  return ranks;
}

std::vector<std::uint32_t> spacedSeeds(const WeldedMesh& welded, const std::vector<std::uint32_t>& byRank,
                                       std::uint32_t spacing) {
  std::vector<std::uint32_t> seeds;
  std::vector<std::uint32_t> nearest(byRank.size(), kFar);  // edges to the nearest seed, where fewer than spacing
  std::vector<std::uint32_t> front, next;
  for (const std::uint32_t seed : byRank) {
    if (nearest[seed] != kFar) continue;
    seeds.push_back(seed);
    nearest[seed] = 0;
    front.assign(1, seed);
    for (std::uint32_t distance = 1; distance < spacing && !front.empty(); ++distance) {
      next.clear();
      for (const std::uint32_t v : front) {
        for (const std::uint32_t u : welded.neighboursOf(v)) {
          if (nearest[u] <= distance) continue;
          nearest[u] = distance;
          next.push_back(u);
        }
      }
      front.swap(next);
    }
  }
  return seeds;
}

}  // namespace

std::vector<std::uint64_t> connectivityNames(const WeldedMesh& welded) {
  const std::uint32_t count = welded.vertexCount();
  std::vector<std::uint64_t> names(count), refined(count);
  for (std::uint32_t v = 0; v < count; ++v) names[v] = Random::mix(welded.neighboursOf(v).size());
  for (int round = 0; round < kRefinements; ++round) {
    for (std::uint32_t v = 0; v < count; ++v) {
      std::uint64_t sum = 0;
      for (const std::uint32_t u : welded.neighboursOf(v)) sum += Random::mix(names[u]);
      refined[v] = Random::mix(3 * names[v] + sum);
    }
    names.swap(refined);
  }
  return names;
}

std::vector<Patch> patchesOf(const WeldedMesh& welded, std::uint32_t spacing) {
  const std::vector<std::uint64_t> names = connectivityNames(welded);
  std::vector<std::uint32_t> byRank;
  const std::vector<std::uint32_t> ranks = ranksOf(names, byRank);
  const std::vector<std::uint32_t> seeds = spacedSeeds(welded, byRank, spacing);
  std::vector<Patch> patches(seeds.size());
  std::vector<std::uint32_t> patchOf(names.size(), kFar), front, next;
  for (std::uint32_t p = 0; p < seeds.size(); ++p) {
    patches[p].name = names[seeds[p]];
    patchOf[seeds[p]] = p;
    front.push_back(seeds[p]);
  }
  for (std::uint32_t ring = 0; !front.empty(); ++ring) {
    std::sort(front.begin(), front.end(), [&](std::uint32_t a, std::uint32_t b) { return ranks[a] < ranks[b]; });
    for (const std::uint32_t v : front) {
      patches[patchOf[v]].vertices.push_back(v);
      patches[patchOf[v]].rings.push_back(ring);
    }
    next.clear();
    for (const std::uint32_t v : front) {
      for (const std::uint32_t u : welded.neighboursOf(v)) {
        if (patchOf[u] == kFar) next.push_back(u);
      }
    }
    // All of a ring are reached at once: the lowest patch among a vertex's neighbours takes it.
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    std::vector<std::uint32_t> taken(next.size(), kFar);
    for (std::size_t i = 0; i < next.size(); ++i) {
      for (const std::uint32_t u : welded.neighboursOf(next[i])) taken[i] = std::min(taken[i], patchOf[u]);
    }
    for (std::size_t i = 0; i < next.size(); ++i) patchOf[next[i]] = taken[i];
    front.swap(next);
  }
  return patches;
}

}  // namespace quadmark::bench
