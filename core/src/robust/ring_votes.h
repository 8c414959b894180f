// SPDX-License-Identifier: MIT
// Reading layer A: what the carriers' coordinates say about coded bits.
#pragma once

#include <cstdint>
#include <vector>

#include "carriers.h"
#include "lattice.h"

namespace quadmark::robust {

/// Steps of the lattice, in ring radii.
inline constexpr double kRingStep = 0.5;

/// Which coded bits a call is about.
struct StreamSelection {
  Sharing sharing = Sharing::headOnly;
  Stream stream = Stream::head;
  std::uint32_t bits = 0;
};

/// The coordinates of all carriers, grouped by label: copies of a label speak about the same coded bit and are no
/// independent witnesses, so each label has one bounded vote.
class RingVotes {
 public:
  RingVotes(const Carriers& carriers, const RingCode& code, const std::vector<double>& positions,
            const SymmetricTensor& tensor);

  /// Adds the ratios under vertex noise of standard deviation `sigma` (file units) to `ratios`, selection.bits of them.
  void addRatios(double sigma, const StreamSelection& selection, std::vector<float>& ratios) const;

  /// One vote per label and coordinate, unweighted: does its sign agree with the expected bit?
  void countAgreement(const StreamSelection& selection, const std::vector<std::uint8_t>& expected,
                      Agreement& out) const;

  /// Per carrier (in the order given) the mean of its two votes for the expected bits, -1..1.
  [[nodiscard]] std::vector<float> agreementPerCarrier(const CodedPayload& expected) const;

  [[nodiscard]] std::uint32_t labelCount() const { return static_cast<std::uint32_t>(labels_.size()); }
  /// Coded positions of a stream that at least one label speaks about.
  [[nodiscard]] std::uint32_t positionsHit(const StreamSelection& selection) const;

 private:
  struct Sample {
    float vote[2];  // latticeVote, pad undone
    float radius;
    std::uint32_t carrier;
  };
  struct Label {
    RingSlot slot[2];
    std::uint32_t begin, end;  // of its samples
  };
  std::vector<Sample> samples_;
  std::vector<Label> labels_;
};

}  // namespace quadmark::robust
