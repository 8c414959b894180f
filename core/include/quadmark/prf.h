// SPDX-License-Identifier: MIT
// Keyed pseudo-randomness: SHA-256 (FIPS 180-4), HMAC (RFC 2104), HKDF (RFC 5869) and SipHash-2-4 (Aumasson and
// Bernstein 2012). Integer arithmetic and constant tables only, so bits are equal on every platform.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace quadmark {

using Digest = std::array<std::uint8_t, 32>;

[[nodiscard]] Digest sha256(std::span<const std::uint8_t> data);
[[nodiscard]] Digest hmacSha256(std::span<const std::uint8_t> key, std::span<const std::uint8_t> data);

/// First 32 bytes of HKDF-SHA256 (extract, then expand with `info`).
[[nodiscard]] Digest hkdfSha256(std::span<const std::uint8_t> secret, std::span<const std::uint8_t> salt,
                                std::string_view info);

/// SipHash-2-4 of one 64-bit word under a 128-bit sub-key: a uniform 64-bit value that reveals nothing about the
/// sub-key or other values. About 20 ns.
class Prf {
 public:
  /// The sub-key for one purpose: HKDF-SHA256 of the secret with `purpose` as info. Sub-keys of different purposes
  /// are independent; none gives the secret away.
  Prf(std::span<const std::uint8_t> secret, std::string_view purpose);

  /// Under a sub-key that was derived before.
  explicit Prf(const std::array<std::uint8_t, 16>& subKey);

  [[nodiscard]] std::uint64_t operator()(std::uint64_t item) const;

  /// Uniform in [0, n) for n >= 1; the bias of the modulo is below n / 2^64.
  [[nodiscard]] std::uint32_t below(std::uint64_t item, std::uint32_t n) const {
    return static_cast<std::uint32_t>((*this)(item) % n);
  }

 private:
  std::uint64_t k0_ = 0, k1_ = 0;
};

}  // namespace quadmark
