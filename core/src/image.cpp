// SPDX-License-Identifier: MIT
// PNG (W3C recommendation, second edition) by stb_image behind our own check of the chunks: stb looks at no checksum
// and takes a truncated file for a complete one where the pixels happen to suffice.
#include "quadmark/image.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "concat.h"
#include "stb.h"

namespace quadmark {
namespace {

constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

std::uint32_t bigEndian32(const std::uint8_t* p) {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | p[3];
}

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      t[i] = i;
      for (int bit = 0; bit < 8; ++bit) t[i] = (t[i] >> 1) ^ (t[i] & 1 ? 0xedb88320u : 0);
    }
    return t;
  }();
  std::uint32_t crc = 0xffffffffu;
  for (std::uint8_t b : bytes) crc = table[(crc ^ b) & 0xff] ^ (crc >> 8);
  return ~crc;
}

Error badImage(const std::string& message) {
  return {ErrorCode::badImage, "PNG: " + message};
}

/// Signature, header, every chunk's length and checksum, up to IEND.
Status checkChunks(std::span<const std::uint8_t> png) {
  if (png.size() < kSignature.size() || !std::equal(kSignature.begin(), kSignature.end(), png.begin()))
    return badImage("the signature is missing, this is not a PNG");
  std::size_t at = kSignature.size();
  for (bool first = true;; first = false) {
    const std::string place = concat(" at byte ", at);
    if (png.size() - at < 12) return badImage("truncated: no room for a chunk" + place);
    const std::size_t length = bigEndian32(&png[at]);
    if (length > png.size() - at - 12)
      return badImage(concat("chunk", place, " claims ", length, " bytes, ", png.size() - at - 12, " are left"));
    const auto body = png.subspan(at + 4, 4 + length);
    if (crc32(body) != bigEndian32(&png[at + 8 + length])) return badImage("wrong checksum of the chunk" + place);
    const std::string_view type(reinterpret_cast<const char*>(body.data()), 4);
    if (first) {
      if (type != "IHDR" || length != 13) return badImage("the first chunk is not a header of 13 bytes");
      const std::uint32_t width = bigEndian32(&body[4]), height = bigEndian32(&body[8]);
      if (width == 0 || height == 0) return badImage("the image has no pixels");
      if (width > kMaxImageSide || height > kMaxImageSide)
        return Error{ErrorCode::tooLarge,
                     concat("PNG: ", width, " x ", height, " pixels, at most ", kMaxImageSide, " each way")};
      if (width == 1 && height == 1) return badImage("a single pixel is no watermark");
    }
    if (type == "IEND") return okStatus();
    at += 12 + length;
  }
}

/// Rec. 709 luma of an RGBA pixel over white, 0 .. kWhite. Integers, so that every platform agrees.
constexpr std::uint32_t kWhite = 10000 * 255;
std::uint32_t luminance(const std::uint8_t* rgba) {
  const std::uint64_t ink = 2126u * rgba[0] + 7152u * rgba[1] + 722u * rgba[2];
  return static_cast<std::uint32_t>((ink * rgba[3] + std::uint64_t{kWhite} * (255u - rgba[3]) + 127) / 255);
}

/// Otsu 1979: the threshold that separates two classes best, over 256 levels. Between the levels of a two-level image
/// every threshold is as good; the middle one is taken. A single level has no classes: dark is ink, light is not.
std::uint32_t otsuThreshold(const std::vector<std::uint32_t>& values) {
  const auto levelOf = [](std::uint32_t value) { return (value + 5000) / 10000; };
  std::array<std::uint64_t, 256> histogram{};
  for (std::uint32_t value : values) ++histogram[levelOf(value)];
  double count = static_cast<double>(values.size()), sum = 0;
  for (std::size_t i = 0; i < 256; ++i) sum += static_cast<double>(i * histogram[i]);
  double below = 0, sumBelow = 0, best = 0;
  std::size_t first = 127, last = 127;
  for (std::size_t i = 0; i < 255; ++i) {
    below += static_cast<double>(histogram[i]);
    sumBelow += static_cast<double>(i * histogram[i]);
    if (below == 0 || below == count) continue;
    const double difference = sumBelow * count - sum * below;  // exact: integers below 2^53
    const double between = difference * difference / (below * (count - below));
    if (between > best) first = i, best = between;
    if (between >= best) last = i;
  }
  return static_cast<std::uint32_t>(5000 * (first + last + 1));  // between the levels i and i + 1
}

