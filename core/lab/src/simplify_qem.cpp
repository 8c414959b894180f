// SPDX-License-Identifier: MIT
// M. Garland, P. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH 1997. Area-weighted quadrics,
// optimal placement, constraint planes at borders; edges wait in a heap whose outdated entries are dropped when they
// come up, which is simpler than moving them and costs about one extra entry per live one.
#include <algorithm>

#include "mesh_tools.h"
#include "quadric.h"

namespace quadmark::lab {
namespace {

/// Weight of a border's constraint plane against a face of the same size.
constexpr double kBorderWeight = 100;
/// Share of (edge length)^2 added to the error. It orders the collapses where the surface is flat and all errors are
/// rounding noise, and is far too small to matter elsewhere.
constexpr double kLengthShare = 1e-7;
/// A collapse may not turn a face's normal by more than about 78 degrees.
constexpr double kLeastNormalCosine = 0.2;
/// Nor leave a needle: twice the area below this share of the longest edge squared.
constexpr double kLeastFatness = 1e-3;

struct Candidate {
  double cost;
  std::uint32_t a, b;                // a < b
  std::uint32_t versionA, versionB;  // of the vertices when this was computed
};

/// A total order, so that the sequence of pops does not depend on how the heap is arranged inside. The heap keeps the
/// largest on top: this says "later".
bool later(const Candidate& p, const Candidate& q) {
  if (p.cost != q.cost) return p.cost > q.cost;
  if (p.a != q.a) return p.a > q.a;
  if (p.b != q.b) return p.b > q.b;
  if (p.versionA != q.versionA) return p.versionA > q.versionA;
  return p.versionB > q.versionB;
}

class Collapser {
 public:
  explicit Collapser(const Mesh& triangles);
  void run(double keep);
  [[nodiscard]] Mesh result() const;

 private:
  static constexpr std::uint32_t kNone = kNoVertex;

  void linkCorners();
  void addFaceQuadrics();
  void addConstraints();
  [[nodiscard]] Vec3 bestPlace(std::uint32_t a, std::uint32_t b, const Quadric& sum) const;
  void push(std::uint32_t a, std::uint32_t b);
  void gatherFaces(std::uint32_t v, std::vector<std::uint32_t>& faces);
  [[nodiscard]] bool topologyAllows(std::uint32_t a, std::uint32_t b);
  [[nodiscard]] bool keepsShape(std::uint32_t v, std::uint32_t other, const Vec3& place,
                                const std::vector<std::uint32_t>& faces) const;
  bool collapse(std::uint32_t a, std::uint32_t b);
  void dropIfLoose(std::uint32_t v);
  [[nodiscard]] bool contains(std::uint32_t face, std::uint32_t v) const {
    const std::uint32_t* c = &corners_[3 * std::size_t{face}];
    return c[0] == v || c[1] == v || c[2] == v;
  }

