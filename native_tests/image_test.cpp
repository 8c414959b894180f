// SPDX-License-Identifier: MIT
#include "quadmark/image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "quadmark/random.h"

namespace quadmark {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A PNG writer of its own, stored deflate blocks and bitwise checksums, to have inputs that owe the product nothing.

void addBigEndian(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void addChunk(Bytes& out, const std::string& type, const Bytes& data) {
  addBigEndian(out, static_cast<std::uint32_t>(data.size()));
  Bytes body(type.begin(), type.end());
  body.insert(body.end(), data.begin(), data.end());
  std::uint32_t crc = 0xffffffffu;
  for (std::uint8_t byte : body) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? (crc >> 1) ^ 0xedb88320u : crc >> 1;
  }
  out.insert(out.end(), body.begin(), body.end());
  addBigEndian(out, ~crc);
}

Bytes stored(const Bytes& data) {
  Bytes out{0x78, 0x01};
  std::size_t at = 0;
  do {
    const auto length = static_cast<std::uint32_t>(std::min<std::size_t>(65535, data.size() - at));
    out.push_back(at + length == data.size());
    for (std::uint32_t word : {length, ~length})
      for (int shift : {0, 8}) out.push_back(static_cast<std::uint8_t>(word >> shift));
    out.insert(out.end(), data.begin() + static_cast<std::ptrdiff_t>(at),
               data.begin() + static_cast<std::ptrdiff_t>(at + length));
    at += length;
  } while (at < data.size());
  std::uint32_t a = 1, b = 0;
  for (std::uint8_t byte : data) a = (a + byte) % 65521, b = (b + a) % 65521;
  addBigEndian(out, b << 16 | a);
  return out;
}

struct Png {
  std::uint32_t width = 0, height = 0;
  std::uint8_t bitDepth = 8, colourType = 0, interlace = 0;
  Bytes rows;  // filter bytes included
  Bytes palette, transparency;
};

Bytes file(const Png& png, const Bytes& idat) {
  Bytes out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, header;
  addBigEndian(header, png.width);
  addBigEndian(header, png.height);
  header.insert(header.end(), {png.bitDepth, png.colourType, 0, 0, png.interlace});
  addChunk(out, "IHDR", header);
  if (!png.palette.empty()) addChunk(out, "PLTE", png.palette);
  if (!png.transparency.empty()) addChunk(out, "tRNS", png.transparency);
  addChunk(out, "IDAT", idat);
  addChunk(out, "IEND", {});
  return out;
}

Bytes file(const Png& png) {
  return file(png, stored(png.rows));
}

Bytes decoded(const Png& png, double threshold = 0.5) {
  const Result<BitImage> image = decodePng(file(png), {threshold});
  EXPECT_TRUE(image.ok()) << (image.ok() ? "" : image.error().message);
  return image.ok() ? image->bits : Bytes{};
}

BitImage randomImage(std::uint32_t width, std::uint32_t height, std::uint64_t seed) {
  Random random(seed);
  BitImage image{width, height, Bytes(std::size_t{width} * height)};
  for (std::uint8_t& bit : image.bits) bit = static_cast<std::uint8_t>(random.below(2));
  return image;
}

TEST(Image, ComesBackFromItsOwnPng) {
  const std::uint32_t sizes[][2] = {{24, 24}, {90, 90}, {7, 3},    {1, 2},    {8, 1},
                                    {9, 1},   {64, 1},  {1024, 1}, {1, 1024}, {1024, 1024}};
  for (const auto& size : sizes) {
    SCOPED_TRACE(std::to_string(size[0]) + " x " + std::to_string(size[1]));
    const BitImage image = randomImage(size[0], size[1], size[0] * 31 + size[1]);
    const Result<BitImage> back = decodePng(encodePng(image), {0.5});
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->width, image.width);
    EXPECT_EQ(back->height, image.height);
    EXPECT_EQ(back->bits, image.bits);
  }
}

TEST(Image, IsWrittenWithOneBitPerPixel) {
  const Bytes png = encodePng(randomImage(90, 90, 1));
  EXPECT_EQ(png[24], 1);  // bit depth
  EXPECT_EQ(png[25], 0);  // grey
  EXPECT_LT(png.size(), 90u * 13 + 100);
  EXPECT_LT(encodePng({90, 90, Bytes(8100, 0)}).size(), 150u);
}

TEST(Image, ShowsErasedPixelsInMidGrey) {
  const BitImage image{3, 1, {1, 0, 1}};
  const Bytes png = encodePng(image, Bytes{0, 0, 1});
  EXPECT_EQ(decodePng(png, {0.49})->bits, (Bytes{1, 0, 0}));
  EXPECT_EQ(decodePng(png, {0.51})->bits, (Bytes{1, 0, 1}));
  EXPECT_EQ(encodePng(image, Bytes{0, 0, 0}), encodePng(image));
}

