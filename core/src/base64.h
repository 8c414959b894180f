// SPDX-License-Identifier: MIT
// Base64 (RFC 4648, with padding) for key files and reports.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace quadmark {

[[nodiscard]] std::string toBase64(std::span<const std::uint8_t> bytes);

/// Strict: standard alphabet, padded, no white space; nullopt otherwise.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> fromBase64(std::string_view text);

}  // namespace quadmark