void appendBigEndian32(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void appendChunk(std::vector<std::uint8_t>& out, std::string_view type, std::span<const std::uint8_t> data) {
  appendBigEndian32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  appendBigEndian32(out, crc32(std::span(out).subspan(begin)));
}

/// @param rows  filter byte 0 and packed pixels, row after row.
std::vector<std::uint8_t> greyPng(std::uint32_t width, std::uint32_t height, std::uint8_t bitDepth,
                                  std::vector<std::uint8_t> rows) {
  std::vector<std::uint8_t> header, out(kSignature.begin(), kSignature.end());
  appendBigEndian32(header, width);
  appendBigEndian32(header, height);
  header.insert(header.end(), {bitDepth, 0, 0, 0, 0});  // grey, deflate, adaptive filters, not interlaced
  appendChunk(out, "IHDR", header);
  appendChunk(out, "IDAT", detail::zlibCompress(std::move(rows)));
  appendChunk(out, "IEND", {});
  return out;
}

}  // namespace

Result<BitImage> decodePng(std::span<const std::uint8_t> png, const ThresholdOptions& options) {
  if (options.threshold > 1 || std::isnan(options.threshold))
    return Error{ErrorCode::badOption, "threshold must lie in 0..1, or be negative to have it chosen"};
  if (const Status status = checkChunks(png); !status) return status.error();
  BitImage image;
  const char* failure = nullptr;
  const std::vector<std::uint8_t> rgba = detail::decodePngRgba(png, image.width, image.height, failure);
  if (rgba.empty()) return badImage(std::string("pixels cannot be decoded: ") + failure);
  std::vector<std::uint32_t> values(rgba.size() / 4);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = luminance(&rgba[4 * i]);
  const double threshold = options.threshold < 0 ? otsuThreshold(values) : options.threshold * kWhite;
  image.bits.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) image.bits[i] = values[i] < threshold;
  return image;
}

std::vector<std::uint8_t> encodePng(const BitImage& image, std::span<const std::uint8_t> erased) {
  assert(image.bits.size() == std::size_t{image.width} * image.height);
  assert(erased.empty() || erased.size() == image.bits.size());
  // One bit per pixel has no room for grey: images with erasures are written with eight.
  const bool grey = std::any_of(erased.begin(), erased.end(), [](std::uint8_t e) { return e != 0; });
  std::vector<std::uint8_t> rows;
  rows.reserve((std::size_t{image.width} + 1) * image.height);
  for (std::uint32_t y = 0; y < image.height; ++y) {
    const std::size_t row = std::size_t{y} * image.width;
    rows.push_back(0);
    if (grey) {
      for (std::size_t i = row; i < row + image.width; ++i) {
        const bool ink = image.bits[i] != 0;
        rows.push_back(erased[i] != 0 ? 128 : ink ? 0 : 255);
      }
    } else {
      for (std::uint32_t x = 0; x < image.width; x += 8) {
        std::uint32_t packed = 0;
        for (std::uint32_t i = 0; i < 8 && x + i < image.width; ++i)
          if (image.bits[row + x + i] == 0) packed |= 0x80u >> i;  // 1 is white
        rows.push_back(static_cast<std::uint8_t>(packed));
      }
    }
  }
  return greyPng(image.width, image.height, grey ? 8 : 1, std::move(rows));
}

std::vector<std::uint8_t> encodeGreyPng(std::uint32_t width, std::uint32_t height, std::span<const float> values) {
  assert(values.size() == std::size_t{width} * height);
  std::vector<std::uint8_t> rows;
  rows.reserve((std::size_t{width} + 1) * height);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i % width == 0) rows.push_back(0);
    const float value = values[i];
    const float held = value > 0 ? std::min(value, 1.0f) : 0.0f;  // NaN is black
    rows.push_back(static_cast<std::uint8_t>(255 * held + 0.5f));
  }
  return greyPng(width, height, 8, std::move(rows));
}

}  // namespace quadmark
