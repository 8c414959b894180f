// SPDX-License-Identifier: MIT
#include "gltf_bounds.h"

#include <cmath>
#include <limits>

#include "gltf_components.h"
#include "number_text.h"

namespace quadmark::io {

std::vector<CodeRange> codeRanges(const std::uint8_t* first, std::uint64_t stride, std::uint64_t count,
                                  std::uint32_t componentType, std::uint32_t components) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<CodeRange> ranges(components, CodeRange{kInfinity, -kInfinity});
  withComponent(componentType, [&](auto component) {
    using T = decltype(component);
    for (std::uint64_t i = 0; i < count; ++i, first += stride) {
      for (std::size_t k = 0; k < ranges.size(); ++k) {
        const double code = load<T>(first + k * sizeof(T));
        if (code < ranges[k].low) ranges[k].low = code;
        if (code > ranges[k].high) ranges[k].high = code;
      }
    }
  });
  return ranges;
}

std::string spellBound(double bound, std::uint32_t componentType) {
  return componentType == kGltfFloat ? formatShortest(static_cast<float>(bound)) : formatShortest(bound);
}

void correctBound(JsonValue declared, double bound, std::uint32_t componentType, JsonEdits& edits) {
  std::optional<double> number = parseDouble(declared.text());
  if (const std::optional<float> narrow = parseFloat(declared.text()); narrow && componentType == kGltfFloat) {
    number = *narrow;
  }
  if (!number || *number == bound || !std::isfinite(bound)) return;
  edits.replace(declared.text(), spellBound(bound, componentType));
}

}  // namespace quadmark::io
