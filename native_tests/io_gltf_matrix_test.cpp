// SPDX-License-Identifier: MIT
// Positions of every kind, in every arrangement: what is written is what was meant, to the byte.
#include <array>
#include <cstdlib>
#include <fstream>
#include <set>

#include "fixtures.h"
#include "io/data_uri.h"
#include "io/gltf_container.h"
#include "io_gltf_matrix.h"
#include "json_text.h"

namespace quadmark::test {
namespace {

std::string nameOf(const MatrixSpec& s) {
  const char* sparse[] = {"", " sparse", " sparse without base"};
  const char* buffers[] = {"bin", "external", "data", "several"};
  const char* compressions[] = {"", ", meshopt", ", meshopt with fallback", ", Draco"};
  return s.component + (s.normalized ? " normalized" : "") + (s.interleaved ? " interleaved" : "") +
         sparse[static_cast<int>(s.sparse)] + " by " + s.sparseIndex + ", indices " + (s.index.empty() ? "none" : s.index) +
         ", mode " + std::to_string(s.mode) + ", " + std::to_string(s.primitives) + " primitives" +
         (s.twoMeshes ? " in two meshes" : "") + (s.sharedAccessor ? " of one accessor" : "") + ", " +
         buffers[static_cast<int>(s.buffers)] + compressions[static_cast<int>(s.compression)];
}

/// The same types and views behind every compression, with the indices that it has; the other features take turns.
void addCompressed(std::vector<MatrixSpec>& specs) {
  const std::size_t plain = specs.size();
  for (const Compression compression : {Compression::meshopt, Compression::meshoptFallback, Compression::draco}) {
    if (compression == Compression::draco && !kCanEncodeDraco) continue;
    for (std::size_t i = 0; i < plain; ++i) {
      MatrixSpec spec = specs[i];
      const bool isDraco = compression == Compression::draco;
      if (isDraco && (spec.interleaved || spec.sparse != SparseUse::none || spec.index.empty())) continue;
      if (!isDraco && (spec.sparse == SparseUse::alone || i % 2 == (compression == Compression::meshopt ? 0 : 1))) continue;
      spec.compression = compression;
      if (isDraco) {
        spec.mode = 4;
        spec.sharedAccessor = false;
      }
      specs.push_back(spec);
    }
  }
}

/// Every type with every kind of view, sparse part and index; the other features take turns.
std::vector<MatrixSpec> matrix() {
  std::vector<MatrixSpec> specs;
  for (const auto& [component, normalized] :
       {std::pair{"float", false}, {"char", false}, {"char", true}, {"uchar", false}, {"uchar", true}, {"short", false},
        {"short", true}, {"ushort", false}, {"ushort", true}}) {
    for (const bool interleaved : {false, true}) {
      for (const SparseUse sparse : {SparseUse::none, SparseUse::overBase, SparseUse::alone}) {
        for (const char* index : {"", "uchar", "ushort", "uint"}) {
          const std::size_t turn = specs.size();
          MatrixSpec spec;
          spec.component = component;
          spec.normalized = normalized;
          spec.interleaved = interleaved;
          spec.sparse = sparse;
          spec.index = index;
          const bool byteIndices = spec.index == "uchar";
          spec.sparseIndex = byteIndices ? "uchar" : turn % 2 == 0 ? "ushort" : "uint";
          spec.mode = 4 + static_cast<int>(turn / 4 % 3);
          spec.primitives = byteIndices ? 6 : 1 + static_cast<std::uint32_t>(turn / 3 % 3);
          spec.sharedAccessor = !byteIndices && !spec.index.empty() && turn % 5 == 0;
          spec.twoMeshes = spec.primitives > 1 && turn / 2 % 3 == 0 && !spec.sharedAccessor;
          spec.buffers = static_cast<BufferUse>(turn / 5 % 4);
          specs.push_back(spec);
        }
      }
    }
  }
  addCompressed(specs);
  return specs;
}

Mesh codesOf(const std::vector<MatrixSpec>& specs, std::size_t i) {
  return asCodes(i % 2 == 0 ? lab::seamed(4) : lab::bumpyGrid(28, 28, 3), specs[i]);
}

Resources merged(Resources before, const Resources& changed) {
  for (const auto& [uri, bytes] : changed) before[uri] = bytes;
  return before;
}

/// The file that a writer of the new positions would have made: nothing else in it may differ.
MatrixFile expected(const MatrixSpec& spec, const Mesh& codes, const Mesh& before, const Mesh& after,
                    const std::vector<std::uint32_t>& vertexMesh) {
  const std::optional<CoordinateGrid> grid = matrixGrid(spec);
  const double divisor = grid ? grid->divisor : 1;
  std::map<std::array<double, 3>, std::array<double, 3>> movedTo[2];
  std::vector<bool> used(before.vertexCount());
  for (const std::uint32_t v : before.faceVertices) used[v] = true;
  for (std::size_t v = 0; v < before.vertexCount(); ++v) {
    if (!used[v]) continue;
    std::array<double, 3> from, to;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      from[axis] = std::floor(before.positions[3 * v + axis] * divisor + 0.5);
      to[axis] = std::floor(after.positions[3 * v + axis] * divisor + 0.5);
      if (!grid) from[axis] = before.positions[3 * v + axis], to[axis] = after.positions[3 * v + axis];
    }
    const auto [entry, isNew] = movedTo[vertexMesh[v]].emplace(from, to);
    EXPECT_TRUE(isNew || entry->second == to) << "twins of vertex " << v << " parted";
  }
  Mesh moved[2] = {codes, codes};
  for (int which : {0, 1}) {
    for (std::size_t v = 0; v < codes.vertexCount(); ++v) {
      double* position = &moved[which].positions[3 * v];
      const auto found = movedTo[which].find({position[0], position[1], position[2]});
      if (found != movedTo[which].end()) std::copy(found->second.begin(), found->second.end(), position);
    }
  }
  return MatrixWriter(spec, moved[0], moved[1]).write();
}

std::vector<std::string> elementsOf(JsonValue array) {
  std::vector<std::string> out;
  array.forEachElement([&](JsonValue element) { out.emplace_back(element.text()); });
  return out;
}

FileBytes bufferBytes(JsonValue buffer, const io::GltfContainer& container, const FileBytes& file,
                      const Resources& resources) {
  const std::string uri = buffer.find("uri").asString();
  if (uri.empty()) return FileBytes(container.bin(file).begin(), container.bin(file).end());
  if (uri.substr(0, 5) == "data:") return io::decodeDataUri(uri, "buffer").value();
  return resources.at(replaced(uri, "%20", " "));
}

/// Of a file with compressed views: each one that lost its compression holds what was meant, the others are as before,
/// and accessors, meshes and nodes are spelled as in the file that was meant. All bytes that were there still are.
void expectDecompressed(const MatrixFile& before, const FileBytes& file, const Resources& resources,
                        const MatrixFile& meant, bool isSparse) {
  const auto container = io::openGltf(file), old = io::openGltf(before.file), wanted = io::openGltf(meant.file);
  const JsonValue json = parseJson(container->json(file)).value(), was = parseJson(old->json(before.file)).value(),
                  goal = parseJson(wanted->json(meant.file)).value();
  for (const char* part : {"accessors", "meshes", "nodes", "extras"})
    EXPECT_EQ(json.find(part).text(), goal.find(part).text());
  std::vector<FileBytes> buffers;
  json.find("buffers").forEachElement([&](JsonValue buffer) {
    const bool isPlaceholder = buffer.find("extensions").isObject();
    buffers.push_back(isPlaceholder ? FileBytes{} : bufferBytes(buffer, *container, file, resources));
  });
  const std::vector<std::string> oldViews = elementsOf(was.find("bufferViews"));
  std::size_t index = 0, plain = 0;
  json.find("bufferViews").forEachElement([&](JsonValue view) {
    const std::size_t i = index++;
    if (view.find("extensions")) {
      EXPECT_EQ(view.text(), oldViews[i]);
      return;
    }
    const auto field = [&](const char* name) { return static_cast<std::size_t>(*view.find(name).asUnsigned()); };
    const FileBytes& buffer = buffers[field("buffer")];
    const std::size_t begin = field("byteOffset"), length = field("byteLength");
    ASSERT_LE(begin + length, buffer.size());
    EXPECT_TRUE(std::equal(meant.views[i].begin(), meant.views[i].end(), buffer.begin() + static_cast<std::ptrdiff_t>(begin),
                           buffer.begin() + static_cast<std::ptrdiff_t>(begin + length)));
    ++plain;
  });
  EXPECT_EQ(index, oldViews.size());
  EXPECT_GT(plain, 0u);
  // Sparse values of integers are not compressed, and marked in their places.
  if (!old->hasBin || isSparse) return;
  EXPECT_TRUE(std::equal(old->bin(before.file).begin(), old->bin(before.file).end(), container->bin(file).begin()));
}

TEST(GltfMatrix, MarksReadBackAndNothingElseChanges) {
  const Key key = idKey();
  const std::vector<MatrixSpec> specs = matrix();
  ASSERT_GE(specs.size(), 200u);
  const std::size_t step = specs.size() / static_cast<std::size_t>(repetitions(static_cast<int>(specs.size())));
  int written = 0, refused = 0;
  for (std::size_t i = 0; i < specs.size(); i += step) {
    const MatrixSpec& spec = specs[i];
    SCOPED_TRACE(std::to_string(i) + ": " + nameOf(spec));
    const Mesh codes = codesOf(specs, i);
    const MatrixFile file = MatrixWriter(spec, codes, codes).write();

    // 1. What is read is what was stored.
    const auto model = readModel(file.file, file.resources);
    ASSERT_TRUE(model.ok()) << model.error().message;
    const Mesh& before = (*model)->mesh();
    ASSERT_TRUE(validate(before).ok());
    const std::optional<CoordinateGrid> grid = matrixGrid(spec);
    std::set<std::array<double, 3>> stored, read;
    for (const std::uint32_t v : codes.faceVertices)
      stored.insert({codes.positions[3 * v], codes.positions[3 * v + 1], codes.positions[3 * v + 2]});
    const double divisor = grid ? grid->divisor : 1;
    for (const std::uint32_t v : before.faceVertices) {
      std::array<double, 3> p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = before.positions[3 * v + axis];
        p[axis] = grid ? std::floor(x * divisor + 0.5) : x;
        ASSERT_EQ(p[axis] / divisor, x);
      }
      read.insert(p);
    }
    EXPECT_EQ(read, stored);

    // 2. A mark, or where eight bits are too few any other movement.
    EmbedRequest request;
    request.key = key;
    request.id = 0x0123456789abcdef;
    auto marked = embed(file.file, file.resources, request);
    PatchedFile out;
    if (marked.ok()) {
      ++written;
      out = std::move(marked->file);
    } else {
      ++refused;
      EXPECT_EQ(marked.error().code, ErrorCode::capacity) << marked.error().message;
      EXPECT_TRUE(spec.component == "char" || spec.component == "uchar") << marked.error().message;
      Mesh moved = before;
      const std::set<std::uint32_t> used(before.faceVertices.begin(), before.faceVertices.end());
      for (const std::uint32_t v : used)
        for (std::size_t k = 3 * std::size_t{v}; k < 3 * std::size_t{v} + 3; ++k)
          moved.positions[k] += (moved.positions[k] * divisor > 20 ? -3 : 2) / divisor;
      roundToPrecision(moved);
      auto patched = (*model)->patch(file.file, file.resources, moved.positions);
      ASSERT_TRUE(patched.ok()) << patched.error().message;
      out = std::move(*patched);
    }
    EXPECT_GT(out.bytesChanged, 0u);

    // 3. The output.
    const Resources resources = merged(file.resources, out.resources);
    const auto again = readModel(out.bytes, resources);
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_EQ((*again)->mesh().faceVertices, before.faceVertices);
    EXPECT_EQ((*again)->mesh().gridOf, before.gridOf);
    MatrixSpec plainSpec = spec;
    plainSpec.compression = Compression::none;
    const MatrixFile meant = expected(plainSpec, codes, before, (*again)->mesh(), (*model)->vertexMesh());
    if (spec.compression == Compression::none) {
      EXPECT_TRUE(out.bytes == meant.file);
      EXPECT_TRUE(resources == meant.resources);
    } else if (spec.usesMeshopt()) {
      expectDecompressed(file, out.bytes, resources, meant, spec.sparse != SparseUse::none);
    } else {
      EXPECT_EQ(textOf(out.bytes).find("draco"), std::string::npos);
    }
    if (!marked.ok()) continue;
    EXPECT_EQ(weld((*again)->mesh()).weldedOf, weld(before).weldedOf);
    const auto extracted = extract(out.bytes, resources, {key, std::nullopt, {}});
    ASSERT_TRUE(extracted.ok()) << extracted.error().message;
    EXPECT_EQ(extracted->verdict, "match");
    EXPECT_EQ(extracted->id, request.id);
  }
  EXPECT_GT(written, 2 * refused / 3);
}

/// For programs that look at them with eyes that are not ours (js_tests/gltf_matrix.test.mjs): every file, by its number,
/// with the buffers that it refers to behind the number.
TEST(GltfMatrix, IsWrittenForOthersWhereAsked) {
  const char* folder = std::getenv("QUADMARK_MATRIX_FOLDER");
  if (folder == nullptr || *folder == '\0') GTEST_SKIP() << "set QUADMARK_MATRIX_FOLDER to an existing folder";
  const std::vector<MatrixSpec> specs = matrix();
  const auto write = [&](const std::string& name, const FileBytes& bytes) {
    std::ofstream stream(std::string(folder) + "/" + name, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    ASSERT_TRUE(stream.good()) << name;
  };
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const Mesh codes = codesOf(specs, i);
    const MatrixFile file = MatrixWriter(specs[i], codes, codes).write();
    write(std::to_string(i) + ".model", file.file);
    for (const auto& [uri, bytes] : file.resources) write(std::to_string(i) + "." + uri, bytes);
    write(std::to_string(i) + ".txt", bytesOf(nameOf(specs[i])));
  }
}

}  // namespace
}  // namespace quadmark::test
