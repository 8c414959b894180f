// SPDX-License-Identifier: MIT
// How much a reading is worth: the share of true cells among readings of its kind, estimated from the file itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "quadmark/digits.h"

namespace quadmark {

/// Readings fall into kinds by how flat they are (gap in powers of two of the rounding unit) and how central in their
/// digit cells. A true cell always has a valid index and octal digits; a chance set that has the same leading digits is
/// valid with a known probability (Reading::chance). So of V valid readings among N that could be, with C expected by
/// chance, (V - C) / (N - C) of N are true cells, and N / V times that of the valid ones: the purity. Nothing is assumed
/// about the attack: after quantization the mass moves to less flat or less central kinds, and their validity says so.
///
/// Tried: weights from a Gaussian model of the gap (needs the attack's noise level, and is badly wrong on CAD models,
/// whose natural sets are exactly flat); weights by pass only (the chance sets of the bunny, a third of pass 1, then
/// vote with full weight); one probability for all digits (0.46 at 900 pieces: natural ratios crowd below 0.5, so leading
/// digits are far from uniform, and unmarked scans got credit).
class PurityTable {
 public:
  static constexpr int kFlatness = 24, kCentrality = 5;

  /// @param expected  readings to come, about: saves growing.
  explicit PurityTable(std::size_t expected = 0);

  /// Kind of a reading: `units` = gap in rounding units.
  [[nodiscard]] static int kind(double units, const Reading& reading);

  /// Counts a reading. Repeats of the same reading in the same kind count once: a model with repeated structures would
  /// otherwise speak with one voice a thousand times.
  void add(int kind, const Reading& reading, double ratio1, double ratio2);

  /// To be called after the last add().
  void estimate();

  /// 0 .. 0.998.
  [[nodiscard]] double purity(int kind) const { return purity_[kind]; }

  /// Standard deviations by which the share of valid readings exceeds chance: evidence of some mark with these
  /// parameters, of whatever key.
  [[nodiscard]] double excess() const { return excess_; }

 private:
  struct Counted {
    std::uint64_t fingerprint;
    double chance;
    int kind;
    bool valid;
  };
  static constexpr std::size_t kAhead = 16;

  void count(const Counted& reading);
  bool firstTime(std::uint64_t fingerprint);

  std::array<double, kFlatness * kCentrality> valid_{}, total_{}, byChance_{}, purity_{};
  double excess_ = 0;
  std::vector<std::uint64_t> seen_;  ///< open addressing, 0 = free
  std::size_t seenCount_ = 0;
  std::array<Counted, kAhead> waiting_;  ///< a ring: what came last, while the memory for it is being fetched
  std::size_t added_ = 0;
};

}  // namespace quadmark
