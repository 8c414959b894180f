// SPDX-License-Identifier: MIT
// Marking a mesh so that the payload certainly reads back: the form of its body, both layers, the file's grid, a reading.
#pragma once

#include "quadmark/adjacency.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/robust/frame.h"
#include "quadmark/robust/self_test.h"

namespace quadmark::robust {

struct MarkedMesh {
  PayloadBits bits;
  CodedPayload coded;
  RobustEmbedding embedding;  ///< its positions are those of the mesh's grid; without ground
  Welding welding;            ///< of the mesh
  SelfTest unattacked;        ///< what reading them gives
};

/// Head positions that one layer must reach: one and a half times the information.
inline constexpr std::uint32_t kLeastPositions = kFrameBits * 3 / 2;

/// Marks a mesh. Bodies are written in the most robust coded form that reads back.
/// @param mesh  must validate().
/// Fails like bitsOf() and embedRobust(); with capacity, saying how much there is, where the payload does not read back or
/// either layer reaches fewer than kLeastPositions. Cost: embedRobust() and one reading, for bodies up to three of each.
[[nodiscard]] Result<MarkedMesh> markMesh(const Mesh& mesh, const Payload& payload, const SchemeKeys& keys,
                                          const EmbedOptions& options);

}  // namespace quadmark::robust
