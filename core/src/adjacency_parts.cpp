// SPDX-License-Identifier: MIT
// Welded meshes made of other ones: connected components, and seams that quantization has split closed again.
#include <algorithm>
#include <cmath>

#include "quadmark/adjacency.h"
#include "sorting.h"

namespace quadmark {
namespace {

// @param numberOf  new vertex per vertex, or kNoVertex for those that are left out.
// @param members   the vertices that are not, those with one number in a row, numbers ascending.
// @param origin    per new vertex the one whose position it gets.
WeldedMesh regroup(const WeldedMesh& welded, const std::vector<std::uint32_t>& numberOf,
                   const std::vector<std::uint32_t>& members, const std::vector<std::uint32_t>& origin) {
  WeldedMesh out;
  std::size_t next = 0;
  for (std::uint32_t number = 0; number < origin.size(); ++number) {
    const double* p = &welded.positions[3 * std::size_t{origin[number]}];
    out.positions.insert(out.positions.end(), p, p + 3);
    if (!welded.halfStep.empty()) out.halfStep.push_back(welded.halfStep[origin[number]]);
    const std::size_t begin = out.neighbours.size();
    out.edgeOffsets.push_back(static_cast<std::uint32_t>(begin));
    for (; next < members.size() && numberOf[members[next]] == number; ++next)
      for (std::uint32_t w : welded.neighboursOf(members[next]))
        if (numberOf[w] != kNoVertex && numberOf[w] != number) out.neighbours.push_back(numberOf[w]);
    const auto first = out.neighbours.begin() + static_cast<std::ptrdiff_t>(begin);
    sortShort(first, out.neighbours.end());
    out.neighbours.erase(std::unique(first, out.neighbours.end()), out.neighbours.end());
  }
  out.edgeOffsets.push_back(static_cast<std::uint32_t>(out.neighbours.size()));
  return out;
}

constexpr double kSeamRel = 5e-4;       // of the diagonal: what 11 bits may part
constexpr double kSeamEdge2 = 1.0 / 16;  // and at most a quarter of the shortest edge nearby, squared
constexpr std::size_t kMostPerCell = 64;  // in a cell with more of them nothing is a twin

class SeamFinder {
 public:
  explicit SeamFinder(const WeldedMesh& welded) : welded_(welded), leader_(welded.vertexCount()) {
    for (std::uint32_t v = 0; v < leader_.size(); ++v) leader_[v] = v;
  }

  // The leader of each vertex: one per cluster of near vertices.
  std::vector<std::uint32_t> run() {
    const std::uint32_t count = welded_.vertexCount();
    if (count == 0) return leader_;
    double low[3] = {0, 0, 0}, side2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
      double least = at(0)[axis], most = least;
      for (std::uint32_t v = 0; v < count; ++v) least = std::min(least, at(v)[axis]), most = std::max(most, at(v)[axis]);
      low[axis] = least;
      side2 += (most - least) * (most - least);
    }
    reach_ = kSeamRel * std::sqrt(side2);
    if (!(reach_ > 0) || !std::isfinite(reach_)) return leader_;
    cells_.reserve(count);
    for (std::uint32_t v = 0; v < count; ++v) {
      std::uint64_t key = 0;
      for (int axis = 0; axis < 3; ++axis)
        key = key << 16 | (static_cast<std::uint64_t>((at(v)[axis] - low[axis]) / reach_) + 1);
      cells_.push_back({key, v});
    }
    sortByKey(cells_);
    for (std::size_t begin = 0, end = 0; begin < cells_.size(); begin = end) {
      while (end < cells_.size() && cells_[end].key == cells_[begin].key) ++end;
      if (end - begin > kMostPerCell) continue;
      for (int x = 0; x <= 1; ++x)  // each pair of neighbouring cells once
        for (int y = x == 0 ? 0 : -1; y <= 1; ++y)
          for (int z = x == 0 && y == 0 ? 0 : -1; z <= 1; ++z)
            compare(begin, end, cells_[begin].key + (static_cast<std::uint64_t>(std::int64_t{x}) << 32) +
                                    (static_cast<std::uint64_t>(std::int64_t{y}) << 16) + static_cast<std::uint64_t>(std::int64_t{z}));
    }
    for (std::uint32_t v = 0; v < count; ++v) leader_[v] = find(v);
    return leader_;
  }

 private:
  [[nodiscard]] const double* at(std::uint32_t v) const { return &welded_.positions[3 * std::size_t{v}]; }

