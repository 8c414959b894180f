// SPDX-License-Identifier: MIT
// Watermark images: one bit per pixel, PNG in and out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "quadmark/result.h"

namespace quadmark {

/// Largest side of a watermark image in pixels; larger ones are refused with tooLarge.
inline constexpr std::uint32_t kMaxImageSide = 1024;

/// A black-and-white image. bits[y * width + x] is 1 for a dark pixel (ink), 0 for a light one.
struct BitImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> bits;  ///< width * height values, each 0 or 1, rows from the top
};

/// How an image with grey levels becomes black and white.
struct ThresholdOptions {
  double threshold = -1;  ///< luminance below which a pixel is ink, 0..1; negative: Otsu's method picks it
};

/// Decodes a PNG (any colour type; transparency is laid over white) and thresholds its luminance.
/// Fails with badImage (not a PNG, broken, zero size, 1 x 1) or tooLarge (a side above kMaxImageSide, read from
/// the header before anything is allocated).
[[nodiscard]] Result<BitImage> decodePng(std::span<const std::uint8_t> png, const ThresholdOptions& options = {});

/// Encodes ink as black on white, one pixel per bit.
/// @param erased  empty, or one value per pixel; pixels with a nonzero value were not read and become mid grey (128).
[[nodiscard]] std::vector<std::uint8_t> encodePng(const BitImage& image, std::span<const std::uint8_t> erased = {});

/// Encodes values 0..1 as an 8-bit grey PNG, 1 = white; for confidence pictures.
[[nodiscard]] std::vector<std::uint8_t> encodeGreyPng(std::uint32_t width, std::uint32_t height,
                                                      std::span<const float> values);

}  // namespace quadmark