TEST(Image, WritesConfidenceAsGrey) {
  const std::vector<float> values{0.0f, 0.25f, 0.5f, 1.0f, -3.0f, 7.0f};
  const Bytes png = encodeGreyPng(3, 2, values);
  EXPECT_EQ(decodePng(png, {0.2})->bits, (Bytes{1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(decodePng(png, {0.3})->bits, (Bytes{1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(decodePng(png, {1.0})->bits, (Bytes{1, 1, 1, 0, 1, 0}));
}

TEST(Image, ReadsGreyOfEveryDepth) {
  EXPECT_EQ(decoded({8, 1, 1, 0, 0, {0, 0b10110001}, {}, {}}), (Bytes{0, 1, 0, 0, 1, 1, 1, 0}));
  EXPECT_EQ(decoded({4, 1, 2, 0, 0, {0, 0b00011011}, {}, {}}), (Bytes{1, 1, 0, 0}));
  EXPECT_EQ(decoded({4, 1, 4, 0, 0, {0, 0x07, 0x8f}, {}, {}}), (Bytes{1, 1, 0, 0}));
  EXPECT_EQ(decoded({3, 1, 8, 0, 0, {0, 0, 127, 128}, {}, {}}), (Bytes{1, 1, 0}));
  EXPECT_EQ(decoded({2, 1, 16, 0, 0, {0, 0x7f, 0xff, 0x80, 0x00}, {}, {}}), (Bytes{1, 0}));
}

TEST(Image, WeighsColoursByRec709) {
  const Png rgb{3, 1, 8, 2, 0, {0, 255, 0, 0, 0, 255, 0, 0, 0, 255}, {}, {}};
  EXPECT_EQ(decoded(rgb, 0.0721), (Bytes{0, 0, 0}));
  EXPECT_EQ(decoded(rgb, 0.0723), (Bytes{0, 0, 1}));
  EXPECT_EQ(decoded(rgb, 0.2125), (Bytes{0, 0, 1}));
  EXPECT_EQ(decoded(rgb, 0.2127), (Bytes{1, 0, 1}));
  EXPECT_EQ(decoded(rgb, 0.7151), (Bytes{1, 0, 1}));
  EXPECT_EQ(decoded(rgb, 0.7153), (Bytes{1, 1, 1}));
}

TEST(Image, LaysTransparencyOverWhite) {
  const Png rgba{3, 1, 8, 6, 0, {0, 0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 128}, {}, {}};
  EXPECT_EQ(decoded(rgba, 0.49), (Bytes{1, 0, 0}));
  EXPECT_EQ(decoded(rgba, 0.51), (Bytes{1, 0, 1}));
  const Png greyAlpha{2, 1, 8, 4, 0, {0, 0, 255, 0, 0}, {}, {}};
  EXPECT_EQ(decoded(greyAlpha), (Bytes{1, 0}));
}

TEST(Image, ReadsPalettesWithTransparency) {
  const Bytes palette{0, 0, 0, 255, 255, 255, 10, 10, 10};
  EXPECT_EQ(decoded({4, 1, 8, 3, 0, {0, 0, 1, 2, 0}, palette, {}}), (Bytes{1, 0, 1, 1}));
  EXPECT_EQ(decoded({4, 1, 8, 3, 0, {0, 0, 1, 2, 0}, palette, {255, 255, 0}}), (Bytes{1, 0, 0, 1}));
  EXPECT_EQ(decoded({4, 2, 2, 3, 0, {0, 0b00011000, 0, 0b01010101}, palette, {}}), (Bytes{1, 0, 1, 1, 0, 0, 0, 0}));
}

TEST(Image, ReadsFiltersAndInterlacing) {
  // Row 2 by the filter "up": differences to row 1.
  EXPECT_EQ(decoded({3, 2, 8, 0, 0, {0, 0, 200, 0, 2, 255, 56, 10}, {}, {}}), (Bytes{1, 0, 1, 0, 1, 1}));
  // Adam7 of 2 x 2: pass 1 has pixel (0, 0), pass 6 (1, 0), pass 7 the second row.
  EXPECT_EQ(decoded({2, 2, 8, 0, 1, {0, 0, 0, 255, 0, 255, 0}, {}, {}}), (Bytes{1, 0, 0, 1}));
}

TEST(Image, FindsTheThresholdByOtsu) {
  Random random(1);
  Png png{40, 40, 8, 0, 0, {}, {}, {}};
  Bytes expected;
  for (int y = 0; y < 40; ++y) {
    png.rows.push_back(0);
    for (int x = 0; x < 40; ++x) {
      const bool ink = random.below(4) == 0;
      expected.push_back(ink);
      png.rows.push_back(static_cast<std::uint8_t>((ink ? 150 : 220) + random.below(21) - 10));
    }
  }
  EXPECT_EQ(decoded(png, -1), expected);  // all lighter than one half
  EXPECT_EQ(decoded(png, 0.5), Bytes(1600, 0));
}

TEST(Image, TakesTheMiddleBetweenTwoLevels) {
  const BitImage image = randomImage(20, 20, 9);
  EXPECT_EQ(decodePng(encodePng(image))->bits, image.bits);
  // 0 and 255 with a single pixel of 127 and 128 in between each fall to their nearer side only at a middle threshold.
  EXPECT_EQ(decodePng(file({2, 1, 8, 0, 0, {0, 10, 11}, {}, {}}))->bits, (Bytes{1, 0}));
}

TEST(Image, TakesAnImageOfOneLevelAsItLooks) {
  EXPECT_EQ(decodePng(file({2, 1, 8, 0, 0, {0, 30, 30}, {}, {}}))->bits, (Bytes{1, 1}));
  EXPECT_EQ(decodePng(file({2, 1, 8, 0, 0, {0, 230, 230}, {}, {}}))->bits, (Bytes{0, 0}));
}

void expectError(std::span<const std::uint8_t> png, ErrorCode code, const std::string& part,
                 const ThresholdOptions& options = {}) {
  const Result<BitImage> image = decodePng(png, options);
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().code, code) << image.error().message;
  EXPECT_NE(image.error().message.find(part), std::string::npos) << image.error().message;
}

TEST(Image, RefusesWhatIsNotAPng) {
  expectError({}, ErrorCode::badImage, "not a PNG");
  const Bytes jpeg{0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F', 0, 1};
  expectError(jpeg, ErrorCode::badImage, "not a PNG");
}

TEST(Image, RefusesEveryTruncation) {
  const Bytes png = encodePng(randomImage(24, 24, 1));
  for (std::size_t length = 0; length < png.size(); ++length) {
    const Result<BitImage> image = decodePng(std::span(png).first(length));
    ASSERT_FALSE(image.ok()) << length;
    ASSERT_EQ(image.error().code, ErrorCode::badImage) << length;
  }
}

TEST(Image, RefusesEveryChangedByte) {
  const Bytes png = encodePng(randomImage(24, 24, 1));
  for (std::size_t at = 0; at < png.size(); ++at) {
    Bytes broken = png;
    broken[at] ^= 0x10;
    ASSERT_FALSE(decodePng(broken).ok()) << at;
  }
}

TEST(Image, NamesTheBrokenChunk) {
  Bytes png = encodePng(randomImage(24, 24, 1));
  png[45] ^= 1;  // inside IDAT, which begins at byte 33
  expectError(png, ErrorCode::badImage, "checksum of the chunk at byte 33");
  png = encodePng(randomImage(24, 24, 1));
  png[33] = 0x7f;
  expectError(png, ErrorCode::badImage, "chunk at byte 33 claims 21");
}

TEST(Image, RefusesSizesItCannotUse) {
  expectError(file({1, 1, 8, 0, 0, {0, 0}, {}, {}}), ErrorCode::badImage, "single pixel");
  expectError(file({0, 5, 8, 0, 0, {0}, {}, {}}), ErrorCode::badImage, "no pixels");
  expectError(file({5, 0, 8, 0, 0, {0}, {}, {}}), ErrorCode::badImage, "no pixels");
  expectError(file({1025, 1, 1, 0, 0, Bytes(130, 0), {}, {}}), ErrorCode::tooLarge, "1025 x 1");
  expectError(file({0xffffffffu, 0xffffffffu, 8, 6, 0, {0}, {}, {}}), ErrorCode::tooLarge, "4294967295");
}

TEST(Image, RefusesBrokenPixels) {
  expectError(file({8, 8, 8, 0, 0, Bytes(20, 0), {}, {}}), ErrorCode::badImage, "decoded");  // too few
  expectError(file({8, 8, 3, 0, 0, Bytes(72, 0), {}, {}}), ErrorCode::badImage, "decoded");  // depth 3
  expectError(file({8, 8, 8, 3, 0, Bytes(72, 0), {}, {}}), ErrorCode::badImage, "decoded");  // no palette
  expectError(file({8, 8, 8, 0, 0, {9, 0}, {}, {}}, {0x78, 0x01, 0xff}), ErrorCode::badImage, "decoded");
}

TEST(Image, RefusesADeflateBomb) {
  // Fixed Huffman codes: one zero byte, then 100 MB as matches of length 258 at distance 1, 13 bits each.
  Bytes packed{0x78, 0x01};
  std::uint32_t pending = 0;
  int count = 0;
  const auto bits = [&](std::uint32_t value, int length) {
    for (int i = 0; i < length; ++i) {
      pending |= ((value >> i) & 1) << count;
      if (++count < 8) continue;
      packed.push_back(static_cast<std::uint8_t>(pending));
      pending = 0;
      count = 0;
    }
  };
  bits(0b011, 3);       // last block, fixed codes
  bits(0b00001100, 8);  // literal 0, code 00110000 from its high bit
  for (int i = 0; i < 400000; ++i) {
    bits(0b10100011, 8);  // length 258, code 11000101
    bits(0, 5);           // distance 1
  }
  bits(0, 7);  // end of block
  bits(0, 7);
  expectError(file({8, 8, 8, 0, 0, {}, {}, {}}, packed), ErrorCode::badImage, "decoded");
}

TEST(Image, RefusesThresholdsOutOfRange) {
  const Bytes png = encodePng(randomImage(4, 4, 1));
  expectError(png, ErrorCode::badOption, "threshold", {1.5});
  expectError(png, ErrorCode::badOption, "threshold", {std::numeric_limits<double>::quiet_NaN()});
}

}  // namespace
}  // namespace quadmark
