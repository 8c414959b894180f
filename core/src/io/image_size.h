// SPDX-License-Identifier: MIT
// Width and height of an image file, from its header.
#pragma once

#include <array>
#include <optional>

#include "bytes.h"

namespace quadmark::io {

/// @param file  a PNG, JPEG, WebP or KTX 2 file; found by content. Only its first bytes are looked at, of a JPEG those
/// in
///              front of its picture.
/// @return width and height in pixels, at least 1 each; nothing for other files and for headers that say neither.
std::optional<std::array<std::uint32_t, 2>> imageSize(Bytes file);

}  // namespace quadmark::io
