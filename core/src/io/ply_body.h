// SPDX-License-Identifier: MIT
// Cursors over the body of a PLY file: one reads binary rows, one words of text. Both hand out scalars through the same
// calls, so that the reader is written once. A failing call leaves the cursor's error set.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "concat.h"
#include "number_text.h"
#include "ply_header.h"

namespace quadmark::io {

/// Why a value could not be read; which value is known to the caller.
enum class PlyFault : std::uint8_t { none, truncated, notANumber, listTooLong };

/// Reads a list's length and checks it against the bytes left.
template <class Cursor>
bool readListLength(Cursor& cursor, const PlyProperty& property, std::uint64_t& length) {
  std::int64_t value = 0;
  if (!cursor.readInteger(property.countType, value)) return false;
  length = static_cast<std::uint64_t>(value);
  if (value >= 0 && length <= cursor.itemsLeft(property.type)) return true;
  return cursor.fail(PlyFault::listTooLong);
}

/// Skips one property of one row, list or scalar.
template <class Cursor>
bool skipProperty(Cursor& cursor, const PlyProperty& property) {
  std::uint64_t count = 1;
  if (property.isList && !readListLength(cursor, property, count)) return false;
  return cursor.skip(property.type, count);
}

class BinaryPlyCursor {
 public:
  BinaryPlyCursor(Bytes file, const PlyHeader& header)
      : file_(file.data()),
        at_(file.data() + header.bodyBegin),
        end_(file.data() + file.size()),
        order_(header.order()) {}

  [[nodiscard]] std::size_t position() const { return static_cast<std::size_t>(at_ - file_); }
  [[nodiscard]] const std::uint8_t* current() const { return at_; }
  [[nodiscard]] ByteOrder order() const { return order_; }
  [[nodiscard]] std::uint64_t bytesLeft() const { return static_cast<std::uint64_t>(end_ - at_); }
  [[nodiscard]] PlyFault fault() const { return fault_; }
  [[nodiscard]] std::string place() const { return concat("byte ", position()); }
  [[nodiscard]] std::string_view lastText() const { return {}; }

  /// Upper bound of the list items that can still follow.
  [[nodiscard]] std::uint64_t itemsLeft(PlyType type) const { return bytesLeft() / sizeBytes(type); }

  bool skip(PlyType type, std::uint64_t count) {
    if (count > itemsLeft(type)) return fail(PlyFault::truncated);
    at_ += count * sizeBytes(type);
    return true;
  }

  /// Skips whole rows without lists at once.
  bool skipRows(const PlyElement& element) {
    if (element.rowBytes != 0 && element.count > bytesLeft() / element.rowBytes) return fail(PlyFault::truncated);
    at_ += element.count * element.rowBytes;
    return true;
  }

  bool readInteger(PlyType type, std::int64_t& value) {
    const std::uint8_t* bytes = take(sizeBytes(type));
    if (bytes == nullptr) return false;
    switch (type) {
      case PlyType::int8:
        value = load<std::int8_t>(bytes);
        break;
      case PlyType::uint8:
        value = load<std::uint8_t>(bytes);
        break;
      case PlyType::int16:
        value = load<std::int16_t>(bytes, order_);
        break;
      case PlyType::uint16:
        value = load<std::uint16_t>(bytes, order_);
        break;
      case PlyType::int32:
        value = load<std::int32_t>(bytes, order_);
        break;
      case PlyType::uint32:
        value = load<std::uint32_t>(bytes, order_);
        break;
      default:
        return fail(PlyFault::notANumber);
    }
    return true;
  }

  bool readFloating(PlyType type, double& value) {
    const std::uint8_t* bytes = take(sizeBytes(type));
    if (bytes == nullptr) return false;
    value = type == PlyType::float32 ? double{load<float>(bytes, order_)} : load<double>(bytes, order_);
    return true;
  }

  bool fail(PlyFault fault) {
    fault_ = fault;
    return false;
  }

