// SPDX-License-Identifier: MIT
// Keys: the JSON key file, its parameters, and sub-keys per purpose.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "quadmark/result.h"

namespace quadmark {

enum class PayloadType : std::uint8_t { image, id };

/// Parameters of the `paper` scheme. They are part of the key: the scheme is semi-blind.
struct PaperParams {
  /// Decimal digit positions, counted from the point (1 = tenths), that carry the index (in the smaller ratio r1) and
  /// the piece (in the larger ratio r2). 2 <= L <= H <= 9.
  int L1 = 2, H1 = 3, L2 = 2, H2 = 3;
  double lambda = 1e-3;  ///< largest projection that construction may make, fraction of the bounding-box diagonal, (0, 0.1]
  double tau = 1e-3;     ///< largest deviation from a plane that the second decoding pass tolerates, fraction of the longer diagonal of the quadrilateral, [0, 0.1]
  int k = 1;             ///< neighbourhood radius in edges, 1..3
  PayloadType payload = PayloadType::image;
  std::uint32_t width = 0, height = 0;  ///< image size in pixels; a 64-bit ID is 64 x 1
  bool keyedCells = false;      ///< section 6.4: only cells picked by the key carry pieces
  bool scrambleOrder = false;   ///< section 6.4: embedding also permutes the vertex order (changes the file's layout)

  [[nodiscard]] std::uint32_t bitCount() const { return width * height; }
  bool operator==(const PaperParams&) const = default;
};

/// A secret and what it was made for.
struct Key {
  std::array<std::uint8_t, 32> secret{};
  std::string owner;  ///< free text, may be empty
  std::string scheme = "paper";  ///< "paper" or "robust"
  PaperParams params;            ///< of scheme "paper" alone
};

/// Parses a key file. Fails with badKey (not JSON, a member of the wrong type or range: names it; a scheme this
/// version does not have) or unsupportedVersion ("quadmark" above 1).
[[nodiscard]] Result<Key> parseKey(std::string_view json);

/// Writes a key file: pretty JSON with a final line break. parseKey() of it gives an equal key.
[[nodiscard]] std::string formatKey(const Key& key);

/// Checks ranges of every parameter; fails with badOption naming it.
[[nodiscard]] Status validate(const PaperParams& params);

/// Digit positions for a payload by the paper's Eq. (7): the smallest D with ceil(bits / 3D) <= 10^D, then
/// L1 = L2 = L and H1 = H2 = L + D - 1.
/// @param bits  payload length, >= 1.
/// @param L     first digit position, 2..8; 2 suits scans, 3 CAD models.
[[nodiscard]] Result<PaperParams> chooseDigits(std::uint32_t bits, int L = 2);

}  // namespace quadmark
