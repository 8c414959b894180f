// SPDX-License-Identifier: MIT
// Marks in one object of a scene, and across seams that quantization has split.
#include "quadmark/extract_parts.h"

#include <cmath>

#include "fixtures.h"
#include "io_fixtures.h"

namespace quadmark::test {
namespace {

std::vector<std::uint8_t> idBits() {
  std::vector<std::uint8_t> bits(64);
  for (int i = 0; i < 64; ++i) bits[i] = static_cast<std::uint8_t>(0x0123456789abcdefu >> (63 - i) & 1);
  return bits;
}

/// One mesh of several, side by side, as joining the primitives of a scene makes it.
Mesh joined(const std::vector<Mesh>& parts) {
  Mesh out;
  double offset = 0;
  for (const Mesh& part : parts) {
    const auto base = static_cast<std::uint32_t>(out.vertexCount());
    double low = 1e300, high = -1e300;
    for (std::size_t i = 0; i < part.positions.size(); i += 3)
      low = std::min(low, part.positions[i]), high = std::max(high, part.positions[i]);
    for (std::size_t i = 0; i < part.positions.size(); ++i)
      out.positions.push_back(part.positions[i] + (i % 3 == 0 ? offset - low : 0));
    offset += 1.2 * (high - low);
    for (std::size_t f = 0; f < part.faceCount(); ++f)
      for (std::size_t c = part.faceBegin(f) + 1; c + 1 < part.faceEnd(f); ++c)
        for (const std::size_t corner : {part.faceBegin(f), c, c + 1}) out.faceVertices.push_back(base + part.faceVertices[corner]);
  }
  roundToPrecision(out);
  return out;
}

PartsExtraction readParts(const Mesh& mesh, const Key& key) {
  ExtractOptions options;
  options.keepReadings = true;
  return extractParts(weld(mesh), mesh.precision, key, options);
}

TEST(Components, AreNumberedByTheirLowestVertices) {
  const WeldedMesh welded = weld(joined({lab::cube(), lab::icosphere(1), lab::cube()}));
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> of = components(welded, count);
  EXPECT_EQ(count, 3u);
  EXPECT_EQ(of[0], 0u);
  EXPECT_EQ(of[8], 1u);
  EXPECT_EQ(of.back(), 2u);
  for (std::uint32_t v = 0; v < welded.vertexCount(); ++v)
    for (const std::uint32_t w : welded.neighboursOf(v)) EXPECT_EQ(of[v], of[w]);
}

TEST(SubMesh, KeepsTheEdgesInside) {
  const WeldedMesh whole = weld(joined({lab::cube(), lab::icosphere(1)})), alone = weld(lab::icosphere(1));
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t v = 8; v < whole.vertexCount(); ++v) vertices.push_back(v);
  const WeldedMesh part = subMesh(whole, vertices);
  EXPECT_EQ(part.edgeOffsets, alone.edgeOffsets);
  EXPECT_EQ(part.neighbours, alone.neighbours);
  EXPECT_EQ(part.positions.size(), alone.positions.size());
}

/// The seamed sphere with the second copies of its duplicated vertices moved a little.
Mesh splitSeam(Mesh mesh, double shift) {
  const WeldedMesh welded = weld(mesh);
  std::vector<bool> seen(welded.vertexCount());
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    const std::uint32_t w = welded.weldedOf[v];
    if (w == kNoVertex) continue;
    if (seen[w])
      for (std::size_t axis = 0; axis < 3; ++axis) mesh.positions[3 * v + axis] += (axis == v % 3 ? shift : -shift);
    seen[w] = true;
  }
  roundToPrecision(mesh);
  return mesh;
}

TEST(CloseSeams, WeldsTwinsThatQuantizationParted) {
  const Mesh mesh = lab::seamed(4);
  const WeldedMesh before = weld(mesh), split = weld(splitSeam(mesh, 5e-5 * boundingDiagonal(mesh)));
  ASSERT_GT(split.vertexCount(), before.vertexCount());
  std::vector<std::uint32_t> origin;
  const WeldedMesh closed = closeSeams(split, origin);
  EXPECT_EQ(closed.vertexCount(), before.vertexCount());
  EXPECT_EQ(closed.neighbours.size(), before.neighbours.size());
  EXPECT_EQ(origin.size(), closed.vertexCount());
  for (const NamedMesh& named : allMeshes()) {  // where nothing is near anything else, nothing is welded
    SCOPED_TRACE(named.name);
    const WeldedMesh welded = weld(named.mesh);
    EXPECT_EQ(closeSeams(welded, origin).vertexCount(), welded.vertexCount());
  }
}

