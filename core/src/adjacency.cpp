// SPDX-License-Identifier: MIT
#include "quadmark/adjacency.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "sorting.h"

namespace quadmark {
namespace {

std::uint64_t bitsOf(double value) {
  value = value == 0 ? 0.0 : value;  // -0 and +0 are one position
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93u;
  x ^= x >> 32;
  return x;
}

std::uint64_t hashPosition(const double* p, std::uint32_t group) {
  return mix(bitsOf(p[0]) + mix(bitsOf(p[1]) * 3 + mix(bitsOf(p[2]) * 5 + group)));
}

std::vector<std::uint8_t> referencedVertices(const Mesh& mesh) {
  std::vector<std::uint8_t> used(mesh.vertexCount(), 0);
  for (std::uint32_t v : mesh.faceVertices) used[v] = 1;
  return used;
}

// Open addressing over vertex indices: 4 bytes a slot, so two million vertices need 16 MB. That is far beyond any
// cache, so callers that know what comes ask for its slot early.
class PositionTable {
 public:
  explicit PositionTable(std::size_t count) {
    std::size_t capacity = 16;
    while (capacity < 2 * count) capacity *= 2;
    slots_.assign(capacity, kNoVertex);
  }

  /// How many positions ahead of enter() a caller should call expect().
  static constexpr std::size_t kAhead = 12;

  void expect(const double* p, std::uint32_t group) const {
    __builtin_prefetch(&slots_[hashPosition(p, group) & (slots_.size() - 1)]);
  }

  // The number under which an equal position of the group stands; `number` after entering it, if there was none.
  template <class PositionOf, class GroupOf>
  std::uint32_t enter(const double* p, std::uint32_t group, std::uint32_t number, const PositionOf& positionOf,
                      const GroupOf& groupOf) {
    std::size_t slot = hashPosition(p, group) & (slots_.size() - 1);
    for (; slots_[slot] != kNoVertex; slot = (slot + 1) & (slots_.size() - 1)) {
      const double* q = positionOf(slots_[slot]);
      if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2] && groupOf(slots_[slot]) == group) return slots_[slot];
    }
    slots_[slot] = number;
    return number;
  }

 private:
  std::vector<std::uint32_t> slots_;
};

void weldPositions(const Mesh& mesh, WeldedMesh& out) {
  const std::size_t count = mesh.vertexCount();
  const std::vector<std::uint8_t> used = referencedVertices(mesh);
  PositionTable table(count);
  out.weldedOf.assign(count, kNoVertex);
  out.positions.reserve(3 * count);
  std::vector<std::uint32_t> weldedGroup;
  const bool grouped = !mesh.groups.empty();
  const auto groupOf = [&](std::size_t v) { return grouped ? mesh.groups[v] : 0; };
  for (std::size_t v = 0; v < count; ++v) {
    if (const std::size_t next = v + PositionTable::kAhead; next < count)
      table.expect(&mesh.positions[3 * next], groupOf(next));
    if (!used[v]) continue;
    const double* p = &mesh.positions[3 * v];
    const std::uint32_t group = groupOf(v);
    const auto next = static_cast<std::uint32_t>(out.positions.size() / 3);
    out.weldedOf[v] = table.enter(
        p, group, next, [&](std::uint32_t w) { return &out.positions[3 * std::size_t{w}]; },
        [&](std::uint32_t w) { return grouped ? weldedGroup[w] : 0; });
    if (out.weldedOf[v] != next) continue;
    out.positions.insert(out.positions.end(), p, p + 3);
    if (grouped) weldedGroup.push_back(group);
  }
  out.positions.shrink_to_fit();
}

