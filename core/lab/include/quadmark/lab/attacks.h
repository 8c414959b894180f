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
/// arguments give bit-equal output natively and in wasm. The input must validate(). "diag" is the bounding-box diagonal
/// of the vertices that faces use. Attacks that move vertices leave those no face uses where they are, unless said;
/// twins (bit-equal position and group) always move alike. Arguments are in range as stated: attack() checks them.
/// `origin`, where an attack offers it, receives for each output vertex the input vertex it came from.
/// Cost: about linear; simplification n log n. Two million vertices take seconds.
using VertexOrigin = std::vector<std::uint32_t>;

/// Row-major 3 x 4 affine map applied to every vertex, used or not. A map that mirrors leaves the faces' orientation.
using Affine = std::array<double, 12>;
[[nodiscard]] Mesh affine(const Mesh& mesh, const Affine& map);

/// The paper's affine attacks by name: "R" (45 degrees about x, then y), "NS" (scale .5, 1.5, 2), "RE" (reflection in
/// the yz-plane), "S" (scale .5), "SH" (x + 1.5 y), "CB" (all in that order). Fails with badOption on another name.
[[nodiscard]] Result<Affine> paperAffine(std::string_view name);

/// Permutes vertices, faces and the first corner of each face. Unreferenced vertices are kept; each face keeps its
/// orientation.
[[nodiscard]] Mesh reorder(const Mesh& mesh, std::uint64_t seed, VertexOrigin* origin = nullptr);

/// Removes `fraction` (0..1) of the welded vertices: those lowest along an axis (0, 1, 2 = x, y, z; 3 = a random
/// direction from the seed; equal heights by x, y, z), with every face that used one of them. Unreferenced vertices on
/// that side go too; survivors that lost all their faces stay, as loose points.
[[nodiscard]] Mesh crop(const Mesh& mesh, double fraction, int axis = 1, std::uint64_t seed = 1,
                        VertexOrigin* origin = nullptr);

/// Adds uniform noise in [-amplitude, amplitude] * diag to each coordinate. @param amplitude  0..1.
[[nodiscard]] Mesh noise(const Mesh& mesh, double amplitude, std::uint64_t seed);

/// Noise on a connected-looking half: vertices on one side of a random plane that holds `share` (0..1) of them.
[[nodiscard]] Mesh localNoise(const Mesh& mesh, double amplitude, double share, std::uint64_t seed);

/// Rounds to a grid of 2^bits levels over the bounding box of the used vertices: one step, the longest side's, for all
/// axes (as Draco and glTF tools do) or one per axis. The result is then rounded to the mesh's own precision, as a
/// decoder does. Unreferenced vertices are rounded too. @param bits  1..30.
enum class Grid : std::uint8_t { common, perAxis };
[[nodiscard]] Mesh quantize(const Mesh& mesh, int bits, Grid grid);

/// Umbrella Laplacian smoothing: x += lambda * (mean of neighbours - x) for all vertices at once. Vertices of border
/// edges (edges of one face) stay fixed. @param lambda  0..1. @param iterations  >= 0.
[[nodiscard]] Mesh smoothLaplacian(const Mesh& mesh, double lambda, int iterations);
/// Taubin's lambda | mu smoothing: one iteration is a step with lambda > 0 then one with mu = -lambda / (1 - 0.1
/// lambda).
[[nodiscard]] Mesh smoothTaubin(const Mesh& mesh, double lambda, int iterations);

/// meshoptimizer's simplifier: keeps about `keep` (0..1) of the triangles (polygons are fanned first), or more where the
/// next collapse would exceed `errorLimit` (relative to the extent; 1 gives every collapse free way). Survivors keep
/// their exact positions. It may stop early where topology forbids going on. Vertices that no
/// triangle uses any more are dropped. It works in float32 whatever the precision.
[[nodiscard]] Mesh simplifyMeshopt(const Mesh& mesh, double keep, VertexOrigin* origin = nullptr,
                                   double errorLimit = 1);
/// Quadric edge collapse with optimal placement (Garland and Heckbert 1997) down to `keep` (0..1) of the welded
/// vertices. Twins become one vertex, polygons are fanned, borders are held by constraint planes, and a collapse that
/// would turn a face over or change the topology is refused, so that it too may stop early.
[[nodiscard]] Mesh simplifyQem(const Mesh& mesh, double keep);

/// A smooth handle-based deformation standing in for Au et al. 2006: the part of the model beyond the median along
/// its longest axis is bent and twisted by up to `amount` radians, the rest (the handle's anchor) keeps its exact
/// position, with a smooth fall-off between. The seed picks the direction of the bend and the sense of the twist.
[[nodiscard]] Mesh deform(const Mesh& mesh, double amount, std::uint64_t seed);

/// An attack by name and amount, as the command line spells it.
/// kinds: affine (variant = R NS RE S SH CB, default CB; amount unused), reorder, crop (amount = share of the vertices,
/// variant = x y z random, default y), noise, local-noise (amount = amplitude; half of the vertices), quantize (amount
/// = bits, variant = common per-axis, default common), smooth (amount = lambda, variant = taubin laplacian, default
/// taubin, iterations), simplify (amount = share removed, variant = meshopt qem, default meshopt), deform (amount =
/// radians). An empty variant means the default.
struct AttackSpec {
  std::string kind;
  double amount = 0;
  std::string variant{};
  int iterations = 1;
  std::uint64_t seed = 1;
};
/// Fails with badOption (names the option and its range), or badMesh when nothing but loose points would be left.
[[nodiscard]] Result<Mesh> attack(const Mesh& mesh, const AttackSpec& spec);

/// All kinds with a one-line description each, for help texts.
struct AttackInfo {
  std::string kind, description;
};
[[nodiscard]] std::vector<AttackInfo> attackKinds();

/// Writes a mesh as a new, plain file (not a patch of a user's file): binary little-endian PLY, or GLB when all faces
/// are triangles (polygons are fanned). float32 or, PLY only, float64 by mesh.precision. A GLB gets one glTF mesh and
/// node per seam group; PLY knows no groups.
[[nodiscard]] std::vector<std::uint8_t> writePly(const Mesh& mesh);
[[nodiscard]] std::vector<std::uint8_t> writeGlb(const Mesh& mesh);

}  // namespace quadmark::lab
