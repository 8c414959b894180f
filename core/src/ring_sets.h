// SPDX-License-Identifier: MIT
// All triple products of one neighbourhood, from which the volume of each of its four-point sets takes three additions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "quadmark/cells.h"

namespace quadmark {

constexpr int choose2(int n) { return n * (n - 1) / 2; }
constexpr int choose3(int n) { return n * (n - 1) * (n - 2) / 6; }

/// Points relative to the seed (the origin) and the determinants of their triples, T(i,j,k) = p_i . (p_j x p_k).
/// Six times the volume of a set with the seed in it is such a product itself; that of (i,j,k,l) is
/// T(jkl) - T(ikl) + T(ijl) - T(ijk). So the 35 sets of a valence-6 neighbourhood cost 20 products and 45 additions
/// instead of 35 times two cross products, which is what makes a full enumeration affordable.
class RingSets {
 public:
  /// Loads the members.
  /// @param members   distinct; may contain the seed.
  /// @param withAreas  also compute normal2().
  void load(const std::vector<std::uint32_t>& members, std::uint32_t seed, const double* positions, bool withAreas) {
    const double* origin = positions + 3 * std::size_t{seed};
    seedIsMember_ = false;
    count_ = 0;
    radius2_ = 0;
    magnitude_ = std::max(std::fabs(origin[0]), std::max(std::fabs(origin[1]), std::fabs(origin[2])));
    for (std::uint32_t vertex : members) {
      if (vertex == seed) {
        seedIsMember_ = true;
        continue;
      }
      const double* p = positions + 3 * std::size_t{vertex};
      const double x = p[0] - origin[0], y = p[1] - origin[1], z = p[2] - origin[2];
      vertex_[count_] = vertex;
      x_[count_] = x, y_[count_] = y, z_[count_] = z;
      ++count_;
      radius2_ = std::max(radius2_, x * x + y * y + z * z);
      magnitude_ = std::max(magnitude_, std::max(std::fabs(p[0]), std::max(std::fabs(p[1]), std::fabs(p[2]))));
    }
    vertex_[kSeed] = seed;
    withCount(count_, [&](auto n) { multiply(n); });
    if (withAreas) computeAreas();
  }

  /// Index of the seed in visits; members count from 0.
  static constexpr int kSeed = static_cast<int>(std::max(kMaxMembersReading, kMaxMembersWriting));

  [[nodiscard]] std::uint32_t vertex(int index) const { return vertex_[index]; }

  /// Largest squared distance of a member from the seed.
  [[nodiscard]] double radius2() const { return radius2_; }

  /// Largest absolute coordinate of seed and members.
  [[nodiscard]] double magnitude() const { return magnitude_; }

  /// 4 area^2 of a triangle, i < j < k, where k may be kSeed. Needs load(..., withAreas = true).
  [[nodiscard]] double normal2(int i, int j, int k) const {
    return k == kSeed ? seedNormal2_[choose2(j) + i] : normal2_[choose3(k) + choose2(j) + i];
  }

  /// The largest 4 area^2 among the four triangles of a set i < j < k < l, l may be kSeed. The normals of two triangles
  /// add up to the product of the diagonals, so that product is at most twice the square root of this.
  [[nodiscard]] double largestNormal2(int i, int j, int k, int l) const {
    const int ij = choose2(j) + i, ik = choose2(k) + i, jk = choose2(k) + j;
    const double first = squaredSum(ij, jk, ik);
    if (l == kSeed) return std::max(first, std::max(squaredPair(ij), std::max(squaredPair(ik), squaredPair(jk))));
    const int il = choose2(l) + i, jl = choose2(l) + j, kl = choose2(l) + k;
    return std::max(std::max(first, squaredSum(ij, jl, il)), std::max(squaredSum(ik, kl, il), squaredSum(jk, kl, jl)));
  }

  /// Calls visit(i, j, k, l, determinant) for every set i < j < k < l with |determinant| <= limit; l may be kSeed.
  template <class Visit>
  void forEach(double limit, const Visit& visit) const {
    withCount(count_, [&](auto n) { enumerate(n, limit, visit); });
  }

