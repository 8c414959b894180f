// SPDX-License-Identifier: MIT
#include "gltf_sections.h"

namespace quadmark::io {

GltfSections findSections(JsonValue root, std::string_view text, std::size_t textBegin) {
  GltfSections sections;
  sections.text = text;
  sections.textBegin = textBegin;
  const struct {
    std::string_view name;
    JsonValue* value;
  } wanted[] = {{"asset", &sections.asset},
                {"buffers", &sections.buffers},
                {"bufferViews", &sections.bufferViews},
                {"accessors", &sections.accessors},
                {"meshes", &sections.meshes},
                {"nodes", &sections.nodes},
                {"materials", &sections.materials},
                {"textures", &sections.textures},
                {"images", &sections.images},
                {"skins", &sections.skins},
                {"animations", &sections.animations},
                {"extensionsUsed", &sections.extensionsUsed}};
  root.forEachMember([&](std::string_view key, JsonValue value) {
    for (const auto& entry : wanted) {
      if (keyIs(key, entry.name)) *entry.value = value;
    }
  });
  return sections;
}

void markOtherUses(const GltfSections& sections, GltfDocument& document) {
  const auto mark = [&](JsonValue reference) {
    const std::optional<std::uint64_t> index = reference.asUnsigned();
    if (index && *index < document.accessors.size()) {
      document.accessors[static_cast<std::size_t>(*index)].usedOtherwise = true;
    }
  };
  const auto markMembers = [&](JsonValue object) {
    object.forEachMember([&](std::string_view, JsonValue v) { mark(v); });
  };

  sections.meshes.forEachElement([&](JsonValue mesh) {
    mesh.find("primitives").forEachElement([&](JsonValue primitive) {
      mark(primitive.find("indices"));
      primitive.find("attributes").forEachMember([&](std::string_view name, JsonValue accessor) {
        if (!keyIs(name, "POSITION")) mark(accessor);
      });
      primitive.find("targets").forEachElement(markMembers);
    });
  });
  sections.skins.forEachElement([&](JsonValue skin) { mark(skin.find("inverseBindMatrices")); });
  sections.animations.forEachElement([&](JsonValue animation) {
    animation.find("samplers").forEachElement([&](JsonValue sampler) {
      mark(sampler.find("input"));
      mark(sampler.find("output"));
    });
  });
  sections.nodes.forEachElement(
      [&](JsonValue node) { markMembers(node.find("extensions").find("EXT_mesh_gpu_instancing").find("attributes")); });
  sections.images.forEachElement([&](JsonValue image) {
    const std::optional<std::uint64_t> view = image.find("bufferView").asUnsigned();
    if (view && *view < document.views.size()) document.imageViews.push_back(static_cast<std::uint32_t>(*view));
  });
}

}  // namespace quadmark::io
