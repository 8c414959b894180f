// SPDX-License-Identifier: MIT
// The product's two schemes, as the evaluation asks for them.
#pragma once

#include <memory>

#include "scheme.h"

namespace quadmark::bench {

/// Scheme `robust`. Settings: a strength of robust/embedder.h. Its claim includes the comparison with the expected
/// payload, as when a user gives one.
[[nodiscard]] std::unique_ptr<Scheme> makeRobust();

/// Scheme `paper`. Settings: "L=2" or "L=2 H=4", the same digits for index and piece; without H they follow from Eq. (7).
/// Its claim includes the comparison with the expected payload.
[[nodiscard]] std::unique_ptr<Scheme> makePaper();

}  // namespace quadmark::bench