TEST(CloseSeams, DoesNotSeeTheOrderOfTheVertices) {
  const Mesh mesh = splitSeam(lab::seamed(4), 3e-5 * boundingDiagonal(lab::seamed(4)));
  const auto sortedPositions = [](const Mesh& m) {
    std::vector<std::uint32_t> origin;
    const WeldedMesh closed = closeSeams(weld(m), origin);
    std::vector<std::array<double, 4>> out;
    for (std::uint32_t v = 0; v < closed.vertexCount(); ++v)
      out.push_back({closed.positions[3 * v], closed.positions[3 * v + 1], closed.positions[3 * v + 2],
                     static_cast<double>(closed.neighboursOf(v).size())});
    std::sort(out.begin(), out.end());
    return out;
  };
  EXPECT_EQ(sortedPositions(mesh), sortedPositions(lab::reorder(mesh, 7)));
}

TEST(ExtractParts, FindsTheMarkOfOneObjectInAJoinedScene) {
  const Key key = idKey();
  const Mesh object = marked(lab::sculpture(1500), key, idBits());
  // Unmarked objects of every kind, flat ones too, whose sets of four points drown those of a mark.
  const std::vector<Mesh> others = {lab::machinedPart(3000), lab::flatGrid(40, 40), lab::bumpyGrid(30, 30, 9),
                                    lab::polygonMix(8), lab::machinedPart(2500, 5), lab::sculpture(2000, 3)};
  std::vector<Mesh> scene = others;
  scene.insert(scene.begin() + 3, object);
  const PartsExtraction read = readParts(joined(scene), key);
  EXPECT_EQ(read.extraction.verdict, Verdict::match) << read.extraction.falsePositive;
  EXPECT_LE(read.extraction.falsePositive, kMatchProbability);
  EXPECT_TRUE(isExact(read.extraction, idBits()));

  const PartsExtraction none = readParts(joined(others), key);
  EXPECT_EQ(none.extraction.verdict, Verdict::none);
  EXPECT_EQ(none.part, Part::model);
  EXPECT_GT(none.tried, 5u);
  EXPECT_EQ(readParts(joined(scene), strangersKey(key, 1)).extraction.verdict, Verdict::none);
}

TEST(ExtractParts, FindsTheMarkOfASmallObjectAmongLargeFlatOnes) {
  const Key key = idKey();
  const Mesh object = marked(lab::bumpyGrid(28, 28, 3), key, idBits());
  const PartsExtraction read =
      readParts(joined({lab::flatGrid(60, 60), lab::machinedPart(8000, 2), object, lab::flatGrid(70, 50)}), key);
  EXPECT_EQ(read.extraction.verdict, Verdict::match) << read.extraction.falsePositive;
  EXPECT_EQ(read.part, Part::component);
  EXPECT_EQ(read.partVertices, 784u);
  EXPECT_GE(read.tried, 4u);
  for (const CellReading& reading : read.extraction.readings)  // numbered as in the whole scene
    for (const std::uint32_t v : reading.vertices) EXPECT_GE(v, 61u * 61u);
}

TEST(ExtractParts, ChargesForEverythingItTries) {
  const Key key = idKey();
  const Mesh object = marked(lab::sculpture(1500), key, idBits());
  const PartsExtraction whole = readParts(object, key);
  EXPECT_EQ(whole.part, Part::model);
  EXPECT_EQ(whole.tried, 1u);
  EXPECT_EQ(whole.partVertices, weld(object).vertexCount());
  EXPECT_EQ(whole.extraction.falsePositive, 2 * readMark(object, key).falsePositive);
}

TEST(ExtractParts, IsNotSatisfiedOftenerThanItSaysByStrangersKeys) {
  const Key key = idKey();
  const Mesh scene = joined({marked(lab::sculpture(900), key, idBits()), lab::machinedPart(900), lab::flatGrid(20, 20)});
  const WeldedMesh welded = weld(scene);
  int below[3] = {0, 0, 0};
  const int keys = repetitions(200);
  for (int i = 0; i < keys; ++i) {
    const double p =
        extractParts(welded, scene.precision, strangersKey(key, static_cast<std::uint32_t>(i)), {}).extraction.falsePositive;
    below[0] += p <= 0.1, below[1] += p <= 0.01, below[2] += p <= kDoubtProbability;
  }
  EXPECT_LE(below[0], keys / 10 + 6);
  EXPECT_LE(below[1], keys / 100 + 3);
  EXPECT_EQ(below[2], 0);
}

