// SPDX-License-Identifier: MIT
// The demo's model: a trefoil knot of twisted strands, weathered and folded like carved coral.
#include <algorithm>

#include "mesh_tools.h"
#include "noise_field.h"
#include "quadmark/lab/generate.h"
#include "quadmark/trig.h"
#include "torus_surface.h"

namespace quadmark::lab {
namespace {

/// Tube around the knot that winds twice around the axis of a torus and three times around its core.
class Knot {
 public:
  /// @param spacing  mean edge length of the mesh: reliefs it could not resolve fade out.
  Knot(std::uint64_t seed, double spacing)
      : muscles_(Random::mix(seed)), folds_(Random::mix(seed + 1)), grain_(Random::mix(seed + 2)), spacing_(spacing) {}

  [[nodiscard]] Vec3 at(SurfacePoint point) const {
    const SinCos around = sinCosTurns(2 * point.u), through = sinCosTurns(3 * point.u);
    const double reach = kMajor + kMinor * through.cos;
    const Vec3 core{reach * around.cos, reach * around.sin, kMinor * through.sin};
    // The torus' own normal gives a frame that closes after one round.
    const Vec3 normal{through.cos * around.cos, through.cos * around.sin, through.sin};
    const Vec3 tangent =
        normalized({-3 * kMinor * through.sin * around.cos - 2 * reach * around.sin,
                    -3 * kMinor * through.sin * around.sin + 2 * reach * around.cos, 3 * kMinor * through.cos});
    const Vec3 binormal = cross(tangent, normal);
    const SinCos angle = sinCosTurns(point.v);
    const Vec3 outwards = angle.cos * normal - angle.sin * binormal;
    return core + radius(point, core, core + kTube * outwards) * outwards;
  }

  static constexpr double kLength = 30, kCircumference = 5;

 private:
  static constexpr double kMajor = 2.15, kMinor = 1.0, kTube = 0.65;

  /// 1 where a relief of this wavelength shows in the mesh, 0 where the mesh is too coarse for it.
  [[nodiscard]] double visible(double wavelength) const {
    return std::min(1.0, std::max(0.0, wavelength / spacing_ / 3 - 1));
  }

  [[nodiscard]] double radius(SurfacePoint point, const Vec3& core, const Vec3& skin) const {
    // 1. Swelling along the tube, as of muscles.
    const double swelling = 0.16 * muscles_.at(0.7 * core);
    // 2. Three strands twisted around each other, with a wandering phase; the grooves between them are sharp.
    const double phase = 3 * point.v - 20 * point.u + 0.6 * muscles_.at(0.9 * skin + Vec3{5, 9, 2});
    const double cosine = sinCosTurns(0.5 * phase).cos;  // |cos| has period 1 in phase
    const double back = std::sqrt(cosine * cosine + 0.01);
    const double strand = 0.30 * (back - 0.6);
    // 3. Meandering folds where a warped field passes zero, strongest on the strands' backs.
    const Vec3 warped = 2.2 * skin + 0.8 * folds_.vectorAt(1.3 * skin);
    const double field = folds_.at(warped);
    const double fold = 1 / (1 + 60 * field * field) - 0.4;
    const double folds = -0.05 * visible(0.35) * fold * back;
    // 4. Ribs across the strands, their phase bent by noise, and grain.
    const double rib = sinCosTurns(24 * point.u + 4 * point.v + 0.5 * folds_.at(1.5 * skin)).cos;
    const double ribs = 0.13 * visible(0.35) * back * (std::sqrt(rib * rib + 0.01) - 0.6);
    const double grain =
        0.02 * visible(0.25) * grain_.sum(4 * skin, 2) + 0.008 * visible(0.1) * grain_.sum(16 * skin, 2);
    return kTube + swelling + strand + folds + ribs + grain;
  }

  NoiseField muscles_, folds_, grain_;
  double spacing_;
};

}  // namespace

Mesh sculpture(std::size_t vertices, std::uint64_t seed) {
  const double count = static_cast<double>(std::max<std::size_t>(vertices, 500));
  const double spacing = std::sqrt(Knot::kLength * Knot::kCircumference / count);
  const auto rows = static_cast<std::uint32_t>(std::max(8.0, Knot::kCircumference / spacing + 0.5));
  const auto columns = static_cast<std::uint32_t>(count / rows + 0.5);
  const Knot knot(seed, spacing);
  Random random(Random::mix(seed + 3));
  TorusSurface surface(
      columns, rows, [&](SurfacePoint point) { return knot.at(point); }, random);
  surface.flipToDelaunay(6);
  for (double jitter : {0.3, 0.2, 0.1, 0.0}) {
    surface.relax(jitter, random);
    surface.flipToDelaunay(4);
  }
  Mesh mesh = surface.mesh();
  const Box box = boxOf(mesh.positions);
  const double scale = 2 / (box.high.y - box.low.y);
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    put(mesh.positions, v, scale * (at(mesh.positions, v) - box.centre()));
  roundToPrecision(mesh);
  return mesh;
}

}  // namespace quadmark::lab
