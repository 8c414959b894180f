// SPDX-License-Identifier: MIT
#include "json_writer.h"

#include <cmath>

#include "json_text.h"
#include "number_text.h"

namespace quadmark {

void JsonWriter::key(std::string_view name) {
  beginItem();
  text_ += quoteJson(name);
  text_ += layout_ == Layout::indented ? ": " : ":";
}

void JsonWriter::value(std::string_view text) {
  append(quoteJson(text));
}

void JsonWriter::value(const std::vector<std::string>& texts) {
  beginArray();
  for (const std::string& text : texts) value(text);
  endArray();
}

void JsonWriter::value(double number) {
  append(std::isfinite(number) ? formatShortest(number) : "null");
}

void JsonWriter::open(char bracket) {
  beginItem();
  text_ += bracket;
  ++depth_;
}

void JsonWriter::close(char bracket) {
  --depth_;
  if (text_.back() != '{' && text_.back() != '[') breakLine();
  text_ += bracket;
}

void JsonWriter::append(std::string_view spelled) {
  beginItem();
  text_ += spelled;
}

/// The comma before every item but the first of its container. Outside strings, a colon or blank ends a key.
void JsonWriter::beginItem() {
  if (text_.empty() || text_.back() == ':' || text_.back() == ' ') return;
  if (text_.back() != '{' && text_.back() != '[') text_ += ',';
  breakLine();
}

void JsonWriter::breakLine() {
  if (layout_ == Layout::oneLine) return;
  text_ += '\n';
  text_.append(2 * depth_, ' ');
}

}  // namespace quadmark