  [[nodiscard]] double distance2(std::uint32_t v, std::uint32_t w) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) sum += (at(v)[axis] - at(w)[axis]) * (at(v)[axis] - at(w)[axis]);
    return sum;
  }

  [[nodiscard]] double shortestEdge2(std::uint32_t v) const {
    double shortest = 0;
    for (std::uint32_t w : welded_.neighboursOf(v)) {
      const double length2 = distance2(v, w);
      if (shortest == 0 || length2 < shortest) shortest = length2;
    }
    return shortest;
  }

  void compare(std::size_t begin, std::size_t end, std::uint64_t key) {
    auto other = std::lower_bound(cells_.begin(), cells_.end(), key,
                                  [](const KeyedIndex& e, std::uint64_t k) { return e.key < k; });
    const auto first = other;
    while (other != cells_.end() && other->key == key) ++other;
    if (static_cast<std::size_t>(other - first) > kMostPerCell) return;
    for (std::size_t i = begin; i < end; ++i)
      for (auto j = first; j != other; ++j)
        if (cells_[i].index != j->index && areTwins(cells_[i].index, j->index)) join(cells_[i].index, j->index);
  }

  [[nodiscard]] bool areTwins(std::uint32_t v, std::uint32_t w) const {
    const double d2 = distance2(v, w);
    if (d2 > reach_ * reach_ || d2 > kSeamEdge2 * shortestEdge2(v) || d2 > kSeamEdge2 * shortestEdge2(w)) return false;
    const auto around = welded_.neighboursOf(v);
    return !std::binary_search(around.begin(), around.end(), w);
  }

  std::uint32_t find(std::uint32_t v) {
    while (leader_[v] != v) v = leader_[v] = leader_[leader_[v]];
    return v;
  }

  // The leader is the first by position, so that it does not depend on numbers.
  void join(std::uint32_t v, std::uint32_t w) {
    v = find(v), w = find(w);
    if (v == w) return;
    if (std::lexicographical_compare(at(w), at(w) + 3, at(v), at(v) + 3)) std::swap(v, w);
    leader_[w] = v;
  }

  const WeldedMesh& welded_;
  std::vector<std::uint32_t> leader_;
  std::vector<KeyedIndex> cells_;
  double reach_ = 0;
};

}  // namespace

std::vector<std::uint32_t> components(const WeldedMesh& welded, std::uint32_t& count) {
  std::vector<std::uint32_t> componentOf(welded.vertexCount(), kNoVertex), stack;
  count = 0;
  for (std::uint32_t start = 0; start < welded.vertexCount(); ++start) {
    if (componentOf[start] != kNoVertex) continue;
    componentOf[start] = count;
    stack.assign(1, start);
    while (!stack.empty()) {
      const std::uint32_t v = stack.back();
      stack.pop_back();
      for (std::uint32_t w : welded.neighboursOf(v))
        if (componentOf[w] == kNoVertex) componentOf[w] = count, stack.push_back(w);
    }
    ++count;
  }
  return componentOf;
}

WeldedMesh subMesh(const WeldedMesh& welded, const std::vector<std::uint32_t>& vertices) {
  std::vector<std::uint32_t> numberOf(welded.vertexCount(), kNoVertex);
  for (std::uint32_t number = 0; number < vertices.size(); ++number) numberOf[vertices[number]] = number;
  return regroup(welded, numberOf, vertices, vertices);
}

WeldedMesh closeSeams(const WeldedMesh& welded, std::vector<std::uint32_t>& origin) {
  const std::vector<std::uint32_t> leader = SeamFinder(welded).run();
  origin.clear();
  std::vector<std::uint32_t> numberOf(welded.vertexCount(), kNoVertex), members(welded.vertexCount());
  for (std::uint32_t v = 0; v < leader.size(); ++v) {
    if (leader[v] != v) continue;
    numberOf[v] = static_cast<std::uint32_t>(origin.size());
    origin.push_back(v);
  }
  for (std::uint32_t v = 0; v < leader.size(); ++v) numberOf[v] = numberOf[leader[v]];
  std::vector<std::uint32_t> cursor(origin.size() + 1, 0);
  for (std::uint32_t number : numberOf) ++cursor[number + 1];
  for (std::size_t number = 1; number < cursor.size(); ++number) cursor[number] += cursor[number - 1];
  for (std::uint32_t v = 0; v < leader.size(); ++v) members[cursor[numberOf[v]]++] = v;
  return regroup(welded, numberOf, members, origin);
}

}  // namespace quadmark
