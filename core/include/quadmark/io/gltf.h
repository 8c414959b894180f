// SPDX-License-Identifier: MIT
// glTF 2.0: .gltf JSON with external or data-URI buffers, and GLB containers.
#pragma once

#include "quadmark/io/model.h"

namespace quadmark {

/// True for the GLB magic, or for bytes that begin (after white space or a BOM) with a JSON object.
[[nodiscard]] bool isGltf(std::span<const std::uint8_t> file);

/// Reads a glTF or GLB. Errors as for readModel().
[[nodiscard]] Result<std::unique_ptr<Model>> readGltf(std::span<const std::uint8_t> file, const Resources& resources);

}  // namespace quadmark
