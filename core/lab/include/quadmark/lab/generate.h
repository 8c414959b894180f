// SPDX-License-Identifier: MIT
// Procedural models made by our own code: the demo's model and the tests' fixtures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/result.h"

namespace quadmark::lab {

/// All models are deterministic, bit-equal on every platform, of one seam group and rounded to float32; closed ones are
/// turned outwards. Coordinates are of the order of 1.

/// A detailed, good-looking sculpture of about `vertices` vertices (less than 500 is taken as 500): a trefoil knot
/// braided of three strands, ribbed, folded and weathered like a scan; y is up, its height is 2. One closed surface of
/// genus 1, irregular triangles of valence 4..8, no natural coplanar quadrilaterals. Reliefs too fine for the mesh fade
/// out. Used by the demo and as the page's sample. Cost: about 6 microseconds per vertex.
[[nodiscard]] Mesh sculpture(std::size_t vertices, std::uint64_t seed = 1);

/// A machined bracket of about `vertices` vertices (less than 300 is taken as 300): flat faces with grid-like but
/// irregular triangulations, creases, a bore, a chamfer and a fillet; vertices of flat regions, slanted ones too, are
/// exactly coplanar in float32, as CAD exports are. Closed, genus 1. Stresses natural coplanar sets.
[[nodiscard]] Mesh machinedPart(std::size_t vertices, std::uint64_t seed = 1);

/// Small fixtures, each with the property its name says.
[[nodiscard]] Mesh cube();                        ///< 8 vertices, 12 triangles
[[nodiscard]] Mesh quadSphere(int subdivisions);  ///< 6 * 4^n quads (n 0..10), valence 3 and 4, closed
[[nodiscard]] Mesh icosphere(int subdivisions);   ///< 20 * 4^n triangles (n 0..11), valence 5 and 6, closed
/// Triangles with a border: columns * rows vertices (>= 2 each way), a unit grid with noise in all coordinates.
[[nodiscard]] Mesh bumpyGrid(int columns, int rows, std::uint64_t seed);
[[nodiscard]] Mesh flatGrid(int columns, int rows);    ///< the same without noise: every vertex in z = 0
[[nodiscard]] Mesh polygonMix(std::uint64_t seed);     ///< triangles, quads, pentagons and hexagons, bumpy
[[nodiscard]] Mesh fan(int spokes);                    ///< one pole of valence `spokes` (>= 3), open
[[nodiscard]] Mesh nonManifold();                      ///< an edge with three faces, a bow-tie vertex, bumpy
[[nodiscard]] Mesh twoComponents(std::uint64_t seed);  ///< two separate bumpy spheres
[[nodiscard]] Mesh seamed(std::uint64_t seed);         ///< bumpy sphere with duplicated vertices along a seam

/// A model by name: sculpture, part, cube, quad-sphere, icosphere, bumpy-grid, flat-grid, polygon-mix, fan,
/// non-manifold, two-components, seamed. `vertices` (at most 20 million) and `seed` count where the model has such a
/// parameter. Fails with badOption.
[[nodiscard]] Result<Mesh> generate(const std::string& name, std::size_t vertices, std::uint64_t seed);

}  // namespace quadmark::lab
