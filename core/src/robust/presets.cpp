// SPDX-License-Identifier: MIT
// Distortion and survival of each strength are in docs/robust.md.
#include "presets.h"

#include <algorithm>

#include "quadmark/trig.h"

namespace quadmark::robust {
namespace {

double cosineOf(double degrees) {
  return sinCosTurns(degrees / 360).cos;
}

// As edgeBends() measures it.
double bendOf(double degrees) {
  return 2 * sinCosTurns(degrees / 720).sin;
}

// What the whole mark may do at `standard`: vertex normals turn by half a degree; surfaces lie .006 % of the diagonal
// apart, on coarse meshes more, as these are farther from the smooth surface that they approximate: .01 % where there are
// about 10 000 vertices, and one part in as many as there are below.
constexpr double kMeanTurn = 0.0087, kSurfaceRms = 5.9e-5, kSurfaceRmsCoarse = 9.8e-5;
constexpr double kCoarse = 10000, kCoarseEnd = 12500;  // vertices

double surfaceRmsFor(double vertices) {
  if (vertices <= kCoarse) return kSurfaceRmsCoarse * kCoarse / vertices;
  const double fall = std::min(1.0, kCoarseEnd / vertices);
  return std::max(kSurfaceRms, kSurfaceRmsCoarse * fall * fall);
}

}  // namespace

Preset presetOf(Strength strength) {
  struct Row {
    double step, ringCrease, cellCrease, ofRoughness, ringTurn, gap, cellTurn, farQuota, mostFar, slackQuota, maxError,
        concealment, budget;
    std::uint32_t standing;
  };
  static constexpr Row kRows[] = {
      {0.5, 12, 35, 2.5, 5, 0.012, 4, 0.03, 6, 1, 2e-3, 1e-5, 0.5, 0},    // invisible
      {0.7, 25, 35, 5, 10, 0.05, 10, 0.075, 10, 2, 6e-3, 1e-5, 1, 8},     // standard
      {0.9, 35, 60, 5, 20, 0.1, 20, 0.135, 100, 1, 1.5e-2, 0, 1e9, 8},  // strong
  };
  const Row& row = kRows[static_cast<int>(strength)];
  Preset out;
  out.ringCrease = bendOf(row.ringCrease);
  out.cellCrease = bendOf(row.cellCrease);
  out.ofRoughness = row.ofRoughness;
  out.ring.turnCosine = cosineOf(row.ringTurn);
  out.diamond.mostGap = row.gap;
  out.diamond.turnCosine = cosineOf(row.cellTurn);
  out.diamond.farQuota = row.farQuota;
  out.diamond.mostFar = row.mostFar;
  out.slackQuota = row.slackQuota;
  out.mostStep = row.step;
  out.maxError = row.maxError;
  out.concealment = row.concealment;
  out.budget = row.budget;
  out.standing = row.standing;
  return out;
}

DistortionLimits limitsOf(const Preset& preset, std::uint32_t vertices, double diagonal) {
  const double rms = surfaceRmsFor(std::max(1u, vertices));
  return {preset.budget * kMeanTurn, preset.budget * rms * diagonal};
}

const char* strengthName(Strength strength) {
  return strength == Strength::invisible ? "invisible" : strength == Strength::standard ? "standard" : "strong";
}

Result<Strength> strengthFrom(std::string_view name) {
  for (const Strength strength : {Strength::invisible, Strength::standard, Strength::strong})
    if (name == strengthName(strength)) return strength;
  return Error{ErrorCode::badOption, "strength: expected \"invisible\", \"standard\" or \"strong\""};
}

}  // namespace quadmark::robust
