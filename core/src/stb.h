// SPDX-License-Identifier: MIT
// What image.cpp uses of stb.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace quadmark::detail {

/// Decodes a PNG whose header was checked. @return 4 bytes per pixel, empty on failure with the reason in `failure`.
/// Never allocates more than 64 MB at once, whatever the deflate stream claims.
[[nodiscard]] std::vector<std::uint8_t> decodePngRgba(std::span<const std::uint8_t> png, std::uint32_t& width,
                                                      std::uint32_t& height, const char*& failure);

/// A zlib stream of `data` (below 2 GB).
[[nodiscard]] std::vector<std::uint8_t> zlibCompress(std::vector<std::uint8_t> data);

}  // namespace quadmark::detail
