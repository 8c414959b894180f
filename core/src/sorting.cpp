// SPDX-License-Identifier: MIT
#include "sorting.h"

#include <algorithm>

namespace quadmark {
namespace detail {
namespace {

class Sorter {
 public:
  explicit Sorter(const Sequence& sequence) : sequence_(sequence) {}

  /// @param depth  halvings left before the pivots count as bad ones.
  void quick(std::size_t begin, std::size_t end, int depth) const {
    constexpr std::size_t kShort = 12;
    while (end - begin > kShort) {
      if (depth-- == 0) return heap(begin, end);
      const std::size_t middle = partition(begin, end);
      if (middle - begin < end - middle) {
        quick(begin, middle, depth);
        begin = middle + 1;
      } else {
        quick(middle + 1, end, depth);
        end = middle;
      }
    }
    insertion(begin, end);
  }

 private:
  [[nodiscard]] bool isBefore(std::size_t i, std::size_t j) const { return sequence_.isBefore(sequence_, i, j); }
  void exchange(std::size_t i, std::size_t j) const { sequence_.exchange(sequence_, i, j); }

  /// Returns where the median of the first, the middle and the last item belongs, and puts it there: nothing before it
  /// comes later, nothing behind it earlier.
  [[nodiscard]] std::size_t partition(std::size_t begin, std::size_t end) const {
    const std::size_t middle = begin + (end - begin) / 2;
    if (isBefore(begin, middle)) exchange(begin, middle);    // the first is the later one of both
    if (isBefore(end - 1, begin)) {                          // and not the last of the three
      exchange(begin, isBefore(end - 1, middle) ? middle : end - 1);
    }
    std::size_t low = begin + 1, high = end - 1;
    for (;;) {
      while (low <= high && isBefore(low, begin)) ++low;
      while (low <= high && isBefore(begin, high)) --high;
      if (low >= high) break;
      exchange(low++, high--);
    }
    exchange(begin, high);
    return high;
  }

  void insertion(std::size_t begin, std::size_t end) const {
    for (std::size_t at = begin; at < end; ++at)
      for (std::size_t to = at; to > begin && isBefore(to, to - 1); --to) exchange(to, to - 1);
  }

  void heap(std::size_t begin, std::size_t end) const {
    const std::size_t count = end - begin;
    for (std::size_t root = count / 2; root-- > 0;) siftDown(begin, root, count);
    for (std::size_t last = count; --last > 0;) {
      exchange(begin, begin + last);
      siftDown(begin, 0, last);
    }
  }

  void siftDown(std::size_t begin, std::size_t root, std::size_t count) const {
    for (std::size_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
      if (child + 1 < count && isBefore(begin + child, begin + child + 1)) ++child;
      if (!isBefore(begin + root, begin + child)) return;
      exchange(begin + root, begin + child);
      root = child;
    }
  }

  const Sequence& sequence_;
};

}  // namespace

void sort(const Sequence& sequence, std::size_t count) {
  int depth = 0;
  for (std::size_t rest = count; rest > 1; rest /= 2) depth += 2;
  Sorter(sequence).quick(0, count, depth);
}

}  // namespace detail

void sortByKey(std::vector<KeyedIndex>& items) {
  std::sort(items.begin(), items.end(), [](const KeyedIndex& a, const KeyedIndex& b) {
    return a.key != b.key ? a.key < b.key : a.index < b.index;
  });
}

}  // namespace quadmark
