// SPDX-License-Identifier: MIT
// Reading layer A: what the carriers' coordinates say about coded bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "carriers.h"
#include "lattice.h"

namespace quadmark::robust {

/// Which coded bits a call is about.
struct StreamSelection {
  Sharing sharing = Sharing::headOnly;
  Stream stream = Stream::head;
  std::uint32_t bits = 0;
};

/// How layer A is looked at: a lattice step and a noise level.
struct RingView {
  double step = kRingSteps[0];
  double sigma = 0;  ///< vertex noise, standard deviation, file units
};

/// The coordinates of all carriers, grouped by label: copies of a label speak about the same coded bit and are no
/// independent witnesses, so each label has one bounded vote.
class RingVotes {
 public:
  RingVotes(const Carriers& carriers, const RingCode& code, const std::vector<double>& positions,
            const SymmetricTensor& tensor);

  /// Adds ratios to `ratios`, selection.bits of them.
  void addRatios(const RingView& view, const StreamSelection& selection, std::vector<float>& ratios) const;

  /// How much better "some coordinates lie on either lattice" explains the carriers than "none does", as a logarithm.
  /// Looks at no payload, so choosing the best of several steps by it costs no significance.
  [[nodiscard]] double fit(const RingView& view) const;

  /// One vote per label, coordinate and bit, unweighted: does its sign agree with the expected bit?
  void countAgreement(double step, const StreamSelection& selection, const std::vector<std::uint8_t>& expected,
                      Agreement& out) const;

  /// Per carrier (in the order given, as far as the last one read) the mean of its two votes for the expected bits,
  /// -1..1.
  [[nodiscard]] std::vector<float> agreementPerCarrier(double step, const CodedPayload& expected) const;

  [[nodiscard]] std::uint32_t labelCount() const { return static_cast<std::uint32_t>(labels_.size()); }
  /// Coded positions of a stream that at least one label speaks about.
  [[nodiscard]] std::uint32_t positionsHit(const StreamSelection& selection) const;

 private:
  struct Sample {
    float coordinate[2];
    float radius;
    std::uint32_t carrier;
  };
  struct Label {
    double offset[2];
    std::uint32_t begin, end;  // of its samples
    std::uint32_t firstSlot;   // of its slots: those of alpha, then as many of beta
    std::uint32_t bits;        // per coordinate
  };
  // Densities of a coordinate if its carrier holds 0 or 1; 1 is the density of one that holds nothing.
  struct Densities {
    double zero, one;
  };
  // Log-likelihood of each value that a coordinate of several bits may hold, over that of holding nothing.
  using ValueScores = std::array<double, std::size_t{1} << kMostRingBits>;

  static Densities densitiesAt(double distance, double spread);
  [[nodiscard]] static double estimateShare(const std::vector<Densities>& densities);
  [[nodiscard]] std::span<const RingSlot> slots(const Label& label, int coordinate) const {
    return {slots_.data() + label.firstSlot + static_cast<std::uint32_t>(coordinate) * label.bits, label.bits};
  }
  [[nodiscard]] double spread(const Sample& sample, const RingView& view) const;
  // Of the samples of labels with one bit per coordinate, in the order of samples_.
  [[nodiscard]] std::vector<Densities> densities(const RingView& view) const;
  [[nodiscard]] ValueScores scores(const Label& label, int coordinate, const RingView& view) const;

  std::vector<Sample> samples_;
  std::vector<Label> labels_;
  std::vector<RingSlot> slots_;
};

}  // namespace quadmark::robust
