// SPDX-License-Identifier: MIT
#include "image_size.h"

#include <algorithm>

namespace quadmark::io {
namespace {

using Size = std::array<std::uint32_t, 2>;

template <class T>
std::uint32_t at(Bytes file, std::size_t offset, ByteOrder order = ByteOrder::little) {
  return offset + sizeof(T) <= file.size() ? load<T>(file.data() + offset, order) : 0;
}

// The frame header follows segments of any length (ITU-T T.81, annex B).
Size jpegSize(Bytes file) {
  for (std::size_t i = 2; i + 9 <= file.size() && file[i] == 0xff;) {
    const std::uint8_t marker = file[i + 1];
    if (marker == 0xff) {  // filling
      ++i;
      continue;
    }
    const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) return {at<std::uint16_t>(file, i + 7, ByteOrder::big), at<std::uint16_t>(file, i + 5, ByteOrder::big)};
    i += 2 + std::size_t{at<std::uint16_t>(file, i + 2, ByteOrder::big)};
  }
  return {0, 0};
}

// RFC 9649: a lossy, a lossless or an extended file.
Size webpSize(Bytes file) {
  const std::string_view kind = asText(file).substr(12, 4);
  if (kind == "VP8 ") return {at<std::uint16_t>(file, 26) & 0x3fff, at<std::uint16_t>(file, 28) & 0x3fff};
  if (kind == "VP8L" && file.size() >= 25) {
    const std::uint32_t bits = at<std::uint32_t>(file, 21);
    return {(bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1};
  }
  if (kind != "VP8X" || file.size() < 30) return {0, 0};
  return {(at<std::uint32_t>(file, 24) & 0xffffff) + 1, (at<std::uint32_t>(file, 26) >> 8) + 1};
}

}  // namespace

std::optional<Size> imageSize(Bytes file) {
  constexpr ByteOrder big = ByteOrder::big;
  const std::string_view text = asText(file);
  Size size{0, 0};
  if (text.starts_with("\x89PNG\r\n\x1a\n"))
    size = {at<std::uint32_t>(file, 16, big), at<std::uint32_t>(file, 20, big)};
  if (text.starts_with("\xff\xd8")) size = jpegSize(file);
  if (text.starts_with("\xabKTX 20")) size = {at<std::uint32_t>(file, 20), at<std::uint32_t>(file, 24)};
  if (text.starts_with("RIFF") && text.substr(std::min<std::size_t>(8, text.size()), 4) == "WEBP" && file.size() > 16)
    size = webpSize(file);
  if (size[0] == 0 || size[1] == 0) return std::nullopt;
  return size;
}

}  // namespace quadmark::io
