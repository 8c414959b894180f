// SPDX-License-Identifier: MIT
// The affine attacks of section 6.2.1 of the paper.
#include "quadmark/lab/attacks.h"
#include "quadmark/vec3.h"

namespace quadmark::lab {
namespace {

constexpr double kHalfRoot = 0.70710678118654752440;  // sin and cos of 45 degrees

constexpr Affine kScale{0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0};
constexpr Affine kNonUniformScale{0.5, 0, 0, 0, 0, 1.5, 0, 0, 0, 0, 2, 0};
constexpr Affine kReflection{-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
constexpr Affine kShear{1, 1.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
constexpr Affine kRotateX{1, 0, 0, 0, 0, kHalfRoot, -kHalfRoot, 0, 0, kHalfRoot, kHalfRoot, 0};
constexpr Affine kRotateY{kHalfRoot, 0, kHalfRoot, 0, 0, 1, 0, 0, -kHalfRoot, 0, kHalfRoot, 0};

/// First `inner`, then `outer`.
Affine compose(const Affine& outer, const Affine& inner) {
  Affine out{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = column == 3 ? outer[4 * row + 3] : 0.0;
      for (std::size_t i = 0; i < 3; ++i) sum += outer[4 * row + i] * inner[4 * i + column];
      out[4 * row + column] = sum;
    }
  return out;
}

}  // namespace

Mesh affine(const Mesh& mesh, const Affine& map) {
  Mesh out = mesh;
  for (std::size_t v = 0; v < out.vertexCount(); ++v) {
    const Vec3 p = at(mesh.positions, v);
    put(out.positions, v,
        {map[0] * p.x + map[1] * p.y + map[2] * p.z + map[3], map[4] * p.x + map[5] * p.y + map[6] * p.z + map[7],
         map[8] * p.x + map[9] * p.y + map[10] * p.z + map[11]});
  }
  roundToPrecision(out);
  return out;
}

Result<Affine> paperAffine(std::string_view name) {
  const Affine rotation = compose(kRotateY, kRotateX);
  if (name == "R") return rotation;
  if (name == "NS") return kNonUniformScale;
  if (name == "RE") return kReflection;
  if (name == "S") return kScale;
  if (name == "SH") return kShear;
  if (name == "CB") return compose(kShear, compose(kScale, compose(kReflection, compose(kNonUniformScale, rotation))));
  return Error{ErrorCode::badOption, "affine attack \"" + std::string(name) + "\" is not one of R, NS, RE, S, SH, CB"};
}

}  // namespace quadmark::lab
