// SPDX-License-Identifier: MIT
// Little-endian bytes, one value after another, independent of the machine's own order.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

namespace quadmark::lab {

class ByteWriter {
 public:
  explicit ByteWriter(std::size_t expected) { bytes_.reserve(expected); }

  void byte(std::uint8_t value) { bytes_.push_back(value); }
  void uint32(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) byte(static_cast<std::uint8_t>(value >> shift));
  }
  void float32(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    uint32(bits);
  }
  void float64(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    uint32(static_cast<std::uint32_t>(bits));
    uint32(static_cast<std::uint32_t>(bits >> 32));
  }
  void text(std::string_view value) { bytes_.insert(bytes_.end(), value.begin(), value.end()); }

  [[nodiscard]] std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace quadmark::lab