  const Mesh& mesh_;
  WeldedMesh welded_;
  Vec3 centre_;
  double size_ = 1;
  std::vector<Vec3> place_;  // centred, diagonal 1: keeps the quadrics' cancellation small
  std::vector<Quadric> quadric_;
  std::vector<std::uint32_t> version_;
  std::vector<std::uint8_t> alive_, moved_, special_;  // special: on an edge that has not exactly two faces
  std::size_t aliveCount_ = 0;
  std::vector<std::uint32_t> corners_;       // 3 per face; kNone in the first one of a removed face
  std::vector<std::uint32_t> first_, next_;  // per vertex its corners as a list
  std::vector<std::uint32_t> mark_;          // scratch for neighbour sets, compared with stamp_
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> facesA_, facesB_;  // scratch
  std::vector<std::pair<std::uint32_t, std::uint32_t>> opposite_;
  std::vector<Candidate> heap_;
};

Collapser::Collapser(const Mesh& triangles) : mesh_(triangles), welded_(weld(triangles)) {
  const std::size_t count = welded_.vertexCount();
  const Box box = boxOf(welded_.positions);
  centre_ = box.centre();
  const double diagonal = length(box.size());
  size_ = diagonal > 0 ? diagonal : 1;
  place_.resize(count);
  for (std::size_t v = 0; v < count; ++v) place_[v] = (1 / size_) * (at(welded_.positions, v) - centre_);
  quadric_.resize(count);
  version_.assign(count, 0);
  alive_.assign(count, 1);
  moved_.assign(count, 0);
  special_.assign(count, 0);
  mark_.assign(count, 0);
  aliveCount_ = count;
  for (std::size_t c = 0; c < triangles.faceVertices.size(); c += 3) {
    const std::uint32_t i = welded_.weldedOf[triangles.faceVertices[c]];
    const std::uint32_t j = welded_.weldedOf[triangles.faceVertices[c + 1]];
    const std::uint32_t k = welded_.weldedOf[triangles.faceVertices[c + 2]];
    if (i != j && j != k && k != i) corners_.insert(corners_.end(), {i, j, k});
  }
  linkCorners();
  addFaceQuadrics();
  addConstraints();
}

void Collapser::linkCorners() {
  first_.assign(alive_.size(), kNone);
  next_.assign(corners_.size(), kNone);
  for (std::size_t c = corners_.size(); c > 0; --c) {
    next_[c - 1] = first_[corners_[c - 1]];
    first_[corners_[c - 1]] = static_cast<std::uint32_t>(c - 1);
  }
}

void Collapser::addFaceQuadrics() {
  for (std::size_t c = 0; c < corners_.size(); c += 3) {
    const Vec3 p = place_[corners_[c]];
    const Vec3 area = cross(place_[corners_[c + 1]] - p, place_[corners_[c + 2]] - p);
    const double twice = length(area);
    if (!(twice > 0)) continue;
    const Vec3 normal = (1 / twice) * area;
    for (std::size_t i = 0; i < 3; ++i) quadric_[corners_[c + i]].addPlane(normal, -dot(normal, p), 0.5 * twice);
  }
}

void Collapser::addConstraints() {
  // Faces per edge, at the edge's place in the list of its lower end.
  const auto placeOf = [&](std::uint32_t a, std::uint32_t b) {
    const auto list = welded_.neighboursOf(std::min(a, b));
    const auto found = std::lower_bound(list.begin(), list.end(), std::max(a, b)) - list.begin();
    return welded_.edgeOffsets[std::min(a, b)] + static_cast<std::size_t>(found);
  };
  std::vector<std::uint8_t> faces(welded_.neighbours.size(), 0);
  const auto forEachEdge = [&](const auto& visit) {
    for (std::size_t c = 0; c < corners_.size(); ++c)
      visit(corners_[c], corners_[c % 3 == 2 ? c - 2 : c + 1], c - c % 3);
  };
  forEachEdge([&](std::uint32_t a, std::uint32_t b, std::size_t) {
    std::uint8_t& count = faces[placeOf(a, b)];
    if (count < 3) ++count;
  });
  forEachEdge([&](std::uint32_t a, std::uint32_t b, std::size_t face) {
    if (faces[placeOf(a, b)] == 2) return;
    special_[a] = special_[b] = 1;
    const Vec3 p = place_[a], edge = place_[b] - p;
    const Vec3 normal = normalized(cross(edge, cross(place_[corners_[face + 1]] - place_[corners_[face]],
                                                     place_[corners_[face + 2]] - place_[corners_[face]])));
    if (!(dot(normal, normal) > 0)) return;
    for (std::uint32_t v : {a, b}) quadric_[v].addPlane(normal, -dot(normal, p), kBorderWeight * dot(edge, edge));
  });
}

Vec3 Collapser::bestPlace(std::uint32_t a, std::uint32_t b, const Quadric& sum) const {
  const Vec3 pa = place_[a], edge = place_[b] - pa, middle = pa + 0.5 * edge;
  Vec3 best;
  if (sum.minimum(best)) {
    const Vec3 away = best - middle;
    if (dot(away, away) <= 4 * dot(edge, edge)) return best;  // an ill-conditioned minimum lies far off
  }
  const Vec3 slope = sum.timesA(edge);
  const double curvature = dot(edge, slope);
  if (curvature > 1e-12 * sum.weight * dot(edge, edge)) {
    const double t = -(dot(slope, pa) + sum.x * edge.x + sum.y * edge.y + sum.z * edge.z) / curvature;
    return pa + std::min(1.0, std::max(0.0, t)) * edge;
  }
  return middle;
}

void Collapser::push(std::uint32_t a, std::uint32_t b) {
  if (a > b) std::swap(a, b);
  Quadric sum = quadric_[a];
  sum += quadric_[b];
  const Vec3 edge = place_[b] - place_[a];
  const double cost = std::max(0.0, sum.at(bestPlace(a, b, sum))) + kLengthShare * sum.weight * dot(edge, edge);
  heap_.push_back({cost, a, b, version_[a], version_[b]});
}

/// Lists the living faces of v and unlinks the dead ones.
void Collapser::gatherFaces(std::uint32_t v, std::vector<std::uint32_t>& faces) {
  faces.clear();
  std::uint32_t* link = &first_[v];
  while (*link != kNone) {
    const std::uint32_t face = *link / 3;
    if (corners_[3 * std::size_t{face}] == kNone) {
      *link = next_[*link];
    } else {
      faces.push_back(face);
      link = &next_[*link];
    }
  }
}

/// The link condition: what a and b have in common must be exactly what their edge's faces have.
bool Collapser::topologyAllows(std::uint32_t a, std::uint32_t b) {
  if (stamp_ > 0xfffffff0u) {
    std::fill(mark_.begin(), mark_.end(), 0u);
    stamp_ = 0;
  }
  const std::uint32_t ofA = ++stamp_, common = ++stamp_;
  std::size_t shared = 0, commonCount = 0;
  for (std::uint32_t face : facesA_) {
    shared += contains(face, b);
    for (std::size_t i = 0; i < 3; ++i) mark_[corners_[3 * std::size_t{face} + i]] = ofA;
  }
  mark_[a] = mark_[b] = 0;
  for (std::uint32_t face : facesB_)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = corners_[3 * std::size_t{face} + i];
      if (mark_[v] != ofA) continue;
      mark_[v] = common;
      ++commonCount;
    }
  if (shared == 0 || commonCount != shared) return false;
  if (special_[a] && special_[b] && shared == 2) return false;  // would pinch two borders together
  // A face of a and one of b over the same opposite edge would fall onto each other (a tetrahedron's end).
  opposite_.clear();
  const auto oppositeEdge = [&](std::uint32_t face, std::uint32_t v, std::pair<std::uint32_t, std::uint32_t>& edge) {
    const std::uint32_t* c = &corners_[3 * std::size_t{face}];
    edge = c[0] == v ? std::pair{c[1], c[2]} : c[1] == v ? std::pair{c[2], c[0]} : std::pair{c[0], c[1]};
    if (edge.first > edge.second) std::swap(edge.first, edge.second);
    return mark_[edge.first] == common && mark_[edge.second] == common;
  };
  std::pair<std::uint32_t, std::uint32_t> edge;
  for (std::uint32_t face : facesA_)
    if (oppositeEdge(face, a, edge)) opposite_.push_back(edge);
  if (opposite_.empty()) return true;
  std::sort(opposite_.begin(), opposite_.end());
  for (std::uint32_t face : facesB_)
    if (oppositeEdge(face, b, edge) && std::binary_search(opposite_.begin(), opposite_.end(), edge)) return false;
  return true;
}

bool Collapser::keepsShape(std::uint32_t v, std::uint32_t other, const Vec3& place,
                           const std::vector<std::uint32_t>& faces) const {
  for (std::uint32_t face : faces) {
    if (contains(face, other)) continue;
    const std::uint32_t* c = &corners_[3 * std::size_t{face}];
    const std::size_t i = c[0] == v ? 0 : c[1] == v ? 1 : 2;
    const Vec3 q = place_[c[(i + 1) % 3]], r = place_[c[(i + 2) % 3]];
    const Vec3 before = cross(q - place_[v], r - place_[v]), after = cross(q - place, r - place);
    const double lengthBefore = length(before), lengthAfter = length(after);
    if (dot(before, after) < kLeastNormalCosine * lengthBefore * lengthAfter) return false;
    const auto longest = [&](const Vec3& p) {
      return std::max({dot(q - p, q - p), dot(r - p, r - p), dot(r - q, r - q)});
    };
    // A face that was a needle already may stay one.
    if (lengthAfter < kLeastFatness * longest(place) && lengthBefore >= kLeastFatness * longest(place_[v]))
      return false;
  }
  return true;
}

bool Collapser::collapse(std::uint32_t a, std::uint32_t b) {
  gatherFaces(a, facesA_);
  gatherFaces(b, facesB_);
  if (!topologyAllows(a, b)) return false;
  Quadric sum = quadric_[a];
  sum += quadric_[b];
  const Vec3 place = bestPlace(a, b, sum);
  if (!keepsShape(a, b, place, facesA_) || !keepsShape(b, a, place, facesB_)) return false;

  place_[a] = place;
  quadric_[a] = sum;
  moved_[a] = 1;
  special_[a] |= special_[b];
  alive_[b] = 0;
  --aliveCount_;
  ++version_[a];
  // b's corners go to the front of a's list; faces with both ends die.
  std::vector<std::uint32_t>& thirds = facesB_;
  std::uint32_t corner = first_[b];
  thirds.clear();
  while (corner != kNone) {
    const std::uint32_t following = next_[corner], face = corner / 3;
    std::uint32_t* c = &corners_[3 * std::size_t{face}];
    if (c[0] != kNone) {
      if (contains(face, a)) {
        for (std::size_t i = 0; i < 3; ++i)
          if (c[i] != a && c[i] != b) thirds.push_back(c[i]);
        c[0] = kNone;
      } else {
        corners_[corner] = a;
        next_[corner] = first_[a];
        first_[a] = corner;
      }
    }
    corner = following;
  }
  for (std::uint32_t v : thirds) dropIfLoose(v);
  dropIfLoose(a);
  if (!alive_[a]) return true;

  gatherFaces(a, facesA_);
  const std::uint32_t seen = ++stamp_;
  mark_[a] = seen;
  for (std::uint32_t face : facesA_)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = corners_[3 * std::size_t{face} + i];
      if (mark_[v] == seen) continue;
      mark_[v] = seen;
      push(a, v);
      std::push_heap(heap_.begin(), heap_.end(), later);
    }
  return true;
}

