// SPDX-License-Identifier: MIT
#include "principal_frame.h"

#include <Eigen/Eigenvalues>

namespace quadmark::bench {

Eigen::Matrix3d principalAxes(const std::vector<double>& positions) {
  const Eigen::Map<const Eigen::Matrix3Xd> points(positions.data(), 3, static_cast<Eigen::Index>(positions.size() / 3));
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Matrix3d spread = centred * centred.transpose();
  Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().rowwise().reverse().transpose();
  const Eigen::Vector3d skew = (axes * centred).array().cube().rowwise().sum();
  for (int i = 0; i < 3; ++i) {
    if (skew[i] < 0) axes.row(i) *= -1;
  }
  return axes;
}

}  // namespace quadmark::bench
