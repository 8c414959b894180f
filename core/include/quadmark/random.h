// SPDX-License-Identifier: MIT
// A small integer generator whose numbers are the same on every platform (std distributions and std::shuffle are not).
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadmark {

/// SplitMix64 (Steele, Lea, Flood 2014). Not cryptographic: keyed decisions belong to prf.h.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() { return mix(state_ += 0x9e3779b97f4a7c15u); }

  /// In [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

  /// In [low, high); high itself can appear by rounding.
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// In 0 .. n - 1, exactly uniform. @param n  >= 1.
  std::uint32_t below(std::uint32_t n) {
    // Lemire 2019: the high half of a 32 x 32 product, redrawn in the few cases that would favour small results.
    std::uint64_t product = (next() >> 32) * n;
    if (static_cast<std::uint32_t>(product) < n) {
      const std::uint32_t reject = (0u - n) % n;
      while (static_cast<std::uint32_t>(product) < reject) product = (next() >> 32) * n;
    }
    return static_cast<std::uint32_t>(product >> 32);
  }

  /// The finaliser alone, a bijection of 64-bit words: for hashing indices without a state.
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

/// Fisher-Yates. @param values  at most 2^32 - 1 elements.
template <class T>
void shuffle(std::vector<T>& values, Random& random) {
  for (std::size_t i = values.size(); i > 1; --i)
    std::swap(values[i - 1], values[random.below(static_cast<std::uint32_t>(i))]);
}

}  // namespace quadmark
