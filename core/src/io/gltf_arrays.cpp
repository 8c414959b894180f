// SPDX-License-Identifier: MIT
#include "gltf_arrays.h"

#include <algorithm>

#include "concat.h"
#include "sorting.h"

namespace quadmark::io {
namespace {

/// Equally spaced elements in a buffer.
struct Layout {
  std::uint32_t buffer = 0;
  std::uint64_t start = 0, stride = 0, count = 0;
  std::uint32_t width = 0;  // bytes per element
  PositionType type;
  std::uint32_t accessor = kNone;
  std::uint32_t array = kNone;  // of joined layouts: their own index

  [[nodiscard]] std::uint64_t end() const { return start + stride * (count - 1) + width; }
  [[nodiscard]] std::uint64_t residue() const { return start % stride; }
};

Layout layoutOf(const GltfDocument& document, const std::vector<std::uint32_t>& sameBuffer, std::uint32_t index) {
  const GltfAccessor& accessor = document.accessors[index];
  const GltfView& view = document.views[accessor.view];
  Layout layout;
  layout.buffer = sameBuffer[view.buffer];
  layout.start = view.byteOffset + accessor.byteOffset;
  layout.width = accessor.elementBytes();
  layout.stride = view.byteStride == 0 ? layout.width : view.byteStride;
  layout.count = accessor.count;
  layout.type.component = accessor.componentType;
  layout.type.normalized = accessor.normalized && accessor.componentType != kGltfFloat;
  layout.accessor = index;
  return layout;
}

/// One of the packed arrays of a sparse accessor.
Layout packedLayout(const GltfDocument& document, const std::vector<std::uint32_t>& sameBuffer, std::uint32_t index,
                    std::uint32_t viewIndex, std::uint64_t offset, std::uint32_t width) {
  const GltfAccessor& accessor = document.accessors[index];
  const GltfView& view = document.views[viewIndex];
  Layout layout;
  layout.buffer = sameBuffer[view.buffer];
  layout.start = view.byteOffset + offset;
  layout.width = width;
  layout.stride = width;
  layout.count = accessor.sparse->count;
  layout.type.component = accessor.componentType;
  layout.type.normalized = accessor.normalized && accessor.componentType != kGltfFloat;
  layout.accessor = index;
  return layout;
}

Layout valuesLayout(const GltfDocument& document, const std::vector<std::uint32_t>& sameBuffer, std::uint32_t index) {
  const GltfSparse& sparse = *document.accessors[index].sparse;
  return packedLayout(document, sameBuffer, index, sparse.valuesView, sparse.valuesOffset,
                      document.accessors[index].elementBytes());
}

/// Whether any element of one touches any element of the other. Elements of unrelated strides whose ranges overlap
/// count as touching: no sane file interleaves so.
bool shareBytes(const Layout& a, const Layout& b) {
  if (a.buffer != b.buffer || a.start >= b.end() || b.start >= a.end()) return false;
  if (a.count == 1 && b.count == 1) return true;
  if (a.stride != b.stride && a.count != 1 && b.count != 1) return true;
  const std::uint64_t stride = a.count == 1 ? b.stride : a.stride;
  const std::uint64_t gap = (b.start % stride + stride - a.start % stride) % stride;  // from a's element to b's next
  return gap < a.width || stride - gap < b.width;
}

/// POSITION accessors of triangle primitives, each once, in the order of their first use.
std::vector<std::uint32_t> positionAccessors(const GltfDocument& document) {
  std::vector<std::uint32_t> order;
  std::vector<bool> seen(document.accessors.size());
  for (const GltfPrimitive& primitive : document.primitives) {
    if (!primitive.hasTriangles() || seen[primitive.position]) continue;
    seen[primitive.position] = true;
    order.push_back(primitive.position);
  }
  return order;
}

/// Joins layouts that share whole elements. Returns for each layout the array it went to.
std::vector<std::uint32_t> joinWindows(std::vector<Layout>& layouts, std::vector<Layout>& arrays) {
  std::vector<std::uint32_t> byPlace(layouts.size());
  for (std::uint32_t i = 0; i < byPlace.size(); ++i) byPlace[i] = i;
  sortCompactly(byPlace.begin(), byPlace.end(), [&](std::uint32_t left, std::uint32_t right) {
    const Layout& a = layouts[left];
    const Layout& b = layouts[right];
    if (a.buffer != b.buffer) return a.buffer < b.buffer;
    if (a.stride != b.stride) return a.stride < b.stride;
    if (a.residue() != b.residue()) return a.residue() < b.residue();
    if (a.type.component != b.type.component) return a.type.component < b.type.component;
    if (a.type.normalized != b.type.normalized) return b.type.normalized;
    if (a.start != b.start) return a.start < b.start;
    return left < right;
  });
  std::vector<std::uint32_t> arrayOf(layouts.size());
  for (const std::uint32_t index : byPlace) {
    const Layout& layout = layouts[index];
    Layout* last = arrays.empty() ? nullptr : &arrays.back();
    const bool joins = last != nullptr && last->buffer == layout.buffer && last->stride == layout.stride &&
                       last->residue() == layout.residue() && last->type == layout.type && layout.start < last->end();
    if (joins) {
      const std::uint64_t count = (layout.start - last->start) / last->stride + layout.count;
      last->count = std::max(last->count, count);
    } else {
      arrays.push_back(layout);
      arrays.back().array = static_cast<std::uint32_t>(arrays.size() - 1);
    }
    arrayOf[index] = static_cast<std::uint32_t>(arrays.size() - 1);
  }
  return arrayOf;
}

/// Arrays by place, so that those near a layout are found without looking at all.
class PlaceIndex {
 public:
  explicit PlaceIndex(std::vector<Layout> arrays) : arrays_(std::move(arrays)) {
    sortCompactly(arrays_.begin(), arrays_.end(), [](const Layout& a, const Layout& b) {
      if (a.buffer != b.buffer) return a.buffer < b.buffer;
      return a.start != b.start ? a.start < b.start : a.accessor < b.accessor;
    });
    std::uint64_t largest = 0;
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      if (i == 0 || arrays_[i].buffer != arrays_[i - 1].buffer) largest = 0;
      largest = std::max(largest, arrays_[i].end());
      largestEnd_.push_back(largest);
    }
  }

