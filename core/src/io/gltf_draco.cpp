// SPDX-License-Identifier: MIT
#include "gltf_draco.h"

#include <map>
#include <utility>

#include "concat.h"
#include "draco_codec.h"

namespace quadmark::io {
namespace {

class DracoPrimitives {
 public:
  DracoPrimitives(GltfDocument& document, std::vector<BufferPlace>& places, std::vector<BufferBytes>& buffers,
                  std::uint64_t memoryLimit)
      : document_(document), places_(places), buffers_(buffers), memoryLimit_(memoryLimit) {}

  Status decode(GltfPrimitive& primitive) {
    const GltfDraco& draco = *primitive.draco;
    const GltfAccessor declared = document_.accessors[primitive.position];
    const auto [known, isNew] = streams_.emplace(std::pair(draco.view, draco.position), Stream{});
    Stream& stream = known->second;
    if (isNew) {
      if (Status status = decode(primitive, declared, stream); !status) return status;
    } else if (stream.componentType != declared.componentType || stream.normalized != declared.normalized) {
      return unsupportedFile(primitive.place() + ": its Draco data serves positions of two types");
    }
    primitive.position = stream.position;
    primitive.indices = stream.indices;
    primitive.mode = 4;  // the decoder gives triangles, whatever they were before
    return okStatus();
  }

 private:
  struct Stream {
    std::uint32_t position = 0, indices = 0;  // accessors
    std::uint32_t componentType = 0;
    bool normalized = false;
  };

  Status decode(const GltfPrimitive& primitive, const GltfAccessor& declared, Stream& stream) {
    const GltfView& view = document_.views[primitive.draco->view];
    BufferPlace place;
    place.source = BufferPlace::Source::draco;
    place.draco = DracoStream{
        primitive.draco->view,  view.buffer,         view.byteOffset,  view.byteLength, primitive.draco->position,
        declared.componentType, declared.normalized, primitive.place()};
    Result<DracoMesh> mesh = decodeDracoStream(place.draco, buffers_, memoryLimit_);
    if (!mesh) return mesh.error();
    decodedBytes_ += mesh->values[0].size() + mesh->indices.size() * sizeof(std::uint32_t);
    if (decodedBytes_ > memoryLimit_) {
      return tooLarge(concat(primitive.place(), ": the compressed data would take more than ", memoryLimit_, " bytes"));
    }
    GltfAccessor position = declared;
    position.sparse = {};
    position.min = position.max = {};
    position.usedOtherwise = false;
    position.count = mesh->pointCount;
    stream.position = append(std::move(place), std::move(mesh->values[0]), position);

    std::vector<std::uint8_t> indices(mesh->indices.size() * sizeof(std::uint32_t));
    for (std::size_t i = 0; i < mesh->indices.size(); ++i) store(&indices[sizeof(std::uint32_t) * i], mesh->indices[i]);
    GltfAccessor index;
    index.componentType = kGltfUint32;
    index.components = 1;
    index.count = mesh->indices.size();
    index.usedOtherwise = true;
    stream.indices = append(BufferPlace{}, std::move(indices), index);
    stream.componentType = declared.componentType;
    stream.normalized = declared.normalized;
    return okStatus();
  }

  /// Adds a buffer with one view and one accessor over all of it; returns the accessor.
  std::uint32_t append(BufferPlace place, std::vector<std::uint8_t> bytes, GltfAccessor accessor) {
    GltfView view;
    view.buffer = static_cast<std::uint32_t>(document_.buffers.size());
    view.byteLength = bytes.size();
    view.needed = true;
    accessor.view = static_cast<std::uint32_t>(document_.views.size());
    accessor.byteOffset = 0;
    accessor.needed = true;
    place.byteLength = bytes.size();
    BufferBytes buffer;
    buffer.decoded = std::move(bytes);
    buffer.bytes = buffer.decoded;
    document_.buffers.emplace_back();
    document_.buffers.back().byteLength = place.byteLength;
    document_.views.push_back(view);
    document_.accessors.push_back(accessor);
    places_.push_back(std::move(place));
    buffers_.push_back(std::move(buffer));
    return static_cast<std::uint32_t>(document_.accessors.size() - 1);
  }

  GltfDocument& document_;
  std::vector<BufferPlace>& places_;
  std::vector<BufferBytes>& buffers_;
  std::uint64_t memoryLimit_, decodedBytes_ = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Stream> streams_;  // by view and unique id
};

}  // namespace

Status decodeDracoPrimitives(GltfDocument& document, std::vector<BufferPlace>& places,
                             std::vector<BufferBytes>& buffers, std::uint64_t memoryLimit) {
  DracoPrimitives decoder(document, places, buffers, memoryLimit);
  for (GltfPrimitive& primitive : document.primitives) {
    if (!primitive.draco || !primitive.hasTriangles()) continue;
    if (Status status = decoder.decode(primitive); !status) return status;
  }
  return okStatus();
}

}  // namespace quadmark::io
