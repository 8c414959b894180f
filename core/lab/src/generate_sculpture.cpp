// SPDX-License-Identifier: MIT
// The demo's model: a trefoil knot of twisted strands, weathered and folded like carved coral.
#include <algorithm>

#include "mesh_tools.h"
#include "noise_field.h"
#include "quadmark/lab/generate.h"
#include "torus_surface.h"
#include "trig.h"

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
    const Vec3 tangent = normalized({-3 * kMinor * through.sin * around.cos - 2 * reach * around.sin,
                                     -3 * kMinor * through.sin * around.sin + 2 * reach * around.cos,
                                     3 * kMinor * through.cos});
    const Vec3 binormal = cross(tangent, normal);
    const SinCos angle = sinCosTurns(point.v);
    const Vec3 outwards = angle.cos * normal - angle.sin * binormal;
    return core + radius(point, core, core + kTube * outwards) * outwards;
  }

  static constexpr double kLength = 29, kCircumference = 4.4;

 private:
  static constexpr double kMajor = 2.05, kMinor = 1.0, kTube = 0.55;

  /// 1 where a relief of this wavelength shows in the mesh, 0 where the mesh is too coarse for it.
  [[nodiscard]] double visible(double wavelength) const {
    return std::min(1.0, std::max(0.0, wavelength / spacing_ / 3 - 1));
  }

  [[nodiscard]] double radius(SurfacePoint point, const Vec3& core, const Vec3& skin) const {
    // 1. Swelling along the tube, as of muscles.
    const double swelling = 0.10 * muscles_.at(0.8 * core);
    // 2. Three strands twisted around each other, with a wandering phase; the grooves between them are sharp.
    const double phase = 3 * point.v + 10 * point.u + 0.55 * muscles_.at(1.1 * skin + Vec3{5, 9, 2});
    const double cosine = sinCosTurns(0.5 * phase).cos;  // |cos| has period 1 in phase
    const double strand = 0.17 * (std::sqrt(cosine * cosine + 0.004) - 0.55);
    // 3. Meandering folds where a warped field passes zero, strongest on the strands' backs.
    const Vec3 warped = 3.1 * skin + 0.9 * folds_.vectorAt(1.7 * skin);
    const double field = folds_.sum(warped, 2);
    const double fold = 1 / (1 + 40 * field * field) - 0.35;
    const double folds = 0.052 * visible(0.3) * fold * (0.35 + 0.65 * cosine * cosine);
    // 4. Ripples across the strands and grain.
    const double ripples =
        0.012 * visible(0.16) * sinCosTurns(150 * point.u - 4 * point.v + 0.8 * folds_.at(2.3 * skin)).sin;
    const double grain = 0.014 * visible(0.14) * grain_.sum(9 * skin, 2);
    return kTube + swelling + strand + folds + ripples + grain;
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
  TorusSurface surface(columns, rows, [&](SurfacePoint point) { return knot.at(point); }, random);
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
