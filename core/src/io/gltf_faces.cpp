// SPDX-License-Identifier: MIT
// The triangles of a glTF, from indices of every kind and in every mode.
#include <set>
#include <tuple>

#include "concat.h"
#include "face_collector.h"
#include "gltf_model.h"
#include "gltf_sparse.h"

namespace quadmark::io {
namespace {

/// The corners of a primitive's vertex stream, one index after the other.
template <class T>
struct IndexStream {
  const std::uint8_t* bytes;
  [[nodiscard]] std::uint32_t operator()(std::uint64_t i) const { return load<T>(bytes + i * sizeof(T)); }
};
struct CountingStream {
  [[nodiscard]] std::uint32_t operator()(std::uint64_t i) const { return static_cast<std::uint32_t>(i); }
};

/// A primitive's faces as they are needed to be read once.
struct FaceSource {
  const GltfPrimitive* primitive;
  const PositionWindow* window;
  const std::uint8_t* indices = nullptr;  // null: not indexed
  std::uint32_t componentType = 0;
  std::uint64_t count = 0;  // of the vertex stream

  [[nodiscard]] std::uint64_t mostCorners() const {
    return primitive->mode == 4 ? count / 3 * 3 : count < 3 ? 0 : 3 * (count - 2);
  }
};

/// The mesh vertex of an accessor's element: of a plain accessor, and of one whose elements lie in several places.
struct PlainVertices {
  std::uint32_t base;
  [[nodiscard]] std::uint32_t operator()(std::uint32_t element) const { return base + element; }
};
struct SparseVertices {
  const PositionArrays& positions;
  const PositionWindow& window;
  [[nodiscard]] std::uint32_t operator()(std::uint32_t element) const { return positions.vertexOf(window, element); }
};

template <class Stream, class Vertices>
Status appendFaces(const FaceSource& source, const Stream& stream, const Vertices& vertexOf, Mesh& mesh) {
  const std::uint64_t vertexCount = source.window->count;
  const std::uint32_t mode = source.primitive->mode;
  const std::uint64_t used = mode == 4 ? source.count / 3 * 3 : source.count;
  for (std::uint64_t i = 0; i < source.count; ++i) {
    if (stream(i) < vertexCount) continue;
    return badFile(concat(source.primitive->place(), ": index ", stream(i), " at position ", i, " exceeds accessor ",
                          source.window->accessor, " (", vertexCount, " vertices)"));
  }
  if (mode == 4) {
    const std::size_t begin = mesh.faceVertices.size();
    mesh.faceVertices.resize(begin + static_cast<std::size_t>(used));
    std::uint32_t* corners = mesh.faceVertices.data() + begin;
    for (std::uint64_t i = 0; i < used; ++i) corners[i] = vertexOf(stream(i));
    return okStatus();
  }
  FaceCollector faces(mesh);
  if (mode == 5) {
    for (std::uint64_t i = 0; i < used; ++i) faces.stripVertex(vertexOf(stream(i)));
    return okStatus();
  }
  for (std::uint64_t i = 2; i < used; ++i) {
    const std::uint32_t a = vertexOf(stream(0)), b = vertexOf(stream(i - 1)), c = vertexOf(stream(i));
    if (a != b && b != c && a != c) faces.addTriangle(a, b, c);
  }
  return okStatus();
}

template <class Vertices>
Status appendFaces(const FaceSource& source, const Vertices& vertexOf, Mesh& mesh) {
  if (source.indices == nullptr) return appendFaces(source, CountingStream{}, vertexOf, mesh);
  switch (source.componentType) {
    case kGltfUint8:
      return appendFaces(source, IndexStream<std::uint8_t>{source.indices}, vertexOf, mesh);
    case kGltfUint16:
      return appendFaces(source, IndexStream<std::uint16_t>{source.indices}, vertexOf, mesh);
    default:
      return appendFaces(source, IndexStream<std::uint32_t>{source.indices}, vertexOf, mesh);
  }
}

}  // namespace

Result<std::vector<PrimitiveFaces>> GltfModel::readFaces(const GltfDocument& document,
                                                         const std::vector<BufferBytes>& buffers,
                                                         std::uint64_t totalBytes, std::uint64_t memoryLimit) {
  std::vector<FaceSource> sources;
  std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> seen;  // the same faces twice say nothing new
  std::uint64_t corners = 0;
  for (const GltfPrimitive& primitive : document.primitives) {
    if (!primitive.hasTriangles()) continue;
    if (!seen.emplace(primitive.position, primitive.indices, primitive.mode).second) continue;
    FaceSource source;
    source.primitive = &primitive;
    source.window = &positions_.windows[positions_.windowOf[primitive.position]];
    source.count = source.window->count;
    if (primitive.indices != kNone) source.count = document.accessors[primitive.indices].count;
    constexpr std::size_t kMostWarnings = 200;
    if (primitive.mode == 4 && source.count % 3 != 0 && info_.warnings.size() < kMostWarnings) {
      info_.warnings.push_back(concat(primitive.place(), ": ", source.count,
                                      " corners are not a multiple of 3; the rest is passed through"));
    }
    corners += source.mostCorners();
    sources.push_back(source);
  }
  // Accessors may overlap, so a small file could ask for any number of faces. Sane files stay below 3 corners per byte.
  constexpr std::uint64_t kMostCornersPerByte = 4;
  if (corners > FaceCollector::kLargestCornerCount || corners / kMostCornersPerByte > totalBytes ||
      corners > memoryLimit / sizeof(std::uint32_t)) {
    return tooLarge(concat("glTF: primitives reuse the same data for ", corners, " triangle corners"));
  }
  mesh_.faceVertices.reserve(static_cast<std::size_t>(corners));
  std::vector<PrimitiveFaces> faces;
  for (FaceSource& source : sources) {
    std::vector<std::uint8_t> assembled;
    if (const std::uint32_t index = source.primitive->indices; index != kNone) {
      const GltfAccessor& accessor = document.accessors[index];
      source.componentType = accessor.componentType;
      if (accessor.view == kNone || accessor.sparse) {
        Result<std::vector<std::uint8_t>> result = assembleSparse(document, index, buffers);
        if (!result) return result.error();
        assembled = std::move(result).value();
        source.indices = assembled.data();
      } else {
        const GltfView& view = document.views[accessor.view];
        source.indices = buffers[view.buffer].bytes.data() + view.byteOffset + accessor.byteOffset;
      }
    }
    const PositionWindow& window = *source.window;
    const std::size_t begin = mesh_.faceVertices.size();
    const bool plain = window.isStored() && window.values == kNone;
    Status status = plain ? appendFaces(source, PlainVertices{static_cast<std::uint32_t>(window.firstVertex)}, mesh_)
                          : appendFaces(source, SparseVertices{positions_, window}, mesh_);
    if (!status) return status.error();
    faces.push_back({source.primitive, begin, mesh_.faceVertices.size()});
  }
  return faces;
}

}  // namespace quadmark::io