// Twins move together, so what they can become is what the grids of all of them can store.
void weldGrids(const Mesh& mesh, WeldedMesh& out) {
  if (mesh.gridOf.empty()) return;
  constexpr std::uint8_t kUnknown = 254;
  out.gridOf.assign(out.vertexCount(), kUnknown);
  out.halfStep.assign(out.vertexCount(), 0);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const std::uint32_t w = out.weldedOf[v];
    if (w == kNoVertex) continue;
    const CoordinateGrid* grid = mesh.grid(v);
    std::uint8_t& found = out.gridOf[w];
    const bool differs = found != kUnknown && found != mesh.gridOf[v];
    found = differs || (grid != nullptr && grid->low == grid->high) ? kFixed : mesh.gridOf[v];
    if (grid != nullptr) out.halfStep[w] = std::max(out.halfStep[w], 0.5 * grid->step());
  }
}

template <class Visit>
void forEachEdge(const Mesh& mesh, const WeldedMesh& welded, const Visit& visit) {
  const std::size_t faces = mesh.faceCount();
  for (std::size_t f = 0; f < faces; ++f) {
    const std::size_t begin = mesh.faceBegin(f), end = mesh.faceEnd(f);
    if (begin == end) continue;
    std::uint32_t a = welded.weldedOf[mesh.faceVertices[end - 1]];
    for (std::size_t corner = begin; corner < end; ++corner) {
      const std::uint32_t b = welded.weldedOf[mesh.faceVertices[corner]];
      if (a != b) visit(a, b);
      a = b;
    }
  }
}

// Turns degrees into where the lists begin. Returns their length in all.
std::uint32_t beginLists(std::vector<std::uint32_t>& degrees) {
  std::uint32_t total = 0;
  for (std::uint32_t& entry : degrees) {
    const std::uint32_t degree = entry;
    entry = total;
    total += degree;
  }
  return total;
}

// Faces enter their edges the way they run. Where two faces with one orientation share an edge, that is both ways
// already, so on closed surfaces the lists are complete, and half as long as if every face entered both; borders and
// faces that are turned round are made up for afterwards.
void collectEdges(const Mesh& mesh, WeldedMesh& out) {
  const std::size_t count = out.positions.size() / 3;
  std::vector<std::uint32_t> cursor(count + 1, 0);
  std::vector<std::uint32_t>&offsets = out.edgeOffsets, &lists = out.neighbours;
  forEachEdge(mesh, out, [&](std::uint32_t a, std::uint32_t) { ++cursor[a]; });
  lists.resize(beginLists(cursor));
  offsets = cursor;
  forEachEdge(mesh, out, [&](std::uint32_t a, std::uint32_t b) { lists[cursor[a]++] = b; });
  std::uint32_t write = 0;
  for (std::size_t v = 0; v < count; ++v) {  // in place: sorted, and nothing twice
    std::uint32_t *begin = lists.data() + offsets[v], *end = lists.data() + offsets[v + 1];
    sortShort(begin, end);
    offsets[v] = write;
    write = static_cast<std::uint32_t>(std::unique_copy(begin, end, lists.data() + write) - lists.data());
  }
  offsets[count] = write;
  lists.resize(write);

  // Edges a -> b without a way back. As a ascends, so do the entries of b's list that it is looked for in.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> oneWay;
  cursor = offsets;
  for (std::uint32_t a = 0; a < count; ++a)
    for (const std::uint32_t b : out.neighboursOf(a)) {
      std::uint32_t& at = cursor[b];
      while (at < offsets[b + 1] && lists[at] < a) ++at;
      if (at == offsets[b + 1] || lists[at] != a) oneWay.emplace_back(a, b);
    }
  if (!oneWay.empty()) {
    std::fill(cursor.begin(), cursor.end(), 0u);
    for (const auto& [a, b] : oneWay) ++cursor[b];
    for (std::size_t v = 0; v < count; ++v) cursor[v] += offsets[v + 1] - offsets[v];
    std::vector<std::uint32_t> all(beginLists(cursor)), begins = cursor;
    for (std::uint32_t v = 0; v < count; ++v)
      for (const std::uint32_t w : out.neighboursOf(v)) all[cursor[v]++] = w;
    for (const auto& [a, b] : oneWay) all[cursor[b]++] = a;
    for (std::size_t v = 0; v < count; ++v)
      if (begins[v + 1] - begins[v] > offsets[v + 1] - offsets[v])
        sortShort(all.data() + begins[v], all.data() + begins[v + 1]);
    offsets.swap(begins);
    lists.swap(all);
  }
  lists.shrink_to_fit();
}

}  // namespace

