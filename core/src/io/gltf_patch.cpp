// SPDX-License-Identifier: MIT
#include <algorithm>

#include "allowed_spans.h"
#include "concat.h"
#include "data_uri.h"
#include "gltf_bounds.h"
#include "gltf_decompress.h"
#include "gltf_edits.h"
#include "gltf_model.h"
#include "patch_positions.h"

namespace quadmark::io {
namespace {

Error notTheFile(const std::string& what) {
  return Error{ErrorCode::badOption, concat("patch: these are not the bytes that were read (", what, ")")};
}

/// Writes the positions of all arrays in one buffer; components of equal value keep their bytes.
/// @return the number of bytes that differ from `before`, or `internal` if one of them is not part of a position.
Result<std::uint64_t> writeArrays(const std::vector<const PositionArray*>& arrays, std::span<const double> positions,
                                  Bytes before, std::span<std::uint8_t> after) {
  AllowedSpans allowed;
  for (const PositionArray* array : arrays) {
    allowed.add(array->start, array->stride, array->type.bytes(), array->count);
    const std::optional<CoordinateGrid> grid = array->type.grid();
    withComponent(array->type.component, [&](auto component) {
      using T = decltype(component);
      std::uint8_t* element = after.data() + array->start;
      const double divisor = grid ? grid->divisor : 1;
      const double* position = &positions[static_cast<std::size_t>(3 * array->firstVertex)];
      for (std::uint64_t i = 0; i < array->count; ++i, element += array->stride, position += 3) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::uint8_t* bytes = element + axis * sizeof(T);
          const T stored = load<T>(bytes), code = encodeComponent(position[axis], stored, divisor);
          if (code != stored) store(bytes, code);
        }
      }
    });
  }
  allowed.finish();
  return countDifferences(before, after, allowed);
}

}  // namespace

void GltfModel::Extent::include(const double (&codes)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    if (empty || codes[axis] < low[axis]) low[axis] = codes[axis];
    if (empty || codes[axis] > high[axis]) high[axis] = codes[axis];
  }
  empty = false;
}

/// That the buffers are as long as those that were read, and that each component can hold its coordinate.
Status GltfModel::checkPatch(std::span<const double> positions, const std::vector<BufferBytes>& buffers) const {
  std::uint64_t stored = 0;
  for (const PositionArray& array : positions_.arrays) {
    if (array.start + array.stride * (array.count - 1) + array.type.bytes() > buffers[array.buffer].bytes.size()) {
      return notTheFile("a buffer is shorter");
    }
    const std::optional<CoordinateGrid> grid = array.type.grid();
    Status status = checkRepresentable(positions, array.firstVertex, array.count,
                                       [&](double x) { return grid ? nearestOnGrid(*grid, x) == x : fitsFloat32(x); });
    if (!status) return status;
    stored = std::max(stored, array.firstVertex + array.count);
  }
  return checkRepresentable(positions, stored, positions_.vertexCount - stored, [](double x) { return x == 0; });
}

/// Extends the extents by some elements of a window, by their codes as stored and as they will be. The mesh would not
/// do: its positions are the caller's to change.
void GltfModel::includeElements(const PositionWindow& window, std::uint64_t begin, std::uint64_t end,
                                std::span<const double> positions, const std::vector<BufferBytes>& buffers,
                                Extent& before, Extent& after) const {
  const PositionArray& array = positions_.arrays[window.array];
  const std::optional<CoordinateGrid> grid = array.type.grid();
  const std::uint64_t skipped = window.firstVertex - array.firstVertex;
  withComponent(array.type.component, [&](auto component) {
    using T = decltype(component);
    const double divisor = grid ? grid->divisor : 1;
    const std::uint8_t* element = buffers[array.buffer].bytes.data() + array.start + (skipped + begin) * array.stride;
    const double* position = &positions[static_cast<std::size_t>(3 * (window.firstVertex + begin))];
    for (std::uint64_t i = begin; i < end; ++i, element += array.stride, position += 3) {
      double old[3], now[3];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const T code = load<T>(element + axis * sizeof(T));
        old[axis] = code;
        now[axis] = encodeComponent(position[axis], code, divisor);
      }
      before.include(old);
      after.include(now);
    }
  });
}

