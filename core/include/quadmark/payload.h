// SPDX-License-Identifier: MIT
// From payload bits to the pieces that cells carry, and back: keyed scrambling, octal groups, keyed pad (D14-D16, D23).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "quadmark/key.h"
#include "quadmark/prf.h"

namespace quadmark {

/// ceil(bits / (3 D2)): how many pieces a payload has.
[[nodiscard]] std::uint32_t pieceCount(const PaperParams& params);

/// Where each payload bit goes in the scrambled string: a keyed permutation.
/// Square images: the generalised Arnold map (x, y) -> (x + a y, b x + (a b + 1) y) mod N, repeated; a, b and the number
/// of rounds come from the key. Everything else: a keyed Fisher-Yates shuffle.
/// @return position in the scrambled string per payload bit.
[[nodiscard]] std::vector<std::uint32_t> scrambling(const Key& key);

/// Splits bits (one per byte, 0 or 1) into pieces of 3 D2 bits, most significant first, the last one zero padded,
/// after scrambling.
[[nodiscard]] std::vector<std::uint32_t> toPieces(std::span<const std::uint8_t> bits, const Key& key);

/// The keyed pad of a cell. It depends on the piece index and on the cell's label (the prefixes of its two ratios),
/// so that two copies of one piece look unrelated and, under a wrong key, disagree like coin flips. That is what gives
/// the verdict an exact null distribution.
class Pad {
 public:
  explicit Pad(const Key& key);

  /// 3 D2 bits to XOR with the piece.
  [[nodiscard]] std::uint32_t operator()(std::uint32_t index, std::uint32_t prefix1, std::uint32_t prefix2) const;

  /// Section 6.4 (D24): does the key let cells with this label carry pieces? Half of all labels, or every label when
  /// params.keyedCells is off.
  [[nodiscard]] bool carries(std::uint32_t prefix1, std::uint32_t prefix2) const;

  /// Content of a decoy (a cell with a label that carries nothing), indistinguishable from a piece without the key.
  [[nodiscard]] std::uint64_t decoy(std::uint64_t item) const { return decoy_(item); }

 private:
  Prf pad_, choice_, decoy_;
  std::uint32_t mask_;
  bool keyedCells_;
};

}  // namespace quadmark
