// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "io_fixtures.h"

namespace quadmark::test {
namespace {

std::unique_ptr<Model> readOk(const FileBytes& file) {
  Result<std::unique_ptr<Model>> model = readModel(file);
  EXPECT_TRUE(model.ok()) << model.error().message;
  return model.ok() ? std::move(model).value() : nullptr;
}

void expectRefused(const FileBytes& file, ErrorCode code, const std::string& place) {
  const Result<std::unique_ptr<Model>> model = readModel(file);
  ASSERT_FALSE(model.ok()) << place;
  EXPECT_EQ(errorCodeName(model.error().code), errorCodeName(code)) << model.error().message;
  EXPECT_NE(model.error().message.find(place), std::string::npos) << model.error().message;
}

std::vector<PlySpec> allVariants() {
  std::vector<PlySpec> variants;
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* coordinate : {"float", "float32", "double", "float64"}) {
      for (const bool extras : {false, true}) {
        for (const char* lineBreak : {"\n", "\r\n"}) {
          PlySpec spec;
          spec.encoding = encoding;
          spec.coordinate = coordinate;
          spec.extras = extras;
          spec.lineBreak = lineBreak;
          variants.push_back(spec);
        }
      }
    }
  }
  return variants;
}

std::string nameOf(const PlySpec& spec) {
  return spec.encoding + " " + spec.coordinate + (spec.extras ? " extras" : "") +
         (spec.lineBreak == "\n" ? " LF" : " CRLF");
}

std::vector<std::uint32_t> flat(const std::vector<std::vector<int>>& faces) {
  std::vector<std::uint32_t> corners;
  for (const auto& face : faces) corners.insert(corners.end(), face.begin(), face.end());
  return corners;
}

TEST(ReadPly, ReadsEveryEncodingCoordinateTypeAndHeaderStyle) {
  for (const PlySpec& spec : allVariants()) {
    SCOPED_TRACE(nameOf(spec));
    const auto model = readOk(makePly(spec));
    ASSERT_NE(model, nullptr);
    EXPECT_EQ(model->mesh().positions, gridPositions());
    EXPECT_EQ(model->mesh().faceVertices, flat(gridTriangles()));
    EXPECT_TRUE(model->mesh().faceOffsets.empty());
    EXPECT_TRUE(model->mesh().groups.empty());
    EXPECT_TRUE(model->vertexMesh().empty());
    EXPECT_TRUE(model->nodes().empty());
    EXPECT_EQ(model->mesh().precision,
              spec.coordinate[0] == 'd' || spec.coordinate == "float64" ? Precision::float64 : Precision::float32);
    EXPECT_EQ(model->info().format, FileFormat::ply);
    EXPECT_EQ(model->info().variant, spec.encoding + " 1.0");
    EXPECT_TRUE(model->info().warnings.empty());
  }
}

TEST(ReadPly, ReadsFaceListsOfEveryIntegerWidthAndName) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* index : {"char", "int8", "uchar", "short", "ushort", "uint16", "int", "int32", "uint", "uint32"}) {
      for (const char* count : {"char", "uchar", "short", "ushort", "int", "uint"}) {
        SCOPED_TRACE(std::string(encoding) + " " + count + " " + index);
        PlySpec spec;
        spec.encoding = encoding;
        spec.index = index;
        spec.count = count;
        spec.list = std::string(index) == "int" ? "vertex_index" : "vertex_indices";
        const auto model = readOk(makePly(spec));
        ASSERT_NE(model, nullptr);
        EXPECT_EQ(model->mesh().faceVertices, flat(gridTriangles()));
      }
    }
  }
}

