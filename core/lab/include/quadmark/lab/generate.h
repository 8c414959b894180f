// SPDX-License-Identifier: MIT
// Procedural models made by our own code: the demo's model and the tests' fixtures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/result.h"

namespace quadmark::lab {

/// A detailed, good-looking sculpture of about `vertices` vertices (>= 500): one closed triangle surface, irregular
/// connectivity, folds and fine relief like a scan. Deterministic. Used by the demo and as the page's sample.
[[nodiscard]] Mesh sculpture(std::size_t vertices, std::uint64_t seed = 1);

/// A machined part: flat faces with grid-like triangulations, creases, holes and fillets; coordinates of flat regions
/// are exactly coplanar, as CAD exports are. Stresses natural coplanar sets.
[[nodiscard]] Mesh machinedPart(std::size_t vertices, std::uint64_t seed = 1);

/// Small fixtures, each with the property its name says.
[[nodiscard]] Mesh cube();                                   ///< 8 vertices, 12 triangles
[[nodiscard]] Mesh quadSphere(int subdivisions);             ///< quads, valence 3 and 4, closed
[[nodiscard]] Mesh icosphere(int subdivisions);              ///< triangles, valence 5 and 6, closed
[[nodiscard]] Mesh bumpyGrid(int columns, int rows, std::uint64_t seed);  ///< triangles with border, height noise
[[nodiscard]] Mesh flatGrid(int columns, int rows);          ///< every vertex in one plane
[[nodiscard]] Mesh polygonMix(std::uint64_t seed);           ///< triangles, quads, pentagons and hexagons, bumpy
[[nodiscard]] Mesh fan(int spokes);                          ///< one pole of high valence
[[nodiscard]] Mesh nonManifold();                            ///< an edge with three faces, a bow-tie vertex, bumpy
[[nodiscard]] Mesh twoComponents(std::uint64_t seed);        ///< two separate bumpy spheres
[[nodiscard]] Mesh seamed(std::uint64_t seed);               ///< bumpy sphere with duplicated vertices along a seam

/// A model by name: "sculpture", "part", "icosphere", ... as above. Fails with badOption.
[[nodiscard]] Result<Mesh> generate(const std::string& name, std::size_t vertices, std::uint64_t seed);

}  // namespace quadmark::lab
