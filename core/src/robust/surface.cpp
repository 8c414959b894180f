// SPDX-License-Identifier: MIT
#include "surface.h"

#include <algorithm>

#include "release.h"

namespace quadmark::robust {
namespace {

void collectFaces(const Mesh& mesh, Surface& out) {
  const std::size_t faces = mesh.faceCount();
  out.faceOffsets.reserve(faces + 1);
  out.corners.reserve(mesh.faceVertices.size());
  out.faceOffsets.push_back(0);
  for (std::size_t f = 0; f < faces; ++f) {
    const std::size_t begin = out.corners.size();
    for (std::size_t c = mesh.faceBegin(f); c < mesh.faceEnd(f); ++c) {
      const std::uint32_t v = out.welded.weldedOf[mesh.faceVertices[c]];
      if (out.corners.size() == begin || out.corners.back() != v) out.corners.push_back(v);
    }
    while (out.corners.size() > begin + 1 && out.corners.back() == out.corners[begin]) out.corners.pop_back();
    const std::size_t count = out.corners.size() - begin;
    const bool folded = count == 3 && out.corners[begin] == out.corners[begin + 2];
    if (count < 3 || folded)
      out.corners.resize(begin);
    else
      out.faceOffsets.push_back(static_cast<std::uint32_t>(out.corners.size()));
  }
}

struct Spoke {
  std::uint32_t next, previous;  // the neighbours of a vertex along one face
};

// The ring of one vertex from its spokes: each neighbour must be followed by exactly one other.
bool walkRing(std::span<const Spoke> spokes, std::vector<std::uint32_t>& ring) {
  const std::size_t begin = ring.size();
  std::uint32_t at = spokes[0].next;
  for (std::size_t steps = 0; steps < spokes.size(); ++steps) {
    ring.push_back(at);
    std::uint32_t following = kNoVertex;
    int followers = 0;
    for (const Spoke& spoke : spokes)
      if (spoke.next == at) following = spoke.previous, ++followers;
    if (followers != 1) break;
    at = following;
    if (at == spokes[0].next) {
      if (steps + 1 == spokes.size()) return true;
      break;
    }
  }
  ring.resize(begin);
  return false;
}

// In as many rounds, each over all faces for its share of the vertices: so much less memory for spokes, which are half of
// what a surface is.
void collectRings(Surface& out, std::uint32_t rounds) {
  const std::uint32_t count = out.vertexCount();
  out.cornerCounts.assign(count, 0);
  std::vector<std::uint32_t> offsets(count + 1, 0);
  for (const std::uint32_t v : out.corners) ++offsets[v + 1];
  for (std::uint32_t v = 0; v < count; ++v) offsets[v + 1] += offsets[v];
  std::vector<Spoke> spokes;
  std::vector<std::uint32_t> cursor(offsets.begin(), offsets.end() - 1);
  out.ringOffsets.reserve(count + 1);
  out.rings.reserve(out.corners.size());
  for (std::uint32_t round = 0; round < rounds; ++round) {
    const auto begin = static_cast<std::uint32_t>(std::uint64_t{count} * round / rounds);
    const auto end = static_cast<std::uint32_t>(std::uint64_t{count} * (round + 1) / rounds);
    spokes.resize(offsets[end] - offsets[begin]);
    for (std::uint32_t f = 0; f < out.faceCount(); ++f) {
      const auto face = out.face(f);
      const std::size_t sides = face.size();
      for (std::size_t k = 0; k < sides; ++k) {
        const std::uint32_t v = face[k];
        if (v < begin || v >= end) continue;
        spokes[cursor[v]++ - offsets[begin]] = {face[(k + 1) % sides], face[(k + sides - 1) % sides]};
        out.cornerCounts[v] += static_cast<std::uint32_t>(1 + 32 * (sides - 3));
      }
    }
    for (std::uint32_t v = begin; v < end; ++v) {
      out.ringOffsets.push_back(static_cast<std::uint32_t>(out.rings.size()));
      const std::uint32_t degree = offsets[v + 1] - offsets[v];
      if (degree >= kMinRing && degree <= kMaxRing)
        walkRing({spokes.data() + (offsets[v] - offsets[begin]), degree}, out.rings);
    }
  }
  out.ringOffsets.push_back(static_cast<std::uint32_t>(out.rings.size()));
}

}  // namespace

Surface makeSurface(const Mesh& mesh) {
  Surface out;
  out.welded = weldVertices(mesh);
  collectFaces(mesh, out);
  collectRings(out, 1);
  return out;
}

void rememberRings(Surface& surface) {
  if (surface.ringOffsets.empty()) collectRings(surface, 4);
}

void forgetRings(Surface& surface) {
  for (auto* list : {&surface.rings, &surface.ringOffsets, &surface.cornerCounts}) release(*list);
}

void turnOver(Surface& surface) {
  const auto reverse = [](std::vector<std::uint32_t>& values, const std::vector<std::uint32_t>& offsets) {
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i)
      std::reverse(values.begin() + offsets[i], values.begin() + offsets[i + 1]);
  };
  reverse(surface.corners, surface.faceOffsets);
  reverse(surface.rings, surface.ringOffsets);
}