 private:
  const std::uint8_t* take(std::size_t count) {
    if (static_cast<std::size_t>(end_ - at_) < count) {
      fault_ = PlyFault::truncated;
      return nullptr;
    }
    const std::uint8_t* bytes = at_;
    at_ += count;
    return bytes;
  }

  const std::uint8_t* file_;
  const std::uint8_t* at_;
  const std::uint8_t* end_;
  ByteOrder order_;
  PlyFault fault_ = PlyFault::none;
};

class TextPlyCursor {
 public:
  TextPlyCursor(Bytes file, const PlyHeader& header)
      : file_(file.data()),
        body_(file.data() + header.bodyBegin),
        at_(file.data() + header.bodyBegin),
        end_(file.data() + file.size()) {}

  /// Position after the last word read.
  [[nodiscard]] std::size_t position() const { return static_cast<std::size_t>(at_ - file_); }
  [[nodiscard]] PlyFault fault() const { return fault_; }
  [[nodiscard]] std::string_view lastText() const { return last_; }

  /// The line of the last word, counted from the file's beginning.
  [[nodiscard]] std::string place() const {
    const auto* lastByte = last_.empty() ? at_ : reinterpret_cast<const std::uint8_t*>(last_.data());
    bool lineFeeds = false;
    for (const std::uint8_t* byte = file_; byte < body_ && !lineFeeds; ++byte) lineFeeds = *byte == '\n';
    std::size_t line = 1;
    for (const std::uint8_t* byte = file_; byte < lastByte; ++byte) line += *byte == (lineFeeds ? '\n' : '\r') ? 1 : 0;
    return concat("line ", line);
  }

  [[nodiscard]] std::uint64_t itemsLeft(PlyType) const { return (static_cast<std::uint64_t>(end_ - at_) + 1) / 2; }

  /// The next word, empty at the end.
  std::string_view word() {
    while (at_ < end_ && isBlank(*at_)) ++at_;
    const std::uint8_t* begin = at_;
    while (at_ < end_ && !isBlank(*at_)) ++at_;
    last_ = {reinterpret_cast<const char*>(begin), static_cast<std::size_t>(at_ - begin)};
    if (last_.empty()) fault_ = PlyFault::truncated;
    return last_;
  }

  bool skip(PlyType, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (word().empty()) return false;
    }
    return true;
  }

  bool skipRows(const PlyElement& element) {
    for (std::uint64_t row = 0; row < element.count && !element.properties.empty(); ++row) {
      if (!skip(PlyType::uint8, element.properties.size())) return false;
    }
    return true;
  }

  bool readInteger(PlyType type, std::int64_t& value) {
    const std::string_view text = word();
    if (text.empty()) return false;
    const std::optional<std::int64_t> number = parseInteger(text);
    if (!number || isFloating(type)) return fail(PlyFault::notANumber);
    value = *number;
    return true;
  }

  bool readFloating(PlyType type, double& value) {
    const std::string_view text = word();
    if (text.empty()) return false;
    return parseText(type, text, value) || fail(PlyFault::notANumber);
  }

  /// The value a word has in a property of a floating type: rounded once, to that type.
  static bool parseText(PlyType type, std::string_view text, double& value) {
    if (type == PlyType::float32) {
      const std::optional<float> number = parseFloat(text);
      if (number) value = *number;
      return number.has_value();
    }
    const std::optional<double> number = parseDouble(text);
    if (number) value = *number;
    return number.has_value();
  }

  bool fail(PlyFault fault) {
    fault_ = fault;
    return false;
  }

  static bool isBlank(std::uint8_t byte) { return byte == ' ' || (byte >= '\t' && byte <= '\r'); }

 private:
  const std::uint8_t* file_;
  const std::uint8_t* body_;
  const std::uint8_t* at_;
  const std::uint8_t* end_;
  std::string_view last_;
  PlyFault fault_ = PlyFault::none;
};

}  // namespace quadmark::io
