// SPDX-License-Identifier: MIT
// PLY: ascii, binary little and big endian; float or double coordinates; polygons and triangle strips.
#pragma once

#include "quadmark/io/model.h"

namespace quadmark {

/// True when the bytes begin with the PLY magic line.
[[nodiscard]] bool isPly(std::span<const std::uint8_t> file);

/// Reads a PLY. Errors as for readModel(); places are named as "line 14" or "vertex 20, property y".
[[nodiscard]] Result<std::unique_ptr<Model>> readPly(std::span<const std::uint8_t> file);

}  // namespace quadmark
