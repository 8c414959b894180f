// SPDX-License-Identifier: MIT
// The decisions that the paper leaves open, writing, reading, keys and reports: D19 to D25 and the measures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures.h"

namespace quadmark {
namespace {

using namespace test;

const Key kKey = testKey(8, 8);
const std::vector<std::uint8_t> kBits = logo(8, 8).bits;

TEST(Decisions, D19RepairsWhatRoundingBreaks) {
  // A hundred sizes away from the origin float32 keeps five digits of a coordinate, of which the mark needs three.
  for (const auto& [name, original] : roomyMeshes()) {
    SCOPED_TRACE(name);
    const double shift = 100 * boundingDiagonal(original);
    const Mesh mesh = lab::affine(original, {1, 0, 0, shift, 0, 1, 0, shift, 0, 0, 1, -shift});
    const Mesh output = marked(mesh, kKey, kBits);
    for (double x : output.positions) ASSERT_EQ(x, nearestFloat32(x));
    EXPECT_TRUE(readsExactly(output, kKey, kBits));
  }
}

TEST(Decisions, D20ReadsExactlyUnattackedReorderedAndUnderTheCombinedAffineMap) {
  // Faces that are flat by construction, where the literal algorithm reads wrong bits in all three cases.
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Key key = testKey(24, 24, 3);
    const std::vector<std::uint8_t> bits = logo(24, 24).bits;
    MarkedMesh report;
    const Mesh output = marked(lab::machinedPart(6000, seed), key, bits, &report);
    EXPECT_TRUE(report.guarantees.all());
    EXPECT_GT(report.naturalCells, 100u);
    EXPECT_GT(report.repairs, 0u);  // unwanted flat sets were broken
    EXPECT_TRUE(readsExactly(output, key, bits));
    EXPECT_TRUE(readsExactly(mapped(output, "CB"), key, bits));
    for (int i = 0; i < repetitions(20); ++i)
      ASSERT_TRUE(readsExactly(lab::reorder(output, static_cast<std::uint64_t>(i)), key, bits)) << i;
  }
}

TEST(Decisions, D21DoesNotTakeCoverageForSuccess) {
  const Key key = testKey(24, 24);
  const Mesh garbage = lab::noise(marked(lab::sculpture(12000), key, logo(24, 24).bits), 1e-3, 1);
  const Extraction read = readMark(garbage, key);
  EXPECT_GT(read.passes, 1);               // it did go on looking
  EXPECT_NE(read.verdict, Verdict::match);  // and found pieces, none of which mean anything
  double sum = 0;
  for (float c : read.confidence) sum += c;
  EXPECT_LT(sum / 576, 0.5);
}

TEST(Decisions, D21FindsByToleranceWhatIsNoLongerExactlyFlat) {
  Key strict = testKey(8, 8);
  strict.params.tau = 0;
  // Noise of a few roundings: too much for pass 1, little for the digits.
  const Mesh noisy = lab::noise(marked(lab::sculpture(3000), kKey, kBits), 3e-6, 1);
  const Extraction exactOnly = readMark(noisy, strict), tolerant = readMark(noisy, kKey);
  EXPECT_GT(tolerant.cells, exactOnly.cells);
  EXPECT_TRUE(isExact(tolerant, kBits));
  EXPECT_EQ(tolerant.verdict, Verdict::match);
}

TEST(Decisions, D22ReportsUnreadBitsAsErasuresWithoutConfidence) {
  const Key key = testKey(24, 24);
  const std::vector<std::uint8_t> bits = logo(24, 24).bits;
  const Extraction read = readMark(lab::crop(marked(lab::sculpture(3000), key, bits), 0.9), key);
  ASSERT_EQ(read.confidence.size(), 576u);
  std::size_t erased = 0, confident = 0, wrongAndConfident = 0;
  for (std::size_t i = 0; i < 576; ++i) {
    EXPECT_GE(read.confidence[i], 0);
    EXPECT_LE(read.confidence[i], 1);
    if (read.erased[i] != 0) {
      ++erased;
      EXPECT_EQ(read.bits[i], 0);
      EXPECT_LE(read.confidence[i], 0.1f);
    } else if (read.confidence[i] > 0.9f) {
      ++confident;
      wrongAndConfident += read.bits[i] != bits[i];
    }
  }
  EXPECT_GT(erased, 50u);
  EXPECT_GT(confident, 50u);
  EXPECT_LE(wrongAndConfident, confident / 50);
}

TEST(Decisions, D23ScramblesByKeyAndBalancesBitsByPad) {
  const Key key = testKey(24, 24);
  // An empty picture: without the pad every piece of every cell would be zero.
  const std::vector<std::uint8_t> empty(576, 0);
  ExtractOptions options;
  options.keepReadings = true;
  std::size_t ones = 0, count = 0;
  for (const CellReading& r : readMark(marked(lab::sculpture(6000), key, empty), key, options).readings) {
    if (r.weight <= 0) continue;
    for (int bit = 0; bit < 6; ++bit, ++count) ones += r.reading.piece >> bit & 1;
  }
  ASSERT_GT(count, 3000u);
  const double half = 0.5 * static_cast<double>(count);
  // The embedder prefers codes near the natural ratios, which is no secret; five standard deviations of fair coins.
  EXPECT_NEAR(static_cast<double>(ones), half, 0.1 * half + 5 * std::sqrt(half / 2));
  EXPECT_NE(scrambling(key), scrambling(strangersKey(key, 1)));
}

TEST(Decisions, D24ReadsNoiseUnderAnotherChoiceOfCells) {
  Key key = testKey(8, 8, 3);
  key.params.keyedCells = true;
  MarkedMesh report;
  const Mesh mesh = lab::sculpture(6000), output = marked(mesh, key, kBits, &report);
  EXPECT_TRUE(report.guarantees.all());
  EXPECT_TRUE(readsExactly(output, key, kBits));
  EXPECT_TRUE(readsExactly(lab::reorder(output, 2), key, kBits));
  EXPECT_TRUE(readsExactly(mapped(output, "CB"), key, kBits));
  EXPECT_EQ(readMark(output, key).verdict, Verdict::match);
  EXPECT_EQ(readMark(output, strangersKey(key, 1)).verdict, Verdict::none);
  // Every label that carries is one of the key's; a reader without the choice sees the others as well.
  const Pad pad(key);
  ExtractOptions options;
  options.keepReadings = true;
  for (const CellReading& r : readMark(output, key, options).readings)
    if (r.weight > 0) {
      EXPECT_TRUE(pad.carries(r.reading.prefix1, r.reading.prefix2));
    }
  MarkedMesh all;
  Key open = key;
  open.params.keyedCells = false;
  marked(mesh, open, kBits, &all);
  EXPECT_LT(report.cells, all.cells);
}

TEST(Decisions, D25ScramblesNoVertexOrderUnlessAsked) {
  EXPECT_FALSE(PaperParams{}.scrambleOrder);
  const Mesh mesh = lab::sculpture(1500);
  const std::vector<std::uint8_t> file = lab::writePly(mesh);
  EmbedRequest request;
  request.key = kKey;
  request.image = logo(8, 8);
  const auto plain = embed(file, {}, request);
  ASSERT_TRUE(plain.ok()) << plain.error().message;
  const auto read = readModel(plain->file.bytes);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ((*read)->mesh().faceVertices, mesh.faceVertices);  // the order is the file's own
  EXPECT_EQ(plain->reportJson.find("scrambled"), std::string::npos);
  // Asked for, the order is another one for every key; faces and mark are the same.
  const auto corners = [](const Mesh& of) {
    std::vector<double> out;
    for (std::uint32_t v : of.faceVertices) out.insert(out.end(), &of.positions[3 * v], &of.positions[3 * v] + 3);
    return out;
  };
  request.key.params.scrambleOrder = true;
  std::vector<std::vector<std::uint32_t>> orders = {mesh.faceVertices};
  for (const Key& key : {request.key, strangersKey(request.key, 1)}) {
    request.key = key;
    request.key.params.scrambleOrder = false;
    const auto unmoved = embed(file, {}, request);
    request.key.params.scrambleOrder = true;
    const auto scrambled = embed(file, {}, request);
    ASSERT_TRUE(unmoved.ok() && scrambled.ok()) << scrambled.error().message;
    const auto before = readModel(unmoved->file.bytes), after = readModel(scrambled->file.bytes);
    ASSERT_TRUE(before.ok() && after.ok());
    EXPECT_EQ(corners((*after)->mesh()), corners((*before)->mesh()));
    EXPECT_TRUE(readsExactly((*after)->mesh(), key, kBits));
    EXPECT_NE(scrambled->reportJson.find("the order of the vertices was scrambled (" +
                                         std::to_string(mesh.vertexCount()) + " of "),
              std::string::npos);
    EXPECT_EQ(scrambled->file.bytesChanged, countChangedBytes(file, {}, scrambled->file));
    EXPECT_EQ(std::count(orders.begin(), orders.end(), (*after)->mesh().faceVertices), 0);
    orders.push_back((*after)->mesh().faceVertices);
    EXPECT_EQ(embed(file, {}, request)->file.bytes, scrambled->file.bytes);
  }
}

TEST(Decisions, D25SaysSoWhereNoOrderCanBeScrambled) {
  // Without indices the order of the vertices is that of the triangles.
  Mesh mesh = lab::sculpture(1500);
  std::vector<double> corners;
  for (std::uint32_t v : mesh.faceVertices)
    corners.insert(corners.end(), &mesh.positions[3 * v], &mesh.positions[3 * v] + 3);
  std::string json =
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":N}],"bufferViews":[{"buffer":0,"byteLength":N}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":V,"type":"VEC3"}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})";
  const auto put = [&](char name, std::size_t value) {
    for (std::size_t at; (at = json.find(std::string(":") + name)) != json.npos;)
      json.replace(at + 1, 1, std::to_string(value));
  };
  put('N', 4 * corners.size());
  put('V', corners.size() / 3);
  while (json.size() % 4 != 0) json += ' ';
  std::vector<std::uint8_t> file;
  const auto word = [&](std::size_t value) {
    for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<std::uint8_t>(value >> shift));
  };
  for (std::size_t value : {std::size_t{0x46546c67}, std::size_t{2}, 28 + json.size() + 4 * corners.size(), json.size(),
                            std::size_t{0x4e4f534a}})
    word(value);
  file.insert(file.end(), json.begin(), json.end());
  word(4 * corners.size());
  word(0x004e4942);
  for (double x : corners) {
    const float narrow = static_cast<float>(x);
    const auto* raw = reinterpret_cast<const std::uint8_t*>(&narrow);
    file.insert(file.end(), raw, raw + 4);
  }
  EmbedRequest request;
  request.key = kKey;
  request.image = logo(8, 8);
  const auto plain = embed(file, {}, request);
  request.key.params.scrambleOrder = true;
  const auto kept = embed(file, {}, request);
  ASSERT_TRUE(plain.ok() && kept.ok()) << kept.error().message;
  EXPECT_EQ(kept->file.bytes, plain->file.bytes);
  EXPECT_EQ(kept->file.bytesChanged, plain->file.bytesChanged);
  EXPECT_NE(kept->reportJson.find("could not be scrambled"), std::string::npos);
  EXPECT_NE(kept->reportJson.find("mesh 0 primitive 0 has no indices"), std::string::npos);
}

TEST(Decisions, ReportsErasuresAsHalfAnError) {
  const std::vector<std::uint8_t> expected = {1, 0, 1, 0}, read = {1, 1, 0, 0}, erased = {0, 0, 1, 0};
  EXPECT_DOUBLE_EQ(bitErrorRate(expected, read, erased), (1 + 0.5) / 4);
}

TEST(Decisions, ReportsTheSignalToNoiseRatioOfItsDefinition) {
  Mesh a;
  a.positions = {0, 0, 0, 3, 0, 0, 0, 3, 0};
  a.faceVertices = {0, 1, 2};
  Mesh b = a;
  b.positions[2] = 0.1;
  // Centre (1, 1, 0): 2 + 5 + 5 = 12 over 0.01.
  EXPECT_NEAR(distortion(a, b).snrDb, 10 * std::log10(12 / 0.01), 1e-9);
}

}  // namespace
}  // namespace quadmark
