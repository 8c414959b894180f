// SPDX-License-Identifier: MIT
// What a mark withstands, found by damaging the marked mesh and reading it again.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/robust/frame.h"

namespace quadmark::robust {

struct Ground;

struct SelfTest {
  std::string name;          ///< "quantize14", "quantize11", "noise3e-4", "collapse10", "collapse10quantize14", "crop50"
  bool read = false;         ///< the payload came back, images exactly
  double falsePositive = 1;
};

/// Whether `payload` is read from a mesh, whole and certain.
/// @param ground  as for MeshReader.
[[nodiscard]] SelfTest readBack(const Mesh& mesh, const PayloadBits& payload, const SchemeKeys& keys,
                                std::shared_ptr<Ground> ground = nullptr);

/// Rounds to a grid of 14 and of 11 bits over the largest extent; moves vertices by Gaussian noise of 3e-4 of the
/// diagonal; collapses the shortest edges until a tenth of the vertices is gone, alone and with 14 bits; cuts the mesh
/// in half. Deterministic. Cost: six readings.
[[nodiscard]] std::vector<SelfTest> selfTest(const Mesh& marked, const PayloadBits& payload, const SchemeKeys& keys);

}  // namespace quadmark::robust
