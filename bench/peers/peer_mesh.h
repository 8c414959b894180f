// SPDX-License-Identifier: MIT
// What all peers do with a mesh around their own idea.
#pragma once

#include <cstddef>
#include <vector>

#include "peers.h"
#include "quadmark/adjacency.h"
#include "quadmark/mesh.h"

namespace quadmark::bench {

/// Bits of a payload whose bits a blind reader does not know.
[[nodiscard]] inline std::size_t bitCount(const TrialPayload& payload) {
  return std::size_t{payload.width} * payload.height;
}

/// Positions of every vertex of the mesh when its welded vertices move: twins move alike, vertices no face refers to and
/// those that cannot be stored elsewhere stay.
/// @param moved  3 per welded vertex.
[[nodiscard]] std::vector<double> unwelded(const Mesh& mesh, const WeldedMesh& welded, const std::vector<double>& moved);

/// For each welded vertex, the first vertex of the file that it stands for.
[[nodiscard]] std::vector<std::uint32_t> firstTwins(const WeldedMesh& welded);

/// The mesh with other positions, rounded to what its file can store.
[[nodiscard]] Mesh asStored(const Mesh& mesh, const std::vector<double>& positions);

/// Returns the mark if its scheme reads it back from the stored positions with at most one bit in ten wrong (an unread
/// bit counts one half), or fails with capacity: papers state no room, so that what can be read is the room.
[[nodiscard]] Result<TrialMark> readableMark(const Scheme& scheme, const Mesh& mesh, const TrialPayload& payload,
                                             std::uint64_t key, const std::string& settings, TrialMark mark);

/// Fails with badOption on a payload without bits or of another size than it says, with capacity on a mesh of fewer than four welded vertices or without extent.
[[nodiscard]] Status checkMarkable(const Mesh& mesh, const WeldedMesh& welded, const TrialPayload& payload);

}  // namespace quadmark::bench
