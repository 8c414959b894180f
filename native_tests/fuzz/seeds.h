// SPDX-License-Identifier: MIT
// Small whole files of every kind that we read, made by our own code: where the fuzzers begin, and what the tests of
// hostile files damage.
#pragma once

#include <vector>

#include "io_fixtures.h"

namespace quadmark::test {

/// External buffers that glTF seeds refer to.
[[nodiscard]] Resources seedResources();

[[nodiscard]] std::vector<FileBytes> plySeeds();
[[nodiscard]] std::vector<FileBytes> gltfSeeds();
[[nodiscard]] std::vector<FileBytes> drcSeeds();
[[nodiscard]] std::vector<FileBytes> keySeeds();
[[nodiscard]] std::vector<FileBytes> pngSeeds();

/// For exerciseMesh(): numbers of vertices and faces, corners, coordinates.
[[nodiscard]] std::vector<FileBytes> meshSeeds();

}  // namespace quadmark::test
