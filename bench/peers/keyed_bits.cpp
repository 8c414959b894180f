// SPDX-License-Identifier: MIT
#include "keyed_bits.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "../schemes/secret.h"
#include "quadmark/random.h"

namespace quadmark::bench {
namespace {

Prf keyedBy(std::uint64_t key, std::string_view purpose, const char* use) {
  return {secretOf(key, "peer"), std::string(purpose) + use};
}

}  // namespace

KeyedBits::KeyedBits(std::uint64_t key, std::string_view purpose, std::size_t count) : order_(count), pad_(count) {
  const Prf padding = keyedBy(key, purpose, " pad");
  for (std::size_t i = 0; i < count; ++i) pad_[i] = static_cast<std::uint8_t>(padding(i) & 1);
  std::iota(order_.begin(), order_.end(), 0u);
  Random random(keyedBy(key, purpose, " order")(count));
  shuffle(order_, random);
}

void BitVotes::add(std::uint64_t carrier, double weight) {
  if (weight == 0) return;
  const std::size_t bit = bits_->bitAt(carrier);
  unanimous_ = unanimous_ && sums_[bit] * weight >= 0;
  sums_[bit] += weight;
  heard_[bit] = 1;
}

void BitVotes::add(const BitVotes& other) {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    unanimous_ = unanimous_ && other.unanimous_ && sums_[i] * other.sums_[i] >= 0;
    sums_[i] += other.sums_[i];
    heard_[i] |= other.heard_[i];
  }
}

double BitVotes::clearness() const {
  double sum = 0, right = 0, pilots = 0;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sum += std::abs(sums_[i]);
    if (i + kPilots < sums_.size()) continue;
    right += bits_->padded(i, 0) ? sums_[i] : -sums_[i];
    pilots += std::abs(sums_[i]);
  }
  return pilots > 0 ? sum * std::max(right / pilots, 0.0) : 0;
}

TrialReading BitVotes::reading(std::size_t count) const {
  TrialReading out;
  if (std::count(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(count), 1) == 0) return out;
  out.bits.assign(count, 0);
  out.unread.assign(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (heard_[i] == 0 || sums_[i] == 0) {
      out.unread[i] = 1;
    } else {
      out.bits[i] = bits_->padded(i, sums_[i] > 0 ? 1 : 0) ? 1 : 0;
    }
  }
  return out;
}

}  // namespace quadmark::bench
