// SPDX-License-Identifier: MIT
// Small files built by the tests themselves: PLY in every variant, glTF and GLB from JSON text and a buffer.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "io/bytes.h"
#include "number_text.h"
#include "quadmark/io/gltf.h"
#include "quadmark/io/model.h"
#include "quadmark/io/ply.h"

namespace quadmark::test {

using FileBytes = std::vector<std::uint8_t>;

inline FileBytes bytesOf(std::string_view text) {
  return {text.begin(), text.end()};
}
inline std::string textOf(const FileBytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

/// Bytes spelled as pairs of hexadecimal digits.
inline FileBytes fromHex(std::string_view text) {
  FileBytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(16 * hexDigit(text[i]) + hexDigit(text[i + 1])));
  }
  return bytes;
}

/// Replaces every occurrence of a placeholder.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// Appends a number in a PLY scalar type.
inline void appendScalar(FileBytes& out, const std::string& type, double value, io::ByteOrder order) {
  std::uint8_t raw[8];
  std::size_t size = 0;
  const auto put = [&](auto number) {
    size = sizeof(number);
    io::store(raw, number, order);
  };
  if (type == "char" || type == "int8") put(static_cast<std::int8_t>(value));
  if (type == "uchar" || type == "uint8") put(static_cast<std::uint8_t>(value));
  if (type == "short" || type == "int16") put(static_cast<std::int16_t>(value));
  if (type == "ushort" || type == "uint16") put(static_cast<std::uint16_t>(value));
  if (type == "int" || type == "int32") put(static_cast<std::int32_t>(value));
  if (type == "uint" || type == "uint32") put(static_cast<std::uint32_t>(static_cast<std::int64_t>(value)));
  if (type == "float" || type == "float32") put(static_cast<float>(value));
  if (type == "double" || type == "float64") put(value);
  out.insert(out.end(), raw, raw + size);
}

/// Coordinates of a bumpy 3 x 3 grid and its faces: four quads of which two are cut into triangles.
inline const std::vector<double>& gridPositions() {
  static const std::vector<double> positions = {0, 0, 0.125, 1,     0, -0.5, 2, 0, 0.25, 0,   1, 0.75, 1.0625, 1,
                                                0, 2, 1,     -0.25, 0, 2,    0, 1, 2,    0.5, 2, 2,    -1};
  return positions;
}
inline const std::vector<std::vector<int>>& gridPolygons() {
  static const std::vector<std::vector<int>> faces = {{0, 1, 4, 3}, {1, 2, 4}, {2, 5, 4},
                                                      {3, 4, 6},    {4, 7, 6}, {4, 5, 8, 7}};
  return faces;
}
inline const std::vector<std::vector<int>>& gridTriangles() {
  static const std::vector<std::vector<int>> faces = {{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 5, 4},
                                                      {3, 4, 6}, {4, 7, 6}, {4, 5, 8}, {4, 8, 7}};
  return faces;
}

/// The grid with two vertices moved; the bounds change.
inline std::vector<double> movedGrid() {
  std::vector<double> positions = gridPositions();
  positions[3 * 4] = 1.1f;
  positions[3 * 8 + 2] = -1.25;
  return positions;
}

/// How to spell the grid as a PLY.
struct PlySpec {
  std::string encoding = "ascii";  // ascii, binary_little_endian, binary_big_endian
  std::string coordinate = "float", count = "uchar", index = "int", list = "vertex_indices";
  std::string lineBreak = "\n";
  bool extras = false;  // comments, further elements and properties, lists inside vertices
  std::vector<std::vector<int>> faces = gridTriangles();
  std::vector<double> positions = gridPositions();
  bool strips = false;  // faces are triangle strips
};

class PlyWriter {
 public:
  explicit PlyWriter(const PlySpec& spec) : spec_(spec) {}

  FileBytes write() {
    line("ply");
    line("format " + spec_.encoding + " 1.0");
    if (spec_.extras) line("comment made  by\ta test ");
    if (spec_.extras) line("obj_info nothing");
    if (spec_.extras) header("camera", 2, {"property double fov", "property list uchar short window"});
    const std::string xyz = "property " + spec_.coordinate + " ";
    if (spec_.extras) {
      header("vertex", spec_.positions.size() / 3,
             {"property uchar red", xyz + "x", "property list int float weights", xyz + "z", "property int8 flag",
              xyz + "y"});
    } else {
      header("vertex", spec_.positions.size() / 3, {xyz + "x", xyz + "y", xyz + "z"});
    }
    std::vector<std::string> faceProperties = {"property list " + spec_.count + " " + spec_.index + " " + spec_.list};
    if (spec_.extras) faceProperties.push_back("property ushort material");
    header(spec_.strips ? "tristrips" : "face", spec_.faces.size(), faceProperties);
    if (spec_.extras) header("edge", 1, {"property int vertex1", "property int vertex2"});
    line("end_header");
    body();
    return out_;
  }

