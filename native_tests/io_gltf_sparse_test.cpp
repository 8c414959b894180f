// SPDX-License-Identifier: MIT
// Sparse positions, positions without data, and integer codes at the edges of their ranges.
#include <gtest/gtest.h>

#include "io_allocations.h"
#include "io_fixtures.h"

namespace quadmark::test {
namespace {

/// The grid of io_fixtures.h whose last vertices come from a sparse part: JSON after the accessor's type, and a buffer
/// with positions (0..107), 16-bit triangle indices (108..155), sparse indices (156..) and values (164..).
struct SparseGrid {
  std::string json;
  FileBytes bin;
  FileBytes glb() const { return makeGlb(json, bin); }
};

SparseGrid sparseGrid(const std::vector<int>& replaced_, const std::vector<double>& values, bool base = true) {
  const GridGltf grid = gridGltf();
  BufferBuilder buffer{grid.bin};
  for (const int index : replaced_) appendScalar(buffer.bytes, "ushort", index, io::ByteOrder::little);
  buffer.bytes.resize(164, 0xee);
  buffer.floats(values);
  const std::string sparse =
      R"("type":"VEC3","sparse":{"count":)" + std::to_string(replaced_.size()) +
      R"(,"indices":{"bufferView":2,"componentType":5123},"values":{"bufferView":3}})";
  std::string json = replaced(grid.json, "156", std::to_string(buffer.bytes.size()));
  json = replaced(json, R"("type":"VEC3")", sparse);
  json = replaced(json, R"("byteOffset":108,"byteLength":48})",
                  R"("byteOffset":108,"byteLength":48},{"buffer":0,"byteOffset":156,"byteLength":8},)"
                  R"({"buffer":0,"byteOffset":164,"byteLength":)" +
                      std::to_string(4 * values.size()) + "}");
  if (!base) json = replaced(json, R"({"bufferView":0,"componentType":5126)", R"({"componentType":5126)");
  return {json, buffer.bytes};
}

std::unique_ptr<Model> readOk(const FileBytes& file) {
  Result<std::unique_ptr<Model>> model = readModel(file);
  EXPECT_TRUE(model.ok()) << model.error().message;
  return model.ok() ? std::move(model).value() : nullptr;
}

std::vector<double> corner(const Mesh& mesh, std::size_t c) {
  const double* p = &mesh.positions[3 * std::size_t{mesh.faceVertices[c]}];
  return {p[0], p[1], p[2]};
}

TEST(SparseGltf, TakesValuesForListedElementsAndTheBaseForTheOthers) {
  const SparseGrid file = sparseGrid({4, 8}, {9, 8, 7, 6, 5, 4});
  const auto model = readOk(file.glb());
  ASSERT_NE(model, nullptr);
  const Mesh& mesh = model->mesh();
  EXPECT_EQ(mesh.vertexCount(), 11u);  // nine elements of the base and two values
  EXPECT_EQ(corner(mesh, 0), (std::vector<double>{0, 0, 0.125}));
  EXPECT_EQ(corner(mesh, 2), (std::vector<double>{9, 8, 7}));   // triangle 0 1 4
  EXPECT_EQ(corner(mesh, 20), (std::vector<double>{6, 5, 4}));  // triangle 4 5 8
  EXPECT_EQ(model->patch(file.glb(), {}, mesh.positions)->bytes, file.glb());

  // Patching: the value where there is one, else the base; what a value hides stays. Bounds follow.
  std::vector<double> positions = mesh.positions;
  for (const std::uint32_t v : mesh.faceVertices) positions[3 * std::size_t{v}] = 20 + v;
  const Result<PatchedFile> patched = model->patch(file.glb(), {}, positions);
  ASSERT_TRUE(patched.ok()) << patched.error().message;
  const auto again = readOk(patched->bytes);
  EXPECT_EQ(again->mesh().positions, positions);
  const std::string text = textOf(patched->bytes);
  EXPECT_NE(text.find("\"min\":[20, 0.0,-1.000],\"max\":[30,2e0 ,0.75]"), std::string::npos) << text.substr(0, 900);
  const std::size_t binBegin = patched->bytes.size() - file.bin.size();
  for (const std::size_t hidden : {4, 8}) {
    EXPECT_TRUE(std::equal(&file.bin[12 * hidden], &file.bin[12 * hidden] + 12, &patched->bytes[binBegin + 12 * hidden]));
  }
}

TEST(SparseGltf, TakesZeroForElementsThatAreStoredNowhereAndNeverMovesThem) {
  const SparseGrid file = sparseGrid({1, 3, 4, 5}, {1, 0, 0, 0, 1, 0, 1, 1, 1, 3, 1, 0}, false);
  const auto model = readOk(file.glb());
  ASSERT_NE(model, nullptr);
  Mesh& mesh = model->mesh();
  EXPECT_EQ(mesh.vertexCount(), 5u);  // four values, and one vertex for all that is zero
  EXPECT_EQ(corner(mesh, 0), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(corner(mesh, 1), (std::vector<double>{1, 0, 0}));
  EXPECT_EQ(corner(mesh, 20), (std::vector<double>{0, 0, 0}));
  std::vector<double> positions = mesh.positions;
  for (std::size_t i = 0; i < 12; ++i) positions[i] += 1;
  ASSERT_TRUE(model->patch(file.glb(), {}, positions).ok());
  EXPECT_EQ(readOk(model->patch(file.glb(), {}, positions)->bytes)->mesh().positions, positions);
  positions[12] = 1;
  const Result<PatchedFile> refused = model->patch(file.glb(), {}, positions);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::badOption);
  mesh.positions = positions;
  roundToPrecision(mesh);
  EXPECT_EQ(mesh.positions[12], 0);
}

TEST(SparseGltf, MovesElementsThatADenseAccessorSharesOnce) {
  // Mesh 1 draws the base without the sparse part.
  SparseGrid file = sparseGrid({4}, {1, 1, 3});
  file.json = replaced(file.json, R"(,"type":"SCALAR"})",
                       R"(,"type":"SCALAR"},{"bufferView":0,"componentType":5126,"count":9,"type":"VEC3"})");
  file.json = replaced(file.json, R"("meshes":[)", R"("meshes":[{"primitives":[{"attributes":{"POSITION":2},"indices":1}]},)");
  const auto model = readOk(file.glb());
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->mesh().vertexCount(), 10u);
  EXPECT_TRUE(model->mesh().groups.empty());  // they share an array, so they are one group
  EXPECT_TRUE(model->info().warnings.empty());
}

TEST(SparseGltf, RefusesContradictionsNamingThePlace) {
  const auto refused = [](const SparseGrid& file, const std::string& place) {
    const Result<std::unique_ptr<Model>> model = readModel(file.glb());
    ASSERT_FALSE(model.ok()) << place;
    EXPECT_EQ(model.error().code, ErrorCode::badFile) << model.error().message;
    EXPECT_NE(model.error().message.find(place), std::string::npos) << model.error().message;
  };
  const std::vector<double> values = {1, 2, 3, 4, 5, 6};
  refused(sparseGrid({4, 4}, values), "accessor 0 sparse.indices: 4 at position 1");
  refused(sparseGrid({5, 4}, values), "accessor 0 sparse.indices: 4 at position 1");
  refused(sparseGrid({4, 9}, values), "accessor 0 sparse.indices: 9 at position 1");
  const auto with = [&](const std::string& what, const std::string& by) {
    SparseGrid file = sparseGrid({4, 8}, values);
    EXPECT_NE(file.json.find(what), std::string::npos) << what;
    file.json = replaced(file.json, what, by);
    return file;
  };
  refused(with("\"sparse\":{\"count\":2", "\"sparse\":{\"count\":10"), "accessor 0 sparse.count is 10 for 9 elements");
  refused(with("\"sparse\":{\"count\":2", "\"sparse\":{\"count\":0"), "accessor 0 sparse.count is 0");
  refused(with("\"sparse\":{\"count\":2", "\"sparse\":{\"count\":3"), "accessor 0 sparse.values: byteOffset 0 with 3");
  refused(with("\"sparse\":{\"count\":2", "\"sparse\":{\"count\":5"), "accessor 0 sparse.indices: byteOffset 0 with 5");
  refused(with("\"sparse\":{\"count\":2,", "\"sparse\":{"), "accessor 0 sparse has no count");
  refused(with("\"values\":{\"bufferView\":3}", "\"values\":{\"bufferView\":4}"), "accessor 0 sparse refers to bufferView 4 of 4");
  refused(with("\"values\":{\"bufferView\":3}", "\"values\":3"), "accessor 0 sparse.values is not an object");
  refused(with("\"bufferView\":2,\"componentType\":5123", "\"bufferView\":2,\"componentType\":5122"), "not unsigned integers");
  refused(with("\"values\":{\"bufferView\":3}", "\"values\":{\"bufferView\":3,\"byteOffset\":4294967295}"), "sparse.values");
}

TEST(SparseGltf, RefusesToPatchPositionsThatShareBytesWithASparsePart) {
  SparseGrid file = sparseGrid({4, 8}, {9, 8, 7, 6, 5, 4});
  file.json = replaced(file.json, R"("values":{"bufferView":3})", R"("values":{"bufferView":0,"byteOffset":4})");
  const auto model = readOk(file.glb());
  ASSERT_NE(model, nullptr);
  const Result<PatchedFile> patched = model->patch(file.glb(), {}, model->mesh().positions);
  ASSERT_FALSE(patched.ok());
  EXPECT_EQ(patched.error().code, ErrorCode::unsupportedFile);
}

TEST(SparseGltf, CountsThatNothingBacksCostNothing) {
  for (const char* indexed : {"\"indices\":1,", ""}) {
    SparseGrid file = sparseGrid({1, 3, 4, 5}, {1, 0, 0, 0, 1, 0, 1, 1, 1, 3, 1, 0}, false);
    file.json = replaced(replaced(file.json, "\"count\":9", "\"count\":4000000000"), "\"indices\":1,", indexed);
#if QM_COUNT_ALLOCATIONS
    resetLargestAllocation();
#endif
    const FileBytes glb = file.glb();
    const Result<std::unique_ptr<Model>> model = readModel(glb);
    EXPECT_EQ(model.ok(), *indexed != '\0');
    if (!model.ok()) {
      EXPECT_EQ(model.error().code, ErrorCode::tooLarge) << model.error().message;
    }
#if QM_COUNT_ALLOCATIONS
    EXPECT_LT(largestAllocation(), 100000u);
#endif
  }
}

/// The grid whose triangle indices come from a sparse part where `listed` says so, and from the base, which is wrong
/// there, or zeros elsewhere.
FileBytes sparselyIndexed(const std::vector<int>& listed, bool base = true, const std::string& extra = "") {
  const GridGltf grid = gridGltf();
  BufferBuilder buffer{grid.bin};
  for (const int corner : listed) appendScalar(buffer.bytes, "uchar", corner, io::ByteOrder::little);
  buffer.bytes.resize(180, 0xee);
  for (const int corner : listed) {
    const int vertex = gridTriangles()[static_cast<std::size_t>(corner / 3)][static_cast<std::size_t>(corner % 3)];
    appendScalar(buffer.bytes, "ushort", vertex, io::ByteOrder::little);
    io::store(&buffer.bytes[108 + 2 * static_cast<std::size_t>(corner)], std::uint16_t{500});
  }
  std::string json = replaced(grid.json, "156", std::to_string(buffer.bytes.size()));
  json = replaced(json, R"("type":"SCALAR")",
                  R"("type":"SCALAR","sparse":{"count":)" + std::to_string(listed.size()) +
                      R"(,"indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":3)" + extra + "}}");
  json = replaced(json, R"("byteOffset":108,"byteLength":48})",
                  R"("byteOffset":108,"byteLength":48},{"buffer":0,"byteOffset":156,"byteLength":24},)"
                  R"({"buffer":0,"byteOffset":180,"byteLength":)" + std::to_string(2 * listed.size()) + "}");
  if (!base) json = replaced(json, R"({"bufferView":1,"componentType":5123)", R"({"componentType":5123)");
  return makeGlb(json, buffer.bytes);
}

TEST(SparseGltf, ReadsSparseIndices) {
  const auto plain = readOk(gridGltf().glb());
  const FileBytes file = sparselyIndexed({0, 7, 8, 23});
  const auto model = readOk(file);
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->mesh().positions, plain->mesh().positions);
  EXPECT_EQ(model->mesh().faceVertices, plain->mesh().faceVertices);