TEST(ReadPly, KeepsPolygonsWithTheirCornerCounts) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    PlySpec spec;
    spec.encoding = encoding;
    spec.faces = gridPolygons();
    const auto model = readOk(makePly(spec));
    ASSERT_NE(model, nullptr);
    EXPECT_EQ(model->mesh().faceVertices, flat(gridPolygons()));
    EXPECT_EQ(model->mesh().faceOffsets, (std::vector<std::uint32_t>{0, 4, 7, 10, 13, 16, 20}));
    EXPECT_TRUE(validate(model->mesh()).ok());
  }
  PlySpec late;  // triangles first: the offsets of earlier faces are filled in
  late.faces = {{0, 1, 4}, {1, 2, 4}, {4, 5, 8, 7}};
  EXPECT_EQ(readOk(makePly(late))->mesh().faceOffsets, (std::vector<std::uint32_t>{0, 3, 6, 10}));
}

TEST(ReadPly, PassesFacesWithFewerThanThreeCornersThroughWithAWarning) {
  PlySpec spec;
  spec.faces = {{0, 1, 4}, {}, {1}, {1, 2}, {1, 2, 4}};
  const auto model = readOk(makePly(spec));
  EXPECT_EQ(model->mesh().faceVertices, (std::vector<std::uint32_t>{0, 1, 4, 1, 2, 4}));
  ASSERT_EQ(model->info().warnings.size(), 1u);
  EXPECT_EQ(model->info().warnings[0], "3 faces with fewer than 3 corners are passed through");
}

TEST(ReadPly, ExpandsTriangleStripsWithAlternatingWindingAndRestarts) {
  for (const char* index : {"int", "uint", "short"}) {
    PlySpec spec;
    spec.encoding = "binary_little_endian";
    spec.strips = true;
    spec.count = "int";
    spec.index = index;
    spec.faces = {{0, 3, 1, 4, 4, 5, -1, 6, 3, 7, 4}, {4, 5, 8}, {1}, {}};
    if (std::string(index) == "uint") spec.faces = {{0, 3, 1, 4, 4, 5, -1, 6, 3, 7, 4}, {4, 5, 8}, {}};
    const auto model = readOk(makePly(spec));
    ASSERT_NE(model, nullptr);
    // Strip 0 3 1 4 4 5: two triangles, then two degenerate ones that keep the winding's parity.
    EXPECT_EQ(model->mesh().faceVertices, (std::vector<std::uint32_t>{0, 3, 1, 1, 3, 4, 6, 3, 7, 7, 3, 4, 4, 5, 8}))
        << index;
  }
}

