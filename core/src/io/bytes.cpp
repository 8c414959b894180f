// SPDX-License-Identifier: MIT
#include "bytes.h"

namespace quadmark::io {

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string out = "\"";
  for (const char character : text.substr(0, kLongest)) {
    const bool printable = character >= ' ' && character <= '~' && character != '"';
    out += printable ? character : '?';
  }
  if (text.size() > kLongest) out += "...";
  return out + "\"";
}

}  // namespace quadmark::io
