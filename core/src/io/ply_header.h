// SPDX-License-Identifier: MIT
// The text header of a PLY file: encoding, elements and their properties.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bytes.h"

namespace quadmark::io {

enum class PlyEncoding : std::uint8_t { ascii, littleEndian, bigEndian };

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

inline bool isFloating(PlyType type) {
  return type == PlyType::float32 || type == PlyType::float64;
}
std::uint32_t sizeBytes(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::uint8;  ///< of the scalar or of the list's items
  bool isList = false;
  PlyType countType = PlyType::uint8;  ///< of the list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  bool hasList = false;
  std::uint64_t rowBytes = 0;  ///< in a binary file: size of a row without list items, so exact if !hasList

  /// Index of the first property of that name, or -1.
  [[nodiscard]] int find(std::string_view propertyName) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::string variant;  ///< "ascii 1.0", ...
  std::vector<PlyElement> elements;
  std::size_t bodyBegin = 0;  ///< byte after the header's last line break

  [[nodiscard]] ByteOrder order() const {
    return encoding == PlyEncoding::bigEndian ? ByteOrder::big : ByteOrder::little;
  }
  [[nodiscard]] const PlyElement* find(std::string_view name) const;
};

/// Parses up to and including end_header; errors name the line. Lines may end in LF, CR LF or (then all of them) CR.
/// Every element's count is checked against the bytes that are left, so later code may trust its order of magnitude.
Result<PlyHeader> parsePlyHeader(Bytes file);

}  // namespace quadmark::io
