// SPDX-License-Identifier: MIT
// Digits L..H of a diagonal ratio: writing a code into them and reading it back (section 4.2 of the paper; D10-D14).
#pragma once

#include <cstdint>

#include "quadmark/key.h"

namespace quadmark {

/// The smallest ratio the embedder writes: nearer to an end of its diagonal, a quadrilateral degenerates.
inline constexpr double kMinRatio = 0.02;

/// What stands in one ratio. r = prefix . code, read at digit H, e.g. L = 2, H = 4: 0.2 137 -> prefix 2, code 137.
struct RatioDigits {
  std::uint32_t prefix = 0;  ///< digits before L as an integer, 0 .. 10^(L-1) - 1
  std::uint32_t code = 0;    ///< digits L..H as an integer, 0 .. 10^(H-L+1) - 1
  double residue = 0;        ///< distance from the centre of the digit cell in units of 10^-H, [-0.5, 0.5)
};

/// The digit positions of one ratio, L..H.
class DigitSlot {
 public:
  /// @param L, H  2 <= L <= H <= 9.
  DigitSlot(int L, int H);

  [[nodiscard]] std::uint32_t codeCount() const { return codes_; }
  [[nodiscard]] int digitCount() const { return digits_; }
  [[nodiscard]] double cellWidth() const { return width_; }  ///< 10^-H

  /// @param ratio  0 <= ratio < 1.
  [[nodiscard]] RatioDigits read(double ratio) const;

  /// The centre of the digit cell (D10): never an edge, which the first rounding error would cross.
  [[nodiscard]] double centre(std::uint32_t prefix, std::uint32_t code) const {
    return (static_cast<double>(prefix) * codes_ + code + 0.5) * width_;
  }

  /// Largest ratio that is ever written, 0.5 - 10^-(L-1) / 4 (D12): beyond it a little noise would exchange the near
  /// and the far end.
  [[nodiscard]] double maxRatio() const { return maxRatio_; }

 private:
  int digits_;
  std::uint32_t codes_;
  double scale_, width_, maxRatio_;
};

/// Why a cell could not be read; anything but `ok` is a detected erasure, never a vote.
enum class ReadingState : std::uint8_t { ok, ambiguousOrder, outOfRange, badIndex, badDigit };

/// One cell as read.
struct Reading {
  ReadingState state = ReadingState::ok;
  std::uint32_t index = 0;                ///< piece index
  std::uint32_t piece = 0;                ///< 3 (H2 - L2 + 1) bits, as written (still padded by the key)
  std::uint32_t prefix1 = 0, prefix2 = 0; ///< prefixes of r1 and r2: the cell's label
  float residue1 = 0, residue2 = 0;       ///< see RatioDigits
  /// Probability that a chance reading with the same leading digits is valid. Leading digits follow the shapes of a
  /// model's neighbourhoods, the others are uniform: this is what a share of valid readings has to be compared with.
  float chance = 0;
};

class PairCodec {
 public:
  /// @param pieces  number of pieces, >= 1; indices from it upwards are detected erasures (D14).
  PairCodec(const PaperParams& params, std::uint32_t pieces);

  [[nodiscard]] const DigitSlot& indexSlot() const { return index_; }
  [[nodiscard]] const DigitSlot& pieceSlot() const { return piece_; }
  [[nodiscard]] int bitsPerPiece() const { return 3 * piece_.digitCount(); }
  [[nodiscard]] std::uint32_t pieces() const { return pieces_; }

  /// Reads both ratios of a cell, given in any order, each already measured from its nearer end.
  [[nodiscard]] Reading read(double ratioA, double ratioB) const;

  /// Is the index's ratio smaller than the piece's by enough (two digit cells) that rounding cannot exchange them? The
  /// decoder tells the two apart by size alone, as in Eq. (2), so equal prefixes are legal while the codes keep the
  /// order (D11). Tried: the paper's rule of distinct prefixes. Most natural ratios lie between 0.4 and 0.5, so at L = 2
  /// it forces one of two neighbours out by a whole prefix: 3.5 to 4 dB of SNR on seven models, for nothing the decoder
  /// could notice.
  [[nodiscard]] bool ordered(double ratio1, double ratio2) const { return ratio2 - ratio1 >= leastApart(); }
  [[nodiscard]] double leastApart() const { return 2 * coarserCell_; }

 private:
  [[nodiscard]] double chanceOf(std::uint32_t indexCode, std::uint32_t pieceCode) const;

  DigitSlot index_, piece_;
  double coarserCell_;
  std::uint32_t pieces_;
};

/// Octal digits of `bits` written in decimal: 0b111'000'101 -> 705. `digits` octal digits.
[[nodiscard]] std::uint32_t octalDigits(std::uint32_t bits, int digits);
/// The inverse; false when a decimal digit is 8 or 9 (D14).
[[nodiscard]] bool fromOctalDigits(std::uint32_t decimal, int digits, std::uint32_t& bits);

}  // namespace quadmark
