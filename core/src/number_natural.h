// SPDX-License-Identifier: MIT
// Large unsigned integers on the stack, for numbers as text.
#pragma once

#include <cstdint>

namespace quadmark {

/// An unsigned integer of up to 4096 bits, enough for exact conversions between decimal and binary: parsing takes 781
/// digits or 10^1131, and these times 2^54; formatting takes 10^308 * 2^1076.
class Natural {
 public:
  explicit Natural(std::uint64_t value);
  Natural(const Natural& other);
  Natural& operator=(const Natural& other);

  void multiply(std::uint32_t factor, std::uint32_t plus = 0);
  void multiplyByPowerOfTen(int exponent);
  void shiftLeft(int bits);
  void add(const Natural& other);
  /// Requires *this >= other.
  void subtract(const Natural& other);

  [[nodiscard]] int bitLength() const;
  [[nodiscard]] int compare(const Natural& other) const;
  /// this + other compared with limit.
  [[nodiscard]] int compareSum(const Natural& other, const Natural& limit) const;

 private:
  std::uint32_t limbs_[128];  ///< of 32 bits, the lowest first; those from size_ on are not set
  int size_;
};

}  // namespace quadmark
