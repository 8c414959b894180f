// SPDX-License-Identifier: MIT
// What a mark does to a surface, as sums over vertices, and which of its parts to give up when that is too much.
#pragma once

#include <cstdint>
#include <vector>

#include "surface.h"

namespace quadmark::robust {

/// Means over all vertices that a mark may not exceed.
struct DistortionLimits {
  double turn = 1e300;        ///< of vertex normals, as the distance of unit vectors (radians, for small ones)
  double surfaceRms = 1e300;  ///< distance between the surfaces, file units
};

/// The two means for one set of positions after another, with each vertex's share in them.
class ChangeMeter {
 public:
  /// @param surface      before embedding; kept by reference, like the faces around its vertices.
  ChangeMeter(const Surface& surface, const FacesAround& facesAround);

  /// @param positions  welded, after embedding. Cost: some 0.3 microseconds per vertex.
  void measure(const std::vector<double>& positions);

  /// Unit normal of a vertex before embedding; zero where its faces have no area.
  [[nodiscard]] const Vec3& normal(std::uint32_t vertex) const { return normals_[vertex]; }
  /// Sums over all vertices; a limit times the number of vertices is to be compared with them.
  [[nodiscard]] double turns() const { return turns_; }
  [[nodiscard]] double squares() const { return squares_; }
  /// What a moved vertex has caused: its share of the turns around it, by squared displacement; the squared distance of
  /// its old and new place from the other surface, mean of both.
  [[nodiscard]] double turnOf(std::uint32_t vertex) const { return turnOf_[vertex]; }
  [[nodiscard]] double squareOf(std::uint32_t vertex) const { return squareOf_[vertex]; }

 private:
  const Surface& surface_;
  const FacesAround& facesAround_;
  std::vector<Vec3> normals_;  // before
  double turns_ = 0, squares_ = 0;
  std::vector<float> turnOf_, squareOf_;
};

/// A carrier or a cell as the budget sees it.
struct Expense {
  double turn = 0, square = 0;
  double votes = 1;  ///< coded bits it speaks for
};

/// The expenses to give up so that both sums stay below their limits: those that cost most per vote, whichever layer
/// they are of, since that leaves the most votes. Ties by number, ascending.
/// @return one flag per expense.
[[nodiscard]] std::vector<std::uint8_t> expensesToDrop(const std::vector<Expense>& expenses, double turnLimit,
                                                       double squareLimit);

}  // namespace quadmark::robust
