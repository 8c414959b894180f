// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>

#include "concat.h"
#include "gltf_draco.h"
#include "gltf_model.h"
#include "gltf_sparse.h"

namespace quadmark {

bool isGltf(std::span<const std::uint8_t> file) {
  std::string_view text = io::asText(file);
  if (text.substr(0, 4) == "glTF") return true;
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != text.npos && text[first] == '{';
}

Result<std::unique_ptr<Model>> readGltf(std::span<const std::uint8_t> file, const Resources& resources) {
  auto model = std::make_unique<io::GltfModel>();
  if (Status status = model->read(file, resources); !status) return status.error();
  return std::unique_ptr<Model>(std::move(model));
}

std::optional<TextureShift> textureShift(std::span<const std::uint8_t> file, const Resources& resources,
                                         const std::vector<double>& before) {
  io::TextureShiftMeter meter(before);
  if (!isGltf(file) || !io::GltfModel().read(file, resources, &meter)) return std::nullopt;
  return meter.shift();
}

namespace io {
namespace {

/// buffer -> lowest buffer with the same bytes: two buffers may name the same file.
std::vector<std::uint32_t> findSameBuffers(const std::vector<BufferPlace>& places) {
  std::vector<std::uint32_t> same(places.size());
  std::map<std::string, std::uint32_t> byKey;
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    const bool resource = places[i].source == BufferPlace::Source::resource;
    same[i] = resource ? byKey.emplace(places[i].key, i).first->second : i;
  }
  return same;
}

}  // namespace

Status GltfModel::readReplaced(const GltfDocument& document, const std::vector<BufferBytes>& buffers) {
  for (PositionWindow& window : positions_.windows) {
    if (window.values == kNone) continue;
    Result<std::vector<std::uint32_t>> replaced = readSparseIndices(document, window.accessor, buffers);
    if (!replaced) return replaced.error();
    positions_.windows[window.values].replaced = std::move(replaced).value();
  }
  return okStatus();
}

Error GltfModel::notFinite(std::uint64_t vertex, int axis) const {
  const auto window =
      std::find_if(positions_.windows.begin(), positions_.windows.end(), [&](const PositionWindow& w) {
        return w.isStored() && vertex >= w.firstVertex && vertex - w.firstVertex < w.count;
      });
  const bool isValue = positions_.windows[positions_.windowOf[window->accessor]].values != kNone &&
                       &*window != &positions_.windows[positions_.windowOf[window->accessor]];
  return badMesh(concat("accessor ", window->accessor, ": ", isValue ? "sparse value " : "vertex ",
                        vertex - window->firstVertex, ", component ", "xyz"[axis], " is not finite"));
}

Status GltfModel::readPositions(const std::vector<BufferBytes>& buffers) {
  mesh_.positions.resize(static_cast<std::size_t>(3 * positions_.vertexCount));
  std::uint64_t stored = 0;
  for (const PositionArray& array : positions_.arrays) {
    const std::optional<CoordinateGrid> grid = array.type.grid();
    if (grid) setGrid(array.firstVertex, array.count, *grid);
    stored = std::max(stored, array.firstVertex + array.count);
    double* out = &mesh_.positions[static_cast<std::size_t>(3 * array.firstVertex)];
    Status status = withComponent(array.type.component, [&](auto component) -> Status {
      using T = decltype(component);
      const double divisor = grid ? grid->divisor : 1;
      const std::uint8_t* element = buffers[array.buffer].bytes.data() + array.start;
      for (std::uint64_t i = 0; i < array.count; ++i, element += array.stride, out += 3) {
        for (int axis = 0; axis < 3; ++axis) {
          const T code = load<T>(element + sizeof(T) * static_cast<std::size_t>(axis));
          out[axis] = decodeComponent(code, divisor);
          if (!std::isfinite(out[axis])) return notFinite(array.firstVertex + i, axis);
        }
      }
      return okStatus();
    });
    if (!status) return status;
  }
  if (stored < positions_.vertexCount) setGrid(stored, positions_.vertexCount - stored, CoordinateGrid{1, 0, 0});
  return okStatus();
}

void GltfModel::setGrid(std::uint64_t firstVertex, std::uint64_t count, const CoordinateGrid& grid) {
  std::size_t number = 0;
  while (number < mesh_.grids.size() && !(mesh_.grids[number] == grid)) ++number;
  if (number == mesh_.grids.size()) mesh_.grids.push_back(grid);
  mesh_.gridOf.resize(static_cast<std::size_t>(positions_.vertexCount));
  const auto first = mesh_.gridOf.begin() + static_cast<std::ptrdiff_t>(firstVertex);
  std::fill(first, first + static_cast<std::ptrdiff_t>(count), static_cast<std::uint8_t>(number + 1));
}

void GltfModel::readGroups(const GltfDocument& document) {
  // Meshes that share an array are one group, whose number follows its lowest mesh.
  std::vector<std::uint32_t> leader(static_cast<std::size_t>(document.meshCount));
  for (std::uint32_t i = 0; i < leader.size(); ++i) leader[i] = i;
  const auto find = [&](std::uint32_t mesh) {
    while (leader[mesh] != mesh) mesh = leader[mesh] = leader[leader[mesh]];
    return mesh;
  };
  std::vector<std::uint32_t> arrayMesh(positions_.arrays.size(), kNone);
  std::vector<std::uint32_t> windowMesh(positions_.windows.size(), kNone);
  std::vector<std::uint32_t> zerosMesh(positions_.windows.size(), kNone);
  for (const GltfPrimitive& primitive : document.primitives) {
    if (!primitive.hasTriangles()) continue;
    const std::uint32_t window = positions_.windowOf[primitive.position];
    for (const std::uint32_t part : {window, positions_.windows[window].values}) {
      if (part == kNone) continue;
      windowMesh[part] = std::min(windowMesh[part], primitive.mesh);
      // What is stored nowhere is a place of its own.
      const PositionWindow& place = positions_.windows[part];
      std::uint32_t& first = place.isStored() ? arrayMesh[place.array] : zerosMesh[part];
      if (first == kNone) first = primitive.mesh;
      const std::uint32_t a = find(first), b = find(primitive.mesh);
      leader[std::max(a, b)] = std::min(a, b);
    }
  }
  vertexMesh_.assign(static_cast<std::size_t>(positions_.vertexCount), kNone);
  for (std::size_t i = 0; i < positions_.windows.size(); ++i) {
    const PositionWindow& window = positions_.windows[i];
    const std::uint64_t count = window.isStored() ? window.count : 1;
    for (std::uint64_t v = window.firstVertex; v < window.firstVertex + count; ++v) {
      vertexMesh_[static_cast<std::size_t>(v)] = std::min(vertexMesh_[static_cast<std::size_t>(v)], windowMesh[i]);
    }
  }
  std::vector<std::uint32_t> groupOf(leader.size(), kNone);
  std::vector<bool> drawn(leader.size());
  for (const std::vector<std::uint32_t>* meshes : {&arrayMesh, &zerosMesh}) {
    for (const std::uint32_t mesh : *meshes) {
      if (mesh != kNone) drawn[find(mesh)] = true;
    }
  }
  std::uint32_t groups = 0;
  for (std::uint32_t mesh = 0; mesh < leader.size(); ++mesh) {
    if (drawn[mesh]) groupOf[mesh] = groups++;
  }
  if (groups < 2) return;
  mesh_.groups.resize(vertexMesh_.size());
  for (std::size_t v = 0; v < vertexMesh_.size(); ++v) mesh_.groups[v] = groupOf[find(vertexMesh_[v])];
}

Status GltfModel::read(Bytes file, const Resources& resources, TextureShiftMeter* meter) {
  // 1. The document.
  Result<GltfContainer> container = openGltf(file);
  if (!container) return container.error();
  container_ = std::move(container).value();
  Result<GltfDocument> read = readGltfDocument(container_.json(file), container_.jsonBegin, meter != nullptr);
  if (!read) return read.error();
  GltfDocument document = std::move(read).value();
  if (meter != nullptr && document.textures.empty()) return okStatus();
  fileSize_ = file.size();
  info_.format = container_.isGlb ? FileFormat::glb : FileFormat::gltf;
  info_.variant = "glTF " + document.version;
  info_.meshes = static_cast<std::uint32_t>(document.meshCount);
  info_.primitives = static_cast<std::uint32_t>(document.primitiveCount);
  info_.nodes = static_cast<std::uint32_t>(document.nodeCount);
  info_.extensionsUsed = document.extensionsUsed;
  info_.warnings = container_.warnings;
  info_.warnings.insert(info_.warnings.end(), document.warnings.begin(), document.warnings.end());
  for (const GltfNode& node : document.nodes) nodes_.push_back(NodeRef{node.node, node.name, node.mesh});

  // 2. Buffers and the positions in them.
  Result<std::vector<BufferPlace>> places = placeBuffers(document, container_, file, resources);
  if (!places) return places.error();
  buffers_ = std::move(places).value();
  Result<std::vector<BufferBytes>> opened =
      openBuffers(buffers_, std::vector<bool>(buffers_.size(), true), container_, file, resources);
  if (!opened) return opened.error();
  std::vector<BufferBytes> buffers = std::move(opened).value();
  const std::uint64_t limit = memoryLimit(file, resources);
  if (Status status = decodeDracoPrimitives(document, buffers_, buffers, limit); !status) return status;
  Result<PositionArrays> arrays = collectPositionArrays(document, findSameBuffers(buffers_));
  if (!arrays) return arrays.error();
  positions_ = std::move(arrays).value();
  if (positions_.windows.empty()) return badMesh("glTF: the file has no triangles");
  if (!positions_.conflict.empty())
    info_.warnings.push_back(positions_.conflict + "; marking this file will be refused");

  std::uint64_t totalBytes = file.size();
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const bool inFile =
        buffers_[i].source == BufferPlace::Source::bin || buffers_[i].source == BufferPlace::Source::dataUri;
    if (!inFile) totalBytes += buffers[i].bytes.size();
  }
  std::uint64_t windowed = 0;
  for (const PositionWindow& window : positions_.windows) windowed += window.isStored() ? window.count : 1;
  if (windowed > totalBytes) return tooLarge("glTF: accessors reuse the same positions too often");
  if (positions_.vertexCount > limit / (3 * sizeof(double))) {
    return tooLarge(concat("glTF: ", positions_.vertexCount, " vertices are too many for a file of this size"));
  }
  if (Status status = readReplaced(document, buffers); !status) return status;
  if (Status status = readPositions(buffers); !status) return status;

  // 3. Faces and groups.
  const Result<std::vector<PrimitiveFaces>> faces = readFaces(document, buffers, totalBytes, limit);
  if (!faces) return faces.error();
  if (mesh_.faceCount() == 0) return badMesh("glTF: the file has no triangles");
  if (meter != nullptr) {
    meter->measure(document, resources, buffers, positions_, mesh_, *faces);
    return okStatus();
  }
  readGroups(document);
  if (boundingDiagonal(mesh_) == 0) return badMesh("glTF: all used vertices are at one point");

  // 4. What patch() will need.
  for (std::uint32_t i = 0; i < positions_.windows.size(); ++i) {
    const GltfAccessor& accessor = document.accessors[positions_.windows[i].accessor];
    if (positions_.windowOf[positions_.windows[i].accessor] != i || (accessor.min.empty() && accessor.max.empty())) continue;
    bounds_.push_back(Bounds{accessor.min, accessor.max, i});
  }
  return okStatus();
}

}  // namespace io
}  // namespace quadmark
