// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "concat.h"
#include "face_collector.h"
#include "ply_body.h"
#include "ply_model.h"

namespace quadmark {

bool isPly(std::span<const std::uint8_t> file) {
  const std::string_view text = io::asText(file.first(std::min<std::size_t>(file.size(), 64)));
  if (text.substr(0, 3) != "ply") return false;
  const std::size_t end = text.find_first_not_of(" \t", 3);
  return end != text.npos && (text[end] == '\n' || text[end] == '\r');
}

Result<std::unique_ptr<Model>> readPly(std::span<const std::uint8_t> file) {
  auto model = std::make_unique<io::PlyModel>();
  if (Status status = model->read(file); !status) return status.error();
  return std::unique_ptr<Model>(std::move(model));
}

namespace io {
namespace {

/// The error of a cursor's failed call, for example `PLY line 14: vertex 20, property "y": ...`.
template <class Cursor>
Error faultAt(const Cursor& cursor, const std::string& element, std::uint64_t row, const PlyProperty& property) {
  const std::string where = concat(element, " ", row, ", property ", quoted(property.name));
  switch (cursor.fault()) {
    case PlyFault::truncated:
      return badFile(concat("PLY: the file ends (", cursor.place(), ") inside ", where));
    case PlyFault::listTooLong:
      return badFile(
          concat("PLY ", cursor.place(), ": ", where, ": the list's length does not fit into the rest of the file"));
    default:
      return badFile(
          concat("PLY ", cursor.place(), ": ", where, ": ", quoted(cursor.lastText()), " is not a number of its type"));
  }
}

template <class Cursor>
Status skipElement(Cursor& cursor, const PlyElement& element) {
  if (!element.hasList) {
    if (cursor.skipRows(element)) return okStatus();
    return badFile(concat("PLY: the file ends (", cursor.place(), ") inside element ", quoted(element.name)));
  }
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (const PlyProperty& property : element.properties) {
      if (!skipProperty(cursor, property)) return faultAt(cursor, element.name, row, property);
    }
  }
  return okStatus();
}

Error notFinite(std::uint64_t vertex, int axis) {
  return badMesh(concat("PLY vertex ", vertex, ", property ", "xyz"[axis], " is not a finite number"));
}

/// The common binary case: rows of equal size.
template <class T>
Status readFixedRows(const std::uint8_t* rows, std::uint64_t count, std::uint64_t rowBytes,
                     const std::uint64_t (&offsets)[3], ByteOrder order, std::vector<double>& positions) {
  for (std::uint64_t row = 0; row < count; ++row, rows += rowBytes) {
    for (int axis = 0; axis < 3; ++axis) {
      const T value = load<T>(rows + offsets[axis], order);
      if (!std::isfinite(value)) return notFinite(row, axis);
      positions.push_back(value);
    }
  }
  return okStatus();
}

/// The common case of a face list, 4-byte indices: adds corners until one is out of range, which is left to the caller.
std::uint64_t addCorners(BinaryPlyCursor& cursor, std::uint64_t length, std::uint64_t vertexCount,
                         FaceCollector& faces) {
  const std::uint8_t* item = cursor.current();
  std::uint64_t added = 0;
  for (; added < length; ++added, item += 4) {
    const std::uint32_t vertex = load<std::uint32_t>(item, cursor.order());
    if (vertex >= vertexCount) break;
    faces.addCorner(vertex);
  }
  cursor.skip(PlyType::uint32, added);
  return added;
}

}  // namespace

Status PlyModel::checkVertexElement() const {
  const PlyElement& element = vertexElement();
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name = kAxes[axis];
    if (axisProperty_[axis] < 0) return badFile(concat("PLY element \"vertex\" has no property \"", name, "\""));
    const PlyProperty& property = element.properties[axisProperty_[axis]];
    if (property.isList) return badFile(concat("PLY vertex property \"", name, "\" is a list"));
    if (!isFloating(property.type)) {
      return unsupportedFile(
          concat("PLY vertex property \"", name, "\" has an integer type; coordinates must be float or double"));
    }
    if (property.type != element.properties[axisProperty_[0]].type) {
      return unsupportedFile("PLY vertex properties x, y and z are of different types");
    }
  }
  if (element.count > 0xffffffffu) return tooLarge("PLY: more than 4294967295 vertices");
  if (element.count == 0) return badMesh("PLY: the file has no vertices");
  return okStatus();
}

