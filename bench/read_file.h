// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "quadmark/result.h"

namespace quadmark::bench {

/// A file's bytes, or `io` with its path.
inline Result<std::vector<std::uint8_t>> readFile(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Error{ErrorCode::io, "cannot read " + path};
  return std::vector<std::uint8_t>(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
}

}  // namespace quadmark::bench
