// SPDX-License-Identifier: MIT
#include "purity.h"

#include <algorithm>
#include <cmath>

namespace quadmark {
namespace {

constexpr double kMaxPurity = 0.998;
constexpr double kPriorReadings = 8;  // a kind with few readings leans on the whole pass by this many
constexpr double kLeastExcess = 2.5;  // standard deviations; a pass that does not show more than chance has no vote

std::uint64_t mix(std::uint64_t x) {
  x = (x ^ x >> 31) * 0x7fb5d329728ea185u;
  x = (x ^ x >> 27) * 0x81dadef4bc2dd44du;
  return x ^ x >> 33;
}

}  // namespace

PurityTable::PurityTable(std::size_t expected) {
  std::size_t capacity = 1024;
  while (capacity < 2 * expected) capacity *= 2;
  seen_.assign(capacity, 0);
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
  if (!(reading.chance > 0)) return;
  // Ratios to seven decimals: enough to tell readings apart, coarse enough to see that two are the same shape.
  const auto shape = static_cast<std::uint64_t>(ratio1 * 1e7) << 32 | static_cast<std::uint64_t>(ratio2 * 1e7);
  const std::uint64_t fingerprint = mix(shape * 128 + static_cast<std::uint64_t>(kind)) | 1;
  __builtin_prefetch(&seen_[fingerprint & (seen_.size() - 1)]);  // far beyond any cache on large meshes
  Counted& slot = waiting_[added_ % kAhead];
  if (added_++ >= kAhead) count(slot);
  slot = {fingerprint, reading.chance, kind, reading.state == ReadingState::ok};
}

void PurityTable::count(const Counted& reading) {
  if (!firstTime(reading.fingerprint)) return;
  total_[reading.kind] += 1;
  byChance_[reading.kind] += reading.chance;
  if (reading.valid) valid_[reading.kind] += 1;
}

void PurityTable::estimate() {
  for (std::size_t i = added_ - std::min(added_, kAhead); i < added_; ++i) count(waiting_[i % kAhead]);
  added_ = 0;
  double valid = 0, total = 0, byChance = 0;
  for (std::size_t i = 0; i < total_.size(); ++i) valid += valid_[i], total += total_[i], byChance += byChance_[i];
  purity_.fill(0);
  excess_ = 0;
  const double variance = total > 0 ? byChance * (1 - byChance / total) : 0;
  if (!(variance > 0)) return;
  excess_ = (valid - byChance) / std::sqrt(variance);
  if (excess_ < kLeastExcess) return;
  // The pass as a whole gets no credit for what chance does half of the time; a kind with few readings leans on it.
  const double share = std::max(0.0, (valid - byChance - 0.5 * std::sqrt(variance)) / (total - byChance));
  for (std::size_t i = 0; i < total_.size(); ++i) {
    const double chance = (byChance_[i] + kPriorReadings * byChance / total) / (total_[i] + kPriorReadings);
    const double v = (valid_[i] + kPriorReadings * (chance + share * (1 - chance))) / (total_[i] + kPriorReadings);
    const double trueShare = std::max(0.0, (v - chance) / (1 - chance));
    purity_[i] = std::min(trueShare / v, kMaxPurity);
  }
}

}  // namespace quadmark
