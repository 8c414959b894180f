// SPDX-License-Identifier: MIT
#include "data_uri.h"

#include "concat.h"
#include "json_text.h"
#include "number_text.h"

namespace quadmark::io {
namespace {

constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

int sextet(char character) {
  if (character >= 'A' && character <= 'Z') return character - 'A';
  if (character >= 'a' && character <= 'z') return character - 'a' + 26;
  if (character >= '0' && character <= '9') return character - '0' + 52;
  if (character == '+') return 62;
  if (character == '/') return 63;
  return -1;
}

/// Steps through the payload: one base64 digit at a time, however it is spelled. Blanks are stepped over.
class Base64Reader {
 public:
  explicit Base64Reader(std::string_view payload) : text_(payload) {}

  enum class Step : std::uint8_t { digit, end, broken };

  Step next() {
    while (at_ < text_.size()) {
      begin_ = at_;
      const char character = take();
      digit_ = sextet(character);
      if (digit_ >= 0) return Step::digit;
      if (character == '=') return onlyPaddingLeft() ? Step::end : Step::broken;
      if (character != ' ' && character != '\t' && character != '\n' && character != '\r' && character != '\f') {
        return Step::broken;
      }
    }
    begin_ = at_;
    return Step::end;
  }

  [[nodiscard]] int digit() const { return digit_; }
  [[nodiscard]] std::size_t begin() const { return begin_; }  // of the last digit's spelling, or of the padding
  [[nodiscard]] std::size_t end() const { return at_; }

 private:
  /// One character of the URI: a JSON escape, a %XX or itself.
  char take() {
    if (text_[at_] == '\\') {
      const std::size_t length = text_.substr(at_, 2) == "\\u" ? 6 : 2;
      const std::string resolved = unescapeJson(text_.substr(at_, length));
      at_ = at_ + length < text_.size() ? at_ + length : text_.size();
      return resolved.size() == 1 ? resolved[0] : '?';
    }
    if (text_[at_] == '%' && text_.size() - at_ >= 3 && hexDigit(text_[at_ + 1]) >= 0 &&
        hexDigit(text_[at_ + 2]) >= 0) {
      const int value = 16 * hexDigit(text_[at_ + 1]) + hexDigit(text_[at_ + 2]);
      at_ += 3;
      return static_cast<char>(value);
    }
    return text_[at_++];
  }

  bool onlyPaddingLeft() {
    while (at_ < text_.size()) {
      const char character = take();
      if (character != '=' && character != ' ' && character != '\n' && character != '\r') return false;
    }
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0, begin_ = 0;
  int digit_ = 0;
};

/// Byte after the comma that ends "data:...;base64,"; 0 if this is not such a URI.
std::size_t payloadBegin(std::string_view spelled) {
  const std::size_t comma = spelled.find(',');
  if (comma == spelled.npos) return 0;
  std::string head = unescapeJson(spelled.substr(0, comma));
  for (char& character : head)
    character = character >= 'A' && character <= 'Z' ? static_cast<char>(character + 32) : character;
  constexpr std::string_view kMark = ";base64";
  if (head.size() < kMark.size() || head.compare(head.size() - kMark.size(), kMark.size(), kMark) != 0) return 0;
  return comma + 1;
}

}  // namespace

bool isDataUri(std::string_view uri) {
  if (uri.size() < 5) return false;
  for (std::size_t i = 0; i < 5; ++i) {
    const char lower = uri[i] >= 'A' && uri[i] <= 'Z' ? static_cast<char>(uri[i] + 32) : uri[i];
    if (lower != "data:"[i]) return false;
  }
  return true;
}

Result<std::vector<std::uint8_t>> decodeDataUri(std::string_view spelled, const std::string& place) {
  const std::size_t begin = payloadBegin(spelled);
  if (begin == 0) return unsupportedFile(place + ": the data URI is not base64");
  std::vector<std::uint8_t> bytes;
  bytes.reserve((spelled.size() - begin) / 4 * 3 + 3);
  Base64Reader reader(spelled.substr(begin));
  std::uint32_t quad = 0;
  std::uint64_t digits = 0;
  for (;;) {
    const Base64Reader::Step step = reader.next();
    if (step == Base64Reader::Step::broken) {
      return badFile(concat(place, ": the data URI's base64 is broken at character ", begin + reader.begin()));
    }
    if (step == Base64Reader::Step::end) break;
    quad = (quad << 6) | static_cast<std::uint32_t>(reader.digit());
    if (++digits % 4 != 0) continue;
    for (int shift = 16; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(quad >> shift));
    quad = 0;
  }
  if (digits % 4 == 1) return badFile(place + ": the data URI's base64 ends with a single digit");
  if (digits % 4 >= 2) bytes.push_back(static_cast<std::uint8_t>(quad >> (digits % 4 == 2 ? 4 : 10)));
  if (digits % 4 == 3) bytes.push_back(static_cast<std::uint8_t>(quad >> 2));
  return bytes;
}

Result<std::string> recodeDataUri(std::string_view spelled, Bytes bytes, const std::string& place) {
  const Result<std::vector<std::uint8_t>> before = decodeDataUri(spelled, place);
  if (!before) return before.error();
  if (before->size() != bytes.size())
    return Error{ErrorCode::internal, place + ": re-encoding another number of bytes"};
  const std::size_t begin = payloadBegin(spelled);
  std::string out(spelled.substr(0, begin));
  out.reserve(spelled.size());
  const std::string_view payload = spelled.substr(begin);
  Base64Reader reader(payload);
  std::size_t copied = 0;
  for (std::uint64_t index = 0; reader.next() == Base64Reader::Step::digit; ++index) {
    const auto group = static_cast<std::size_t>(index / 4 * 3);
    const std::size_t length = bytes.size() - group < 3 ? bytes.size() - group : 3;
    if (std::memcmp(&(*before)[group], &bytes[group], length) == 0) continue;
    std::uint32_t quad = 0;
    for (std::size_t i = 0; i < 3; ++i) quad = (quad << 8) | (i < length ? bytes[group + i] : 0u);
    const std::uint32_t digit = (quad >> (18 - 6 * (index % 4))) & 63;
    if (static_cast<int>(digit) == reader.digit()) continue;
    out.append(payload.substr(copied, reader.begin() - copied));
    out += kAlphabet[digit];
    copied = reader.end();
  }
  out.append(payload.substr(copied));
  return out;
}

}  // namespace quadmark::io