/// Edits for an accessor's min and max: of the codes, with sparse values in their places. A bound whose true value
/// stays keeps its spelling, even a wrong one; but of data that was compressed, bounds that nobody could check become
/// true.
Status GltfModel::editBounds(Bytes file, const Bounds& bounds, std::span<const double> positions,
                             const std::vector<BufferBytes>& buffers, const std::vector<bool>& decompressed,
                             JsonEdits& edits) const {
  const PositionWindow& window = positions_.windows[bounds.window];
  const bool wasCompressed = window.isStored() && decompressed[positions_.arrays[window.array].buffer];
  if (wasCompressed && window.values == kNone) return okStatus();  // Decompression has done it
  Extent before, after;
  std::uint64_t done = 0;
  std::size_t replaced = 0;
  if (window.values != kNone) {
    const PositionWindow& values = positions_.windows[window.values];
    replaced = values.replaced.size();
    includeElements(values, 0, values.count, positions, buffers, before, after);
    for (const std::uint32_t element : values.replaced) {
      if (window.isStored()) includeElements(window, done, element, positions, buffers, before, after);
      done = element + std::uint64_t{1};
    }
  }
  if (window.isStored()) {
    includeElements(window, done, window.count, positions, buffers, before, after);
  } else if (replaced < window.count) {
    before.include({0, 0, 0});
    after.include({0, 0, 0});
  }

  const PositionWindow& typed =
      window.isStored() || window.values == kNone ? window : positions_.windows[window.values];
  const std::uint32_t componentType =
      typed.isStored() ? positions_.arrays[typed.array].type.component : std::uint32_t{kGltfFloat};
  const auto edit = [&](FileSpan span, const double(&old)[3], const double(&now)[3]) {
    if (span.empty()) return okStatus();
    if (span.end > file.size()) return Status(notTheFile("the JSON text differs"));
    const Result<JsonValue> array = parseJson(textAt(file, span));
    if (!array) return Status(notTheFile("the JSON text differs"));
    if (!array->isArray() || array->elementCount() != 3) return okStatus();  // broken in the original: not ours to mend
    int axis = 0;
    array->forEachElement([&](JsonValue element) {
      const int a = axis++;
      if (!wasCompressed && old[a] == now[a]) return;
      correctBound(element, now[a], componentType, edits);
    });
    return okStatus();
  };
  if (Status status = edit(bounds.min, before.low, after.low); !status) return status;
  return edit(bounds.max, before.high, after.high);
}

Result<PatchedFile> GltfModel::patch(std::span<const std::uint8_t> file, const Resources& resources,
                                     std::span<const double> positions) const {
  if (file.size() != fileSize_) return notTheFile("another size");
  if (Status status = checkMarkable(); !status) return status.error();
  if (Status status = checkPositions(positions, positions_.vertexCount); !status) return status.error();

  // 1. Bounds that change, and buffers outside the file or inside its text.
  PatchedFile patched;
  Result<GltfEdits> edits = GltfEdits::of(file, container_);
  if (!edits) return notTheFile("the JSON text differs");
  Decompression decompression(*edits);
  std::vector<std::vector<const PositionArray*>> arraysOf(buffers_.size());
  for (const PositionArray& array : positions_.arrays) arraysOf[array.buffer].push_back(&array);
  std::vector<bool> wanted(buffers_.size()), decompressed(buffers_.size());
  for (std::size_t i = 0; i < buffers_.size(); ++i) wanted[i] = !arraysOf[i].empty();
  Result<std::vector<BufferBytes>> opened = openBuffers(buffers_, wanted, container_, file, resources);
  if (!opened) return opened.error();
  const std::vector<BufferBytes> before = std::move(opened).value();
  if (Status status = checkPatch(positions, before); !status) return status.error();
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    if (arraysOf[i].empty() || buffers_[i].source == BufferPlace::Source::bin) continue;
    std::vector<std::uint8_t> after(before[i].bytes.begin(), before[i].bytes.end());
    const Result<std::uint64_t> changed = writeArrays(arraysOf[i], positions, before[i].bytes, after);
    if (!changed) return changed.error();
    if (*changed == 0) continue;
    if (buffers_[i].source == BufferPlace::Source::meshopt) {
      decompression.replaceView(buffers_[i].meshopt.view, after);
      decompressed[i] = true;
      continue;
    }
    if (buffers_[i].source == BufferPlace::Source::draco) {
      const DracoStream& stream = buffers_[i].draco;
      const Bytes bytes = before[stream.buffer].bytes.subspan(static_cast<std::size_t>(stream.byteOffset),
                                                              static_cast<std::size_t>(stream.byteLength));
      const Status status = decompression.replaceStream(stream, bytes, after, memoryLimit(file, resources));
      if (!status) return status.error();
      continue;
    }
    if (buffers_[i].source == BufferPlace::Source::resource) {
      patched.bytesChanged += *changed;
      patched.resources[buffers_[i].key] = std::move(after);
      continue;
    }
    const std::string name = concat("buffer ", i);
    Result<std::string> uri = recodeDataUri(textAt(file, buffers_[i].uri), after, name);
    if (!uri) return uri.error();
    const Result<std::vector<std::uint8_t>> decoded = decodeDataUri(*uri, name);
    if (!decoded || *decoded != after)
      return Error{ErrorCode::internal, concat("self-check: ", name, " decodes differently")};
    edits->replace(buffers_[i].uri, std::move(uri).value());
  }

  for (const Bounds& bounds : bounds_) {
    if (Status status = editBounds(file, bounds, positions, before, decompressed, edits->json()); !status)
      return status.error();
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
