// SPDX-License-Identifier: MIT
// Reading a mark from whatever a pipeline made of a model: as it is, with its split seams closed, object by object.
#pragma once

#include <cstdint>

#include "quadmark/adjacency.h"
#include "quadmark/extract.h"

namespace quadmark {

/// What a result was read from.
enum class Part : std::uint8_t { model, closedSeams, component };

/// "model", "closedSeams" or "component".
[[nodiscard]] const char* partName(Part part);

struct PartsExtraction {
  Extraction extraction;           ///< vertices of its readings are those of the whole model, whatever was read
  Part part = Part::model;
  std::uint32_t partVertices = 0;  ///< welded vertices of that part
  std::uint32_t tried = 1;         ///< parts that were read
};

/// Reads the whole model; if that is no match, reads it with near twins welded (closeSeams()), and then each of its
/// largest connected components alone, since the cells of unmarked objects that were joined with a marked one say
/// nothing and drown it.
///
/// Each reading has a weight that geometry alone fixes: 1/2 the whole, 1/4 the closed seams, 1/4 (1 / (r (r + 1))) the
/// component that is r-th by size. falsePositive is that of a reading divided by its weight, and the least of these, so
/// it stays an upper bound for the whole procedure (Bonferroni). The verdict follows from it.
///
/// @param welded  with positions. Deterministic, and independent of the order of vertices and faces.
/// Cost: extractMesh() once where that matches, else up to three times.
[[nodiscard]] PartsExtraction extractParts(const WeldedMesh& welded, Precision precision, const Key& key,
                                           const ExtractOptions& options);

}  // namespace quadmark
