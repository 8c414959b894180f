// SPDX-License-Identifier: MIT
#include "purity.h"

#include <algorithm>
#include <cmath>

namespace quadmark {
namespace {

constexpr double kMaxPurity = 0.998;
constexpr double kPriorReadings = 8;  // a kind with few readings leans on the whole pass by this many

std::uint64_t mix(std::uint64_t x) {
  x = (x ^ x >> 31) * 0x7fb5d329728ea185u;
  x = (x ^ x >> 27) * 0x81dadef4bc2dd44du;
  return x ^ x >> 33;
}

}  // namespace

PurityTable::PurityTable(const PairCodec& codec) : seen_(1024, 0) {
  chance_ = static_cast<double>(codec.pieces()) / codec.indexSlot().codeCount();
  for (int digit = 0; digit < codec.pieceSlot().digitCount(); ++digit) chance_ *= 0.8;
  chance_ = std::min(chance_, 0.95);
}

int PurityTable::kind(double units, const Reading& reading) {
  int flatness = 0;
  for (double limit = 1; units > limit && flatness < kFlatness - 1; limit *= 2) ++flatness;
  const double off = std::max(std::fabs(reading.residue1), std::fabs(reading.residue2));
  return flatness * kCentrality + std::min(kCentrality - 1, static_cast<int>(off * 10));
}

bool PurityTable::firstTime(std::uint64_t fingerprint) {
  if (2 * ++seenCount_ > seen_.size()) {
    std::vector<std::uint64_t> old(2 * seen_.size(), 0);
    old.swap(seen_);
    for (std::uint64_t value : old) {
      if (value == 0) continue;
      std::size_t slot = value & (seen_.size() - 1);
      while (seen_[slot] != 0) slot = (slot + 1) & (seen_.size() - 1);
      seen_[slot] = value;
    }
  }
  std::size_t slot = fingerprint & (seen_.size() - 1);
  for (; seen_[slot] != 0; slot = (slot + 1) & (seen_.size() - 1))
    if (seen_[slot] == fingerprint) {
      --seenCount_;
      return false;
    }
  seen_[slot] = fingerprint;
  return true;
}

void PurityTable::add(int kind, const Reading& reading, double ratio1, double ratio2) {
  if (reading.state == ReadingState::ambiguousOrder || reading.state == ReadingState::outOfRange) return;
  // Ratios to seven decimals: enough to tell readings apart, coarse enough to see that two are the same shape.
  const auto shape = static_cast<std::uint64_t>(ratio1 * 1e7) << 32 | static_cast<std::uint64_t>(ratio2 * 1e7);
  const std::uint64_t fingerprint = mix(shape * 128 + static_cast<std::uint64_t>(kind)) | 1;
  if (!firstTime(fingerprint)) return;
  ++total_[kind];
  if (reading.state == ReadingState::ok) ++valid_[kind];
}

void PurityTable::estimate() {
  double valid = 0, total = 0;
  for (std::size_t i = 0; i < total_.size(); ++i) valid += valid_[i], total += total_[i];
  purity_.fill(0);
  excess_ = 0;
  if (total == 0) return;
  const double sd = std::sqrt(chance_ * (1 - chance_) / total);
  const double share = valid / total;
  excess_ = (share - chance_) / sd;
  // The pass as a whole gets no credit for what chance does half of the time.
  const double base = std::max(chance_, share - 0.5 * std::sqrt(share * (1 - share) / total));
  for (std::size_t i = 0; i < total_.size(); ++i) {
    const double v = (valid_[i] + kPriorReadings * base) / (total_[i] + kPriorReadings);
    purity_[i] = std::clamp((v - chance_) / (1 - chance_), 0.0, kMaxPurity);
  }
}

}  // namespace quadmark
