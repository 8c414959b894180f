// SPDX-License-Identifier: MIT
#include "allowed_spans.h"
#include "concat.h"
#include "patch_positions.h"
#include "ply_body.h"
#include "ply_model.h"

namespace quadmark::io {
namespace {

Error notTheFile() {
  return Error{ErrorCode::badOption, "patch: these are not the bytes that were read"};
}

/// Writes one binary coordinate if its value differs (-0 and 0 are equal).
void writeCoordinate(std::uint8_t* bytes, PlyType type, ByteOrder order, double value) {
  if (type == PlyType::float32) {
    const float narrow = static_cast<float>(value);
    if (load<float>(bytes, order) != narrow) store(bytes, narrow, order);
  } else if (load<double>(bytes, order) != value) {
    store(bytes, value, order);
  }
}

double coordinate(std::span<const double> positions, std::uint64_t vertex, int axis) {
  return positions[static_cast<std::size_t>(3 * vertex) + static_cast<std::size_t>(axis)];
}

std::string spell(PlyType type, double value) {
  return type == PlyType::float32 ? formatShortest(static_cast<float>(value)) : formatShortest(value);
}

}  // namespace

Result<PatchedFile> PlyModel::patch(std::span<const std::uint8_t> file, const Resources&,
                                    std::span<const double> positions) const {
  if (file.size() != fileSize_) return notTheFile();
  const std::uint64_t vertexCount = vertexElement().count;
  if (Status status = checkPositions(positions, vertexCount); !status) return status.error();
  const bool wide = mesh_.precision == Precision::float64;
  Status status = checkRepresentable(positions, 0, vertexCount, [&](double x) { return wide || fitsFloat32(x); });
  if (!status) return status.error();
  return header_.encoding == PlyEncoding::ascii ? patchText(file, positions) : patchBinary(file, positions);
}

Result<PatchedFile> PlyModel::patchBinary(Bytes file, std::span<const double> positions) const {
  const PlyElement& element = vertexElement();
  PatchedFile patched;
  patched.bytes.assign(file.begin(), file.end());
  AllowedSpans allowed;
  const PlyType type = element.properties[axisProperty_[0]].type;
  const std::uint32_t width = sizeBytes(type);

  if (!element.hasList) {
    std::uint64_t offset = vertexBegin_;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      if (const int axis = axisOf(axisProperty_, i); axis >= 0) {
        allowed.add(offset, element.rowBytes, width, element.count);
        for (std::uint64_t row = 0; row < element.count; ++row) {
          writeCoordinate(patched.bytes.data() + offset + row * element.rowBytes, type, header_.order(),
                          coordinate(positions, row, axis));
        }
      }
      offset += sizeBytes(element.properties[i].type);
    }
  } else {
    PlyHeader body = header_;
    body.bodyBegin = vertexBegin_;
    BinaryPlyCursor cursor(file, body);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const std::size_t at = cursor.position();
        if (!skipProperty(cursor, element.properties[i])) return notTheFile();
        const int axis = axisOf(axisProperty_, i);
        if (axis < 0) continue;
        allowed.add(at, width, width, 1);
        writeCoordinate(&patched.bytes[at], type, header_.order(), coordinate(positions, row, axis));
      }
    }
  }
  allowed.finish();
  const Result<std::uint64_t> changed = countDifferences(file, patched.bytes, allowed);
  if (!changed) return changed.error();
  patched.bytesChanged = *changed;
  return patched;
}

Result<PatchedFile> PlyModel::patchText(Bytes file, std::span<const double> positions) const {
  const PlyElement& element = vertexElement();
  PatchedFile patched;
  patched.bytes.reserve(file.size() + file.size() / 8);
  PlyHeader body = header_;
  body.bodyBegin = vertexBegin_;
  TextPlyCursor cursor(file, body);
  std::size_t copied = 0;  // everything before this byte is in the output
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      const int axis = axisOf(axisProperty_, i);
      if (axis < 0) {
        if (!skipProperty(cursor, property)) return notTheFile();
        continue;
      }
      double value = 0;
      if (!cursor.readFloating(property.type, value)) return notTheFile();
      if (value == coordinate(positions, row, axis)) continue;
      const std::string_view before = cursor.lastText();
      const std::string after = spell(property.type, coordinate(positions, row, axis));
      const std::size_t begin = cursor.position() - before.size();
      patched.bytes.insert(patched.bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(copied),
                           file.begin() + static_cast<std::ptrdiff_t>(begin));
      patched.bytes.insert(patched.bytes.end(), after.begin(), after.end());
      copied = cursor.position();
      patched.bytesChanged += countReplaced(before, after);
    }
  }
  patched.bytes.insert(patched.bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(copied), file.end());
  if (Status status = checkPatchedText(file, patched.bytes, positions); !status) return status.error();
  return patched;
}

/// Walks the old and the new text side by side: coordinates have the wanted value, everything else is equal.
Status PlyModel::checkPatchedText(Bytes file, Bytes patched, std::span<const double> positions) const {
  const PlyElement& element = vertexElement();
  const auto failed = [](std::uint64_t row) {
    return Error{ErrorCode::internal, concat("self-check: the row of vertex ", row, " changed beyond its position")};
  };
  PlyHeader body = header_;
  body.bodyBegin = vertexBegin_;
  TextPlyCursor before(file, body), after(patched, body);
  std::size_t beforeEnd = 0, afterEnd = 0;  // everything before these was compared
  const auto equalGap = [&](std::size_t beforeBegin, std::size_t afterBegin) {
    return asText(file.subspan(beforeEnd, beforeBegin - beforeEnd)) ==
           asText(patched.subspan(afterEnd, afterBegin - afterEnd));
  };
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      const int axis = axisOf(axisProperty_, i);
      if (axis < 0) {
        if (!skipProperty(before, property) || !skipProperty(after, property)) return failed(row);
        continue;
      }
      double value = 0;
      before.word();
      if (!after.readFloating(property.type, value) || value != coordinate(positions, row, axis)) return failed(row);
      if (!equalGap(before.position() - before.lastText().size(), after.position() - after.lastText().size())) {
        return failed(row);
      }
      beforeEnd = before.position();
      afterEnd = after.position();
    }
  }
  if (!equalGap(file.size(), patched.size())) return failed(element.count);
  return okStatus();
}

}  // namespace quadmark::io
