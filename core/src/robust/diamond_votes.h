// SPDX-License-Identifier: MIT
// Reading layer B: how likely each fine cell is to hold more than chance.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "constellation.h"
#include "diamonds.h"

namespace quadmark::robust {

/// Log-likelihood that a fine cell is good, per fine cell of a class; keyless, so that one set serves all streams.
struct CellScores {
  std::vector<float> score;  ///< by FineCell::number, at least 0
  double share = 0;          ///< estimated share of marked diamonds
};

/// The shapes of all diamonds of a mesh, as far as reading needs them.
class DiamondVotes {
 public:
  /// @param sigmas  the noise levels that will be asked for, file units: shapes are sorted by them, so that each level
  ///                looks at its own part only.
  DiamondVotes(const Surface& surface, const std::vector<double>& positions, std::span<const double> sigmas);

  /// @param sigma  one of the constructor's.
  /// @param plane  how much of it moves the ratios; less than all where the embedder has unflattened cells.
  [[nodiscard]] CellScores score(const DeltaClass& shape, double sigma, double plane) const;

  /// Adds the symbols of the groups that carry a stream.
  static void addSymbols(const Constellation& constellation, const CellScores& scores, Stream stream, SoftBits& out);

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(gap_.size()); }

 private:
  static constexpr std::uint32_t kBins = 8;  // of the background histogram for the edge; twice as many for the span

  [[nodiscard]] std::vector<float> background(double sigma) const;

  std::vector<double> limits_;           // ascending upper limits of gap_ per section
  std::vector<std::uint32_t> sections_;  // limits + 1: where each section begins
  std::vector<float> gap_;               // gap per unit of vertex noise that would explain it, file units
  std::vector<float> edge_, span_;       // Ratios
  std::vector<float> edgeGain_, spanGain_;
  std::vector<std::uint8_t> bin_;
  double scale_ = 1;  // typical gap_ of unmarked diamonds
};

/// Raises each vertex of a flat diamond in a good fine cell to how flat it is under `sigma` (file units), 0..1.
void addDiamondEvidence(const Surface& surface, const Constellation& constellation, const CodedPayload& payload,
                        double sigma, std::vector<float>& perVertex);

}  // namespace quadmark::robust
