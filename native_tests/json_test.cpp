// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>

#include "json_text.h"
#include "json_writer.h"

namespace quadmark {
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

TEST(JsonWriter, SeparatesAndNestsItsItems) {
  for (const auto& [layout, expected] :
       {std::pair{JsonWriter::Layout::oneLine, R"({"a":1,"b":[],"c":[{"d":true},"x y: ",null],"e":{},"f":["g"]})"},
        std::pair{JsonWriter::Layout::indented,
                  "{\n  \"a\": 1,\n  \"b\": [],\n  \"c\": [\n    {\n      \"d\": true\n    },\n    \"x y: \",\n    null\n"
                  "  ],\n  \"e\": {},\n  \"f\": [\n    \"g\"\n  ]\n}"}}) {
    JsonWriter json(layout);
    json.beginObject();
    json.member("a", 1);
    json.key("b");
    json.beginArray();
    json.endArray();
    json.key("c");
    json.beginArray();
    json.beginObject();
    json.member("d", true);
    json.endObject();
    json.value("x y: ");
    json.null();
    json.endArray();
    json.key("e");
    json.beginObject();
    json.endObject();
    json.member("f", std::vector<std::string>{"g"});
    json.endObject();
    EXPECT_EQ(json.text(), expected);
    EXPECT_TRUE(parseJson(json.text()).ok());
  }
}

TEST(JsonWriter, SpellsNumbersAsJson) {
  JsonWriter json;
  json.beginArray();
  json.value(0.1);
  json.value(-3);
  json.value(std::numeric_limits<std::uint64_t>::max());
  json.value(1e-7);
  json.value(std::numeric_limits<double>::infinity());
  json.value(std::numeric_limits<double>::quiet_NaN());
  json.endArray();
  EXPECT_EQ(json.text(), "[0.1,-3,18446744073709551615,1e-7,null,null]");
}

TEST(JsonWriter, WritesStringsThatReadBackAsTheyWere) {
  for (const std::string text : {"", "plain", "\"quoted\\\"", "a\tb\nc\x01\x1f", "\xc3\xa9\xf0\x9f\x90\xb0"}) {
    const std::string quoted = quoteJson(text);
    EXPECT_EQ(parsed(quoted).asString(), text);
    for (const char character : quoted) EXPECT_FALSE(character >= 0 && character < ' ');
  }
  EXPECT_EQ(parsed(quoteJson(std::string("\0", 1))).asString(), std::string("\0", 1));
  EXPECT_EQ(quoteJson("\xff\xc0x\xed\xa0\x80"), "\"\xef\xbf\xbd\xef\xbf\xbdx\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\"");
}

}  // namespace
}  // namespace quadmark
