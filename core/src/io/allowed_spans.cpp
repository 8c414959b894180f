// SPDX-License-Identifier: MIT
#include "allowed_spans.h"

#include <algorithm>

#include "concat.h"
#include "sorting.h"

namespace quadmark::io {

void AllowedSpans::add(std::uint64_t begin, std::uint64_t stride, std::uint64_t width, std::uint64_t count) {
  if (count == 0) return;
  const std::uint64_t end = begin + stride * (count - 1) + width;
  if (stride == width || count == 1) stride = width = end - begin;
  runs_.push_back(Run{begin, end, stride, width});
}

void AllowedSpans::finish() {
  std::vector<KeyedIndex> byPlace;
  for (const Run& run : runs_) byPlace.push_back({run.begin, static_cast<std::uint32_t>(byPlace.size())});
  sortByKey(byPlace);
  std::vector<Run> sorted;
  for (const KeyedIndex& entry : byPlace) sorted.push_back(runs_[entry.index]);
  runs_ = std::move(sorted);
  largestEnd_.clear();
  std::uint64_t largest = 0;
  for (const Run& run : runs_) {
    largest = std::max(largest, run.end);
    largestEnd_.push_back(largest);
  }
}

bool AllowedSpans::contains(std::uint64_t position) const {
  if (recent_ < runs_.size() && runs_[recent_].contains(position)) return true;
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), position,
                                      [](std::uint64_t at, const Run& run) { return at < run.begin; });
  for (auto i = static_cast<std::size_t>(after - runs_.begin()); i-- > 0 && largestEnd_[i] > position;) {
    if (runs_[i].contains(position)) {
      recent_ = i;
      return true;
    }
  }
  return false;
}

Result<std::uint64_t> countDifferences(Bytes before, Bytes after, const AllowedSpans& allowed) {
  if (before.size() != after.size()) {
    return Error{ErrorCode::internal, "self-check: the size of a binary part changed"};
  }
  constexpr std::size_t kBlock = 64;
  std::uint64_t count = 0;
  for (std::size_t begin = 0; begin < before.size(); begin += kBlock) {
    const std::size_t length = std::min(kBlock, before.size() - begin);
    if (std::memcmp(&before[begin], &after[begin], length) == 0) continue;
    for (std::size_t at = begin; at < begin + length; ++at) {
      if (before[at] == after[at]) continue;
      if (!allowed.contains(at)) {
        return Error{ErrorCode::internal, concat("self-check: byte ", at, " changed but holds no position")};
      }
      ++count;
    }
  }
  return count;
}

std::uint64_t countReplaced(std::string_view before, std::string_view after) {
  const std::size_t common = std::min(before.size(), after.size());
  std::uint64_t count = std::max(before.size(), after.size()) - common;
  for (std::size_t i = 0; i < common; ++i) count += before[i] != after[i] ? 1 : 0;
  return count;
}

}  // namespace quadmark::io
