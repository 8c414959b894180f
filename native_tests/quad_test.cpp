// SPDX-License-Identifier: MIT
#include "quadmark/quad.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fixtures.h"
#include "quadmark/random.h"

namespace quadmark {
namespace {

using Points = std::array<double, 12>;
constexpr std::uint32_t kIds[4] = {0, 1, 2, 3};

bool quadOf(const Points& p, Quad& out, double minTriangle = kMinTriangleWriting) {
  return makeQuad(kIds, p.data(), minTriangle, out);
}

double distance(const double* p, const double* q) {
  return std::sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
}

// Diagonals a-c along x and b-d along y that cross in the origin at ratios r and s, lengths 4 and 2.
Points crossAt(double r, double s, double lift = 0) {
  return {-4 * r, 0, 0, 0, -2 * s, lift, 4 * (1 - r), 0, 0, 0, 2 * (1 - s), lift};
}

Points randomQuad(Random& random) {
  Points p = crossAt(random.uniform(0.1, 0.45), random.uniform(0.1, 0.45));
  const double m[9] = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2),
                       random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2),
                       random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
  Points out;
  for (int v = 0; v < 4; ++v)
    for (int row = 0; row < 3; ++row)
      out[3 * v + row] = m[3 * row] * p[3 * v] + m[3 * row + 1] * p[3 * v + 1] + m[3 * row + 2] * p[3 * v + 2] + row;
  return out;
}

TEST(MakeQuad, FindsDiagonalsAndRatiosOfAKnownQuadrilateral) {
  Quad q;
  ASSERT_TRUE(quadOf(crossAt(0.25, 0.375), q));
  // Exact: all coordinates are multiples of 1/4.
  const bool acFirst = q.lengthAC == 4;
  EXPECT_EQ(acFirst ? q.ratioAC : q.ratioBD, 0.25);
  EXPECT_EQ(acFirst ? q.ratioBD : q.ratioAC, 0.375);
  EXPECT_EQ(acFirst ? q.lengthBD : q.lengthAC, 2);
  EXPECT_EQ(acFirst ? q.a : q.b, 0u);
  EXPECT_EQ(acFirst ? q.c : q.d, 2u);
  EXPECT_EQ(acFirst ? q.b : q.a, 1u);
  EXPECT_EQ(acFirst ? q.d : q.c, 3u);
  EXPECT_EQ(q.gap, 0);
  EXPECT_EQ(q.longerDiagonal(), 4);
  EXPECT_EQ(q.diagonalSum(), 6);
}

TEST(MakeQuad, MeasuresFromTheNearerEnd) {
  Quad q;
  ASSERT_TRUE(quadOf(crossAt(0.75, 0.625), q));
  const bool acFirst = q.lengthAC == 4;
  EXPECT_EQ(acFirst ? q.ratioAC : q.ratioBD, 0.25);
  EXPECT_EQ(acFirst ? q.ratioBD : q.ratioAC, 0.375);
  EXPECT_EQ(acFirst ? q.a : q.b, 2u);  // the near end is now the other one
}

TEST(MakeQuad, MeasuresTheDistanceBetweenTheDiagonals) {
  Quad q;
  ASSERT_TRUE(quadOf(crossAt(0.25, 0.375, 0.0625), q));
  EXPECT_EQ(q.gap, 0.0625);
  EXPECT_EQ(std::min(q.ratioAC, q.ratioBD), 0.25);
}

TEST(MakeQuad, GivesTheSameBitsForAll24Orders) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    Points p = randomQuad(random);
    for (double& x : p) x += random.uniform(-1e-4, 1e-4);  // not quite coplanar, as real sets are
    Quad reference;
    if (!quadOf(p, reference)) continue;
    std::array<std::uint32_t, 4> order = {0, 1, 2, 3};
    int orders = 0;
    do {
      Quad q;
      ASSERT_TRUE(makeQuad(order.data(), p.data(), kMinTriangleWriting, q));
      EXPECT_EQ(q.a, reference.a);
      EXPECT_EQ(q.b, reference.b);
      EXPECT_EQ(q.c, reference.c);
      EXPECT_EQ(q.d, reference.d);
      EXPECT_EQ(q.ratioAC, reference.ratioAC);
      EXPECT_EQ(q.ratioBD, reference.ratioBD);
      EXPECT_EQ(q.gap, reference.gap);
      EXPECT_EQ(q.lengthAC, reference.lengthAC);
      EXPECT_EQ(q.lengthBD, reference.lengthBD);
      ++orders;
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(orders, 24);
  }
}

TEST(MakeQuad, DoesNotChangeItsRatiosUnderAffineMaps) {
  Random random(2);
  int compared = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const double r = random.uniform(0.05, 0.49), s = random.uniform(0.05, 0.49);
    const Points p = crossAt(r, s);
    Points image;
    double m[12];
    for (double& x : m) x = random.uniform(-2, 2);
    for (int v = 0; v < 4; ++v)
      for (int row = 0; row < 3; ++row)
        image[3 * v + row] =
            m[4 * row] * p[3 * v] + m[4 * row + 1] * p[3 * v + 1] + m[4 * row + 2] * p[3 * v + 2] + m[4 * row + 3];
    Quad q;
    if (!quadOf(image, q, kMinTriangleReading)) continue;  // squashed into a line
    ++compared;
    EXPECT_NEAR(std::min(q.ratioAC, q.ratioBD), std::min(r, s), 1e-9);
    EXPECT_NEAR(std::max(q.ratioAC, q.ratioBD), std::max(r, s), 1e-9);
    EXPECT_LT(q.gap, 1e-12);
  }
  EXPECT_GT(compared, 400);
}

