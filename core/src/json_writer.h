// SPDX-License-Identifier: MIT
// Writes JSON, member by member in the order of the calls.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quadmark {

/// The caller closes what it opens. Strings that are not UTF-8 are repaired as quoteJson() does; numbers that are not
/// finite become null, since JSON has neither infinity nor NaN.
class JsonWriter {
 public:
  enum class Layout { oneLine, indented };
  explicit JsonWriter(Layout layout = Layout::oneLine) : layout_(layout) {}

  void beginObject() { open('{'); }
  void beginArray() { open('['); }
  void endObject() { close('}'); }
  void endArray() { close(']'); }

  /// The key of the next value; inside objects only.
  void key(std::string_view name);

  void value(std::string_view text);
  void value(const char* text) { value(std::string_view(text)); }
  void value(const std::vector<std::string>& texts);
  void value(bool truth) { append(truth ? "true" : "false"); }
  void value(double number);
  void value(std::integral auto number) { append(std::to_string(number)); }
  void null() { append("null"); }
  /// null for nothing.
  template <class T>
  void value(const std::optional<T>& content) {
    if (content) {
      value(*content);
    } else {
      null();
    }
  }

  template <class T>
  void member(std::string_view name, const T& content) {
    key(name);
    value(content);
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void open(char bracket);
  void close(char bracket);
  void append(std::string_view spelled);
  void beginItem();
  void breakLine();

  Layout layout_;
  std::string text_;
  std::size_t depth_ = 0;
};

}  // namespace quadmark
