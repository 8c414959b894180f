// SPDX-License-Identifier: MIT
// log, exp and binomial tails from + - * / alone: libm's differ in the last bit between platforms, and a verdict must not.
#pragma once

#include <cstdint>

namespace quadmark {

inline constexpr double kLn2 = 0x1.62e42fefa39efp-1;  ///< log 2

/// Natural logarithm of a normal, positive number; relative error below 1e-14. About 15 ns.
[[nodiscard]] double exactLog(double x);

/// e^x, 0 below -700, capped at e^700; relative error below 1e-13. About 15 ns.
[[nodiscard]] double exactExp(double x);

/// log P(X >= matches) for X ~ Binomial(trials, 1/2). Cost: linear in trials.
[[nodiscard]] double logBinomialTail(std::uint64_t trials, std::uint64_t matches);

}  // namespace quadmark
