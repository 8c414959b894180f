// SPDX-License-Identifier: MIT
#include "gltf_normalise.h"

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

#include <set>
#include <tuple>

namespace quadmark::io {
namespace {

const char* typeName(std::uint32_t components) {
  switch (components) {
    case 1:
      return "SCALAR";
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    case 9:
      return "MAT3";
    default:
      return "MAT4";
  }
}

/// The normalised text and, per entry in it, the entry of the document that it stands for.
struct Draft {
  std::string text;
  std::vector<std::size_t> views, accessors, primitives;
};

class Writer {
 public:
  explicit Writer(const GltfDocument& document) : document_(document) {}

  Draft write() {
    draft_.text = R"({"asset":{"version":"2.0"},"bufferViews":[)";
    writeViews();
    draft_.text += R"(],"accessors":[)";
    writeAccessors();
    draft_.text += R"(],"meshes":[)";
    writeMeshes();
    draft_.text += "]}";
    return std::move(draft_);
  }

 private:
  void member(const char* name, std::uint64_t value) {
    const char last = draft_.text.back();
    if (last != '{') draft_.text += ',';
    draft_.text.append("\"").append(name).append("\":").append(std::to_string(value));
  }
  void beginItem(bool first) { draft_.text += first ? "{" : ",{"; }

  void writeViews() {
    viewNumber_.assign(document_.views.size(), kNone);
    for (std::size_t i = 0; i < document_.views.size(); ++i) {
      const GltfView& view = document_.views[i];
      if (!view.needed || view.buffer == kNone) continue;
      beginItem(draft_.views.empty());
      member("buffer", view.buffer);
      member("byteOffset", view.byteOffset);
      member("byteLength", view.byteLength);
      member("byteStride", view.byteStride);
      draft_.text += '}';
      viewNumber_[i] = static_cast<std::uint32_t>(draft_.views.size());
      draft_.views.push_back(i);
    }
  }

  void writeAccessors() {
    accessorNumber_.assign(document_.accessors.size(), kNone);
    for (std::size_t i = 0; i < document_.accessors.size(); ++i) {
      const GltfAccessor& accessor = document_.accessors[i];
      if (!accessor.needed || accessor.view == kNone || viewNumber_[accessor.view] == kNone) continue;
      beginItem(draft_.accessors.empty());
      member("bufferView", viewNumber_[accessor.view]);
      member("byteOffset", accessor.byteOffset);
      member("componentType", accessor.componentType);
      member("count", accessor.count);
      draft_.text.append(R"(,"type":")").append(typeName(accessor.components)).append("\"}");
      accessorNumber_[i] = static_cast<std::uint32_t>(draft_.accessors.size());
      draft_.accessors.push_back(i);
    }
  }

  /// One mesh per primitive, equal ones once: nothing but the pairing of accessors matters here.
  void writeMeshes() {
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> seen;
    for (std::size_t i = 0; i < document_.primitives.size(); ++i) {
      const GltfPrimitive& primitive = document_.primitives[i];
      const bool indexed = primitive.indices != kNone;
      if (!primitive.hasTriangles() || accessorNumber_[primitive.position] == kNone) continue;
      if (indexed && accessorNumber_[primitive.indices] == kNone) continue;
      if (!seen.emplace(primitive.position, primitive.indices, primitive.mode).second) continue;
      beginItem(draft_.primitives.empty());
      draft_.text += R"("primitives":[{"attributes":{)";
      member("POSITION", accessorNumber_[primitive.position]);
      draft_.text += '}';
      if (indexed) member("indices", accessorNumber_[primitive.indices]);
      member("mode", primitive.mode);
      draft_.text += "}]}";
      draft_.primitives.push_back(i);
    }
  }

  const GltfDocument& document_;
  Draft draft_;
  std::vector<std::uint32_t> viewNumber_, accessorNumber_;
};

Error disagreement(const std::string& what) {
  return Error{ErrorCode::internal, "tinygltf reads the document model differently: " + what};
}

}  // namespace

Status loadThroughTinygltf(GltfDocument& document) {
  const Draft draft = Writer(document).write();
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  if (draft.text.size() > 0xffffffffu) return tooLarge("glTF: the document model is too large");
  const auto length = static_cast<unsigned int>(draft.text.size());
  if (!loader.LoadASCIIFromString(&model, &error, &warning, draft.text.c_str(), length, "")) return disagreement(error);
  if (model.bufferViews.size() != draft.views.size() || model.accessors.size() != draft.accessors.size() ||
      model.meshes.size() != draft.primitives.size()) {
    return disagreement("another number of entries");
  }
  for (std::size_t i = 0; i < draft.views.size(); ++i) {
    GltfView& view = document.views[draft.views[i]];
    view.buffer = static_cast<std::uint32_t>(model.bufferViews[i].buffer);
    view.byteOffset = model.bufferViews[i].byteOffset;
    view.byteLength = model.bufferViews[i].byteLength;
    view.byteStride = static_cast<std::uint32_t>(model.bufferViews[i].byteStride);
  }
  for (std::size_t i = 0; i < draft.accessors.size(); ++i) {
    const tinygltf::Accessor& loaded = model.accessors[i];
    GltfAccessor& accessor = document.accessors[draft.accessors[i]];
    if (loaded.bufferView < 0 || static_cast<std::size_t>(loaded.bufferView) >= draft.views.size()) {
      return disagreement("accessor " + std::to_string(draft.accessors[i]));
    }
    accessor.view = static_cast<std::uint32_t>(draft.views[loaded.bufferView]);
    accessor.byteOffset = loaded.byteOffset;
    accessor.count = loaded.count;
    accessor.componentType = static_cast<std::uint32_t>(loaded.componentType);
    accessor.components =
        static_cast<std::uint32_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(loaded.type)));
  }
  for (std::size_t i = 0; i < draft.primitives.size(); ++i) {
    GltfPrimitive& primitive = document.primitives[draft.primitives[i]];
    const std::vector<tinygltf::Primitive>& loaded = model.meshes[i].primitives;
    const auto position =
        loaded.empty() ? std::map<std::string, int>::const_iterator{} : loaded[0].attributes.find("POSITION");
    if (loaded.size() != 1 || position == loaded[0].attributes.end()) return disagreement(primitive.place());
    primitive.position = static_cast<std::uint32_t>(draft.accessors[position->second]);
    primitive.indices = loaded[0].indices < 0 ? kNone : static_cast<std::uint32_t>(draft.accessors[loaded[0].indices]);
    primitive.mode = static_cast<std::uint32_t>(loaded[0].mode);
  }
  return okStatus();
}

}  // namespace quadmark::io
