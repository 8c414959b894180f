// SPDX-License-Identifier: MIT
// Writing a mark into a mesh (section 4.2; D10-D20), with verification by the decoder itself.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "quadmark/adjacency.h"
#include "quadmark/key.h"
#include "quadmark/mesh.h"
#include "quadmark/result.h"

namespace quadmark {

/// Which of the three checks after writing read the payload back exactly, without error or erasure (D20).
struct Guarantees {
  bool unattacked = false;  ///< the output itself
  bool reordered = false;   ///< a copy with vertices and faces permuted
  bool affine = false;      ///< a copy under the paper's combined affine attack, rounded to the file's precision
  [[nodiscard]] bool all() const { return unattacked && reordered && affine; }
};

struct MarkedMesh {
  std::vector<double> positions;      ///< 3 per mesh vertex, representable in mesh.precision; twins stay bit-equal
  std::uint32_t cells = 0;            ///< cells that carry a piece
  std::uint32_t naturalCells = 0;     ///< of all cells found, coplanar before
  std::uint32_t unusableCells = 0;    ///< found, but too fine for the file's precision or without a legal ratio pair
  std::uint32_t payloadBits = 0;
  std::uint64_t capacityBits = 0;     ///< Eq. (6): 3 (H2 - L2 + 1) * cells
  double repeats = 0;                 ///< cells per piece
  std::uint32_t leastRepeats = 0;     ///< copies of the rarest piece
  std::uint32_t repairs = 0;          ///< sets broken and cells rewritten by the verification
  Guarantees guarantees;
  double diagonal = 0;                ///< boundingDiagonal() of the mesh before
  Welding welding;                    ///< numbered in an order of its own
};

/// Marks a mesh.
/// @param mesh  must validate(); at least one face, a bounding box of positive size.
/// @param bits  payload, one per byte (0 or 1), key.params.bitCount() of them.
/// Fails with badMesh (no extent), badOption (wrong number of bits), capacity (fewer cells than pieces; the message has
/// the numbers), aborted. Deterministic. Cost: linear, about 2 microseconds per vertex.
[[nodiscard]] Result<MarkedMesh> embedMesh(const Mesh& mesh, std::span<const std::uint8_t> bits, const Key& key,
                                           const MeshProgress& progress = {});

}  // namespace quadmark