template <class Cursor>
Status PlyModel::readVertices(Cursor& cursor, const PlyElement& element) {
  vertexBegin_ = cursor.position();
  mesh_.positions.reserve(static_cast<std::size_t>(3 * element.count));
  const PlyType type = element.properties[axisProperty_[0]].type;
  if constexpr (std::is_same_v<Cursor, BinaryPlyCursor>) {
    if (!element.hasList) {
      std::uint64_t offsets[3] = {0, 0, 0}, offset = 0;
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        if (const int axis = axisOf(axisProperty_, i); axis >= 0) offsets[axis] = offset;
        offset += sizeBytes(element.properties[i].type);
      }
      const std::uint8_t* rows = cursor.current();
      if (Status status = skipElement(cursor, element); !status) return status;
      return type == PlyType::float32 ? readFixedRows<float>(rows, element.count, element.rowBytes, offsets,
                                                             header_.order(), mesh_.positions)
                                      : readFixedRows<double>(rows, element.count, element.rowBytes, offsets,
                                                              header_.order(), mesh_.positions);
    }
  }
  for (std::uint64_t row = 0; row < element.count; ++row) {
    double position[3];
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      const int axis = axisOf(axisProperty_, i);
      if (axis < 0) {
        if (!skipProperty(cursor, property)) return faultAt(cursor, element.name, row, property);
        continue;
      }
      if (!cursor.readFloating(property.type, position[axis])) return faultAt(cursor, element.name, row, property);
      if (!std::isfinite(position[axis])) return notFinite(row, axis);
    }
    mesh_.positions.insert(mesh_.positions.end(), position, position + 3);
  }
  return okStatus();
}

template <class Cursor>
Status PlyModel::readFaces(Cursor& cursor, const PlyElement& element, bool isLastElement) {
  const bool strips = element.name == "tristrips";
  int list = element.find("vertex_indices");
  if (list < 0) list = element.find("vertex_index");
  if (list < 0) {
    info_.warnings.push_back(concat("element ", quoted(element.name), " has no vertex_indices and is passed through"));
    return skipElement(cursor, element);
  }
  const PlyProperty& indices = element.properties[list];
  if (!indices.isList || isFloating(indices.type)) {
    return badFile(concat("PLY ", element.name, " property ", quoted(indices.name), " is not a list of integers"));
  }
  const std::uint64_t vertexCount = vertexElement().count;
  FaceCollector faces(mesh_);
  if (!strips) {
    // The bytes left bound the corners; when nothing else follows in a binary file they give their exact number.
    const std::uint64_t most = cursor.itemsLeft(indices.type);
    std::uint64_t expected = std::min(3 * element.count, most);
    if (header_.encoding != PlyEncoding::ascii && isLastElement && element.properties.size() == 1) {
      const std::uint64_t lengths = element.count * element.rowBytes;
      const std::uint64_t bytes = cursor.itemsLeft(PlyType::uint8);
      expected = (bytes - std::min(lengths, bytes)) / sizeBytes(indices.type);
    }
    faces.reserve(static_cast<std::size_t>(expected));
  }
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (static_cast<int>(i) != list) {
        if (!skipProperty(cursor, property)) return faultAt(cursor, element.name, row, property);
        continue;
      }
      std::uint64_t length = 0;
      if (!readListLength(cursor, property, length)) return faultAt(cursor, element.name, row, property);
      faces.reserve(static_cast<std::size_t>(strips ? 3 * length : length));
      faces.restartStrip();
      std::uint64_t done = 0;
      if constexpr (std::is_same_v<Cursor, BinaryPlyCursor>) {
        if (!strips && sizeBytes(property.type) == 4) done = addCorners(cursor, length, vertexCount, faces);
      }
      for (std::uint64_t item = done; item < length; ++item) {
        std::int64_t vertex = 0;
        if (!cursor.readInteger(property.type, vertex)) return faultAt(cursor, element.name, row, property);
        const bool restart = vertex == -1 || (vertex == 0xffffffff && property.type == PlyType::uint32);
        if (strips && restart) {
          faces.restartStrip();
        } else if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= vertexCount) {
          return badFile(concat("PLY ", cursor.place(), ": ", element.name, " ", row, ": vertex index ", vertex,
                                " is outside 0..", vertexCount - 1));
        } else if (strips) {
          faces.stripVertex(static_cast<std::uint32_t>(vertex));
        } else {
          faces.addCorner(static_cast<std::uint32_t>(vertex));
        }
      }
      if (faces.overflows()) return tooLarge("PLY: more than 4294967295 face corners");
      if (!strips) faces.endPolygon();
    }
  }
  if (faces.droppedPolygons() > 0) {
    info_.warnings.push_back(concat(faces.droppedPolygons(), " faces with fewer than 3 corners are passed through"));
  }
  return okStatus();
}

