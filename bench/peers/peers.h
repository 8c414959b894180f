// SPDX-License-Identifier: MIT
// Watermarking schemes of other people, written from their papers to be measured beside ours. Never part of the product.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "../schemes/scheme.h"

namespace quadmark::bench {

/// What a report prints about a peer.
struct PeerInfo {
  std::string authors, title, venue;
  int year = 0;
  bool blind = true;        ///< reads without the original
  std::string carrier;      ///< what carries a bit
  std::string settings;     ///< their names, ranges and the usual values
  std::string decided;      ///< what the paper leaves open and how it was decided, in the peer's favour
  std::string validation;   ///< the published number or property that a test compares with
};

/// A scheme of other people. Its settings are `name=number` joined by commas; what is not named has its usual value.
class Peer : public Scheme {
 public:
  [[nodiscard]] virtual PeerInfo info() const = 0;
};

// Each file names the paper, says where the paper leaves something open and what was decided.
[[nodiscard]] std::unique_ptr<Peer> ohbuchiTvr();
[[nodiscard]] std::unique_ptr<Peer> cayreSpectral();
[[nodiscard]] std::unique_ptr<Peer> choMean();
[[nodiscard]] std::unique_ptr<Peer> choVariance();
[[nodiscard]] std::unique_ptr<Peer> gaoSimilarity();
[[nodiscard]] std::unique_ptr<Peer> indexQim();
[[nodiscard]] std::unique_ptr<Peer> lsbHmac();

/// All of them, oldest paper first, then the two that are common practice rather than a paper.
[[nodiscard]] std::vector<std::unique_ptr<Peer>> peers();

}  // namespace quadmark::bench
