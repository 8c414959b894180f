// SPDX-License-Identifier: MIT
#include "number_natural.h"

#include <algorithm>

namespace quadmark {

Natural::Natural(std::uint64_t value) {
  limbs_[0] = static_cast<std::uint32_t>(value);
  limbs_[1] = static_cast<std::uint32_t>(value >> 32);
  size_ = limbs_[1] != 0 ? 2 : 1;
}

Natural::Natural(const Natural& other) : size_(other.size_) {
  std::copy(other.limbs_, other.limbs_ + size_, limbs_);
}

Natural& Natural::operator=(const Natural& other) {
  size_ = other.size_;
  std::copy(other.limbs_, other.limbs_ + size_, limbs_);
  return *this;
}

void Natural::multiply(std::uint32_t factor, std::uint32_t plus) {
  std::uint64_t carry = plus;
  for (int i = 0; i < size_; ++i) {
    carry += std::uint64_t{limbs_[i]} * factor;
    limbs_[i] = static_cast<std::uint32_t>(carry);
    carry >>= 32;
  }
  if (carry != 0) limbs_[size_++] = static_cast<std::uint32_t>(carry);
}

void Natural::multiplyByPowerOfTen(int exponent) {
  for (; exponent >= 9; exponent -= 9) multiply(1000000000);
  for (; exponent > 0; --exponent) multiply(10);
}

void Natural::shiftLeft(int bits) {
  for (; bits >= 31; bits -= 31) multiply(std::uint32_t{1} << 31);
  if (bits > 0) multiply(std::uint32_t{1} << bits);
}

void Natural::add(const Natural& other) {
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

void Natural::subtract(const Natural& other) {
  std::int64_t borrow = 0;
  for (int i = 0; i < size_; ++i) {
    borrow += std::int64_t{limbs_[i]} - (i < other.size_ ? std::int64_t{other.limbs_[i]} : 0);
    limbs_[i] = static_cast<std::uint32_t>(borrow);
    borrow >>= 32;
  }
  while (size_ > 1 && limbs_[size_ - 1] == 0) --size_;
}

int Natural::bitLength() const {
  int bits = 32 * (size_ - 1);
  for (std::uint32_t rest = limbs_[size_ - 1]; rest != 0; rest >>= 1) ++bits;
  return bits;
}

int Natural::compare(const Natural& other) const {
  if (size_ != other.size_) return size_ < other.size_ ? -1 : 1;
  for (int i = size_ - 1; i >= 0; --i) {
    if (limbs_[i] != other.limbs_[i]) return limbs_[i] < other.limbs_[i] ? -1 : 1;
  }
  return 0;
}

int Natural::compareSum(const Natural& other, const Natural& limit) const {
  Natural sum = *this;
  sum.add(other);
  return sum.compare(limit);
}

}  // namespace quadmark
