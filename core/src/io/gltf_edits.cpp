// SPDX-License-Identifier: MIT
#include "gltf_edits.h"

#include <algorithm>

#include "allowed_spans.h"
#include "base64.h"
#include "concat.h"

namespace quadmark::io {
namespace {

constexpr std::uint64_t aligned(std::uint64_t size) {
  return (size + 3) / 4 * 4;
}

/// Keeps a GLB's JSON chunk a multiple of 4 bytes long, taking back at most the usual padding first.
void padJson(std::string& json) {
  for (int i = 0; i < 3 && json.size() % 4 != 0 && json.back() == ' '; ++i) json.pop_back();
  while (json.size() % 4 != 0) json += ' ';
}

void append(std::vector<std::uint8_t>& out, Bytes bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

/// Adds elements to an array of the root, which may be missing.
void addToArray(JsonEdits& json, JsonValue root, const char* name, const std::vector<std::string>& elements) {
  if (const JsonValue array = root.find(name); array.isArray()) {
    for (const std::string& element : elements) json.addElement(array, element);
    return;
  }
  std::string text;
  for (const std::string& element : elements) text += (text.empty() ? "[" : ",") + element;
  json.setMember(root, name, text + "]");
}

}  // namespace

std::string_view textAt(Bytes file, FileSpan span) {
  return asText(file.subspan(span.begin, span.end - span.begin));
}

GltfEdits::GltfEdits(Bytes file, const GltfContainer& container, JsonValue root)
    : file_(file), container_(&container), root_(root), json_(container.json(file)) {
  const JsonValue buffers = root.find("buffers");
  bufferCount_ = buffers.elementCount();
  viewCount_ = root.find("bufferViews").elementCount();
  accessorCount_ = root.find("accessors").elementCount();
  bool first = true;
  appendsToBin_ = container.isGlb && (container.hasBin || bufferCount_ == 0);
  buffers.forEachElement([&](JsonValue buffer) {
    if (first && buffer.find("uri")) appendsToBin_ = false;
    first = false;
  });
}

Result<GltfEdits> GltfEdits::of(Bytes file, const GltfContainer& container) {
  const Result<JsonValue> root = parseJson(container.json(file));
  if (!root) return root.error();
  return GltfEdits(file, container, *root);
}

GltfEdits::Place GltfEdits::appendBytes(Bytes bytes) {
  Place place;
  const std::uint64_t before = appendsToBin_ ? aligned(container_->binEnd - container_->binBegin) : 0;
  place.buffer = appendsToBin_ ? 0 : static_cast<std::uint32_t>(bufferCount_);
  place.byteOffset = before + appended_.size();
  append(appended_, bytes);
  appended_.resize(static_cast<std::size_t>(aligned(appended_.size())));
  return place;
}

std::uint32_t GltfEdits::appendView(Bytes bytes, std::uint32_t byteStride, std::uint32_t target) {
  const Place place = appendBytes(bytes);
  std::string view =
      concat(R"({"buffer":)", place.buffer, R"(,"byteOffset":)", place.byteOffset, R"(,"byteLength":)", bytes.size());
  if (byteStride != 0) view += concat(R"(,"byteStride":)", byteStride);
  if (target != 0) view += concat(R"(,"target":)", target);
  views_.push_back(view + "}");
  return static_cast<std::uint32_t>(viewCount_ + views_.size() - 1);
}

std::uint32_t GltfEdits::addAccessor(std::string json) {
  accessors_.push_back(std::move(json));
  return static_cast<std::uint32_t>(accessorCount_ + accessors_.size() - 1);
}

/// Tells the JSON text about the new bytes and views.
void GltfEdits::declareAppended() {
  if (!views_.empty()) addToArray(json_, root_, "bufferViews", views_);
  if (!accessors_.empty()) addToArray(json_, root_, "accessors", accessors_);
  if (appended_.empty()) return;
  const std::uint64_t before = appendsToBin_ ? aligned(container_->binEnd - container_->binBegin) : 0;
  const std::string length = std::to_string(before + appended_.size());
  if (appendsToBin_ && bufferCount_ > 0) {
    bool first = true;
    root_.find("buffers").forEachElement([&](JsonValue buffer) {
      if (first) json_.setMember(buffer, "byteLength", length);
      first = false;
    });
    return;
  }
  std::string buffer = R"({"byteLength":)" + length;
  if (!appendsToBin_) buffer += concat(R"(,"uri":"data:application/octet-stream;base64,)", toBase64(appended_), "\"");
  addToArray(json_, root_, "buffers", {buffer + "}"});
}

void GltfEdits::appendGlb(const std::string& json, AssembledGltf& out) const {
  const auto header = [&](std::uint64_t length, const char* type) {
    std::uint8_t bytes[kGlbChunkHeaderBytes];
    store(bytes, static_cast<std::uint32_t>(length));
    std::memcpy(bytes + 4, type, 4);
    append(out.bytes, bytes);
  };
  const std::uint64_t addedToBin = appendsToBin_ ? appended_.size() : 0;
  const std::size_t jsonEnd = container_->jsonEnd;

  append(out.bytes, file_.first(container_->jsonBegin - kGlbChunkHeaderBytes));
  header(json.size(), "JSON");
  append(out.bytes, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()});
  if (!container_->hasBin) {
    if (addedToBin > 0) {  // right behind the JSON chunk, where the specification wants it
      header(addedToBin, "BIN");
      out.binBegin = out.bytes.size();
      append(out.bytes, appended_);
    }
    append(out.bytes, file_.subspan(jsonEnd));
  } else {
    const std::uint64_t oldBytes = container_->binEnd - container_->binBegin;
    const std::uint64_t newBytes = addedToBin > 0 ? aligned(oldBytes) + addedToBin : oldBytes;
    append(out.bytes, file_.subspan(jsonEnd, container_->binBegin - kGlbChunkHeaderBytes - jsonEnd));
    header(newBytes, "BIN");
    out.binBegin = out.bytes.size();
    append(out.bytes, container_->bin(file_));
    if (addedToBin > 0) {
      out.bytes.resize(out.binBegin + static_cast<std::size_t>(aligned(oldBytes)));
      append(out.bytes, appended_);
    }
    append(out.bytes, file_.subspan(container_->binEnd));
  }
  // What lies behind the GLB's end is no part of the length that its header states.
  const std::uint64_t length = load<std::uint32_t>(&file_[8]) + std::uint64_t{out.bytes.size()} - file_.size();
  store(&out.bytes[8], static_cast<std::uint32_t>(length));
}

