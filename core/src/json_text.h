// SPDX-License-Identifier: MIT
// JSON by place: values are spans of the original text, so that a few of them can be replaced and the rest left exactly
// as its author wrote it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "quadmark/result.h"

namespace quadmark {

/// A value inside a JSON text that parseJson() has accepted, or no value. Two pointers; costs no allocation, and
/// every look-up scans the text again. The text must outlive it.
class JsonValue {
 public:
  enum class Kind : std::uint8_t { absent, null, boolean, number, string, array, object };

  JsonValue() = default;

  [[nodiscard]] Kind kind() const;
  [[nodiscard]] bool isObject() const { return kind() == Kind::object; }
  [[nodiscard]] bool isArray() const { return kind() == Kind::array; }
  [[nodiscard]] bool isString() const { return kind() == Kind::string; }
  explicit operator bool() const { return !text_.empty(); }

  /// The value exactly as spelled, for strings with their quotes.
  [[nodiscard]] std::string_view text() const { return text_; }

  /// Member of an object; the last one where a key is repeated, as JSON.parse has it. Absent otherwise.
  [[nodiscard]] JsonValue find(std::string_view key) const;

  /// Calls visit(value) for each element of an array; nothing for other kinds.
  template <class Visit>
  void forEachElement(Visit&& visit) const {
    if (!isArray()) return;
    for (Scanner scanner(text_); scanner.next();) visit(scanner.value());
  }

  /// Calls visit(key as spelled without quotes, value) for each member of an object; nothing for other kinds.
  template <class Visit>
  void forEachMember(Visit&& visit) const {
    if (!isObject()) return;
    for (Scanner scanner(text_); scanner.nextMember();) visit(scanner.key(), scanner.value());
  }

  [[nodiscard]] std::size_t elementCount() const;

  /// Of an array; none for other kinds.
  [[nodiscard]] std::vector<JsonValue> elements() const;

  /// A number without fraction and not below 0, whatever its spelling (12, 12.0, 1.2e1); nothing for any other value.
  [[nodiscard]] std::optional<std::uint64_t> asUnsigned() const;

  /// A string as valid UTF-8: escapes resolved, broken sequences and lone surrogates replaced by U+FFFD.
  /// Empty for other kinds.
  [[nodiscard]] std::string asString() const;

 private:
  friend Result<JsonValue> parseJson(std::string_view text);
  explicit JsonValue(std::string_view text) : text_(text) {}

  /// Steps through the elements or members of a valid container.
  class Scanner {
   public:
    explicit Scanner(std::string_view container) : at_(container.data() + 1) {}
    bool next();
    bool nextMember();
    [[nodiscard]] std::string_view key() const { return key_; }
    [[nodiscard]] JsonValue value() const { return JsonValue(value_); }

   private:
    bool toItem();
    const char* at_;
    std::string_view key_, value_;
  };

  std::string_view text_;
};

/// Checks a whole JSON text (RFC 8259, UTF-8 not verified) and returns its root value. Uses no recursion. Fails with
/// badFile naming the byte, also for nesting deeper than kDeepestJson.
[[nodiscard]] Result<JsonValue> parseJson(std::string_view text);

inline constexpr std::size_t kDeepestJson = 512;

/// True if a key, as spelled in the text, means `name`.
bool keyIs(std::string_view spelled, std::string_view name);

/// Resolves the escapes of a string as spelled between its quotes, as asString().
std::string unescapeJson(std::string_view spelled);

/// A text as a JSON string with its quotes; broken UTF-8 is replaced by U+FFFD.
std::string quoteJson(std::string_view text);

}  // namespace quadmark
