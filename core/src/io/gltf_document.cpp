// SPDX-License-Identifier: MIT
#include "gltf_document.h"

#include <algorithm>

#include "concat.h"
#include "gltf_fields.h"
#include "gltf_sections.h"

namespace quadmark::io {
namespace {

constexpr std::uint64_t kMostEntries = std::uint64_t{1} << 20;
constexpr std::uint64_t kMostPrimitives = std::uint64_t{1} << 18;
constexpr std::uint64_t kLargestSize = 0xffffffff;  // of anything counted in bytes or elements, on every platform

Status checkEntryCount(const char* what, std::uint64_t count, std::uint64_t most = kMostEntries) {
  if (count <= most) return okStatus();
  return tooLarge(concat("glTF: more than ", most, " ", what));
}

Status readDraco(JsonValue extension, GltfPrimitive& primitive, GltfDocument& document) {
  const std::string place = concat(primitive.place(), " ", kDracoExtension);
  if (document.views.empty()) return badFile(place + ": the file has no bufferViews");
  FieldReader fields(extension, place);
  FieldReader attributes(extension.find("attributes"), place + " attributes");
  GltfDraco draco;
  draco.view = static_cast<std::uint32_t>(fields.required("bufferView", document.views.size() - 1));
  draco.position = static_cast<std::uint32_t>(attributes.required("POSITION", kLargestSize));
  if (fields.error()) return *fields.error();
  if (attributes.error()) return *attributes.error();
  document.views[draco.view].needed = true;
  primitive.draco = draco;
  return okStatus();
}

void readTextureCoordinates(JsonValue json, GltfPrimitive& primitive, GltfDocument& document) {
  primitive.material = static_cast<std::uint32_t>(json.find("material").asUnsigned().value_or(kNone));
  for (std::size_t set = 0; set < primitive.textureCoordinates.size(); ++set) {
    const auto accessor = json.find("attributes").find(concat("TEXCOORD_", set)).asUnsigned();
    if (!accessor || *accessor >= document.accessors.size()) continue;
    primitive.textureCoordinates[set] = static_cast<std::uint32_t>(*accessor);
    document.accessors[primitive.textureCoordinates[set]].needed = true;
  }
}

Status readPrimitive(JsonValue json, GltfPrimitive primitive, GltfDocument& document) {
  const std::uint64_t lastAccessor = document.accessors.size() - 1;  // only used when there is one
  FieldReader fields(json, primitive.place());
  primitive.mode = static_cast<std::uint32_t>(fields.optional("mode", 4, 0x7fffffff));
  const JsonValue attributes = json.find("attributes");
  const JsonValue position = attributes.find("POSITION");
  if (fields.error()) return *fields.error();
  if (!position) {
    document.warn(primitive.place() + ": no POSITION, passed through");
    return okStatus();
  }
  if (!primitive.hasTriangles()) {
    document.warn(concat(primitive.place(), ": ", primitiveModeName(primitive.mode), " are passed through"));
  }
  if (document.accessors.empty()) return badFile(primitive.place() + ": the file has no accessors");
  FieldReader positionField(attributes, primitive.place());
  primitive.position = static_cast<std::uint32_t>(positionField.required("POSITION", lastAccessor));
  if (positionField.error()) {
    if (!primitive.hasTriangles()) return okStatus();
    return *positionField.error();
  }
  if (const JsonValue draco = json.find("extensions").find(kDracoExtension); draco && primitive.hasTriangles()) {
    if (Status status = readDraco(draco, primitive, document); !status) return status;
  } else if (primitive.hasTriangles() && json.find("indices")) {
    primitive.indices = static_cast<std::uint32_t>(fields.required("indices", lastAccessor));
    if (fields.error()) return *fields.error();
  }
  if (document.withTextures && primitive.hasTriangles() && !primitive.draco) {
    readTextureCoordinates(json, primitive, document);
  }
  document.primitives.push_back(primitive);
  return checkEntryCount("primitives", document.primitives.size(), kMostPrimitives);
}

Status readMeshes(const GltfSections& sections, GltfDocument& document) {
  Status status = okStatus();
  sections.meshes.forEachElement([&](JsonValue mesh) {
    std::uint32_t index = 0;
    mesh.find("primitives").forEachElement([&](JsonValue json) {
      if (!status) return;
      GltfPrimitive primitive;
      primitive.mesh = static_cast<std::uint32_t>(document.meshCount);
      primitive.index = index++;
      status = readPrimitive(json, primitive, document);
    });
    document.primitiveCount += index;
    ++document.meshCount;
  });
  for (const GltfPrimitive& primitive : document.primitives) {
    if (!primitive.hasTriangles() || primitive.draco) continue;
    document.accessors[primitive.position].needed = true;
    if (primitive.indices != kNone) document.accessors[primitive.indices].needed = true;
  }
  return status;
}

FileSpan spanOf(JsonValue value, const char* jsonText, std::size_t jsonBegin) {
  if (!value) return {};
  const std::size_t begin = jsonBegin + static_cast<std::size_t>(value.text().data() - jsonText);
  return {begin, begin + value.text().size()};
}

/// The sparse member of an accessor; what is wrong goes to `fields`.
GltfSparse readSparse(JsonValue json, const std::string& accessor, const GltfDocument& document, FieldReader& fields) {
  GltfSparse sparse;
  FieldReader own(json, accessor + " sparse"), indices(json.find("indices"), accessor + " sparse.indices"),
      values(json.find("values"), accessor + " sparse.values");
  sparse.count = own.required("count", kLargestSize);
  sparse.indicesView = static_cast<std::uint32_t>(indices.required("bufferView", kLargestSize));
  sparse.indicesOffset = indices.optional("byteOffset", 0, kLargestSize);
  sparse.indicesType = static_cast<std::uint32_t>(indices.required("componentType", 0xffff));
  sparse.valuesView = static_cast<std::uint32_t>(values.required("bufferView", kLargestSize));
  sparse.valuesOffset = values.optional("byteOffset", 0, kLargestSize);
  for (const FieldReader* part : {&own, &indices, &values}) fields.adopt(*part);
  for (std::uint32_t* view : {&sparse.indicesView, &sparse.valuesView}) {
    if (*view < document.views.size()) continue;
    fields.fail(concat("sparse refers to bufferView ", *view, " of ", document.views.size()));
    *view = kNone;
  }
  return sparse;
}

Status readAccessors(const GltfSections& sections, GltfDocument& document) {
  std::size_t index = 0;
  Status status = okStatus();
  sections.accessors.forEachElement([&](JsonValue json) {
    GltfAccessor& accessor = document.accessors[index];
    const std::string place = concat("accessor ", index);
    FieldReader fields(json, place);
    ++index;
    accessor.normalized = json.find("normalized").text() == "true";
    accessor.min = spanOf(json.find("min"), sections.text.data(), sections.textBegin);
    accessor.max = spanOf(json.find("max"), sections.text.data(), sections.textBegin);
    accessor.componentType = static_cast<std::uint32_t>(fields.required("componentType", 0xffff));
    accessor.count = fields.required("count", kLargestSize);
    accessor.byteOffset = fields.optional("byteOffset", 0, kLargestSize);
    const std::string type = json.find("type").asString();
    accessor.components = componentsOfType(type);
    if (accessor.components == 0) fields.fail("has the unknown type " + quoted(type));
    if (accessor.componentType < 5120 || accessor.componentType > 5126 || accessor.componentType == 5124) {
      fields.fail(concat("has the unknown componentType ", accessor.componentType));
    }
    if (json.find("bufferView")) {
      const std::uint64_t view = fields.required("bufferView", kLargestSize);
      if (view >= document.views.size()) {
        fields.fail(concat("refers to bufferView ", view, " of ", document.views.size()));
      }
      if (!fields.error()) accessor.view = static_cast<std::uint32_t>(view);
    }
    if (const JsonValue sparse = json.find("sparse"); sparse.isObject()) {
      accessor.sparse = readSparse(sparse, place, document, fields);
    }
    if (fields.error() && accessor.needed && status) status = *fields.error();
    if (!accessor.needed) return;
    for (const std::uint32_t view : {accessor.view, accessor.sparse ? accessor.sparse->indicesView : kNone,
                                     accessor.sparse ? accessor.sparse->valuesView : kNone}) {
      if (view != kNone) document.views[view].needed = true;
    }
  });
  return status;
}

/// Reads the extension of a compressed view that is needed, and lets the view refer to a buffer of its decoded bytes.
Status readCompression(JsonValue extension, std::uint32_t index, std::size_t fileBuffers, GltfDocument& document) {
  constexpr std::string_view kModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
  constexpr std::string_view kFilters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"};
  GltfView& view = document.views[index];
  FieldReader fields(extension, concat("bufferView ", index, " ", view.compression));
  MeshoptSource source;
  source.view = index;
  const std::uint64_t buffer = fields.required("buffer", kLargestSize);
  source.byteOffset = fields.optional("byteOffset", 0, kLargestSize);
  source.byteLength = fields.required("byteLength", kLargestSize);
  source.layout.count = fields.required("count", kLargestSize);
  source.layout.byteStride = static_cast<std::uint32_t>(fields.required("byteStride", 256));
  const auto choose = [&](const char* name, const auto& choices, std::string_view chosen) -> std::size_t {
    const auto found = std::find(std::begin(choices), std::end(choices), chosen);
    if (found == std::end(choices)) fields.fail(concat("has the unknown ", name, " ", quoted(chosen)));
    return static_cast<std::size_t>(found - std::begin(choices));
  };
  const JsonValue filter = extension.find("filter");
  source.layout.mode = static_cast<MeshoptMode>(choose("mode", kModes, extension.find("mode").asString()));
  source.layout.filter = static_cast<MeshoptFilter>(choose("filter", kFilters, filter ? filter.asString() : "NONE"));
  if (buffer >= fileBuffers) {
    fields.fail(concat("refers to buffer ", buffer, " of ", fileBuffers));
  } else if (const std::uint64_t length = document.buffers[static_cast<std::size_t>(buffer)].byteLength;
             source.byteOffset > length || source.byteLength > length - source.byteOffset) {
    fields.fail(concat("exceeds buffer ", buffer, " (", length, " bytes)"));
  }
  const std::uint64_t decodedBytes = source.layout.count * source.layout.byteStride;
  if (decodedBytes != view.byteLength) {
    fields.fail(concat("decodes to ", decodedBytes, " bytes, the view has ", view.byteLength));
  }
  if (fields.error()) return *fields.error();
  source.buffer = static_cast<std::uint32_t>(buffer);
  view.buffer = static_cast<std::uint32_t>(document.buffers.size());
  view.byteOffset = 0;
  GltfBuffer decoded;
  decoded.byteLength = decodedBytes;
  decoded.meshopt = source;
  document.buffers.push_back(decoded);
  return okStatus();
}

Status readViews(const GltfSections& sections, GltfDocument& document) {
  const std::size_t fileBuffers = document.buffers.size();
  std::size_t index = 0;
  Status status = okStatus();
  sections.bufferViews.forEachElement([&](JsonValue json) {
    GltfView& view = document.views[index];
    FieldReader fields(json, concat("bufferView ", index));
    ++index;
    const std::uint64_t buffer = fields.required("buffer", kLargestSize);
    view.byteOffset = fields.optional("byteOffset", 0, kLargestSize);
    view.byteLength = fields.required("byteLength", kLargestSize);
    view.byteStride = static_cast<std::uint32_t>(fields.optional("byteStride", 0, kLargestSize));
    if (view.byteStride > 252 || view.byteStride % 4 != 0) {
      fields.fail(concat("has the byteStride ", view.byteStride, ", expected a multiple of 4 up to 252"));
    }
    if (buffer >= fileBuffers) {
      fields.fail(concat("refers to buffer ", buffer, " of ", fileBuffers));
    } else if (const std::uint64_t length = document.buffers[static_cast<std::size_t>(buffer)].byteLength;
               view.byteOffset > length || view.byteLength > length - view.byteOffset) {
      fields.fail(concat("with byteOffset ", view.byteOffset, " and byteLength ", view.byteLength, " exceeds buffer ",
                         buffer, " (", length, " bytes)"));
    }
    JsonValue compression;
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      const JsonValue extension = json.find("extensions").find(name);
      if (!extension) continue;
      view.compression = name;
      compression = extension;
    }
    if (!fields.error()) view.buffer = static_cast<std::uint32_t>(buffer);
    if (!view.needed || !status) return;
    if (fields.error()) {
      status = *fields.error();
    } else if (compression) {
      status = readCompression(compression, static_cast<std::uint32_t>(index - 1), fileBuffers, document);
    }
  });
  return status;
}

Status readNodes(const GltfSections& sections, GltfDocument& document) {
  Status status = okStatus();
  sections.nodes.forEachElement([&](JsonValue json) {
    const auto node = static_cast<std::uint32_t>(document.nodeCount++);
    const JsonValue mesh = json.find("mesh");
    if (!mesh || !status) return;
    FieldReader fields(json, concat("node ", node));
    const std::uint64_t index = fields.required("mesh", kLargestSize);
    if (index >= document.meshCount) {
      fields.fail(concat("refers to mesh ", index, " of ", document.meshCount));
    }
    if (fields.error()) {
      status = *fields.error();
      return;
    }
    document.nodes.push_back(GltfNode{node, static_cast<std::uint32_t>(index), json.find("name").asString()});
    status = checkEntryCount("nodes with a mesh", document.nodes.size());
  });
  return status;
}

void readBuffers(const GltfSections& sections, GltfDocument& document) {
  std::size_t index = 0;
  sections.buffers.forEachElement([&](JsonValue json) {
    GltfBuffer& buffer = document.buffers[index];
    FieldReader fields(json, concat("buffer ", index));
    ++index;
    buffer.byteLength = fields.required("byteLength", kLargestSize);
    const JsonValue uri = json.find("uri");
    if (!uri.isString()) return;
    const FileSpan span = spanOf(uri, sections.text.data(), sections.textBegin);
    buffer.hasUri = true;
    buffer.uri = {span.begin + 1, span.end - 1};
  });
}

/// What this version can do with the accessors that triangles need, and whether they stay inside their views.
Status checkElements(const GltfDocument& document, std::uint32_t index) {
  const GltfAccessor& accessor = document.accessors[index];
  const GltfView& view = document.views[accessor.view];
  const std::string place = concat("accessor ", index);
  if (accessor.count == 0) return badFile(place + ": count is 0");
  const std::uint64_t elementBytes = accessor.elementBytes();
  const std::uint64_t stride = view.byteStride == 0 ? elementBytes : view.byteStride;
  if (stride < elementBytes) {
    return badFile(concat(place, ": elements of ", elementBytes, " bytes overlap at the byteStride ", stride,
                          " of bufferView ", accessor.view));
  }
  const bool fits = accessor.byteOffset <= view.byteLength && elementBytes <= view.byteLength - accessor.byteOffset &&
                    accessor.count - 1 <= (view.byteLength - accessor.byteOffset - elementBytes) / stride;
  if (fits) return okStatus();
  return badFile(concat(place, ": byteOffset ", accessor.byteOffset, " with ", accessor.count,
                        " elements exceeds bufferView ", accessor.view, " (", view.byteLength, " bytes)"));
}

/// Compressed positions are checked when they are decoded; their accessor only says what they become.
Status checkDraco(const GltfDocument& document, const GltfPrimitive& primitive) {
  const GltfAccessor& position = document.accessors[primitive.position];
  if (!document.views[primitive.draco->view].compression.empty()) {
    return unsupportedFile(concat(primitive.place(), " ", kDracoExtension, ": its bufferView is compressed again"));
  }
  if (position.components == 3 && position.componentType != kGltfUint32) return okStatus();
  return unsupportedFile(concat(primitive.place(), " POSITION (accessor ", primitive.position,
                                "): is not a VEC3 of floats or of 8- or 16-bit integers"));
}

/// One of the two arrays of a sparse accessor: tightly packed elements in a view.
Status checkPacked(const GltfDocument& document, const std::string& place, std::uint32_t viewIndex,
                   std::uint64_t offset, std::uint64_t count, std::uint64_t elementBytes) {
  const GltfView& view = document.views[viewIndex];
  if (view.byteStride != 0 && view.byteStride != elementBytes) {
    return badFile(concat(place, ": bufferView ", viewIndex, " has a byteStride"));
  }
  if (offset <= view.byteLength && count <= (view.byteLength - offset) / elementBytes) return okStatus();
  return badFile(concat(place, ": byteOffset ", offset, " with ", count, " elements exceeds bufferView ", viewIndex,
                        " (", view.byteLength, " bytes)"));
}

Status checkSparse(const GltfDocument& document, std::uint32_t index) {
  const GltfAccessor& accessor = document.accessors[index];
  const GltfSparse& sparse = *accessor.sparse;
  const std::string place = concat("accessor ", index, " sparse");
  if (sparse.count == 0 || sparse.count > accessor.count) {
    return badFile(concat(place, ".count is ", sparse.count, " for ", accessor.count, " elements"));
  }
  const std::uint32_t type = sparse.indicesType;
  if (type != kGltfUint8 && type != kGltfUint16 && type != kGltfUint32) {
    return badFile(place + ".indices: are not unsigned integers");
  }
  if (Status status = checkPacked(document, place + ".indices", sparse.indicesView, sparse.indicesOffset, sparse.count,
                                  componentBytes(type));
      !status) {
    return status;
  }
  return checkPacked(document, place + ".values", sparse.valuesView, sparse.valuesOffset, sparse.count,
                     accessor.elementBytes());
}

Status checkTriangles(const GltfDocument& document, const GltfPrimitive& primitive) {
  const std::string what = primitive.place() + " POSITION";
  if (primitive.draco) return checkDraco(document, primitive);
  const GltfAccessor& position = document.accessors[primitive.position];
  const std::string place = concat(" (accessor ", primitive.position, ")");
  if (position.components != 3 || position.componentType == kGltfUint32) {
    return badFile(concat(what, place, ": is not a VEC3 of floats or of 8- or 16-bit integers"));
  }
  if (position.count == 0) return badFile(concat("accessor ", primitive.position, ": count is 0"));
  if (position.view != kNone) {
    if (Status status = checkElements(document, primitive.position); !status) return status;
  }
  if (position.sparse) {
    if (Status status = checkSparse(document, primitive.position); !status) return status;
  }

  for (const std::uint32_t accessor : primitive.textureCoordinates) {
    if (accessor == kNone) continue;
    const GltfAccessor& coordinates = document.accessors[accessor];
    const bool isStored = coordinates.view != kNone && !coordinates.sparse;
    if (coordinates.components != 2 || coordinates.componentType == kGltfUint32 || !isStored)
      return unsupportedFile(concat("accessor ", accessor, ": is not a stored VEC2 of floats or small integers"));
    if (Status status = checkElements(document, accessor); !status) return status;
  }
  if (primitive.indices == kNone) return okStatus();
  const GltfAccessor& indices = document.accessors[primitive.indices];
  const std::string indicesPlace = concat(primitive.place(), " indices (accessor ", primitive.indices, ")");
  const bool unsignedType =
      indices.componentType == 5121 || indices.componentType == 5123 || indices.componentType == 5125;
  if (indices.components != 1 || !unsignedType) return badFile(indicesPlace + ": is not a SCALAR of unsigned integers");
  if (indices.count == 0) return badFile(concat("accessor ", primitive.indices, ": count is 0"));
  if (indices.sparse) {
    if (Status status = checkSparse(document, primitive.indices); !status) return status;
  }
  if (indices.view == kNone) return okStatus();
  const std::uint32_t stride = document.views[indices.view].byteStride;
  if (stride != 0 && stride != indices.elementBytes()) {
    return badFile(
        concat(indicesPlace, ": bufferView ", indices.view, " has a byteStride, which indices must not have"));
  }
  return checkElements(document, primitive.indices);
}

}  // namespace

