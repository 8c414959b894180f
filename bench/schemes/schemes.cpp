// SPDX-License-Identifier: MIT
#include <utility>

#include "../peers/peers.h"
#include "ours.h"
#include "scheme.h"

namespace quadmark::bench {

const std::vector<std::unique_ptr<Scheme>>& schemes() {
  static const std::vector<std::unique_ptr<Scheme>> list = [] {
    std::vector<std::unique_ptr<Scheme>> all;
    all.push_back(makeRobust());
    all.push_back(makePaper());
    for (auto& peer : peers()) all.push_back(std::move(peer));
    return all;
  }();
  return list;
}

Result<const Scheme*> schemeNamed(const std::string& name) {
  std::string known;
  for (const auto& scheme : schemes()) {
    if (scheme->name() == name) return scheme.get();
    known.append(known.empty() ? "" : ", ").append(scheme->name());
  }
  return Error{ErrorCode::badOption, "scheme \"" + name + "\" is not one of " + known};
}

}  // namespace quadmark::bench
