// SPDX-License-Identifier: MIT
#include <algorithm>

#include "allowed_spans.h"
#include "data_uri.h"
#include "gltf_decompress.h"
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
/// @param before  null: the data was compressed, and bounds that nobody could check become true.
Status editBound(Bytes file, FileSpan span, const float* before, const float (&after)[3], JsonEdits& edits) {
  if (span.empty()) return okStatus();
  if (span.end > file.size()) return notTheFile("the JSON text differs");
  const Result<JsonValue> array = parseJson(textAt(file, span));
  if (!array) return notTheFile("the JSON text differs");
  if (!array->isArray() || array->elementCount() != 3) return okStatus();  // broken in the original: not ours to mend
  int axis = 0;
  array->forEachElement([&](JsonValue element) {
    const int a = axis++;
    const std::optional<float> declared = parseFloat(element.text());
    const bool stays = before != nullptr && before[a] == after[a];
    if (stays || !declared || *declared == after[a]) return;
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
  Decompression decompression(*edits);
  std::vector<std::vector<const PositionArray*>> arraysOf(buffers_.size());
  std::vector<std::vector<const Bounds*>> boundsOf(buffers_.size());
  for (const PositionArray& array : positions_.arrays) arraysOf[array.buffer].push_back(&array);
  for (const Bounds& bounds : bounds_) boundsOf[positions_.arrays[bounds.array].buffer].push_back(&bounds);
  std::vector<bool> wanted(buffers_.size());
  for (std::size_t i = 0; i < buffers_.size(); ++i) wanted[i] = !arraysOf[i].empty();
  const Result<std::vector<BufferBytes>> buffers = openBuffers(buffers_, wanted, container_, file, resources);
  if (!buffers) return buffers.error();
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    if (arraysOf[i].empty()) continue;
    const Bytes before = (*buffers)[i].bytes;
    if (Status status = checkArrays(arraysOf[i], before); !status) return status.error();
    const bool compressed = buffers_[i].source == BufferPlace::Source::meshopt;
    std::vector<std::uint8_t> after;
    std::uint64_t changedBytes = 0;
    if (buffers_[i].source != BufferPlace::Source::bin) {
      after.assign(before.begin(), before.end());
      const Result<std::uint64_t> changed = writeArrays(arraysOf[i], positions, before, after);
      if (!changed) return changed.error();
      if (*changed == 0) continue;
      changedBytes = *changed;
    }
    for (const Bounds* bounds : boundsOf[i]) {
      const Extent old = storedExtent(before, positions_.arrays[bounds->array], bounds->firstVertex, bounds->count);
      const Extent now = newExtent(positions, bounds->firstVertex, bounds->count);
      for (const bool low : {true, false}) {
        const Status status = editBound(file, low ? bounds->min : bounds->max,
                                        compressed ? nullptr
                                        : low      ? old.low
                                                   : old.high,
                                        low ? now.low : now.high, edits->json());
        if (!status) return status.error();
      }
    }
    if (buffers_[i].source == BufferPlace::Source::bin) continue;
    if (compressed) {
      decompression.replaceView(buffers_[i].meshopt.view, after);
      continue;
    }
    if (buffers_[i].source == BufferPlace::Source::resource) {
      patched.bytesChanged += changedBytes;
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

  patched.warnings = decompression.finish();

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
