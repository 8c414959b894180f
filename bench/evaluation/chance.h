// SPDX-License-Identifier: MIT
// How often chance looks like a mark: readings of models that do not carry the mark of the key they are read with.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "quadmark/mesh.h"
#include "quadmark/result.h"

namespace quadmark::bench {

struct ChanceBin {
  std::uint64_t trials = 0;
  std::uint64_t matches = 0;  ///< of these: taken for a mark, outcome other than "lost" (bench/README.md)
};

/// What trials claimed, by tenths of -log10(claim), rounded down: 0 holds claims in (10^-0.1, 1].
using ChanceBins = std::map<int, ChanceBin>;

/// Trials first, first + 1, .. of one kind; each has its own key and ID, which no mark has.
struct ChanceTrials {
  std::string scheme, settings;  ///< that reads
  std::string mark;              ///< name of the scheme whose marks (keys 1 to 4, in turn) the model carries; empty: none
  std::uint64_t first = 0, count = 0;
};

/// Fails with badOption (unknown scheme), or as Scheme::mark() where the model takes no such mark.
[[nodiscard]] Result<ChanceBins> countChance(const ChanceTrials& trials, const Mesh& model);

}  // namespace quadmark::bench
