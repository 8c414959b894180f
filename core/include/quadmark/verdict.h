// SPDX-License-Identifier: MIT
// How likely a mark is read by chance: exact bounds under "this key has nothing to do with this model".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace quadmark {

enum class Verdict : std::uint8_t { match, none, inconclusive };

/// "match", "none" or "inconclusive".
[[nodiscard]] const char* verdictName(Verdict verdict);

/// A false-positive probability at or below this is a match.
inline constexpr double kMatchProbability = 1e-6;
/// Above kMatchProbability and up to this, the verdict is inconclusive.
inline constexpr double kDoubtProbability = 1e-4;

/// Evidence from copies of the same bit that agree.
///
/// Null hypothesis: the key is unrelated to the model. Then each unit (all cells with one index and one label) has had
/// its bits XORed with pad bits that are independent fair coins, whatever the geometry, marked or not. For one bit with
/// units of votes v = +-1 and bets 0 < q < 1 fixed by geometry alone, the value
///     E(bit) = (prod(1 + q v) + prod(1 - q v)) / 2
/// has expectation 1, and so has the product over all bits and the mean over several scales of q. By Markov's
/// inequality P(E >= 1 / p) <= p: 1 / E is a valid false-positive probability, with no approximation and no tuning to
/// any population of models. ("Testing by betting", Shafer 2021.)
///
/// Tried: chi-square of vote sums (its tail is wrong at 1e-6 for few, unequal copies); Chernoff bounds on pair agreement
/// (valid, but an order of magnitude weaker in the exponent at two copies per bit).
class AgreementTest {
 public:
  explicit AgreementTest(std::uint32_t bits);

  /// Adds one unit's vote on a bit.
  /// @param vote  +1, -1 or 0 (no vote).
  /// @param bet   purity of the unit, 0..1.
  void add(std::uint32_t bit, int vote, double bet);

  /// Upper bound on the probability of this much agreement under the null hypothesis; at least 1e-300.
  [[nodiscard]] double probability() const;
  /// The same if every vote had agreed: what the evidence could have shown at best.
  [[nodiscard]] double bestProbability() const;

 private:
  [[nodiscard]] double bound(bool best) const;
  std::vector<double> forOne_, forZero_, allAgree_, allDiffer_;  ///< log products per scale and bit
  std::uint32_t bits_;
};

/// Probability that at least `matches` of `trials` keyed-random bits equal a reference; at least 1e-300.
[[nodiscard]] double referenceProbability(std::uint64_t trials, std::uint64_t matches);

/// e^x for the logarithm of a probability, kept within [1e-300, 1].
[[nodiscard]] double probabilityFromLog(double logProbability);

}  // namespace quadmark
