// SPDX-License-Identifier: MIT
// Attacks on real models: scans with loose vertices, borders, seams, several meshes.
#include <gtest/gtest.h>

#include <cctype>
#include <set>
#include <string>

#include "mesh_checks.h"
#include "models.h"
#include "quadmark/adjacency.h"
#include "quadmark/io/model.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/metrics.h"

namespace quadmark {
namespace {

using namespace lab;
using namespace testing;

class RealModel : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::optional<test::FileBytes> bytes = test::modelBytes(GetParam());
    if (!bytes) GTEST_SKIP() << GetParam() << " is absent";
    Result<std::unique_ptr<Model>> model = readModel(*bytes);
    ASSERT_TRUE(model.ok()) << model.error().message;
    mesh_ = (*model)->mesh();
  }
  Mesh mesh_;
};

TEST_P(RealModel, SurvivesEveryAttackAsAValidMesh) {
  const AttackSpec specs[] = {{"affine", 0, "CB"},   {"reorder"},      {"crop", 0.5},          {"noise", 1e-3},
                              {"local-noise", 1e-3}, {"quantize", 11}, {"smooth", 0.5, "", 3}, {"deform", 0.7}};
  const std::size_t welded = weld(mesh_).vertexCount();
  for (const AttackSpec& spec : specs) {
    SCOPED_TRACE(spec.kind);
    const Result<Mesh> attacked = attack(mesh_, spec);
    ASSERT_TRUE(attacked.ok()) << attacked.error().message;
    EXPECT_TRUE(validate(*attacked).ok());
    const std::size_t after = weld(*attacked).vertexCount();
    EXPECT_LE(after, welded);  // twins never part; rounding may bring others together
    if (spec.kind == "reorder") {
      EXPECT_EQ(after, welded);
    }
  }
}

TEST_P(RealModel, CanBeSimplified) {
  const auto welded = static_cast<double>(weld(mesh_).vertexCount());
  const Mesh meshopt = simplifyMeshopt(mesh_, 0.7), qem = simplifyQem(mesh_, 0.7);
  EXPECT_NEAR(static_cast<double>(qem.vertexCount()), 0.7 * welded, 0.005 * welded);
  const std::size_t fanned = mesh_.faceVertices.size() - 2 * mesh_.faceCount();
  EXPECT_NEAR(static_cast<double>(meshopt.faceCount()), 0.7 * static_cast<double>(fanned),
              0.02 * static_cast<double>(fanned));
  for (const Mesh* simple : {&meshopt, &qem}) {
    EXPECT_TRUE(validate(*simple).ok());
    EXPECT_LT(hausdorff(mesh_, *simple, 1), 0.005 * boundingDiagonal(mesh_));
  }
  std::set<Position> old;
  for (std::size_t v = 0; v < mesh_.vertexCount(); ++v) old.insert(positionOf(mesh_, v));
  for (std::size_t v = 0; v < meshopt.vertexCount(); ++v) ASSERT_EQ(old.count(positionOf(meshopt, v)), 1u);
}

INSTANTIATE_TEST_SUITE_P(Models, RealModel,
                         ::testing::Values("bunny.ply", "fandisk.ply", "igea-tristrips.ply", "beast-quads.ply",
                                           "Duck.glb", "CesiumMan.glb", "clothFolds.glb"),
                         [](const ::testing::TestParamInfo<const char*>& model) {
                           std::string name = model.param;
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

}  // namespace
}  // namespace quadmark
