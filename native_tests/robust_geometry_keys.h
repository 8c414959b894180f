// SPDX-License-Identifier: MIT
// Sub-keys for tests of the robust scheme's geometry, which does not care where they come from.
#pragma once

#include <cstdint>

#include "quadmark/random.h"
#include "quadmark/robust/coded.h"

namespace quadmark::robust {

inline RobustKeys keysOf(std::uint64_t seed) {
  RobustKeys keys;
  Random random(seed);
  for (SubKey* key : {&keys.select, &keys.dither, &keys.constellation, &keys.assignment, &keys.share})
    for (std::uint8_t& byte : *key) byte = static_cast<std::uint8_t>(random.next() >> 56);
  return keys;
}

}  // namespace quadmark::robust
