// SPDX-License-Identifier: MIT
#include "quadmark/robust/parts.h"

#include <utility>

#include "quadmark/adjacency.h"
#include "quadmark/robust/mesh_source.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

constexpr std::size_t kMostComponents = 16;             // by then the weight is below 1 / 500
constexpr std::uint32_t kLeastComponentVertices = 300;  // fewer hold no frame

// One component's faces, with the vertices that they use.
struct Object {
  Mesh mesh;
  std::vector<std::uint32_t> origin;  ///< per vertex the one of the whole mesh
};

// Components that could carry a mark, largest first, of equal ones the first in the file; none where there is one only.
std::vector<Object> objectsOf(const Mesh& mesh) {
  const WeldedMesh welded = weld(mesh);
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> componentOf = components(welded, count);
  if (count < 2) return {};
  std::vector<std::uint32_t> size(count, 0), order(count), place(count, kNoVertex);
  for (const std::uint32_t c : componentOf) ++size[c];
  for (std::uint32_t c = 0; c < count; ++c) order[c] = c;
  sortCompactly(order.begin(), order.end(),
                [&](std::uint32_t a, std::uint32_t b) { return size[a] != size[b] ? size[a] > size[b] : a < b; });
  std::vector<Object> objects;
  for (const std::uint32_t c : order) {
    if (size[c] < kLeastComponentVertices || objects.size() == kMostComponents) break;
    place[c] = static_cast<std::uint32_t>(objects.size());
    objects.emplace_back();
  }
  std::vector<std::uint32_t> numberOf(mesh.vertexCount(), kNoVertex);
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const std::size_t begin = mesh.faceBegin(f), end = mesh.faceEnd(f);
    const std::uint32_t at = place[componentOf[welded.weldedOf[mesh.faceVertices[begin]]]];
    if (at == kNoVertex) continue;
    Object& object = objects[at];
    for (std::size_t c = begin; c < end; ++c) {
      const std::uint32_t v = mesh.faceVertices[c];
      if (numberOf[v] == kNoVertex) {
        numberOf[v] = static_cast<std::uint32_t>(object.origin.size());
        object.origin.push_back(v);
        for (std::size_t k = 0; k < 3; ++k) object.mesh.positions.push_back(mesh.positions[3 * std::size_t{v} + k]);
        if (!mesh.groups.empty()) object.mesh.groups.push_back(mesh.groups[v]);
      }
      object.mesh.faceVertices.push_back(numberOf[v]);
    }
    if (mesh.faceOffsets.empty()) continue;
    if (object.mesh.faceOffsets.empty()) object.mesh.faceOffsets.push_back(0);
    object.mesh.faceOffsets.push_back(static_cast<std::uint32_t>(object.mesh.faceVertices.size()));
  }
  return objects;
}

class Scene {
 public:
  Scene(const Mesh& mesh, const SceneRequest& request) : mesh_(mesh), request_(request) {}

  Result<SceneReading> run() {
    auto whole = read(mesh_, kWholeMultiplicity, 0, 1);
    if (!whole || whole->reading.cancelled || whole->reading.verdict == Verdict::match) return whole;
    const std::vector<Object> objects = objectsOf(mesh_);
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const auto rank = static_cast<std::uint32_t>(i + 1);
      auto part = read(objects[i].mesh, kWholeMultiplicity * rank * (rank + 1), rank, objects.size() + 1);
      if (!part) return part.error();
      ++whole->tried;
      if (part->reading.cancelled) return part;
      if (part->reading.verdict != Verdict::match) continue;
      std::vector<float> evidence(part->evidence.empty() ? 0 : mesh_.vertexCount(), 0.0f);
      for (std::size_t v = 0; v < part->evidence.size(); ++v) evidence[objects[i].origin[v]] = part->evidence[v];
      part->evidence = std::move(evidence);
      part->component = rank - 1;
      part->tried = whole->tried;
      return part;
    }
    return whole;
  }

 private:
  static constexpr std::uint32_t kWholeMultiplicity = 2;

  // @param number, count  of this reading among those that may follow, for progress.
  // @param multiplicity   of every probability.
  Result<SceneReading> read(const Mesh& mesh, std::uint32_t multiplicity, std::size_t number, std::size_t count) {
    MeshReader reader(mesh, request_.keys.geometry, headCode());
    MeshSource source(reader);
    ReadRequest request{request_.keys, request_.expected, multiplicity};
    if (request_.progress)
      request.progress = [&](double done) {
        return request_.progress((static_cast<double>(number) + done) / static_cast<double>(count));
      };
    auto reading = readMark(source, request);
    if (!reading) return reading.error();
    SceneReading out;
    out.reading = std::move(*reading);
    out.coverage = reader.coverage();
    if (out.reading.frame && out.reading.hypothesis) {
      const auto shape = bodyShape(*out.reading.frame);
      PayloadBits bits{*out.reading.frame, {}};
      if (shape) bits.body = out.reading.body ? out.reading.body->bits : std::vector<std::uint8_t>(shape->bits(), 0);
      out.evidence = reader.evidence(encode(bits, request_.keys), *out.reading.hypothesis);
    }
    return out;
  }

  const Mesh& mesh_;
  const SceneRequest& request_;
};

}  // namespace

Result<SceneReading> readScene(const Mesh& mesh, const SceneRequest& request) {
  return Scene(mesh, request).run();
}

}  // namespace quadmark::robust
