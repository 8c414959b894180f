// SPDX-License-Identifier: MIT
// The codecs of EXT_meshopt_compression and KHR_meshopt_compression: a compressed bufferView to its plain bytes.
//
// Own code, from the extension's specification: the library in the distributions knows neither vertex codec 1 nor is it
// meant for hostile streams. Results are checked against the npm package's encoder and decoder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bytes.h"

namespace quadmark::io {

enum class MeshoptMode : std::uint8_t { attributes, triangles, indices };

/// Positions come with the filters none and exponential; the others are for unit vectors, rotations and colours.
enum class MeshoptFilter : std::uint8_t { none, octahedral, quaternion, exponential, color };

/// How a stream says it is to be read.
struct MeshoptLayout {
  MeshoptMode mode = MeshoptMode::attributes;
  MeshoptFilter filter = MeshoptFilter::none;
  std::uint64_t count = 0;       ///< elements
  std::uint32_t byteStride = 0;  ///< bytes per element: a multiple of 4 up to 256, of triangles and indices 2 or 4
};

/// Decodes a stream of vertex codec 0 or 1, index codec 1 or index sequence codec 1.
/// @param layout  the caller has checked that count * byteStride bytes may be allocated.
/// @param place   named in errors, for example "bufferView 2".
/// @return count * byteStride bytes. Fails with badFile for a stream that ends early, goes on behind its end or is of
///         another codec, and with unsupportedFile for filters that positions never use.
Result<std::vector<std::uint8_t>> decodeMeshopt(Bytes stream, const MeshoptLayout& layout, const std::string& place);

/// The two kinds of streams, for decodeMeshopt(): false when the stream is broken. `out` has count * byteStride bytes.
bool decodeMeshoptVertices(Bytes stream, const MeshoptLayout& layout, std::uint8_t* out);
bool decodeMeshoptTriangles(Bytes stream, const MeshoptLayout& layout, std::uint8_t* out);
bool decodeMeshoptIndices(Bytes stream, const MeshoptLayout& layout, std::uint8_t* out);

}  // namespace quadmark::io