void Collapser::dropIfLoose(std::uint32_t v) {
  while (first_[v] != kNone && corners_[first_[v] - first_[v] % 3] == kNone) first_[v] = next_[first_[v]];
  if (first_[v] != kNone || !alive_[v]) return;
  alive_[v] = 0;
  --aliveCount_;
}

void Collapser::run(double keep) {
  const std::size_t target = shareOf(keep, welded_.vertexCount());
  for (std::uint32_t v = 0; v < alive_.size(); ++v) dropIfLoose(v);  // only degenerate faces used them
  if (aliveCount_ <= target) return;
  heap_.reserve(welded_.neighbours.size() / 2);
  for (std::uint32_t a = 0; a < welded_.vertexCount(); ++a)
    for (std::uint32_t b : welded_.neighboursOf(a))
      if (a < b) push(a, b);
  std::make_heap(heap_.begin(), heap_.end(), later);
  while (aliveCount_ > target && !heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const Candidate next = heap_.back();
    heap_.pop_back();
    if (alive_[next.a] && alive_[next.b] && version_[next.a] == next.versionA && version_[next.b] == next.versionB)
      collapse(next.a, next.b);
  }
}

Mesh Collapser::result() const {
  Mesh out;
  out.precision = mesh_.precision;
  std::vector<std::uint32_t> numberOf(alive_.size(), kNone), groupOf;
  if (!mesh_.groups.empty()) {
    groupOf.resize(alive_.size());
    for (std::size_t v = 0; v < mesh_.vertexCount(); ++v)
      if (welded_.weldedOf[v] != kNoVertex) groupOf[welded_.weldedOf[v]] = mesh_.groups[v];
  }
  for (std::size_t v = 0; v < alive_.size(); ++v) {
    if (!alive_[v]) continue;
    numberOf[v] = static_cast<std::uint32_t>(out.vertexCount());
    append(out.positions, moved_[v] ? centre_ + size_ * place_[v] : at(welded_.positions, v));
    if (!groupOf.empty()) out.groups.push_back(groupOf[v]);
  }
  for (std::size_t c = 0; c < corners_.size(); c += 3)
    if (corners_[c] != kNone)
      for (std::size_t i = 0; i < 3; ++i) out.faceVertices.push_back(numberOf[corners_[c + i]]);
  roundToPrecision(out);
  return out;
}

}  // namespace

Mesh simplifyQem(const Mesh& mesh, double keep) {
  Mesh triangles;
  triangles.positions = mesh.positions;
  triangles.groups = mesh.groups;
  triangles.precision = mesh.precision;
  triangles.faceVertices = fannedTriangles(mesh);
  Collapser collapser(triangles);
  collapser.run(keep);
  return collapser.result();
}

}  // namespace quadmark::lab
