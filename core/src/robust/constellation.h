// SPDX-License-Identifier: MIT
// The keyed constellation of layer B: which pair of diagonal ratios means which coded bits.
#pragma once

#include <cstdint>
#include <vector>

#include "lattice.h"
#include "quadmark/robust/coded.h"
#include "ratio_plane.h"

namespace quadmark::robust {

/// The fine cells of a class in keyed order, cut into groups of 2^symbol: the cell of a group whose number equals the
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
  /// group * symbols() + symbol of a fine cell (FineCell::number), or kNone for the few left over.
  [[nodiscard]] std::uint32_t meaning(std::uint32_t cell) const { return meaning_[cell]; }
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