template <class Cursor>
Status PlyModel::readBody(Bytes file) {
  Cursor cursor(file, header_);
  for (std::size_t i = 0; i < header_.elements.size(); ++i) {
    const PlyElement& element = header_.elements[i];
    Status status = okStatus();
    if (i == vertexElement_) {
      status = readVertices(cursor, element);
    } else if (element.name == "face" || element.name == "tristrips") {
      status = readFaces(cursor, element, i + 1 == header_.elements.size());
    } else {
      status = skipElement(cursor, element);
    }
    if (!status) return status;
  }
  // Viewers ignore what follows the last element, so a mark must stay readable there; patch() keeps those bytes.
  std::uint64_t extra = file.size() - cursor.position();
  if (header_.encoding == PlyEncoding::ascii) {
    for (std::size_t at = cursor.position(); at < file.size() && TextPlyCursor::isBlank(file[at]); ++at) --extra;
  }
  if (extra > 0) info_.warnings.push_back(concat(extra, " bytes after the last element are kept as they are"));
  return okStatus();
}

Status PlyModel::read(Bytes file) {
  Result<PlyHeader> header = parsePlyHeader(file);
  if (!header) return header.error();
  header_ = std::move(header).value();
  fileSize_ = file.size();
  info_.format = FileFormat::ply;
  info_.variant = header_.variant;
  info_.meshes = info_.primitives = 1;

  const PlyElement* vertices = header_.find("vertex");
  if (vertices == nullptr) return badFile("PLY: the header has no element \"vertex\"");
  vertexElement_ = static_cast<std::size_t>(vertices - header_.elements.data());
  axisProperty_[0] = vertices->find("x");
  axisProperty_[1] = vertices->find("y");
  axisProperty_[2] = vertices->find("z");
  if (Status status = checkVertexElement(); !status) return status;
  const bool isDouble = vertices->properties[axisProperty_[0]].type == PlyType::float64;
  mesh_.precision = isDouble ? Precision::float64 : Precision::float32;

  const bool ascii = header_.encoding == PlyEncoding::ascii;
  if (Status status = ascii ? readBody<TextPlyCursor>(file) : readBody<BinaryPlyCursor>(file); !status) return status;
  if (mesh_.faceCount() == 0) return badMesh("PLY: the file has no faces");
  const double diagonal = boundingDiagonal(mesh_);
  if (diagonal == 0 || !std::isfinite(diagonal)) {
    return badMesh(diagonal == 0 ? "PLY: all used vertices are at one point" : "PLY: the extent overflows a double");
  }
  return okStatus();
}

}  // namespace io
}  // namespace quadmark
