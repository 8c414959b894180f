// SPDX-License-Identifier: MIT
// Vertex codecs 0 and 1. Vertices come in blocks; within a block each byte of the vertex is a plane of its own, in
// groups of 16 whose values are packed into 0, 1, 2, 4 or 8 bits with an escape; values are differences to the vertex
// before.
#include <algorithm>

#include "meshopt.h"

namespace quadmark::io {
namespace {

constexpr std::size_t kGroup = 16;
constexpr std::size_t kMostPerBlock = 256;
constexpr std::size_t kBlockBytes = 8192;
constexpr std::size_t kLargestStride = 256;

/// Hands out the bytes of a stream in order.
class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(bytes) {}

  /// The next `count` bytes, or null when there are fewer.
  const std::uint8_t* take(std::size_t count) {
    if (bytes_.size() - at_ < count) return nullptr;
    at_ += count;
    return bytes_.data() + at_ - count;
  }
  [[nodiscard]] bool isAtEnd() const { return at_ == bytes_.size(); }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

/// Unpacks the 16 values of a group. Values that fill their bits completely are escapes for whole bytes that follow.
bool readGroup(Reader& reader, unsigned bits, std::uint8_t* values) {
  if (bits == 0) {
    std::fill_n(values, kGroup, std::uint8_t{0});
    return true;
  }
  const std::uint8_t* packed = reader.take(kGroup * bits / 8);
  if (packed == nullptr) return false;
  if (bits == 8) {
    std::copy_n(packed, kGroup, values);
    return true;
  }
  const unsigned perByte = 8 / bits, escape = (1u << bits) - 1;
  for (unsigned i = 0; i < kGroup; ++i) {
    const unsigned place = i % perByte;
    const unsigned shift = bits == 1 ? place : 8 - bits * (place + 1);  // single bits begin at the low end
    unsigned value = packed[i / perByte] >> shift & escape;
    if (value == escape) {
      const std::uint8_t* whole = reader.take(1);
      if (whole == nullptr) return false;
      value = *whole;
    }
    values[i] = static_cast<std::uint8_t>(value);
  }
  return true;
}

/// The widths that a group's two header bits choose from.
using Widths = unsigned[4];
constexpr Widths kWidthsOfCodec0 = {0, 2, 4, 8};
constexpr Widths kWidthsOfControl0 = {0, 1, 2, 4};
constexpr Widths kWidthsOfControl1 = {1, 2, 4, 8};

/// One byte of `count` vertices; `plane` has room for whole groups.
bool readPlane(Reader& reader, const Widths& widths, std::size_t count, std::uint8_t* plane) {
  const std::size_t groups = (count + kGroup - 1) / kGroup;
  const std::uint8_t* header = reader.take((groups + 3) / 4);
  if (header == nullptr) return false;
  for (std::size_t group = 0; group < groups; ++group) {
    const unsigned choice = header[group / 4] >> (group % 4 * 2) & 3;
    if (!readGroup(reader, widths[choice], plane + group * kGroup)) return false;
  }
  return true;
}

/// Codec 1 says per plane how it is stored: two sets of widths, all zeros, or plain bytes.
bool readControlledPlane(Reader& reader, unsigned control, std::size_t count, std::uint8_t* plane) {
  if (control < 2) return readPlane(reader, control == 0 ? kWidthsOfControl0 : kWidthsOfControl1, count, plane);
  if (control == 2) {
    std::fill_n(plane, count, std::uint8_t{0});
    return true;
  }
  const std::uint8_t* plain = reader.take(count);
  if (plain != nullptr) std::copy_n(plain, count, plane);
  return plain != nullptr;
}

/// Differences are stored as 2d for d >= 0 and -2d - 1 for d < 0.
template <class T>
T fromZigzag(T value) {
  return static_cast<T>((value & 1) != 0 ? ~(value >> 1) : value >> 1);
}

template <class T>
T add(T previous, T stored) {
  return static_cast<T>(previous + fromZigzag(stored));
}

/// Adds the differences of 4 bytes of a vertex to those of the vertex before, as bytes, 16-bit or 32-bit words.
void addDifference(std::uint8_t channel, const std::uint8_t* stored, std::uint8_t* value) {
  switch (channel & 3) {
    case 0:
      for (int i = 0; i < 4; ++i) value[i] = add(value[i], stored[i]);
      break;
    case 1:
      for (int i = 0; i < 4; i += 2)
        store(value + i, add(load<std::uint16_t>(value + i), load<std::uint16_t>(stored + i)));
      break;
    default: {
      const auto word = load<std::uint32_t>(stored);
      const unsigned turn = channel >> 4;
      const std::uint32_t turned = turn == 0 ? word : word >> turn | word << (32 - turn);
      store(value, load<std::uint32_t>(value) ^ turned);
    }
  }
}

}  // namespace

bool decodeMeshoptVertices(Bytes stream, const MeshoptLayout& layout, std::uint8_t* out) {
  // 1. The tail: the values before the first vertex and, in codec 1, how each 4 bytes are added.
  const std::size_t stride = layout.byteStride;
  if (stride == 0 || stride % 4 != 0 || stride > kLargestStride || stream.empty()) return false;
  const bool isCodec1 = stream[0] == 0xa1;
  if (stream[0] != 0xa0 && !isCodec1) return false;
  const std::size_t tail = isCodec1 ? stride + stride / 4 : stride;
  const std::size_t paddedTail = std::max<std::size_t>(tail, isCodec1 ? 24 : 32);
  if (stream.size() < 1 + paddedTail) return false;
  std::uint8_t previous[kLargestStride], channels[kLargestStride / 4] = {};
  std::copy_n(stream.data() + stream.size() - tail, stride, previous);
  if (isCodec1) std::copy_n(stream.data() + stream.size() - tail + stride, stride / 4, channels);
  for (const std::uint8_t channel : channels) {
    if ((channel & 3) == 3) return false;
  }

  // 2. Blocks.
  Reader reader(stream.subspan(1, stream.size() - 1 - paddedTail));
  const std::size_t perBlock = std::min(kBlockBytes / stride / kGroup * kGroup, kMostPerBlock);
  std::vector<std::uint8_t> planes(stride * kMostPerBlock);
  for (std::uint64_t first = 0; first < layout.count; first += perBlock) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(perBlock, layout.count - first));
    const std::uint8_t* controls = isCodec1 ? reader.take(stride / 4) : nullptr;
    if (isCodec1 && controls == nullptr) return false;
    for (std::size_t byte = 0; byte < stride; ++byte) {
      std::uint8_t* plane = &planes[byte * kMostPerBlock];
      const bool ok = isCodec1 ? readControlledPlane(reader, controls[byte / 4] >> (byte % 4 * 2) & 3u, count, plane)
                               : readPlane(reader, kWidthsOfCodec0, count, plane);
      if (!ok) return false;
    }
    for (std::size_t i = 0; i < count; ++i, out += stride) {
      for (std::size_t at = 0; at < stride; at += 4) {
        std::uint8_t stored[4];
        for (std::size_t k = 0; k < 4; ++k) stored[k] = planes[(at + k) * kMostPerBlock + i];
        addDifference(channels[at / 4], stored, previous + at);
      }
      std::copy_n(previous, stride, out);
    }
  }
  return reader.isAtEnd();
}

}  // namespace quadmark::io
