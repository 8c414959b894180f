// SPDX-License-Identifier: MIT
#include "quadmark/digits.h"

#include <algorithm>

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
  const auto whole = static_cast<std::uint32_t>(scaled);  // at most 10^9; cheaper than floor() where SSE 4.1 is not assumed
  return {whole / codes_, whole % codes_, scaled - whole - 0.5};
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
  out.residue1 = static_cast<float>(first.residue);
  out.residue2 = static_cast<float>(second.residue);
  out.chance = static_cast<float>(chanceOf(first.code, second.code));
  if (r2 - r1 < coarserCell_) {
    out.state = ReadingState::ambiguousOrder;
  } else if (first.code >= pieces_) {
    out.state = ReadingState::badIndex;
  } else if (!fromOctalDigits(second.code, piece_.digitCount(), out.piece)) {
    out.state = ReadingState::badDigit;
  }
  return out;
}

double PairCodec::chanceOf(std::uint32_t indexCode, std::uint32_t pieceCode) const {
  // With a single digit there is nothing but the leading one; then it counts as uniform.
  const std::uint32_t range1 = index_.codeCount() / 10, range2 = piece_.codeCount() / 10;
  double chance = 1;
  if (range1 == 1) {
    chance = pieces_ / 10.0;
  } else {
    const std::uint32_t first = indexCode / range1 * range1;
    chance = first >= pieces_ ? 0 : std::min(1.0, static_cast<double>(pieces_ - first) / range1);
  }
  if (range2 == 1) return 0.8 * chance;
  if (pieceCode / range2 > 7) return 0;
  for (int digit = 1; digit < piece_.digitCount(); ++digit) chance *= 0.8;
  return chance;
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
