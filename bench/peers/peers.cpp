// SPDX-License-Identifier: MIT
#include "peers.h"

namespace quadmark::bench {

std::vector<std::unique_ptr<Peer>> peers() {
  std::vector<std::unique_ptr<Peer>> out;
  for (const auto make : {ohbuchiTvr, cayreSpectral, choMean, choVariance, gaoSimilarity, indexQim, lsbHmac}) out.push_back(make());
  return out;
}

}  // namespace quadmark::bench
