// SPDX-License-Identifier: MIT
// Bare Draco files (.drc) with triangles. They can be read, not marked: their format rounds whatever is written.
#pragma once

#include "quadmark/io/model.h"

namespace quadmark {

/// True for Draco's magic.
[[nodiscard]] bool isDrc(std::span<const std::uint8_t> file);

/// Reads a .drc of bitstream 2.2 (draco_encoder since version 1.1). Errors as for readModel(), with unsupportedFile for
/// point clouds and for builds without Draco's decoder.
[[nodiscard]] Result<std::unique_ptr<Model>> readDrc(std::span<const std::uint8_t> file);

}  // namespace quadmark
