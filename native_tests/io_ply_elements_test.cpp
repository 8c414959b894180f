// SPDX-License-Identifier: MIT
// PLY files with elements, lists, comments and line ends wherever the format allows them.
#include <gtest/gtest.h>

#include "io_fixtures.h"

namespace quadmark::test {
namespace {

/// A property's type ("float", or "uchar int" for a list) and its values in each row.
struct Column {
  std::string type, name;
  std::vector<std::vector<double>> rows;
};
struct Element {
  std::string name;
  std::vector<Column> columns;
};

FileBytes write(const std::vector<Element>& elements, const std::string& encoding, const std::string& lineBreak) {
  std::string header = "ply" + lineBreak + "comment before the format" + lineBreak + "format " + encoding + " 1.0" + lineBreak +
                       "obj_info num_cols 3" + lineBreak;
  FileBytes body;
  const io::ByteOrder order = encoding == "binary_big_endian" ? io::ByteOrder::big : io::ByteOrder::little;
  const auto put = [&](const std::string& type, double value) {
    if (encoding != "ascii") return appendScalar(body, type, value, order);
    char text[40];
    std::snprintf(text, sizeof(text), "%.9g ", value);
    body.insert(body.end(), text, text + std::strlen(text));
  };
  for (const Element& element : elements) {
    header += "element " + element.name + " " + std::to_string(element.columns[0].rows.size()) + lineBreak;
    for (const Column& column : element.columns) {
      const bool isList = column.type.find(' ') != std::string::npos;
      header += std::string("property ") + (isList ? "list " : "") + column.type + " " + column.name + lineBreak;
      header += "comment after " + column.name + " element face 7" + lineBreak;
    }
    for (std::size_t row = 0; row < element.columns[0].rows.size(); ++row) {
      for (const Column& column : element.columns) {
        const std::size_t blank = column.type.find(' ');
        if (blank != std::string::npos) put(column.type.substr(0, blank), static_cast<double>(column.rows[row].size()));
        for (const double value : column.rows[row]) put(column.type.substr(blank == std::string::npos ? 0 : blank + 1), value);
      }
      if (encoding == "ascii") body.insert(body.end(), lineBreak.begin(), lineBreak.end());
    }
  }
  header += "end_header" + lineBreak;
  FileBytes file = bytesOf(header);
  file.insert(file.end(), body.begin(), body.end());
  return file;
}

std::vector<Element> elements(const std::vector<double>& positions, const std::string& index, const std::string& list) {
  Element vertex{"vertex", {{"uchar float", "weights", {}}, {"float", "z", {}}, {"float", "x", {}}, {"double", "quality", {}}, {"float", "y", {}}}};
  for (std::size_t v = 0; v < positions.size(); v += 3) {
    vertex.columns[0].rows.push_back(std::vector<double>(v % 2, 0.25));
    vertex.columns[1].rows.push_back({positions[v + 2]});
    vertex.columns[2].rows.push_back({positions[v]});
    vertex.columns[3].rows.push_back({1.5});
    vertex.columns[4].rows.push_back({positions[v + 1]});
  }
  Element face{"face", {{"uchar float", "texcoord", {}}, {"ushort " + index, list, {}}, {"uchar", "flags", {}}, {"int short", "tags", {}}}};
  for (const std::vector<int>& polygon : gridPolygons()) {
    face.columns[0].rows.push_back(std::vector<double>(2 * polygon.size(), 0.5));
    face.columns[1].rows.emplace_back(polygon.begin(), polygon.end());
    face.columns[2].rows.push_back({3});
    face.columns[3].rows.push_back(std::vector<double>(polygon.size() % 3, -4));
  }
  return {{"camera", {{"double", "fov", {{45}, {60}}}, {"uint double", "path", {{1, 2, 3}, {}}}}},
          vertex,
          {"material", {{"char uchar", "name", {{65, 66}, {}, {67}}}}},
          face,
          {"edge", {{"int", "vertex1", {{0}}}, {"uchar ushort", "others", {{1, 2, 3, 4}}}}},
          {"nothing", {{"int", "at_all", {}}}}};
}

TEST(PlyElements, AreReadAndPatchedWhateverStandsAroundThem) {
  std::vector<double> moved = gridPositions();
  moved[0] = -0.5, moved[4] = 0.25, moved[13] = 1.5, moved[26] = -1.25;
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* lineBreak : {"\n", "\r\n"}) {
      for (const auto& [index, list] : {std::pair{"int", "vertex_indices"}, {"uchar", "vertex_index"}, {"short", "vertex_indices"}, {"uint32", "vertex_index"}}) {
        SCOPED_TRACE(std::string(encoding) + " " + index + " " + list);
        const FileBytes file = write(elements(gridPositions(), index, list), encoding, lineBreak);
        const auto model = readModel(file);
        ASSERT_TRUE(model.ok()) << model.error().message;
        EXPECT_EQ((*model)->mesh().positions, gridPositions());
        EXPECT_EQ((*model)->mesh().faceOffsets, (std::vector<std::uint32_t>{0, 4, 7, 10, 13, 16, 20}));
        EXPECT_TRUE((*model)->info().warnings.empty());
        const auto patched = (*model)->patch(file, {}, moved);
        ASSERT_TRUE(patched.ok()) << patched.error().message;
        EXPECT_EQ(textOf(patched->bytes), textOf(write(elements(moved, index, list), encoding, lineBreak)));
      }
    }
  }
}

}  // namespace
}  // namespace quadmark::test
