// SPDX-License-Identifier: MIT
// Carriers of layer A: which vertices carry, and the affine-covariant frame of each one's ring.
#pragma once

#include <cstdint>
#include <vector>

#include "labels.h"
#include "quadmark/prf.h"
#include "surface.h"

namespace quadmark::robust {

struct Carriers {
  std::vector<std::uint32_t> vertex;       ///< welded vertex per carrier, no two of them neighbours
  std::vector<std::uint64_t> label;        ///< per carrier
  std::vector<std::uint8_t> bits;          ///< coded bits per coordinate, per carrier; one number per label
  std::vector<std::uint32_t> ringOffsets;  ///< carriers + 1
  std::vector<std::uint32_t> rings;        ///< each one's ring in canonical order

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(vertex.size()); }
  [[nodiscard]] std::span<const std::uint32_t> ring(std::uint32_t carrier) const {
    return {rings.data() + ringOffsets[carrier], ringOffsets[carrier + 1] - ringOffsets[carrier]};
  }
};

/// The vertices whose ring has a unique canonical order and whose keyed rank is above that of every ring neighbour.
/// Depends on connectivity and key alone. In the order of vertices.
[[nodiscard]] Carriers selectCarriers(const Surface& surface, const Prf& select);

/// Affine-covariant frame of a ring in canonical order.
struct RingFrame {
  Vec3 origin, e1, e2, e3;
  double radius = 0;  ///< sqrt |e1 x e2|, file units
};

/// Coordinates of a point in a frame; unchanged when points and frame undergo one affine map.
struct RingCoordinates {
  double alpha = 0, beta = 0, gamma = 0;
};

/// First Fourier coefficients of the ring as the first two axes, edge tensor times their cross product as the third.
/// @return false where the ring is degenerate (a line, or an axis in its plane).
[[nodiscard]] bool ringFrame(const std::vector<double>& positions, std::span<const std::uint32_t> ring,
                             const SymmetricTensor& tensor, RingFrame& frame);
[[nodiscard]] RingCoordinates coordinatesIn(const RingFrame& frame, const Vec3& point);
[[nodiscard]] Vec3 pointAt(const RingFrame& frame, const RingCoordinates& coordinates);

}  // namespace quadmark::robust
