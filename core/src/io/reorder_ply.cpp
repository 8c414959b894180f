// SPDX-License-Identifier: MIT
// Reordering the vertices of a PLY: first the indices are rewritten where they stand, then the vertex rows change
// places.
#include <algorithm>

#include "concat.h"
#include "ply_body.h"
#include "ply_model.h"
#include "reorder_order.h"

namespace quadmark::io {
namespace {

Error notTheFile() {
  return Error{ErrorCode::badOption, "reorder: these are not the bytes that were read"};
}

/// Properties that hold numbers of vertices: the lists of faces, strips and polylines, the two ends of an edge.
bool isReference(const PlyProperty& property) {
  if (isFloating(property.type)) return false;
  const std::string& name = property.name;
  if (name == "vertex_indices" || name == "vertex_index") return true;
  return !property.isList && (name == "vertex1" || name == "vertex2");
}

/// Integers that perhaps are numbers of vertices, too. Texture coordinates of their own
/// ("multi_texture_vertex_indices") are not.
bool mayBeReference(const PlyElement& element, const PlyProperty& property) {
  if (isFloating(property.type) || property.name.find("texture") != std::string::npos) return false;
  if (element.name == "edge") return property.name.size() <= 2;  // "a", "b", "v1", "v2"
  return property.name.find("vert") != std::string::npos;
}

bool hasReference(const PlyElement& element) {
  return std::any_of(element.properties.begin(), element.properties.end(), isReference);
}

/// New numbers for old ones. What is no vertex (the -1 that restarts a strip) stays.
class Renumbering {
 public:
  explicit Renumbering(std::span<const std::uint32_t> newOf) : newOf_(newOf) {}

  [[nodiscard]] std::int64_t operator()(std::int64_t vertex) const {
    const bool known = vertex >= 0 && static_cast<std::uint64_t>(vertex) < newOf_.size();
    return known ? std::int64_t{newOf_[static_cast<std::size_t>(vertex)]} : vertex;
  }

 private:
  std::span<const std::uint32_t> newOf_;
};

/// The file with indices overwritten in place.
class BinaryOutput {
 public:
  BinaryOutput(Bytes file, ByteOrder order) : bytes_(file.begin(), file.end()), order_(order) {}

  bool renumber(BinaryPlyCursor& cursor, PlyType type, const Renumbering& newNumber) {
    const std::size_t at = cursor.position();
    std::int64_t vertex = 0;
    if (!cursor.readInteger(type, vertex)) return false;
    const std::int64_t to = newNumber(vertex);
    std::uint8_t* bytes = &bytes_[at];
    // It fits: orderFreedom() sees to it that the type can hold every vertex.
    if (sizeBytes(type) == 1) store(bytes, static_cast<std::uint8_t>(to), order_);
    if (sizeBytes(type) == 2) store(bytes, static_cast<std::uint16_t>(to), order_);
    if (sizeBytes(type) == 4) store(bytes, static_cast<std::uint32_t>(to), order_);
    return true;
  }

  /// Where a position of the input is in the output.
  [[nodiscard]] std::size_t placeOf(std::size_t position) { return position; }
  std::vector<std::uint8_t> finish() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
  ByteOrder order_;
};

/// The file with the words of indices replaced.
class TextOutput {
 public:
  TextOutput(Bytes file, ByteOrder) : file_(file) { bytes_.reserve(file.size() + file.size() / 16); }

  bool renumber(TextPlyCursor& cursor, PlyType type, const Renumbering& newNumber) {
    std::int64_t vertex = 0;
    if (!cursor.readInteger(type, vertex)) return false;
    const std::int64_t to = newNumber(vertex);
    if (to == vertex) return true;
    copyUpTo(cursor.position() - cursor.lastText().size());
    const std::string word = std::to_string(to);
    bytes_.insert(bytes_.end(), word.begin(), word.end());
    copied_ = cursor.position();
    return true;
  }

