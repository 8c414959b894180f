// SPDX-License-Identifier: MIT
// One trial of a scheme: its payload, marking, and what a reading is worth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "schemes/scheme.h"

namespace quadmark::bench {

/// What a row of results says of who marks what, without the model.
struct Trial {
  const Scheme* scheme = nullptr;
  std::string settings;     ///< never empty
  std::string payloadName;  ///< "id" or "image:SIDE"
  std::uint64_t seed = 1;   ///< key and ID come from it

  TrialPayload payload;  ///< what is meant: a random ID, or the emblem
  /// What the scheme is given: the payload XORed with a pad of the key. So the bits are coin flips to whoever has another
  /// key, even those of a picture, and the binomial tail of those that agree is exact (numbers: verdict.h).
  TrialPayload whitened;
};

/// @param settings  empty for the scheme's usual ones.
/// Fails with badOption (a scheme or payload there is not).
[[nodiscard]] Result<Trial> makeTrial(const std::string& scheme, const std::string& settings, const std::string& payload,
                                      std::uint64_t seed);

/// The model's mesh with the mark in it, its positions rounded to what the file can store.
struct MarkedTrial {
  Mesh mesh;
  TrialMark mark;  ///< its positions are the mesh's
};
/// Fails as Scheme::mark(), or with internal where that gave another number of positions.
[[nodiscard]] Result<MarkedTrial> markTrial(const Trial& trial, const Mesh& mesh);

struct Judgement {
  std::string outcome;                 ///< exact, match, lost or wrong: bench/README.md
  double bitErrorRate = 0.5;           ///< an unread bit counts one half
  double unread = 1;                   ///< share of the bits
  double claim = 1;                    ///< the scheme's own, or the binomial tail of the bits read
  Bits bits, erased;                   ///< as long as the payload; a bit that was not read is 0
};
[[nodiscard]] Judgement readTrial(const Trial& trial, const Mesh& mesh);

}  // namespace quadmark::bench
