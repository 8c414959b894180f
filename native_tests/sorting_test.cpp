// SPDX-License-Identifier: MIT
#include "sorting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace quadmark {
namespace {

/// Lists that lead quicksorts astray: random, sorted both ways, all equal, few values, organ pipe.
std::vector<std::vector<std::uint32_t>> lists(std::uint32_t count) {
  std::vector<std::vector<std::uint32_t>> out(6);
  std::uint32_t state = 1;
  for (std::uint32_t i = 0; i < count; ++i) {
    state = state * 1664525u + 1013904223u;
    out[0].push_back(state >> 8);
    out[1].push_back(i);
    out[2].push_back(count - i);
    out[3].push_back(7);
    out[4].push_back(state >> 30);
    out[5].push_back(std::min(i, count - i));
  }
  return out;
}

TEST(Sorting, GivesWhatStdSortGives) {
  for (const std::uint32_t count : {0u, 1u, 2u, 3u, 11u, 12u, 13u, 14u, 24u, 25u, 26u, 100u, 5000u})
    for (const std::vector<std::uint32_t>& list : lists(count)) {
      std::vector<std::uint32_t> expected = list, compact = list, shortOnes = list;
      std::sort(expected.begin(), expected.end());
      sortCompactly(compact.begin(), compact.end());
      sortShort(shortOnes.begin(), shortOnes.end());
      EXPECT_EQ(compact, expected) << count << " items";
      EXPECT_EQ(shortOnes, expected) << count << " items";
    }
}

TEST(Sorting, FollowsTheOrderThatItIsGiven) {
  struct Item {
    double weight;
    std::uint32_t number;
    bool operator==(const Item& other) const { return weight == other.weight && number == other.number; }
  };
  const auto heavierFirst = [](const Item& a, const Item& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.number < b.number;
  };
  for (const std::uint32_t count : {5u, 20u, 1000u})
    for (const std::vector<std::uint32_t>& list : lists(count)) {
      std::vector<Item> expected;
      for (const std::uint32_t value : list)
        expected.push_back({value / 3.0, static_cast<std::uint32_t>(expected.size())});
      std::vector<Item> compact = expected, shortOnes = expected;
      std::sort(expected.begin(), expected.end(), heavierFirst);
      sortCompactly(compact.begin(), compact.end(), heavierFirst);
      sortShort(shortOnes.begin(), shortOnes.end(), heavierFirst);
      EXPECT_EQ(compact, expected);
      EXPECT_EQ(shortOnes, expected);
    }
}

/// McIlroy's adversary (1999) decides the values while it is asked, so that every pivot is a bad one.
class Adversary {
 public:
  explicit Adversary(std::uint32_t count) : value_(count, count) {}

  bool isBefore(std::uint32_t a, std::uint32_t b) {
    ++comparisons;
    if (value_[a] == value_.size() && value_[b] == value_.size()) value_[a == candidate_ ? a : b] = solid_++;
    if (value_[a] == value_.size()) candidate_ = a;
    if (value_[b] == value_.size()) candidate_ = b;
    return value_[a] < value_[b];
  }
  [[nodiscard]] std::uint32_t value(std::uint32_t item) const { return value_[item]; }

  std::uint64_t comparisons = 0;

 private:
  std::vector<std::uint32_t> value_;
  std::uint32_t solid_ = 0, candidate_ = 0;
};

TEST(Sorting, NeedsFewComparisonsHoweverBadThePivots) {
  constexpr std::uint32_t kCount = 1 << 14;
  Adversary adversary(kCount);
  std::vector<std::uint32_t> items;
  for (std::uint32_t i = 0; i < kCount; ++i) items.push_back(i);
  sortCompactly(items.begin(), items.end(), [&](std::uint32_t a, std::uint32_t b) { return adversary.isBefore(a, b); });
  for (std::uint32_t i = 1; i < kCount; ++i) ASSERT_LE(adversary.value(items[i - 1]), adversary.value(items[i]));
  // 28 levels of pivots, then 2 * 14 of a heap; a quarter of n^2 would be 4096 n.
  EXPECT_LT(adversary.comparisons, 80u * kCount);
}

}  // namespace
}  // namespace quadmark
