// SPDX-License-Identifier: MIT
// What each strength may spend.
#pragma once

#include "distortion_budget.h"
#include "embed_diamonds.h"
#include "embed_rings.h"
#include "quadmark/robust/embedder.h"

namespace quadmark::robust {

struct Preset {
  RingLimits ring;
  DiamondLimits diamond;
  double ringCrease, cellCrease;  ///< bends of edges beyond which carriers and cells are left alone, on smooth surfaces
  double ofRoughness;             ///< how much more on rough ones (creaseBend())
  double mostStep;                ///< of layer A's lattice, ring radii
  double maxError;                ///< of the diagonal
  double concealment;             ///< jitter of cells that were not flat, of the diagonal
  double budget;                  ///< of the mean distortion that `standard` may cause
  double slackQuota;              ///< factor on the quota of far candidates where little of the budget is used
  std::uint32_t standing;         ///< times good cells: raise cells until so many stand, at such slack or without a budget; 0 = none
};

[[nodiscard]] Preset presetOf(Strength strength);

/// What a mark may do to a mesh on average.
[[nodiscard]] DistortionLimits limitsOf(const Preset& preset, std::uint32_t vertices, double diagonal);

}  // namespace quadmark::robust