 private:
  // Runs an algorithm with the number of points as a compile-time constant for the usual valences: its short triangular
  // loops then unroll, and unrolled they vectorise.
  template <class Algorithm>
  static void withCount(int count, const Algorithm& algorithm) {
    switch (count) {
      case 4: return algorithm(std::integral_constant<int, 4>{});
      case 5: return algorithm(std::integral_constant<int, 5>{});
      case 6: return algorithm(std::integral_constant<int, 6>{});
      case 7: return algorithm(std::integral_constant<int, 7>{});
      default: return algorithm(count);
    }
  }

  [[nodiscard]] double squaredPair(int ij) const { return cx_[ij] * cx_[ij] + cy_[ij] * cy_[ij] + cz_[ij] * cz_[ij]; }
  [[nodiscard]] double squaredSum(int ij, int jk, int ik) const {
    const double x = cx_[ij] + cx_[jk] - cx_[ik], y = cy_[ij] + cy_[jk] - cy_[ik], z = cz_[ij] + cz_[jk] - cz_[ik];
    return x * x + y * y + z * z;
  }

  template <class Count>
  void multiply(Count n) {
    for (int j = 1, ij = 0; j < n; ++j)
      for (int i = 0; i < j; ++i, ++ij) {
        cx_[ij] = y_[i] * z_[j] - z_[i] * y_[j];
        cy_[ij] = z_[i] * x_[j] - x_[i] * z_[j];
        cz_[ij] = x_[i] * y_[j] - y_[i] * x_[j];
      }
    for (int k = 2, ijk = 0; k < n; ++k) {
      const double x = x_[k], y = y_[k], z = z_[k];
      for (int ij = 0; ij < choose2(k); ++ij, ++ijk) triple_[ijk] = cx_[ij] * x + cy_[ij] * y + cz_[ij] * z;
    }
  }

  template <class Count, class Visit>
  void enumerate(Count n, double limit, const Visit& visit) const {
    if (seedIsMember_)
      for (int k = 2, ijk = 0; k < n; ++k)
        for (int j = 1; j < k; ++j)
          for (int i = 0; i < j; ++i, ++ijk)
            if (std::fabs(triple_[ijk]) <= limit) visit(i, j, k, kSeed, triple_[ijk]);
    for (int l = 3; l < n; ++l)
      for (int k = 2; k < l; ++k)
        for (int j = 1; j < k; ++j) {
          const double jkl = triple_[choose3(l) + choose2(k) + j];
          const double *ikl = &triple_[choose3(l) + choose2(k)], *ijl = &triple_[choose3(l) + choose2(j)],
                       *ijk = &triple_[choose3(k) + choose2(j)];
          for (int i = 0; i < j; ++i) {
            const double determinant = jkl - ikl[i] + ijl[i] - ijk[i];
            if (std::fabs(determinant) <= limit) visit(i, j, k, l, determinant);
          }
        }
  }

  void computeAreas() {
    for (int ij = 0; ij < choose2(count_); ++ij)
      seedNormal2_[ij] = cx_[ij] * cx_[ij] + cy_[ij] * cy_[ij] + cz_[ij] * cz_[ij];
    for (int k = 2, ijk = 0; k < count_; ++k)
      for (int j = 1, ij = 0; j < k; ++j)
        for (int i = 0; i < j; ++i, ++ij, ++ijk) {
          const int ik = choose2(k) + i, jk = choose2(k) + j;
          const double nx = cx_[ij] + cx_[jk] - cx_[ik], ny = cy_[ij] + cy_[jk] - cy_[ik],
                       nz = cz_[ij] + cz_[jk] - cz_[ik];
          normal2_[ijk] = nx * nx + ny * ny + nz * nz;
        }
  }

  int count_ = 0;
  bool seedIsMember_ = false;
  double radius2_ = 0, magnitude_ = 0;
  std::array<std::uint32_t, kSeed + 1> vertex_;
  std::array<double, kSeed> x_, y_, z_;
  std::array<double, choose2(kSeed)> cx_, cy_, cz_;
  std::array<double, choose3(kSeed)> triple_;
  std::array<double, choose2(kSeed)> seedNormal2_;
  std::array<double, choose3(kSeed)> normal2_;
};

/// Keeps the `limit` members nearest to the seed (D8), ties by position. Members keep no particular order.
void keepNearest(std::vector<std::uint32_t>& members, std::uint32_t seed, const double* positions, std::size_t limit);

}  // namespace quadmark
