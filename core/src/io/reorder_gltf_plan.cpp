// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "concat.h"
#include "gltf_sections.h"
#include "reorder_gltf.h"

namespace quadmark::io {
namespace {

constexpr std::uint32_t kForeign = kNone - 1;  // "group" of data that no array of positions owns

enum class Role : std::uint8_t { unused, attribute, index };

/// What an accessor is for.
struct Claim {
  std::uint32_t group = kNone;
  Role role = Role::unused;
};

std::string accessorName(std::uint32_t accessor) {
  return concat("accessor ", accessor);
}

/// Bytes of a buffer that are used once, and those used by more than one run.
class UseMap {
 public:
  explicit UseMap(std::size_t size) : once_(size), again_(size) {}

  void add(const ElementRun& run) {
    forEachByte(run, [&](std::size_t byte) {
      if (once_[byte]) again_[byte] = true;
      once_[byte] = true;
      return true;
    });
  }

  [[nodiscard]] bool shares(const ElementRun& run) const {
    return !forEachByte(run, [&](std::size_t byte) { return !again_[byte]; });
  }

 private:
  /// Visits while `visit` is true; returns whether it always was.
  template <class Visit>
  bool forEachByte(const ElementRun& run, const Visit& visit) const {
    for (std::uint64_t i = 0; i < run.count; ++i) {
      for (std::uint64_t byte = run.start + i * run.stride; byte < run.start + i * run.stride + run.width; ++byte) {
        if (byte >= once_.size()) return true;  // other buffer entries may claim more of the same file
        if (!visit(static_cast<std::size_t>(byte))) return false;
      }
    }
    return true;
  }

  std::vector<bool> once_, again_;
};

class Planner {
 public:
  Planner(const PositionArrays& positions, const GltfDocument& document, const GltfSections& sections,
          const GltfContainer& container, Bytes file, const Resources& resources)
      : positions_(positions),
        document_(document),
        sections_(sections),
        container_(container),
        file_(file),
        resources_(resources) {}

  GltfReorderPlan make() {
    plan_.groups.resize(positions_.arrays.size());
    claims_.resize(document_.accessors.size());
    claimAll();
    findBuffers();
    findRuns();
    findSharedBytes();
    return std::move(plan_);
  }

 private:
  void object(std::uint32_t group, const std::string& obstacle) {
    if (group < plan_.groups.size() && plan_.groups[group].obstacle.empty()) plan_.groups[group].obstacle = obstacle;
  }

  // 1. Who uses which accessor.

  void claim(JsonValue reference, std::uint32_t group, Role role) {
    const std::optional<std::uint64_t> index = reference.asUnsigned();
    if (!index || *index >= claims_.size()) {
      object(group, "a reference to an accessor is broken");
      return;
    }
    claim(static_cast<std::uint32_t>(*index), group, role);
  }

  void claim(std::uint32_t accessor, std::uint32_t group, Role role) {
    Claim& claimed = claims_[accessor];
    if (claimed.group == kNone) claimed = {group, role};
    if (claimed.group == group && claimed.role == role) return;
    object(claimed.group, accessorName(accessor) + " has other uses, too");
    object(group, accessorName(accessor) + " has other uses, too");
  }

  void claimMembers(JsonValue accessors, std::uint32_t group) {
    accessors.forEachMember([&](std::string_view, JsonValue reference) { claim(reference, group, Role::attribute); });
  }

  void claimAll() {
    for (const PositionWindow& window : positions_.windows) {
      if (window.accessor < claims_.size()) {
        claim(window.accessor, window.array, Role::attribute);
      } else {
        object(window.array, "its data is compressed");
      }
    }
    std::uint32_t meshIndex = 0;
    sections_.meshes.forEachElement([&](JsonValue mesh) {
      std::uint32_t primitiveIndex = 0;
      mesh.find("primitives").forEachElement([&](JsonValue primitive) {
        const std::string place = concat("mesh ", meshIndex, " primitive ", primitiveIndex++);
        claimPrimitive(primitive, mesh.find("extensions"), place);
      });
      ++meshIndex;
    });
    sections_.skins.forEachElement([&](JsonValue skin) {
      if (const JsonValue matrices = skin.find("inverseBindMatrices")) claim(matrices, kForeign, Role::attribute);
    });
    sections_.animations.forEachElement([&](JsonValue animation) {
      animation.find("samplers").forEachElement([&](JsonValue sampler) {
        claim(sampler.find("input"), kForeign, Role::attribute);
        claim(sampler.find("output"), kForeign, Role::attribute);
      });
    });
    sections_.nodes.forEachElement([&](JsonValue node) {
      claimMembers(node.find("extensions").find("EXT_mesh_gpu_instancing").find("attributes"), kForeign);
    });
  }

