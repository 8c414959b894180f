// SPDX-License-Identifier: MIT
// Writing coded bits into the positions of a mesh (the robust scheme's embedder): layer B first, then layer A.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/result.h"
#include "quadmark/robust/coded.h"

namespace quadmark::robust {

struct Ground;

enum class Strength : std::uint8_t { invisible, standard, strong };

/// By its name: "invisible", "standard" or "strong". Fails with badOption.
[[nodiscard]] Result<Strength> strengthFrom(std::string_view name);
[[nodiscard]] const char* strengthName(Strength strength);

struct EmbedOptions {
  Strength strength = Strength::standard;
  double maxErrorRel = 0;  ///< cap on each vertex's displacement, of the bounding-box diagonal; 0 = the preset's own
  double maxSlideRel = 0;  ///< cap on its part along the surface, of the diagonal; 0 = the preset's own
  MeshProgress progress{};
};

struct RobustEmbedding {
  std::vector<double> positions;      ///< 3 per mesh vertex, representable in mesh.precision; twins stay bit-equal
  std::vector<float> displacement;    ///< per mesh vertex, file units
  double largestSlide = 0;            ///< of any vertex along the surface, file units: by so much textures may swim
  std::uint32_t selected = 0;         ///< carriers of layer A that the key selects
  std::uint32_t carriers = 0;         ///< of these, written (the others were vetoed)
  std::uint32_t labels = 0;           ///< distinct labels among the written
  std::uint32_t cells = 0;            ///< cells of layer B written
  std::uint32_t symbolBits = 0;       ///< coded bits that each of them carries
  std::uint32_t vetoed = 0;           ///< cells undone because a face would have turned too far
  std::uint32_t goodCells = 0;        ///< fine cells that carry this payload: cells / goodCells copies of each
  std::uint8_t deltaClass = 0;
  std::uint32_t ringPositions = 0;    ///< U_A: coded positions of the head hit by a written label
  std::uint32_t diamondPositions = 0; ///< U_B: coded positions of the head whose group has a written cell
  std::uint32_t headPositions = 0;    ///< coded positions of the head that either layer holds
  std::uint32_t ringBodyPositions = 0;
  std::uint32_t diamondBodyPositions = 0;
  double diagonal = 0;                ///< boundingDiagonal() of the mesh before
  std::shared_ptr<Ground> ground;     ///< for reading it back at once
};

/// Writes both layers.
/// @param mesh  must validate(); at least one face and a bounding box of positive size.
/// Fails with badMesh (no extent), badOption (an empty head, a cap out of 0..1), aborted. Too little capacity is no
/// failure here: the counts say how much there is. Deterministic. Cost: linear, some 3 microseconds per
/// vertex, 5 where little of the budget is used and cells are written twice.
[[nodiscard]] Result<RobustEmbedding> embedRobust(const Mesh& mesh, const CodedPayload& payload, const RobustKeys& keys,
                                                  const EmbedOptions& options = {});

}  // namespace quadmark::robust
