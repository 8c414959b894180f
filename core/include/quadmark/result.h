// SPDX-License-Identifier: MIT
// Error codes and Result<T>: the only way the core reports failure. The core throws nothing.
#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace quadmark {

/// What went wrong, as one of a closed list shared by the C++ core, the JavaScript API, the CLI's exit status and HTTP.
/// The stable snake_case name of each is given by errorCodeName(). "No mark found" is a result, never an error.
enum class ErrorCode {
  badFile,             ///< not a file of the claimed or any known format, truncated, or self-contradictory
  unsupportedFile,     ///< a valid file that uses a feature this version does not handle
  badMesh,             ///< readable, but without usable geometry (no faces, NaN or infinite positions, zero extent)
  badOption,           ///< an option or parameter is missing, of the wrong type or out of range
  badKey,              ///< the key file is malformed or belongs to another scheme
  badImage,            ///< the watermark image cannot be read or has an unusable size
  capacity,            ///< the model cannot hold the payload even once
  unsupportedVersion,  ///< key file or payload of a newer format version
  tooLarge,            ///< a limit on size was exceeded
  io,                  ///< reading or writing outside the core failed (raised by CLI and server only)
  aborted,             ///< cancelled by the caller
  internal,            ///< a bug in quadmark
};

/// Stable name of a code, for example "unsupported_file". Never empty.
[[nodiscard]] std::string_view errorCodeName(ErrorCode code);

/// A failure: its code and one English sentence naming the place, without trailing period or line break.
struct Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;
};

/// A value or an Error. Test with `if (!result) return result.error();`.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(std::move(error)) {}

  [[nodiscard]] bool ok() const { return value_.has_value(); }
  explicit operator bool() const { return ok(); }

  [[nodiscard]] T& value() & { assert(ok()); return *value_; }
  [[nodiscard]] const T& value() const& { assert(ok()); return *value_; }
  [[nodiscard]] T&& value() && { assert(ok()); return *std::move(value_); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  [[nodiscard]] const Error& error() const { assert(!ok()); return error_; }

 private:
  std::optional<T> value_;  // beside the error, not instead of it: std::variant costs the wasm module more than it saves
  Error error_;
};

/// Result of an operation that returns nothing: `Status s = okStatus();`.
struct Unit {};
using Status = Result<Unit>;
[[nodiscard]] inline Status okStatus() { return Unit{}; }

}  // namespace quadmark
