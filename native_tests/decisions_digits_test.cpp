// SPDX-License-Identifier: MIT
// The decisions that the paper leaves open, ratios, digits and capacity: D10 to D18.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures.h"

namespace quadmark {
namespace {

using namespace test;

const Key kKey = testKey(8, 8);
const std::vector<std::uint8_t> kBits = logo(8, 8).bits;

// Cells that voted with nearly full weight, as read from a mesh.
std::vector<CellReading> votingCells(const Mesh& mesh, const Key& key) {
  ExtractOptions options;
  options.keepReadings = true;
  std::vector<CellReading> out;
  for (const CellReading& r : readMark(mesh, key, options).readings)
    if (r.weight > 0 && r.purity > 0.5) out.push_back(r);
  return out;
}

TEST(Decisions, D10WritesTheCentreOfTheDigitCell) {
  const DigitSlot slot(2, 4);
  EXPECT_DOUBLE_EQ(slot.centre(2, 137), 0.21375);
  EXPECT_DOUBLE_EQ(slot.centre(0, 0), 0.00005);
  const std::vector<CellReading> cells = votingCells(marked(lab::sculpture(3000), kKey, kBits), kKey);
  ASSERT_GT(cells.size(), 300u);
  double sum = 0;
  for (const CellReading& c : cells) sum += std::max(std::fabs(c.reading.residue1), std::fabs(c.reading.residue2));
  EXPECT_LT(sum / static_cast<double>(cells.size()), 0.02);  // of a digit, after rounding to float32
}

TEST(Decisions, D11KeepsIndexAndPieceTellableApartBySize) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    SCOPED_TRACE(name);
    const Mesh output = marked(mesh, kKey, kBits);
    const WeldedMesh welded = weld(output);
    const PairCodec codec(kKey.params, 11);
    for (const CellReading& c : votingCells(output, kKey)) {
      Quad q;
      ASSERT_TRUE(makeQuad(c.vertices, welded.positions.data(), kMinTriangleReading, q));
      const double gap = std::fabs(q.ratioAC - q.ratioBD);
      EXPECT_GT(gap, 1.5 * codec.pieceSlot().cellWidth());  // two digits less a rounding
    }
  }
}

TEST(Decisions, D12StaysAwayFromOneHalf) {
  EXPECT_DOUBLE_EQ(DigitSlot(2, 3).maxRatio(), 0.475);
  EXPECT_DOUBLE_EQ(DigitSlot(3, 5).maxRatio(), 0.4975);
  const Mesh output = marked(lab::sculpture(3000), kKey, kBits);
  const WeldedMesh welded = weld(output);
  for (const CellReading& c : votingCells(output, kKey)) {
    Quad q;
    ASSERT_TRUE(makeQuad(c.vertices, welded.positions.data(), kMinTriangleReading, q));
    EXPECT_LE(std::max(q.ratioAC, q.ratioBD), 0.476);
    EXPECT_GE(std::min(q.ratioAC, q.ratioBD), kMinRatio - 1e-3);
  }
}

TEST(Decisions, D13WritesBothRatiosIndependentlyAndInThePlane) {
  const double start[] = {-1, 0.5, 2, 0.3, -0.75, 2.5, 3, -1.5, -6, -0.5, 1.25, -4.1};
  const std::uint32_t ids[4] = {0, 1, 2, 3};
  Quad q;
  double p[12];
  std::copy(start, start + 12, p);
  ASSERT_TRUE(makeQuad(ids, p, kMinTriangleReading, q));
  writeRatios(q, q.ratioAC, q.ratioBD, p);  // first make it flat
  ASSERT_TRUE(makeQuad(ids, p, kMinTriangleReading, q));
  double one[12], two[12];
  std::copy(p, p + 12, one), std::copy(p, p + 12, two);
  // AC then BD, and BD then AC: the same points.
  Quad q1, q2;
  writeRatios(q, 0.31, q.ratioBD, one);
  ASSERT_TRUE(makeQuad(ids, one, kMinTriangleReading, q1));
  writeRatios(q1, q1.a == q.a || q1.a == q.c ? 0.31 : 0.22, q1.a == q.a || q1.a == q.c ? 0.22 : 0.31, one);
  writeRatios(q, q.ratioAC, 0.22, two);
  ASSERT_TRUE(makeQuad(ids, two, kMinTriangleReading, q2));
  writeRatios(q2, q2.a == q.a || q2.a == q.c ? 0.31 : 0.22, q2.a == q.a || q2.a == q.c ? 0.22 : 0.31, two);
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(one[i], two[i], 1e-12);
  ASSERT_TRUE(makeQuad(ids, one, kMinTriangleReading, q1));
  EXPECT_LT(q1.gap, 1e-14 * q1.longerDiagonal() * 10);
}