  void claimPrimitive(JsonValue primitive, JsonValue meshExtensions, const std::string& place) {
    const JsonValue attributes = primitive.find("attributes");
    const std::optional<std::uint64_t> position = attributes.find("POSITION").asUnsigned();
    const bool known = position && *position < positions_.windowOf.size();
    const std::uint32_t window = known ? positions_.windowOf[static_cast<std::size_t>(*position)] : kNone;
    const std::uint32_t group = window == kNone ? kForeign : positions_.windows[window].array;
    claimMembers(attributes, group);
    primitive.find("targets").forEachElement([&](JsonValue target) { claimMembers(target, group); });
    if (const JsonValue indices = primitive.find("indices")) {
      claim(indices, group, Role::index);
    } else {
      object(group, place + " has no indices");
    }
    checkExtensions(primitive.find("extensions"), group, place);
    checkExtensions(meshExtensions, group, place);
  }

  /// Extensions may hold vertex indices or packed vertices of their own (CESIUM_primitive_outline, EXT_mesh_manifold).
  void checkExtensions(JsonValue extensions, std::uint32_t group, const std::string& place) {
    constexpr std::string_view kHarmless[] = {"KHR_materials_variants", "EXT_mesh_features", "EXT_structural_metadata",
                                              "FB_ngon_encoding",       "KHR_xmp_json_ld",   "KHR_xmp"};
    extensions.forEachMember([&](std::string_view name, JsonValue) {
      const bool harmless = std::any_of(std::begin(kHarmless), std::end(kHarmless),
                                        [&](std::string_view other) { return keyIs(name, other); });
      if (!harmless) object(group, concat(place, " has the extension ", quoted(name)));
    });
  }

  // 2. The buffers that groups need. A missing one is an obstacle only, since reading did not need it.

  void findBuffers() {
    std::vector<bool> wanted(document_.buffers.size());
    for (std::size_t i = 0; i < claims_.size(); ++i) {
      const GltfAccessor& accessor = document_.accessors[i];
      if (claims_[i].group >= kForeign || accessor.view == kNone) continue;
      if (const std::uint32_t buffer = document_.views[accessor.view].buffer; buffer != kNone) wanted[buffer] = true;
    }
    plan_.places.resize(document_.buffers.size());
    plan_.buffers.resize(document_.buffers.size());
    sameBuffer_.resize(document_.buffers.size());
    isOpen_.resize(document_.buffers.size());
    std::map<std::string, std::uint32_t> byKey;
    for (std::uint32_t i = 0; i < sameBuffer_.size(); ++i) {
      plan_.places[i] = place(i);
      const bool resource = plan_.places[i].source == BufferPlace::Source::resource;
      sameBuffer_[i] = resource ? byKey.emplace(plan_.places[i].key, i).first->second : i;
      if (wanted[i] && plan_.places[i].source != BufferPlace::Source::absent) open(i);
    }
  }

  [[nodiscard]] BufferPlace place(std::uint32_t buffer) const {
    if (!document_.buffers[buffer].hasUri && buffer != 0) return {};
    GltfDocument alone;  // so that another buffer's flaw is not this one's
    alone.buffers.push_back(document_.buffers[buffer]);
    alone.views.emplace_back();
    alone.views[0].buffer = 0;
    alone.views[0].needed = true;
    Result<std::vector<BufferPlace>> places = placeBuffers(alone, container_, file_, resources_);
    return places.ok() ? std::move(places.value()[0]) : BufferPlace{};
  }

  void open(std::uint32_t buffer) {
    Result<BufferBytes> opened = openBuffer(plan_.places[buffer], buffer, container_, file_, resources_);
    if (!opened.ok()) return;
    isOpen_[buffer] = true;
    // Two entries for one file: its bytes are kept at the lower one, though perhaps only the other one is needed.
    plan_.buffers[sameBuffer_[buffer]] = std::move(opened).value();
  }

