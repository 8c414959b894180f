// SPDX-License-Identifier: MIT
// glTF 2.0 binary container (Khronos, section 4): header, JSON chunk, BIN chunk.
#include <algorithm>
#include <cstdio>

#include "byte_writer.h"
#include "mesh_tools.h"

namespace quadmark::lab {
namespace {

/// One glTF mesh: which vertices it stores and its triangles in terms of them.
struct Part {
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> indices;
};

/// The groups' parts by ascending group. A triangle across two groups, which no glTF reader produces, would make its
/// vertices appear in both.
std::vector<Part> splitByGroup(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  std::vector<std::uint32_t> groups = mesh.groups;
  std::sort(groups.begin(), groups.end());
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  if (groups.empty()) groups.push_back(0);
  const auto partOf = [&](std::uint32_t vertex) -> std::size_t {
    if (mesh.groups.empty()) return 0;
    return static_cast<std::size_t>(std::lower_bound(groups.begin(), groups.end(), mesh.groups[vertex]) -
                                    groups.begin());
  };
  std::vector<Part> parts(groups.size());
  std::vector<std::uint32_t> numberOf(mesh.vertexCount());
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    Part& part = parts[partOf(v)];
    numberOf[v] = static_cast<std::uint32_t>(part.vertices.size());
    part.vertices.push_back(v);
  }
  for (std::size_t c = 0; c < triangles.size(); c += 3) {
    const std::size_t first = partOf(triangles[c]);
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t v = triangles[c + i], number = numberOf[v];
      if (partOf(v) != first) {
        number = static_cast<std::uint32_t>(parts[first].vertices.size());
        parts[first].vertices.push_back(v);
      }
      parts[first].indices.push_back(number);
    }
  }
  std::erase_if(parts, [](const Part& part) { return part.indices.empty(); });
  return parts;
}

/// Nine digits bring a float32 back exactly.
std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
  return text;
}

std::string minMax(const Mesh& mesh, const Part& part) {
  float low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  for (std::size_t i = 0; i < part.vertices.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto x = static_cast<float>(mesh.positions[3 * std::size_t{part.vertices[i]} + axis]);
      low[axis] = i == 0 ? x : std::min(low[axis], x);
      high[axis] = i == 0 ? x : std::max(high[axis], x);
    }
  return "\"min\":[" + number(low[0]) + "," + number(low[1]) + "," + number(low[2]) + "],\"max\":[" + number(high[0]) +
         "," + number(high[1]) + "," + number(high[2]) + "]";
}

std::string comma(std::size_t index) {
  return index == 0 ? "" : ",";
}

}  // namespace

std::vector<std::uint8_t> writeGlb(const Mesh& mesh) {
  const std::vector<Part> parts = splitByGroup(mesh, fannedTriangles(mesh));

  // 1. JSON: per part a POSITION view, an index view and their accessors.
  std::string views, accessors, meshes, nodes, scene;
  std::size_t offset = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string position = std::to_string(2 * i), index = std::to_string(2 * i + 1);
    const std::size_t positionBytes = 12 * parts[i].vertices.size(), indexBytes = 4 * parts[i].indices.size();
    views += comma(i) + "{\"buffer\":0,\"byteOffset\":" + std::to_string(offset) +
             ",\"byteLength\":" + std::to_string(positionBytes) +
             ",\"target\":34962},{\"buffer\":0,\"byteOffset\":" + std::to_string(offset + positionBytes) +
             ",\"byteLength\":" + std::to_string(indexBytes) + ",\"target\":34963}";
    accessors += comma(i) + "{\"bufferView\":" + position +
                 ",\"componentType\":5126,\"count\":" + std::to_string(parts[i].vertices.size()) +
                 ",\"type\":\"VEC3\"," + minMax(mesh, parts[i]) + "},{\"bufferView\":" + index +
                 ",\"componentType\":5125,\"count\":" + std::to_string(parts[i].indices.size()) +
                 ",\"type\":\"SCALAR\"}";
    meshes +=
        comma(i) + "{\"primitives\":[{\"attributes\":{\"POSITION\":" + position + "},\"indices\":" + index + "}]}";
    nodes += comma(i) + "{\"mesh\":" + std::to_string(i) + "}";
    scene += comma(i) + std::to_string(i);
    offset += positionBytes + indexBytes;
  }
  std::string json = "{\"asset\":{\"version\":\"2.0\",\"generator\":\"quadmark\"}";
  if (!parts.empty())  // glTF forbids empty arrays
    json += ",\"scene\":0,\"scenes\":[{\"nodes\":[" + scene + "]}],\"nodes\":[" + nodes + "],\"meshes\":[" + meshes +
            "],\"accessors\":[" + accessors + "],\"bufferViews\":[" + views +
            "],\"buffers\":[{\"byteLength\":" + std::to_string(offset) + "}]";
  json += "}";
  json.append((4 - json.size() % 4) % 4, ' ');

  // 2. Container. All parts of the BIN chunk are multiples of four bytes.
  const std::size_t total = 12 + 8 + json.size() + (parts.empty() ? 0 : 8 + offset);
  ByteWriter out(total);
  out.text("glTF");
  out.uint32(2);
  out.uint32(static_cast<std::uint32_t>(total));
  out.uint32(static_cast<std::uint32_t>(json.size()));
  out.text("JSON");
  out.text(json);
  if (parts.empty()) return out.take();
  out.uint32(static_cast<std::uint32_t>(offset));
  out.text(std::string_view("BIN\0", 4));
  for (const Part& part : parts) {
    for (std::uint32_t v : part.vertices)
      for (std::size_t axis = 0; axis < 3; ++axis)
        out.float32(static_cast<float>(mesh.positions[3 * std::size_t{v} + axis]));
    for (std::uint32_t i : part.indices) out.uint32(i);
  }
  return out.take();
}

}  // namespace quadmark::lab
