// SPDX-License-Identifier: MIT
// The self-check of patch(): which bytes of a file may differ afterwards.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bytes.h"

namespace quadmark::io {

/// A set of byte positions made of strided runs: the components that a patch may write.
class AllowedSpans {
 public:
  /// `count` runs of `width` bytes, `stride` apart. Runs that touch (stride == width) are one long run.
  void add(std::uint64_t begin, std::uint64_t stride, std::uint64_t width, std::uint64_t count);

  /// To be called once after the last add().
  void finish();

  [[nodiscard]] bool contains(std::uint64_t position) const;

 private:
  struct Run {
    std::uint64_t begin, end, stride, width;
    [[nodiscard]] bool contains(std::uint64_t position) const {
      // Asked for every changed byte, so the long runs are spared the division.
      return position >= begin && position < end && (stride == width || (position - begin) % stride < width);
    }
  };
  std::vector<Run> runs_;                  // by begin
  std::vector<std::uint64_t> largestEnd_;  // of runs 0..i
  mutable std::size_t recent_ = 0;         // differences cluster: the last hit is asked first
};

/// Counts the bytes that differ between two ranges of equal size.
/// @return the count, or `internal` naming the first difference outside `allowed`.
Result<std::uint64_t> countDifferences(Bytes before, Bytes after, const AllowedSpans& allowed);

/// Bytes that differ where a text was replaced by another of perhaps other length.
std::uint64_t countReplaced(std::string_view before, std::string_view after);

}  // namespace quadmark::io