TEST(ExtractParts, ClosesSeamsWhereTheMarkNeedsIt) {
  // Every face with corners of its own, no two of them at the same place: no two faces share a vertex.
  const Key key = idKey();
  const Mesh object = marked(asFloat64(joined({lab::sculpture(1500)})), key, idBits());
  Mesh soup;
  soup.precision = Precision::float64;
  for (const std::uint32_t v : object.faceVertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t random = static_cast<std::uint32_t>(soup.positions.size()) * 2654435761u;
      soup.positions.push_back(object.positions[3 * std::size_t{v} + axis] + (random * 0x1p-32 - 0.5) * 1e-8);
    }
    soup.faceVertices.push_back(static_cast<std::uint32_t>(soup.faceVertices.size()));
  }
  ASSERT_NE(readMark(soup, key).verdict, Verdict::match);
  const PartsExtraction read = readParts(soup, key);
  EXPECT_EQ(read.extraction.verdict, Verdict::match) << read.extraction.falsePositive;
  EXPECT_EQ(read.part, Part::closedSeams);
  EXPECT_TRUE(isExact(read.extraction, idBits()));
}

/// Two glTF meshes in a GLB, drawn by two nodes.
FileBytes twoNodeScene(const Mesh& first, const Mesh& second) {
  BufferBuilder buffer;
  std::string views, accessors;
  int count = 0;
  for (const Mesh* mesh : {&first, &second}) {
    const std::size_t positions = buffer.floats(mesh->positions), indices = buffer.bytes.size();
    for (const std::uint32_t v : mesh->faceVertices) appendScalar(buffer.bytes, "uint", v, io::ByteOrder::little);
    views += (count == 0 ? "" : ",") + (R"({"buffer":0,"byteOffset":)" + std::to_string(positions)) + R"(,"byteLength":)" +
             std::to_string(indices - positions) + R"(},{"buffer":0,"byteOffset":)" + std::to_string(indices) +
             R"(,"byteLength":)" + std::to_string(buffer.bytes.size() - indices) + "}";
    accessors += (count == 0 ? "" : ",") + (R"({"bufferView":)" + std::to_string(count)) +
                 R"(,"componentType":5126,"type":"VEC3","count":)" + std::to_string(mesh->vertexCount()) +
                 R"(},{"bufferView":)" + std::to_string(count + 1) + R"(,"componentType":5125,"type":"SCALAR","count":)" +
                 std::to_string(mesh->faceVertices.size()) + "}";
    count += 2;
  }
  return makeGlb(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":)" + std::to_string(buffer.bytes.size()) +
                     R"(}],"bufferViews":[)" + views + R"(],"accessors":[)" + accessors +
                     R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]},)"
                     R"({"primitives":[{"attributes":{"POSITION":2},"indices":3}]}],)"
                     R"("nodes":[{"name":"plain","mesh":0},{"name":"marked","mesh":1}]})",
                 buffer.bytes);
}

TEST(ExtractReport, SaysInWhichNodeTheEvidenceIs) {
  const Key key = idKey();
  const FileBytes file = twoNodeScene(joined({lab::sculpture(2000, 3)}), marked(joined({lab::sculpture(1500)}), key, idBits()));
  const auto response = extract(file, {}, {key, std::nullopt, {}});
  ASSERT_TRUE(response.ok()) << response.error().message;
  EXPECT_EQ(response->verdict, "match");
  const std::string& report = response->reportJson;
  const std::size_t plain = report.find(R"("name":"plain")"), carrier = report.find(R"("name":"marked")");
  ASSERT_NE(plain, report.npos);
  ASSERT_NE(carrier, report.npos);
  const auto share = [&](std::size_t from) { return std::stod(report.substr(report.find("\"share\":", from) + 8)); };
  EXPECT_LT(share(plain), 0.02);
  EXPECT_GT(share(carrier), 0.98);
  EXPECT_NE(report.find(R"("readFrom":"model")"), report.npos) << report.substr(0, 300);
}

}  // namespace
}  // namespace quadmark::test
