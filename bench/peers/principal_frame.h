// SPDX-License-Identifier: MIT
// A model's own axes, which follow it through rotation, shift, scaling and reflection.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace quadmark::bench {

/// The principal axes of the vertices as rows, longest first; each points to where the third moment is positive, so that a
/// mirrored model gets mirrored axes.
/// @param positions  3 per vertex, at least one.
[[nodiscard]] Eigen::Matrix3d principalAxes(const std::vector<double>& positions);

}  // namespace quadmark::bench
