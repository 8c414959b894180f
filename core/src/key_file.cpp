// SPDX-License-Identifier: MIT
// The key file: JSON to Key and back.
#include <algorithm>

#include "base64.h"
#include "concat.h"
#include "json_text.h"
#include "json_writer.h"
#include "number_text.h"
#include "quadmark/key.h"

namespace quadmark {
namespace {

constexpr int kKeyVersion = 1;

Error badKey(const std::string& message) { return {ErrorCode::badKey, "key file: " + message}; }

// Readers remember the first problem, so that a caller can read all members and ask once.
class Members {
 public:
  explicit Members(JsonValue object) : object_(object) {}

  void integer(const char* name, auto& out, bool required = false) {
    const JsonValue member = find(name, required);
    if (!member) return;
    const auto number = member.kind() == JsonValue::Kind::number ? parseInteger(member.text()) : std::nullopt;
    if (!number || *number < -1000000 || *number > 1000000)
      fail(name, "is not a small integer");
    else
      out = static_cast<std::remove_reference_t<decltype(out)>>(*number);
  }

  void number(const char* name, double& out) {
    const JsonValue member = find(name, false);
    if (!member) return;
    const auto number = member.kind() == JsonValue::Kind::number ? parseDouble(member.text()) : std::nullopt;
    if (!number)
      fail(name, "is not a number");
    else
      out = *number;
  }

  void boolean(const char* name, bool& out) {
    const JsonValue member = find(name, false);
    if (!member) return;
    if (member.kind() != JsonValue::Kind::boolean)
      fail(name, "is not true or false");
    else
      out = member.text() == "true";
  }

  void text(const char* name, std::string& out, bool required = false) {
    const JsonValue member = find(name, required);
    if (!member) return;
    if (!member.isString())
      fail(name, "is not a string");
    else
      out = member.asString();
  }

  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  JsonValue find(const char* name, bool required) {
    const JsonValue member = object_.find(name);
    if (!member && required) fail(name, "is missing");
    return member;
  }
  void fail(const char* name, const char* what) {
    if (problem_.empty()) problem_ = concat("\"", name, "\" ", what);
  }

  JsonValue object_;
  std::string problem_;
};

}  // namespace

Result<Key> parseKey(std::string_view text) {
  if (text.size() > 65536) return badKey("larger than 64 kB");
  const Result<JsonValue> json = parseJson(text);
  if (!json) return badKey(json.error().message);
  if (!json->isObject()) return badKey("not a JSON object");

  Members top(*json);
  int keyVersion = 0;
  Key key;
  std::string secret;
  top.integer("quadmark", keyVersion, true);
  if (!top.problem().empty()) return badKey(top.problem());
  if (keyVersion > kKeyVersion)
    return Error{ErrorCode::unsupportedVersion,
                 concat("key file: version ", keyVersion, " is newer than this program's ", kKeyVersion)};
  if (keyVersion < 1) return badKey("\"quadmark\" is not 1");
  top.text("scheme", key.scheme, true);
  top.text("secret", secret, true);
  top.text("owner", key.owner);
  if (!top.problem().empty()) return badKey(top.problem());
  if (key.scheme != "paper" && key.scheme != "robust")
    return badKey(concat("scheme \"", key.scheme.substr(0, 40),
                         "\" is not available in this version (\"paper\" and \"robust\" are)"));
  const auto bytes = fromBase64(secret);
  if (!bytes || bytes->size() != key.secret.size()) return badKey("\"secret\" is not 32 bytes in base64");
  std::copy(bytes->begin(), bytes->end(), key.secret.begin());

  if (key.scheme == "robust") return key;  // what else it needs is read from the mark
  const JsonValue params = json->find("params");
  if (!params.isObject()) return badKey("\"params\" is missing or not an object");
  Members members(params);
  PaperParams& p = key.params;
  std::string payload = "image";
  members.integer("L1", p.L1, true);
  members.integer("H1", p.H1, true);
  members.integer("L2", p.L2, true);
  members.integer("H2", p.H2, true);
  members.number("lambda", p.lambda);
  members.number("tau", p.tau);
  members.integer("k", p.k);
  members.text("payload", payload);
  members.integer("width", p.width, true);
  members.integer("height", p.height, true);
  members.boolean("keyedCells", p.keyedCells);
  members.boolean("scrambleOrder", p.scrambleOrder);
  if (!members.problem().empty()) return badKey("params: " + members.problem());
  if (payload != "image" && payload != "id") return badKey("params: \"payload\" is neither \"image\" nor \"id\"");
  p.payload = payload == "id" ? PayloadType::id : PayloadType::image;
  if (Status s = validate(p); !s) return badKey("params: " + s.error().message);
  return key;
}

std::string formatKey(const Key& key) {
  const PaperParams& p = key.params;
  JsonWriter json(JsonWriter::Layout::indented);
  json.beginObject();
  json.member("quadmark", kKeyVersion);
  json.member("scheme", key.scheme);
  json.member("secret", toBase64(key.secret));
  json.member("owner", key.owner);
  if (key.scheme == "robust") {
    json.endObject();
    return json.text() + "\n";
  }
  json.key("params");
  json.beginObject();
  json.member("L1", p.L1);
  json.member("H1", p.H1);
  json.member("L2", p.L2);
  json.member("H2", p.H2);
  json.member("lambda", p.lambda);
  json.member("tau", p.tau);
  json.member("k", p.k);
  json.member("payload", p.payload == PayloadType::id ? "id" : "image");
  json.member("width", p.width);
  json.member("height", p.height);
  if (p.keyedCells) json.member("keyedCells", true);
  if (p.scrambleOrder) json.member("scrambleOrder", true);
  json.endObject();
  json.endObject();
  return json.text() + "\n";
}

}  // namespace quadmark
