// SPDX-License-Identifier: MIT
// Sine and cosine by + - * / alone: libm's differ between platforms in the last bit.
#pragma once

namespace quadmark {

struct SinCos {
  double sin = 0, cos = 1;
};

/// Of an angle in full turns, any finite value below 2^50. Error below 1e-15. About 10 ns.
[[nodiscard]] SinCos sinCosTurns(double turns);

inline SinCos sinCos(double radians) {
  return sinCosTurns(radians * 0.159154943091895335769);
}

}  // namespace quadmark
