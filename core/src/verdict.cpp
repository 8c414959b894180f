// SPDX-License-Identifier: MIT
#include "quadmark/verdict.h"

#include <algorithm>
#include <array>

#include "quadmark/exact_math.h"

namespace quadmark {
namespace {

constexpr std::array<double, 4> kScales = {0.3, 0.6, 0.9, 0.99};
constexpr std::size_t kBetLevels = 64;

// log(1 + s q) and log(1 - s q) for quantised bets: a bit gets one addition per unit instead of a logarithm.
struct LogTable {
  std::array<std::array<double, kBetLevels + 1>, kScales.size()> plus, minus;
  LogTable() {
    for (std::size_t s = 0; s < kScales.size(); ++s)
      for (std::size_t level = 0; level <= kBetLevels; ++level) {
        const double q = kScales[s] * static_cast<double>(level) / kBetLevels;
        plus[s][level] = exactLog(1 + q);
        minus[s][level] = exactLog(1 - q);
      }
  }
};

const LogTable& logTable() {
  static const LogTable table;
  return table;
}

double logMeanExp(double a, double b) {
  const double top = std::max(a, b);
  return top + exactLog((1 + exactExp(std::min(a, b) - top)) / 2);
}

}  // namespace

const char* verdictName(Verdict verdict) {
  return verdict == Verdict::match ? "match" : verdict == Verdict::none ? "none" : "inconclusive";
}

double probabilityFromLog(double logProbability) {
  return logProbability >= 0 ? 1 : std::max(exactExp(std::max(logProbability, -690.7)), 1e-300);
}

AgreementTest::AgreementTest(std::uint32_t bits)
    : forOne_(kScales.size() * bits, 0), forZero_(forOne_), allAgree_(forOne_), allDiffer_(forOne_), bits_(bits) {}

void AgreementTest::add(std::uint32_t bit, int vote, double bet) {
  if (vote == 0) return;
  const auto level = static_cast<std::size_t>(std::clamp(bet, 0.0, 1.0) * kBetLevels);
  const LogTable& table = logTable();
  for (std::size_t s = 0; s < kScales.size(); ++s) {
    const std::size_t at = s * bits_ + bit;
    const double plus = table.plus[s][level], minus = table.minus[s][level];
    forOne_[at] += vote > 0 ? plus : minus;
    forZero_[at] += vote > 0 ? minus : plus;
    allAgree_[at] += plus;
    allDiffer_[at] += minus;
  }
}

double AgreementTest::bound(bool best) const {
  const std::vector<double>& agree = best ? allAgree_ : forOne_;
  const std::vector<double>& differ = best ? allDiffer_ : forZero_;
  std::array<double, kScales.size()> logEvidence{};
  for (std::size_t s = 0; s < kScales.size(); ++s)
    for (std::uint32_t bit = 0; bit < bits_; ++bit)
      logEvidence[s] += logMeanExp(agree[s * bits_ + bit], differ[s * bits_ + bit]);
  const double top = *std::max_element(logEvidence.begin(), logEvidence.end());
  double sum = 0;
  for (double value : logEvidence) sum += exactExp(value - top);
  return probabilityFromLog(-(top + exactLog(sum / static_cast<double>(kScales.size()))));
}

double AgreementTest::probability() const { return bound(false); }
double AgreementTest::bestProbability() const { return bound(true); }

double referenceProbability(std::uint64_t trials, std::uint64_t matches) {
  return probabilityFromLog(logBinomialTail(trials, matches));
}

}  // namespace quadmark
