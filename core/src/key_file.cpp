// SPDX-License-Identifier: MIT
// The key file: JSON to Key and back.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "base64.h"
#include "quadmark/key.h"

namespace quadmark {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kKeyVersion = 1;

Error badKey(const std::string& message) { return {ErrorCode::badKey, "key file: " + message}; }

// Readers remember the first problem, so that a caller can read all members and ask once.
class Members {
 public:
  explicit Members(const Json& object) : object_(object) {}

  void integer(const char* name, auto& out, bool required = false) {
    const Json* member = find(name, required);
    if (member == nullptr) return;
    if (!member->is_number_integer() || *member < -1000000 || *member > 1000000) {
      fail(name, "is not a small integer");
    } else {
      out = member->get<std::remove_reference_t<decltype(out)>>();
    }
  }

  void number(const char* name, double& out) {
    const Json* member = find(name, false);
    if (member == nullptr) return;
    if (!member->is_number())
      fail(name, "is not a number");
    else
      out = member->get<double>();
  }

  void boolean(const char* name, bool& out) {
    const Json* member = find(name, false);
    if (member == nullptr) return;
    if (!member->is_boolean())
      fail(name, "is not true or false");
    else
      out = member->get<bool>();
  }

  void text(const char* name, std::string& out, bool required = false) {
    const Json* member = find(name, required);
    if (member == nullptr) return;
    if (!member->is_string())
      fail(name, "is not a string");
    else
      out = member->get<std::string>();
  }

  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  const Json* find(const char* name, bool required) {
    const auto at = object_.find(name);
    if (at != object_.end()) return &*at;
    if (required) fail(name, "is missing");
    return nullptr;
  }
  void fail(const char* name, const char* what) {
    if (problem_.empty()) problem_ = std::string("\"") + name + "\" " + what;
  }

  const Json& object_;
  std::string problem_;
};

}  // namespace

Result<Key> parseKey(std::string_view text) {
  // The parser recurses per bracket; a real key file nests two deep.
  if (text.size() > 65536) return badKey("larger than 64 kB");
  int depth = 0;
  for (char c : text) {
    depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
    if (depth > 32) return badKey("nested too deeply");
  }
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) return badKey("not a JSON object");

  Members top(json);
  int keyVersion = 0;
  Key key;
  std::string secret;
  top.integer("quadmark", keyVersion, true);
  if (!top.problem().empty()) return badKey(top.problem());
  if (keyVersion > kKeyVersion)
    return Error{ErrorCode::unsupportedVersion, "key file: version " + std::to_string(keyVersion) +
                                                    " is newer than this program's " + std::to_string(kKeyVersion)};
  if (keyVersion < 1) return badKey("\"quadmark\" is not 1");
  top.text("scheme", key.scheme, true);
  top.text("secret", secret, true);
  top.text("owner", key.owner);
  if (!top.problem().empty()) return badKey(top.problem());
  if (key.scheme != "paper")
    return badKey("scheme \"" + key.scheme.substr(0, 40) + "\" is not available in this version (\"paper\" is)");
  const auto bytes = fromBase64(secret);
  if (!bytes || bytes->size() != key.secret.size()) return badKey("\"secret\" is not 32 bytes in base64");
  std::copy(bytes->begin(), bytes->end(), key.secret.begin());

  const auto params = json.find("params");
  if (params == json.end() || !params->is_object()) return badKey("\"params\" is missing or not an object");
  Members members(*params);
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
  Json params = {{"L1", p.L1},       {"H1", p.H1},   {"L2", p.L2},     {"H2", p.H2}, {"lambda", p.lambda},
                 {"tau", p.tau},     {"k", p.k},     {"payload", p.payload == PayloadType::id ? "id" : "image"},
                 {"width", p.width}, {"height", p.height}};
  if (p.keyedCells) params["keyedCells"] = true;
  if (p.scrambleOrder) params["scrambleOrder"] = true;
  const Json json = {{"quadmark", kKeyVersion}, {"scheme", key.scheme}, {"secret", toBase64(key.secret)},
                     {"owner", key.owner},      {"params", params}};
  // Text that is not UTF-8 would make dump() fail: replaced, not thrown.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadmark
