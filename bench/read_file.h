// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "quadmark/result.h"

namespace quadmark::bench {

/// A file's bytes, or `io` with its path.
inline Result<std::vector<std::uint8_t>> readFile(const std::string& path) {
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) return Error{ErrorCode::io, "cannot read " + path};
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(stream.tellg()));  // no larger: quadmark_speed measures memory
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream) return Error{ErrorCode::io, "cannot read " + path};
  return bytes;
}

}  // namespace quadmark::bench
