// SPDX-License-Identifier: MIT
// How far textures slide, on a plane where that is known exactly, and what the reader makes of images and materials.
#include <gtest/gtest.h>

#include <cmath>

#include "io/image_size.h"
#include "io_textured.h"

namespace quadmark::test {
namespace {

// Headers as the formats' specifications lay them out, for pictures of 300 x 200 pixels; png() is another one.
FileBytes jpeg() {  // after an APP0 segment, filling bytes and a table: a progressive frame
  return fromHex("ffd8ffe000104a46494600010100000100010000ffffffdb0004aabbffc2001108"
                 "00c8012c03012200021101031101");
}
FileBytes webp(const std::string& kind) {
  if (kind == "VP8 ") return fromHex("52494646000000005745425056503820000000000000009d012a2c41c8c0");
  if (kind == "VP8L") return fromHex("52494646000000005745425056503" "84c000000002f2bc13100");
  return fromHex("5249464600000000574542505650385" "80a000000000000002b0100c70000");
}
FileBytes ktx2() {
  return fromHex("ab4b5458203230bb0d0a1a0a00000000010000002c010000c800000000000000");
}

TEST(ImageSize, IsReadFromTheHeadersOfAllFormats) {
  const std::array<std::uint32_t, 2> size{300, 200};
  EXPECT_EQ(io::imageSize(png()), size);
  EXPECT_EQ(io::imageSize(jpeg()), size);
  EXPECT_EQ(io::imageSize(webp("VP8 ")), size);  // whose upper two bits are a hint on scaling
  EXPECT_EQ(io::imageSize(webp("VP8L")), size);
  EXPECT_EQ(io::imageSize(webp("VP8X")), size);
  EXPECT_EQ(io::imageSize(ktx2()), size);
}

TEST(ImageSize, IsNothingForOtherAndForShortFiles) {
  EXPECT_EQ(io::imageSize({}), std::nullopt);
  EXPECT_EQ(io::imageSize(bytesOf("GIF89a-and-so-on")), std::nullopt);
  for (const FileBytes& whole : {png(), jpeg(), webp("VP8 "), webp("VP8L"), webp("VP8X"), ktx2()}) {
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const FileBytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
      const std::array<std::uint32_t, 2> size{300, 200};
      EXPECT_EQ(io::imageSize(cut).value_or(size), size) << length;
    }
  }
  EXPECT_EQ(io::imageSize(fromHex("ffd8ffe00000ffe00000ffe00000")), std::nullopt);  // a segment that ends before it begins
}

std::optional<TextureShift> shiftOf(const Textured& spec, double across, double up, double out = 0,
                                    const Resources& resources = {}) {
  return textureShift(planeFile(spec, planePositions(across, up, out)), resources, planePositions());
}

constexpr double kClose = 1e-5;  // floats of about 1

TEST(TextureShift, IsTheDisplacementAlongThePlaneInTexels) {
  const auto shift = shiftOf({}, 0.1, 0);
  ASSERT_TRUE(shift);
  EXPECT_NEAR(shift->uv, 0.1 * kPerWidth, kClose);
  ASSERT_TRUE(shift->texels);
  EXPECT_NEAR(*shift->texels, 0.1 * kPerWidth * 300, 300 * kClose);
  EXPECT_EQ(shift->place, "mesh 0 primitive 0");
  EXPECT_NEAR(*shiftOf({}, 0, 0.1)->texels, 0.1 * kPerHeight * 200, 200 * kClose);
  EXPECT_NEAR(shiftOf({}, 0.3, 0.4)->uv, std::hypot(0.3 * kPerWidth, 0.4 * kPerHeight), kClose);
}

TEST(TextureShift, IsNoneAcrossThePlaneAndForAModelThatDidNotMove) {
  EXPECT_NEAR(shiftOf({}, 0, 0, 0.25)->uv, 0, kClose);
  const FileBytes file = planeFile({}, planePositions());
  EXPECT_EQ(textureShift(file, {}, (*readModel(file))->mesh().positions)->uv, 0);
}

TEST(TextureShift, KnowsEveryWayToSayTheCoordinates) {
  const double expected = 0.1 * kPerWidth;
  for (const bool compressed : {false, true}) {
    EXPECT_NEAR(shiftOf({.compressed = compressed}, 0.1, 0)->uv, expected, kClose);
    EXPECT_NEAR(shiftOf({.component = "ushort", .compressed = compressed}, 0.1, 0)->uv, expected, 5e-5);
    EXPECT_NEAR(shiftOf({.component = "uchar", .compressed = compressed}, 0.1, 0)->uv, expected, 5e-3);
  }
  const std::string scaled = R"({"index":0,"extensions":{"KHR_texture_transform":{"scale":[4,5e-1]}}})";
  EXPECT_NEAR(shiftOf({.texture = scaled}, 0.1, 0)->uv, 4 * expected, 4 * kClose);
  EXPECT_NEAR(shiftOf({.texture = scaled}, 0, 0.1)->uv, 0.05 * kPerHeight, kClose);
  const std::string second = R"({"index":0,"texCoord":1})";
  EXPECT_FALSE(shiftOf({.texture = second}, 0.1, 0));
  EXPECT_NEAR(shiftOf({.texture = second, .set = "TEXCOORD_1"}, 0.1, 0)->uv, expected, kClose);
  const std::string moved = R"({"index":0,"texCoord":7,"extensions":{"KHR_texture_transform":{"texCoord":0}}})";
  EXPECT_NEAR(shiftOf({.texture = moved}, 0.1, 0)->uv, expected, kClose);
}

TEST(TextureShift, LooksAtEveryTextureOfAMaterial) {
  for (const char* slot : {"normalTexture", "emissiveTexture", "occlusionTexture", "sheenColorTexture"})
    EXPECT_TRUE(shiftOf({.slot = slot}, 0.1, 0)) << slot;
}

TEST(TextureShift, FindsImagesInsideAndOutsideOfTheFile) {
  const double texels = 0.1 * kPerWidth * 300;
  const std::string inside = R"({"uri":"data:image\/png;base64,)" + base64(png()) + R"("})";
  EXPECT_NEAR(*shiftOf({.image = inside}, 0.1, 0)->texels, texels, 300 * kClose);
  const std::string outside = R"({"uri":"wood.png"})";
  EXPECT_NEAR(*shiftOf({.image = outside}, 0.1, 0, 0, {{"wood.png", png()}})->texels, texels, 300 * kClose);
  for (const char* unknown : {R"({"uri":"wood.png"})", R"({"uri":"data:image/png;base64,!!"})", R"({"bufferView":99})", "{}"}) {
    const auto shift = shiftOf({.image = unknown}, 0.1, 0);
    ASSERT_TRUE(shift) << unknown;
    EXPECT_FALSE(shift->texels) << unknown;
    EXPECT_NEAR(shift->uv, 0.1 * kPerWidth, kClose) << unknown;
  }
}

TEST(TextureShift, IsNothingWithoutCoordinatesOrWithBrokenOnes) {
  EXPECT_FALSE(shiftOf({.texture = R"({"index":5})"}, 0.1, 0));
  EXPECT_FALSE(shiftOf({.coordinates = 15}, 0.1, 0));   // fewer than positions
  EXPECT_FALSE(shiftOf({.coordinates = 999}, 0.1, 0));  // more than the view has
  EXPECT_TRUE(readModel(planeFile({.coordinates = 999}, planePositions())));  // which reading does not mind
  EXPECT_FALSE(textureShift(makePly({}), {}, gridPositions()));
  EXPECT_FALSE(textureShift(planeFile({}, planePositions()), {}, gridPositions()));
}

}  // namespace
}  // namespace quadmark::test
