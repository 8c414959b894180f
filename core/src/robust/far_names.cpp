// SPDX-License-Identifier: MIT
#include "far_names.h"

#include <algorithm>
#include <array>

#include "quadmark/random.h"

namespace quadmark::robust {
namespace {

constexpr std::size_t kNearest = 3;
// One irregular vertex among more than so many: a grid or a subdivision surface.
constexpr std::uint64_t kRegularModel = 100;

// The vertices along the sides of the faces around each one, most of them twice. (By FacesAround, a polygon of a million
// sides would be gone through at each of its corners.)
class Neighbours {
 public:
  explicit Neighbours(const Surface& surface) : offsets_(surface.vertexCount() + 1, 0), lists_(2 * surface.corners.size()) {
    for (const std::uint32_t v : surface.corners) offsets_[v + 1] += 2;
    for (std::size_t v = 1; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
    std::vector<std::uint32_t> cursor(offsets_.begin(), offsets_.end() - 1);
    for (std::uint32_t f = 0; f < surface.faceCount(); ++f) {
      const auto face = surface.face(f);
      std::uint32_t from = face.back();
      for (const std::uint32_t to : face) {
        lists_[cursor[from]++] = to;
        lists_[cursor[to]++] = from;
        from = to;
      }
    }
  }
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t vertex) const {
    return {lists_.data() + offsets_[vertex], offsets_[vertex + 1] - offsets_[vertex]};
  }

 private:
  std::vector<std::uint32_t> offsets_, lists_;
};

struct Arrival {
  std::uint32_t source = kNoVertex;
  std::uint32_t distance = 0;
};

// Breadth-first search from all sources at once; a vertex passes on the first kNearest sources that reach it. Which of
// several equally near ones those are depends on the order of vertices, how far they are does not.
void reachFrom(const std::vector<std::uint32_t>& sources, const Neighbours& neighbours,
               std::vector<std::array<Arrival, kNearest>>& reached) {
  struct Visit {
    std::uint32_t vertex, source;
  };
  std::vector<Visit> front, next;
  for (const std::uint32_t source : sources) front.push_back({source, source});
  for (std::uint32_t distance = 0; !front.empty(); ++distance) {
    next.clear();
    for (const Visit& visit : front) {
      auto& arrivals = reached[visit.vertex];
      std::size_t slot = 0;
      while (slot < kNearest && arrivals[slot].source != kNoVertex && arrivals[slot].source != visit.source) ++slot;
      if (slot == kNearest || arrivals[slot].source == visit.source) continue;
      arrivals[slot] = {visit.source, distance};
      for (const std::uint32_t n : neighbours.of(visit.vertex)) next.push_back({n, visit.source});
    }
    front.swap(next);
  }
}

// Two vertices of a grid that quantization made one are three irregular vertices beside each other, and would name half of
// the model anew; the corners of grids and the extraordinary vertices of subdivision surfaces stand alone.
std::vector<std::uint32_t> thoseAlone(const std::vector<std::uint32_t>& irregular, const Surface& surface,
                                      const Neighbours& neighbours) {
  std::vector<std::uint32_t> out;
  // Regular vertices have few neighbours, and others end the search: linear, whatever the mesh.
  const auto areRegularAround = [&](std::uint32_t v, std::uint32_t apart) {
    const auto around = neighbours.of(v);
    return std::all_of(around.begin(), around.end(),
                       [&](std::uint32_t n) { return n == apart || isRegular(surface, n); });
  };
  for (const std::uint32_t v : irregular) {
    const auto around = neighbours.of(v);
    if (!around.empty() && areRegularAround(v, v) &&
        std::all_of(around.begin(), around.end(), [&](std::uint32_t n) { return areRegularAround(n, v); }))
      out.push_back(v);
  }
  return out;
}

}  // namespace

bool isRegular(const Surface& surface, std::uint32_t vertex) {
  constexpr std::uint32_t kQuad = 1 + 32;
  const std::uint32_t corners = surface.cornerCounts[vertex];
  return surface.ring(vertex).empty() ? corners == 3 || corners == 2 * kQuad : corners == 6 || corners == 4 * kQuad;
}

std::vector<std::uint64_t> farNames(const Surface& surface) {
  const std::uint32_t count = surface.vertexCount();
  std::vector<std::uint32_t> irregular;
  for (std::uint32_t v = 0; v < count; ++v)
    if (!isRegular(surface, v)) irregular.push_back(v);
  if (10 * std::uint64_t{irregular.size()} > count) return {};
  const Neighbours neighbours(surface);
  std::vector<std::array<Arrival, kNearest>> reached(count);
  if (kRegularModel * irregular.size() < count)
    if (const std::vector<std::uint32_t> alone = thoseAlone(irregular, surface, neighbours); alone.size() >= kNearest)
      reachFrom(alone, neighbours, reached);
  // Components without a lone one: from what there is.
  irregular.erase(std::remove_if(irregular.begin(), irregular.end(),
                                 [&](std::uint32_t v) { return reached[v][0].source != kNoVertex; }),
                  irregular.end());
  reachFrom(irregular, neighbours, reached);
  std::vector<std::uint64_t> names(count);
  for (std::uint32_t v = 0; v < count; ++v) {
    std::uint64_t name = surface.cornerCounts[v];
    for (const Arrival& arrival : reached[v])
      name = Random::mix(name * 0x9e3779b97f4a7c15u + (arrival.source == kNoVertex ? 0 : arrival.distance + 1));
    names[v] = name;
  }
  return names;
}

}  // namespace quadmark::robust
