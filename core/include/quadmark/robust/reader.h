// SPDX-License-Identifier: MIT
// From a mesh to soft coded bits, hypothesis by hypothesis (the robust scheme's reader).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/robust/coded.h"

namespace quadmark::robust {

/// What there was to read, for capacity and for the difference between "none" and "inconclusive".
struct ReaderCoverage {
  std::uint32_t vertices = 0;       ///< welded vertices
  std::uint32_t carriers = 0;       ///< layer A
  std::uint32_t labels = 0;         ///< distinct labels among them
  std::uint32_t ringPositions = 0;  ///< coded positions of the head that some label votes for (Sharing::headOnly)
  std::uint32_t diamonds = 0;       ///< layer B: usable diamonds, marked or not
  double diamondShare = 0;          ///< largest estimated share of marked diamonds over the hypotheses tried so far
};

struct ReadLimits {
  bool trySplit = true;     ///< also look for payloads with a body
  bool tryHarder = true;    ///< combinations and sharpened readings after the plain ones
};

struct Ground;

/// Reads one mesh. Keeps what the hypotheses share, so that each costs little; not thread safe.
/// Deterministic; independent of the order of vertices and faces up to rounding of sums. Cost: about 1 microsecond and
/// 300 bytes per vertex to construct, 0.02 (layer A) to 0.3 (layer B) microseconds per vertex and hypothesis.
class MeshReader {
 public:
  /// @param mesh  must validate(); positions in any affine frame. Kept by reference.
  /// @param head  the head's code, fixed by the format.
  /// @param ground  of what was embedded a moment ago: RobustEmbedding::ground, for the same mesh at its new positions, which
  ///                it receives. Spares more than half of the time.
  MeshReader(const Mesh& mesh, const RobustKeys& keys, StreamCode head, std::shared_ptr<Ground> ground = nullptr);
  ~MeshReader();
  MeshReader(MeshReader&&) noexcept;

  /// Hands hypotheses to `accept`, likeliest first, until it returns true: layer A, layer B, the remaining scales of
  /// layer B, sums of both layers, sharpened readings, the mesh turned over. May be called once.
  /// @return whether accept returned true.
  bool search(const ReadLimits& limits, const AcceptHead& accept);

  /// The head under one hypothesis again (or under one of the caller's own).
  [[nodiscard]] SoftBits headBits(const Hypothesis& hypothesis);
  /// The body under a hypothesis of Sharing::split.
  [[nodiscard]] SoftBits bodyBits(const Hypothesis& hypothesis, const StreamCode& body);
  /// All hypotheses that search() goes through, in its order: for bodies, where the best one for the head need not be
  /// the best one for the rest.
  [[nodiscard]] static std::vector<Hypothesis> hypotheses(const ReadLimits& limits);

  /// Layer A's votes against an expected payload: one per distinct label, coordinate and bit.
  [[nodiscard]] Agreement ringAgreement(const CodedPayload& expected, double sharpening = 0, bool mirrored = false);
  /// Layer B's votes: the sign of each coded bit's ratio where it is not 0, head and body together.
  [[nodiscard]] Agreement diamondAgreement(const CodedPayload& expected, const Hypothesis& hypothesis);

  /// Where the votes came from: per mesh vertex (not welded) in [-1, 1], positive where its cells agree with the payload, 0
  /// where there were none.
  [[nodiscard]] std::vector<float> evidence(const CodedPayload& payload, const Hypothesis& hypothesis);

  [[nodiscard]] const ReaderCoverage& coverage() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace quadmark::robust
