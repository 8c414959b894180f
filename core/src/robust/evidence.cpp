// SPDX-License-Identifier: MIT
#include "quadmark/robust/evidence.h"

#include <algorithm>
#include <array>

#include "quadmark/exact_math.h"

namespace quadmark::robust {
namespace {


// Log of the winnings of all bets at scale s: each is 1 + tanh(s |r| / 2) where the sign is right, 1 - that where wrong,
// which is twice the logistic function of s r.
double logWinnings(std::span<const float> ratios, std::span<const std::uint8_t> codeword, double s) {
  double sum = 0;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    const double x = std::clamp(s * (codeword[i] != 0 ? -double{ratios[i]} : double{ratios[i]}), -40.0, 40.0);
    sum += kLn2 - exactLog(1 + exactExp(-x));
  }
  return sum;
}

}  // namespace

double logChance(std::span<const float> ratios, std::span<const std::uint8_t> codeword) {
  Agreement signs;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    if (ratios[i] == 0) continue;
    ++signs.votes;
    signs.agreeing += (ratios[i] < 0) == (codeword[i] != 0) ? 1 : 0;
  }
  std::array<double, 3> winnings{};
  double scale = 1;
  for (double& value : winnings) {
    value = logWinnings(ratios, codeword, scale);
    scale /= 2;
  }
  const double top = *std::max_element(winnings.begin(), winnings.end());
  double mean = 0;
  for (double value : winnings) mean += exactExp(value - top) / 3;
  const double bet = -(top + exactLog(mean));
  return std::min(0.0, kLn2 + std::min(bet, logChance(signs)));
}

double logChance(const Agreement& agreement) { return logBinomialTail(agreement.votes, agreement.agreeing); }

float honestScale(std::span<const float> ratios, std::span<const std::uint8_t> codeword) {
  double best = 0;
  float bestScale = 1;
  for (const float scale : {1.0f, 0.5f, 0.25f, 0.125f}) {
    const double winnings = logWinnings(ratios, codeword, scale);
    if (scale == 1.0f || winnings > best) {
      best = winnings;
      bestScale = scale;
    }
  }
  return bestScale;
}

}  // namespace quadmark::robust