  /// An array other than the `except`th (in place order) that shares bytes with a layout, or nullptr.
  [[nodiscard]] const Layout* findSharing(const Layout& layout, std::size_t except = ~std::size_t{0}) const {
    const auto behind =
        std::lower_bound(arrays_.begin(), arrays_.end(), layout, [](const Layout& array, const Layout& l) {
          return array.buffer != l.buffer ? array.buffer < l.buffer : array.start < l.end();
        });
    for (auto i = static_cast<std::size_t>(behind - arrays_.begin()); i-- > 0;) {
      if (arrays_[i].buffer != layout.buffer || largestEnd_[i] <= layout.start) return nullptr;
      if (i != except && shareBytes(arrays_[i], layout)) return &arrays_[i];
    }
    return nullptr;
  }

  [[nodiscard]] const std::vector<Layout>& arrays() const { return arrays_; }

 private:
  std::vector<Layout> arrays_;
  std::vector<std::uint64_t> largestEnd_;  // within the buffer, up to this array
};

/// Data that is not positions but lies in the same bytes: patching would damage it.
std::string findConflict(const GltfDocument& document, const std::vector<std::uint32_t>& sameBuffer,
                         const PlaceIndex& index, const PositionArrays& result) {
  const auto message = [](std::uint32_t position, const std::string& other) {
    return concat("accessor ", position, " (POSITION) shares bytes with ", other);
  };
  for (std::uint32_t i = 0; i < document.accessors.size(); ++i) {
    const GltfAccessor& accessor = document.accessors[i];
    const std::string other = concat("accessor ", i, ", which holds other data");
    if (result.windowOf[i] != kNone) {
      if (accessor.usedOtherwise) return message(i, concat("itself under another name (", other, ")"));
      continue;
    }
    if (accessor.view == kNone || accessor.count == 0 || document.views[accessor.view].buffer == kNone) continue;
    const Layout layout = layoutOf(document, sameBuffer, i);
    if (layout.width == 0 || layout.stride == 0) continue;
    if (const Layout* array = index.findSharing(layout)) return message(array->accessor, other);
  }
  for (std::uint32_t i = 0; i < document.accessors.size(); ++i) {
    const GltfAccessor& accessor = document.accessors[i];
    if (!accessor.sparse || accessor.sparse->count == 0) continue;
    const GltfSparse& sparse = *accessor.sparse;
    const bool isPosition = result.windowOf[i] != kNone;
    const auto sharing = [&](std::uint32_t view, std::uint64_t offset, std::uint32_t width) -> const Layout* {
      if (view == kNone || document.views[view].buffer == kNone || width == 0) return nullptr;
      return index.findSharing(packedLayout(document, sameBuffer, i, view, offset, width));
    };
    const Layout* array = sharing(sparse.indicesView, sparse.indicesOffset, componentBytes(sparse.indicesType));
    if (array == nullptr && !isPosition) array = sharing(sparse.valuesView, sparse.valuesOffset, accessor.elementBytes());
    if (array != nullptr) return message(array->accessor, concat("the sparse part of accessor ", i));
  }
  const auto inRange = [&](std::uint32_t buffer, std::uint64_t start, std::uint64_t length) -> const Layout* {
    if (buffer == kNone || length == 0) return nullptr;
    Layout range;
    range.buffer = sameBuffer[buffer];
    range.start = start;
    range.stride = length;
    range.count = 1;
    range.width = static_cast<std::uint32_t>(length);
    return index.findSharing(range);
  };
  const auto inView = [&](std::uint32_t view) {
    const GltfView& v = document.views[view];
    return inRange(v.buffer, v.byteOffset, v.byteLength);
  };
  const auto holds = [&](const Layout* array, std::uint32_t view, const char* what) {
    return message(array->accessor, concat("bufferView ", view, ", which holds ", what));
  };
  for (const std::uint32_t view : document.imageViews)
    if (const Layout* array = inView(view)) return holds(array, view, "an image");
  for (const GltfBuffer& buffer : document.buffers)
    if (const auto& source = buffer.meshopt)
      if (const Layout* array = inRange(source->buffer, source->byteOffset, source->byteLength))
        return holds(array, source->view, "compressed data");
  for (const GltfPrimitive& primitive : document.primitives)
    if (primitive.draco && primitive.draco->view != kNone)
      if (const Layout* array = inView(primitive.draco->view))
        return holds(array, primitive.draco->view, "compressed data");
  return {};
}

}  // namespace

