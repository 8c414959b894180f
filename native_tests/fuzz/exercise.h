// SPDX-License-Identifier: MIT
// What the program does with bytes from anywhere, all of it: used by the fuzzers and by the tests of hostile files.
// Every clean answer is fine. A crash, a leak, an answer that contradicts itself or `internal` is not.
#pragma once

#include <string>

#include "quadmark/io/model.h"

namespace quadmark::test {

using Bytes = std::span<const std::uint8_t>;

/// What went wrong in a sentence, or empty.
using Problem = std::string;

/// Reads a model; where that works, patches moved positions, exchanges the order of vertices, and reads both back; on
/// small models also inspects, looks for a mark and embeds one.
[[nodiscard]] Problem exerciseModel(Bytes file, const Resources& resources);

/// The same with the resources that the seeds refer to.
[[nodiscard]] Problem exerciseModel(Bytes file);

/// The same, but goes beyond reading, patching and reordering for one input in eight only: readers see several times as
/// many inputs in the same time.
[[nodiscard]] Problem exerciseReading(Bytes file);

/// Parses a key file; where that works, writes it and parses it again.
[[nodiscard]] Problem exerciseKey(Bytes file);

/// Decodes a PNG; where that works, encodes it and decodes it again.
[[nodiscard]] Problem exercisePng(Bytes file);

/// Takes the bytes themselves for faces and coordinates (any floats that are finite), marks them and reads the mark.
[[nodiscard]] Problem exerciseMesh(Bytes file);

}  // namespace quadmark::test
