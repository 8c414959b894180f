// SPDX-License-Identifier: MIT
// J.-W. Cho, R. Prost, H.-Y. Jung: An oblivious watermarking for 3-D polygonal meshes using distribution of vertex norms,
// IEEE Transactions on Signal Processing 55(1), 2007, pages 142-155.
//
// The distances of the vertices from their centre ("norms") are sorted into as many equal bins as there are bits. Inside a
// bin they are scaled to 0 .. 1 (method I, mean) or -1 .. 1 (method II, variance), where a uniform distribution has mean
// 1/2 and mean square 1/3. A bit bends the distribution by |x|^k until its mean or mean square is beyond that value by
// the strength; k goes up or down in steps of 0.001. Reading compares with 1/2 or 1/3.
//
// The paper leaves open, and here is decided:
// - Moving vertices moves their centre, and thereby the bins ("causality"): marking is repeated on the marked positions, at
//   most eight times, for bins that do not reach the strength any more. Without that some bits are lost before any attack.
// - The key orders the bits along the bins and pads them; the paper's sequence is public.
// - Welded vertices count once, so that a seam does not change the distribution.
// - k stops at 0.001 and at 16: a bin whose norms sit at its ends cannot be bent and keeps its wrong bit.
// Strength: the paper's alpha. 0.04 moves vertices of a scan by about 0.02 % of the diagonal.
#include <algorithm>
#include <cmath>

#include "quadmark/vec3.h"
#include "welded_peer.h"

namespace quadmark::bench {
namespace {

enum class Statistic : std::uint8_t { mean, variance };

constexpr double kStep = 0.001;
constexpr double kHighestPower = 16;
constexpr int kRounds = 8;

// The norms of all vertices, and which bin each is in.
struct NormBins {
  Vec3 centre;
  double low = 0, width = 0;  // of the first bin; of each bin
  std::vector<std::vector<std::uint32_t>> members;
  std::vector<double> scaled;  // per vertex, 0 .. 1 inside its bin

  NormBins(const std::vector<double>& positions, std::size_t bins) : members(bins), scaled(positions.size() / 3, 0) {
    const std::size_t count = scaled.size();
    if (count == 0) return;
    for (std::size_t v = 0; v < count; ++v) centre += at(positions, v);
    centre = (1.0 / static_cast<double>(count)) * centre;
    for (std::size_t v = 0; v < count; ++v) scaled[v] = length(at(positions, v) - centre);
    const auto [least, most] = std::minmax_element(scaled.begin(), scaled.end());
    low = *least;
    width = (*most - *least) / static_cast<double>(bins);
    if (!(width > 0)) return;
    for (std::size_t v = 0; v < count; ++v) {
      const double place = (scaled[v] - low) / width;
      const std::size_t bin = std::min(static_cast<std::size_t>(place), bins - 1);
      scaled[v] = std::clamp(place - static_cast<double>(bin), 0.0, 1.0);
      members[bin].push_back(static_cast<std::uint32_t>(v));
    }
  }
};

class Cho final : public WeldedPeer {
 public:
  explicit Cho(Statistic statistic) : statistic_(statistic) {}

  std::string name() const override { return statistic_ == Statistic::mean ? "cho-mean" : "cho-variance"; }
  PeerInfo info() const override;

 protected:
  std::vector<Setting> settings() const override {
    return {{"strength", statistic_ == Statistic::mean ? 0.04 : 0.06, 0.001, 0.3}};
  }
  void write(const Work& work, const Bits& written, std::vector<double>& moved, TrialMark& mark) const override;
  void vote(const Work& work, BitVotes& votes) const override;

 private:
  // The statistic of a bin less its value for a uniform distribution, its norms bent by a power.
  double excess(const NormBins& bins, std::size_t bin, double power) const {
    double sum = 0;
    for (const std::uint32_t v : bins.members[bin]) {
      const double x = bent(bins.scaled[v], power);
      sum += statistic_ == Statistic::mean ? x : (2 * x - 1) * (2 * x - 1);
    }
    return sum / static_cast<double>(bins.members[bin].size()) - (statistic_ == Statistic::mean ? 1.0 / 2 : 1.0 / 3);
  }

