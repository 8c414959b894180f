// SPDX-License-Identifier: MIT
// The robust scheme's key schedule: one sub-key per purpose, per master secret and asset salt.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "quadmark/result.h"
#include "quadmark/robust/coded.h"

namespace quadmark::robust {

inline constexpr std::size_t kMaxSaltBytes = 256;

struct SchemeKeys {
  RobustKeys geometry;  ///< for the layers below the coded bits
  SubKey mac{};         ///< authenticates frames and bodies
  SubKey whitening{};   ///< stream that bodies are XORed with before the code
};

/// K = HKDF-SHA256(secret, salt, "qm/v1"); a sub-key is the first 16 bytes of HKDF-SHA256(K, no salt, "qm/v1/" purpose).
/// None of them says anything about the secret, about another purpose or about another salt.
/// @param salt  names one asset, so that marks of equal payload on different assets have nothing in common; may be empty.
/// Fails with badOption for more than kMaxSaltBytes or a zero byte (HMAC pads with zeros: two salts would be one).
[[nodiscard]] Result<SchemeKeys> deriveKeys(std::span<const std::uint8_t> secret, std::string_view salt);

}  // namespace quadmark::robust