TEST(Decisions, D14DetectsDigitsEightAndNineAndIndicesBeyondThePieces) {
  const PairCodec codec(kKey.params, 11);
  EXPECT_EQ(codec.read(0.1115, 0.3775).state, ReadingState::badIndex);  // index 11; 10 is the last
  EXPECT_EQ(codec.read(0.1105, 0.3775).state, ReadingState::ok);
  EXPECT_EQ(codec.read(0.1095, 0.3785).state, ReadingState::badDigit);
  EXPECT_EQ(codec.read(0.1095, 0.3975).state, ReadingState::badDigit);
  ExtractOptions options;
  options.keepReadings = true;
  const Extraction read = readMark(lab::noise(marked(lab::sculpture(3000), kKey, kBits), 1e-3, 2), kKey, options);
  EXPECT_GT(read.erasedCells, 0u);
  for (const CellReading& r : read.readings) EXPECT_EQ(r.reading.state, ReadingState::ok);
}

TEST(Decisions, D15CountsPiecesFromTheMostSignificantBitAndPadsTheLast) {
  const std::vector<std::uint32_t> target = scrambling(kKey);
  std::vector<std::uint8_t> bits(64, 0);
  for (std::size_t i = 0; i < 64; ++i)
    if (target[i] == 0 || target[i] == 5 || target[i] == 63) bits[i] = 1;
  const std::vector<std::uint32_t> pieces = toPieces(bits, kKey);
  ASSERT_EQ(pieces.size(), 11u);
  EXPECT_EQ(pieces[0], 0b100001u);
  EXPECT_EQ(pieces[10], 0b000100u);  // bit 63 is the fourth of the last piece, two zeros pad it
  for (int i = 1; i < 10; ++i) EXPECT_EQ(pieces[i], 0u);
  EXPECT_EQ(kKey.params.width * kKey.params.height, 64u);  // the size is the key's, not the model's
}

TEST(Decisions, D16ChoosesTheSmallestSufficientNumberOfDigits) {
  const auto digits = [](std::uint32_t bits) {
    const PaperParams p = *chooseDigits(bits, 2);
    EXPECT_EQ(p.L1, p.L2);
    EXPECT_EQ(p.H1, p.H2);
    return p.H1 - p.L1 + 1;
  };
  EXPECT_EQ(digits(8100), 3);  // 900 pieces
  EXPECT_EQ(digits(576), 2);   // 96 pieces, not the 64 of three digits
  EXPECT_EQ(digits(30), 1);    // ten pieces fit ten indices: equality is allowed
  EXPECT_EQ(digits(31), 2);
  EXPECT_EQ(digits(600), 2);
  EXPECT_EQ(digits(601), 3);
  EXPECT_EQ(digits(9000), 3);
  EXPECT_EQ(digits(9001), 4);
  EXPECT_EQ(chooseDigits(0, 2).error().code, ErrorCode::badOption);
  EXPECT_EQ(chooseDigits(576, 3)->H2, 4);
  // 900 pieces of nine bits in separate positions are a valid choice too, 96 indices in one digit are not.
  PaperParams p = testKey(90, 90).params;
  p.L1 = 3, p.H1 = 5;
  EXPECT_TRUE(validate(p).ok());
  p.H1 = 3;
  EXPECT_EQ(validate(p).error().code, ErrorCode::badOption);
}

TEST(Decisions, D17SpreadsCopiesEvenly) {
  for (const auto& [name, mesh] : roomyMeshes()) {
    SCOPED_TRACE(name);
    MarkedMesh report;
    marked(mesh, kKey, kBits, &report);
    // Round robin: all pieces differ by one copy, but for a few cells that could not take theirs.
    EXPECT_GE(report.leastRepeats + 2.0, report.repeats);
    std::vector<int> copies(11, 0);
    for (const CellReading& r : votingCells(withPositions(mesh, report.positions), kKey)) ++copies[r.reading.index];
    EXPECT_LE(*std::max_element(copies.begin(), copies.end()), report.repeats + 3);
  }
}

TEST(Decisions, D18ReportsCapacityByEquationSixAndRefusesLessThanOneCopy) {
  for (const int digits : {2, 3}) {
    const Key key = digits == 2 ? testKey(24, 24) : testKey(30, 30);
    MarkedMesh report;
    marked(lab::sculpture(12000), key, logo(key.params.width, key.params.height).bits, &report);
    EXPECT_EQ(report.capacityBits, 3ull * digits * report.cells);
    EXPECT_EQ(report.payloadBits, key.params.bitCount());
    EXPECT_DOUBLE_EQ(report.repeats, static_cast<double>(report.cells) / pieceCount(key.params));
  }
  const Key large = testKey(120, 120);
  const Mesh small = lab::sculpture(1500);
  const Result<MarkedMesh> refused = embedMesh(small, logo(120, 120).bits, large);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::capacity);
  for (const std::string& number : {std::string("14400"), std::to_string(pieceCount(large.params)),
                                   std::to_string(small.vertexCount())})
    EXPECT_NE(refused.error().message.find(number), std::string::npos) << number << ": " << refused.error().message;
}

}  // namespace
}  // namespace quadmark
