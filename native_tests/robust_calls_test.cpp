// SPDX-License-Identifier: MIT
// The calls on bytes under keys of scheme `robust`.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/quadmark.h"
#include "robust_simulation.h"

namespace quadmark {
namespace {

using namespace lab;

Key robustKey(std::uint8_t seed = 1) {
  KeyRequest request;
  request.secret.fill(seed);
  request.owner = "test";
  request.scheme = "robust";
  return *makeKey(request);
}

const std::vector<std::uint8_t>& model() {
  static const std::vector<std::uint8_t> file = writePly(sculpture(9000));
  return file;
}

EmbedRequest idRequest(std::uint64_t id) {
  EmbedRequest request{.key = robustKey()};
  request.id = id;
  return request;
}

const std::vector<std::uint8_t>& marked() {
  static const std::vector<std::uint8_t> file = [] {
    auto response = embed(model(), {}, idRequest(0x0123456789abcdef));
    EXPECT_TRUE(response) << (response ? "" : response.error().message);
    return response ? response->file.bytes : std::vector<std::uint8_t>();
  }();
  return file;
}

ExtractResponse extracted(const std::vector<std::uint8_t>& file, const ExtractRequest& request) {
  auto response = extract(file, {}, request);
  EXPECT_TRUE(response) << (response ? "" : response.error().message);
  return response ? *response : ExtractResponse{};
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST(RobustKeyFile, HasNoParameters) {
  const Key key = robustKey();
  const std::string json = formatKey(key);
  EXPECT_FALSE(has(json, "params"));
  const auto back = parseKey(json);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->scheme, "robust");
  EXPECT_EQ(back->secret, key.secret);
  EXPECT_EQ(formatKey(*back), json);
}

TEST(RobustCalls, SayHowFarVerticesSlide) {
  auto response = embed(model(), {}, idRequest(1));
  ASSERT_TRUE(response);
  EXPECT_TRUE(has(response->reportJson, "\"slideRel\":0.00"));
}

TEST(RobustCalls, BringAnIdBackBlindly) {
  ExtractRequest request{.key = robustKey()};
  const ExtractResponse read = extracted(marked(), request);
  EXPECT_EQ(read.verdict, "match");
  EXPECT_EQ(read.id, 0x0123456789abcdefu);
  EXPECT_LT(read.falsePositive, 1e-30);
  EXPECT_EQ(read.image.width, 0u);
  EXPECT_EQ(read.evidence.size(), sculpture(9000).vertexCount());
  EXPECT_TRUE(has(read.reportJson, "\"payload\":\"id\""));
  EXPECT_TRUE(has(read.reportJson, "\"id\":\"0123456789abcdef\""));

  EXPECT_EQ(extracted(model(), request).verdict, "none");
  ExtractRequest other{.key = robustKey(2)};
  EXPECT_EQ(extracted(marked(), other).verdict, "none");
  ExtractRequest salted{.key = robustKey()};
  salted.salt = "another asset";
  EXPECT_EQ(extracted(marked(), salted).verdict, "none");
}

TEST(RobustCalls, SayWhetherTheExpectedIdIsThere) {
  ExtractRequest request{.key = robustKey()};
  request.expectedId = 0x0123456789abcdef;
  const ExtractResponse same = extracted(marked(), request);
  EXPECT_EQ(same.verdict, "match");
  EXPECT_TRUE(has(same.reportJson, "\"comparison\":\"agrees\""));
  request.expectedId = 0x0123456789abcdee;
  const ExtractResponse differs = extracted(marked(), request);
  EXPECT_EQ(differs.verdict, "none");
  EXPECT_EQ(differs.id, 0x0123456789abcdefu);
  EXPECT_TRUE(has(differs.reportJson, "\"comparison\":\"differs\""));
}

TEST(RobustCalls, SurviveQuantizationToFourteenBits) {
  const auto parsed = readModel(marked());
  ASSERT_TRUE(parsed);
  const std::vector<std::uint8_t> worn = writePly(quantize((*parsed)->mesh(), 14, Grid::common));
  EXPECT_EQ(extracted(worn, {.key = robustKey()}).id, 0x0123456789abcdefu);
}

// One mesh beside another, of vertices that are its own.
Mesh beside(Mesh left, const Mesh& right, double shift) {
  const auto first = static_cast<std::uint32_t>(left.vertexCount());
  for (std::size_t i = 0; i < right.positions.size(); ++i)
    left.positions.push_back(right.positions[i] + (i % 3 == 0 ? shift : 0));
  for (const std::uint32_t v : right.faceVertices) left.faceVertices.push_back(first + v);
  roundToPrecision(left);
  return left;
}

TEST(RobustCalls, FindTheMarkedObjectAmongOthers) {
  const auto parsed = readModel(marked());
  ASSERT_TRUE(parsed);
  const Mesh worn = simplifyMeshopt((*parsed)->mesh(), 0.65);
  Mesh scene = machinedPart(20000);
  for (int i = 1; i <= 2; ++i) scene = beside(std::move(scene), machinedPart(20000, 7), 4.0 * i);
  const std::size_t others = scene.vertexCount();
  scene = beside(std::move(scene), worn, -4);
  ExtractRequest request{.key = robustKey()};
  request.expectedId = 0x0123456789abcdef;
  const ExtractResponse read = extracted(writePly(scene), request);
  EXPECT_EQ(read.verdict, "match");
  EXPECT_TRUE(has(read.reportJson, "\"readFrom\":\"component\""));
  ASSERT_EQ(read.evidence.size(), scene.vertexCount());
  for (std::size_t v = 0; v < others; ++v) ASSERT_EQ(read.evidence[v], 0) << v;
  EXPECT_GT(std::count_if(read.evidence.begin(), read.evidence.end(), [](float e) { return e > 0.5f; }), 100);
  // The same objects without a mark.
  const Mesh plain = beside(machinedPart(4000), sculpture(3000), -4);
  EXPECT_EQ(extracted(writePly(plain), request).verdict, "none");
}

TEST(RobustCalls, BringTextsBack) {
  for (const std::string text : {"chair 42", "Example Studio, chair 42"}) {
    EmbedRequest request{.key = robustKey()};
    request.text = text;
    request.robust.salt = "chair";
    const auto response = embed(model(), {}, request);
    ASSERT_TRUE(response) << response.error().message;
    ExtractRequest reading{.key = robustKey()};
    reading.salt = "chair";
    const ExtractResponse read = extracted(response->file.bytes, reading);
    EXPECT_EQ(read.verdict, "match");
    EXPECT_EQ(read.text, text);
  }
}

TEST(RobustCalls, BringImagesBackAndCompareThem) {
  Random random(5);
  const BitImage image{16, 12, robust::randomBits(192, random)};
  EmbedRequest request{.key = robustKey()};
  request.image = image;
  const auto response = embed(model(), {}, request);
  ASSERT_TRUE(response) << response.error().message;
  ExtractRequest reading{.key = robustKey()};
  reading.reference = image;
  const ExtractResponse read = extracted(response->file.bytes, reading);
  EXPECT_EQ(read.verdict, "match");
  EXPECT_EQ(read.image.width, 16u);
  EXPECT_EQ(read.image.height, 12u);
  EXPECT_EQ(read.image.bits, image.bits);
  EXPECT_EQ(read.erased, std::vector<std::uint8_t>(192, 0));
  for (float confidence : read.confidence) EXPECT_GT(confidence, 0.99f);
  EXPECT_TRUE(has(read.reportJson, "\"ber\":0"));
  EXPECT_TRUE(has(read.reportJson, "\"exact\":true"));
}

TEST(RobustCalls, ReportWhatAMarkWithstands) {
  EmbedRequest request = idRequest(7);
  request.robust.strength = robust::Strength::strong;
  request.robust.selfTest = true;
  const auto response = embed(model(), {}, request);
  ASSERT_TRUE(response);
  const std::string& report = response->reportJson;
  EXPECT_TRUE(has(report, "\"strength\":\"strong\""));
  for (const char* test : {"quantize14", "quantize11", "noise3e-4", "collapse10", "crop50"})
    EXPECT_TRUE(has(report, "\"" + std::string(test) + "\":{\"read\":")) << test;
  EXPECT_TRUE(has(report, "\"quantize14\":{\"read\":true"));
  EXPECT_TRUE(has(report, "\"capacityClass\":\""));
}

TEST(RobustCalls, RefuseModelsThatAreTooSmall) {
  const auto response = embed(writePly(cube()), {}, idRequest(1));
  ASSERT_FALSE(response);
  EXPECT_EQ(response.error().code, ErrorCode::capacity);
  EXPECT_TRUE(has(response.error().message, "of the 276 bits")) << response.error().message;
}

TEST(RobustCalls, RefuseWrongArguments) {
  EmbedRequest two = idRequest(1);
  two.text = "x";
  auto response = embed(model(), {}, two);
  ASSERT_FALSE(response);
  EXPECT_EQ(response.error().message, "give either an image or an id or a text to embed");
  EmbedRequest salted = idRequest(1);
  salted.robust.salt = std::string("a\0b", 3);
  EXPECT_EQ(embed(model(), {}, salted).error().message, "salt: contains a zero byte");
  ExtractRequest both{.key = robustKey()};
  both.expectedId = 1;
  both.expectedText = "x";
  EXPECT_EQ(extract(marked(), {}, both).error().code, ErrorCode::badOption);
}

TEST(RobustCalls, StopWhenTold) {
  EmbedRequest request = idRequest(1);
  request.progress = [](const char*, double done) { return done < 0.5; };
  EXPECT_EQ(embed(model(), {}, request).error().code, ErrorCode::aborted);
  ExtractRequest reading{.key = robustKey(9)};
  reading.progress = [](const char*, double done) { return done < 0.5; };
  EXPECT_EQ(extract(marked(), {}, reading).error().code, ErrorCode::aborted);
}

TEST(RobustCalls, DescribeThePlacesForAMark) {
  const auto report = inspect(model(), {});
  ASSERT_TRUE(report);
  EXPECT_TRUE(has(*report, "\"robust\":{\"carriers\":"));
}

}  // namespace
}  // namespace quadmark
