// SPDX-License-Identifier: MIT
// Conversions between JavaScript values and the core's types, shared by both modules' binding tables.
//
// Every bound function takes typed arrays and plain values and returns a plain object: either its result, or
// { error: { code, message } }. Bytes are copied in both directions, so nothing in JavaScript ever points into the
// module's memory and nothing needs to be deleted.
#pragma once

#include <emscripten/em_asm.h>
#include <emscripten/val.h>

#include <cmath>
#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quadmark/io/model.h"
#include "quadmark/quadmark.h"
#include "quadmark/result.h"

namespace quadmark::wasm {

using emscripten::val;

/// Makes a failed allocation throw a JavaScript error that names it, instead of an anonymous abort. The instance is lost
/// either way; the loader (node/src/load.js) makes a new one for the next call.
inline void installNewHandler() {
  std::set_new_handler([] {
    EM_ASM({ throw new RangeError("out of memory"); });
  });
}

/// Copies a Uint8Array in. The JavaScript side has checked its type.
inline std::vector<std::uint8_t> bytesFrom(const val& array) {
  std::vector<std::uint8_t> bytes(array["length"].as<std::uint32_t>());
  // The view is made after the allocation: growing memory detaches older views.
  if (!bytes.empty()) val(emscripten::typed_memory_view(bytes.size(), bytes.data())).call<void>("set", array);
  return bytes;
}

/// Copies numbers out into a fresh typed array of their type.
template <class T>
val arrayFrom(std::span<const T> values) {
  return val(emscripten::typed_memory_view(values.size(), values.data())).template call<val>("slice");
}

/// [[uri, Uint8Array], ...] <-> Resources.
inline Resources resourcesFrom(const val& entries) {
  Resources resources;
  const std::uint32_t count = entries["length"].as<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    const val entry = entries[i];
    resources.insert_or_assign(entry[0].as<std::string>(), bytesFrom(entry[1]));
  }
  return resources;
}

inline val entriesFrom(const Resources& resources) {
  val entries = val::array();
  for (const auto& [uri, bytes] : resources) {
    val entry = val::array();
    entry.call<void>("push", uri, arrayFrom<std::uint8_t>(bytes));
    entries.call<void>("push", entry);
  }
  return entries;
}

inline bool isPresent(const val& value) { return !value.isUndefined() && !value.isNull(); }

inline val failure(const Error& error) {
  val details = val::object();
  details.set("code", std::string(errorCodeName(error.code)));
  details.set("message", error.message);
  val result = val::object();
  result.set("error", details);
  return result;
}

/// A whole number within [low, high], or the fallback when absent.
inline Result<double> integerFrom(const val& object, const char* name, double fallback, double low, double high) {
  const val value = object[name];
  if (!isPresent(value)) return fallback;
  const double number = value.isNumber() ? value.as<double>() : std::nan("");
  if (!(number >= low && number <= high) || number != std::floor(number)) {
    return Error{ErrorCode::badOption, std::string(name) + ": expected a whole number from " +
                                           std::to_string(static_cast<std::int64_t>(low)) + " to " +
                                           std::to_string(static_cast<std::int64_t>(high))};
  }
  return number;
}

/// A finite number, or the fallback when absent. Its range is the core's to check.
inline Result<double> numberFrom(const val& object, const char* name, double fallback) {
  const val value = object[name];
  if (!isPresent(value)) return fallback;
  const double number = value.isNumber() ? value.as<double>() : std::nan("");
  if (!std::isfinite(number)) return Error{ErrorCode::badOption, std::string(name) + ": expected a finite number"};
  return number;
}

/// An image given as PNG bytes or as { width, height, bits }.
inline Result<BitImage> imageFrom(const val& value) {
  const val bits = value["bits"];
  if (!isPresent(bits)) return decodePng(bytesFrom(value));
  const auto width = integerFrom(value, "width", -1, 1, kMaxImageSide);
  if (!width) return width.error();
  const auto height = integerFrom(value, "height", -1, 1, kMaxImageSide);
  if (!height) return height.error();
  BitImage image{static_cast<std::uint32_t>(*width), static_cast<std::uint32_t>(*height), bytesFrom(bits)};
  const std::size_t pixels = std::size_t{image.width} * image.height;
  if (image.bits.size() != pixels) {
    return Error{ErrorCode::badImage, "image: bits has " + std::to_string(image.bits.size()) + " values, expected " +
                                          std::to_string(pixels) + " (width x height)"};
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    if (image.bits[i] > 1) {
      return Error{ErrorCode::badImage, "image: bits[" + std::to_string(i) + "] is " + std::to_string(image.bits[i]) +
                                            ", expected 0 or 1"};
    }
  }
  return image;
}

inline val imageTo(const BitImage& image) {
  val object = val::object();
  object.set("width", image.width);
  object.set("height", image.height);
  object.set("bits", arrayFrom<std::uint8_t>(image.bits));
  return object;
}

/// 16 hexadecimal digits <-> 64-bit ID. The JavaScript side has checked the digits.
inline std::uint64_t idFrom(const std::string& hex) {
  std::uint64_t id = 0;
  for (const char c : hex) id = id * 16 + static_cast<std::uint64_t>(c <= '9' ? c - '0' : c - 'a' + 10);
  return id;
}

inline std::string idTo(std::uint64_t id) {
  std::string hex(16, '0');
  for (std::size_t i = 16; i-- > 0; id >>= 4) hex[i] = "0123456789abcdef"[id & 15];
  return hex;
}

/// Wraps a JavaScript function (stage, done) => boolean that never throws (node/src/api.js sees to that).
inline Progress progressFrom(const val& callback) {
  if (!isPresent(callback)) return {};
  return [callback](const char* stage, double done) { return callback(std::string(stage), done).as<bool>(); };
}

}  // namespace quadmark::wasm
