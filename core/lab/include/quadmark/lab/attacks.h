// SPDX-License-Identifier: MIT
// Attacks: what happens to a marked model between marking and reading. For tests, benchmarks and `quadmark attack`;
// never part of the product's wasm module.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/result.h"

namespace quadmark::lab {

/// Every attack returns a new mesh, rounded to mesh.precision, and is a pure function of its arguments: equal
/// arguments give bit-equal output natively and in wasm. "diag" is the bounding-box diagonal of the input.
/// `vertexOrigin` (where an attack offers it) maps each output vertex to the input vertex it came from.

/// Row-major 3 x 4 affine map applied to every vertex.
using Affine = std::array<double, 12>;
[[nodiscard]] Mesh affine(const Mesh& mesh, const Affine& map);

/// The paper's affine attacks by name: "R" (45 degrees about x, then y), "NS" (scale .5, 1.5, 2), "RE" (reflection in
/// the yz-plane), "S" (scale .5), "SH" (x + 1.5 y), "CB" (all in that order). Fails with badOption on another name.
[[nodiscard]] Result<Affine> paperAffine(std::string_view name);

/// Permutes vertices, faces and the first corner of each face. Unreferenced vertices are kept.
[[nodiscard]] Mesh reorder(const Mesh& mesh, std::uint64_t seed);

/// Removes `fraction` (0..1) of the vertices: those lowest along an axis (0, 1, 2 = x, y, z; 3 = a random direction
/// from the seed), with every face that used one of them.
[[nodiscard]] Mesh crop(const Mesh& mesh, double fraction, int axis = 1, std::uint64_t seed = 1);

/// Adds uniform noise in [-amplitude, amplitude] * diag to each coordinate. Twins (equal position and group) move alike.
[[nodiscard]] Mesh noise(const Mesh& mesh, double amplitude, std::uint64_t seed);

/// Noise on a connected-looking half: vertices on one side of a random plane that holds `share` (0..1) of them.
[[nodiscard]] Mesh localNoise(const Mesh& mesh, double amplitude, double share, std::uint64_t seed);

/// Rounds to a grid of 2^bits levels: one step for all axes (as Draco and glTF tools do) or one per axis.
enum class Grid : std::uint8_t { common, perAxis };
[[nodiscard]] Mesh quantize(const Mesh& mesh, int bits, Grid grid);

/// Umbrella Laplacian smoothing: x += lambda * (mean of neighbours - x), boundary vertices fixed.
[[nodiscard]] Mesh smoothLaplacian(const Mesh& mesh, double lambda, int iterations);
/// Taubin's lambda | mu smoothing: one iteration is a step with lambda > 0 then one with mu = -lambda / (1 - 0.1 lambda).
[[nodiscard]] Mesh smoothTaubin(const Mesh& mesh, double lambda, int iterations);

/// meshoptimizer's simplifier: keeps `keep` (0..1) of the triangles; survivors keep their exact positions.
[[nodiscard]] Mesh simplifyMeshopt(const Mesh& mesh, double keep);
/// Quadric edge collapse with optimal placement (Garland and Heckbert 1997) down to `keep` of the vertices.
[[nodiscard]] Mesh simplifyQem(const Mesh& mesh, double keep);

/// A smooth handle-based deformation standing in for Au et al. 2006: the part of the model beyond the median along
/// its longest axis is bent and twisted by up to `amount` radians, the rest (the handle's anchor) keeps its exact
/// position, with a smooth fall-off between.
[[nodiscard]] Mesh deform(const Mesh& mesh, double amount, std::uint64_t seed);

/// An attack by name and amount, as the command line spells it.
/// kinds: affine (amount unused, `variant` = R NS RE S SH CB), reorder, crop, noise, local-noise, quantize (amount = bits,
/// variant common | per-axis), smooth (amount = lambda, variant taubin | laplacian, iterations), simplify (amount = share
/// removed, variant meshopt | qem), deform.
struct AttackSpec {
  std::string kind;
  double amount = 0;
  std::string variant;
  int iterations = 1;
  std::uint64_t seed = 1;
};
[[nodiscard]] Result<Mesh> attack(const Mesh& mesh, const AttackSpec& spec);

/// All kinds with a one-line description each, for help texts.
struct AttackInfo { std::string kind, description; };
[[nodiscard]] std::vector<AttackInfo> attackKinds();

/// Writes a mesh as a new, plain file (not a patch of a user's file): binary little-endian PLY, or GLB when all faces
/// are triangles (polygons are fanned). float32 or, PLY only, float64 by mesh.precision.
[[nodiscard]] std::vector<std::uint8_t> writePly(const Mesh& mesh);
[[nodiscard]] std::vector<std::uint8_t> writeGlb(const Mesh& mesh);

}  // namespace quadmark::lab
