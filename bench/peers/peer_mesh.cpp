// SPDX-License-Identifier: MIT
#include "peer_mesh.h"

#include <string>

#include "quadmark/metrics.h"

namespace quadmark::bench {

std::vector<double> unwelded(const Mesh& mesh, const WeldedMesh& welded, const std::vector<double>& moved) {
  std::vector<double> out = mesh.positions;
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const std::uint32_t w = welded.weldedOf[v];
    if (w == kNoVertex || (!welded.gridOf.empty() && welded.gridOf[w] == kFixed)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // What did not move keeps its very bits, -0 included.
      if (moved[3 * w + axis] != welded.positions[3 * w + axis]) out[3 * v + axis] = moved[3 * w + axis];
    }
  }
  return out;
}

std::vector<std::uint32_t> firstTwins(const WeldedMesh& welded) {
  std::vector<std::uint32_t> first(welded.vertexCount(), kNoVertex);
  for (std::size_t v = 0; v < welded.weldedOf.size(); ++v) {
    const std::uint32_t w = welded.weldedOf[v];
    if (w != kNoVertex && first[w] == kNoVertex) first[w] = static_cast<std::uint32_t>(v);
  }
  return first;
}

Mesh asStored(const Mesh& mesh, const std::vector<double>& positions) {
  Mesh out = mesh;
  out.positions = positions;
  roundToPrecision(out);
  return out;
}

Result<TrialMark> readableMark(const Scheme& scheme, const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                               const std::string& settings, TrialMark mark) {
  const TrialReading reading = scheme.read(asStored(mesh, mark.positions), payload, key, settings);
  const double wrong =
      reading.bits.empty() ? 0.5 : bitErrorRate(payload.bits, reading.bits, reading.unread);
  if (wrong <= 0.1) return mark;
  return Error{ErrorCode::capacity, scheme.name() + " cannot write " + std::to_string(payload.bits.size()) +
                                        " bits here: its own reading has a bit error rate of " + std::to_string(wrong)};
}

Status checkMarkable(const Mesh& mesh, const WeldedMesh& welded, const TrialPayload& payload) {
  if (payload.bits.empty() || payload.bits.size() != bitCount(payload))
    return Error{ErrorCode::badOption, "the payload has " + std::to_string(payload.bits.size()) + " bits, its size says " +
                                           std::to_string(bitCount(payload))};
  if (welded.vertexCount() < 4 || !(boundingDiagonal(mesh) > 0))
    return Error{ErrorCode::capacity, "the model has fewer than four vertices or no extent"};
  return okStatus();
}

}  // namespace quadmark::bench
