// SPDX-License-Identifier: MIT
// What the peers that mark welded vertices share: everything around their own idea.
#pragma once

#include <string>
#include <vector>

#include "keyed_bits.h"
#include "peers.h"
#include "quadmark/adjacency.h"
#include "settings.h"

namespace quadmark::bench {

/// Welds, checks and reads settings before, moves twins together and reads its own mark after.
class WeldedPeer : public Peer {
 public:
  std::string usualSettings() const final { return usualText(settings()); }
  /// Fails with badOption on settings or a payload that are none, with capacity where readableMark() refuses.
  Result<TrialMark> mark(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                         const std::string& text) const final;
  TrialReading read(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                    const std::string& text) const final;

 protected:
  /// One model under one key.
  struct Work {
    const Mesh& mesh;
    WeldedMesh welded;
    KeyedBits bits;              ///< of the payload, then the pilots
    std::vector<double> values;  ///< of settings()
  };

  [[nodiscard]] virtual std::vector<Setting> settings() const = 0;
  /// Bits written after the payload's, always 0.
  [[nodiscard]] virtual std::size_t pilots() const { return 0; }
  /// Moves vertices.
  /// @param written  the bit that each of work.bits is to hold, as carriers hold them (padded).
  /// @param moved    3 per welded vertex: before, and on return after.
  /// @param mark     gets the counts.
  virtual void write(const Work& work, const Bits& written, std::vector<double>& moved, TrialMark& mark) const = 0;
  virtual void vote(const Work& work, BitVotes& votes) const = 0;
};

}  // namespace quadmark::bench
