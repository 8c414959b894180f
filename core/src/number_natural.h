// SPDX-License-Identifier: MIT
// Large unsigned integers on the stack, for numbers as text.
#pragma once

#include <cstdint>

namespace quadmark {

/// An unsigned integer of up to kLimbs * 32 bits, just enough for exact conversions between decimal and binary.
template <int kLimbs>
class Natural {
 public:
  explicit Natural(std::uint64_t value) {
    limbs_[0] = static_cast<std::uint32_t>(value);
    limbs_[1] = static_cast<std::uint32_t>(value >> 32);
    size_ = limbs_[1] != 0 ? 2 : 1;
  }

  void multiply(std::uint32_t factor, std::uint32_t plus = 0) {
    std::uint64_t carry = plus;
    for (int i = 0; i < size_; ++i) {
      carry += std::uint64_t{limbs_[i]} * factor;
      limbs_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    if (carry != 0) limbs_[size_++] = static_cast<std::uint32_t>(carry);
  }

  void multiplyByPowerOfTen(int exponent) {
    for (; exponent >= 9; exponent -= 9) multiply(1000000000);
    for (; exponent > 0; --exponent) multiply(10);
  }

  void shiftLeft(int bits) {
    for (; bits >= 31; bits -= 31) multiply(std::uint32_t{1} << 31);
    if (bits > 0) multiply(std::uint32_t{1} << bits);
  }

  void add(const Natural& other) {
    std::uint64_t carry = 0;
    const int longest = size_ > other.size_ ? size_ : other.size_;
    for (int i = 0; i < longest; ++i) {
      carry += std::uint64_t{i < size_ ? limbs_[i] : 0} + (i < other.size_ ? other.limbs_[i] : 0);
      limbs_[i] = static_cast<std::uint32_t>(carry);
      carry >>= 32;
    }
    size_ = longest;
    if (carry != 0) limbs_[size_++] = static_cast<std::uint32_t>(carry);
  }

  /// Requires *this >= other.
  void subtract(const Natural& other) {
    std::int64_t borrow = 0;
    for (int i = 0; i < size_; ++i) {
      borrow += std::int64_t{limbs_[i]} - (i < other.size_ ? std::int64_t{other.limbs_[i]} : 0);
      limbs_[i] = static_cast<std::uint32_t>(borrow);
      borrow >>= 32;
    }
    while (size_ > 1 && limbs_[size_ - 1] == 0) --size_;
  }

  [[nodiscard]] int bitLength() const {
    int bits = 32 * (size_ - 1);
    for (std::uint32_t rest = limbs_[size_ - 1]; rest != 0; rest >>= 1) ++bits;
    return bits;
  }

  [[nodiscard]] int compare(const Natural& other) const {
    if (size_ != other.size_) return size_ < other.size_ ? -1 : 1;
    for (int i = size_ - 1; i >= 0; --i) {
      if (limbs_[i] != other.limbs_[i]) return limbs_[i] < other.limbs_[i] ? -1 : 1;
    }
    return 0;
  }

  /// this + other compared with limit.
  [[nodiscard]] int compareSum(const Natural& other, const Natural& limit) const {
    Natural sum = *this;
    sum.add(other);
    return sum.compare(limit);
  }

 private:
  std::uint32_t limbs_[kLimbs] = {};
  int size_;
};

}  // namespace quadmark
