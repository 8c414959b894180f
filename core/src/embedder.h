// SPDX-License-Identifier: MIT
// The state that the embedder's stages share: assign -> write -> separate -> verify.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "quadmark/cells.h"
#include "quadmark/digits.h"
#include "quadmark/embed.h"
#include "quadmark/extract.h"
#include "quadmark/payload.h"
#include "release.h"

namespace quadmark {

inline constexpr std::uint32_t kNoPiece = 0xffffffffu;

/// Coarseness of a cell: what one rounding of one coordinate may move a ratio by, in digits. Above kMaxCoarseness even
/// an unattacked file could not hold the digits; above kFineCoarseness the rounding after an affine map may be too much.
inline constexpr double kMaxCoarseness = 4, kFineCoarseness = 0.1;

/// A cell with what it shall carry.
struct PlannedCell {
  Quad quad;                       ///< as searched: near ends a, b
  std::uint32_t piece = kNoPiece;  ///< index, or kNoPiece for a decoy or an unused cell
  bool written = false;            ///< are the ratios below to be written?
  double ratioAC = 0, ratioBD = 0; ///< what to write
};

/// What a piece looks like in a cell with a given label: octal digits of piece XOR pad, remembered, since the
/// assignment asks for the same few labels thousands of times.
class PadCache {
 public:
  PadCache(const Pad& pad, const std::vector<std::uint32_t>& pieces, int digits)
      : pad_(pad), pieces_(pieces), digits_(digits), entries_(kEntries) {}
  std::uint32_t operator()(std::uint32_t index, std::uint32_t prefix1, std::uint32_t prefix2);

  /// Gives the memory back; nothing may be asked afterwards.
  void release() { quadmark::release(entries_); }

 private:
  static constexpr std::size_t kEntries = 1 << 14;
  struct Entry {
    std::uint64_t label = ~std::uint64_t{0};
    std::uint32_t index = 0, octal = 0;
  };
  const Pad& pad_;
  const std::vector<std::uint32_t>& pieces_;
  int digits_;
  std::vector<Entry> entries_;
};

class Embedder {
 public:
  Embedder(const Mesh& mesh, std::span<const std::uint8_t> bits, const Key& key);

  Result<MarkedMesh> run(const MeshProgress& progress);

 private:
  // embed.cpp
  Status search();
  [[nodiscard]] const CoordinateGrid* gridOf(std::uint32_t vertex) const;
  [[nodiscard]] bool isFixed(std::uint32_t vertex) const;
  [[nodiscard]] double neighbour(std::uint32_t vertex, double x, int steps) const;
  void round(std::uint32_t vertex);
  void writeCell(PlannedCell& cell);
  void settleCell(const PlannedCell& cell);
  [[nodiscard]] double misfit(const PlannedCell& cell) const;
  [[nodiscard]] double misfit(const PlannedCell& cell, const double* const points[4], double gridHalfStep) const;
  [[nodiscard]] double misfitAfterMaps(const PlannedCell& cell) const;
  [[nodiscard]] bool plan(PlannedCell& cell, std::uint32_t piece);
  void planDecoy(PlannedCell& cell, std::uint64_t number) const;
  [[nodiscard]] Status refuseUnreadableGrid() const;
  [[nodiscard]] MarkedMesh result();

  // embed_assign.cpp
  Status assign();
  Status adoptOrphans(const std::vector<std::uint32_t>& order);
  void assignWindow(std::span<std::uint32_t> cells, std::uint32_t firstPiece);
  [[nodiscard]] double coarseness(const Quad& quad) const;

  // embed_separate.cpp
  using VertexSet = std::array<std::uint32_t, 4>;
  void separate();
  [[nodiscard]] bool areHarmless(std::size_t unwanted) const;
  void updateFlatSets(const std::vector<Quad>& found, const std::vector<std::uint8_t>& isChanged);
  void breakSet(const Quad& set, std::uint64_t salt, std::vector<std::uint8_t>& movedCell,
                std::vector<std::uint32_t>& changed);
  void tilt(PlannedCell& cell, std::uint64_t salt);
  [[nodiscard]] bool isCell(const Quad& set) const;

  // embed_verify.cpp
  using AffineMap = std::array<double, 9>;  ///< row major, no translation
  [[nodiscard]] static const std::vector<AffineMap>& verificationMaps();
  void applyRounded(const AffineMap& map, const double* point, double* out) const;
  Status verify(const MeshProgress& progress);
  std::size_t check(bool mayRepair, std::uint64_t& salt);
  std::size_t checkMapped(const AffineMap& map, bool mayRepair, std::uint64_t& salt);
  std::vector<std::uint32_t> renumberVertices();
  void renumberEdges(const std::vector<std::uint32_t>& oldOf);
  [[nodiscard]] bool checkReordered();
  [[nodiscard]] bool weldsAlike() const;
  [[nodiscard]] Extraction read(ExtractOptions options) const;
  [[nodiscard]] std::vector<std::uint32_t> badPieces(const Extraction& read) const;
  void repair(const std::vector<std::uint32_t>& bad, const Extraction& read, std::uint64_t& salt);

  const Mesh& mesh_;
  const std::span<const std::uint8_t> bits_;
  const Key& key_;
  const Pad pad_;
  const std::vector<std::uint32_t> pieces_;
  const PairCodec codec_;
  WeldedMesh welded_;
  std::vector<double>& positions_;        ///< of welded_: the original ones until search(), representable once written
  Rounding rounding_;                     ///< of the file, or of the copy that is being checked
  const double diagonal_;
  PadCache padded_;
  std::vector<PlannedCell> cells_;
  std::vector<std::uint32_t> cellOf_;     ///< per welded vertex: cell index or kNoVertex
  std::vector<std::uint32_t> copies_;     ///< per piece
  std::vector<VertexSet> flatSets_;       ///< sorted: those that separate() could not break, apart from the cells
  bool flatSetsKnown_ = false;            ///< nothing has moved since separate()
  bool scarce_ = false;                   ///< fewer than kScarceRepeats copies per piece
  std::size_t unreadPieces_ = 0;          ///< in the worse of the last two checks, of the output and of an affine copy
  MarkedMesh report_;
};

}  // namespace quadmark