  // Marking does not touch them.
  const Result<PatchedFile> patched = model->patch(file, {}, movedGrid());
  ASSERT_TRUE(patched.ok()) << patched.error().message;
  EXPECT_EQ(readOk(patched->bytes)->mesh().positions, movedGrid());
  EXPECT_TRUE(std::equal(file.end() - 80, file.end(), patched->bytes.end() - 80));  // indices, base and sparse

  // Without a base all other corners are vertex 0.
  const auto few = readOk(sparselyIndexed({1, 2, 9, 11}, false));
  ASSERT_NE(few, nullptr);
  std::vector<std::uint32_t> corners(24);
  for (const std::size_t corner : {1, 2, 9, 11}) corners[corner] = plain->mesh().faceVertices[corner];
  EXPECT_EQ(few->mesh().faceVertices, corners);
}

TEST(SparseGltf, RefusesBrokenSparseIndicesNamingThePlace) {
  const auto message = [](const FileBytes& file) {
    const Result<std::unique_ptr<Model>> model = readModel(file);
    EXPECT_FALSE(model.ok());
    return model.ok() ? "" : model.error().message;
  };
  EXPECT_NE(message(sparselyIndexed({7, 0})).find("accessor 1 sparse.indices: 0 at position 1"), std::string::npos);
  EXPECT_NE(message(sparselyIndexed({0, 24 - 1}, true, ",\"byteOffset\":2")).find("accessor 1 sparse.values"),
            std::string::npos);
  GridGltf strided = gridGltf();
  strided.json = replaced(strided.json, R"("byteOffset":108,"byteLength":48})",
                          R"("byteOffset":108,"byteLength":48,"byteStride":4})");
  EXPECT_EQ(message(strided.glb()),
            "mesh 0 primitive 0 indices (accessor 1): bufferView 1 has a byteStride, which indices must not have");
  GridGltf nowhere = gridGltf();  // four thousand million zeros
  nowhere.json = replaced(replaced(nowhere.json, R"({"bufferView":1,)", "{"), "\"count\":24", "\"count\":4000000000");
  EXPECT_NE(message(nowhere.glb()).find("triangle corners"), std::string::npos);
}

