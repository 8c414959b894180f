// SPDX-License-Identifier: MIT
#include "quadmark/key.h"

#include <gtest/gtest.h>

#include "fixtures.h"

namespace quadmark {
namespace {

using test::testKey;

void expectEqual(const Key& a, const Key& b) {
  EXPECT_EQ(a.secret, b.secret);
  EXPECT_EQ(a.owner, b.owner);
  EXPECT_EQ(a.scheme, b.scheme);
  EXPECT_EQ(a.params, b.params);
}

// The text of a valid key with one piece of it replaced.
std::string edited(const std::string& from, const std::string& to) {
  std::string text = formatKey(testKey(24, 24));
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void expectRefused(const std::string& text, ErrorCode code, const std::string& place) {
  const Result<Key> key = parseKey(text);
  ASSERT_FALSE(key.ok()) << text;
  EXPECT_EQ(key.error().code, code) << key.error().message;
  EXPECT_NE(key.error().message.find(place), std::string::npos) << key.error().message;
}

TEST(KeyFile, BringsEveryFieldBack) {
  expectEqual(*parseKey(formatKey(testKey(24, 24))), testKey(24, 24));
  Key key = testKey(90, 33, 3, 200);
  key.owner = "Zoe \"quoted\" \\ \xc3\xa9\n";
  key.params.L1 = 2, key.params.H1 = 6, key.params.L2 = 4, key.params.H2 = 5;
  key.params.lambda = 1.2345678901234567e-5;
  key.params.tau = 0;
  key.params.k = 3;
  key.params.keyedCells = key.params.scrambleOrder = true;
  ASSERT_TRUE(parseKey(formatKey(key)).ok()) << parseKey(formatKey(key)).error().message;
  expectEqual(*parseKey(formatKey(key)), key);
  expectEqual(*parseKey(formatKey(test::idKey(9))), test::idKey(9));
}

TEST(KeyFile, EndsWithALineBreakAndSurvivesWhiteSpaceAndUnknownMembers) {
  const std::string text = formatKey(testKey(24, 24));
  EXPECT_EQ(text.back(), '\n');
  EXPECT_TRUE(parseKey(" \r\n\t" + text + "  ").ok());
  EXPECT_TRUE(parseKey(edited("\"owner\"", "\"comment\": [1, {\"a\": null}], \"owner\"")).ok());
}

TEST(KeyFile, KeepsAnOwnerThatIsNotUtf8FromBreakingTheFile) {
  Key key = testKey(24, 24);
  key.owner = "caf\xe9";
  EXPECT_TRUE(parseKey(formatKey(key)).ok());
}

TEST(KeyFile, UsesDefaultsForOptionalMembers) {
  const Result<Key> key = parseKey(R"({"quadmark":1,"scheme":"paper",
    "secret":"AAECAwQFBgcICQoLDA0ODxAREhMUFRYXGBkaGxwdHh8=",
    "params":{"L1":2,"H1":3,"L2":2,"H2":3,"width":24,"height":24}})");
  ASSERT_TRUE(key.ok());
  EXPECT_EQ(key->secret[31], 31);
  EXPECT_EQ(key->owner, "");
  PaperParams expected;
  expected.width = expected.height = 24;
  EXPECT_EQ(key->params, expected);
}

TEST(KeyFile, RefusesWhatIsNotAKeyFile) {
  for (const std::string text : {"", "{", "[]", "42", "null", "\"key\"", "{\"quadmark\":1", "quadmark"})
    expectRefused(text, ErrorCode::badKey, "key file");
  expectRefused("{}", ErrorCode::badKey, "\"quadmark\" is missing");
  expectRefused(std::string(1000, '[') + std::string(1000, ']'), ErrorCode::badKey, "nested");
  expectRefused("{\"x\":\"" + std::string(70000, 'x') + "\"}", ErrorCode::badKey, "64 kB");
  const std::string whole = formatKey(testKey(24, 24));
  for (std::size_t length = 0; length + 2 < whole.size(); ++length)
    ASSERT_FALSE(parseKey(std::string_view(whole).substr(0, length)).ok()) << length;
}

TEST(KeyFile, RefusesOtherVersionsAndSchemes) {
  expectRefused(edited("\"quadmark\": 1", "\"quadmark\": 2"), ErrorCode::unsupportedVersion, "2");
  expectRefused(edited("\"quadmark\": 1", "\"quadmark\": 0"), ErrorCode::badKey, "quadmark");
  expectRefused(edited("\"quadmark\": 1", "\"quadmark\": \"1\""), ErrorCode::badKey, "quadmark");
  expectRefused(edited("\"quadmark\": 1", "\"quadmark\": 1.5"), ErrorCode::badKey, "quadmark");
  expectRefused(edited("\"quadmark\": 1", "\"quadmark\": 1e30"), ErrorCode::badKey, "quadmark");
  expectRefused(edited("\"paper\"", "\"sturdy\""), ErrorCode::badKey, "scheme \"sturdy\" is not available");
  expectRefused(edited("\"paper\"", "7"), ErrorCode::badKey, "scheme");
}

TEST(KeyFile, RefusesASecretOfTheWrongKind) {
  const std::string text = formatKey(testKey(24, 24));
  const std::size_t at = text.find("\"secret\": \"") + 11;
  const std::string secret = text.substr(at, 44);
  for (const std::string& other : {std::string(""), secret.substr(0, 40), secret + "AAAA", "!" + secret.substr(1),
                                   std::string(44, 'A')})
    expectRefused(edited(secret, other), ErrorCode::badKey, "secret");
  expectRefused(edited('"' + secret + '"', "[1,2]"), ErrorCode::badKey, "secret");
}

TEST(KeyFile, RefusesEveryParameterOutOfRange) {
  const struct { const char *from, *to, *place; } cases[] = {
      {"\"L1\": 2", "\"L1\": 1", "L1"},
      {"\"L1\": 2", "\"L1\": 10", "L1"},
      {"\"L1\": 2", "\"L1\": 4", "H1"},
      {"\"H1\": 3", "\"H1\": 10", "H1"},
      {"\"L2\": 2", "\"L2\": 0", "L2"},
      {"\"H2\": 3", "\"H2\": -3", "H2"},
      {"\"H2\": 3", "\"H2\": 3.5", "H2"},
      {"\"H2\": 3", "\"H2\": null", "H2"},
      {"\"k\": 1", "\"k\": 0", "k"},
      {"\"k\": 1", "\"k\": 4", "k"},
      {"\"k\": 1", "\"k\": 99999999999999999999", "k"},
      {"\"width\": 24", "\"width\": 0", "0 x 24"},
      {"\"width\": 24", "\"width\": -1", "params"},
      {"\"height\": 24", "\"height\": 1025", "1025"},
      {"\"height\": 24", "\"height\": \"24\"", "height"},
      {"\"tau\": 0.001", "\"tau\": -1e-9", "tau"},
      {"\"tau\": 0.001", "\"tau\": 0.11", "tau"},
      {"\"tau\": 0.001", "\"tau\": true", "tau"},
      {"\"lambda\": 0.001", "\"lambda\": 0", "lambda"},
      {"\"lambda\": 0.001", "\"lambda\": 0.2", "lambda"},
      {"\"lambda\": 0.001", "\"lambda\": \"x\"", "lambda"},
      {"\"image\"", "\"text\"", "payload"},
      {"\"image\"", "\"id\"", "64 x 1"},
      {"\"width\": 24", "\"keyedCells\": 1, \"width\": 24", "keyedCells"},
      {"\"width\": 24", "\"width\": 64", "pieces"},  // 64 x 24 bits: 256 pieces, two digits count to 100
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.to);
    expectRefused(edited(c.from, c.to), ErrorCode::badKey, c.place);
  }
  for (const char* name : {"L1", "H1", "L2", "H2", "width", "height"})
    expectRefused(edited('"' + std::string(name) + '"', "\"other\""), ErrorCode::badKey, name);
  expectRefused(edited("\"params\"", "\"parameters\""), ErrorCode::badKey, "params");
}

TEST(ValidateParams, NamesTheOption) {
  const auto expectBad = [](PaperParams p, const std::string& place) {
    const Status s = validate(p);
    ASSERT_FALSE(s.ok()) << place;
    EXPECT_EQ(s.error().code, ErrorCode::badOption);
    EXPECT_NE(s.error().message.find(place), std::string::npos) << s.error().message;
  };
  const PaperParams good = testKey(24, 24).params;
  EXPECT_TRUE(validate(good).ok());
  PaperParams p = good;
  p.lambda = std::numeric_limits<double>::quiet_NaN();
  expectBad(p, "lambda");
  p = good, p.tau = std::numeric_limits<double>::quiet_NaN();
  expectBad(p, "tau");
  p = good, p.width = p.height = 1;
  expectBad(p, "1 x 1");
  p = good, p.width = 0;
  expectBad(p, "0 x 24");
  p = good, p.width = 1u << 31, p.height = 2;  // the product alone would wrap to 0
  expectBad(p, "2147483648");
}

TEST(MakeKey, ChoosesDigitsAndRefusesNonsense) {
  KeyRequest request;
  request.params.width = request.params.height = 90;
  const Result<Key> key = makeKey(request);
  ASSERT_TRUE(key.ok());
  EXPECT_EQ(key->params.L1, 2);
  EXPECT_EQ(key->params.H2, 4);
  request.params.width = 0;
  EXPECT_EQ(makeKey(request).error().code, ErrorCode::badOption);
  request.params.width = request.params.height = 1;
  EXPECT_EQ(makeKey(request).error().code, ErrorCode::badOption);
  request.params.width = request.params.height = 1000;
  request.params.L1 = 8;  // two digits left for a million bits
  EXPECT_EQ(makeKey(request).error().code, ErrorCode::badOption);
  request.chooseDigits = false;
  request.params = PaperParams{};
  request.params.width = request.params.height = 90;
  EXPECT_EQ(makeKey(request).error().code, ErrorCode::badOption);  // two digits cannot number 1350 pieces
}

}  // namespace
}  // namespace quadmark
