// SPDX-License-Identifier: MIT
#include <algorithm>

#include "allowed_spans.h"
#include "data_uri.h"
#include "gltf_model.h"
#include "number_text.h"
#include "patch_positions.h"

namespace quadmark::io {
namespace {

Error notTheFile(const std::string& what) {
  return Error{ErrorCode::badOption, "patch: these are not the bytes that were read (" + what + ")"};
}

/// A piece of the JSON text to be replaced, in file positions.
struct TextEdit {
  FileSpan span;
  std::string text;
};

std::string_view textAt(Bytes file, FileSpan span) {
  return asText(file.subspan(span.begin, span.end - span.begin));
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
Status editBound(Bytes file, FileSpan span, const float (&before)[3], const float (&after)[3],
                 std::vector<TextEdit>& edits) {
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
    const std::size_t begin = span.begin + static_cast<std::size_t>(element.text().data() - textAt(file, span).data());
    edits.push_back(TextEdit{{begin, begin + element.text().size()}, formatShortest(after[a])});
  });
  return okStatus();
}

/// The JSON text with its edits (sorted, disjoint), and the self-check that all else is equal.
Result<std::string> applyEdits(Bytes file, FileSpan json, const std::vector<TextEdit>& edits,
                               std::uint64_t& bytesChanged) {
  std::string out;
  out.reserve(json.end - json.begin + 16 * edits.size());
  std::size_t copied = json.begin;
  for (const TextEdit& edit : edits) {
    if (edit.span.begin < copied || edit.span.end > json.end) {
      return Error{ErrorCode::internal, "self-check: text edits overlap"};
    }
    out += textAt(file, {copied, edit.span.begin});
    out += edit.text;
    copied = edit.span.end;
    bytesChanged += countReplaced(textAt(file, edit.span), edit.text);
  }
  out += textAt(file, {copied, json.end});
  if (!parseJson(out)) return Error{ErrorCode::internal, "self-check: the edited JSON is broken"};
  return out;
}

/// Keeps a GLB's JSON chunk a multiple of 4 bytes long, taking back at most the usual padding first.
void padJson(std::string& json) {
  for (int i = 0; i < 3 && json.size() % 4 != 0 && json.back() == ' '; ++i) json.pop_back();
  while (json.size() % 4 != 0) json += ' ';
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
  std::vector<TextEdit> edits;
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
      if (Status status = editBound(file, bounds->min, old.low, now.low, edits); !status) return status.error();
      if (Status status = editBound(file, bounds->max, old.high, now.high, edits); !status) return status.error();
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
    edits.push_back(TextEdit{buffers_[i].uri, std::move(uri).value()});
  }

  // 2. The JSON text.
  std::sort(edits.begin(), edits.end(),
            [](const TextEdit& a, const TextEdit& b) { return a.span.begin < b.span.begin; });
  const FileSpan jsonSpan{container_.jsonBegin, container_.jsonEnd};
  const std::size_t oldJsonBytes = jsonSpan.end - jsonSpan.begin;
  Result<std::string> json = applyEdits(file, jsonSpan, edits, patched.bytesChanged);
  if (!json) return json.error();
  if (container_.isGlb && json->size() != oldJsonBytes) padJson(*json);

  // 3. Assembly: everything before the JSON text, the text, everything behind it; lengths and the BIN chunk in place.
  patched.bytes.reserve(file.size() - oldJsonBytes + json->size());
  const auto append = [&](std::string_view text) {
    patched.bytes.insert(patched.bytes.end(), text.begin(), text.end());
  };
  append(textAt(file, {0, jsonSpan.begin}));
  append(*json);
  append(textAt(file, {jsonSpan.end, file.size()}));
  if (!container_.isGlb) return patched;

  const std::uint64_t length = load<std::uint32_t>(&file[8]) + std::uint64_t{json->size()} - oldJsonBytes;
  if (length > 0xffffffffu) return tooLarge("GLB: the file would exceed 4 GiB");
  store(&patched.bytes[8], static_cast<std::uint32_t>(length));
  store(&patched.bytes[kGlbHeaderBytes], static_cast<std::uint32_t>(json->size()));
  patched.bytesChanged +=
      countReplaced(textAt(file, {0, jsonSpan.begin}), asText(Bytes(patched.bytes).first(jsonSpan.begin)));
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    if (arraysOf[i].empty() || buffers_[i].source != BufferPlace::Source::bin) continue;
    const std::size_t binBegin = container_.binBegin - jsonSpan.end + jsonSpan.begin + json->size();
    const std::span<std::uint8_t> bin(&patched.bytes[binBegin], container_.binEnd - container_.binBegin);
    const Result<std::uint64_t> changed = writeArrays(arraysOf[i], positions, container_.bin(file), bin);
    if (!changed) return changed.error();
    patched.bytesChanged += *changed;
  }
  return patched;
}

}  // namespace quadmark::io
