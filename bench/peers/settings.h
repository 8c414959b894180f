// SPDX-License-Identifier: MIT
// The settings of a peer as text: `name=number` joined by commas.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "quadmark/result.h"

namespace quadmark::bench {

/// One setting that a peer has.
struct Setting {
  std::string name;
  double usual = 0, low = 0, high = 0;  ///< the usual value and the range, both ends allowed
};

/// The values in the order of `known`, the usual ones where the text (it may be empty) names none. Fails with badOption
/// on an unknown name, a name without a number, or a number out of range.
[[nodiscard]] Result<std::vector<double>> settingValues(const std::string& text, const std::vector<Setting>& known);

/// The usual values as text that settingValues() reads.
[[nodiscard]] std::string usualText(const std::vector<Setting>& known);

/// The settings for a report: "strength 0.001 .. 0.4, usually 0.04; ...".
[[nodiscard]] std::string describe(const std::vector<Setting>& known);

}  // namespace quadmark::bench
