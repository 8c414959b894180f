// SPDX-License-Identifier: MIT
// Strings inside JSON texts: escapes and UTF-8, both ways.
#include "json_text.h"
#include "number_text.h"

namespace quadmark {
namespace {

void appendUtf8(std::string& out, std::uint32_t code) {
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xc0 | (code >> 6));
    out += static_cast<char>(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    out += static_cast<char>(0xe0 | (code >> 12));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
    out += static_cast<char>(0x80 | (code & 0x3f));
  } else {
    out += static_cast<char>(0xf0 | (code >> 18));
    out += static_cast<char>(0x80 | ((code >> 12) & 0x3f));
    out += static_cast<char>(0x80 | ((code >> 6) & 0x3f));
    out += static_cast<char>(0x80 | (code & 0x3f));
  }
}

constexpr std::uint32_t kReplacement = 0xfffd;

/// Reads one UTF-8 character; a broken or overlong sequence costs one byte and gives U+FFFD.
std::uint32_t takeUtf8(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const std::uint32_t first = byte(at++);
  if (first < 0x80) return first;
  const int more = first >= 0xf0 && first < 0xf5   ? 3
                   : first >= 0xe0 && first < 0xf0 ? 2
                   : first >= 0xc2 && first < 0xe0 ? 1
                                                   : 0;
  if (more == 0) return kReplacement;
  std::uint32_t code = first & (0x3fu >> more);
  for (int i = 0; i < more; ++i) {
    const std::uint32_t next = byte(at + static_cast<std::size_t>(i));
    if ((next & 0xc0) != 0x80) return kReplacement;
    code = (code << 6) | (next & 0x3f);
  }
  constexpr std::uint32_t kSmallest[] = {0, 0x80, 0x800, 0x10000};
  if (code < kSmallest[more] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return kReplacement;
  at += static_cast<std::size_t>(more);
  return code;
}

/// The four hex digits after "\u", with `at` on the first of them.
std::uint32_t takeHex(std::string_view text, std::size_t& at) {
  std::uint32_t code = 0;
  for (int i = 0; i < 4 && at < text.size(); ++i) code = 16 * code + static_cast<std::uint32_t>(hexDigit(text[at++]));
  return code;
}

std::uint32_t takeEscape(std::string_view text, std::size_t& at) {
  const char escape = at < text.size() ? text[at++] : '\\';
  switch (escape) {
    case 'b':
      return '\b';
    case 'f':
      return '\f';
    case 'n':
      return '\n';
    case 'r':
      return '\r';
    case 't':
      return '\t';
    case 'u':
      break;
    default:
      return static_cast<unsigned char>(escape);
  }
  const std::uint32_t code = takeHex(text, at);
  if (code < 0xd800 || code > 0xdfff) return code;
  std::size_t next = at + 2;
  if (code < 0xdc00 && text.substr(at, 2) == "\\u" && text.size() - next >= 4) {
    const std::uint32_t low = takeHex(text, next);
    if (low >= 0xdc00 && low <= 0xdfff) {
      at = next;
      return 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
    }
  }
  return kReplacement;
}

}  // namespace

std::string unescapeJson(std::string_view spelled) {
  std::string out;
  out.reserve(spelled.size());
  for (std::size_t at = 0; at < spelled.size();) {
    if (spelled[at] == '\\') {
      ++at;
      appendUtf8(out, takeEscape(spelled, at));
    } else {
      appendUtf8(out, takeUtf8(spelled, at));
    }
  }
  return out;
}

bool keyIs(std::string_view spelled, std::string_view name) {
  if (spelled == name) return true;
  return spelled.find('\\') != spelled.npos && unescapeJson(spelled) == name;
}

std::string quoteJson(std::string_view text) {
  std::string out = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const std::uint32_t code = takeUtf8(text, at);
    if (code == '"' || code == '\\') out += '\\';
    if (code >= 0x20) {
      appendUtf8(out, code);
    } else {
      constexpr char kHex[] = "0123456789abcdef";
      (out += code < 0x10 ? "\\u000" : "\\u001") += kHex[code & 15];
    }
  }
  return out += '"';
}

}  // namespace quadmark