WeldedMesh weldVertices(const Mesh& mesh) {
  WeldedMesh out;
  weldPositions(mesh, out);
  return out;
}

WeldedMesh weld(const Mesh& mesh) {
  WeldedMesh out = weldVertices(mesh);
  collectEdges(mesh, out);
  weldGrids(mesh, out);
  return out;
}

bool hasTwins(const std::vector<double>& positions, const std::vector<std::uint32_t>& groups) {
  const std::size_t count = positions.size() / 3;
  PositionTable table(count);
  const auto groupOf = [&](std::size_t w) { return groups.empty() ? 0 : groups[w]; };
  for (std::size_t v = 0; v < count; ++v) {
    if (const std::size_t next = v + PositionTable::kAhead; next < count)
      table.expect(&positions[3 * next], groupOf(next));
    const auto number = static_cast<std::uint32_t>(v);
    if (table.enter(&positions[3 * v], groupOf(number), number,
                    [&](std::uint32_t w) { return &positions[3 * std::size_t{w}]; }, groupOf) != number)
      return true;
  }
  return false;
}

FaceRings faceRings(const Mesh& mesh, const std::vector<std::uint32_t>& weldedOf, std::uint32_t count) {
  FaceRings out;
  const std::size_t faces = mesh.faceCount();
  out.offsets.assign(count + std::size_t{1}, 0);
  const auto forEachCorner = [&](const auto& visit) {
    for (std::size_t f = 0; f < faces; ++f)
      for (std::size_t c = mesh.faceBegin(f); c < mesh.faceEnd(f); ++c) {
        const std::uint32_t w = weldedOf[mesh.faceVertices[c]];
        // A degenerate face may visit a vertex twice. Only a short way back: a repeat costs a little time, never a
        // wrong answer, and a hostile million-gon must not cost a quadratic scan.
        bool repeated = false;
        for (std::size_t e = std::max(mesh.faceBegin(f), c < 8 ? std::size_t{0} : c - 8); e < c && !repeated; ++e)
          repeated = weldedOf[mesh.faceVertices[e]] == w;
        if (!repeated) visit(w, static_cast<std::uint32_t>(f));
      }
  };
  forEachCorner([&](std::uint32_t w, std::uint32_t) { ++out.offsets[w]; });
  out.faces.resize(beginLists(out.offsets));
  forEachCorner([&](std::uint32_t w, std::uint32_t f) { out.faces[out.offsets[w]++] = f; });
  for (std::size_t v = count; v > 0; --v) out.offsets[v] = out.offsets[v - 1];  // undo the cursor's advance
  out.offsets[0] = 0;
  return out;
}

bool neighbourhood(const WeldedMesh& welded, std::uint32_t vertex, int k, std::vector<std::uint32_t>& out) {
  out.clear();
  out.push_back(vertex);
  std::size_t ringBegin = 0;
  for (int ring = 0; ring < k; ++ring) {
    const auto ringEnd = static_cast<std::ptrdiff_t>(out.size());
    for (std::size_t i = ringBegin; i < static_cast<std::size_t>(ringEnd); ++i) {
      const auto next = welded.neighboursOf(out[i]);
      if (ring > 0 && out.size() + next.size() > kMaxNeighbourhood) return false;
      out.insert(out.end(), next.begin(), next.end());
    }
    if (ring > 0) {  // the first ring is unique by construction
      std::sort(out.begin() + ringEnd, out.end());
      auto last = std::unique(out.begin() + ringEnd, out.end());
      last = std::remove_if(out.begin() + ringEnd, last, [&](std::uint32_t v) {
        return std::find(out.begin(), out.begin() + ringEnd, v) != out.begin() + ringEnd;
      });
      out.erase(last, out.end());
    }
    ringBegin = static_cast<std::size_t>(ringEnd);
  }
  return true;
}

}  // namespace quadmark
