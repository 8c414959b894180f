// SPDX-License-Identifier: MIT
// Payloads of the robust scheme as bits: a head frame of fixed length that names the payload, and for images and longer
// texts a body. Layout: docs/format.md, part "The robust scheme".
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "quadmark/image.h"
#include "quadmark/result.h"
#include "quadmark/robust/coded.h"
#include "quadmark/robust/keys.h"

namespace quadmark::robust {

inline constexpr std::uint32_t kLargestSide = 128;     ///< pixels
inline constexpr std::uint32_t kLongestText = 64;      ///< bytes of UTF-8
inline constexpr std::uint32_t kFrameBits = 92;        ///< kind 4, field 64, tag 24
inline constexpr std::uint32_t kTagBits = 24;
inline constexpr std::uint32_t kBodyTagBits = 40;

/// A 64-bit ID, an image up to kLargestSide a side, or a text of 1 to kLongestText bytes.
using Payload = std::variant<std::uint64_t, BitImage, std::string>;

enum class PayloadKind : std::uint8_t { id = 1, image = 2, text = 3, shortText = 4 };

/// How many coded bits a bit of the body becomes.
enum class BodyRate : std::uint8_t { plain = 1, half = 2, third = 3 };

/// What the head carries. Short texts (up to 8 bytes) and IDs are the field itself; for the rest it describes the body.
struct Frame {
  PayloadKind kind = PayloadKind::id;
  std::uint64_t field = 0;
  bool operator==(const Frame&) const = default;
};

/// The body a frame announces.
struct BodyShape {
  PayloadKind kind = PayloadKind::image;
  std::uint32_t width = 0, height = 0;  ///< image size; a text is 8 * bytes x 1
  BodyRate rate = BodyRate::half;
  std::uint8_t strength = 0;            ///< the preset it was written with; for reports only
  std::uint64_t tag = 0;                ///< kBodyTagBits bits over kind, size and content

  [[nodiscard]] std::uint32_t bits() const { return width * height; }
};

/// The length and puncturing order of every head, whatever it carries.
[[nodiscard]] StreamCode headCode();
[[nodiscard]] StreamCode bodyCode(const BodyShape& shape);

/// Frame and information bits of a payload. `body` is empty for IDs and short texts.
struct PayloadBits {
  Frame frame;
  std::vector<std::uint8_t> body;
};
/// Fails with badOption (a text that is empty, too long, not UTF-8 or with a zero byte) or badImage (no pixels, too
/// large, another number of bits than width x height).
[[nodiscard]] Result<PayloadBits> bitsOf(const Payload& payload, BodyRate rate, std::uint8_t strength,
                                         const SchemeKeys& keys);

/// The coded bits to write. All of them are pseudo-random under a key that nobody has, and so is the difference between
/// those of any two payloads: kind and field are XORed with a stream that depends on the tag, a body with one that
/// depends on its tag (the principle of RFC 5297).
[[nodiscard]] CodedPayload encode(const PayloadBits& bits, const SchemeKeys& keys);

/// The frame of a decoded head, if its tag is right. A wrong one passes with probability 2^-kTagBits.
[[nodiscard]] std::optional<Frame> parseFrame(std::span<const std::uint8_t> decoded, const SchemeKeys& keys);

/// nullopt for IDs and short texts.
[[nodiscard]] std::optional<BodyShape> bodyShape(const Frame& frame);

/// The text of a shortText frame.
[[nodiscard]] std::string shortText(const Frame& frame);

struct BodyReading {
  std::vector<std::uint8_t> bits;  ///< likeliest value of each information bit
  std::vector<float> ratios;       ///< its log-likelihood ratio, positive where 0 is likelier
  bool exact = false;              ///< the tag confirms all bits; the ratios are then +-60
};
/// Whether a bit with this ratio counts as not read: its odds are next to even.
[[nodiscard]] inline bool isUnread(float ratio) { return (ratio < 0 ? -ratio : ratio) < 0.2f; }
/// Decodes a body as far as it goes: without a right tag each bit is the likeliest one by itself.
/// @param coded  what is known of the coded bits of bodyCode(shape).
/// @param scale  factor on it, as for Demapper.
/// A wrong body is called exact with probability kBodyTries * 2^-kBodyTagBits at most.
[[nodiscard]] BodyReading decodeBody(const BodyShape& shape, const SoftBits& coded, const SchemeKeys& keys,
                                     float scale = 1);
inline constexpr std::uint32_t kBodyTries = 17;

/// Whether text is well-formed UTF-8 (RFC 3629) without zero bytes.
[[nodiscard]] bool isUtf8(std::string_view text);

}  // namespace quadmark::robust
