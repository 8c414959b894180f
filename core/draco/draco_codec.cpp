// SPDX-License-Identifier: MIT
// The decoder itself. Draco's release in the distributions lacks later security fixes, so everything it is told is
// bounded before (readDracoHeader(), the size of attributes) and everything it says is checked after.
#include "io/draco_codec.h"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/decoder_buffer.h>
#include <draco/mesh/mesh.h>

#include <memory>

namespace quadmark::io {
namespace {

/// A decoder that looks at the attributes' sizes before it makes room for them: their descriptions come compressed,
/// so that they cannot be checked in advance.
template <class Decoder>
class BoundedDecoder final : public Decoder {
 public:
  explicit BoundedDecoder(std::uint64_t memoryLimit) : memoryLimit_(memoryLimit) {}

  [[nodiscard]] bool isTooLarge() const { return isTooLarge_; }

 private:
  bool DecodeAllAttributes() override {
    constexpr std::uint64_t kLimitsForAllAttributes = 4, kWorkingBytesPerPoint = 16;
    const draco::PointCloud& cloud = *this->point_cloud();
    std::uint64_t total = 0;
    for (std::int32_t i = 0; i < cloud.num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *cloud.attribute(i);
      // Values are decoded as 32-bit integers first.
      const std::uint64_t elementBytes =
          4u * static_cast<std::uint64_t>(attribute.num_components()) + attribute.byte_stride();
      const std::uint64_t bytes = elementBytes * cloud.num_points();
      total += bytes + kWorkingBytesPerPoint * cloud.num_points();
      isTooLarge_ = isTooLarge_ || bytes > memoryLimit_ || total > kLimitsForAllAttributes * memoryLimit_;
    }
    return !isTooLarge_ && Decoder::DecodeAllAttributes();
  }

  std::uint64_t memoryLimit_;
  bool isTooLarge_ = false;
};

struct Decoded {
  std::unique_ptr<draco::Mesh> mesh;
  bool isTooLarge = false;
};

template <class Decoder>
Decoded runDecoder(Bytes stream, std::uint64_t memoryLimit) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  const draco::DecoderOptions options;
  Decoded decoded;
  auto mesh = std::make_unique<draco::Mesh>();
  BoundedDecoder<Decoder> decoder(memoryLimit);
  if (decoder.Decode(options, &buffer, mesh.get()).ok()) decoded.mesh = std::move(mesh);
  decoded.isTooLarge = decoder.isTooLarge();
  return decoded;
}

template <class T>
bool convertValues(const draco::PointAttribute& attribute, std::uint32_t components, std::uint32_t pointCount,
                   std::vector<std::uint8_t>& out) {
  out.resize(std::size_t{pointCount} * components * sizeof(T));
  std::vector<T> element(components);
  for (std::uint32_t point = 0; point < pointCount; ++point) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(point));
    if (value.value() >= attribute.size()) return false;
    if (!attribute.ConvertValue<T>(value, static_cast<std::int8_t>(components), element.data())) return false;
    std::memcpy(&out[std::size_t{point} * components * sizeof(T)], element.data(), components * sizeof(T));
  }
  return true;
}

bool convertValues(const draco::PointAttribute& attribute, const DracoAttribute& wanted, std::uint32_t pointCount,
                   std::vector<std::uint8_t>& out) {
  switch (wanted.componentType) {
    case 5120:
      return convertValues<std::int8_t>(attribute, wanted.components, pointCount, out);
    case 5121:
      return convertValues<std::uint8_t>(attribute, wanted.components, pointCount, out);
    case 5122:
      return convertValues<std::int16_t>(attribute, wanted.components, pointCount, out);
    case 5123:
      return convertValues<std::uint16_t>(attribute, wanted.components, pointCount, out);
    case 5125:
      return convertValues<std::uint32_t>(attribute, wanted.components, pointCount, out);
    case 5126:
      return convertValues<float>(attribute, wanted.components, pointCount, out);
    default:
      return false;
  }
}

/// Whether every value that the attribute's own tables lead to lies in its buffer. Booleans are refused: glTF knows none,
/// and the decoder does not look whether the byte of one is 0 or 1.
bool isSound(const draco::PointAttribute& attribute, std::uint32_t pointCount) {
  const draco::DataBuffer* buffer = attribute.buffer();
  if (attribute.data_type() == draco::DT_BOOL) return false;
  if (buffer == nullptr || attribute.byte_stride() <= 0 || attribute.byte_offset() < 0) return false;
  if (!attribute.is_mapping_identity() && attribute.indices_map_size() < pointCount) return false;
  const auto stride = static_cast<std::uint64_t>(attribute.byte_stride());
  const std::uint64_t element = static_cast<std::uint64_t>(attribute.num_components()) *
                                static_cast<std::uint64_t>(draco::DataTypeLength(attribute.data_type()));
  return element <= stride &&
         static_cast<std::uint64_t>(attribute.byte_offset()) + stride * attribute.size() <= buffer->data_size();
}

}  // namespace

Result<DracoMesh> decodeDraco(Bytes stream, const std::vector<DracoAttribute>& attributes, std::uint64_t memoryLimit,
                              const std::string& place) {
  const Result<DracoHeader> header = readDracoHeader(stream, memoryLimit, place);
  if (!header) return header.error();
  std::vector<std::uint8_t> withoutMetadata;
  if (header->metadataEnd > header->metadataBegin) {
    withoutMetadata.assign(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(header->metadataBegin));
    withoutMetadata[10] &= 0x7f;
    withoutMetadata.insert(withoutMetadata.end(), stream.begin() + static_cast<std::ptrdiff_t>(header->metadataEnd),
                           stream.end());
    stream = withoutMetadata;
  }
  const Decoded decoded = header->isEdgebreaker ? runDecoder<draco::MeshEdgebreakerDecoder>(stream, memoryLimit)
                                                : runDecoder<draco::MeshSequentialDecoder>(stream, memoryLimit);
  if (decoded.isTooLarge)
    return tooLarge(place + ": the Draco data would take too much memory for a file of this size");
  if (decoded.mesh == nullptr) return badFile(place + ": the Draco data is broken");

  const draco::Mesh& mesh = *decoded.mesh;
  const std::uint32_t pointCount = mesh.num_points();
  if (pointCount == 0) return badFile(place + ": the Draco data has no points");
  DracoMesh out;
  out.pointCount = pointCount;
  out.indices.reserve(std::size_t{mesh.num_faces()} * 3);
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
    for (const draco::PointIndex& point : mesh.face(face)) {
      if (point.value() >= pointCount) return badFile(place + ": the Draco data refers to missing points");
      out.indices.push_back(point.value());
    }
  }
  for (const DracoAttribute& wanted : attributes) {
    const draco::PointAttribute* attribute = wanted.id == kAnyDracoPosition
                                                 ? mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION)
                                                 : mesh.GetAttributeByUniqueId(wanted.id);
    const std::string name = wanted.id == kAnyDracoPosition ? "positions" : "attribute " + std::to_string(wanted.id);
    if (attribute == nullptr) return badFile(place + ": the Draco data has no " + name);
    if (static_cast<std::uint32_t>(attribute->num_components()) != wanted.components) {
      return badFile(place + ": " + name + " of the Draco data has " + std::to_string(attribute->num_components()) +
                     " components, expected " + std::to_string(wanted.components));
    }
    out.values.emplace_back();
    if (!isSound(*attribute, pointCount) || !convertValues(*attribute, wanted, pointCount, out.values.back())) {
      return badFile(place + ": " + name + " of the Draco data cannot be read as stated");
    }
  }
  return out;
}

}  // namespace quadmark::io
