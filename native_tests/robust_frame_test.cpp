// SPDX-License-Identifier: MIT
#include "quadmark/robust/frame.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "quadmark/robust/code.h"
#include "robust_simulation.h"

namespace quadmark::robust {
namespace {

SchemeKeys keysOf(std::uint8_t seed, std::string_view salt = "") {
  return *deriveKeys(std::vector<std::uint8_t>(32, seed), salt);
}

BitImage randomImage(std::uint32_t width, std::uint32_t height, Random& random) {
  return {width, height, randomBits(std::size_t{width} * height, random)};
}

// The information bits of a head, from its coded bits without noise.
std::vector<std::uint8_t> decodedHead(const CodedPayload& coded) {
  std::vector<float> ratios;
  for (std::uint8_t bit : coded.head) ratios.push_back(bit != 0 ? -4.0f : 4.0f);
  std::vector<std::uint8_t> out;
  static_cast<void>(decodeList(thirdRateCode(), ratios, 1, [&](std::span<const std::uint8_t> input) {
    out.assign(input.begin(), input.end());
    return true;
  }));
  return out;
}

std::vector<float> certain(const std::vector<std::uint8_t>& bits) {
  std::vector<float> ratios;
  for (std::uint8_t bit : bits) ratios.push_back(bit != 0 ? -6.0f : 6.0f);
  return ratios;
}

double shareDiffering(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differing += a[i] != b[i] ? 1 : 0;
  return static_cast<double>(differing) / static_cast<double>(a.size());
}

TEST(RobustPayload, CarriesIdsAndShortTexts) {
  const SchemeKeys keys = keysOf(1);
  for (const Payload& payload : {Payload{std::uint64_t{0}}, Payload{~std::uint64_t{0}}, Payload{std::uint64_t{0x0123456789abcdef}},
                                 Payload{std::string("a")}, Payload{std::string("J\xc3\xbcrgen!")}}) {
    const auto bits = bitsOf(payload, BodyRate::half, 1, keys);
    ASSERT_TRUE(bits);
    EXPECT_TRUE(bits->body.empty());
    const CodedPayload coded = encode(*bits, keys);
    EXPECT_EQ(coded.head.size(), headCode().bits);
    EXPECT_FALSE(coded.hasBody());
    const auto frame = parseFrame(decodedHead(coded), keys);
    ASSERT_TRUE(frame);
    EXPECT_EQ(*frame, bits->frame);
    if (const auto* id = std::get_if<std::uint64_t>(&payload)) {
      EXPECT_EQ(frame->field, *id);
    } else {
      EXPECT_EQ(shortText(*frame), std::get<std::string>(payload));
    }
  }
}

TEST(RobustPayload, DescribesBodiesOfEverySizeAndRate) {
  const SchemeKeys keys = keysOf(2);
  Random random(1);
  for (const BodyRate rate : {BodyRate::plain, BodyRate::half, BodyRate::third})
    for (const auto& [width, height] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{{1, 1}, {24, 24}, {17, 30}, {128, 128}}) {
      const BitImage image = randomImage(width, height, random);
      const auto bits = bitsOf(image, rate, 2, keys);
      ASSERT_TRUE(bits);
      const CodedPayload coded = encode(*bits, keys);
      const auto frame = parseFrame(decodedHead(coded), keys);
      ASSERT_TRUE(frame);
      const auto shape = bodyShape(*frame);
      ASSERT_TRUE(shape);
      EXPECT_EQ(shape->width, width);
      EXPECT_EQ(shape->height, height);
      EXPECT_EQ(shape->rate, rate);
      EXPECT_EQ(shape->strength, 2);
      EXPECT_EQ(bodyCode(*shape).bits, coded.body.size());
      EXPECT_EQ(bodyCode(*shape).generator, coded.bodyGenerator);
      const BodyReading reading = decodeBody(*shape, {certain(coded.body)}, keys);
      EXPECT_TRUE(reading.exact);
      EXPECT_EQ(reading.bits, image.bits) << width << " x " << height;
    }
}

TEST(RobustPayload, CarriesTextsInBodies) {
  const SchemeKeys keys = keysOf(3);
  const std::string text = "Example Studio, chair 42";
  const auto bits = bitsOf(text, BodyRate::third, 0, keys);
  ASSERT_TRUE(bits);
  const CodedPayload coded = encode(*bits, keys);
  const auto shape = bodyShape(bits->frame);
  ASSERT_TRUE(shape);
  EXPECT_EQ(shape->kind, PayloadKind::text);
  EXPECT_EQ(shape->bits(), 8 * text.size());
  const BodyReading reading = decodeBody(*shape, {certain(coded.body)}, keys);
  EXPECT_TRUE(reading.exact);
  EXPECT_EQ(reading.bits, bits->body);
}

TEST(RobustPayload, RefusesPayloadsItCannotHold) {
  const SchemeKeys keys = keysOf(4);
  const auto refusal = [&](const Payload& payload) {
    const auto bits = bitsOf(payload, BodyRate::half, 1, keys);
    EXPECT_FALSE(bits);
    return bits ? std::string() : bits.error().message;
  };
  EXPECT_EQ(refusal(std::string()), "text: 0 bytes, expected 1 to 64");
  EXPECT_EQ(refusal(std::string(65, 'x')), "text: 65 bytes, expected 1 to 64");
  EXPECT_EQ(refusal(std::string("\xff")), "text: not UTF-8, or with a zero byte");
  EXPECT_EQ(refusal(std::string("a\0b", 3)), "text: not UTF-8, or with a zero byte");
  EXPECT_EQ(refusal(BitImage{129, 1, std::vector<std::uint8_t>(129)}),
            "the image is 129 x 1, scheme robust takes up to 128 x 128");
  EXPECT_EQ(refusal(BitImage{2, 2, std::vector<std::uint8_t>(3)}),
            "the image is 2 x 2, scheme robust takes up to 128 x 128");
}

TEST(RobustPayload, KnowsUtf8) {
  for (const char* good : {"a", "\xc2\x80", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"})
    EXPECT_TRUE(isUtf8(good)) << good;
  for (const char* bad : {"\x80", "\xc0\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
                          "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xc3", "\xe2\x82", "a\xff"})
    EXPECT_FALSE(isUtf8(bad)) << bad;
}

TEST(RobustPayload, AcceptsNoOtherKeysFramesNorDamagedOnes) {
  const SchemeKeys keys = keysOf(5);
  const std::vector<std::uint8_t> bits = decodedHead(encode(*bitsOf(std::uint64_t{77}, BodyRate::half, 1, keys), keys));
  ASSERT_TRUE(parseFrame(bits, keys));
  EXPECT_FALSE(parseFrame(bits, keysOf(6)));
  EXPECT_FALSE(parseFrame(bits, keysOf(5, "another asset")));
  for (std::size_t i = 0; i < bits.size(); ++i) {
    std::vector<std::uint8_t> damaged = bits;
    damaged[i] ^= 1;
    EXPECT_FALSE(parseFrame(damaged, keys)) << "bit " << i;
  }
  EXPECT_FALSE(parseFrame(std::span(bits).first(91), keys));
  Random random(9);
  int accidents = 0;
  for (int trial = 0; trial < 100000; ++trial) accidents += parseFrame(randomBits(kFrameBits, random), keys) ? 1 : 0;
  EXPECT_EQ(accidents, 0);  // 0.006 expected
}

// Verifying one ID on a model that carries another must not succeed because the two are alike.
TEST(RobustPayload, GivesAlikePayloadsUnrelatedCodewords) {
  const SchemeKeys keys = keysOf(7);
  const auto coded = [&](const Payload& payload) { return encode(*bitsOf(payload, BodyRate::half, 1, keys), keys); };
  const CodedPayload reference = coded(std::uint64_t{1000});
  for (std::uint64_t bit = 0; bit < 64; ++bit)
    EXPECT_NEAR(shareDiffering(reference.head, coded(std::uint64_t{1000} ^ std::uint64_t{1} << bit).head), 0.5, 0.15);
  Random random(2);
  BitImage image = randomImage(24, 24, random);
  const CodedPayload before = coded(image);
  image.bits[100] ^= 1;
  EXPECT_NEAR(shareDiffering(before.head, coded(image).head), 0.5, 0.15);
  EXPECT_NEAR(shareDiffering(before.body, coded(image).body), 0.5, 0.08);
}

TEST(RobustPayload, HidesPlainPictures) {
  const SchemeKeys keys = keysOf(8);
  const BitImage white{64, 64, std::vector<std::uint8_t>(4096, 0)};
  for (const BodyRate rate : {BodyRate::plain, BodyRate::half}) {
    const CodedPayload coded = encode(*bitsOf(white, rate, 1, keys), keys);
    EXPECT_NEAR(static_cast<double>(std::count(coded.body.begin(), coded.body.end(), 1)),
                static_cast<double>(coded.body.size()) / 2, 2.5 * std::sqrt(static_cast<double>(coded.body.size())));
  }
}

// What could not be decoded is shown as what was read: bit by bit better than chance, with honest confidence.
TEST(DecodeBody, DegradesGracefully) {
  const SchemeKeys keys = keysOf(9);
  Random random(3);
  const BitImage image = randomImage(24, 24, random);
  const auto bits = bitsOf(image, BodyRate::half, 1, keys);
  const CodedPayload coded = encode(*bits, keys);
  const auto shape = bodyShape(bits->frame);
  double previous = -1;
  for (const double deviation : {0.6, 1.4, 2.0, 3.0, 5.0}) {
    const BodyReading reading = decodeBody(*shape, {noisy(coded.body, deviation, random)}, keys);
    double wrong = 0, sure = 0, sureWrong = 0;
    for (std::size_t i = 0; i < reading.bits.size(); ++i) {
      const bool isWrong = reading.bits[i] != image.bits[i];
      EXPECT_EQ(reading.ratios[i] < 0, reading.bits[i] != 0);
      wrong += isWrong ? 1 : 0;
      if (std::abs(reading.ratios[i]) > 4) {
        sure += 1;
        sureWrong += isWrong ? 1 : 0;
      }
    }
    wrong /= 576;
    EXPECT_GE(wrong, previous - 0.03);
    EXPECT_LT(wrong, 0.46) << deviation;
    EXPECT_EQ(reading.exact, wrong == 0);
    EXPECT_LE(sureWrong, 0.03 * sure + 3) << deviation;
    previous = wrong;
  }
  EXPECT_GT(previous, 0.2);
}

TEST(DecodeBody, SaysExactOnlyWhereTheTagIsRight) {
  const SchemeKeys keys = keysOf(10);
  Random random(4);
  const BitImage image = randomImage(8, 8, random);
  const auto bits = bitsOf(image, BodyRate::plain, 1, keys);
  const CodedPayload coded = encode(*bits, keys);
  const auto shape = bodyShape(bits->frame);
  std::vector<float> ratios = certain(coded.body);
  EXPECT_TRUE(decodeBody(*shape, {ratios}, keys).exact);
  ratios[20] = -ratios[20];
  const BodyReading damaged = decodeBody(*shape, {ratios}, keys);
  EXPECT_FALSE(damaged.exact);
  EXPECT_NE(damaged.bits[20], image.bits[20]);
}

}  // namespace
}  // namespace quadmark::robust
