// SPDX-License-Identifier: MIT
// Positions of every kind, in every arrangement: what is written is what was meant, to the byte.
#include <array>
#include <set>

#include "fixtures.h"
#include "io_gltf_matrix.h"

namespace quadmark::test {
namespace {

std::string nameOf(const MatrixSpec& s) {
  const char* sparse[] = {"", " sparse", " sparse without base"};
  const char* buffers[] = {"bin", "external", "data", "several"};
  return s.component + (s.normalized ? " normalized" : "") + (s.interleaved ? " interleaved" : "") +
         sparse[static_cast<int>(s.sparse)] + " by " + s.sparseIndex + ", indices " + (s.index.empty() ? "none" : s.index) +
         ", mode " + std::to_string(s.mode) + ", " + std::to_string(s.primitives) + " primitives" +
         (s.twoMeshes ? " in two meshes" : "") + (s.sharedAccessor ? " of one accessor" : "") + ", " +
         buffers[static_cast<int>(s.buffers)];
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
  return specs;
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

TEST(GltfMatrix, MarksReadBackAndNothingElseChanges) {
  const Key key = idKey();
  const std::vector<MatrixSpec> specs = matrix();
  ASSERT_GE(specs.size(), 200u);
  const std::size_t step = specs.size() / static_cast<std::size_t>(repetitions(static_cast<int>(specs.size())));
  int written = 0, refused = 0;
  for (std::size_t i = 0; i < specs.size(); i += step) {
    const MatrixSpec& spec = specs[i];
    SCOPED_TRACE(std::to_string(i) + ": " + nameOf(spec));
    const Mesh codes = asCodes(i % 2 == 0 ? lab::seamed(4) : lab::bumpyGrid(28, 28, 3), spec);
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
    const MatrixFile meant = expected(spec, codes, before, (*again)->mesh(), (*model)->vertexMesh());
    EXPECT_TRUE(out.bytes == meant.file);
    EXPECT_TRUE(resources == meant.resources);
    if (!marked.ok()) continue;
    EXPECT_EQ(weld((*again)->mesh()).weldedOf, weld(before).weldedOf);
    const auto extracted = extract(out.bytes, resources, {key, std::nullopt, {}});
    ASSERT_TRUE(extracted.ok()) << extracted.error().message;
    EXPECT_EQ(extracted->verdict, "match");
    EXPECT_EQ(extracted->id, request.id);
  }
  EXPECT_GT(written, 2 * refused / 3);
}

}  // namespace
}  // namespace quadmark::test
