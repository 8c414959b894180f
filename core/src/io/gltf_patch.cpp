// SPDX-License-Identifier: MIT
#include <algorithm>

#include "allowed_spans.h"
#include "data_uri.h"
#include "gltf_edits.h"
#include "gltf_model.h"
#include "number_text.h"
#include "patch_positions.h"

namespace quadmark::io {
namespace {

Error notTheFile(const std::string& what) {
  return Error{ErrorCode::badOption, "patch: these are not the bytes that were read (" + what + ")"};
}

Status checkArrays(const std::vector<const PositionArray*>& arrays, Bytes buffer) {
  for (const PositionArray* array : arrays) {
    if (array->start + array->stride * (array->count - 1) + 12 > buffer.size())
      return notTheFile("a buffer is shorter");
  }
  return okStatus();
}

/// Writes the positions of all arrays in one buffer; components of equal value keep their bytes.
/// @return the number of bytes that differ from `before`, or `internal` if one of them is not part of a position.
Result<std::uint64_t> writeArrays(const std::vector<const PositionArray*>& arrays, std::span<const double> positions,
                                  Bytes before, std::span<std::uint8_t> after) {
  AllowedSpans allowed;
  for (const PositionArray* array : arrays) {
    allowed.add(array->start, array->stride, 12, array->count);
    std::uint8_t* element = after.data() + array->start;
    const double* position = &positions[static_cast<std::size_t>(3 * array->firstVertex)];
    for (std::uint64_t i = 0; i < array->count; ++i, element += array->stride, position += 3) {
      for (int axis = 0; axis < 3; ++axis) {
        const float value = static_cast<float>(position[axis]);
        if (load<float>(element + 4 * axis) != value) store(element + 4 * axis, value);
      }
    }
  }
  allowed.finish();
  return countDifferences(before, after, allowed);
}

struct Extent {
  float low[3], high[3];

  void include(const float (&position)[3], bool first) {
    for (int axis = 0; axis < 3; ++axis) {
      if (first || position[axis] < low[axis]) low[axis] = position[axis];
      if (first || position[axis] > high[axis]) high[axis] = position[axis];
    }
  }
};

/// Bounds of an array's elements as stored. The mesh would not do: its positions are the caller's to change.
Extent storedExtent(Bytes buffer, const PositionArray& array, std::uint64_t firstVertex, std::uint64_t count) {
  Extent extent{};
  const std::uint8_t* element = buffer.data() + array.start + (firstVertex - array.firstVertex) * array.stride;
  for (std::uint64_t i = 0; i < count; ++i, element += array.stride) {
    const float position[3] = {load<float>(element), load<float>(element + 4), load<float>(element + 8)};
    extent.include(position, i == 0);
  }
  return extent;
}

Extent newExtent(std::span<const double> positions, std::uint64_t firstVertex, std::uint64_t count) {
  Extent extent{};
  const double* from = &positions[static_cast<std::size_t>(3 * firstVertex)];
  for (std::uint64_t i = 0; i < count; ++i, from += 3) {
    const float position[3] = {static_cast<float>(from[0]), static_cast<float>(from[1]), static_cast<float>(from[2])};
    extent.include(position, i == 0);
  }
  return extent;
}

/// Edits for one min or max array. A bound whose true value stays keeps its spelling, even a wrong one.
Status editBound(Bytes file, FileSpan span, const float (&before)[3], const float (&after)[3], JsonEdits& edits) {
  if (span.empty()) return okStatus();
  if (span.end > file.size()) return notTheFile("the JSON text differs");
  const Result<JsonValue> array = parseJson(textAt(file, span));
  if (!array) return notTheFile("the JSON text differs");
  if (!array->isArray() || array->elementCount() != 3) return okStatus();  // broken in the original: not ours to mend
  int axis = 0;
  array->forEachElement([&](JsonValue element) {
    const int a = axis++;
    const std::optional<float> declared = parseFloat(element.text());
    if (before[a] == after[a] || !declared || *declared == after[a]) return;
    edits.replace(element.text(), formatShortest(after[a]));
  });
  return okStatus();
}

}  // namespace

Result<PatchedFile> GltfModel::patch(std::span<const std::uint8_t> file, const Resources& resources,
                                     std::span<const double> positions) const {
  if (file.size() != fileSize_) return notTheFile("another size");
  if (!positions_.conflict.empty()) return unsupportedFile(positions_.conflict);
  if (Status status = checkPositions(positions, positions_.vertexCount, Precision::float32); !status)
    return status.error();

  // 1. Bounds that change, and buffers outside the file or inside its text.
  PatchedFile patched;
  Result<GltfEdits> edits = GltfEdits::of(file, container_);
  if (!edits) return notTheFile("the JSON text differs");
  std::vector<std::vector<const PositionArray*>> arraysOf(buffers_.size());
  std::vector<std::vector<const Bounds*>> boundsOf(buffers_.size());
  for (const PositionArray& array : positions_.arrays) arraysOf[array.buffer].push_back(&array);
  for (const Bounds& bounds : bounds_) boundsOf[positions_.arrays[bounds.array].buffer].push_back(&bounds);
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    if (arraysOf[i].empty()) continue;
    const Result<BufferBytes> before = openBuffer(buffers_[i], i, container_, file, resources);
    if (!before) return before.error();
    if (Status status = checkArrays(arraysOf[i], before->bytes); !status) return status.error();
    for (const Bounds* bounds : boundsOf[i]) {
      const Extent old =
          storedExtent(before->bytes, positions_.arrays[bounds->array], bounds->firstVertex, bounds->count);
      const Extent now = newExtent(positions, bounds->firstVertex, bounds->count);
      if (Status status = editBound(file, bounds->min, old.low, now.low, edits->json()); !status) return status.error();
      if (Status status = editBound(file, bounds->max, old.high, now.high, edits->json()); !status) return status.error();
    }
    if (buffers_[i].source == BufferPlace::Source::bin) continue;
    std::vector<std::uint8_t> after(before->bytes.begin(), before->bytes.end());
    const Result<std::uint64_t> changed = writeArrays(arraysOf[i], positions, before->bytes, after);
    if (!changed) return changed.error();
    if (*changed == 0) continue;
    if (buffers_[i].source == BufferPlace::Source::resource) {
      patched.bytesChanged += *changed;
      patched.resources[buffers_[i].key] = std::move(after);
      continue;
    }
    const std::string name = "buffer " + std::to_string(i);
    Result<std::string> uri = recodeDataUri(textAt(file, buffers_[i].uri), after, name);
    if (!uri) return uri.error();
    const Result<std::vector<std::uint8_t>> decoded = decodeDataUri(*uri, name);
    if (!decoded || *decoded != after)
      return Error{ErrorCode::internal, "self-check: " + name + " decodes differently"};
    edits->replace(buffers_[i].uri, std::move(uri).value());
  }

  // 2. Assembly, then the BIN chunk in place.
  Result<AssembledGltf> assembled = edits->assemble();
  if (!assembled) return assembled.error();
  patched.bytes = std::move(assembled->bytes);
  patched.bytesChanged += assembled->bytesChanged;
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    if (arraysOf[i].empty() || buffers_[i].source != BufferPlace::Source::bin) continue;
    const std::span<std::uint8_t> bin(&patched.bytes[assembled->binBegin], container_.binEnd - container_.binBegin);
    const Result<std::uint64_t> changed = writeArrays(arraysOf[i], positions, container_.bin(file), bin);
    if (!changed) return changed.error();
    patched.bytesChanged += *changed;
  }
  return patched;
}

}  // namespace quadmark::io
