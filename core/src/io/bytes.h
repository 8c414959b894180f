// SPDX-License-Identifier: MIT
// Unaligned loads and stores of either byte order, and small helpers shared by the file readers.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "quadmark/result.h"

namespace quadmark::io {

using Bytes = std::span<const std::uint8_t>;

enum class ByteOrder : std::uint8_t { little, big };

template <class T>
T reverseBytes(T value) {
  std::uint8_t bytes[sizeof(T)], reversed[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i) reversed[i] = bytes[sizeof(T) - 1 - i];
  std::memcpy(&value, reversed, sizeof(T));
  return value;
}

inline constexpr ByteOrder kHostOrder = std::endian::native == std::endian::little ? ByteOrder::little : ByteOrder::big;

/// Reads a T at any alignment. The caller has checked that sizeof(T) bytes are there.
template <class T>
T load(const std::uint8_t* bytes, ByteOrder order = ByteOrder::little) {
  static_assert(std::is_arithmetic_v<T>);
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return order == kHostOrder ? value : reverseBytes(value);
}

template <class T>
void store(std::uint8_t* bytes, T value, ByteOrder order = ByteOrder::little) {
  static_assert(std::is_arithmetic_v<T>);
  if (order != kHostOrder) value = reverseBytes(value);
  std::memcpy(bytes, &value, sizeof(T));
}

inline std::string_view asText(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline Error badFile(std::string message) {
  return Error{ErrorCode::badFile, std::move(message)};
}
inline Error badMesh(std::string message) {
  return Error{ErrorCode::badMesh, std::move(message)};
}
inline Error unsupportedFile(std::string message) {
  return Error{ErrorCode::unsupportedFile, std::move(message)};
}
inline Error tooLarge(std::string message) {
  return Error{ErrorCode::tooLarge, std::move(message)};
}

/// Text of a file for an error message: in double quotes, at most 40 characters, nothing but printable ASCII.
std::string quoted(std::string_view text);

}  // namespace quadmark::io
