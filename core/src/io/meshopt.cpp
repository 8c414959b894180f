// SPDX-License-Identifier: MIT
#include "meshopt.h"

#include "concat.h"

namespace quadmark::io {
namespace {

/// 24 bits of mantissa and 8 of exponent become a float, in place. Exact but for underflow.
void undoExponential(std::vector<std::uint8_t>& bytes) {
  for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    const auto packed = load<std::uint32_t>(&bytes[at]);
    const std::uint32_t power = ((packed >> 24) + (packed >> 31 != 0 ? 127u - 256u : 127u)) << 23;
    const std::int32_t mantissa = static_cast<std::int32_t>((packed & 0xffffff) ^ 0x800000) - 0x800000;
    float scale;
    std::memcpy(&scale, &power, sizeof(scale));
    store(&bytes[at], scale * static_cast<float>(mantissa));
  }
}

}  // namespace

Result<std::vector<std::uint8_t>> decodeMeshopt(Bytes stream, const MeshoptLayout& layout, const std::string& place) {
  if (layout.filter != MeshoptFilter::none && layout.filter != MeshoptFilter::exponential) {
    return unsupportedFile(place + ": positions and indices with a filter for directions or colours");
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(layout.count * layout.byteStride));
  const bool ok = layout.mode == MeshoptMode::attributes  ? decodeMeshoptVertices(stream, layout, bytes.data())
                  : layout.mode == MeshoptMode::triangles ? decodeMeshoptTriangles(stream, layout, bytes.data())
                                                          : decodeMeshoptIndices(stream, layout, bytes.data());
  if (!ok) {
    return badFile(concat(place, ": the meshopt data is broken, or is not that of ", layout.count, " elements of ",
                          layout.byteStride, " bytes"));
  }
  if (layout.filter == MeshoptFilter::exponential) undoExponential(bytes);
  return bytes;
}

}  // namespace quadmark::io
