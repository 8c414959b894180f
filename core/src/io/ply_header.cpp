// SPDX-License-Identifier: MIT
#include "ply_header.h"

#include <optional>

#include "concat.h"
#include "number_text.h"

namespace quadmark::io {
namespace {

std::optional<PlyType> typeByName(std::string_view name) {
  constexpr struct {
    std::string_view oldName, newName;
    PlyType type;
  } kNames[] = {
      {"char", "int8", PlyType::int8},        {"uchar", "uint8", PlyType::uint8},
      {"short", "int16", PlyType::int16},     {"ushort", "uint16", PlyType::uint16},
      {"int", "int32", PlyType::int32},       {"uint", "uint32", PlyType::uint32},
      {"float", "float32", PlyType::float32}, {"double", "float64", PlyType::float64},
  };
  for (const auto& entry : kNames) {
    if (name == entry.oldName || name == entry.newName) return entry.type;
  }
  return std::nullopt;
}

/// Hands out the header's lines and their words.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {
    const std::size_t firstBreak = text.find_first_of("\r\n");
    const bool lineFeed = firstBreak == text.npos || text[firstBreak] == '\n' || text.substr(firstBreak, 2) == "\r\n";
    terminator_ = lineFeed ? '\n' : '\r';
  }

  /// False at the end of the file; a last line without line break is not a line.
  bool next() {
    const std::size_t end = text_.find(terminator_, at_);
    if (end == text_.npos) return false;
    rest_ = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    return true;
  }

  std::string_view word() {
    constexpr std::string_view kBlank = " \t\r";
    const std::size_t begin = rest_.find_first_not_of(kBlank);
    if (begin == rest_.npos) {
      rest_ = {};
      return {};
    }
    const std::size_t end = rest_.find_first_of(kBlank, begin);
    const std::string_view found = rest_.substr(begin, end == rest_.npos ? end : end - begin);
    rest_ = end == rest_.npos ? std::string_view{} : rest_.substr(end);
    return found;
  }

  [[nodiscard]] std::size_t position() const { return at_; }
  [[nodiscard]] Error error(const std::string& what) const {
    return badFile(concat("PLY header line ", number_, ": ", what));
  }

 private:
  std::string_view text_, rest_;
  char terminator_ = '\n';
  std::size_t at_ = 0;
  std::size_t number_ = 0;
};

Status parseFormat(LineReader& line, PlyHeader& header) {
  const std::string_view encoding = line.word();
  const std::string_view version = line.word();
  if (encoding == "ascii") {
    header.encoding = PlyEncoding::ascii;
  } else if (encoding == "binary_little_endian") {
    header.encoding = PlyEncoding::littleEndian;
  } else if (encoding == "binary_big_endian") {
    header.encoding = PlyEncoding::bigEndian;
  } else {
    return line.error("unknown format " + quoted(encoding));
  }
  if (version != "1.0") return unsupportedFile(line.error("PLY version " + quoted(version)).message);
  header.variant = std::string(encoding) + " 1.0";
  return okStatus();
}

Status parseElement(LineReader& line, PlyHeader& header) {
  PlyElement element;
  element.name = std::string(line.word());
  const std::string_view countText = line.word();
  const std::optional<std::int64_t> count = parseInteger(countText);
  if (element.name.empty()) return line.error("element without a name");
  if (!count || *count < 0) return line.error(concat("element count ", quoted(countText), " is not a number of rows"));
  element.count = static_cast<std::uint64_t>(*count);
  const bool onlyOnce = element.name == "vertex" || element.name == "face" || element.name == "tristrips";
  if (onlyOnce && header.find(element.name) != nullptr) {
    return line.error(concat("element ", quoted(element.name), " appears twice"));
  }
  header.elements.push_back(std::move(element));
  return okStatus();
}

Status parseProperty(LineReader& line, PlyHeader& header) {
  if (header.elements.empty()) return line.error("property before the first element");
  PlyElement& element = header.elements.back();
  PlyProperty property;
  std::string_view typeName = line.word();
  if (typeName == "list") {
    property.isList = true;
    element.hasList = true;
    const std::string_view countName = line.word();
    const std::optional<PlyType> countType = typeByName(countName);
    if (!countType || isFloating(*countType)) {
      return line.error(concat("list length type ", quoted(countName), " is not an integer type"));
    }
    property.countType = *countType;
    typeName = line.word();
  }
  const std::optional<PlyType> type = typeByName(typeName);
  if (!type) return line.error("unknown property type " + quoted(typeName));
  property.type = *type;
  property.name = std::string(line.word());
  if (property.name.empty()) return line.error("property without a name");
  const bool isCoordinate = property.name == "x" || property.name == "y" || property.name == "z";
  if (element.name == "vertex" && isCoordinate && element.find(property.name) >= 0) {
    return line.error(concat("property ", quoted(property.name), " appears twice"));
  }
  element.rowBytes += sizeBytes(property.isList ? property.countType : property.type);
  element.properties.push_back(std::move(property));
  return okStatus();
}

/// Checks that the rows an element claims can exist in the bytes left, whatever their lists hold.
Status checkCounts(const PlyHeader& header, std::uint64_t bytesLeft) {
  for (const PlyElement& element : header.elements) {
    // In a text file every value takes a character and a separator; the last one may lack the separator.
    const bool ascii = header.encoding == PlyEncoding::ascii;
    const std::uint64_t rowBytes = ascii ? 2 * std::uint64_t{element.properties.size()} : element.rowBytes;
    const std::uint64_t available = ascii ? bytesLeft + 1 : bytesLeft;
    if (rowBytes == 0) continue;
    if (element.count > available / rowBytes) {
      return badFile(concat("PLY element ", quoted(element.name), ": ", element.count, " rows of at least ", rowBytes,
                            " bytes do not fit into the remaining ", bytesLeft, " bytes"));
    }
    bytesLeft = available - element.count * rowBytes;
  }
  return okStatus();
}

}  // namespace

std::uint32_t sizeBytes(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 8;
}

int PlyElement::find(std::string_view propertyName) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == propertyName) return static_cast<int>(i);
  }
  return -1;
}

const PlyElement* PlyHeader::find(std::string_view name) const {
  for (const PlyElement& element : elements) {
    if (element.name == name) return &element;
  }
  return nullptr;
}

Result<PlyHeader> parsePlyHeader(Bytes file) {
  PlyHeader header;
  LineReader line(asText(file));
  if (!line.next() || line.word() != "ply") return badFile("PLY: the first line is not \"ply\"");
  for (bool formatSeen = false; line.next();) {
    const std::string_view keyword = line.word();
    Status status = okStatus();
    if (keyword == "format") {
      status = parseFormat(line, header);
      formatSeen = true;
    } else if (keyword == "element") {
      status = parseElement(line, header);
    } else if (keyword == "property") {
      status = parseProperty(line, header);
    } else if (keyword == "end_header") {
      if (!formatSeen) return line.error("the header has no format line");
      header.bodyBegin = line.position();
      if (Status counts = checkCounts(header, file.size() - header.bodyBegin); !counts) return counts.error();
      return header;
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      return line.error("unknown keyword " + quoted(keyword));
    }
    if (!status) return status.error();
  }
  return badFile("PLY: the header has no end_header line");
}

}  // namespace quadmark::io
