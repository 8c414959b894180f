// SPDX-License-Identifier: MIT
#include "quadmark/robust/frame.h"

#include <algorithm>

#include "concat.h"
#include "quadmark/prf.h"
#include "quadmark/robust/code.h"
#include "quadmark/robust/demapper.h"

namespace quadmark::robust {
namespace {

constexpr std::uint32_t kKindBits = 4, kFieldBits = 64;
static_assert(kKindBits + kFieldBits + kTagBits == kFrameBits);

// Domains of the MAC, so that no frame's tag is a body's.
enum class Domain : std::uint64_t { frame = 1, body = 2 };

// CBC-MAC over SipHash, safe for messages of any length because domain and length come first.
class Mac {
 public:
  Mac(const SchemeKeys& keys, Domain domain, std::uint64_t words)
      : prf_(keys.mac), state_(prf_(static_cast<std::uint64_t>(domain) << 32 | words)) {}
  void add(std::uint64_t word) { state_ = prf_(state_ ^ word); }
  [[nodiscard]] std::uint64_t top(std::uint32_t bits) const { return state_ >> (64 - bits); }

 private:
  Prf prf_;
  std::uint64_t state_;
};

std::uint64_t frameTag(const Frame& frame, const SchemeKeys& keys) {
  Mac mac(keys, Domain::frame, 2);
  mac.add(static_cast<std::uint64_t>(frame.kind));
  mac.add(frame.field);
  return mac.top(kTagBits);
}

std::uint64_t bodyTag(PayloadKind kind, std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> bits,
                      const SchemeKeys& keys) {
  Mac mac(keys, Domain::body, 1 + (bits.size() + 63) / 64);
  mac.add(static_cast<std::uint64_t>(kind) << 32 | width << 16 | height);
  for (std::size_t first = 0; first < bits.size(); first += 64) {
    std::uint64_t word = 0;
    for (std::size_t i = first; i < std::min(first + 64, bits.size()); ++i) word = word << 1 | bits[i];
    mac.add(word);
  }
  return mac.top(kBodyTagBits);
}

// Bits of a stream that depends on the key and a tag; the domain keeps heads and bodies apart.
class Stream {
 public:
  Stream(const SchemeKeys& keys, Domain domain, std::uint64_t tag)
      : prf_(keys.whitening), nonce_(prf_(static_cast<std::uint64_t>(domain) << 48 ^ tag)) {}
  [[nodiscard]] std::uint64_t word(std::uint64_t index) const { return prf_(nonce_ ^ index); }
  [[nodiscard]] std::uint8_t bit(std::uint64_t index) const {
    return static_cast<std::uint8_t>(word(index / 64) >> (index % 64) & 1);
  }

