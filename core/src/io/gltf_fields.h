// SPDX-License-Identifier: MIT
// Typed access to the members of glTF objects, with one error that remembers the first thing that was wrong.
#pragma once

#include <optional>
#include <string>

#include "bytes.h"
#include "concat.h"
#include "json_text.h"

namespace quadmark::io {

inline constexpr std::uint64_t kLargestJsonInteger = std::uint64_t{1} << 53;

/// Reads unsigned members of one object, `place` being its name in messages ("accessor 3").
class FieldReader {
 public:
  FieldReader(JsonValue object, std::string place) : object_(object), place_(std::move(place)) {
    if (!object.isObject()) fail("is not an object");
  }

  /// A missing member has the value `fallback`.
  std::uint64_t optional(std::string_view name, std::uint64_t fallback, std::uint64_t largest = kLargestJsonInteger) {
    const JsonValue value = object_.find(name);
    return value ? check(name, value, largest) : fallback;
  }

  std::uint64_t required(std::string_view name, std::uint64_t largest = kLargestJsonInteger) {
    const JsonValue value = object_.find(name);
    if (!value) fail("has no " + std::string(name));
    return value ? check(name, value, largest) : 0;
  }

  void fail(const std::string& what) {
    if (!error_) error_ = badFile(concat(place_, " ", what));
  }

  /// Takes another reader's error over, if it has one.
  void adopt(const FieldReader& other) {
    if (!error_) error_ = other.error_;
  }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  std::uint64_t check(std::string_view name, JsonValue value, std::uint64_t largest) {
    const std::optional<std::uint64_t> number = value.asUnsigned();
    if (number && *number <= largest) return *number;
    fail(concat(name, " is ", quoted(value.text()), ", expected an integer from 0 to ", largest));
    return 0;
  }

  JsonValue object_;
  std::string place_;
  std::optional<Error> error_;
};

}  // namespace quadmark::io
