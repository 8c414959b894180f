// SPDX-License-Identifier: MIT
// The min and max of accessors: what they should say, and how they are made to.
#pragma once

#include <vector>

#include "bytes.h"
#include "json_edits.h"

namespace quadmark::io {

/// What the stored codes of one component range over; neither is finite where no code is.
struct CodeRange {
  double low, high;
};

/// @param first  of `count` > 0 elements, `stride` bytes apart and all in memory.
/// @param componentType  floats, or integers of 8 or 16 bits.
/// @return a range per component.
std::vector<CodeRange> codeRanges(const std::uint8_t* first, std::uint64_t stride, std::uint64_t count,
                                  std::uint32_t componentType, std::uint32_t components);

/// A bound as JSON: the shortest text that means the stored component.
std::string spellBound(double bound, std::uint32_t componentType);

/// Gives an element of a min or max array its true value. One that says so already keeps its spelling.
void correctBound(JsonValue declared, double bound, std::uint32_t componentType, JsonEdits& edits);

}  // namespace quadmark::io
