// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quadmark/lab/attacks.h"

namespace quadmark::bench {

/// Attacks one after the other, as results spell them: steps `kind:amount[:variant[:iterations]]` joined by '+', such as
/// "simplify:0.1+quantize:14" or "smooth:0.03:laplacian:10"; an amount that does not count is left empty ("affine::CB"),
/// nothing behind it is needed ("reorder"). Kinds are those of lab/attacks.h, where the amount of `reorder` tells one order
/// from another, and
///   none         the mesh as it is, with no other step
///   liris-noise  uniform noise in [-amount, amount] * mean distance of the used vertices to their centre (the LIRIS
///                benchmark's unit; that of `noise` is the diagonal)
///   digits       coordinates as text of `amount` significant decimal digits (1..17)
///   subdivide    each face split at its edges' middles, `amount` times (1..3): polygons of n corners into n quads,
///                triangles into four triangles
struct AttackChain {
  std::string text;
  std::vector<lab::AttackSpec> steps;  ///< empty for "none"
};

/// Fails with badOption, naming the step. Amounts are checked where they are applied.
[[nodiscard]] Result<AttackChain> parseAttacks(const std::string& text);

/// @param seed  of everything random in it; each step draws its own numbers from it.
/// Fails as lab::attack().
[[nodiscard]] Result<Mesh> apply(const AttackChain& chain, const Mesh& mesh, std::uint64_t seed);

}  // namespace quadmark::bench
