// SPDX-License-Identifier: MIT
// Distortion and error measures. Definitions are part of the API: every figure the project prints comes from here.
#pragma once

#include <cstdint>
#include <span>

#include "quadmark/adjacency.h"
#include "quadmark/mesh.h"

namespace quadmark {

/// Distances as fractions of the original's bounding-box diagonal ("Rel"), angles in degrees.
/// Normals are taken per welded vertex of the original (so that a seam does not count twice); vertices whose normal
/// vanishes on either side are left out. log10 and atan2 are not bit-equal between platforms: nothing decides by these.
struct Distortion {
  /// 10 log10( sum |v - c|^2 / sum |v - v'|^2 ) over the vertices that faces use, twins counted once each as stored,
  /// c = their mean. Infinity when nothing moved.
  double snrDb = 0;
  double rmsRel = 0;        ///< root mean square vertex displacement
  double maxRel = 0;        ///< largest vertex displacement
  double hausdorffRel = 0;  ///< two-sided, sampled: see hausdorffLocal()
  /// 20 log10( pi / rms angle between corresponding vertex normals (area weighted, radians) ). Infinity when equal.
  double normalPsnrDb = 0;
  double meanNormalDeg = 0;  ///< mean angle between corresponding vertex normals
};

/// Compares two meshes with the same connectivity and vertex order; only the positions of `marked` are used. A mesh
/// without faces gives zeros and infinite ratios. Cost: linear, about 1 microsecond per vertex.
[[nodiscard]] Distortion distortion(const Mesh& original, const Mesh& marked);

/// The same without a second copy of the connectivity.
/// @param marked    3 per vertex of `original`.
/// @param welding   of `original`, in any numbering.
/// @param diagonal  boundingDiagonal(original).
[[nodiscard]] Distortion distortion(const Mesh& original, const std::vector<double>& marked, const Welding& welding,
                                    double diagonal);

/// Two-sided Hausdorff distance in file units, in the manner of Metro (Cignoni et al. 1998) for meshes with the same
/// connectivity: every vertex, edge midpoint and triangle centre (polygons are fanned) of one surface against the faces
/// around the corresponding place (one ring) of the other. An upper bound of the distance for those samples. Cost:
/// linear.
[[nodiscard]] double hausdorffLocal(const Mesh& a, const Mesh& b);

/// Two-sided Hausdorff distance between any two meshes, file units, by a tree of boxes over the triangles (polygons are
/// fanned); `samplesPerFace` (>= 0) deterministic points per triangle plus all used vertices. Infinite when one mesh
/// alone has no faces. Cost: n log n.
[[nodiscard]] double hausdorff(const Mesh& a, const Mesh& b, int samplesPerFace = 4);

/// Bit error rate: (wrong + erased / 2) / all. `erased` empty or per bit (nonzero: not read). Any nonzero bit counts as
/// 1. Sizes must agree; 0 for no bits.
[[nodiscard]] double bitErrorRate(std::span<const std::uint8_t> expected, std::span<const std::uint8_t> read,
                                  std::span<const std::uint8_t> erased = {});

}  // namespace quadmark
