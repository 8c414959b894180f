// SPDX-License-Identifier: MIT
#include "gltf_decompress.h"

#include <algorithm>

#include "concat.h"
#include "gltf_bounds.h"

namespace quadmark::io {
namespace {

constexpr const char* kMeshoptNames[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
constexpr std::uint32_t kVertexTarget = 34962, kIndexTarget = 34963;

JsonValue dracoOf(JsonValue primitive) {
  return primitive.find("extensions").find(kDracoExtension);
}

/// Elements of vertex data begin at multiples of 4.
std::vector<std::uint8_t> aligned(Bytes packed, std::uint32_t elementBytes, std::uint32_t stride) {
  if (elementBytes == stride) return {packed.begin(), packed.end()};
  const std::size_t count = packed.size() / elementBytes;
  std::vector<std::uint8_t> out(count * stride);
  for (std::size_t i = 0; i < count; ++i) std::memcpy(&out[i * stride], &packed[i * elementBytes], elementBytes);
  return out;
}

/// ,"min":[..],"max":[..] of packed positions.
std::string boundsText(Bytes positions, std::uint32_t componentType) {
  const std::uint64_t elementBytes = 3 * componentBytes(componentType);
  const std::vector<CodeRange> ranges =
      codeRanges(positions.data(), elementBytes, positions.size() / elementBytes, componentType, 3);
  std::string text;
  for (const bool isLow : {true, false}) {
    text += isLow ? R"(,"min":[)" : R"(,"max":[)";
    for (const CodeRange& range : ranges) {
      if (text.back() != '[') text += ',';
      text += spellBound(isLow ? range.low : range.high, componentType);
    }
    text += ']';
  }
  return text;
}

}  // namespace

Decompression::Decompression(GltfEdits& edits) : edits_(edits) {
  const JsonValue root = edits.root();
  views_ = root.find("bufferViews").elements();
  accessors_ = root.find("accessors").elements();
  root.find("meshes").forEachElement([&](JsonValue mesh) {
    mesh.find("primitives").forEachElement([&](JsonValue primitive) {
      if (dracoOf(primitive)) dracoPrimitives_.push_back(primitive);
    });
  });
}

/// Removes extensions from a view or primitive, and the list when it has no others.
void Decompression::removeExtension(JsonValue owner, std::initializer_list<const char*> names) {
  const JsonValue extensions = owner.find("extensions");
  bool keepsOthers = false;
  extensions.forEachMember([&](std::string_view key, JsonValue) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const char* name) { return keyIs(key, name); });
    if (found == names.end()) {
      keepsOthers = true;
    } else {
      ++decoded_[*found];
    }
  });
  if (!keepsOthers) return edits_.json().removeMember(owner, "extensions");
  for (const char* name : names) edits_.json().removeMember(extensions, name);
}

void Decompression::replaceView(std::uint32_t view, Bytes plain) {
  const GltfEdits::Place place = edits_.appendBytes(plain);
  edits_.json().setMember(views_[view], "buffer", std::to_string(place.buffer));
  edits_.json().setMember(views_[view], "byteOffset", std::to_string(place.byteOffset));
  removeExtension(views_[view], {kMeshoptNames[0], kMeshoptNames[1]});
  replacedViews_.insert(view);
  for (const JsonValue& accessor : accessors_) {
    if (accessor.find("bufferView").asUnsigned() == std::uint64_t{view}) correctBounds(accessor, view, plain);
  }
}