TEST(MakeQuad, RefusesWhatIsNotConvex) {
  Quad q;
  // One point inside the triangle of the others, in each of the four places.
  for (int inner = 0; inner < 4; ++inner) {
    Points p{};
    const double triangle[3][2] = {{0, 0}, {4, 0}, {0, 4}};
    for (int v = 0, corner = 0; v < 4; ++v) {
      p[3 * v] = v == inner ? 1 : triangle[corner][0];
      p[3 * v + 1] = v == inner ? 1 : triangle[corner][1];
      if (v != inner) ++corner;
    }
    EXPECT_FALSE(quadOf(p, q)) << inner;
  }
  EXPECT_FALSE(quadOf(crossAt(0.0005, 0.3), q));  // the crossing all but coincides with an end
}

TEST(MakeQuad, RefusesDegeneratePoints) {
  Quad q;
  EXPECT_FALSE(quadOf(Points{}, q));                                         // one point four times
  EXPECT_FALSE(quadOf({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}, q));             // a line
  EXPECT_FALSE(quadOf({0, 0, 0, 0, 0, 0, 2, 0, 0, 1, 1, 0}, q));             // a twin
  EXPECT_FALSE(quadOf({0, 0, 0, 1, 0, 0, 2, 1e-4, 0, 1, 1, 0}, q));          // three nearly collinear
  // The reader accepts triangles a hundred times thinner than the writer does.
  const Points thin = {0, 0, 0, 10, -0.005, 0, 20, 0, 0, 10, 8, 0};
  EXPECT_FALSE(quadOf(thin, q, kMinTriangleWriting));
  const Points lessThin = {0, 0, 0, 10, -0.03, 0, 20, 0, 0, 10, 8, 0};
  EXPECT_FALSE(quadOf(lessThin, q, kMinTriangleWriting));
  EXPECT_TRUE(quadOf(lessThin, q, kMinTriangleReading));
}

TEST(MakeQuad, FindsAGapBelowTheDistanceFromThePlaneOfThreePoints) {  // in sets that are not sharply folded
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    Points p = randomQuad(random);
    for (double& x : p) x += random.uniform(-0.05, 0.05);
    Quad q;
    if (!quadOf(p, q)) continue;
    const auto at = [&](int v, int k) { return p[3 * v + k]; };
    for (int x = 0; x < 4; ++x) {
      const int i = (x + 1) % 4, j = (x + 2) % 4, k = (x + 3) % 4;
      double u[3], w[3], t[3];
      for (int c = 0; c < 3; ++c) u[c] = at(j, c) - at(i, c), w[c] = at(k, c) - at(i, c), t[c] = at(x, c) - at(i, c);
      const double n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
      const double h = std::fabs(n[0] * t[0] + n[1] * t[1] + n[2] * t[2]) /
                       std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      EXPECT_LE(q.gap, h * (1 + 1e-9) + 1e-15);
    }
  }
}

TEST(WriteRatios, MovesTheNearEndsAsEquationsThreeAndFourSay) {
  // a = (-1, 0), c = (3, 0), o = origin, r = 1/4. Eq. (3): a' = (o - r' c) / (1 - r') = (-3 r' / (1 - r'), 0).
  Points p = crossAt(0.25, 0.375);
  Quad q;
  ASSERT_TRUE(quadOf(p, q));
  const bool acFirst = q.lengthAC == 4;
  const double wanted = 0.4;
  writeRatios(q, acFirst ? wanted : q.ratioAC, acFirst ? q.ratioBD : wanted, p.data());
  EXPECT_NEAR(p[0], -3 * wanted / (1 - wanted), 1e-15);
  // Eq. (4): |a a'| = |r - r'| / (1 - r') * |ac|.
  EXPECT_NEAR(std::fabs(p[0] + 1), (wanted - 0.25) / (1 - wanted) * 4, 1e-15);
  EXPECT_EQ(p[1], 0);
  const Points before = crossAt(0.25, 0.375);
  for (int i = 3; i < 12; ++i) EXPECT_NEAR(p[i], before[i], 1e-15) << i;
}

TEST(WriteRatios, ChangesOneRatioWithoutDisturbingTheOther) {
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    Points p = randomQuad(random);
    for (double& x : p) x += random.uniform(-1e-4, 1e-4);
    Quad q;
    if (!quadOf(p, q)) continue;
    const Points before = p;
    const double r = random.uniform(0.05, 0.45), s = random.uniform(0.05, 0.45);
    writeRatios(q, r, s, p.data());
    Quad after;
    ASSERT_TRUE(quadOf(p, after, kMinTriangleReading));
    EXPECT_NEAR(std::min(after.ratioAC, after.ratioBD), std::min(r, s), 1e-9);
    EXPECT_NEAR(std::max(after.ratioAC, after.ratioBD), std::max(r, s), 1e-9);
    EXPECT_LT(after.gap, 1e-12 * after.longerDiagonal());  // and is exactly flat afterwards
    for (std::uint32_t far : {q.c, q.d})
      for (int k = 0; k < 3; ++k) EXPECT_EQ(p[3 * far + k], before[3 * far + k]);
    // Writing the ratios it has moves nothing beyond the flattening of half the gap.
    Points same = before;
    writeRatios(q, q.ratioAC, q.ratioBD, same.data());
    EXPECT_LE(distance(&same[3 * q.a], &before[3 * q.a]), q.gap);
    EXPECT_LE(distance(&same[3 * q.b], &before[3 * q.b]), q.gap);
  }
}

}  // namespace
}  // namespace quadmark
