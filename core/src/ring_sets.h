// SPDX-License-Identifier: MIT
// All triple products of one neighbourhood, from which the volume of each of its four-point sets takes three additions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "quadmark/cells.h"

namespace quadmark {

constexpr int choose2(int n) { return n * (n - 1) / 2; }
constexpr int choose3(int n) { return n * (n - 1) * (n - 2) / 6; }

/// Coordinates of up to kMaxMembersReading points relative to the seed, and the determinants of their triples.
/// With T(i,j,k) = p_i . (p_j x p_k), six times the volume of (i,j,k,l) is T(jkl) - T(ikl) + T(ijl) - T(ijk): the
/// C(n,4) sets share C(n,3) products, which is what makes a full enumeration affordable (35 sets from 35 products at
/// valence 6 instead of 35 times two cross products).
class RingSets {
 public:
  /// Loads the members and computes everything. `seed` gives the origin.
  void load(const std::vector<std::uint32_t>& members, std::uint32_t seed, const double* positions, bool withAreas) {
    count_ = static_cast<int>(members.size());
    const double* origin = positions + 3 * std::size_t{seed};
    for (int i = 0; i < count_; ++i) {
      const double* p = positions + 3 * std::size_t{members[i]};
      x_[i] = p[0] - origin[0], y_[i] = p[1] - origin[1], z_[i] = p[2] - origin[2];
    }
    for (int j = 1; j < count_; ++j)
      for (int i = 0; i < j; ++i) {
        const int at = pairIndex(i, j);
        cx_[at] = y_[i] * z_[j] - z_[i] * y_[j];
        cy_[at] = z_[i] * x_[j] - x_[i] * z_[j];
        cz_[at] = x_[i] * y_[j] - y_[i] * x_[j];
      }
    for (int k = 2; k < count_; ++k)
      for (int j = 1; j < k; ++j)
        for (int i = 0; i < j; ++i) {
          const int ij = pairIndex(i, j);
          triple_[tripleIndex(i, j, k)] = cx_[ij] * x_[k] + cy_[ij] * y_[k] + cz_[ij] * z_[k];
        }
    if (!withAreas) return;
    for (int k = 2; k < count_; ++k)
      for (int j = 1; j < k; ++j)
        for (int i = 0; i < j; ++i) {
          const int ij = pairIndex(i, j), ik = pairIndex(i, k), jk = pairIndex(j, k);
          const double nx = cx_[ij] + cx_[jk] - cx_[ik], ny = cy_[ij] + cy_[jk] - cy_[ik],
                       nz = cz_[ij] + cz_[jk] - cz_[ik];
          normal2_[tripleIndex(i, j, k)] = nx * nx + ny * ny + nz * nz;
        }
  }

  [[nodiscard]] int count() const { return count_; }

  /// Largest squared distance of a member from the seed.
  [[nodiscard]] double radius2() const {
    double best = 0;
    for (int i = 0; i < count_; ++i) best = std::max(best, x_[i] * x_[i] + y_[i] * y_[i] + z_[i] * z_[i]);
    return best;
  }

  /// 4 area^2 of the triangle of three members, i < j < k. Needs load(..., withAreas = true).
  [[nodiscard]] double normal2(int i, int j, int k) const { return normal2_[tripleIndex(i, j, k)]; }

  /// Calls visit(i, j, k, l, determinant) for every set i < j < k < l.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (int l = 3; l < count_; ++l)
      for (int k = 2; k < l; ++k)
        for (int j = 1; j < k; ++j) {
          const double jkl = triple_[tripleIndex(j, k, l)];
          const int kl = tripleIndex(0, k, l), jl = tripleIndex(0, j, l), jk = tripleIndex(0, j, k);
          for (int i = 0; i < j; ++i)
            visit(i, j, k, l, jkl - triple_[kl + i] + triple_[jl + i] - triple_[jk + i]);
        }
  }

 private:
  static constexpr int kMax = static_cast<int>(std::max(kMaxMembersReading, kMaxMembersWriting));
  static constexpr int pairIndex(int i, int j) { return choose2(j) + i; }
  static constexpr int tripleIndex(int i, int j, int k) { return choose3(k) + choose2(j) + i; }

  int count_ = 0;
  std::array<double, kMax> x_, y_, z_;
  std::array<double, choose2(kMax)> cx_, cy_, cz_;
  std::array<double, choose3(kMax)> triple_, normal2_;
};

/// Keeps the `limit` members nearest to the seed (D8), ties by position. Members keep no particular order.
void keepNearest(std::vector<std::uint32_t>& members, std::uint32_t seed, const double* positions, std::size_t limit);

}  // namespace quadmark
