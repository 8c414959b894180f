// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "io/json_text.h"

namespace quadmark::io {
namespace {

JsonValue parsed(std::string_view text) {
  const Result<JsonValue> value = parseJson(text);
  EXPECT_TRUE(value.ok()) << text;
  return value.ok() ? *value : JsonValue();
}

TEST(Json, AcceptsEveryKindOfValue) {
  for (const char* text :
       {"{}", "[]", " [ ] ", "null", "true", "false", "0", "-0", "-1.5e-7", "1E+3", "\"\"", "[[],{}]",
        R"({"a":[1,2,{"b":null}],"c":"\u00e9\\\"/"})", "\t{\r\n\"a\" : 1 , \"b\":[ 1 , 2 ]\n}\n"}) {
    EXPECT_TRUE(parseJson(text).ok()) << text;
  }
}

TEST(Json, RefusesBrokenTextNamingTheByte) {
  for (const char* text :
       {"",          " ",        "{",         "[",           "[1",       "[1,",     "[1,]", "{\"a\"",
        "{\"a\":",   "{\"a\":1", "{\"a\":1,", "{\"a\":1,}",  "{a:1}",    "{'a':1}", "[1}",  "{\"a\":1]",
        "01",        "1.",       ".5",        "+1",          "1e",       "-",       "tru",  "nul",
        "\"",        "\"\\\"",   "\"\\x\"",   "\"\\u12g4\"", "\"a\nb\"", "[1] 2",   "{} x", "[1 2]",
        "{\"a\" 1}", "NaN",      "]",         "}",           ","}) {
    const Result<JsonValue> value = parseJson(text);
    ASSERT_FALSE(value.ok()) << text;
    EXPECT_EQ(value.error().code, ErrorCode::badFile);
    EXPECT_EQ(value.error().message.rfind("JSON byte ", 0), 0u) << value.error().message;
  }
  EXPECT_EQ(parseJson("[1,x]").error().message, "JSON byte 3: a value is expected");
  EXPECT_FALSE(parseJson(std::string_view("[1\0]", 4)).ok());
}

TEST(Json, RefusesDeepNestingWithoutRecursion) {
  const std::string deep(1000000, '[');
  EXPECT_FALSE(parseJson(deep).ok());
  EXPECT_FALSE(parseJson(deep + std::string(deep.size(), ']')).ok());
  EXPECT_TRUE(parseJson(std::string(kDeepestJson, '[') + std::string(kDeepestJson, ']')).ok());
  EXPECT_FALSE(parseJson(std::string(kDeepestJson + 1, '[') + std::string(kDeepestJson + 1, ']')).ok());
}

TEST(Json, FindsMembersAndKeepsSpelling) {
  const std::string text = R"({ "a" : 1.50 , "b":{"a":2}, "\u0063":[ 1 ,"x,]}" , {"k":[]} ] , "a":"last" })";
  const JsonValue root = parsed(text);
  EXPECT_EQ(root.find("a").text(), "\"last\"");  // as JSON.parse: the last of repeated keys
  EXPECT_EQ(root.find("b").find("a").text(), "2");
  EXPECT_EQ(root.find("c").elementCount(), 3u);
  EXPECT_FALSE(root.find("missing"));
  EXPECT_FALSE(root.find("missing").find("deeper"));
  std::vector<std::string> elements;
  root.find("c").forEachElement([&](JsonValue value) { elements.emplace_back(value.text()); });
  EXPECT_EQ(elements, (std::vector<std::string>{"1", "\"x,]}\"", "{\"k\":[]}"}));
}

TEST(Json, ReadsUnsignedNumbersInAnySpelling) {
  EXPECT_EQ(parsed("12").asUnsigned(), 12u);
  EXPECT_EQ(parsed("12.0").asUnsigned(), 12u);
  EXPECT_EQ(parsed("1.2e1").asUnsigned(), 12u);
  EXPECT_EQ(parsed("9007199254740992").asUnsigned(), 9007199254740992u);
  for (const char* text : {"-1", "1.5", "1e40", "\"12\"", "null", "[12]", "123456789012345678901234567890"}) {
    EXPECT_FALSE(parsed(text).asUnsigned().has_value()) << text;
  }
}

TEST(Json, DecodesStringsToValidUtf8) {
  EXPECT_EQ(parsed(R"("a\/\\\"\b\f\n\r\t")").asString(), "a/\\\"\b\f\n\r\t");
  EXPECT_EQ(parsed(R"("\u00e9\u20ac\ud83d\ude00")").asString(), "\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80");
  EXPECT_EQ(parsed("\"\xc3\xa9\"").asString(), "\xc3\xa9");
  const std::string replacement = "\xef\xbf\xbd";
  EXPECT_EQ(parsed(R"("\ud83dx")").asString(), replacement + "x");
  EXPECT_EQ(parsed(R"("\ude00")").asString(), replacement);
  EXPECT_EQ(parsed("\"\xff\xc3\"").asString(), replacement + replacement);
  EXPECT_EQ(parsed("\"\xc0\x80\"").asString(), replacement + replacement);                    // overlong
  EXPECT_EQ(parsed("\"\xed\xa0\x80\"").asString(), replacement + replacement + replacement);  // a surrogate in UTF-8
  EXPECT_EQ(parsed("12").asString(), "");
}

}  // namespace
}  // namespace quadmark::io
