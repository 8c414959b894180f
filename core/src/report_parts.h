// SPDX-License-Identifier: MIT
// Members that the reports of all schemes share.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "json_writer.h"
#include "quadmark/image.h"
#include "quadmark/metrics.h"
#include "report.h"

namespace quadmark {

/// "image": { width, height, bits, erased, erasedBits }.
void writeImage(JsonWriter& json, const BitImage& image, const std::vector<std::uint8_t>& erased);

/// "id": 16 hexadecimal digits or null.
void writeId(JsonWriter& json, const std::optional<std::uint64_t>& id);

/// "distortion": { ... }.
void writeDistortion(JsonWriter& json, const Distortion& distortion);

/// "perNode": [ ... ].
void writeNodes(JsonWriter& json, const std::vector<NodeCells>& nodes);

}  // namespace quadmark
