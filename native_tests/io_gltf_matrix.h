// SPDX-License-Identifier: MIT
// glTF files of every combination of features that positions can come in, written around a mesh of the generator.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "io_compress.h"
#include "io_fixtures.h"
#include "number_text.h"
#include "quadmark/mesh.h"

namespace quadmark::test {

enum class SparseUse { none, overBase, alone };
enum class BufferUse { bin, external, dataUri, several };
/// Of views by EXT_meshopt_compression, without and with the plain bytes as a fallback; of primitives by Draco.
enum class Compression { none, meshopt, meshoptFallback, draco };

struct MatrixSpec {
  std::string component = "float";  ///< float, char, uchar, short, ushort
  bool normalized = false;
  bool interleaved = false;         ///< positions share a view with other attributes
  SparseUse sparse = SparseUse::none;
  std::string sparseIndex = "ushort";
  std::string index = "ushort";     ///< uchar, ushort, uint or empty: none
  int mode = 4;
  std::uint32_t primitives = 1;     ///< the faces are dealt out to so many; their seams are twins
  bool twoMeshes = false;           ///< the last primitive is a mesh of its own
  bool sharedAccessor = false;      ///< all primitives draw from one accessor
  BufferUse buffers = BufferUse::bin;
  Compression compression = Compression::none;  ///< draco: only of triangle lists with indices, nothing sparse or shared

  [[nodiscard]] bool usesMeshopt() const {
    return compression == Compression::meshopt || compression == Compression::meshoptFallback;
  }
};

struct MatrixFile {
  FileBytes file;
  Resources resources;
  std::vector<FileBytes> views;  ///< what each bufferView holds, decompressed
};

/// The grid that a component type stores; nothing for floats.
inline std::optional<CoordinateGrid> matrixGrid(const MatrixSpec& spec) {
  if (spec.component == "float") return std::nullopt;
  const double high = spec.component == "char" ? 127 : spec.component == "uchar" ? 255 : spec.component == "short" ? 32767 : 65535;
  const double low = spec.component[0] == 'u' ? 0 : spec.normalized ? -high : -high - 1;
  return CoordinateGrid{spec.normalized ? high : 1, low, high};
}

/// The mesh with its coordinates as a file of this kind stores them: moved and scaled to integer codes, or floats.
inline Mesh asCodes(Mesh mesh, const MatrixSpec& spec) {
  const std::optional<CoordinateGrid> grid = matrixGrid(spec);
  double low[3] = {1e300, 1e300, 1e300}, side = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) low[i % 3] = std::min(low[i % 3], mesh.positions[i]);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) side = std::max(side, mesh.positions[i] - low[i % 3]);
  for (std::size_t i = 0; grid && i < mesh.positions.size(); ++i)
    mesh.positions[i] = std::floor((mesh.positions[i] - low[i % 3]) / side * (grid->high - grid->low) + grid->low + 0.5);
  return mesh;
}

/// Writes one file. What is no position is filled with a pattern, so that a stray write shows.
class MatrixWriter {
 public:
  /// @param first, second  codes for what the first and the second glTF mesh draw; the same faces.
  MatrixWriter(const MatrixSpec& spec, const Mesh& first, const Mesh& second)
      : spec_(spec), mesh_(first), second_(second) {}