  // 3. Accessors as bytes.

  /// An accessor's elements, or nothing with `why` when they are not plain.
  [[nodiscard]] std::optional<ElementRun> runOf(std::uint32_t index, std::string& why) const {
    const GltfAccessor& accessor = document_.accessors[index];
    why = accessorName(index);
    if (accessor.view == kNone || document_.views[accessor.view].buffer == kNone)
      return why += " has no data", std::nullopt;
    const GltfView& view = document_.views[accessor.view];
    if (!view.compression.empty()) return why += " is compressed by " + view.compression, std::nullopt;
    ElementRun run;
    run.buffer = sameBuffer_[view.buffer];
    run.start = view.byteOffset + accessor.byteOffset;
    run.width = accessor.elementBytes();
    run.stride = view.byteStride == 0 ? run.width : view.byteStride;
    run.count = accessor.count;
    const bool fits = run.count > 0 && run.width > 0 && run.stride >= run.width &&
                      accessor.byteOffset <= view.byteLength && run.width <= view.byteLength - accessor.byteOffset &&
                      run.count - 1 <= (view.byteLength - accessor.byteOffset - run.width) / run.stride;
    if (!fits) return why += " does not fit into its bufferView", std::nullopt;
    return run;
  }

  void checkAttribute(std::uint32_t index, std::uint32_t group, const ElementRun& run) {
    const GltfAccessor& accessor = document_.accessors[index];
    const std::uint64_t vertices = positions_.arrays[group].count;
    if (run.count != vertices) {
      object(group, concat(accessorName(index), " has ", run.count, " elements for ", vertices, " vertices"));
    }
    // The columns of small matrices are padded, so their size is not that of their components.
    if (isMatrix_[index] || accessor.components > 4) object(group, accessorName(index) + " holds matrices");
  }

  void checkIndices(std::uint32_t index, std::uint32_t group, const ElementRun& run) {
    const GltfAccessor& accessor = document_.accessors[index];
    const bool isUnsigned =
        accessor.componentType == 5121 || accessor.componentType == 5123 || accessor.componentType == 5125;
    const bool plain = accessor.components == 1 && isUnsigned && run.stride == run.width;
    if (!plain) object(group, accessorName(index) + " does not hold plain indices");
    // Only the first vertices are referred to, but then others cannot take their place.
    const std::uint64_t largest = (std::uint64_t{1} << (8 * run.width)) - 2;  // the last one is reserved for restarts
    if (plain && positions_.arrays[group].count - 1 > largest) {
      object(group, accessorName(index) + " cannot hold every vertex index");
    }
  }

  void findRuns() {
    sections_.accessors.forEachElement(
        [&](JsonValue accessor) { isMatrix_.push_back(accessor.find("type").asString().substr(0, 3) == "MAT"); });
    using Key = std::tuple<std::uint32_t, std::uint64_t, std::uint64_t, std::uint64_t, std::uint32_t>;
    struct Known {
      std::uint32_t group;
      Role role;
      std::uint32_t componentType;
      std::size_t index;  // of an index run in its group
    };
    std::map<Key, Known> known;
    for (std::uint32_t i = 0; i < claims_.size(); ++i) {
      const GltfAccessor& accessor = document_.accessors[i];
      const std::uint32_t group = std::min(claims_[i].group, kForeign);
      const Role role = claims_[i].role;
      std::string why;
      const std::optional<ElementRun> run = runOf(i, why);
      if (accessor.sparse) object(group, accessorName(i) + " is sparse");
      if (!run) {
        object(group, why);
        continue;
      }
      if (group != kForeign) {
        if (!isOpen_[document_.views[accessor.view].buffer])
          object(group, accessorName(i) + " lies in a buffer that was not given");
        role == Role::index ? checkIndices(i, group, *run) : checkAttribute(i, group, *run);
      }
      const std::uint32_t componentType = role == Role::index ? accessor.componentType : 0;
      const auto [entry, isNew] = known.emplace(Key{run->buffer, run->start, run->stride, run->count, run->width},
                                                Known{group, role, componentType, 0});
      Known& first = entry->second;
      if (!isNew && (first.group != group || first.role != role || first.componentType != componentType)) {
        object(first.group, accessorName(i) + " reads the same bytes for another purpose");
        object(group, accessorName(i) + " reads bytes of another accessor");
        continue;
      }
      if (isNew) runs_.push_back(*run);
      if (group == kForeign) continue;
      ReorderGroup& owner = plan_.groups[group];
      if (isNew && role == Role::attribute) owner.attributes.push_back(*run);
      if (role != Role::index) continue;
      if (isNew) {
        first.index = owner.indices.size();
        owner.indices.push_back(IndexRun{*run, accessor.componentType, {}, {}});
      }
      if (!accessor.min.empty()) owner.indices[first.index].min.push_back(accessor.min);
      if (!accessor.max.empty()) owner.indices[first.index].max.push_back(accessor.max);
    }
  }

