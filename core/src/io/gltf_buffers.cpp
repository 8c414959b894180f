// SPDX-License-Identifier: MIT
#include "gltf_buffers.h"

#include "concat.h"
#include "data_uri.h"
#include "number_text.h"

namespace quadmark::io {
namespace {

std::string percentDecoded(const std::string& uri) {
  std::string out;
  for (std::size_t at = 0; at < uri.size(); ++at) {
    const bool escape =
        uri[at] == '%' && at + 2 < uri.size() && hexDigit(uri[at + 1]) >= 0 && hexDigit(uri[at + 2]) >= 0;
    out += escape ? static_cast<char>(16 * hexDigit(uri[at + 1]) + hexDigit(uri[at + 2])) : uri[at];
    if (escape) at += 2;
  }
  return out;
}

/// The caller's entry for a URI: as spelled, percent-decoded, and both without a leading "./".
Resources::const_iterator findResource(const Resources& resources, const std::string& uri) {
  for (const std::string& spelling : {uri, percentDecoded(uri)}) {
    if (const auto found = resources.find(spelling); found != resources.end()) return found;
    if (spelling.substr(0, 2) != "./") continue;
    if (const auto found = resources.find(spelling.substr(2)); found != resources.end()) return found;
  }
  return resources.end();
}

Result<BufferPlace> placeBuffer(const GltfBuffer& buffer, std::size_t index, const GltfContainer& container, Bytes file,
                                const Resources& resources) {
  const std::string name = concat("buffer ", index);
  BufferPlace place;
  place.byteLength = buffer.byteLength;
  if (buffer.meshopt) {
    place.source = BufferPlace::Source::meshopt;
    place.meshopt = *buffer.meshopt;
    return place;
  }
  if (!buffer.hasUri) {
    if (!container.isGlb || index != 0) return badFile(name + " has no uri and so no data");
    if (!container.hasBin) return badFile(name + ": the GLB has no BIN chunk");
    place.source = BufferPlace::Source::bin;
    return place;
  }
  const std::string_view spelled = asText(file.subspan(buffer.uri.begin, buffer.uri.end - buffer.uri.begin));
  // Resolving the escapes of a data: URI would copy all of it, so only its beginning is looked at.
  if (isDataUri(unescapeJson(spelled.substr(0, 64)))) {
    place.source = BufferPlace::Source::dataUri;
    place.uri = buffer.uri;
    return place;
  }
  const std::string uri = unescapeJson(spelled);
  const auto found = findResource(resources, uri);
  if (found == resources.end()) return badFile(concat(name, ": the file ", quoted(uri), " was not given"));
  place.source = BufferPlace::Source::resource;
  place.key = found->first;
  return place;
}

BufferBytes decodedBuffer(std::vector<std::uint8_t> bytes) {
  BufferBytes buffer;
  buffer.decoded = std::move(bytes);
  buffer.bytes = buffer.decoded;
  return buffer;
}

/// @param decodedBytes  of this view and all before it.
Result<BufferBytes> decodeView(const BufferPlace& place, const std::vector<BufferBytes>& buffers,
                               std::uint64_t decodedBytes, std::uint64_t limit) {
  const MeshoptSource& source = place.meshopt;
  const std::string name = concat("bufferView ", source.view);
  if (decodedBytes > limit) {
    return tooLarge(concat(name, ": the compressed data would take more than ", limit, " bytes"));
  }
  const Bytes stream = buffers[source.buffer].bytes.subspan(static_cast<std::size_t>(source.byteOffset),
                                                            static_cast<std::size_t>(source.byteLength));
  Result<std::vector<std::uint8_t>> decoded = decodeMeshopt(stream, source.layout, name);
  if (!decoded) return decoded.error();
  return decodedBuffer(std::move(decoded).value());
}

}  // namespace

Result<std::vector<BufferPlace>> placeBuffers(const GltfDocument& document, const GltfContainer& container, Bytes file,
                                              const Resources& resources) {
  std::vector<bool> needed(document.buffers.size());
  for (const GltfView& view : document.views) {
    if (view.needed && view.buffer != kNone) needed[view.buffer] = true;
  }
  for (const GltfBuffer& buffer : document.buffers) {
    if (buffer.meshopt) needed[buffer.meshopt->buffer] = true;
  }
  std::vector<BufferPlace> places(document.buffers.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!needed[i]) continue;
    Result<BufferPlace> place = placeBuffer(document.buffers[i], i, container, file, resources);
    if (!place) return place.error();
    places[i] = std::move(place).value();
  }
  return places;
}

