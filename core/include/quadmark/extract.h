// SPDX-License-Identifier: MIT
// Reading a mark from a mesh: passes of rising tolerance, votes per bit, verdict (section 4.3; D20-D22).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "quadmark/cells.h"
#include "quadmark/digits.h"
#include "quadmark/key.h"
#include "quadmark/payload.h"
#include "quadmark/verdict.h"

namespace quadmark {

/// One reading that the votes are made of.
struct CellReading {
  std::uint32_t vertices[4];  ///< welded vertices a, b, c, d
  Reading reading;
  float purity = 0;           ///< estimated share of true cells among readings of its kind, 0..1
  float weight = 0;           ///< weight of its votes
  bool agrees = false;        ///< it voted, and for the bits that were read in the end
};

struct Extraction {
  Verdict verdict = Verdict::none;
  double falsePositive = 1;            ///< upper bound, see verdict.h
  double agreementProbability = 1;     ///< from the copies of each bit alone
  double referenceProbability = 1;     ///< from the reference alone; 1 without one
  std::vector<std::uint8_t> bits;      ///< payload bits, one per byte; 0 where erased
  std::vector<std::uint8_t> erased;    ///< 1 = unread
  std::vector<float> confidence;       ///< 0..1 per payload bit: |P(1) - P(0)|
  std::vector<CellReading> readings;   ///< what voted; empty unless asked for
  std::uint32_t cells = 0;             ///< readings that voted
  std::uint32_t exactCells = 0;        ///< of these, found in pass 1
  std::uint32_t erasedCells = 0;       ///< readings rejected as erasures (D14)
  std::uint32_t piecesRead = 0;        ///< pieces with at least one vote of weight
  int passes = 0;
  double agreement = 1;                ///< how far copies of a bit agree, of what their purity promises: 0..1; 1 if untested
  bool cancelled = false;              ///< progress said stop, or exactOnly; nothing else is meaningful then
};

struct ExtractOptions {
  std::span<const std::uint8_t> reference;  ///< expected payload bits, empty for none
  /// For a caller that knows them: all sets that are flat up to rounding, so that pass 1 need not look for them.
  std::span<const std::array<std::uint32_t, 4>> exactSets;
  bool exactOnly = false;                   ///< cancels where these sets alone do not settle every bit
  bool keepReadings = false;
  bool bitsOnly = false;                    ///< leave the verdict, its probabilities and the agreement out
  std::function<bool(int passes)> progress; ///< called before each pass with the number done; false cancels
};

/// Reads a mesh.
/// @param positions  3 per welded vertex; the welded mesh gives the connectivity only.
/// Deterministic, and independent of the order of vertices and faces. Cost: linear, 0.3 microseconds per vertex when
/// the mark is intact; the tolerant passes may take several times as long.
[[nodiscard]] Extraction extractMesh(const WeldedMesh& welded, const std::vector<double>& positions,
                                     const Rounding& rounding, const Key& key, const ExtractOptions& options = {});

}  // namespace quadmark
