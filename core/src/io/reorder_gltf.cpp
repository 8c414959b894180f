// SPDX-License-Identifier: MIT
// Reordering the vertices of a glTF: attributes and indices in place, then the texts that depend on them.
#include "reorder_gltf.h"

#include <algorithm>

#include "allowed_spans.h"
#include "concat.h"
#include "data_uri.h"
#include "gltf_edits.h"
#include "gltf_model.h"
#include "reorder_order.h"

namespace quadmark::io {
namespace {

Error notTheFile() {
  return Error{ErrorCode::badOption, "reorder: these are not the bytes that were read"};
}

std::uint32_t loadIndex(const std::uint8_t* bytes, std::uint32_t width) {
  if (width == 1) return *bytes;
  return width == 2 ? load<std::uint16_t>(bytes) : load<std::uint32_t>(bytes);
}

void storeIndex(std::uint8_t* bytes, std::uint32_t width, std::uint32_t value) {
  if (width == 1) *bytes = static_cast<std::uint8_t>(value);
  if (width == 2) store(bytes, static_cast<std::uint16_t>(value));
  if (width == 4) store(bytes, value);
}

struct IndexExtent {
  std::uint32_t low = 0xffffffff, high = 0;
  void include(std::uint32_t index) {
    low = std::min(low, index);
    high = std::max(high, index);
  }
};

/// Replaces a bound that was true before and is no longer.
void editBound(Bytes file, FileSpan span, std::uint32_t before, std::uint32_t after, JsonEdits& edits) {
  if (before == after || span.end > file.size()) return;
  const Result<JsonValue> array = parseJson(textAt(file, span));
  if (!array.ok() || array->elementCount() != 1) return;
  array->forEachElement([&](JsonValue bound) {
    if (bound.asUnsigned() != std::uint64_t{before}) return;  // wrong in the original: not ours to mend
    edits.replace(bound.text(), std::to_string(after));
  });
}

/// One array's new order, numbered from its own first vertex.
struct ArrayOrder {
  std::span<const std::uint32_t> order, newOf;
  std::uint32_t first = 0;

  [[nodiscard]] bool isIdentity() const {
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (order[i] != first + i) return false;
    }
    return true;
  }
};

/// The bytes of the buffers that change, and the edits of the text that follow.
class Mover {
 public:
  Mover(const GltfReorderPlan& plan, Bytes file, JsonEdits& edits)
      : plan_(plan), file_(file), edits_(edits), after_(plan.buffers.size()), allowed_(plan.buffers.size()) {}

  void move(const ReorderGroup& group, const ArrayOrder& order) {
    for (const ElementRun& run : group.attributes) moveElements(run, order);
    for (const IndexRun& indices : group.indices) renumber(indices, order);
  }

  /// Checks that nothing but elements of moved runs changed.
  Status check() {
    for (std::size_t i = 0; i < after_.size(); ++i) {
      if (after_[i].empty()) continue;
      allowed_[i].finish();
      if (const auto changed = countDifferences(plan_.buffers[i].bytes, after_[i], allowed_[i]); !changed)
        return changed.error();
    }
    return okStatus();
  }

  /// A buffer's new bytes, empty where nothing changed.
  [[nodiscard]] std::vector<std::uint8_t>& after(std::size_t buffer) { return after_[buffer]; }

 private:
  std::uint8_t* begin(const ElementRun& run) {
    std::vector<std::uint8_t>& bytes = after_[run.buffer];
    const Bytes before = plan_.buffers[run.buffer].bytes;
    if (bytes.empty()) bytes.assign(before.begin(), before.end());
    allowed_[run.buffer].add(run.start, run.stride, run.width, run.count);
    return bytes.data() + run.start;
  }

  void moveElements(const ElementRun& run, const ArrayOrder& order) {
    std::uint8_t* to = begin(run);
    const std::uint8_t* from = plan_.buffers[run.buffer].bytes.data() + run.start;
    for (std::size_t i = 0; i < order.order.size(); ++i) {
      std::memcpy(to + i * run.stride, from + (order.order[i] - order.first) * run.stride, run.width);
    }
  }

  void renumber(const IndexRun& indices, const ArrayOrder& order) {
    const ElementRun& run = indices.run;
    std::uint8_t* element = begin(run);
    IndexExtent old, now;
    for (std::uint64_t i = 0; i < run.count; ++i, element += run.stride) {
      const std::uint32_t vertex = loadIndex(element, run.width);
      // Triangles are checked when they are read; what points and lines refer to beyond the end stays.
      const std::uint32_t to = vertex < order.newOf.size() ? order.newOf[vertex] - order.first : vertex;
      storeIndex(element, run.width, to);
      old.include(vertex);
      now.include(to);
    }
    for (const FileSpan& span : indices.min) editBound(file_, span, old.low, now.low, edits_);
    for (const FileSpan& span : indices.max) editBound(file_, span, old.high, now.high, edits_);
  }

