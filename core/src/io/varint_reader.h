// SPDX-License-Identifier: MIT
// Bytes and variable-length integers, as compressed streams begin with or consist of them.
#pragma once

#include "bytes.h"

namespace quadmark::io {

/// Hands them out in order; once something is missing everything reads as 0.
class VarintReader {
 public:
  explicit VarintReader(Bytes bytes) : bytes_(bytes) {}

  std::uint8_t byte() {
    if (at_ == bytes_.size()) failed_ = true;
    return failed_ ? std::uint8_t{0} : bytes_[at_++];
  }

  /// Seven bits per byte, the lowest first, at most five bytes.
  std::uint32_t integer() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const std::uint32_t part = byte();
      value |= (part & 127) << shift;
      if (part < 128) break;
    }
    return value;
  }

  void skip(std::uint64_t count) {
    if (count > bytes_.size() - at_) failed_ = true;
    if (!failed_) at_ += static_cast<std::size_t>(count);
  }

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] bool isAtEnd() const { return !failed_ && at_ == bytes_.size(); }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

}  // namespace quadmark::io
