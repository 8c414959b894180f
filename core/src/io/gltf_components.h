// SPDX-License-Identifier: MIT
// Components of glTF accessors: their types, what they mean, and the numbers that integer types can store.
#pragma once

#include <cmath>
#include <optional>

#include "bytes.h"
#include "quadmark/mesh.h"

namespace quadmark::io {

inline constexpr std::uint32_t kGltfInt8 = 5120, kGltfUint8 = 5121, kGltfInt16 = 5122, kGltfUint16 = 5123,
                               kGltfUint32 = 5125, kGltfFloat = 5126;

inline std::uint32_t componentBytes(std::uint32_t type) {
  return type <= kGltfUint8 ? 1 : type <= kGltfUint16 ? 2 : 4;
}

/// How positions are stored (KHR_mesh_quantization).
struct PositionType {
  std::uint32_t component = kGltfFloat;
  bool normalized = false;

  [[nodiscard]] std::uint32_t bytes() const { return 3 * componentBytes(component); }
  [[nodiscard]] bool operator==(const PositionType& other) const = default;

  /// Of integer components.
  [[nodiscard]] std::optional<CoordinateGrid> grid() const {
    if (component == kGltfFloat) return std::nullopt;
    const bool isSigned = component == kGltfInt8 || component == kGltfInt16;
    const double bits = 8 * componentBytes(component) - (isSigned ? 1 : 0);
    const double high = bits == 7 ? 127 : bits == 8 ? 255 : bits == 15 ? 32767 : 65535;
    // Of a normalized type the lowest code means the same as the next one: -1.
    return CoordinateGrid{normalized ? high : 1, !isSigned ? 0 : normalized ? -high : -high - 1, high};
  }
};

/// Calls action(T{}) with the C++ type of a position's component.
template <class Action>
auto withComponent(std::uint32_t type, const Action& action) {
  switch (type) {
    case kGltfInt8:
      return action(std::int8_t{});
    case kGltfUint8:
      return action(std::uint8_t{});
    case kGltfInt16:
      return action(std::int16_t{});
    case kGltfUint16:
      return action(std::uint16_t{});
    default:
      return action(float{});
  }
}

/// The coordinate that a stored code means.
/// @param divisor  of the grid; 1 for floats.
template <class T>
double decodeComponent(T code, double divisor) {
  const double value = code / divisor;
  return divisor != 1 && value < -1 ? -1 : value;
}

/// The code for a coordinate that its type can store; `before`, the present code, where that means the same.
template <class T>
T encodeComponent(double value, T before, double divisor) {
  if (decodeComponent(before, divisor) == value) return before;
  if constexpr (std::is_floating_point_v<T>) return static_cast<T>(value);
  return static_cast<T>(std::floor(value * divisor + 0.5));
}

}  // namespace quadmark::io
