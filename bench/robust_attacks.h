// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "quadmark/mesh.h"

namespace quadmark::bench {

struct NamedAttack {
  std::string name;
  std::function<Mesh(const Mesh&)> apply;
};

/// The rows of docs/robust.md, mild ones first.
[[nodiscard]] std::vector<NamedAttack> robustAttacks();
/// Of these, the ones that images are put to.
[[nodiscard]] bool isForImages(const std::string& attack);

}  // namespace quadmark::bench
