// SPDX-License-Identifier: MIT
#include "quadmark/robust/marker.h"

#include <algorithm>
#include <string>
#include <utility>

#include "concat.h"
#include "ground.h"
#include "quadmark/robust/reader.h"

namespace quadmark::robust {
namespace {

/// Coded forms of a body to try, the most robust that could fit first: a vote per coded bit and more is worth a code,
/// fewer are better spent on the pixels themselves. From 4 votes of layer A per pixel on, a third is as good as a half in
/// layer A and better in B, whose symbols then have more of the code to agree with (bunny at .7: 5 keys of 5, not 3).
std::vector<BodyRate> ratesFor(const Mesh& mesh, const PayloadBits& bits, const SchemeKeys& keys) {
  if (bits.body.empty()) return {BodyRate::half};
  const MeshReader reader(mesh, keys.geometry, headCode());
  const double votes = 2.0 * reader.coverage().labels / static_cast<double>(bits.body.size());
  if (votes >= 4) return {BodyRate::third, BodyRate::half, BodyRate::plain};
  return {BodyRate::half, BodyRate::plain};
}

// Positions of the head that count for the least capacity. An ID fills both layers and must be whole in one, as most
// damage leaves only one of them. A body leaves its head a few places in each: there both count.
std::uint32_t headPlaces(const MarkedMesh& marked) {
  const RobustEmbedding& e = marked.embedding;
  return marked.bits.body.empty() ? std::max(e.ringPositions, e.diamondPositions) : e.headPositions;
}

Error tooSmall(const MarkedMesh& marked, bool readable) {
  const RobustEmbedding& e = marked.embedding;
  const std::string counts = concat(e.carriers, " carriers and ", e.cells, " cells hold ", headPlaces(marked),
                                    " of the ", marked.coded.head.size(), " bits that identify the mark");
  if (!readable)
    return {ErrorCode::capacity, concat(counts, ": the payload does not read back",
                                        (marked.bits.body.empty() ? "" : "; a smaller image or an ID may fit"))};
  return {ErrorCode::capacity, concat(counts, ", at least ", kLeastPositions, " are needed")};
}

}  // namespace

Result<MarkedMesh> markMesh(const Mesh& mesh, const Payload& payload, const SchemeKeys& keys,
                            const EmbedOptions& options) {
  const auto strength = static_cast<std::uint8_t>(options.strength);
  auto bits = bitsOf(payload, BodyRate::half, strength, keys);
  if (!bits) return bits.error();
  MarkedMesh marked;
  for (const BodyRate rate : ratesFor(mesh, *bits, keys)) {
    auto atRate = bitsOf(payload, rate, strength, keys);
    if (!atRate) return atRate.error();
    marked.bits = std::move(*atRate);
    marked.coded = encode(marked.bits, keys);
    auto embedding = embedRobust(mesh, marked.coded, keys.geometry, options);
    if (!embedding) return embedding.error();
    marked.embedding = std::move(*embedding);
    Mesh after = mesh;
    after.positions = std::move(marked.embedding.positions);
    roundToPrecision(after);  // integer grids are coarser than what the layers round to
    if (options.progress && !options.progress("verify", 0.9)) return Error{ErrorCode::aborted, "cancelled by the caller"};
    marked.unattacked = readBack(after, marked.bits, keys, marked.embedding.ground);
    marked.welding = marked.embedding.ground->surface.welded.takeWelding();
    marked.embedding.ground.reset();
    marked.embedding.positions = std::move(after.positions);
    if (marked.unattacked.read) break;
  }
  if (!marked.unattacked.read) return tooSmall(marked, false);
  if (headPlaces(marked) < kLeastPositions)
    return tooSmall(marked, true);
  return marked;
}

}  // namespace quadmark::robust
