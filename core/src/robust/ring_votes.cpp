// SPDX-License-Identifier: MIT
// A coordinate is a mixture: with some probability, the same for all, its carrier is still what it was and the
// coordinate lies on a lattice, up to noise; otherwise it may be anywhere. After simplification one carrier in twenty
// is left, and it is the narrow peak that finds it. Tried: votes linear in the distance from the lattices, which drown
// in what is left of the others (coded bit error rate of the bunny at .9 and 12 bits .26 instead of .11).
#include "ring_votes.h"

#include <algorithm>

#include "likelihood.h"
#include "quadmark/exact_math.h"
#include "quadmark/trig.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

constexpr double kMostPerLabel = 6;  // bound of one label's log-likelihood ratio
constexpr double kOwnSpread = 0.01;  // steps: rounding, and what the ring's later moves did
constexpr double kRingGain = 1.2;    // the ring moves under noise, too
constexpr double kTwoPiSquared = 19.739208802178716;

double peak(double x, double spread) {
  const double z = x / spread;
  return gaussian(z * z) / (spread * kRootTwoPi);
}

}  // namespace

RingVotes::RingVotes(const Carriers& carriers, const RingCode& code, const std::vector<double>& positions,
                     const SymmetricTensor& tensor) {
  const std::uint32_t count = carriers.count();
  std::vector<KeyedIndex> order(count);
  for (std::uint32_t c = 0; c < count; ++c) order[c] = {carriers.label[c], c};
  sortByKey(order);
  samples_.reserve(count);
  std::uint64_t current = 0;
  for (const auto& [label, c] : order) {
    RingFrame frame;
    if (!ringFrame(positions, carriers.ring(c), tensor, frame)) continue;
    const auto index = static_cast<std::uint32_t>(samples_.size());
    if (labels_.empty() || label != current) {
      current = label;
      labels_.push_back({{code.slot(current, 0), code.slot(current, 1)}, index, index});
    }
    const RingCoordinates p = coordinatesIn(frame, at(positions, carriers.vertex[c]));
    samples_.push_back(
        {{static_cast<float>(p.alpha), static_cast<float>(p.beta)}, static_cast<float>(frame.radius), c});
    labels_.back().end = index + 1;
  }
}

double RingVotes::vote(const Sample& sample, const Label& label, int coordinate, double step) const {
  const RingSlot& slot = label.slot[coordinate];
  const double vote = latticeVote(sample.coordinate[coordinate], step, slot.offset);
  return slot.pad ? -vote : vote;
}

// Wrapped normal distributions around the two lattices, half a step apart.
// @param distance  from the lattice of 0, steps, 0..0.5.
RingVotes::Densities RingVotes::densitiesAt(double distance, double spread) {
  if (spread < 0.2)
    return {peak(distance, spread) + peak(1 - distance, spread),
            peak(0.5 - distance, spread) + peak(0.5 + distance, spread)};
  // Wide peaks overlap: their Fourier series converges at once.
  const double q = exactExp(-kTwoPiSquared * spread * spread), q4 = q * q * q * q;
  const double first = sinCosTurns(distance).cos, second = 2 * first * first - 1;
  return {1 + 2 * q * first + 2 * q4 * second, 1 - 2 * q * first + 2 * q4 * second};
}

std::vector<RingVotes::Densities> RingVotes::densities(const RingView& view) const {
  std::vector<Densities> out(2 * samples_.size());
  for (const Label& label : labels_)
    for (std::uint32_t i = label.begin; i < label.end; ++i) {
      const double noise = kRingGain * view.sigma / (samples_[i].radius * view.step);
      const double spread = std::sqrt(noise * noise + kOwnSpread * kOwnSpread);
      for (int k = 0; k < 2; ++k)
        out[2 * i + k] = densitiesAt(0.25 * (1 - vote(samples_[i], label, k, view.step)), spread);
    }
  return out;
}

// The share of carriers that still are what they were, by expectation maximisation of that one number.
double RingVotes::estimateShare(const std::vector<Densities>& densities) {
  double share = 0.5;
  for (int step = 0; step < 12 && !densities.empty(); ++step) {
    double sum = 0;
    for (const Densities& d : densities) {
      const double marked = share * 0.5 * (d.zero + d.one);
      sum += marked / (1 - share + marked);
    }
    share = std::clamp(sum / static_cast<double>(densities.size()), 0.003, 0.98);
  }
  return share;
}

void RingVotes::addRatios(const RingView& view, const StreamSelection& selection, std::vector<float>& ratios) const {
  if (selection.bits == 0) return;
  const std::vector<Densities> all = densities(view);
  const double share = estimateShare(all);
  for (const Label& label : labels_)
    for (int k = 0; k < 2; ++k) {
      if (label.slot[k].stream(selection.sharing) != selection.stream) continue;
      double sum = 0;
      for (std::uint32_t i = label.begin; i < label.end; ++i) {
        const Densities& d = all[2 * i + k];
        sum += exactLog((1 - share + share * d.zero) / (1 - share + share * d.one));
      }
      ratios[label.slot[k].index % selection.bits] +=
          static_cast<float>(std::clamp(sum, -kMostPerLabel, kMostPerLabel));
    }
}

double RingVotes::fit(const RingView& view) const {
  const std::vector<Densities> all = densities(view);
  const double share = estimateShare(all);
  double sum = 0;
  for (const Densities& d : all) sum += exactLog(1 - share + share * 0.5 * (d.zero + d.one));
  return sum;
}

void RingVotes::countAgreement(double step, const StreamSelection& selection, const std::vector<std::uint8_t>& expected,
                               Agreement& out) const {
  if (expected.empty()) return;
  for (const Label& label : labels_)
    for (int k = 0; k < 2; ++k) {
      if (label.slot[k].stream(selection.sharing) != selection.stream) continue;
      double sum = 0;
      for (std::uint32_t i = label.begin; i < label.end; ++i) sum += vote(samples_[i], label, k, step);
      if (sum == 0) continue;
      ++out.votes;
      out.agreeing += (sum < 0) == (expected[label.slot[k].index % expected.size()] != 0);
    }
}

std::vector<float> RingVotes::agreementPerCarrier(double step, const CodedPayload& expected) const {
  const Sharing sharing = expected.hasBody() ? Sharing::split : Sharing::headOnly;
  std::vector<float> out;
  for (const Label& label : labels_)
    for (std::uint32_t i = label.begin; i < label.end; ++i) {
      double sum = 0;
      for (int k = 0; k < 2; ++k) {
        const auto& bits = label.slot[k].stream(sharing) == Stream::head ? expected.head : expected.body;
        if (bits.empty()) continue;
        const double v = vote(samples_[i], label, k, step);
        sum += bits[label.slot[k].index % bits.size()] != 0 ? -v : v;
      }
      if (out.size() <= samples_[i].carrier) out.resize(samples_[i].carrier + 1, 0.0f);
      out[samples_[i].carrier] = static_cast<float>(0.5 * sum);
    }
  return out;
}

std::uint32_t RingVotes::positionsHit(const StreamSelection& selection) const {
  std::vector<std::uint8_t> hit(selection.bits, 0);
  for (const Label& label : labels_)
    for (const RingSlot& slot : label.slot)
      if (selection.bits > 0 && slot.stream(selection.sharing) == selection.stream)
        hit[slot.index % selection.bits] = 1;
  return static_cast<std::uint32_t>(std::count(hit.begin(), hit.end(), 1));
}

}  // namespace quadmark::robust
