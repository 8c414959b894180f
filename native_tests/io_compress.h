// SPDX-License-Identifier: MIT
// Foreign encoders for the tests' own files. meshoptimizer 0.18 writes vertex codec 0 alone; codec 1 is tested with
// streams of a newer one (io_streams.h) and with the npm package (js_tests). Draco's encoder exists natively alone.
#pragma once

#include <meshoptimizer.h>

#include <string>

#include "io_fixtures.h"

#if !defined(__EMSCRIPTEN__)
#include <draco/compression/expert_encode.h>
#endif

namespace quadmark::test {

/// @param mode  ATTRIBUTES, TRIANGLES or INDICES; indices have 2 or 4 bytes.
inline FileBytes encodeMeshopt(const FileBytes& plain, std::size_t count, std::size_t elementBytes,
                               const std::string& mode) {
  FileBytes out;
  if (mode == "ATTRIBUTES") {
    out.resize(meshopt_encodeVertexBufferBound(count, elementBytes));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), plain.data(), count, elementBytes));
    return out;
  }
  std::vector<unsigned int> indices;
  for (std::size_t i = 0; i < count; ++i) {
    indices.push_back(elementBytes == 2 ? io::load<std::uint16_t>(&plain[2 * i]) : io::load<std::uint32_t>(&plain[4 * i]));
  }
  meshopt_encodeIndexVersion(1);  // the extension's
  const std::size_t vertices = std::size_t{1} + *std::max_element(indices.begin(), indices.end());
  if (mode == "TRIANGLES") {
    out.resize(meshopt_encodeIndexBufferBound(count, vertices));
    out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), count));
  } else {
    out.resize(meshopt_encodeIndexSequenceBound(count, vertices));
    out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), count));
  }
  return out;
}

#if defined(__EMSCRIPTEN__)
constexpr bool kCanEncodeDraco = false;
inline FileBytes encodeDraco(const FileBytes&, const std::string&, const std::vector<std::uint32_t>&) {
  return {};
}
#else
constexpr bool kCanEncodeDraco = true;

/// Lossless, points and triangles in their order; the positions have the unique id 0.
/// @param elements  packed, of a PLY scalar type.
inline FileBytes encodeDraco(const FileBytes& elements, const std::string& component,
                             const std::vector<std::uint32_t>& corners) {
  const draco::DataType type = component == "float"   ? draco::DT_FLOAT32
                               : component == "char"  ? draco::DT_INT8
                               : component == "uchar" ? draco::DT_UINT8
                               : component == "short" ? draco::DT_INT16
                                                      : draco::DT_UINT16;
  const std::int64_t width = 3 * draco::DataTypeLength(type);
  const auto points = static_cast<std::uint32_t>(elements.size() / static_cast<std::size_t>(width));
  draco::Mesh mesh;
  mesh.set_num_points(points);
  draco::GeometryAttribute positions;
  positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, type, false, width, 0);
  const int id = mesh.AddAttribute(positions, true, points);
  for (std::uint32_t i = 0; i < points; ++i) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &elements[i * static_cast<std::size_t>(width)]);
  }
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    mesh.AddFace({draco::PointIndex(corners[i]), draco::PointIndex(corners[i + 1]), draco::PointIndex(corners[i + 2])});
  }
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  return {buffer.data(), buffer.data() + buffer.size()};
}
#endif

}  // namespace quadmark::test
