// SPDX-License-Identifier: MIT
// The decoder's enumeration of coplanar sets: all of them, so that nothing depends on the order of the vertices.
#include <cmath>
#include <memory>
#include <utility>

#include "quadmark/cells.h"
#include "ring_sets.h"

namespace quadmark {
namespace {

// A set is seen from several seeds. Chains by lowest vertex find the repeats without sorting or hashing all sets.
class UniqueSets {
 public:
  explicit UniqueSets(std::uint32_t vertices) : head_(vertices, kNone) {}

  // Expects ids sorted ascending; true the first time.
  bool insert(const std::uint32_t ids[4]) {
    std::uint32_t& head = head_[ids[0]];
    for (std::uint32_t at = head; at != kNone;) {
      const Entry& e = entry(at);
      if (e.id[0] == ids[1] && e.id[1] == ids[2] && e.id[2] == ids[3]) return false;
      at = e.next;
    }
    if (count_ % kBlock == 0) blocks_.push_back(std::make_unique<Entry[]>(kBlock));
    entry(count_) = {{ids[1], ids[2], ids[3]}, head};
    head = count_++;
    return true;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu, kBlock = 1u << 12;
  struct Entry {
    std::uint32_t id[3];
    std::uint32_t next;
  };
  [[nodiscard]] Entry& entry(std::uint32_t index) { return blocks_[index / kBlock][index % kBlock]; }

  std::vector<std::uint32_t> head_;
  std::uint32_t count_ = 0;
  std::vector<std::unique_ptr<Entry[]>> blocks_;  ///< a growing vector would copy them all, and hold them twice
};

void sortFour(std::uint32_t ids[4]) {
  const auto order = [&](int i, int j) {
    if (ids[j] < ids[i]) std::swap(ids[i], ids[j]);
  };
  order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
}

}  // namespace

bool haveOneOwner(const std::uint32_t ids[4], const std::vector<std::uint32_t>& ownerOf) {
  const std::uint32_t owner = ownerOf[ids[0]];
  return owner != kNoVertex && ownerOf[ids[1]] == owner && ownerOf[ids[2]] == owner && ownerOf[ids[3]] == owner;
}

double Rounding::unit(const double* const points[4], double longerDiagonal, double gridHalfStep) const {
  double magnitude = 0;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) magnitude = std::max(magnitude, std::fabs(points[i][k]));
  return std::max(std::max(relative * magnitude, 1e-8 * longerDiagonal), gridHalfStep);
}

double Rounding::unit(const Quad& quad, const double* positions) const {
  const std::uint32_t ids[4] = {quad.a, quad.b, quad.c, quad.d};
  const double* points[4];
  for (int i = 0; i < 4; ++i) points[i] = positions + 3 * std::size_t{ids[i]};
  double gridHalfStep = 0;
  for (const std::uint32_t vertex : ids) gridHalfStep = std::max(gridHalfStep, halfStepOf(vertex));
  return unit(points, quad.longerDiagonal(), gridHalfStep);
}

Rounding roundingOf(Precision precision) {
  return {precision == Precision::float32 ? 1.0 / (1u << 24) : 1.0 / (1ull << 53), {}};
}

Rounding roundingOf(Precision precision, const WeldedMesh& welded) {
  Rounding rounding = roundingOf(precision);
  rounding.halfStep = welded.halfStep;
  return rounding;
}

void keepNearest(std::vector<std::uint32_t>& members, std::uint32_t seed, const double* positions, std::size_t limit) {
  if (members.size() <= limit) return;
  struct Ranked {
    double distance2;
    const double* p;
    std::uint32_t vertex;
  };
  const double* o = positions + 3 * std::size_t{seed};
  std::vector<Ranked> ranked;
  ranked.reserve(members.size());
  for (std::uint32_t w : members) {
    const double* p = positions + 3 * std::size_t{w};
    const double x = p[0] - o[0], y = p[1] - o[1], z = p[2] - o[2];
    ranked.push_back({x * x + y * y + z * z, p, w});
  }
  const auto nearer = [](const Ranked& a, const Ranked& b) {
    if (a.distance2 != b.distance2) return a.distance2 < b.distance2;
    for (int k = 0; k < 3; ++k)
      if (a.p[k] != b.p[k]) return a.p[k] < b.p[k];
    return a.vertex < b.vertex;  // equal positions in different seam groups
  };
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(limit), ranked.end(), nearer);
  members.clear();
  for (std::size_t i = 0; i < limit; ++i) members.push_back(ranked[i].vertex);
}

void forEachCoplanarSet(const WeldedMesh& welded, const std::vector<double>& positions, int k, const Rounding& rounding,
                        const GapLimit& limit, const std::vector<std::uint8_t>& skip,
                        const std::function<void(const Quad&)>& visit, const std::vector<std::uint32_t>* seeds,
                        const std::vector<std::uint32_t>* ownerOf) {
  const std::size_t count = seeds != nullptr ? seeds->size() : welded.vertexCount();
  UniqueSets unique(welded.vertexCount());
  std::vector<std::uint32_t> members;
  RingSets ring;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t v = seeds != nullptr ? (*seeds)[i] : static_cast<std::uint32_t>(i);
    if (!neighbourhood(welded, v, k, members)) continue;
    if (!skip.empty()) std::erase_if(members, [&](std::uint32_t w) { return skip[w] != 0; });
    if (members.size() < 4) continue;
    keepNearest(members, v, positions.data(), kMaxMembersReading);
    ring.load(members, v, positions.data(), false);

    // Cheap test first: gap = |determinant| / |e x f|, and two chords of a ball of radius R span at most (2 R)^2.
    const double radius2 = ring.radius2();
    const double longest = 2 * std::sqrt(radius2);
    double unit = std::max(rounding.relative * ring.magnitude(), 1e-8 * longest);
    if (!rounding.halfStep.empty())
      for (std::uint32_t w : members) unit = std::max(unit, rounding.halfStep[w]);
    const double reach = std::min(limit.units * unit, std::max(kExactUnits * unit, limit.relative * longest));
    const double largest = 1.0001 * reach * 4 * radius2;
    ring.forEach(largest, [&](int a, int b, int c, int d, double determinant) {
      // Then with the set's own size instead of the ball's. On fine meshes, whose triangles are hardly larger than the
      // rounding unit, this spares three of four sets the search among those seen before.
      if (determinant * determinant > 4.001 * reach * reach * ring.largestNormal2(a, b, c, d)) return;
      std::uint32_t ids[4] = {ring.vertex(a), ring.vertex(b), ring.vertex(c), ring.vertex(d)};
      if (ownerOf != nullptr && haveOneOwner(ids, *ownerOf)) return;
      sortFour(ids);
      if (!unique.insert(ids)) return;  // cheaper than the geometry, and a cell is seen from four seeds on average
      Quad quad;
      if (makeQuad(ids, positions.data(), kMinTriangleReading, quad) &&
          limit.admits(quad, rounding.unit(quad, positions.data())))
        visit(quad);
    });
  }
}

}  // namespace quadmark