  // 0 .. 1 to 0 .. 1.
  double bent(double x, double power) const {
    if (statistic_ == Statistic::mean) return std::pow(x, power);
    const double y = 2 * x - 1;
    return (std::copysign(std::pow(std::abs(y), power), y) + 1) / 2;
  }

  // The power of the fewest steps from 1 that brings a bin's excess beyond +-strength, or 1 where none does.
  double powerFor(const NormBins& bins, std::size_t bin, bool one, double strength) const {
    const auto reaches = [&](int steps) {
      const double beyond = excess(bins, bin, 1 + (one ? -kStep : kStep) * steps);
      return one ? beyond >= strength : beyond <= -strength;
    };
    int enough = one ? static_cast<int>(1 / kStep) - 1 : static_cast<int>((kHighestPower - 1) / kStep);
    if (reaches(0) || !reaches(enough)) return 1;
    // The statistic is monotone in the power: bisection finds the step at which the paper's loop ends.
    for (int tooFew = 0; enough - tooFew > 1;) {
      const int middle = (enough + tooFew) / 2;
      (reaches(middle) ? enough : tooFew) = middle;
    }
    return 1 + (one ? -kStep : kStep) * enough;
  }

  Statistic statistic_;
};

PeerInfo Cho::info() const {
  return {"J.-W. Cho, R. Prost, H.-Y. Jung",
          "An oblivious watermarking for 3-D polygonal meshes using distribution of vertex norms (" +
              std::string(statistic_ == Statistic::mean ? "I, mean" : "II, variance") + ")",
          "IEEE Transactions on Signal Processing 55(1)",
          2007,
          true,
          "a bin of distances from the centre",
          describe(settings()),
          "marking is repeated until the bins that moved with the centre hold their bits; the key orders and pads the bits",
          "LIRIS Venus at an rms of 0.012 % of the diagonal (Wang et al. 2010, 2011): bit error rates 0 / .01 / .10 / .24 "
          "under noise of .05 / .1 / .3 / .5 %, 0 / .02 / .06 / .18 at 11 / 10 / 9 / 8 bits, .06 / .16 / .34 after 5 / 10 / "
          "30 smoothing steps, not exceeded by more than .05 on bunny and sculpture; lost after affine maps and cropping"};
}

void Cho::write(const Work& work, const Bits& written, std::vector<double>& moved, TrialMark& mark) const {
  mark.carriers = work.bits.count();
  for (int round = 0; round < kRounds; ++round) {
    const NormBins bins(moved, work.bits.count());
    bool changed = false;
    for (std::size_t bin = 0; bin < bins.members.size(); ++bin) {
      if (bins.members[bin].empty()) continue;
      const double power = powerFor(bins, bin, work.bits.held(written, bin), work.values[0]);
      if (power == 1) continue;
      changed = true;
      for (const std::uint32_t v : bins.members[bin]) {
        const Vec3 from = at(moved, v) - bins.centre;
        const double norm = bins.low + bins.width * (static_cast<double>(bin) + bent(bins.scaled[v], power));
        if (length(from) > 0) put(moved, v, bins.centre + (norm / length(from)) * from);
      }
    }
    if (!changed) return;
  }
}

void Cho::vote(const Work& work, BitVotes& votes) const {
  const NormBins bins(work.welded.positions, work.bits.count());
  for (std::size_t bin = 0; bin < bins.members.size(); ++bin) {
    if (!bins.members[bin].empty()) votes.add(bin, excess(bins, bin, 1));
  }
}

}  // namespace

std::unique_ptr<Peer> choMean() {
  return std::make_unique<Cho>(Statistic::mean);
}
std::unique_ptr<Peer> choVariance() {
  return std::make_unique<Cho>(Statistic::variance);
}

}  // namespace quadmark::bench
