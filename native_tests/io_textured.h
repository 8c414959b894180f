// SPDX-License-Identifier: MIT
// A plane with a texture, written in every way that a glTF knows.
#pragma once

#include "io_compress.h"
#include "io_fixtures.h"

namespace quadmark::test {

/// The header of a PNG of 300 x 200 pixels.
inline FileBytes png() {
  return fromHex("89504e470d0a1a0a0000000d494844520000012c000000c8080200000000000000");
}

/// A tilted plane of 4 x 4 vertices, 3 units wide and 6 high; u grows by .125 a unit of width, v by .0625 a unit of height.
inline constexpr double kAcross[3] = {0.8, 0.6, 0}, kUp[3] = {0, 0, 1}, kOut[3] = {0.6, -0.8, 0};
inline constexpr double kPerWidth = 0.125, kPerHeight = 0.0625;

/// How the plane is textured.
struct Textured {
  std::string component = "float";  // of the coordinates; integers are normalized
  std::string texture = R"({"index":0})";
  std::string image = R"({"bufferView":3,"mimeType":"image/png"})";
  std::string slot = "baseColorTexture";
  std::string set = "TEXCOORD_0";
  bool compressed = false;
  std::size_t coordinates = 16;
};

inline std::vector<std::vector<int>> planeTriangles() {
  std::vector<std::vector<int>> faces;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const int a = 4 * row + column;
      faces.push_back({a, a + 1, a + 5});
      faces.push_back({a, a + 5, a + 4});
    }
  }
  return faces;
}

inline std::vector<double> planePositions(double across = 0, double up = 0, double out = 0) {
  std::vector<double> positions;
  for (int i = 0; i < 16; ++i) {
    for (int axis = 0; axis < 3; ++axis)
      positions.push_back((i % 4 + across) * kAcross[axis] + (2 * (i / 4) + up) * kUp[axis] + out * kOut[axis]);
  }
  return positions;
}

/// @param positions  as stored, in floats.
inline FileBytes planeFile(const Textured& spec, const std::vector<double>& positions) {
  BufferBuilder buffer;
  buffer.floats(positions);
  const std::size_t indices = buffer.indices("ushort", planeTriangles());
  FileBytes plain;
  const double one = spec.component == "float" ? 1 : spec.component == "ushort" ? 65535 : 255;
  for (int i = 0; i < 16; ++i) {
    appendScalar(plain, spec.component, i % 4 * kPerWidth * one, io::ByteOrder::little);
    appendScalar(plain, spec.component, 2 * (i / 4) * kPerHeight * one, io::ByteOrder::little);
    while (plain.size() % 4 != 0) plain.push_back(0);
  }
  const std::size_t stride = plain.size() / 16;
  const FileBytes stored = spec.compressed ? encodeMeshopt(plain, 16, stride, "ATTRIBUTES") : plain;
  const std::size_t coordinates = buffer.bytes.size();
  buffer.bytes.insert(buffer.bytes.end(), stored.begin(), stored.end());
  const std::size_t image = buffer.bytes.size(), imageBytes = png().size();
  for (const std::uint8_t byte : png()) buffer.bytes.push_back(byte);
  const auto text = [](std::size_t value) { return std::to_string(value); };
  const std::string type = spec.component == "float" ? "5126" : spec.component == "ushort" ? "5123" : "5121";
  const std::string range = R"("byteOffset":)" + text(coordinates) + R"(,"byteLength":)";
  const std::string view =
      spec.compressed
          ? R"({"buffer":0,"byteLength":)" + text(plain.size()) + R"(,"byteStride":)" + text(stride) +
                R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,)" + range + text(stored.size()) +
                R"(,"byteStride":)" + text(stride) + R"(,"count":16,"mode":"ATTRIBUTES"}}})"
          : R"({"buffer":0,)" + range + text(plain.size()) + R"(,"byteStride":)" + text(stride) + "}";
  const std::string info = R"({")" + spec.slot + R"(":)" + spec.texture + "}";
  return makeGlb(
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":)" + text(buffer.bytes.size()) +
          R"(}],"bufferViews":[{"buffer":0,"byteLength":192},{"buffer":0,"byteOffset":192,"byteLength":)" +
          text(indices == 192 ? 108 : 0) + "}," + view + R"(,{"buffer":0,"byteOffset":)" + text(image) +
          R"(,"byteLength":)" + text(imageBytes) +
          R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":16,"type":"VEC3"},)"
          R"({"bufferView":1,"componentType":5123,"count":54,"type":"SCALAR"},{"bufferView":2,"normalized":true,"componentType":)" +
          type + R"(,"count":)" + text(spec.coordinates) +
          R"(,"type":"VEC2"}],"images":[)" + spec.image + R"(],"textures":[{"source":0}],"materials":[{"name":"plain"},)" +
          (spec.slot == "baseColorTexture" ? R"({"pbrMetallicRoughness":)" + info + "}"
           : spec.slot == "sheenColorTexture"
               ? R"({"extensions":{"KHR_materials_sheen":)" + info + "}}"
               : info) +
          R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0,")" + spec.set +
          R"(":2},"indices":1,"material":1}]}],"nodes":[{"mesh":0}]})",
      buffer.bytes);
}

}  // namespace quadmark::test
