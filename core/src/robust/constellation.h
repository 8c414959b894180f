// SPDX-License-Identifier: MIT
// The keyed constellation of layer B: which pair of diagonal ratios means which coded bits.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lattice.h"
#include "quadmark/robust/coded.h"

namespace quadmark::robust {

/// A way to cut the plane of folded ratios, [0.1, 0.5] squared, into fine cells.
struct DeltaClass {
  double delta;          ///< side of a fine cell
  std::uint32_t side;    ///< fine cells along one axis: floor(0.4 / delta)
  std::uint32_t symbol;  ///< bits per symbol: one of 2^symbol cells of a group is good
};
/// Coarse cells survive quantization, fine ones hold more bits. Classes 0..2 are for IDs, 0, 3 and 4 for payloads with
/// a body.
inline constexpr std::array<DeltaClass, 5> kDeltas = {
    {{0.012, 33, 4}, {0.016, 25, 3}, {0.020, 20, 3}, {0.008, 50, 3}, {0.004, 100, 3}}};

/// Smallest folded ratio used.
inline constexpr double kLeastRatio = 0.1;

/// Number of the fine cell of a folded ratio, counted from 0.5 downwards; may be `side` or more.
inline std::uint32_t fineCell(double foldedRatio, const DeltaClass& c) {
  return static_cast<std::uint32_t>((0.5 - foldedRatio) / c.delta);
}
inline double fineCentre(std::uint32_t cell, const DeltaClass& c) {
  return 0.5 - (cell + 0.5) * c.delta;
}

/// The side * side fine cells in keyed order, cut into groups of 2^symbol: the cell of a group whose number equals the
/// group's coded bits is good, the others of the group stay empty. There is no index to corrupt, and the embedder may
/// move a diamond to whichever good cell is near.
class Constellation {
 public:
  Constellation(std::uint8_t deltaClass, const RobustKeys& keys, Sharing sharing, const StreamCode& head,
                const StreamCode& body);

  struct Slot {
    Stream stream = Stream::head;
    std::uint32_t bit = 0;  ///< coded bit of that stream
  };

  [[nodiscard]] const DeltaClass& shape() const { return shape_; }
  [[nodiscard]] std::uint32_t groups() const { return groups_; }
  [[nodiscard]] std::uint32_t symbols() const { return 1u << shape_.symbol; }
  /// group * symbols() + symbol of a fine cell (first axis: edge, second: span), or kNone for the few left over.
  [[nodiscard]] std::uint32_t meaning(std::uint32_t edgeCell, std::uint32_t spanCell) const {
    return meaning_[edgeCell * shape_.side + spanCell];
  }
  static constexpr std::uint32_t kNone = 0xffffffffu;
  /// What bit `t` of a group's symbol carries.
  [[nodiscard]] const Slot& slot(std::uint32_t group, std::uint32_t t) const {
    return slots_[group * shape_.symbol + t];
  }

  /// The good cell's number within each group.
  [[nodiscard]] std::vector<std::uint32_t> goodSymbols(const CodedPayload& payload) const;

 private:
  DeltaClass shape_;
  std::uint32_t groups_;
  std::vector<std::uint32_t> meaning_;
  std::vector<Slot> slots_;
};

}  // namespace quadmark::robust
