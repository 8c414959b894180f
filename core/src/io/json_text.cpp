// SPDX-License-Identifier: MIT
#include "json_text.h"

#include <cstring>

#include "bytes.h"
#include "number_text.h"

namespace quadmark::io {
namespace {

bool isBlank(char character) {
  return character == ' ' || character == '\t' || character == '\n' || character == '\r';
}

const char* skipBlank(const char* at) {
  while (isBlank(*at)) ++at;
  return at;
}

/// From the opening quote of a valid string to the byte after its closing quote.
const char* skipString(const char* at) {
  for (++at; *at != '"'; ++at) {
    if (*at == '\\') ++at;
  }
  return at + 1;
}

/// From the first byte of a valid value that is followed by at least one more byte to the byte after it.
const char* skipValue(const char* at) {
  if (*at == '"') return skipString(at);
  if (*at != '{' && *at != '[') {
    while (*at != ',' && *at != '}' && *at != ']' && !isBlank(*at)) ++at;
    return at;
  }
  std::size_t depth = 0;
  do {
    if (*at == '"') {
      at = skipString(at);
      continue;
    }
    if (*at == '{' || *at == '[') ++depth;
    if (*at == '}' || *at == ']') --depth;
    ++at;
  } while (depth > 0);
  return at;
}

/// The grammar, one value after the other with an explicit stack of open containers.
class Validator {
 public:
  explicit Validator(std::string_view text) : text_(text) {}

  /// Empty if valid; otherwise what is wrong at position().
  std::string_view run(std::string_view& root) {
    blank();
    const std::size_t begin = at_;
    if (at_ == text_.size()) return "the text is empty";
    bool valueExpected = true;
    do {
      const std::string_view fault = valueExpected ? beginValue(valueExpected) : afterValue(valueExpected);
      if (!fault.empty()) return fault;
    } while (valueExpected || !open_.empty());
    root = text_.substr(begin, at_ - begin);
    blank();
    return at_ == text_.size() ? "" : "unexpected text after the end";
  }

  [[nodiscard]] std::size_t position() const { return at_; }

 private:
  [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void blank() {
    while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
  }

  std::string_view beginValue(bool& valueExpected) {
    blank();
    const char first = peek();
    if (first == '{' || first == '[') {
      if (open_.size() == kDeepestJson) return "nested too deep";
      ++at_;
      blank();
      const char close = first == '{' ? '}' : ']';
      if (peek() == close) {
        ++at_;
        valueExpected = false;
        return "";
      }
      open_.push_back(close);
      return first == '{' ? key() : "";
    }
    valueExpected = false;
    if (first == '"') return string();
    if (first == '-' || (first >= '0' && first <= '9')) return number();
    for (const std::string_view literal : {"true", "false", "null"}) {
      if (text_.substr(at_, literal.size()) == literal) {
        at_ += literal.size();
        return "";
      }
    }
    return "a value is expected";
  }

  std::string_view afterValue(bool& valueExpected) {
    blank();
    if (peek() == open_.back()) {
      ++at_;
      open_.pop_back();
      return "";
    }
    if (peek() != ',') return open_.back() == '}' ? "',' or '}' is expected" : "',' or ']' is expected";
    ++at_;
    valueExpected = true;
    return open_.back() == '}' ? key() : "";
  }

  std::string_view key() {
    blank();
    if (peek() != '"') return "a key is expected";
    if (const std::string_view fault = string(); !fault.empty()) return fault;
    blank();
    if (peek() != ':') return "':' is expected";
    ++at_;
    return "";
  }

  std::string_view string() {
    for (++at_; at_ < text_.size(); ++at_) {
      const char character = text_[at_];
      if (character == '"') {
        ++at_;
        return "";
      }
      if (static_cast<unsigned char>(character) < 0x20) return "control character in a string";
      if (character != '\\') continue;
      ++at_;
      const char escape = peek();
      if (escape == 'u') {
        for (int i = 0; i < 4; ++i) {
          ++at_;
          if (hexDigit(peek()) < 0) return "broken \\u escape";
        }
      } else if (escape == '\0' || std::strchr("\"\\/bfnrt", escape) == nullptr) {
        return "unknown escape";
      }
    }
    return "unterminated string";
  }

  bool digits() {
    const std::size_t begin = at_;
    while (peek() >= '0' && peek() <= '9') ++at_;
    return at_ > begin;
  }

  std::string_view number() {
    if (peek() == '-') ++at_;
    if (peek() == '0') {
      ++at_;
    } else if (!digits()) {
      return "a digit is expected";
    }
    if (peek() == '.') {
      ++at_;
      if (!digits()) return "a digit is expected after the point";
    }
    if (peek() == 'e' || peek() == 'E') {
      ++at_;
      if (peek() == '+' || peek() == '-') ++at_;
      if (!digits()) return "a digit is expected in the exponent";
    }
    return "";
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string open_;  // the closing brackets to come
};

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

bool JsonValue::Scanner::toItem() {
  at_ = skipBlank(at_);
  if (*at_ == ',') at_ = skipBlank(at_ + 1);
  return *at_ != ']' && *at_ != '}';
}

bool JsonValue::Scanner::next() {
  if (!toItem()) return false;
  const char* end = skipValue(at_);
  value_ = {at_, static_cast<std::size_t>(end - at_)};
  at_ = end;
  return true;
}

bool JsonValue::Scanner::nextMember() {
  if (!toItem()) return false;
  const char* end = skipString(at_);
  key_ = {at_ + 1, static_cast<std::size_t>(end - at_ - 2)};
  at_ = skipBlank(skipBlank(end) + 1);  // the colon
  return next();
}

JsonValue::Kind JsonValue::kind() const {
  if (text_.empty()) return Kind::absent;
  switch (text_[0]) {
    case '{':
      return Kind::object;
    case '[':
      return Kind::array;
    case '"':
      return Kind::string;
    case 't':
    case 'f':
      return Kind::boolean;
    case 'n':
      return Kind::null;
    default:
      return Kind::number;
  }
}

JsonValue JsonValue::find(std::string_view key) const {
  JsonValue found;
  forEachMember([&](std::string_view spelled, JsonValue value) {
    if (keyIs(spelled, key)) found = value;
  });
  return found;
}

std::size_t JsonValue::elementCount() const {
  std::size_t count = 0;
  forEachElement([&](JsonValue) { ++count; });
  return count;
}

std::optional<std::uint64_t> JsonValue::asUnsigned() const {
  if (kind() != Kind::number) return std::nullopt;
  if (const std::optional<std::int64_t> integer = parseInteger(text_)) {
    if (*integer < 0) return std::nullopt;
    return static_cast<std::uint64_t>(*integer);
  }
  constexpr double kLargestExact = 9007199254740992.0;  // 2^53
  const std::optional<double> number = parseDouble(text_);
  if (!number || !(*number >= 0) || *number > kLargestExact) return std::nullopt;
  const auto integer = static_cast<std::uint64_t>(*number);
  if (static_cast<double>(integer) != *number) return std::nullopt;
  return integer;
}

std::string JsonValue::asString() const {
  if (!isString()) return {};
  return unescapeJson(text_.substr(1, text_.size() - 2));
}

Result<JsonValue> parseJson(std::string_view text) {
  Validator validator(text);
  std::string_view root;
  const std::string_view fault = validator.run(root);
  if (!fault.empty()) {
    return Error{ErrorCode::badFile, "JSON byte " + std::to_string(validator.position()) + ": " + std::string(fault)};
  }
  return JsonValue(root);
}

}  // namespace quadmark::io