std::uint32_t GltfAccessor::elementBytes() const {
  return components * componentBytes(componentType);
}

std::uint32_t componentsOfType(std::string_view type) {
  constexpr struct {
    std::string_view name;
    std::uint32_t components;
  } kTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  for (const auto& entry : kTypes) {
    if (type == entry.name) return entry.components;
  }
  return 0;
}

void GltfDocument::warn(std::string text) {
  constexpr std::size_t kMostWarnings = 100;
  if (warnings.size() < kMostWarnings) warnings.push_back(std::move(text));
  if (warnings.size() == kMostWarnings) warnings.back() = "more warnings of this kind were left out";
}

std::string GltfPrimitive::place() const {
  return concat("mesh ", mesh, " primitive ", index);
}

const char* primitiveModeName(std::uint32_t mode) {
  constexpr const char* kNames[] = {"POINTS",    "LINES",          "LINE_LOOP",   "LINE_STRIP",
                                    "TRIANGLES", "TRIANGLE_STRIP", "TRIANGLE_FAN"};
  return mode < 7 ? kNames[mode] : "primitives of an unknown mode";
}

Result<GltfDocument> readGltfDocument(std::string_view json, std::size_t jsonBegin, bool withTextures) {
  const Result<JsonValue> root = parseJson(json);
  if (!root) return root.error();
  if (!root->isObject()) return badFile("glTF: the JSON text is not an object");
  const GltfSections sections = findSections(*root, json, jsonBegin);

  GltfDocument document;
  document.withTextures = withTextures;
  document.version = sections.asset.find("version").asString();
  if (document.version.empty()) return badFile("glTF: asset.version is missing");
  if (document.version.substr(0, 2) != "2.") return unsupportedFile("glTF version " + quoted(document.version));
  constexpr std::size_t kMostExtensions = 1000;  // for the report only; no sane file comes near
  sections.extensionsUsed.forEachElement([&](JsonValue name) {
    if (name.isString() && document.extensionsUsed.size() < kMostExtensions)
      document.extensionsUsed.push_back(name.asString());
  });

  const struct {
    const char* name;
    JsonValue array;
  } arrays[] = {
      {"buffers", sections.buffers}, {"bufferViews", sections.bufferViews}, {"accessors", sections.accessors}};
  std::size_t counts[3];
  for (int i = 0; i < 3; ++i) {
    counts[i] = arrays[i].array.elementCount();
    if (Status status = checkEntryCount(arrays[i].name, counts[i]); !status) return status.error();
  }
  document.buffers.resize(counts[0]);
  document.views.resize(counts[1]);
  document.accessors.resize(counts[2]);

  // The order gives clear messages: what a primitive asks for is refused before what its accessors lack.
  readBuffers(sections, document);
  if (Status status = readMeshes(sections, document); !status) return status.error();
  if (Status status = readNodes(sections, document); !status) return status.error();
  if (Status status = readAccessors(sections, document); !status) return status.error();
  if (Status status = readViews(sections, document); !status) return status.error();
  for (const GltfPrimitive& primitive : document.primitives) {
    if (!primitive.hasTriangles()) continue;
    if (Status status = checkTriangles(document, primitive); !status) return status.error();
  }
  markOtherUses(sections, document);
  if (withTextures) {
    document.materials = sections.materials.elements();
    document.textures = sections.textures.elements();
    document.images = sections.images.elements();
  }
  return document;
}

}  // namespace quadmark::io
