// SPDX-License-Identifier: MIT
// Sorting with little code. Each std::sort is a copy of 1 to 10 kB for its type and order, and 25 of them were a tenth
// of the wasm module; those that take no time worth speaking of share one here, and others sort by a key. A std::sort of
// its own is for what every vertex goes through.
//
// Orders must be total, or equal items exchangeable: neither these nor std::sort are stable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

namespace quadmark {

namespace detail {

/// Items that are only known by their numbers: how to compare two and how to exchange them.
struct Sequence {
  void* items;
  const void* order;
  bool (*isBefore)(const Sequence& self, std::size_t i, std::size_t j);
  void (*exchange)(const Sequence& self, std::size_t i, std::size_t j);
};

/// Introsort: never more than O(n log n) comparisons.
void sort(const Sequence& sequence, std::size_t count);

}  // namespace detail

/// Sorts what lies in one piece of memory, from `begin` to `end`. Takes one and a half to two times as long as std::sort on
/// long lists.
template <class Iterator, class Less = std::less<>>
void sortCompactly(Iterator begin, Iterator end, const Less& less = {}) {
  using Item = typename std::iterator_traits<Iterator>::value_type;
  if (end - begin < 2) return;
  const detail::Sequence sequence = {
      &*begin, &less,
      [](const detail::Sequence& self, std::size_t i, std::size_t j) {
        const Item* items = static_cast<const Item*>(self.items);
        return (*static_cast<const Less*>(self.order))(items[i], items[j]);
      },
      [](const detail::Sequence& self, std::size_t i, std::size_t j) {
        Item* items = static_cast<Item*>(self.items);
        std::swap(items[i], items[j]);
      }};
  detail::sort(sequence, static_cast<std::size_t>(end - begin));
}

/// The same for lists that are short nearly always, but may be long: the hub of a fan has a million neighbours. Faster
/// than std::sort on the short ones.
template <class Iterator, class Less = std::less<>>
void sortShort(Iterator begin, Iterator end, const Less& less = {}) {
  constexpr std::ptrdiff_t kShort = 24;
  if (end - begin > kShort) return sortCompactly(begin, end, less);
  for (Iterator at = begin; at != end; ++at) {
    const auto item = *at;
    Iterator to = at;
    for (; to != begin && less(item, to[-1]); --to) *to = to[-1];
    *to = item;
  }
}

/// A number to sort by, of something that has an index.
struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

/// Sorts by key, then by index; as fast as std::sort, in place.
void sortByKey(std::vector<KeyedIndex>& items);

}  // namespace quadmark