  std::size_t placeOf(std::size_t position) {
    copyUpTo(position);
    return bytes_.size();
  }
  std::vector<std::uint8_t> finish() {
    copyUpTo(file_.size());
    return std::move(bytes_);
  }

 private:
  void copyUpTo(std::size_t end) {
    bytes_.insert(bytes_.end(), file_.begin() + static_cast<std::ptrdiff_t>(copied_),
                  file_.begin() + static_cast<std::ptrdiff_t>(end));
    copied_ = end;
  }

  Bytes file_;
  std::vector<std::uint8_t> bytes_;
  std::size_t copied_ = 0;  // everything before this byte of the file is in the output
};

template <class Cursor, class Output>
bool renumberElement(Cursor& cursor, const PlyElement& element, const Renumbering& newNumber, Output& output) {
  if (!hasReference(element) && !element.hasList) return cursor.skipRows(element);
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (const PlyProperty& property : element.properties) {
      if (!isReference(property)) {
        if (!skipProperty(cursor, property)) return false;
        continue;
      }
      std::uint64_t length = 1;
      if (property.isList && !readListLength(cursor, property, length)) return false;
      for (std::uint64_t item = 0; item < length; ++item) {
        if (!output.renumber(cursor, property.type, newNumber)) return false;
      }
    }
  }
  return true;
}

/// A PLY whose indices are rewritten and whose vertex rows, from `vertexBegin` on, are not yet moved.
struct Renumbered {
  std::vector<std::uint8_t> bytes;
  std::size_t vertexBegin = 0;
};

template <class Cursor, class Output>
Result<Renumbered> renumber(Bytes file, const PlyHeader& header, std::size_t vertexElement,
                            const Renumbering& newNumber) {
  Renumbered result;
  Cursor cursor(file, header);
  Output output(file, header.order());
  for (std::size_t i = 0; i < header.elements.size(); ++i) {
    if (i == vertexElement) result.vertexBegin = output.placeOf(cursor.position());
    if (!renumberElement(cursor, header.elements[i], newNumber, output)) return notTheFile();
  }
  result.bytes = output.finish();
  return result;
}

Result<Renumbered> renumber(Bytes file, const PlyHeader& header, std::size_t vertexElement,
                            const Renumbering& newNumber) {
  return header.encoding == PlyEncoding::ascii
             ? renumber<TextPlyCursor, TextOutput>(file, header, vertexElement, newNumber)
             : renumber<BinaryPlyCursor, BinaryOutput>(file, header, vertexElement, newNumber);
}

/// The rows of the vertex element as byte ranges. A text row runs from its first to its last word: the blanks and line
/// breaks between rows stay where they are, so that rows cannot run into each other, even without a last line break.
class Rows {
 public:
  static Result<Rows> find(Bytes file, const PlyHeader& header, const PlyElement& element, std::size_t begin) {
    PlyHeader body = header;
    body.bodyBegin = begin;
    Rows rows;
    if (header.encoding == PlyEncoding::ascii) {
      TextPlyCursor cursor(file, body);
      if (!rows.walk(cursor, element)) return notTheFile();
    } else if (element.hasList) {
      BinaryPlyCursor cursor(file, body);
      if (!rows.walk(cursor, element)) return notTheFile();
    } else {
      rows.begin_ = begin;
      rows.rowBytes_ = static_cast<std::size_t>(element.rowBytes);
    }
    return rows;
  }

  [[nodiscard]] std::size_t begin(std::size_t row) const {
    return ends_.empty() ? begin_ + row * rowBytes_ : begins_[row];
  }
  [[nodiscard]] std::size_t end(std::size_t row) const { return ends_.empty() ? begin(row + 1) : ends_[row]; }