TEST(ReadPly, ReadsFacesThatComeBeforeTheVertices) {
  const auto model =
      readOk(bytesOf("ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
                     "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
                     "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n"));
  EXPECT_EQ(model->mesh().faceVertices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(ReadPly, ReadsClassicMacLineBreaks) {
  PlySpec spec;
  spec.lineBreak = "\r";
  spec.encoding = "binary_little_endian";
  EXPECT_EQ(readOk(makePly(spec))->mesh().positions, gridPositions());
}

TEST(ReadPly, RefusesEveryTruncation) {
  for (const PlySpec& spec : allVariants()) {
    SCOPED_TRACE(nameOf(spec));
    const FileBytes whole = makePly(spec);
    // In a text file only the last number cannot be told from a shorter one, nor can a lost line break.
    std::size_t end = whole.size();
    if (spec.encoding == "ascii") end = textOf(whole).find_last_of("0123456789");
    for (std::size_t size = 0; size < end; ++size) {
      const FileBytes file(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      const Result<std::unique_ptr<Model>> model = readModel(file);
      ASSERT_FALSE(model.ok()) << size << " of " << whole.size() << " bytes";
      ASSERT_EQ(model.error().code, ErrorCode::badFile) << model.error().message;
    }
  }
}

TEST(ReadPly, KeepsBytesAfterTheEndWithAWarning) {
  for (const char* encoding : {"ascii", "binary_little_endian"}) {
    PlySpec spec;
    spec.encoding = encoding;
    FileBytes file = makePly(spec);
    file.push_back('x');
    const auto model = readOk(file);
    ASSERT_EQ(model->info().warnings.size(), 1u);
    EXPECT_EQ(model->info().warnings[0], "1 bytes after the last element are kept as they are");
    EXPECT_EQ(model->patch(file, {}, model->mesh().positions)->bytes, file);
  }
}

/// The small triangle with one thing replaced.
FileBytes broken(const std::string& what, const std::string& by) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2\n";
  EXPECT_NE(text.find(what), std::string::npos) << what;
  return bytesOf(replaced(text, what, by));
}

TEST(ReadPly, RefusesBrokenHeadersNamingTheLine) {
  expectRefused(broken("format ascii 1.0", "format ebcdic 1.0"), ErrorCode::badFile,
                "line 2: unknown format \"ebcdic\"");
  expectRefused(broken("format ascii 1.0", "format ascii 2.0"), ErrorCode::unsupportedFile, "line 2");
  expectRefused(broken("format ascii 1.0\n", ""), ErrorCode::badFile, "no format line");
  expectRefused(broken("element vertex 3", "element vertex -3"), ErrorCode::badFile, "line 3");
  expectRefused(broken("element vertex 3", "element vertex three"), ErrorCode::badFile, "line 3");
  expectRefused(broken("element vertex 3", "element vertex"), ErrorCode::badFile, "line 3");
  expectRefused(broken("element vertex 3", "element vertex 99999999999999999999"), ErrorCode::badFile, "line 3");
  expectRefused(broken("element face 1", "element vertex 1"), ErrorCode::badFile,
                "line 7: element \"vertex\" appears twice");
  expectRefused(broken("property float y", "property half y"), ErrorCode::badFile,
                "line 5: unknown property type \"half\"");
  expectRefused(broken("property float y", "property float x"), ErrorCode::badFile,
                "line 5: property \"x\" appears twice");
  expectRefused(broken("property float y", "property float"), ErrorCode::badFile, "line 5");
  expectRefused(broken("property float y\n", ""), ErrorCode::badFile, "no property \"y\"");
  expectRefused(broken("list uchar int", "list float int"), ErrorCode::badFile, "line 8");
  expectRefused(broken("list uchar int", "list uchar float"), ErrorCode::badFile, "not a list of integers");
  expectRefused(broken("property list uchar int vertex_indices", "property int vertex_indices"), ErrorCode::badFile,
                "not a list");
  expectRefused(broken("element face 1", "elephant face 1"), ErrorCode::badFile,
                "line 7: unknown keyword \"elephant\"");
  expectRefused(broken("end_header\n", ""), ErrorCode::badFile, "unknown keyword");
  expectRefused(broken("element vertex 3\n", ""), ErrorCode::badFile, "line 3: property before the first element");
  expectRefused(broken("element vertex 3", "element vertices 3"), ErrorCode::badFile, "no element \"vertex\"");
}

TEST(ReadPly, RefusesCoordinatesItCannotPatch) {
  for (const char* type : {"int", "uchar", "short"}) {
    expectRefused(broken("property float", std::string("property ") + type), ErrorCode::unsupportedFile,
                  "integer type");
  }
  expectRefused(broken("property float z", "property double z"), ErrorCode::unsupportedFile, "different types");
  expectRefused(broken("property float z", "property list uchar float z"), ErrorCode::badFile, "is a list");
}

TEST(ReadPly, RefusesBrokenBodiesNamingThePlace) {
  expectRefused(broken("0 1 0.5", "0 abc 0.5"), ErrorCode::badFile, "line 12: vertex 2, property \"y\": \"abc\"");
  expectRefused(broken("0 1 0.5", "0 1,0 0.5"), ErrorCode::badFile, "line 12");
  expectRefused(broken("0 1 0.5", "0 nan 0.5"), ErrorCode::badMesh, "vertex 2, property y");
  expectRefused(broken("0 1 0.5", "0 -inf 0.5"), ErrorCode::badMesh, "vertex 2, property y");
  expectRefused(broken("0 1 0.5", "0 1e39 0.5"), ErrorCode::badMesh, "vertex 2, property y");  // not a float
  expectRefused(broken("3 0 1 2", "3 0 1 3"), ErrorCode::badFile, "line 13: face 0: vertex index 3 is outside 0..2");
  expectRefused(broken("3 0 1 2", "3 0 1 -1"), ErrorCode::badFile, "vertex index -1");
  expectRefused(broken("3 0 1 2", "3 0 1 1.5"), ErrorCode::badFile, "line 13");
  expectRefused(broken("3 0 1 2", "-3 0 1 2"), ErrorCode::badFile, "line 13");
  expectRefused(broken("3 0 1 2", "4000000000 0 1 2"), ErrorCode::badFile, "does not fit");
  expectRefused(broken("3 0 1 2", "2 0 1"), ErrorCode::badMesh, "no faces");
  expectRefused(broken("1 0 0\n0 1 0.5", "0 0 0\n0 0 0"), ErrorCode::badMesh, "at one point");
  expectRefused(broken("element face 1", "element face 0"), ErrorCode::badMesh, "no faces");
  expectRefused(bytesOf(""), ErrorCode::badFile, "empty");
  expectRefused(bytesOf("plyx\n"), ErrorCode::badFile, "not a PLY, glTF, GLB or DRC");
  expectRefused(bytesOf("ply"), ErrorCode::badFile, "not a PLY");
  expectRefused(bytesOf("ply\n"), ErrorCode::badFile, "no end_header");
  expectRefused(bytesOf("solid stl\n"), ErrorCode::badFile, "\"solid st\"");
}

TEST(ReadPly, RefusesNotFiniteBinaryCoordinatesNamingTheVertex) {
  for (const char* coordinate : {"float", "double"}) {
    for (const bool extras : {false, true}) {
      PlySpec spec;
      spec.encoding = "binary_big_endian";
      spec.coordinate = coordinate;
      spec.extras = extras;
      spec.positions[3 * 5 + 2] = std::numeric_limits<double>::quiet_NaN();
      expectRefused(makePly(spec), ErrorCode::badMesh, "vertex 5, property z");
      spec.positions[3 * 5 + 2] = -std::numeric_limits<double>::infinity();
      expectRefused(makePly(spec), ErrorCode::badMesh, "vertex 5, property z");
    }
  }
}

TEST(ReadPly, RefusesDoublesWhoseExtentOverflows) {
  PlySpec spec;
  spec.encoding = "binary_little_endian";
  spec.coordinate = "double";
  spec.positions[0] = -1.7e308;
  spec.positions[3] = 1.7e308;
  expectRefused(makePly(spec), ErrorCode::badMesh, "overflows");
}

/// Positions that differ from the grid in a few components.
std::vector<double> moved() {
  std::vector<double> positions = gridPositions();
  positions[0] = 0.1f;
  positions[5] = -1234567.0f;
  positions[13] = 1.5e-7f;
  positions[26] = 1.0f / 3;
  return positions;
}

TEST(PatchPly, LeavesTheFileAloneWhenNothingMoves) {
  for (const PlySpec& spec : allVariants()) {
    SCOPED_TRACE(nameOf(spec));
    const FileBytes file = makePly(spec);
    const auto model = readOk(file);
    std::vector<double> positions = model->mesh().positions;
    for (double& value : positions) value = value == 0 ? -0.0 : value;  // equal values keep their spelling
    const Result<PatchedFile> patched = model->patch(file, {}, positions);
    ASSERT_TRUE(patched.ok()) << patched.error().message;
    EXPECT_EQ(patched->bytes, file);
    EXPECT_EQ(patched->bytesChanged, 0u);
  }
}

TEST(PatchPly, ReadsBackExactlyWhatWasWritten) {
  for (const PlySpec& spec : allVariants()) {
    SCOPED_TRACE(nameOf(spec));
    const FileBytes file = makePly(spec);
    const auto model = readOk(file);
    const Result<PatchedFile> patched = model->patch(file, {}, moved());
    ASSERT_TRUE(patched.ok()) << patched.error().message;
    EXPECT_EQ(readOk(patched->bytes)->mesh().positions, moved());
    EXPECT_EQ(readOk(patched->bytes)->mesh().faceVertices, flat(gridTriangles()));
    EXPECT_TRUE(patched->resources.empty());
    EXPECT_GT(patched->bytesChanged, 0u);
    // What the caller did to mesh() in the meantime has no influence.
    model->mesh().positions.assign(27, 7.0);
    EXPECT_EQ(model->patch(file, {}, moved())->bytes, patched->bytes);
  }
}

TEST(PatchPly, ChangesNothingButTheBytesOfMovedComponentsInBinaryFiles) {
  for (const PlySpec& spec : allVariants()) {
    if (spec.encoding == "ascii") continue;
    SCOPED_TRACE(nameOf(spec));
    const FileBytes file = makePly(spec);
    PlySpec expected = spec;  // the writer with other positions gives the only right answer
    expected.positions = moved();
    const Result<PatchedFile> patched = readOk(file)->patch(file, {}, moved());
    ASSERT_EQ(patched->bytes, makePly(expected));
    std::uint64_t different = 0;
    for (std::size_t i = 0; i < file.size(); ++i) different += file[i] != patched->bytes[i] ? 1 : 0;
    EXPECT_EQ(patched->bytesChanged, different);
  }
}

TEST(PatchPly, KeepsSpellingAndWhiteSpaceOfTextFiles) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\ncomment  two  blanks \r\nelement vertex 3\r\nproperty float32 x\r\n"
      "property float y\r\nproperty uchar red\r\nproperty float z\r\nelement face 1\r\n"
      "property list uchar int vertex_index\r\nend_header\r\n"
      "+0.00 \t 0e0 007 -0\r\n  1.50000 000.25 +9 1E0  \r\n\r\n0 .5 255 1\r\n3 0 1 2 ";
  const FileBytes file = bytesOf(text);
  const auto model = readOk(file);
  ASSERT_EQ(model->mesh().positions, (std::vector<double>{0, 0, 0, 1.5, 0.25, 1, 0, 0.5, 1}));
  const Result<PatchedFile> patched =
      model->patch(file, {}, std::vector<double>{0, 0, 0, 1.5f, 0.2f, 1, 0, 0.5, 100.125});
  ASSERT_TRUE(patched.ok());
  EXPECT_EQ(textOf(patched->bytes), replaced(replaced(text, "000.25", "0.2"), "255 1\r", "255 100.125\r"));
  EXPECT_EQ(patched->bytesChanged, 5u + 6u);  // 000.25 -> 0.2: two differ, three are gone; 1 -> 100.125: six more
}

TEST(PatchPly, RefusesPositionsThatDoNotFit) {
  const FileBytes file = makePly(PlySpec{});
  const auto model = readOk(file);
  const auto code = [&](std::vector<double> positions, const FileBytes& bytes) {
    const Result<PatchedFile> patched = model->patch(bytes, {}, positions);
    EXPECT_FALSE(patched.ok());
    return patched.ok() ? ErrorCode::internal : patched.error().code;
  };
  std::vector<double> positions = gridPositions();
  positions.pop_back();
  EXPECT_EQ(code(positions, file), ErrorCode::badOption);
  positions = gridPositions();
  positions[4] = 0.1;  // not a float
  EXPECT_EQ(code(positions, file), ErrorCode::badOption);
  positions[4] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code(positions, file), ErrorCode::badOption);
  FileBytes other = file;
  other.pop_back();
  EXPECT_EQ(code(gridPositions(), other), ErrorCode::badOption);
}

}  // namespace
}  // namespace quadmark::test
