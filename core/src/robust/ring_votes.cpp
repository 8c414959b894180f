// SPDX-License-Identifier: MIT
// A coordinate is a mixture: with some probability, the same for all, its carrier is still what it was and the
// coordinate lies on a lattice, up to noise; otherwise it may be anywhere. After simplification one carrier in twenty
// is left, and it is the narrow peak that finds it. Tried: votes linear in the distance from the lattices, which drown
// in what is left of the others (coded bit error rate of the bunny at .9 and 12 bits .26 instead of .11).
#include "ring_votes.h"

#include <algorithm>
#include <cmath>

#include "likelihood.h"
#include "quadmark/exact_math.h"
#include "quadmark/trig.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

constexpr double kFarthest = 1e6;   // ring radii: a vertex farther off its ring says nothing, and is no number to reckon with
constexpr double kMostPerLabel = 6;  // bound of one label's log-likelihood ratio
constexpr double kOwnSpread = 0.01;  // steps: rounding, and what the ring's later moves did
constexpr double kRingGain = 1.2;    // the ring moves under noise, too
constexpr double kTwoPi = 6.283185307179586, kTwoPiSquared = 19.739208802178716;

double peak(double x, double spread) {
  const double z = x / spread;
  return gaussian(z * z) / (spread * kRootTwoPi);
}

// Logarithm of the sum of exp(score) over the values whose bits under `mask` are `wanted`.
double logSum(std::span<const double> score, std::uint32_t bits, std::uint32_t mask, std::uint32_t wanted) {
  const std::uint32_t values = 1u << bits;
  double top = -1e300, sum = 0;
  for (std::uint32_t value = 0; value < values; ++value)
    if ((value & mask) == wanted) top = std::max(top, score[value]);
  for (std::uint32_t value = 0; value < values; ++value)
    if ((value & mask) == wanted) sum += exactExp(score[value] - top);
  return top + exactLog(sum);
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
    const RingCoordinates p = coordinatesIn(frame, at(positions, carriers.vertex[c]));
    if (!(std::fabs(p.alpha) < kFarthest && std::fabs(p.beta) < kFarthest)) continue;
    const auto index = static_cast<std::uint32_t>(samples_.size());
    if (labels_.empty() || label != current) {
      current = label;
      Label next{{}, index, index, static_cast<std::uint32_t>(slots_.size()), carriers.bits[c]};
      for (int k = 0; k < 2; ++k) {
        const RingPlace place = code.place(label, k, next.bits);
        next.offset[k] = place.offset;
        slots_.resize(slots_.size() + next.bits);
        std::copy_n(place.slot, next.bits, slots_.end() - next.bits);
      }
      labels_.push_back(next);
    }
    samples_.push_back(
        {{static_cast<float>(p.alpha), static_cast<float>(p.beta)}, static_cast<float>(frame.radius), c});
    labels_.back().end = index + 1;
  }
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

double RingVotes::spread(const Sample& sample, const RingView& view) const {
  const double noise = kRingGain * view.sigma / (sample.radius * view.step);
  return std::sqrt(noise * noise + kOwnSpread * kOwnSpread);
}

std::vector<RingVotes::Densities> RingVotes::densities(const RingView& view) const {
  std::vector<Densities> out;
  out.reserve(2 * samples_.size());
  for (const Label& label : labels_) {
    if (label.bits > 1) continue;
    for (std::uint32_t i = label.begin; i < label.end; ++i) {
      const double ofSample = spread(samples_[i], view);
      for (int k = 0; k < 2; ++k) {
        const double vote = latticeVote(samples_[i].coordinate[k], view.step, label.offset[k]);
        out.push_back(densitiesAt(0.25 * (1 - vote), ofSample));
      }
    }
  }
  return out;
}