  const GltfReorderPlan& plan_;
  Bytes file_;
  JsonEdits& edits_;
  std::vector<std::vector<std::uint8_t>> after_;
  std::vector<AllowedSpans> allowed_;
};

}  // namespace

Result<OrderFreedom> GltfModel::orderFreedom(std::span<const std::uint8_t> file, const Resources& resources) const {
  if (file.size() != fileSize_) return notTheFile();
  const Result<GltfReorderPlan> plan = planGltfReorder(positions_, container_, file, resources);
  if (!plan) return plan.error();
  constexpr std::size_t kMostWarnings = 100;
  OrderFreedom freedom;
  for (std::size_t i = 0; i < plan->groups.size(); ++i) {
    const PositionArray& array = positions_.arrays[i];
    const std::string& obstacle = plan->groups[i].obstacle;
    if (obstacle.empty()) {
      freedom.ranges.push_back(
          VertexRange{static_cast<std::uint32_t>(array.firstVertex), static_cast<std::uint32_t>(array.count)});
      continue;
    }
    const auto window = std::find_if(positions_.windows.begin(), positions_.windows.end(),
                                     [&](const PositionWindow& w) { return w.array == i; });
    if (freedom.warnings.size() == kMostWarnings) freedom.warnings.back() = "the order of more vertices is kept";
    if (freedom.warnings.size() >= kMostWarnings) continue;
    freedom.warnings.push_back(concat("accessor ", window->accessor, " (POSITION): the order of its ", array.count,
                                      " vertices is kept: ", obstacle));
  }
  return freedom;
}

Result<PatchedFile> GltfModel::reorder(std::span<const std::uint8_t> file, const Resources& resources,
                                       std::span<const std::uint32_t> order) const {
  // 1. What may move.
  if (file.size() != fileSize_) return notTheFile();
  const Result<GltfReorderPlan> plan = planGltfReorder(positions_, container_, file, resources);
  if (!plan) return plan.error();
  std::vector<VertexRange> ranges;
  for (std::size_t i = 0; i < plan->groups.size(); ++i) {
    const PositionArray& array = positions_.arrays[i];
    if (!plan->groups[i].obstacle.empty()) continue;
    ranges.push_back(
        VertexRange{static_cast<std::uint32_t>(array.firstVertex), static_cast<std::uint32_t>(array.count)});
  }
  const Result<std::vector<std::uint32_t>> newOf = invertOrder(order, positions_.vertexCount, ranges);
  if (!newOf) return newOf.error();

  // 2. The buffers.
  Result<GltfEdits> edits = GltfEdits::of(file, container_);
  if (!edits) return notTheFile();
  Mover mover(*plan, file, edits->json());
  for (std::size_t i = 0; i < plan->groups.size(); ++i) {
    if (!plan->groups[i].obstacle.empty()) continue;
    const auto first = static_cast<std::uint32_t>(positions_.arrays[i].firstVertex);
    const auto count = static_cast<std::size_t>(positions_.arrays[i].count);
    const ArrayOrder arrayOrder{order.subspan(first, count), std::span(*newOf).subspan(first, count), first};
    if (!arrayOrder.isIdentity()) mover.move(plan->groups[i], arrayOrder);
  }
  if (Status status = mover.check(); !status) return status.error();

  // 3. Where they belong.
  PatchedFile reordered;
  std::size_t bin = plan->buffers.size();  // the one that is the BIN chunk, if it changes
  for (std::size_t i = 0; i < plan->buffers.size(); ++i) {
    if (mover.after(i).empty()) continue;
    const BufferPlace& place = plan->places[i];
    if (place.source == BufferPlace::Source::bin) bin = i;
    if (place.source == BufferPlace::Source::resource) reordered.resources[place.key] = std::move(mover.after(i));
    if (place.source != BufferPlace::Source::dataUri) continue;
    Result<std::string> uri = recodeDataUri(textAt(file, place.uri), mover.after(i), concat("buffer ", i));
    if (!uri) return uri.error();
    edits->replace(place.uri, std::move(uri).value());
  }
  Result<AssembledGltf> assembled = edits->assemble();
  if (!assembled) return assembled.error();
  reordered.bytes = std::move(assembled->bytes);
  if (bin < plan->buffers.size()) {
    std::copy(mover.after(bin).begin(), mover.after(bin).end(),
              reordered.bytes.begin() + static_cast<std::ptrdiff_t>(assembled->binBegin));
  }

  // 4. It must read back, with the resources that did not change as they are.
  reordered.bytesChanged = countChangedBytes(file, resources, reordered);
  Resources all = resources;
  for (const auto& [uri, bytes] : reordered.resources) all[uri] = bytes;
  if (Status status = checkReordered(mesh_, order, *newOf, reordered.bytes, all); !status) return status.error();
  return reordered;
}

}  // namespace quadmark::io