 private:
  Prf prf_;
  std::uint64_t nonce_;
};

void pushBits(std::vector<std::uint8_t>& out, std::uint64_t value, std::uint32_t count) {
  while (count-- > 0) out.push_back(static_cast<std::uint8_t>(value >> count & 1));
}

std::uint64_t takeBits(std::span<const std::uint8_t> bits, std::size_t first, std::uint32_t count) {
  std::uint64_t value = 0;
  for (std::uint32_t i = 0; i < count; ++i) value = value << 1 | bits[first + i];
  return value;
}

// The field of a frame with a body, from the top: 16 bits of size (images: width - 1 and height - 1; texts: bytes),
// rate 2, strength 2, zero 4, tag 40.
constexpr std::uint32_t kSizeShift = 48, kRateShift = 46, kStrengthShift = 44, kZeroShift = 40;
static_assert(kZeroShift == kBodyTagBits);

Frame frameOf(const BodyShape& shape) {
  const std::uint64_t size = shape.kind == PayloadKind::image
                                 ? std::uint64_t{shape.width - 1} << 8 | (shape.height - 1)
                                 : shape.width / 8;
  return {shape.kind, size << kSizeShift | static_cast<std::uint64_t>(shape.rate) << kRateShift |
                          std::uint64_t{shape.strength} << kStrengthShift | shape.tag};
}

std::vector<std::uint8_t> frameBits(const Frame& frame, const SchemeKeys& keys) {
  const std::uint64_t tag = frameTag(frame, keys);
  const Stream stream(keys, Domain::frame, tag);
  std::vector<std::uint8_t> bits;
  pushBits(bits, static_cast<std::uint64_t>(frame.kind) ^ (stream.word(1) & 15), kKindBits);
  pushBits(bits, frame.field ^ stream.word(0), kFieldBits);
  pushBits(bits, tag, kTagBits);
  return bits;
}

const ConvolutionalCode& codeOf(BodyRate rate) { return rate == BodyRate::third ? thirdRateCode() : halfRateCode(); }

std::uint32_t codedSteps(const BodyShape& shape) {
  return shape.rate == BodyRate::plain ? shape.bits() : systematicLength(codeOf(shape.rate), shape.bits());
}

std::vector<std::uint8_t> generatorNumbers(std::uint32_t bits, std::uint32_t rate) {
  std::vector<std::uint8_t> numbers(bits);
  for (std::uint32_t i = 0; i < bits; ++i) numbers[i] = static_cast<std::uint8_t>(i % rate);
  return numbers;
}

Error badText(const std::string& what) { return {ErrorCode::badOption, "text: " + what}; }

}  // namespace

bool isUtf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<std::uint8_t>(text[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : lead < 0xf5 ? 4 : 0;
    if (lead == 0 || length == 0 || i + length > text.size()) return false;
    std::uint32_t point = length == 1 ? lead : lead & (0x7fu >> length);
    for (std::size_t k = 1; k < length; ++k) {
      const auto next = static_cast<std::uint8_t>(text[i + k]);
      if ((next & 0xc0) != 0x80) return false;
      point = point << 6 | (next & 0x3f);
    }
    const bool overlong = (length == 3 && point < 0x800) || (length == 4 && point < 0x10000);
    if (overlong || (point >= 0xd800 && point < 0xe000) || point > 0x10ffff) return false;
    i += length;
  }
  return true;
}

StreamCode headCode() {
  const std::uint32_t rate = thirdRateCode().rate();
  return {kFrameBits * rate, generatorNumbers(kFrameBits * rate, rate)};
}

StreamCode bodyCode(const BodyShape& shape) {
  const auto rate = static_cast<std::uint32_t>(shape.rate);
  const std::uint32_t bits = codedSteps(shape) * rate;
  return {bits, generatorNumbers(bits, rate)};
}

Result<PayloadBits> bitsOf(const Payload& payload, BodyRate rate, std::uint8_t strength, const SchemeKeys& keys) {
  if (const auto* id = std::get_if<std::uint64_t>(&payload)) return PayloadBits{{PayloadKind::id, *id}, {}};
  BodyShape shape;
  shape.rate = rate;
  shape.strength = strength;
  PayloadBits out;
  if (const auto* text = std::get_if<std::string>(&payload)) {
    if (text->empty() || text->size() > kLongestText)
      return badText(concat(text->size(), " bytes, expected 1 to ", kLongestText));
    if (!isUtf8(*text)) return badText("not UTF-8, or with a zero byte");
    if (text->size() <= 8) {
      std::uint64_t field = 0;  // zero bytes fill the end
      for (std::size_t i = 0; i < text->size(); ++i)
        field |= std::uint64_t{static_cast<std::uint8_t>((*text)[i])} << (56 - 8 * i);
      return PayloadBits{{PayloadKind::shortText, field}, {}};
    }
    shape.kind = PayloadKind::text;
    shape.width = static_cast<std::uint32_t>(8 * text->size());
    shape.height = 1;
    for (char c : *text) pushBits(out.body, static_cast<std::uint8_t>(c), 8);
  } else {
    const BitImage& image = std::get<BitImage>(payload);
    if (image.width < 1 || image.height < 1 || image.width > kLargestSide || image.height > kLargestSide ||
        image.bits.size() != std::size_t{image.width} * image.height)
      return Error{ErrorCode::badImage, concat("the image is ", image.width, " x ", image.height,
                                               ", scheme robust takes up to ", kLargestSide, " x ", kLargestSide)};
    shape.kind = PayloadKind::image;
    shape.width = image.width;
    shape.height = image.height;
    out.body = image.bits;
  }
  shape.tag = bodyTag(shape.kind, shape.width, shape.height, out.body, keys);
  out.frame = frameOf(shape);
  return out;
}

CodedPayload encode(const PayloadBits& bits, const SchemeKeys& keys) {
  CodedPayload coded;
  coded.head = encodeTailBiting(thirdRateCode(), frameBits(bits.frame, keys));
  coded.headGenerator = headCode().generator;
  const std::optional<BodyShape> shape = bodyShape(bits.frame);
  if (!shape) return coded;
  const Stream stream(keys, Domain::body, shape->tag);
  std::vector<std::uint8_t> whitened(codedSteps(*shape));  // filled up with the stream itself
  for (std::size_t i = 0; i < whitened.size(); ++i)
    whitened[i] = stream.bit(i) ^ (i < bits.body.size() ? bits.body[i] : 0);
  const ConvolutionalCode& code = codeOf(shape->rate);
  coded.body = shape->rate == BodyRate::plain ? whitened : encodeTailBiting(code, systematicInput(code, whitened));
  coded.bodyGenerator = bodyCode(*shape).generator;
  return coded;
}

std::optional<Frame> parseFrame(std::span<const std::uint8_t> decoded, const SchemeKeys& keys) {
  if (decoded.size() != kFrameBits) return std::nullopt;
  const std::uint64_t tag = takeBits(decoded, kKindBits + kFieldBits, kTagBits);
  const Stream stream(keys, Domain::frame, tag);
  Frame frame;
  frame.kind = static_cast<PayloadKind>(takeBits(decoded, 0, kKindBits) ^ (stream.word(1) & 15));
  frame.field = takeBits(decoded, kKindBits, kFieldBits) ^ stream.word(0);
  if (frameTag(frame, keys) != tag) return std::nullopt;
  switch (frame.kind) {
    case PayloadKind::id: return frame;
    case PayloadKind::shortText: return shortText(frame).empty() ? std::nullopt : std::optional(frame);
    case PayloadKind::image:
    case PayloadKind::text: return bodyShape(frame) ? std::optional(frame) : std::nullopt;
  }
  return std::nullopt;  // a kind of a later version
}

std::optional<BodyShape> bodyShape(const Frame& frame) {
  if (frame.kind != PayloadKind::image && frame.kind != PayloadKind::text) return std::nullopt;
  BodyShape shape;
  shape.kind = frame.kind;
  const std::uint32_t size = static_cast<std::uint32_t>(frame.field >> kSizeShift);
  const bool image = frame.kind == PayloadKind::image;
  shape.width = image ? (size >> 8) + 1 : 8 * size;
  shape.height = image ? (size & 255) + 1 : 1;
  const auto rate = static_cast<std::uint8_t>(frame.field >> kRateShift & 3);
  shape.rate = static_cast<BodyRate>(rate);
  shape.strength = static_cast<std::uint8_t>(frame.field >> kStrengthShift & 3);
  shape.tag = frame.field & ((std::uint64_t{1} << kBodyTagBits) - 1);
  const bool sizeFits = image ? shape.width <= kLargestSide && shape.height <= kLargestSide
                              : size > 8 && size <= kLongestText;
  if (!sizeFits || rate == 0 || (frame.field >> kZeroShift & 15) != 0) return std::nullopt;
  return shape;
}

std::string shortText(const Frame& frame) {
  std::string text;
  for (int shift = 56; shift >= 0 && (frame.field >> shift & 255) != 0; shift -= 8)
    text.push_back(static_cast<char>(frame.field >> shift & 255));
  const bool padded = text.size() == 8 || frame.field << (8 * text.size()) == 0;
  return padded && isUtf8(text) ? text : std::string();
}

BodyReading decodeBody(const BodyShape& shape, const SoftBits& coded, const SchemeKeys& keys, float scale) {
  const ConvolutionalCode& code = codeOf(shape.rate);
  const bool plain = shape.rate == BodyRate::plain;
  const Stream stream(keys, Domain::body, shape.tag);
  Demapper demapper(coded, scale);
  if (!plain) demapper.iterate(code, kDemapperRounds);
  std::vector<float> ratios = plain ? demapper.ratios() : posteriorRatios(code, demapper.ratios());
  if (!plain)
    for (std::size_t i = 0; i < shape.bits(); ++i) ratios[i] = ratios[i * code.rate()];
  ratios.resize(shape.bits());

  BodyReading reading;
  const auto confirmed = [&](std::span<const std::uint8_t> whitened) {
    std::vector<std::uint8_t> bits(shape.bits());
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = whitened[i] ^ stream.bit(i);
    reading.exact = bodyTag(shape.kind, shape.width, shape.height, bits, keys) == shape.tag;
    if (reading.exact || reading.bits.empty()) reading.bits = std::move(bits);
    return reading.exact;
  };
  std::vector<std::uint8_t> likeliest(ratios.size());
  for (std::size_t i = 0; i < ratios.size(); ++i) likeliest[i] = ratios[i] < 0 ? 1 : 0;
  // The likeliest codewords are seldom right where bit by bit is not, but then all of it is.
  if (!confirmed(likeliest) && !plain)
    static_cast<void>(decodeList(code, demapper.ratios(), kBodyTries - 1, [&](std::span<const std::uint8_t> input) {
      const std::vector<std::uint8_t> word = encodeTailBiting(code, input);
      std::vector<std::uint8_t> systematic(shape.bits());
      for (std::size_t i = 0; i < systematic.size(); ++i) systematic[i] = word[i * code.rate()];
      return confirmed(systematic);
    }));
  reading.ratios.resize(ratios.size());
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    if (reading.exact)
      reading.ratios[i] = reading.bits[i] != 0 ? -60.0f : 60.0f;
    else
      reading.ratios[i] = stream.bit(i) != 0 ? -ratios[i] : ratios[i];
  }
  return reading;
}

}  // namespace quadmark::robust