  // 4. Bytes that more than one run uses.

  void addView(std::uint64_t index) {
    if (index >= document_.views.size() || document_.views[static_cast<std::size_t>(index)].buffer == kNone) return;
    const GltfView& view = document_.views[static_cast<std::size_t>(index)];
    const auto width = static_cast<std::uint32_t>(view.byteLength);  // below 2^32, as all sizes that were read
    if (seenViews_.insert(index).second)
      runs_.push_back(ElementRun{sameBuffer_[view.buffer], view.byteOffset, view.byteLength, 1, width});
  }

  void findSharedBytes() {
    for (const std::uint32_t view : document_.imageViews) addView(view);
    sections_.accessors.forEachElement([&](JsonValue accessor) {
      const JsonValue sparse = accessor.find("sparse");
      for (const char* part : {"indices", "values"}) {
        if (const auto view = sparse.find(part).find("bufferView").asUnsigned()) addView(*view);
      }
    });
    std::vector<std::optional<UseMap>> uses(plan_.buffers.size());
    std::uint64_t opened = 0, visited = 0;
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (plan_.buffers[i].bytes.empty() || sameBuffer_[i] != i) continue;
      uses[i].emplace(plan_.buffers[i].bytes.size());
      opened += plan_.buffers[i].bytes.size();
    }
    // Overlapping accessors could ask for any amount of work. Sane files use each byte once or twice.
    constexpr std::uint64_t kMostUsesPerByte = 16;
    for (const ElementRun& run : runs_) {
      if (!uses[run.buffer]) continue;
      visited += run.count * run.width;
      if (visited / kMostUsesPerByte > opened) {
        for (std::uint32_t group = 0; group < plan_.groups.size(); ++group)
          object(group, "accessors reuse the same bytes too often");
        return;
      }
      uses[run.buffer]->add(run);
    }
    for (std::uint32_t group = 0; group < plan_.groups.size(); ++group) {
      const auto check = [&](const ElementRun& run) {
        if (uses[run.buffer] && uses[run.buffer]->shares(run)) object(group, "other data lies in the same bytes");
      };
      for (const ElementRun& run : plan_.groups[group].attributes) check(run);
      for (const IndexRun& indices : plan_.groups[group].indices) check(indices.run);
    }
  }

  const PositionArrays& positions_;
  const GltfDocument& document_;
  const GltfSections& sections_;
  const GltfContainer& container_;
  Bytes file_;
  const Resources& resources_;

  GltfReorderPlan plan_;
  std::vector<Claim> claims_;              // per accessor
  std::vector<bool> isMatrix_;             // per accessor
  std::vector<std::uint32_t> sameBuffer_;  // buffer -> lowest buffer with the same bytes
  std::vector<bool> isOpen_;               // buffers whose bytes are there in full
  std::vector<ElementRun> runs_;           // all distinct uses of bytes
  std::set<std::uint64_t> seenViews_;
};

}  // namespace

Result<GltfReorderPlan> planGltfReorder(const PositionArrays& positions, const GltfContainer& container, Bytes file,
                                        const Resources& resources) {
  const std::string_view json = container.json(file);
  const Result<JsonValue> root = parseJson(json);
  if (!root) return root.error();
  const Result<GltfDocument> document = readGltfDocument(json, container.jsonBegin);
  if (!document) return document.error();
  // Accessors of decoded data come behind those of the file.
  if (document->accessors.size() > positions.windowOf.size()) {
    return Error{ErrorCode::badOption, "reorder: these are not the bytes that were read"};
  }
  const GltfSections sections = findSections(*root, json, container.jsonBegin);
  return Planner(positions, *document, sections, container, file, resources).make();
}

}  // namespace quadmark::io