/// Everything outside the JSON text must be as before, up to lengths and what was appended.
Status GltfEdits::check(const AssembledGltf& out) const {
  const Result<GltfContainer> now = openGltf(out.bytes);
  const Error broken{ErrorCode::internal, "self-check: the GLB's chunks changed"};
  if (!now || now->isGlb != container_->isGlb || now->jsonBegin != container_->jsonBegin) return broken;
  const auto isEqual = [](Bytes a, Bytes b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); };
  if (!container_->isGlb) return okStatus();
  const std::size_t oldEnd = container_->hasBin ? container_->binEnd : container_->jsonEnd;
  const std::size_t newEnd = now->hasBin ? now->binEnd : now->jsonEnd;
  const Bytes oldBin = container_->bin(file_), newBin = now->bin(out.bytes);
  if (newBin.size() < oldBin.size() || !isEqual(oldBin, newBin.first(oldBin.size()))) return broken;
  return isEqual(file_.subspan(oldEnd), Bytes(out.bytes).subspan(newEnd)) ? okStatus() : Status(broken);
}

Result<AssembledGltf> GltfEdits::assemble() {
  declareAppended();
  Result<JsonEdits::Applied> applied = json_.apply();
  if (!applied) return applied.error();
  std::string& json = applied->text;
  const std::size_t oldJsonBytes = container_->jsonEnd - container_->jsonBegin;
  if (container_->isGlb && json.size() != oldJsonBytes) padJson(json);

  AssembledGltf out;
  out.bytesChanged = applied->bytesChanged;
  const std::uint64_t size = std::uint64_t{file_.size()} - oldJsonBytes + json.size() +
                             (appendsToBin_ && !appended_.empty() ? appended_.size() + kGlbChunkHeaderBytes + 3 : 0);
  if (container_->isGlb && size > 0xffffffffu) return tooLarge("GLB: the file would exceed 4 GiB");
  out.bytes.reserve(static_cast<std::size_t>(size));
  if (!container_->isGlb) {
    append(out.bytes, file_.first(container_->jsonBegin));  // a byte order mark
    append(out.bytes, {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()});
    return out;
  }
  appendGlb(json, out);
  if (Status status = check(out); !status) return status.error();

  // Headers, and what the BIN chunk got; JSON padding means nothing and is not counted.
  out.bytesChanged +=
      countReplaced(asText(file_.first(container_->jsonBegin)), asText(Bytes(out.bytes).first(container_->jsonBegin)));
  const bool binChanged = appendsToBin_ && !appended_.empty();
  if (binChanged && container_->hasBin) {
    const Bytes oldHeader = file_.subspan(container_->binBegin - kGlbChunkHeaderBytes, kGlbChunkHeaderBytes);
    const Bytes newHeader = Bytes(out.bytes).subspan(out.binBegin - kGlbChunkHeaderBytes, kGlbChunkHeaderBytes);
    const std::uint64_t padding = (4 - (container_->binEnd - container_->binBegin) % 4) % 4;
    out.bytesChanged += countReplaced(asText(oldHeader), asText(newHeader)) + padding + appended_.size();
  } else if (binChanged) {
    out.bytesChanged += kGlbChunkHeaderBytes + appended_.size();
  }
  return out;
}

}  // namespace quadmark::io
