// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace quadmark::robust {

/// The upper median, 0 of nothing. One body for all callers, and in single precision: the module is downloaded. Linear.
[[nodiscard]] double medianOf(std::vector<float> values);

}  // namespace quadmark::robust
