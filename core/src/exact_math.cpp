// SPDX-License-Identifier: MIT
#include "quadmark/exact_math.h"

#include <cstring>

namespace quadmark {
namespace {
}

double exactLog(double x) {
  // x = m * 2^e with m in [sqrt(1/2), sqrt(2)), then log m = 2 atanh((m - 1) / (m + 1)).
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  int exponent = static_cast<int>(bits >> 52 & 0x7ff) - 1023;
  bits = (bits & 0x000fffffffffffffu) | 0x3ff0000000000000u;
  double mantissa;
  std::memcpy(&mantissa, &bits, sizeof mantissa);
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++exponent;
  }
  const double u = (mantissa - 1) / (mantissa + 1), u2 = u * u;
  double sum = 0;
  for (int n = 21; n >= 1; n -= 2) sum = sum * u2 + 1.0 / n;
  return exponent * kLn2 + 2 * u * sum;
}

double exactExp(double x) {
  if (x < -700) return 0;
  if (x > 700) x = 700;
  // x = k ln 2 + r with |r| <= ln 2 / 2, then the Taylor series.
  const double scaled = x / kLn2;
  const auto k = static_cast<int>(scaled < 0 ? scaled - 0.5 : scaled + 0.5);
  const double r = x - k * kLn2;
  double sum = 1;
  for (int n = 16; n >= 1; --n) sum = 1 + sum * r / n;
  const std::uint64_t bits = static_cast<std::uint64_t>(k + 1023) << 52;
  double power;
  std::memcpy(&power, &bits, sizeof power);
  return sum * power;
}

double logBinomialTail(std::uint64_t trials, std::uint64_t matches) {
  if (matches == 0) return 0;
  if (matches > trials) return -1e9;
  // log of C(n, matches) / 2^n as a running product that is renormalised before it can leave the range of a double.
  double logTerm = -static_cast<double>(trials) * kLn2, product = 1;
  const std::uint64_t shorter = matches < trials - matches ? matches : trials - matches;
  for (std::uint64_t i = 0; i < shorter; ++i) {
    product = product * static_cast<double>(trials - i) / static_cast<double>(i + 1);
    if (product > 1e250) {
      logTerm += exactLog(product);
      product = 1;
    }
  }
  logTerm += exactLog(product);
  double sum = 1, term = 1;  // in units of the first term
  for (std::uint64_t k = matches; k < trials; ++k) {
    term = term * static_cast<double>(trials - k) / static_cast<double>(k + 1);
    sum += term;
    if (term < sum * 1e-17) break;
    if (sum > 1e250) {
      logTerm += exactLog(sum);
      term /= sum;
      sum = 1;
    }
  }
  const double result = logTerm + exactLog(sum);
  return result > 0 ? 0 : result;
}

}  // namespace quadmark
