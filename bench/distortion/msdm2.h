// SPDX-License-Identifier: MIT
#pragma once

#include "quadmark/mesh.h"

namespace quadmark::bench {

/// How visibly two surfaces differ: MSDM2, 0 (alike) .. 1, after G. Lavoue, "A multiscale metric for 3D mesh visual
/// quality assessment", Computer Graphics Forum 30(5), 2011. The meshes may have different connectivity.
///
/// Mean curvatures of corresponding windows are compared as images are by SSIM: their means (luminance), deviations
/// (contrast) and covariance (structure), weighted .4, .4, .2, in windows of 1, 1.5 and 2 % of the longest side of the
/// bounding box; differences in rough regions count less than in smooth ones. Local values are pooled with exponent 3
/// (Minkowski), from either surface to the other, and the two averaged.
///
/// The paper leaves constants open; those of its author's implementation (MEPP2's description of the filter) are taken:
/// curvatures, times the longest side, over a fifth of a window's radius; Gaussian weights of half a radius; constants
/// of 1 that keep quotients of flat regions finite. Not MSDM (Lavoue et al. 2006), whose limit of .20 the LIRIS
/// protocol states: that one has a single scale, no such constants, and other values. Neither mesh may be without
/// faces. Cost: some 50 microseconds per vertex and more where windows hold many.
[[nodiscard]] double msdm2(const Mesh& a, const Mesh& b);

}  // namespace quadmark::bench
