// SPDX-License-Identifier: MIT
// Messages from pieces of text and numbers. One call each: chains of + made a quarter of the file readers' code.
#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace quadmark {

/// A text, a character or an integer; refers to a text's characters.
class TextPiece {
 public:
  TextPiece(const char* text) : TextPiece(std::string_view(text)) {}
  TextPiece(const std::string& text);
  TextPiece(std::string_view text) : kind_(Kind::text), text_(text.data()), number_(text.size()) {}
  TextPiece(char character) : kind_(Kind::character), number_(static_cast<unsigned char>(character)) {}
  TextPiece(std::unsigned_integral auto number) : kind_(Kind::number), number_(number) {}
  TextPiece(std::signed_integral auto number)
      : kind_(number < 0 ? Kind::negative : Kind::number),
        number_(number < 0 ? 0 - static_cast<std::uint64_t>(number) : static_cast<std::uint64_t>(number)) {}

  void appendTo(std::string& out) const;

 private:
  enum class Kind : std::uint8_t { text, character, number, negative };
  Kind kind_;
  const char* text_ = nullptr;
  std::uint64_t number_;  ///< of a text its length, of a negative number its magnitude
};

/// The pieces one after the other.
[[nodiscard]] std::string concat(std::initializer_list<TextPiece> pieces);

template <class... Pieces>
[[nodiscard]] std::string concat(const Pieces&... pieces) {
  return concat({TextPiece(pieces)...});
}

}  // namespace quadmark
