// SPDX-License-Identifier: MIT
#include "json_text.h"

#include <cstring>

#include "concat.h"
#include "number_text.h"

namespace quadmark {
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

}  // namespace

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

std::vector<JsonValue> JsonValue::elements() const {
  std::vector<JsonValue> elements;
  forEachElement([&](JsonValue value) { elements.push_back(value); });
  return elements;
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
    return Error{ErrorCode::badFile, concat("JSON byte ", validator.position(), ": ", fault)};
  }
  return JsonValue(root);
}

}  // namespace quadmark
