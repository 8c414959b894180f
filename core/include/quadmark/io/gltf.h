// SPDX-License-Identifier: MIT
// glTF 2.0: .gltf JSON with external or data-URI buffers, and GLB containers.
#pragma once

#include <optional>

#include "quadmark/io/model.h"

namespace quadmark {

/// True for the GLB magic, or for bytes that begin (after white space or a BOM) with a JSON object.
[[nodiscard]] bool isGltf(std::span<const std::uint8_t> file);

/// How far a surface slid under its textures, which are fixed to its vertices.
struct TextureShift {
  double uv = 0;                 ///< largest, in texture coordinates (after the scale of KHR_texture_transform)
  std::optional<double> texels;  ///< largest, in texels, of the textures whose image is in the file and of a known format
  std::string place;             ///< where: "mesh 2 primitive 0"
};

/// Of each vertex, the part of its displacement along its triangles is mapped into their texture coordinates, by all
/// materials that show it.
/// @param file, resources  with the new positions. Plain, quantized or meshopt-compressed; primitives that are
///                         Draco-compressed still are left out, as are sparse positions and triangles that
///                         another primitive draws already.
/// @param before           3 per vertex as readGltf() gives them.
/// @return nothing for other formats, files without textures, and texture coordinates that are broken or sparse.
/// Costs reading the file once more, and 24 bytes per vertex; next to nothing where there is no texture.
[[nodiscard]] std::optional<TextureShift> textureShift(std::span<const std::uint8_t> file, const Resources& resources,
                                                       const std::vector<double>& before);

/// Reads a glTF or GLB. Errors as for readModel().
[[nodiscard]] Result<std::unique_ptr<Model>> readGltf(std::span<const std::uint8_t> file, const Resources& resources);

}  // namespace quadmark