TEST(QuantizedGltf, KeepsCodesThatMeanTheSameAndSpellsBoundsAsStored) {
  // Normalized bytes: -128 means -1, as -127 does.
  BufferBuilder buffer;
  for (const int code : {-128, -127, 0, 0, 127, -127, 0, 0, 127, 0, 0, 0}) appendScalar(buffer.bytes, "char", code, io::ByteOrder::little);
  const std::string json =
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":12}],"bufferViews":[{"buffer":0,"byteLength":12,"byteStride":4}],)"
      R"("accessors":[{"bufferView":0,"componentType":5120,"normalized":true,"count":3,"type":"VEC3",)"
      R"("min":[-128,-127,-0],"max":[127.0,0,127]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})";
  const FileBytes file = makeGlb(json, buffer.bytes);
  const auto model = readOk(file);
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->mesh().positions, (std::vector<double>{-1, -1, 0, 1, -1, 0, 1, 0, 0}));
  std::vector<double> positions = model->mesh().positions;
  positions[1] = -100 / 127.0;
  positions[4] = -101 / 127.0;
  positions[6] = 126 / 127.0;
  const Result<PatchedFile> patched = model->patch(file, {}, positions);
  ASSERT_TRUE(patched.ok()) << patched.error().message;
  FileBytes bin = buffer.bytes;
  bin[1] = static_cast<std::uint8_t>(-100), bin[5] = static_cast<std::uint8_t>(-101), bin[8] = 126;
  EXPECT_EQ(patched->bytes, makeGlb(replaced(json, "-128,-127,-0", "-128,-101,-0"), bin));
  positions[4] += 1e-9;
  EXPECT_EQ(model->patch(file, {}, positions).error().code, ErrorCode::badOption);
  positions[4] = 2;
  EXPECT_EQ(model->patch(file, {}, positions).error().code, ErrorCode::badOption);
}

}  // namespace
}  // namespace quadmark::test