Result<BufferBytes> openBuffer(const BufferPlace& place, std::size_t index, const GltfContainer& container, Bytes file,
                               const Resources& resources) {
  const std::string name = concat("buffer ", index);
  BufferBytes buffer;
  std::string source;
  switch (place.source) {
    case BufferPlace::Source::absent:
    case BufferPlace::Source::meshopt:
    case BufferPlace::Source::draco:
      return badFile(name + " has no data");
    case BufferPlace::Source::bin:
      buffer.bytes = container.bin(file);
      source = "the BIN chunk";
      break;
    case BufferPlace::Source::resource: {
      const auto found = resources.find(place.key);
      if (found == resources.end()) return badFile(concat(name, ": the file ", quoted(place.key), " was not given"));
      buffer.bytes = found->second;
      source = quoted(place.key);
      break;
    }
    case BufferPlace::Source::dataUri: {
      const std::string_view spelled = asText(file.subspan(place.uri.begin, place.uri.end - place.uri.begin));
      Result<std::vector<std::uint8_t>> decoded = decodeDataUri(spelled, name);
      if (!decoded) return decoded.error();
      buffer.decoded = std::move(decoded).value();
      buffer.bytes = buffer.decoded;
      source = "the data URI";
      break;
    }
  }
  if (buffer.bytes.size() < place.byteLength) {
    return badFile(
        concat(name, ": byteLength is ", place.byteLength, ", ", source, " has ", buffer.bytes.size(), " bytes"));
  }
  return buffer;
}

Result<DracoMesh> decodeDracoStream(const DracoStream& stream, const std::vector<BufferBytes>& buffers,
                                    std::uint64_t memoryLimit) {
  const Bytes bytes = buffers[stream.buffer].bytes.subspan(static_cast<std::size_t>(stream.byteOffset),
                                                           static_cast<std::size_t>(stream.byteLength));
  return decodeDraco(bytes, {DracoAttribute{stream.position, stream.componentType, 3}}, memoryLimit, stream.place);
}

Result<std::vector<BufferBytes>> openBuffers(const std::vector<BufferPlace>& places, const std::vector<bool>& wanted,
                                             const GltfContainer& container, Bytes file, const Resources& resources) {
  std::vector<bool> opening = wanted;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!wanted[i]) continue;
    if (places[i].source == BufferPlace::Source::meshopt) opening[places[i].meshopt.buffer] = true;
    if (places[i].source == BufferPlace::Source::draco) opening[places[i].draco.buffer] = true;
  }
  const std::uint64_t limit = memoryLimit(file, resources);
  std::uint64_t decodedBytes = 0;
  std::vector<BufferBytes> buffers(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!opening[i] || places[i].source == BufferPlace::Source::absent) continue;
    // Decoded buffers follow those of the file, so what they are decoded from is open.
    Result<BufferBytes> buffer = BufferBytes{};
    if (places[i].source == BufferPlace::Source::meshopt) {
      decodedBytes += places[i].byteLength;
      buffer = decodeView(places[i], buffers, decodedBytes, limit);
    } else if (places[i].source == BufferPlace::Source::draco) {
      Result<DracoMesh> mesh = decodeDracoStream(places[i].draco, buffers, limit);
      buffer = mesh ? Result<BufferBytes>(decodedBuffer(std::move(mesh->values[0]))) : mesh.error();
    } else {
      buffer = openBuffer(places[i], i, container, file, resources);
    }
    if (!buffer) return buffer.error();
    buffers[i] = std::move(buffer).value();
  }
  return buffers;
}

std::uint64_t memoryLimit(Bytes file, const Resources& resources) {
  std::uint64_t bytes = file.size();
  for (const auto& resource : resources) bytes += resource.second.size();
  return 8 * bytes + (std::uint64_t{64} << 20);
}

}  // namespace quadmark::io
