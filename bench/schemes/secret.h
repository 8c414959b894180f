// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "quadmark/prf.h"

namespace quadmark::bench {

/// The secret that a key of the evaluation (any number) stands for, one for each purpose.
[[nodiscard]] inline Digest secretOf(std::uint64_t key, std::string_view purpose) {
  std::uint8_t bytes[8];
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(key >> (8 * i));
  return hkdfSha256(bytes, {}, purpose);
}

}  // namespace quadmark::bench