/// Nobody could check the bounds of compressed data, and some tools declare those of what they had before their filter
/// rounded it. Of plain data they must be true.
void Decompression::correctBounds(JsonValue accessor, std::uint32_t view, Bytes plain) {
  if (accessor.find("sparse")) return;  // its elements lie elsewhere, too; of positions, GltfModel sees to it
  const std::string type = accessor.find("type").asString();
  const std::uint32_t components = componentsOfType(type);
  const std::uint64_t componentType = accessor.find("componentType").asUnsigned().value_or(0);
  const bool isVector = type == "SCALAR" || type.substr(0, 3) == "VEC";
  if (componentType != kGltfFloat && (!isVector || componentType < kGltfInt8 || componentType > kGltfUint16)) return;
  const std::uint64_t elementBytes = components * componentBytes(static_cast<std::uint32_t>(componentType));
  const std::uint64_t declaredStride = views_[view].find("byteStride").asUnsigned().value_or(0);
  const std::uint64_t stride = declaredStride == 0 ? elementBytes : declaredStride;
  const std::uint64_t offset = accessor.find("byteOffset").asUnsigned().value_or(0);
  const std::uint64_t count = accessor.find("count").asUnsigned().value_or(0);
  if (components == 0 || count == 0 || offset > plain.size() || elementBytes > plain.size() - offset) return;
  if (count - 1 > (plain.size() - offset - elementBytes) / stride) return;  // broken: not ours to mend

  const std::vector<CodeRange> ranges =
      codeRanges(plain.data() + offset, stride, count, static_cast<std::uint32_t>(componentType), components);
  for (const bool isLow : {true, false}) {
    const JsonValue bounds = accessor.find(isLow ? "min" : "max");
    if (!bounds.isArray() || bounds.elementCount() != components) continue;
    std::size_t k = 0;
    bounds.forEachElement([&](JsonValue declared) {
      const CodeRange& range = ranges[k++];
      correctBound(declared, isLow ? range.low : range.high, static_cast<std::uint32_t>(componentType), edits_.json());
    });
  }
}

/// The attributes besides positions that primitives take from their Draco stream.
Result<std::vector<Decompression::Column>> Decompression::columnsOf(const std::vector<JsonValue>& primitives,
                                                                    const DracoStream& stream) const {
  std::vector<Column> columns;
  Status status = okStatus();
  for (const JsonValue& primitive : primitives) {
    const JsonValue attributes = primitive.find("attributes");
    dracoOf(primitive).find("attributes").forEachMember([&](std::string_view spelled, JsonValue id) {
      const std::string name = unescapeJson(spelled);
      const std::optional<std::uint64_t> accessor = attributes.find(name).asUnsigned();
      if (!accessor || *accessor >= accessors_.size() || !id.asUnsigned() || name == "POSITION") return;
      const JsonValue json = accessors_[static_cast<std::size_t>(*accessor)];
      Column column;
      column.name = name;
      column.attribute.id = static_cast<std::uint32_t>(*id.asUnsigned());
      column.attribute.componentType = static_cast<std::uint32_t>(json.find("componentType").asUnsigned().value_or(0));
      column.attribute.components = componentsOfType(json.find("type").asString());
      column.type = json.find("type").text();
      column.normalized = json.find("normalized").text();
      const auto known =
          std::find_if(columns.begin(), columns.end(), [&](const Column& other) { return other.name == name; });
      if (known == columns.end()) {
        columns.push_back(column);
      } else if (known->attribute.id != column.attribute.id || known->type != column.type ||
                 known->attribute.componentType != column.attribute.componentType) {
        status = unsupportedFile(concat(stream.place, ": primitives read ", name, " from its Draco data in two ways"));
      }
    });
  }
  if (!status) return status.error();
  return columns;
}

/// Appends packed elements with a view and an accessor over them, and returns the accessor's index, spelled.
/// @param members  the accessor's further members, each with its comma.
std::string Decompression::appendAccessor(Bytes packed, std::uint32_t elementBytes, std::uint32_t componentType,
                                          const std::string& members) {
  const bool isVertexData = elementBytes != 0;
  const std::uint32_t stride = (elementBytes + 3) / 4 * 4;
  const std::uint32_t view = isVertexData
                                 ? edits_.appendView(aligned(packed, elementBytes, stride), stride, kVertexTarget)
                                 : edits_.appendView(packed, 0, kIndexTarget);
  std::string json = R"({"bufferView":)";
  json.append(std::to_string(view)).append(R"(,"componentType":)").append(std::to_string(componentType));
  return std::to_string(edits_.addAccessor(json.append(members).append("}")));
}