 private:
  template <class Cursor>
  bool walk(Cursor& cursor, const PlyElement& element) {
    begins_.reserve(static_cast<std::size_t>(element.count));
    ends_.reserve(static_cast<std::size_t>(element.count));
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const Cursor before = cursor;
        if (!skipProperty(cursor, element.properties[i])) return false;
        if (i == 0) begins_.push_back(firstByte(before));
      }
      ends_.push_back(cursor.position());
    }
    return true;
  }

  static std::size_t firstByte(const BinaryPlyCursor& before) { return before.position(); }
  static std::size_t firstByte(TextPlyCursor before) {
    const std::size_t length = before.word().size();
    return before.position() - length;
  }

  std::size_t begin_ = 0, rowBytes_ = 0;    // rows of equal size,
  std::vector<std::size_t> begins_, ends_;  // or each row by itself
};

std::vector<std::uint8_t> movedRows(Bytes file, const Rows& rows, std::span<const std::uint32_t> order) {
  std::vector<std::uint8_t> out;
  out.reserve(file.size());
  const auto append = [&](std::size_t begin, std::size_t end) {
    out.insert(out.end(), file.begin() + static_cast<std::ptrdiff_t>(begin),
               file.begin() + static_cast<std::ptrdiff_t>(end));
  };
  append(0, rows.begin(0));
  for (std::size_t row = 0; row < order.size(); ++row) {
    append(rows.begin(order[row]), rows.end(order[row]));
    append(rows.end(row), row + 1 < order.size() ? rows.begin(row + 1) : file.size());
  }
  return out;
}

/// The largest number an index can be.
std::uint64_t largestOf(PlyType type) {
  const bool isSigned = type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32;
  return (std::uint64_t{1} << (8 * sizeBytes(type) - (isSigned ? 1 : 0))) - 1;
}

}  // namespace

Result<OrderFreedom> PlyModel::orderFreedom(std::span<const std::uint8_t> file, const Resources&) const {
  if (file.size() != fileSize_) return notTheFile();
  OrderFreedom freedom;
  for (const PlyElement& element : header_.elements) {
    if (element.count == 0) continue;
    for (const PlyProperty& property : element.properties) {
      const std::string place = concat("element ", quoted(element.name), ", property ", quoted(property.name));
      if (isReference(property) && largestOf(property.type) < vertexElement().count - 1) {
        // Legal while only the first vertices are referred to, but then others cannot take their place.
        freedom.warnings.push_back(place + " cannot hold every vertex index; the order of the vertices is kept");
        return freedom;
      }
      if (!isReference(property) && mayBeReference(element, property)) {
        freedom.warnings.push_back(place + " may hold vertex indices and is left as it is");
      }
    }
  }
  // Reading the mesh stops after the faces: references behind them may be broken.
  if (!renumber(file, header_, vertexElement_, Renumbering({}))) {
    freedom.warnings.push_back("a vertex index behind the faces cannot be read; the order of the vertices is kept");
    return freedom;
  }
  freedom.ranges.push_back(VertexRange{0, static_cast<std::uint32_t>(vertexElement().count)});
  return freedom;
}

Result<PatchedFile> PlyModel::reorder(std::span<const std::uint8_t> file, const Resources& resources,
                                      std::span<const std::uint32_t> order) const {
  const Result<OrderFreedom> freedom = orderFreedom(file, resources);
  if (!freedom) return freedom.error();
  const Result<std::vector<std::uint32_t>> newOf = invertOrder(order, vertexElement().count, freedom->ranges);
  if (!newOf) return newOf.error();
  PatchedFile reordered;
  if (freedom->ranges.empty()) {
    reordered.bytes.assign(file.begin(), file.end());
    return reordered;
  }
  const Renumbering newNumber(*newOf);
  const Result<Renumbered> renumbered = renumber(file, header_, vertexElement_, newNumber);
  if (!renumbered) return renumbered.error();
  const Result<Rows> rows = Rows::find(renumbered->bytes, header_, vertexElement(), renumbered->vertexBegin);
  if (!rows) return rows.error();

  reordered.bytes = movedRows(renumbered->bytes, *rows, order);
  if (Status status = checkReordered(mesh_, order, *newOf, reordered.bytes, {}); !status) return status.error();
  reordered.bytesChanged = countChangedBytes(file, resources, reordered);
  return reordered;
}

}  // namespace quadmark::io