  MatrixFile write() {
    std::vector<std::vector<std::uint32_t>> parts(spec_.primitives);
    for (std::size_t f = 0; f < mesh_.faceCount(); ++f) {
      std::vector<std::uint32_t>& part = parts[f * spec_.primitives / mesh_.faceCount()];
      for (std::size_t c = mesh_.faceBegin(f) + 1; c + 1 < mesh_.faceEnd(f); ++c)
        part.insert(part.end(), {mesh_.faceVertices[mesh_.faceBegin(f)], mesh_.faceVertices[c], mesh_.faceVertices[c + 1]});
    }
    std::string first, second;
    std::uint32_t shared = 0;
    if (spec_.sharedAccessor) shared = positions(everyVertex());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      std::vector<std::uint32_t> stream = asMode(parts[i]);
      inSecond_ = spec_.twoMeshes && i + 1 == parts.size();
      std::uint32_t accessor = shared;
      if (!spec_.sharedAccessor) {
        std::vector<std::uint32_t> vertices = stream;
        if (!spec_.index.empty()) {
          std::sort(vertices.begin(), vertices.end());
          vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
          for (std::uint32_t& v : stream)
            v = static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
        }
        accessor = positions(vertices);
      }
      std::string primitive = R"({"attributes":{"POSITION":)" + std::to_string(accessor) + "}";
      if (!spec_.index.empty()) primitive += R"(,"indices":)" + std::to_string(indices(stream));
      if (spec_.compression == Compression::draco) {
        const std::uint32_t place = view(Content::other, 0, [&](FileBytes& out) {
          const FileBytes bytes = encodeDraco(elements_, spec_.component, stream);
          out.insert(out.end(), bytes.begin(), bytes.end());
        });
        primitive += R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":)" + std::to_string(place) +
                     R"(,"attributes":{"POSITION":0}}})";
      }
      primitive += spec_.mode == 4 ? "}" : R"(,"mode":)" + std::to_string(spec_.mode) + "}";
      std::string& mesh = inSecond_ ? second : first;
      mesh += (mesh.empty() ? "" : ",") + primitive;
    }
    if (spec_.compression != Compression::draco)
      first += R"(,{"attributes":{"POSITION":0},"mode":0})";  // points that draw from the first accessor, too
    return finish(first, second);
  }

 private:
  std::vector<std::uint32_t> everyVertex() const {
    std::vector<std::uint32_t> all(mesh_.vertexCount());
    for (std::uint32_t v = 0; v < all.size(); ++v) all[v] = v;
    return all;
  }

  /// Triangle corners as a stream of the wanted mode.
  std::vector<std::uint32_t> asMode(const std::vector<std::uint32_t>& corners) const {
    if (spec_.mode == 4) return corners;
    std::vector<std::uint32_t> stream;
    if (spec_.mode == 5) {  // each triangle joined to the last by degenerate ones
      for (std::size_t i = 0; i < corners.size(); i += 3) {
        if (i > 0) stream.insert(stream.end(), {stream.back(), stream.back(), corners[i]});
        stream.insert(stream.end(), {corners[i], corners[i + 1], corners[i + 2]});
      }
      return stream;
    }
    // A fan from the first corner through all triangles: a, then b, c of each; what lies between two of them is a
    // triangle, too, but of vertices that are near each other.
    stream.push_back(corners[0]);
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k)
        if (corners[i + k] != stream.back()) stream.push_back(corners[i + k]);
    }
    return stream;
  }

  double code(std::uint32_t vertex, int axis) const {
    const Mesh& mesh = inSecond_ ? second_ : mesh_;
    return mesh.positions[3 * std::size_t{vertex} + static_cast<std::size_t>(axis)];
  }

  FileBytes& bytes() { return buffers_[spec_.buffers == BufferUse::several ? used_++ % 3 : 0]; }

  enum class Content { vertices, triangles, indices, other };

  /// A bufferView over the next bytes of some buffer. Its content decides whether and how it can be compressed.
  /// @param stride  of vertices that are not packed, else 0.
  template <class Fill>
  std::uint32_t view(Content content, std::uint32_t stride, const Fill& fill, std::uint32_t elementBytes = 0) {
    FileBytes plain;
    fill(plain);
    FileBytes& buffer = bytes();
    const auto number = static_cast<std::size_t>(&buffer - buffers_);
    const std::size_t begin = buffer.size();
    const auto range = [](std::size_t ofBuffer, std::size_t from, std::size_t length) {
      return R"("buffer":)" + std::to_string(ofBuffer) + R"(,"byteOffset":)" + std::to_string(from) +
             R"(,"byteLength":)" + std::to_string(length);
    };
    const std::string strided = stride == 0 ? "" : R"(,"byteStride":)" + std::to_string(stride);
    std::string text = range(number, begin, plain.size()) + strided;
    FileBytes stream = plain;
    if (spec_.usesMeshopt() && content != Content::other) {
      const std::size_t count = plain.size() / elementBytes;
      const char* mode = content == Content::vertices    ? "ATTRIBUTES"
                         : content == Content::triangles ? "TRIANGLES"
                                                         : "INDICES";
      stream = encodeMeshopt(plain, count, elementBytes, mode);
      text = replaced(range(0, fallback_.size(), plain.size()), R"("buffer":0)", R"("buffer":FALLBACK)") + strided +
             R"(,"extensions":{"EXT_meshopt_compression":{)" + range(number, begin, stream.size()) +
             R"(,"byteStride":)" + std::to_string(elementBytes) + R"(,"count":)" + std::to_string(count) +
             R"(,"mode":")" + mode + R"("}})";
      fallback_.insert(fallback_.end(), plain.begin(), plain.end());
      while (fallback_.size() % 4 != 0) fallback_.push_back(0);
    }
    buffer.insert(buffer.end(), stream.begin(), stream.end());
    while (buffer.size() % 4 != 0) buffer.push_back(0xee);
    views_ += (views_.empty() ? "{" : ",{") + text + "}";
    plainViews_.push_back(std::move(plain));
    return viewCount_++;
  }

  std::uint32_t accessor(const std::string& text) {
    accessors_ += (accessors_.empty() ? "{" : ",{") + text + "}";
    return accessorCount_++;
  }

  void element(FileBytes& out, std::uint32_t vertex, bool hidden) const {
    for (int axis = 0; axis < 3; ++axis) {
      appendScalar(out, spec_.component, hidden ? 1 : code(vertex, axis), io::ByteOrder::little);
    }
  }

  std::uint32_t positions(const std::vector<std::uint32_t>& vertices) {
    const std::map<std::string, std::pair<int, std::uint32_t>> types = {
        {"char", {5120, 1}}, {"uchar", {5121, 1}}, {"short", {5122, 2}}, {"ushort", {5123, 2}}, {"float", {5126, 4}}};
    const auto [type, width] = types.at(spec_.component);
    const std::uint32_t packed = (3 * width + 3) / 4 * 4, stride = spec_.interleaved ? packed + 8 : packed;
    const auto isReplaced = [&](std::size_t i) { return spec_.sparse == SparseUse::alone || i % 3 == 1; };
    std::string text;
    if (spec_.sparse != SparseUse::alone) {
      const auto fill = [&](FileBytes& out) {
        for (std::size_t i = 0; i < vertices.size(); ++i) {
          const std::size_t end = out.size() + stride;
          element(out, vertices[i], spec_.sparse == SparseUse::overBase && isReplaced(i));
          while (out.size() < end) out.push_back(0xcd);
        }
      };
      if (spec_.compression == Compression::draco) {
        elements_.clear();
        for (const std::uint32_t v : vertices) element(elements_, v, false);
      } else {
        const std::uint32_t base = view(Content::vertices, stride == 3 * width ? 0 : stride, fill, stride);
        text = R"("bufferView":)" + std::to_string(base) + ",";
      }
    }
    text += R"("componentType":)" + std::to_string(type) + R"(,"count":)" + std::to_string(vertices.size()) +
            R"(,"type":"VEC3")" + (spec_.normalized ? R"(,"normalized":true)" : "") + bounds(vertices);
    if (spec_.sparse != SparseUse::none) {
      std::vector<std::vector<int>> list(1);
      for (std::size_t i = 0; i < vertices.size(); ++i)
        if (isReplaced(i)) list[0].push_back(static_cast<int>(i));
      const std::uint32_t which = view(Content::other, 0, [&](FileBytes& out) {
        for (const int i : list[0]) appendScalar(out, spec_.sparseIndex, i, io::ByteOrder::little);
      });
      const auto fill = [&](FileBytes& out) {
        for (const int i : list[0]) element(out, vertices[static_cast<std::size_t>(i)], false);
      };
      const bool compressible = 3 * width % 4 == 0;
      const std::uint32_t values = view(compressible ? Content::vertices : Content::other, 0, fill, 3 * width);
      text += R"(,"sparse":{"count":)" + std::to_string(list[0].size()) + R"(,"indices":{"bufferView":)" +
              std::to_string(which) + R"(,"componentType":)" + indexType(spec_.sparseIndex) +
              R"(},"values":{"bufferView":)" + std::to_string(values) + "}}";
    }
    return accessor(text);
  }

  static std::string indexType(const std::string& name) {
    return name == "uchar" ? "5121" : name == "ushort" ? "5123" : "5125";
  }

  std::string bounds(const std::vector<std::uint32_t>& vertices) const {
    std::string text;
    for (const bool isMax : {false, true}) {
      text += isMax ? R"(,"max":[)" : R"(,"min":[)";
      for (int axis = 0; axis < 3; ++axis) {
        double bound = isMax ? -1e300 : 1e300;
        for (const std::uint32_t v : vertices) {
          bound = isMax ? std::max(bound, code(v, axis)) : std::min(bound, code(v, axis));
        }
        text += (axis == 0 ? "" : ",") + formatShortest(static_cast<float>(bound));
      }
      text += "]";
    }
    return text;
  }

  std::uint32_t indices(const std::vector<std::uint32_t>& stream) {
    std::string place;
    if (spec_.compression != Compression::draco) {
      const Content content = spec_.index == "uchar" ? Content::other
                              : spec_.mode == 4      ? Content::triangles
                                                     : Content::indices;
      const auto fill = [&](FileBytes& out) {
        for (const std::uint32_t v : stream) appendScalar(out, spec_.index, v, io::ByteOrder::little);
      };
      place = R"("bufferView":)" + std::to_string(view(content, 0, fill, spec_.index == "ushort" ? 2 : 4)) + ",";
    }
    return accessor(place + R"("componentType":)" + indexType(spec_.index) +
                    R"(,"count":)" + std::to_string(stream.size()) + R"(,"type":"SCALAR")");
  }

  /// ,"extensionsUsed":[..],"extensionsRequired":[..]
  std::string extensions() const {
    std::vector<std::string> required;
    if (spec_.component != "float") required.push_back("KHR_mesh_quantization");
    if (spec_.compression == Compression::draco) required.push_back("KHR_draco_mesh_compression");
    if (spec_.compression == Compression::meshopt && !fallback_.empty()) required.push_back("EXT_meshopt_compression");
    const auto list = [](const char* name, const std::vector<std::string>& names) {
      std::string text;
      for (const std::string& extension : names) text += (text.empty() ? "\"" : ",\"") + extension + "\"";
      return text.empty() ? "" : "\"" + std::string(name) + "\":[" + text + "],";
    };
    std::vector<std::string> all = required;
    if (spec_.compression == Compression::meshoptFallback && !fallback_.empty()) all.push_back("EXT_meshopt_compression");
    return list("extensionsUsed", all) + list("extensionsRequired", required);
  }

  MatrixFile finish(const std::string& first, const std::string& second) {
    MatrixFile out;
    out.views = plainViews_;
    std::string buffers;
    std::size_t bufferCount = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (buffers_[i].empty()) continue;
      const bool bin = spec_.buffers == BufferUse::bin || (spec_.buffers == BufferUse::several && i == 0);
      const bool outside = spec_.buffers == BufferUse::external || (spec_.buffers == BufferUse::several && i == 1);
      const std::string name = "part " + std::to_string(i) + ".bin";
      if (outside) out.resources[name] = buffers_[i];
      buffers += (buffers.empty() ? "{" : ",{") +
                 (bin       ? std::string()
                  : outside ? R"("uri":"part%20)" + std::to_string(i) + R"(.bin",)"
                            : R"("uri":"data:application/octet-stream;base64,)" + base64(buffers_[i]) + R"(",)") +
                 R"("byteLength":)" + std::to_string(buffers_[i].size()) + "}";
      ++bufferCount;
    }
    if (!fallback_.empty()) {
      buffers += R"(,{"byteLength":)" + std::to_string(fallback_.size());
      buffers += spec_.compression == Compression::meshoptFallback
                     ? R"(,"uri":"data:application/octet-stream;base64,)" + base64(fallback_) + "\"}"
                     : R"(,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})";
    }
    views_ = replaced(views_, "FALLBACK", std::to_string(bufferCount));
    std::string json = R"({"asset":{"version":"2.0"},)" + extensions() +
                       R"("extras":{"keep":[1e0,null,{}]},"buffers":[)" + buffers + R"(],"bufferViews":[)" + views_ +
                       R"(],"accessors":[)" + accessors_ + R"(],"meshes":[{"primitives":[)" + first + "]}" +
                       (second.empty() ? "" : R"(,{"primitives":[)" + second + "]}") +
                       R"(],"nodes":[{"name":"a","mesh":0},{"name":"b","mesh":)" + (second.empty() ? "0" : "1") +
                       R"(,"translation":[5,0,0]}],"scenes":[{"nodes":[0,1]}],"scene":0})";
    const bool hasBin = spec_.buffers == BufferUse::bin || spec_.buffers == BufferUse::several;
    out.file = hasBin ? makeGlb(json, buffers_[0]) : bytesOf(json);
    return out;
  }

  const MatrixSpec& spec_;
  const Mesh& mesh_;
  const Mesh& second_;
  bool inSecond_ = false;
  FileBytes buffers_[3];
  std::size_t used_ = 0;
  FileBytes fallback_;  // the plain bytes of compressed views
  FileBytes elements_;  // of the primitive that is compressed next
  std::vector<FileBytes> plainViews_;
  std::string views_, accessors_;
  std::uint32_t viewCount_ = 0, accessorCount_ = 0;
};

}  // namespace quadmark::test
