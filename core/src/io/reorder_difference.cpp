// SPDX-License-Identifier: MIT
// Counting the bytes in which two versions of a model differ.
#include "allowed_spans.h"
#include "gltf_container.h"
#include "ply_header.h"
#include "quadmark/io/ply.h"

namespace quadmark {
namespace io {
namespace {

/// What separates the words of an ascii PLY and the scalars of a JSON text.
bool isSeparator(char character) {
  constexpr std::string_view kSeparators = " \t\r\n\v\f,:[]{}";
  return kSeparators.find(character) != kSeparators.npos;
}

std::string_view takeRun(std::string_view& text, bool separators) {
  std::size_t length = 0;
  while (length < text.size() && isSeparator(text[length]) == separators) ++length;
  const std::string_view run = text.substr(0, length);
  text.remove_prefix(length);
  return run;
}

std::uint64_t countChangedText(std::string_view before, std::string_view after) {
  std::uint64_t count = 0;
  for (bool separators = false; !before.empty() || !after.empty(); separators = !separators) {
    count += countReplaced(takeRun(before, separators), takeRun(after, separators));
  }
  return count;
}

/// A GLB's JSON text is padded with blanks, which mean nothing.
std::string_view withoutPadding(std::string_view text) {
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

/// Everything behind the JSON text. A BIN chunk may have grown without the chunks behind it having changed.
std::uint64_t countChangedRest(Bytes before, const GltfContainer& a, Bytes after, const GltfContainer& b) {
  const auto text = [](Bytes file, std::size_t begin, std::size_t end) {
    return asText(file.subspan(begin, end - begin));
  };
  if (!a.hasBin || !b.hasBin) {
    return countReplaced(asText(before.subspan(a.jsonEnd)), asText(after.subspan(b.jsonEnd)));
  }
  return countReplaced(text(before, a.jsonEnd, a.binBegin), text(after, b.jsonEnd, b.binBegin)) +
         countReplaced(asText(a.bin(before)), asText(b.bin(after))) +
         countReplaced(asText(before.subspan(a.binEnd)), asText(after.subspan(b.binEnd)));
}

std::uint64_t countChangedFile(Bytes before, Bytes after) {
  if (isPly(before)) {
    const Result<PlyHeader> header = parsePlyHeader(before);
    const bool ascii = header.ok() && header->encoding == PlyEncoding::ascii;
    return ascii ? countChangedText(asText(before), asText(after)) : countReplaced(asText(before), asText(after));
  }
  const Result<GltfContainer> a = openGltf(before), b = openGltf(after);
  if (!a.ok() || !b.ok()) return countReplaced(asText(before), asText(after));
  return countReplaced(asText(before.first(a->jsonBegin)), asText(after.first(b->jsonBegin))) +
         countChangedText(withoutPadding(a->json(before)), withoutPadding(b->json(after))) +
         countChangedRest(before, *a, after, *b);
}

}  // namespace
}  // namespace io

std::uint64_t countChangedBytes(std::span<const std::uint8_t> file, const Resources& resources,
                                const PatchedFile& after) {
  std::uint64_t count = io::countChangedFile(file, after.bytes);
  for (const auto& [uri, bytes] : after.resources) {
    const auto before = resources.find(uri);
    count +=
        before == resources.end() ? bytes.size() : io::countReplaced(io::asText(before->second), io::asText(bytes));
  }
  return count;
}

}  // namespace quadmark