// Copies are one von Mises distribution around the point of their value: only their weighted mean on the circle matters.
// The weight of one is bounded, as some may hold nothing; a peak so wide stands root(2 pi weight) above the level.
RingVotes::ValueScores RingVotes::scores(const Label& label, int coordinate, const RingView& view) const {
  constexpr double kMostWeight = 6;
  double cosine = 0, sine = 0, level = 0;
  for (std::uint32_t i = label.begin; i < label.end; ++i) {
    const double s = spread(samples_[i], view), weight = std::min(kMostWeight, 1 / (2 * kTwoPiSquared * s * s));
    const SinCos phase = sinCosTurns(samples_[i].coordinate[coordinate] / view.step - label.offset[coordinate]);
    cosine += weight * phase.cos;
    sine += weight * phase.sin;
    level += 0.5 * exactLog(1 + kTwoPi * weight) - weight;
  }
  ValueScores out{};
  const std::uint32_t points = 1u << label.bits;
  for (std::uint32_t k = 0; k < points; ++k) {
    const SinCos point = sinCosTurns((k + 0.5) / points);
    out[valueOfPoint(k, label.bits)] = level + cosine * point.cos + sine * point.sin;
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
  const auto add = [&](const RingSlot& slot, double ratio) {
    const double bounded = std::clamp(ratio, -kMostPerLabel, kMostPerLabel);
    ratios[slot.index % selection.bits] += static_cast<float>(slot.pad ? -bounded : bounded);
  };
  std::size_t known = 0;  // of `all`
  for (const Label& label : labels_) {
    const std::uint32_t copies = label.end - label.begin;
    for (int k = 0; k < 2; ++k) {
      const auto slot = slots(label, k);
      if (label.bits == 1) {
        if (slot[0].stream(selection.sharing) != selection.stream) continue;
        double sum = 0;
        for (std::uint32_t i = 0; i < copies; ++i) {
          const Densities& d = all[known + 2 * i + static_cast<std::size_t>(k)];
          sum += exactLog((1 - share + share * d.zero) / (1 - share + share * d.one));
        }
        add(slot[0], sum);
        continue;
      }
      const ValueScores score = scores(label, k, view);
      for (std::uint32_t t = 0; t < label.bits; ++t)
        if (slot[t].stream(selection.sharing) == selection.stream)
          add(slot[t], logSum(score, label.bits, 1u << t, 0) - logSum(score, label.bits, 1u << t, 1u << t));
    }
    if (label.bits == 1) known += 2 * std::size_t{copies};
  }
}

double RingVotes::fit(const RingView& view) const {
  const std::vector<Densities> all = densities(view);
  const double share = estimateShare(all);
  double sum = 0;
  for (const Densities& d : all) sum += exactLog(1 - share + share * 0.5 * (d.zero + d.one));
  for (const Label& label : labels_)
    for (int k = 0; k < 2 && label.bits > 1; ++k)
      sum += logSum(scores(label, k, view), label.bits, 0, 0) - kLn2 * label.bits;
  return sum;
}

void RingVotes::countAgreement(double step, const StreamSelection& selection, const std::vector<std::uint8_t>& expected,
                               Agreement& out) const {
  if (expected.empty()) return;
  for (const Label& label : labels_)
    for (int k = 0; k < 2; ++k) {
      const auto slot = slots(label, k);
      for (std::uint32_t t = 0; t < label.bits; ++t) {
        if (slot[t].stream(selection.sharing) != selection.stream) continue;
        double sum = 0;
        for (std::uint32_t i = label.begin; i < label.end; ++i)
          sum += bitVote(samples_[i].coordinate[k], step, label.offset[k], t);
        if (sum == 0) continue;
        ++out.votes;
        out.agreeing += (sum < 0) == ((expected[slot[t].index % expected.size()] != 0) != slot[t].pad) ? 1 : 0;
      }
    }
}

std::vector<float> RingVotes::agreementPerCarrier(double step, const CodedPayload& expected) const {
  const Sharing sharing = expected.hasBody() ? Sharing::split : Sharing::headOnly;
  std::vector<float> out;
  for (const Label& label : labels_) {
    double lattice[2];
    for (int k = 0; k < 2; ++k)
      lattice[k] = label.offset[k] + phaseOf(valueAt(slots(label, k), expected, sharing), label.bits);
    for (std::uint32_t i = label.begin; i < label.end; ++i) {
      double sum = 0;
      for (int k = 0; k < 2; ++k) sum += latticeVote(samples_[i].coordinate[k], step, lattice[k]);
      if (out.size() <= samples_[i].carrier) out.resize(samples_[i].carrier + 1, 0.0f);
      out[samples_[i].carrier] = static_cast<float>(0.5 * sum);
    }
  }
  return out;
}

std::uint32_t RingVotes::positionsHit(const StreamSelection& selection) const {
  std::vector<std::uint8_t> hit(selection.bits, 0);
  for (const RingSlot& slot : slots_)
    if (selection.bits > 0 && slot.stream(selection.sharing) == selection.stream) hit[slot.index % selection.bits] = 1;
  return static_cast<std::uint32_t>(std::count(hit.begin(), hit.end(), 1));
}

}  // namespace quadmark::robust
