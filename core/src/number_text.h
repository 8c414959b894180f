// SPDX-License-Identifier: MIT
// Decimal text to binary floating point and back: exact, free of locales, the same digits on every platform.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace quadmark {

/// The value nearest to a decimal number (ties to even); values beyond the largest become infinite. `text` is the
/// number and nothing else. The usual spellings of NaN and infinity are read as such. Nothing for any other text.
std::optional<float> parseFloat(std::string_view text);
std::optional<double> parseDouble(std::string_view text);

/// A decimal integer with optional sign; nothing for other text or outside 64 bits.
std::optional<std::int64_t> parseInteger(std::string_view text);

/// The value of a hexadecimal digit, or -1.
inline int hexDigit(char character) {
  if (character >= '0' && character <= '9') return character - '0';
  if (character >= 'a' && character <= 'f') return character - 'a' + 10;
  if (character >= 'A' && character <= 'F') return character - 'A' + 10;
  return -1;
}

/// The shortest decimal that parses back to the same value and, of those, the nearest to it; plain notation between
/// 1e-5 and 1e16, otherwise like "1.5e-7". Valid JSON. The value must be finite.
///
/// Own digits (Steele and White 1990 with exact integers) because std::to_chars is missing in Emscripten's libc++ 13,
/// and marked files must not depend on the platform. printf with growing precision is not the same: at powers of two it
/// misses some of the shortest.
std::string formatShortest(float value);
std::string formatShortest(double value);

}  // namespace quadmark