 private:
  void line(const std::string& text) {
    const std::string whole = text + spec_.lineBreak;
    out_.insert(out_.end(), whole.begin(), whole.end());
  }
  void header(const std::string& element, std::size_t count, const std::vector<std::string>& properties) {
    line("element " + element + " " + std::to_string(count));
    for (const std::string& property : properties) line(property);
  }
  void scalar(const std::string& type, double value) {
    if (spec_.encoding != "ascii") {
      appendScalar(out_, type, value,
                   spec_.encoding == "binary_big_endian" ? io::ByteOrder::big : io::ByteOrder::little);
      return;
    }
    char text[40];
    std::snprintf(text, sizeof(text), "%.9g ", value);
    out_.insert(out_.end(), text, text + std::strlen(text));
  }
  void endRow() {
    if (spec_.encoding == "ascii") line("");
  }
  void body() {
    for (int camera = 0; spec_.extras && camera < 2; ++camera) {
      scalar("double", 45.5);
      scalar("uchar", camera);
      for (int i = 0; i < camera; ++i) scalar("short", -7);
      endRow();
    }
    for (std::size_t v = 0; v < spec_.positions.size(); v += 3) {
      if (spec_.extras) scalar("uchar", 200);
      scalar(spec_.coordinate, spec_.positions[v]);
      if (spec_.extras) {
        scalar("int", static_cast<double>(v % 2));
        if (v % 2 != 0) scalar("float", 0.5);
        scalar(spec_.coordinate, spec_.positions[v + 2]);
        scalar("int8", -3);
      }
      scalar(spec_.coordinate, spec_.positions[v + 1]);
      if (!spec_.extras) scalar(spec_.coordinate, spec_.positions[v + 2]);
      endRow();
    }
    for (const std::vector<int>& face : spec_.faces) {
      scalar(spec_.count, static_cast<double>(face.size()));
      for (const int vertex : face) scalar(spec_.index, vertex);
      if (spec_.extras) scalar("ushort", 9);
      endRow();
    }
    if (!spec_.extras) return;
    scalar("int", 0);
    scalar("int", 1);
    endRow();
  }

  PlySpec spec_;
  FileBytes out_;
};

inline FileBytes makePly(const PlySpec& spec) {
  return PlyWriter(spec).write();
}

/// A buffer that tests fill piece by piece.
struct BufferBuilder {
  FileBytes bytes;

  std::size_t floats(const std::vector<double>& values) {
    const std::size_t begin = bytes.size();
    for (const double value : values) appendScalar(bytes, "float", value, io::ByteOrder::little);
    return begin;
  }
  std::size_t indices(const std::string& type, const std::vector<std::vector<int>>& faces) {
    const std::size_t begin = bytes.size();
    for (const std::vector<int>& face : faces) {
      for (const int vertex : face) appendScalar(bytes, type, vertex, io::ByteOrder::little);
    }
    while (bytes.size() % 4 != 0) bytes.push_back(0);
    return begin;
  }
};

/// A GLB from JSON text and a BIN chunk (none if empty), padded as the specification wants.
inline FileBytes makeGlb(std::string json, FileBytes bin = {}) {
  while (json.size() % 4 != 0) json += ' ';
  while (bin.size() % 4 != 0) bin.push_back(0);
  FileBytes out;
  const auto word = [&](std::size_t value) {
    appendScalar(out, "uint", static_cast<double>(value), io::ByteOrder::little);
  };
  word(0x46546c67);
  word(2);
  word(12 + 8 + json.size() + (bin.empty() ? 0 : 8 + bin.size()));
  word(json.size());
  word(0x4e4f534a);
  out.insert(out.end(), json.begin(), json.end());
  if (bin.empty()) return out;
  word(bin.size());
  word(0x004e4942);
  out.insert(out.end(), bin.begin(), bin.end());
  return out;
}

/// The grid as glTF: JSON with one mesh and its buffer of positions and 16-bit indices.
struct GridGltf {
  FileBytes bin;
  std::string json;

  FileBytes glb() const { return makeGlb(json, bin); }
};

/// @param uri  empty, or the member `"uri":"...",` of the buffer.
inline GridGltf gridGltf(const std::string& uri = "") {
  BufferBuilder buffer;
  buffer.floats(gridPositions());
  buffer.indices("ushort", gridTriangles());
  GridGltf file;
  file.bin = buffer.bytes;
  file.json = R"({"asset":{"version":"2.0","generator":"a \"test\" /"},"extensionsUsed":["KHR_materials_unlit"],
 "buffers":[{URI"byteLength":LENGTH}],
 "bufferViews":[{"buffer":0,"byteLength":108,"target":34962},{"buffer":0,"byteOffset":108,"byteLength":48}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":9,"type":"VEC3","min":[0, 0.0,-1.000],"max":[2,2e0 ,0.75]},
  {"bufferView":1,"componentType":5123,"count":24,"type":"SCALAR"}],
 "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],
 "materials":[{"extensions":{"KHR_materials_unlit":{}},"extras":{"big":123456789012345678901234567890,"none":null}}],
 "nodes":[{"name":"grid \u00e9","mesh":0}],"scenes":[{"nodes":[0]}],"scene":0})";
  file.json = replaced(replaced(file.json, "LENGTH", std::to_string(file.bin.size())), "URI", uri);
  return file;
}

inline std::string base64(const FileBytes& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t quad = 0;
    for (std::size_t k = 0; k < 3; ++k) quad = (quad << 8) | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[(quad >> (18 - 6 * k)) & 63] : '=';
  }
  return out;
}

}  // namespace quadmark::test
