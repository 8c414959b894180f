// SPDX-License-Identifier: MIT
#include "ring_votes.h"

#include <algorithm>
#include <numeric>

namespace quadmark::robust {
namespace {

// Expected amplitude of a vote under vertex noise: exp(-2 pi^2 s^2) of the lattice's first harmonic, as 1 / Taylor of
// its inverse; 1.2 because the ring moves too, 0.85 for carriers that the embedder could not write.
double amplitude(double sigma, double radius) {
  const double s = 1.2 * sigma / (radius * kRingStep), q = 19.739208802178716 * s * s;
  return 0.85 / (1 + q * (1 + q * (0.5 + q * (1.0 / 6 + q / 24))));
}

constexpr double kVoteVariance = 0.353;  // 1/3 of a uniform coordinate's votes, and a little for the model's faults
constexpr double kMostPerLabel = 3;      // bound of one label's vote; its exact value is irrelevant (m)
constexpr double kFaintest = 0.002;      // amplitudes below this are left out

}  // namespace

RingVotes::RingVotes(const Carriers& carriers, const RingCode& code, const std::vector<double>& positions,
                     const SymmetricTensor& tensor) {
  const std::uint32_t count = carriers.count();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return carriers.label[a] != carriers.label[b] ? carriers.label[a] < carriers.label[b] : a < b;
  });
  samples_.reserve(count);
  std::uint64_t current = 0;
  for (const std::uint32_t c : order) {
    RingFrame frame;
    if (!ringFrame(positions, carriers.ring(c), tensor, frame)) continue;
    const auto at = static_cast<std::uint32_t>(samples_.size());
    if (labels_.empty() || carriers.label[c] != current) {
      current = carriers.label[c];
      labels_.push_back({{code.slot(current, 0), code.slot(current, 1)}, at, at});
    }
    Label& label = labels_.back();
    const RingCoordinates p = coordinatesIn(frame, quadmark::at(positions, carriers.vertex[c]));
    const double coordinate[2] = {p.alpha, p.beta};
    Sample sample{};
    for (int k = 0; k < 2; ++k) {
      const double vote = latticeVote(coordinate[k], kRingStep, label.slot[k].offset);
      sample.vote[k] = static_cast<float>(label.slot[k].pad ? -vote : vote);
    }
    sample.radius = static_cast<float>(frame.radius);
    sample.carrier = c;
    samples_.push_back(sample);
    label.end = at + 1;
  }
}

void RingVotes::addRatios(double sigma, const StreamSelection& selection, std::vector<float>& ratios) const {
  if (selection.bits == 0) return;
  for (const Label& label : labels_) {
    double sum[2] = {0, 0};
    for (std::uint32_t i = label.begin; i < label.end; ++i) {
      const double weight = amplitude(sigma, samples_[i].radius);
      if (weight < kFaintest) continue;
      for (int k = 0; k < 2; ++k) sum[k] += weight * samples_[i].vote[k];
    }
    for (int k = 0; k < 2; ++k) {
      if (label.slot[k].stream(selection.sharing) != selection.stream) continue;
      const double bounded = std::clamp(sum[k] / kVoteVariance, -kMostPerLabel, kMostPerLabel);
      ratios[label.slot[k].index % selection.bits] += static_cast<float>(2 * bounded);
    }
  }
}

void RingVotes::countAgreement(const StreamSelection& selection, const std::vector<std::uint8_t>& expected,
                               Agreement& out) const {
  if (expected.empty()) return;
  for (const Label& label : labels_)
    for (int k = 0; k < 2; ++k) {
      if (label.slot[k].stream(selection.sharing) != selection.stream) continue;
      double sum = 0;
      for (std::uint32_t i = label.begin; i < label.end; ++i) sum += samples_[i].vote[k];
      if (sum == 0) continue;
      ++out.votes;
      out.agreeing += (sum < 0) == (expected[label.slot[k].index % expected.size()] != 0);
    }
}

std::vector<float> RingVotes::agreementPerCarrier(const CodedPayload& expected) const {
  const Sharing sharing = expected.hasBody() ? Sharing::split : Sharing::headOnly;
  std::vector<float> out;
  for (const Label& label : labels_)
    for (std::uint32_t i = label.begin; i < label.end; ++i) {
      float sum = 0;
      for (int k = 0; k < 2; ++k) {
        const auto& bits = label.slot[k].stream(sharing) == Stream::head ? expected.head : expected.body;
        if (bits.empty()) continue;
        sum += bits[label.slot[k].index % bits.size()] != 0 ? -samples_[i].vote[k] : samples_[i].vote[k];
      }
      if (out.size() <= samples_[i].carrier) out.resize(samples_[i].carrier + 1, 0.0f);
      out[samples_[i].carrier] = 0.5f * sum;
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
