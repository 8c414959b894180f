// SPDX-License-Identifier: MIT
// Reading back on known ground: the same as reading anew, and given up where the ground has changed.
#include <gtest/gtest.h>

#include "fixtures.h"
#include "robust/ground.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/robust/reader.h"
#include "robust_geometry_keys.h"

namespace quadmark::robust {
namespace {

CodedPayload somePayload() {
  CodedPayload out;
  for (int i = 0; i < 276; ++i) {
    out.head.push_back(static_cast<std::uint8_t>(i * i % 7 % 2));
    out.headGenerator.push_back(static_cast<std::uint8_t>(i % 3));
  }
  return out;
}

TEST(RobustGround, GivesEveryHypothesisWhatReadingAnewDoes) {
  const CodedPayload payload = somePayload();
  for (const Mesh& mesh : {lab::sculpture(5000), lab::bumpyGrid(60, 60, 3), lab::machinedPart(4000)}) {
    RobustEmbedding marked = embedRobust(mesh, payload, keysOf(1)).value();
    Mesh copy = mesh;
    copy.positions = marked.positions;
    MeshReader anew(copy, keysOf(1), payload.headCode()), known(copy, keysOf(1), payload.headCode(), marked.ground);
    EXPECT_EQ(known.coverage().carriers, anew.coverage().carriers);
    EXPECT_EQ(known.coverage().ringPositions, anew.coverage().ringPositions);
    // Sharpened ones need the rings that marking gave back, mirrored ones everything anew.
    for (const Hypothesis& h : MeshReader::hypotheses({.trySplit = false})) {
      const SoftBits one = known.headBits(h), other = anew.headBits(h);
      EXPECT_EQ(one.single, other.single) << h.number;
      EXPECT_EQ(one.bitOf, other.bitOf) << h.number;
      EXPECT_EQ(one.score, other.score) << h.number;
    }
    EXPECT_EQ(known.evidence(payload, MeshReader::hypotheses({})[0]), anew.evidence(payload, MeshReader::hypotheses({})[0]));
  }
}

TEST(RobustGround, EndsWhereVerticesMeetOrTwinsPart) {
  const Mesh sphere = lab::icosphere(3);
  const auto stays = [](const Mesh& mesh, const Mesh& copy) { return moveTo(groundOf(mesh, keysOf(1))->surface, copy); };
  Mesh copy = sphere;
  for (double& x : copy.positions) x *= 2;
  EXPECT_TRUE(stays(sphere, copy));
  for (int k = 0; k < 3; ++k) copy.positions[3 * 5 + k] = copy.positions[3 * 9 + k];
  EXPECT_FALSE(stays(sphere, copy)) << "two vertices became one";
  // Parted by groups they are two wherever they lie.
  Mesh grouped = sphere;
  grouped.groups.assign(sphere.vertexCount(), 0);
  grouped.groups[5] = 1;
  copy.groups = grouped.groups;
  EXPECT_TRUE(stays(grouped, copy));

  Mesh seam = sphere;  // vertex 0 twice
  seam.positions.insert(seam.positions.end(), sphere.positions.begin(), sphere.positions.begin() + 3);
  for (std::uint32_t& v : seam.faceVertices)
    if (v == 0) {
      v = static_cast<std::uint32_t>(sphere.vertexCount());
      break;
    }
  copy = seam;
  EXPECT_TRUE(stays(seam, copy));
  copy.positions[0] += 1e-3;
  EXPECT_FALSE(stays(seam, copy)) << "one became two";
}

}  // namespace
}  // namespace quadmark::robust
