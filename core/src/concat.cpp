// SPDX-License-Identifier: MIT
#include "concat.h"

namespace quadmark {

TextPiece::TextPiece(const std::string& text) : TextPiece(std::string_view(text)) {}

void TextPiece::appendTo(std::string& out) const {
  switch (kind_) {
    case Kind::text:
      out.append(text_, static_cast<std::size_t>(number_));
      return;
    case Kind::character:
      out += static_cast<char>(number_);
      return;
    case Kind::negative:
      out += '-';
      [[fallthrough]];
    case Kind::number:
      out += std::to_string(number_);
  }
}

std::string concat(std::initializer_list<TextPiece> pieces) {
  std::string out;
  for (const TextPiece& piece : pieces) piece.appendTo(out);
  return out;
}

}  // namespace quadmark