Status Decompression::replaceStream(const DracoStream& stream, Bytes bytes, Bytes positions,
                                    std::uint64_t memoryLimit) {
  // 1. The primitives drawn from the stream, and what they take from it.
  std::vector<JsonValue> primitives, others;
  for (const JsonValue& primitive : dracoPrimitives_) {
    const bool isOurs =
        dracoOf(primitive).find("bufferView").asUnsigned() == std::uint64_t{stream.view} &&
        dracoOf(primitive).find("attributes").find("POSITION").asUnsigned() == std::uint64_t{stream.position};
    (isOurs ? primitives : others).push_back(primitive);
  }
  const Result<std::vector<Column>> columns = columnsOf(primitives, stream);
  if (!columns) return columns.error();
  std::vector<DracoAttribute> wanted;
  for (const Column& column : *columns) wanted.push_back(column.attribute);
  const Result<DracoMesh> mesh = decodeDraco(bytes, wanted, memoryLimit, stream.place);
  if (!mesh) return mesh.error();

  // 2. Plain accessors of it.
  std::map<std::string, std::string> accessorOf;  // attribute -> index
  const auto count = [](std::uint64_t elements) { return concat(R"(,"count":)", elements, R"(,"type":)"); };
  accessorOf["POSITION"] =
      appendAccessor(positions, 3 * componentBytes(stream.componentType), stream.componentType,
                     concat((stream.normalized ? R"(,"normalized":true)" : ""), count(mesh->pointCount), R"("VEC3")",
                            boundsText(positions, stream.componentType)));
  for (std::size_t i = 0; i < columns->size(); ++i) {
    const Column& column = (*columns)[i];
    std::string members;
    if (!column.normalized.empty()) members.append(R"(,"normalized":)").append(column.normalized);
    accessorOf[column.name] =
        appendAccessor(mesh->values[i], column.attribute.components * componentBytes(column.attribute.componentType),
                       column.attribute.componentType, members + count(mesh->pointCount) + column.type);
  }
  const std::uint32_t indexType = mesh->pointCount <= 0xffff ? kGltfUint16 : kGltfUint32;
  std::vector<std::uint8_t> indices(mesh->indices.size() * componentBytes(indexType));
  for (std::size_t i = 0; i < mesh->indices.size(); ++i) {
    if (indexType == kGltfUint16) store(&indices[2 * i], static_cast<std::uint16_t>(mesh->indices[i]));
    if (indexType == kGltfUint32) store(&indices[4 * i], mesh->indices[i]);
  }
  const std::string indexAccessor = appendAccessor(indices, 0, indexType, count(mesh->indices.size()) + R"("SCALAR")");

  // 3. The primitives refer to them.
  for (const JsonValue& primitive : primitives) {
    const JsonValue attributes = primitive.find("attributes");
    for (const auto& entry : accessorOf) {
      const bool takesIt = dracoOf(primitive).find("attributes").find(entry.first) && attributes.find(entry.first);
      if (takesIt) edits_.json().setMember(attributes, entry.first, entry.second);
    }
    edits_.json().setMember(primitive, "indices", indexAccessor);
    if (primitive.find("mode")) edits_.json().setMember(primitive, "mode", "4");  // triangles, even if it was a strip
    removeExtension(primitive, {kDracoExtension});
  }
  dracoPrimitives_ = std::move(others);
  return okStatus();
}

bool Decompression::isStillUsed(std::string_view extension) const {
  if (extension == kDracoExtension) return !dracoPrimitives_.empty();
  bool used = false;
  for (std::uint32_t i = 0; i < views_.size() && !used; ++i) {
    used = replacedViews_.count(i) == 0 && views_[i].find("extensions").find(extension);
  }
  // A placeholder for fallback data carries the extension too.
  edits_.root().find("buffers").forEachElement(
      [&](JsonValue buffer) { used = used || buffer.find("extensions").find(extension); });
  return used;
}

std::vector<std::string> Decompression::finish() {
  std::vector<std::string> warnings;
  for (const auto& entry : decoded_) {
    const std::string& extension = entry.first;
    const std::uint64_t count = entry.second;
    const std::string things = extension == kDracoExtension ? "primitive" : "bufferView";
    warnings.push_back(concat("the data of ", count, " ", things, count == 1 ? "" : "s",
                              " with marked positions is plain now, no longer compressed by ", extension,
                              "; compress the marked file anew if its size matters, with as many bits as before"));
    if (isStillUsed(extension)) continue;
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      const JsonValue names = edits_.root().find(list);
      std::vector<std::size_t> found;
      std::size_t index = 0;
      names.forEachElement([&](JsonValue name) {
        if (name.asString() == extension) found.push_back(index);
        ++index;
      });
      if (found.empty()) continue;
      if (found.size() == index) {
        edits_.json().removeMember(edits_.root(), list);  // an empty list is not allowed
      } else {
        for (const std::size_t i : found) edits_.json().removeElement(names, i);
      }
    }
  }
  return warnings;
}

}  // namespace quadmark::io
