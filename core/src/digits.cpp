// SPDX-License-Identifier: MIT
#include "quadmark/digits.h"

#include <algorithm>
#include <cmath>

namespace quadmark {
namespace {

std::uint32_t powerOfTen(int exponent) {
  std::uint32_t value = 1;
  while (exponent-- > 0) value *= 10;
  return value;
}

}  // namespace

DigitSlot::DigitSlot(int L, int H)
    : digits_(H - L + 1), codes_(powerOfTen(H - L + 1)), scale_(powerOfTen(H)), width_(1 / scale_),
      maxRatio_(0.5 - 0.25 / powerOfTen(L - 1)) {}

RatioDigits DigitSlot::read(double ratio) const {
  const double scaled = ratio * scale_;
  const double cell = std::floor(scaled);
  const auto whole = static_cast<std::uint64_t>(cell);
  return {static_cast<std::uint32_t>(whole / codes_), static_cast<std::uint32_t>(whole % codes_), scaled - cell - 0.5};
}

PairCodec::PairCodec(const PaperParams& params, std::uint32_t pieces)
    : index_(params.L1, params.H1), piece_(params.L2, params.H2), coarserCell_(std::max(index_.cellWidth(), piece_.cellWidth())),
      pieces_(pieces) {}

Reading PairCodec::read(double ratioA, double ratioB) const {
  Reading out;
  const double r1 = std::min(ratioA, ratioB), r2 = std::max(ratioA, ratioB);
  // One digit cell of slack: the embedder stays inside, rounding may step out a little.
  if (r1 < kMinRatio - index_.cellWidth() || r2 > piece_.maxRatio() + piece_.cellWidth() ||
      r1 > index_.maxRatio() + index_.cellWidth() || r1 < 0) {
    out.state = ReadingState::outOfRange;
    return out;
  }
  const RatioDigits first = index_.read(r1), second = piece_.read(r2);
  out.index = first.code;
  out.prefix1 = first.prefix;
  out.prefix2 = second.prefix;
  out.residue1 = first.residue;
  out.residue2 = second.residue;
  if (r2 - r1 < coarserCell_) {
    out.state = ReadingState::ambiguousOrder;
  } else if (first.code >= pieces_) {
    out.state = ReadingState::badIndex;
  } else if (!fromOctalDigits(second.code, piece_.digitCount(), out.piece)) {
    out.state = ReadingState::badDigit;
  }
  return out;
}

std::uint32_t octalDigits(std::uint32_t bits, int digits) {
  std::uint32_t decimal = 0, place = 1;
  for (int i = 0; i < digits; ++i, bits >>= 3, place *= 10) decimal += (bits & 7) * place;
  return decimal;
}

bool fromOctalDigits(std::uint32_t decimal, int digits, std::uint32_t& bits) {
  bits = 0;
  for (int i = 0; i < digits; ++i, decimal /= 10) {
    const std::uint32_t digit = decimal % 10;
    if (digit > 7) return false;
    bits |= digit << (3 * i);
  }
  return true;
}

}  // namespace quadmark
