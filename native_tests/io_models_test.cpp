// SPDX-License-Identifier: MIT
// Real files: each reads as known or is refused by name, and a patch keeps everything else.
#include <gtest/gtest.h>

#include "io_fixtures.h"
#include "models.h"

namespace quadmark::test {
namespace {

struct Expected {
  const char* name;
  std::size_t vertices, faces;
  bool polygons = false;
  bool groups = false;
};

constexpr Expected kReadable[] = {
    {"bunny.ply", 35947, 69451},
    {"bunny.glb", 34834, 69451},
    {"fandisk.ply", 6475, 12946},
    {"fandisk.glb", 6475, 12946},
    {"rocker-arm.ply", 10044, 20088},
    {"rocker-arm.glb", 10044, 20088},
    {"nefertiti.ply", 49971, 99938},
    {"nefertiti.glb", 49971, 99938},
    {"ogre.ply", 62194, 124008},
    {"ogre.glb", 62194, 124008},
    {"beast-quads.ply", 32311, 32364, true},
    {"beast.glb", 32311, 64618},
    {"igea-tristrips.ply", 134345, 268686},
    {"Duck.glb", 2399, 4212},
    {"CesiumMan.glb", 3273, 4672},
    {"SheenCloth.glb", 58081, 115200},
    {"clothFolds.glb", 38809, 76832},
    {"shaderBall.glb", 3074, 3392},
    {"moltenDagger.glb", 1006, 1298, false, true},
    {"morphLoader.glb", 144, 48, false, true},
    {"riggedMesh.glb", 9748, 11034, false, true},
    {"Fox/Fox.gltf", 1728, 576},
    {"AnimatedMorphCube/AnimatedMorphCube.gltf", 24, 12},
    {"CubeScaledInstances/cube_att.gltf", 24, 12},
    {"SimpleSparseAccessor/SimpleSparseAccessor.gltf", 17, 12},  // 14 elements, of which 3 values replace 3
};

TEST(RealModels, ReadAsKnownAndKeepEverythingButPositions) {
  for (const Expected& expected : kReadable) {
    SCOPED_TRACE(expected.name);
    const std::optional<FileBytes> file = modelBytes(expected.name);
    if (!file) continue;
    const Result<std::vector<std::string>> uris = externalUris(*file);
    ASSERT_TRUE(uris.ok());
    const Resources resources = modelResources(expected.name, *uris);
    const Result<std::unique_ptr<Model>> read = readModel(*file, resources);
    ASSERT_TRUE(read.ok()) << read.error().message;
    const Model& model = **read;
    EXPECT_EQ(model.mesh().vertexCount(), expected.vertices);
    EXPECT_EQ(model.mesh().faceCount(), expected.faces);
    EXPECT_EQ(!model.mesh().faceOffsets.empty(), expected.polygons);
    EXPECT_EQ(!model.mesh().groups.empty(), expected.groups);
    EXPECT_TRUE(validate(model.mesh()).ok());
    EXPECT_TRUE(model.info().warnings.empty()) << model.info().warnings[0];

    const Result<PatchedFile> same = model.patch(*file, resources, model.mesh().positions);
    ASSERT_TRUE(same.ok()) << same.error().message;
    EXPECT_TRUE(same->bytes == *file);
    EXPECT_TRUE(same->resources.empty());
    EXPECT_EQ(same->bytesChanged, 0u);

    Mesh moved = model.mesh();
    const double step = 1e-3 * boundingDiagonal(moved);
    for (std::size_t i = 0; i < moved.positions.size(); i += 7) moved.positions[i] += step;
    roundToPrecision(moved);
    const Result<PatchedFile> patched = model.patch(*file, resources, moved.positions);
    ASSERT_TRUE(patched.ok()) << patched.error().message;
    EXPECT_GT(patched->bytesChanged, 0u);
    Resources changed = resources;
    for (const auto& [uri, bytes] : patched->resources) changed[uri] = bytes;
    const Result<std::unique_ptr<Model>> again = readModel(patched->bytes, changed);
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_TRUE((*again)->mesh().positions == moved.positions);
    EXPECT_TRUE((*again)->mesh().faceVertices == moved.faceVertices);

    // Patching back to the first positions restores a binary PLY and the buffers of a glTF bit for bit.
    const Result<PatchedFile> back = (*again)->patch(patched->bytes, changed, model.mesh().positions);
    ASSERT_TRUE(back.ok()) << back.error().message;
    if (model.info().format == FileFormat::ply && model.info().variant[0] == 'b') {
      EXPECT_TRUE(back->bytes == *file);
    }
    for (const auto& [uri, bytes] : back->resources) EXPECT_TRUE(bytes == resources.at(uri)) << uri;
  }
}

}  // namespace
}  // namespace quadmark::test