Result<PositionArrays> collectPositionArrays(const GltfDocument& document,
                                             const std::vector<std::uint32_t>& sameBuffer) {
  const std::vector<std::uint32_t> accessors = positionAccessors(document);
  std::vector<Layout> layouts, joined;
  for (const std::uint32_t accessor : accessors) {
    if (document.accessors[accessor].view != kNone) layouts.push_back(layoutOf(document, sameBuffer, accessor));
    if (document.accessors[accessor].sparse) layouts.push_back(valuesLayout(document, sameBuffer, accessor));
  }
  const std::vector<std::uint32_t> arrayOf = joinWindows(layouts, joined);

  PositionArrays result;
  const PlaceIndex index(joined);
  for (std::size_t i = 0; i < index.arrays().size() && result.conflict.empty(); ++i) {
    const Layout& array = index.arrays()[i];
    if (const Layout* other = index.findSharing(array, i)) {
      result.conflict =
          concat("accessor ", std::min(array.accessor, other->accessor), " and accessor ",
                 std::max(array.accessor, other->accessor), " hold positions that overlap with different layouts");
    }
  }

  result.windowOf.assign(document.accessors.size(), kNone);
  std::vector<std::uint32_t> number(joined.size(), kNone);  // joined -> result.arrays, in the order of first use
  for (const std::uint32_t array : arrayOf) {
    if (number[array] != kNone) continue;
    number[array] = static_cast<std::uint32_t>(result.arrays.size());
    const Layout& layout = joined[array];
    result.arrays.push_back(PositionArray{layout.buffer, layout.start, static_cast<std::uint32_t>(layout.stride),
                                          layout.count, result.vertexCount, layout.type});
    result.vertexCount += layout.count;
  }
  const auto addWindow = [&](const Layout& layout, std::uint32_t joinedArray) {
    const PositionArray& array = result.arrays[number[joinedArray]];
    const std::uint64_t skipped = (layout.start - array.start) / array.stride;
    PositionWindow window;
    window.accessor = layout.accessor;
    window.array = number[joinedArray];
    window.firstVertex = array.firstVertex + skipped;
    window.count = layout.count;
    result.windows.push_back(std::move(window));
    return static_cast<std::uint32_t>(result.windows.size() - 1);
  };
  std::size_t next = 0;  // in layouts
  for (const std::uint32_t accessor : accessors) {
    std::uint32_t window = kNone;
    if (document.accessors[accessor].view != kNone) {
      window = addWindow(layouts[next], arrayOf[next]);
      ++next;
    } else {
      window = static_cast<std::uint32_t>(result.windows.size());
      PositionWindow zeros;
      zeros.accessor = accessor;
      zeros.array = kNone;
      zeros.firstVertex = result.vertexCount++;
      zeros.count = document.accessors[accessor].count;
      result.windows.push_back(std::move(zeros));
    }
    result.windowOf[accessor] = window;
    if (!document.accessors[accessor].sparse) continue;
    result.windows[window].values = static_cast<std::uint32_t>(result.windows.size());
    addWindow(layouts[next], arrayOf[next]);
    ++next;
  }
  if (result.vertexCount > 0xfffffffeu) return tooLarge("glTF: more than 4294967294 vertices");

  // Positions of points and lines, or accessors nobody uses, that lie in an array move with it: their bounds follow.
  for (std::uint32_t i = 0; i < document.accessors.size(); ++i) {
    const GltfAccessor& accessor = document.accessors[i];
    const bool couldBe = result.windowOf[i] == kNone && !accessor.usedOtherwise && !accessor.sparse &&
                         accessor.view != kNone && accessor.count > 0 && accessor.components == 3 &&
                         document.views[accessor.view].buffer != kNone;
    if (!couldBe) continue;
    const Layout layout = layoutOf(document, sameBuffer, i);
    const Layout* inside = index.findSharing(layout);
    if (inside == nullptr || inside->stride != layout.stride || inside->residue() != layout.residue()) continue;
    if (!(inside->type == layout.type) || layout.start < inside->start || layout.end() > inside->end()) continue;
    result.windowOf[i] = addWindow(layout, inside->array);
  }
  if (result.conflict.empty()) result.conflict = findConflict(document, sameBuffer, index, result);
  return result;
}

std::uint32_t PositionArrays::vertexOf(const PositionWindow& window, std::uint32_t element) const {
  if (window.values != kNone) {
    const PositionWindow& values = windows[window.values];
    const auto found = std::lower_bound(values.replaced.begin(), values.replaced.end(), element);
    if (found != values.replaced.end() && *found == element)
      return static_cast<std::uint32_t>(values.firstVertex + static_cast<std::uint64_t>(found - values.replaced.begin()));
  }
  return static_cast<std::uint32_t>(window.firstVertex + (window.isStored() ? element : 0));
}

}  // namespace quadmark::io
