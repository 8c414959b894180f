// SPDX-License-Identifier: MIT
// How likely ratios agree with a codeword by chance: exact bounds, for the robust scheme's verdicts.
//
// Null hypothesis: the key has nothing to do with the model, or carries a payload other than the one asked for. Then the
// signs of the log-likelihood ratios of coded bits are independent fair coins, given their magnitudes: in layer A a
// vote's sign is its label's keyed pad and dither, in layer B renaming the symbols of a group by any mask is as likely a
// key as not renaming them, and a mask turns the signs of the group's bits one by one. Sums over labels, groups and
// layers keep that. So what follows holds for every model, without tuning.
#pragma once

#include <cstdint>
#include <span>

#include "quadmark/robust/coded.h"

namespace quadmark::robust {

/// log of a bound on the probability that ratios with coin-flip signs agree with one given codeword as well as these.
/// The better of two tests, counted double: the exact binomial tail of the signs, and a bet of tanh(s |ratio| / 2) on
/// each sign, whose winnings have mean 1 (s = 1/4, 1/2, 1, averaged; see verdict.h for the argument).
/// @param ratios    positive where 0 is likelier; zeros do not count.
/// @param codeword  as many bits.
/// @return at most 0. Cost: 0.2 microseconds per ratio.
[[nodiscard]] double logChance(std::span<const float> ratios, std::span<const std::uint8_t> codeword);

/// log of the exact binomial tail of votes on an expected payload.
[[nodiscard]] double logChance(const Agreement& agreement);

/// The scale s out of 1/8, 1/4, 1/2, 1 under which ratios predict best how they agree with a codeword that is known to
/// be right: the factor that makes other ratios of the same kind honest.
[[nodiscard]] float honestScale(std::span<const float> ratios, std::span<const std::uint8_t> codeword);

}  // namespace quadmark::robust