FacesAround::FacesAround(const Surface& surface)
    : offsets_(surface.vertexCount() + 1, 0), faces_(surface.corners.size()) {
  for (const std::uint32_t v : surface.corners) ++offsets_[v + 1];
  for (std::size_t v = 1; v < offsets_.size(); ++v) offsets_[v] += offsets_[v - 1];
  std::vector<std::uint32_t> cursor(offsets_.begin(), offsets_.end() - 1);
  for (std::uint32_t f = 0; f < surface.faceCount(); ++f)
    for (const std::uint32_t v : surface.face(f)) faces_[cursor[v]++] = f;
}

Vec3 areaVector(std::span<const std::uint32_t> face, const std::vector<double>& positions) {
  const Vec3 origin = at(positions, face[0]);
  Vec3 sum;
  for (std::size_t k = 1; k + 1 < face.size(); ++k)
    sum += cross(at(positions, face[k]) - origin, at(positions, face[k + 1]) - origin);
  return sum;
}

double slideOf(const Vec3& move, const Vec3& normal) {
  return length(move - dot(move, normal) * normal);
}

double largestExtent(std::span<const double> positions) {
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (positions.empty()) return 0;
    double low = positions[axis], high = low;
    for (std::size_t i = axis; i < positions.size(); i += 3) {
      low = std::min(low, positions[i]);
      high = std::max(high, positions[i]);
    }
    largest = std::max(largest, high - low);
  }
  return largest;
}

SymmetricTensor edgeTensor(const Surface& surface, const std::vector<double>& positions) {
  SymmetricTensor m;
  for (std::uint32_t f = 0; f < surface.faceCount(); ++f) {
    const auto face = surface.face(f);
    Vec3 from = at(positions, face.back());
    for (const std::uint32_t v : face) {
      const Vec3 to = at(positions, v), e = to - from;
      m.xx += e.x * e.x, m.xy += e.x * e.y, m.xz += e.x * e.z;
      m.yy += e.y * e.y, m.yz += e.y * e.z, m.zz += e.z * e.z;
      from = to;
    }
  }
  return m;
}

std::vector<double> sharpened(const Surface& surface, double lambda) {
  constexpr double kStep = 0.03;
  const std::uint32_t count = surface.vertexCount();
  std::vector<double> from = surface.welded.positions, to(from.size());
  const int steps = static_cast<int>(lambda / kStep + 0.5);
  for (int step = 0; step < steps; ++step) {
    for (std::uint32_t v = 0; v < count; ++v) {
      const Vec3 p = at(from, v);
      Vec3 mean;
      const auto ring = surface.ring(v);
      for (const std::uint32_t n : ring) mean += at(from, n);
      const double share = ring.empty() ? 0 : 1.0 / static_cast<double>(ring.size());
      put(to, v, ring.empty() ? p : p - kStep * (share * mean - p));
    }
    from.swap(to);
  }
  return from;
}

}  // namespace quadmark::robust
