// SPDX-License-Identifier: MIT
// What the papers leave to "a secret key", the same for all peers: which bit a carrier holds, a pad that makes the written
// bits look random, and the sums of a carrier's votes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "../schemes/scheme.h"
#include "quadmark/prf.h"

namespace quadmark::bench {

/// The keyed assignment of `count` >= 1 payload bits to carriers.
class KeyedBits {
 public:
  /// @param purpose  the scheme's name: schemes under one key have nothing in common.
  KeyedBits(std::uint64_t key, std::string_view purpose, std::size_t count);

  [[nodiscard]] std::size_t count() const { return order_.size(); }
  /// The payload bit that a carrier holds; all bits take turns.
  [[nodiscard]] std::size_t bitAt(std::uint64_t carrier) const { return order_[carrier % order_.size()]; }
  /// What a carrier is to hold when `written` is what the bits are to hold (padded).
  [[nodiscard]] bool held(const Bits& written, std::uint64_t carrier) const { return written[bitAt(carrier)] != 0; }
  /// What is written for a payload's bit: whitened, so that an all-zero logo is as hard to guess as a random one.
  [[nodiscard]] bool padded(std::size_t bit, std::uint8_t value) const { return (value != 0) != (pad_[bit] != 0); }

 private:
  std::vector<std::uint32_t> order_;
  Bits pad_;
};

/// Bits, always 0, that peers with several possible frames write after the payload, to know the right frame when reading.
constexpr std::size_t kPilots = 16;

/// Sums of votes per payload bit.
class BitVotes {
 public:
  explicit BitVotes(const KeyedBits& bits) : bits_(&bits), sums_(bits.count(), 0), heard_(bits.count(), 0) {}

  /// @param weight  > 0 votes for a written 1, < 0 for a written 0, 0 for nothing.
  void add(std::uint64_t carrier, double weight);
  /// All votes of another sum over the same bits.
  void add(const BitVotes& other);
  /// How far the votes speak for the frame they were read in: what is left of them after opposite ones, as far as the
  /// last kPilots bits are 0. 0 where these are 1 at least as much.
  [[nodiscard]] double clearness() const;
  /// Whether no two votes for one bit differed.
  [[nodiscard]] bool unanimous() const { return unanimous_; }
  /// The first `count` bits. Those without a vote are unread. Empty when none has one.
  [[nodiscard]] TrialReading reading(std::size_t count) const;
  [[nodiscard]] TrialReading reading() const { return reading(sums_.size()); }

 private:
  const KeyedBits* bits_;
  std::vector<double> sums_;
  Bits heard_;
  bool unanimous_ = true;
};

}  // namespace quadmark::bench
