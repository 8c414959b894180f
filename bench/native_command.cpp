// SPDX-License-Identifier: MIT
// quadmark_native: the core's calls on files, for the parity tests and for profiling. Not a product: the command line for
// users is the npm package's.
//
//   quadmark_native embed IN OUT KEY (image PNG | id HEX | text TEXT) [--strength S] [URI=FILE ...]   marks; writes OUT and OUT.<n> per changed buffer
//   quadmark_native extract IN KEY [URI=FILE ...]                          reads; prints the report and the bits
//   quadmark_native inspect IN [URI=FILE ...]
//   quadmark_native attack IN OUT KIND AMOUNT VARIANT ITERATIONS SEED      writes PLY, or GLB when OUT ends in .glb
//   quadmark_native generate OUT NAME VERTICES SEED
//
// Prints one JSON object; errors as {"error":{"code":...,"message":...}} with exit status 1.
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/quadmark.h"
#include "read_file.h"

namespace {

using namespace quadmark;
using bench::readFile;
using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

Status writeFile(const std::string& path, const Bytes& bytes) {
  std::ofstream stream(path, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) return Error{ErrorCode::io, "cannot write " + path};
  return okStatus();
}

template <class T>
Result<T> parseNumber(const std::string& text, int base = 10) {
  T number{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  if (code != std::errc() || end != text.data() + text.size()) return Error{ErrorCode::badOption, "bad number " + text};
  return number;
}

Result<double> parseReal(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') return Error{ErrorCode::badOption, "bad number " + text};
  return number;
}

/// Arguments from `first` on as URI=FILE.
Result<Resources> readResources(const std::vector<std::string>& arguments, std::size_t first) {
  Resources resources;
  for (std::size_t i = first; i < arguments.size(); ++i) {
    const std::size_t equals = arguments[i].rfind('=');
    if (equals == std::string::npos) return Error{ErrorCode::badOption, "expected URI=FILE, got " + arguments[i]};
    auto bytes = readFile(arguments[i].substr(equals + 1));
    if (!bytes) return bytes.error();
    resources.emplace(arguments[i].substr(0, equals), std::move(*bytes));
  }
  return resources;
}

Result<Key> readKey(const std::string& path) {
  auto bytes = readFile(path);
  if (!bytes) return bytes.error();
  return parseKey(std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()));
}

Result<std::string> runEmbed(const std::vector<std::string>& arguments) {
  if (arguments.size() < 6) return Error{ErrorCode::badOption, "embed: IN OUT KEY (image PNG | id HEX | text TEXT) [--strength S] [URI=FILE ...]"};
  auto file = readFile(arguments[1]);
  if (!file) return file.error();
  auto key = readKey(arguments[3]);
  if (!key) return key.error();
  EmbedRequest request;
  request.key = std::move(*key);
  std::size_t next = 6;
  if (arguments.size() > next + 1 && arguments[next] == "--strength") {
    auto strength = robust::strengthFrom(arguments[next + 1]);
    if (!strength) return strength.error();
    request.robust.strength = *strength;
    next += 2;
  }
  auto resources = readResources(arguments, next);
  if (!resources) return resources.error();
  if (arguments[4] == "image") {
    auto png = readFile(arguments[5]);
    if (!png) return png.error();
    auto image = decodePng(*png);
    if (!image) return image.error();
    request.image = std::move(*image);
  } else if (arguments[4] == "text") {
    request.text = arguments[5];
  } else {
    auto id = parseNumber<std::uint64_t>(arguments[5], 16);
    if (!id) return id.error();
    request.id = *id;
  }
  auto response = embed(*file, *resources, request);
  if (!response) return response.error();
  if (Status status = writeFile(arguments[2], response->file.bytes); !status) return status.error();
  int number = 0;
  for (const auto& [uri, bytes] : response->file.resources) {
    if (Status status = writeFile(arguments[2] + "." + std::to_string(number++), bytes); !status) return status.error();
  }
  return response->reportJson;
}

Result<std::string> runExtract(const std::vector<std::string>& arguments) {
  if (arguments.size() < 3) return Error{ErrorCode::badOption, "extract: IN KEY [URI=FILE ...]"};
  auto file = readFile(arguments[1]);
  if (!file) return file.error();
  auto key = readKey(arguments[2]);
  if (!key) return key.error();
  auto resources = readResources(arguments, 3);
  if (!resources) return resources.error();
  ExtractRequest request;
  request.key = std::move(*key);
  auto response = extract(*file, *resources, request);
  if (!response) return response.error();
  // Everything the API returns beside the report, so that the parity test can compare all of it.
  json result;
  result["verdict"] = response->verdict;
  result["falsePositive"] = response->falsePositive;
  result["width"] = response->image.width;
  result["height"] = response->image.height;
  result["bits"] = response->image.bits;
  result["erased"] = response->erased;
  result["confidence"] = response->confidence;
  result["id"] = response->id ? json(std::to_string(*response->id)) : json(nullptr);
  result["text"] = response->text ? json(*response->text) : json(nullptr);
  result["evidence"] = response->evidence;
  result["report"] = json::parse(response->reportJson, nullptr, false);
  return result.dump();
}

Result<std::string> runInspect(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2) return Error{ErrorCode::badOption, "inspect: IN [URI=FILE ...]"};
  auto file = readFile(arguments[1]);
  if (!file) return file.error();
  auto resources = readResources(arguments, 2);
  if (!resources) return resources.error();
  return inspect(*file, *resources);
}

Result<std::string> writeMesh(const std::string& path, const Mesh& mesh) {
  const Bytes bytes = path.ends_with(".glb") ? lab::writeGlb(mesh) : lab::writePly(mesh);
  if (Status status = writeFile(path, bytes); !status) return status.error();
  return json{{"vertices", mesh.vertexCount()}, {"faces", mesh.faceCount()}}.dump();
}

Result<std::string> runAttack(const std::vector<std::string>& arguments) {
  if (arguments.size() != 8) return Error{ErrorCode::badOption, "attack: IN OUT KIND AMOUNT VARIANT ITERATIONS SEED"};
  auto file = readFile(arguments[1]);
  if (!file) return file.error();
  auto amount = parseReal(arguments[4]);
  if (!amount) return amount.error();
  auto iterations = parseNumber<int>(arguments[6]);
  if (!iterations) return iterations.error();
  auto seed = parseNumber<std::uint64_t>(arguments[7]);
  if (!seed) return seed.error();
  auto model = readModel(*file);
  if (!model) return model.error();
  auto mesh = lab::attack((*model)->mesh(), {arguments[3], *amount, arguments[5], *iterations, *seed});
  if (!mesh) return mesh.error();
  return writeMesh(arguments[2], *mesh);
}

Result<std::string> runGenerate(const std::vector<std::string>& arguments) {
  if (arguments.size() != 5) return Error{ErrorCode::badOption, "generate: OUT NAME VERTICES SEED"};
  auto vertices = parseNumber<std::size_t>(arguments[3]);
  if (!vertices) return vertices.error();
  auto seed = parseNumber<std::uint64_t>(arguments[4]);
  if (!seed) return seed.error();
  auto mesh = lab::generate(arguments[2], *vertices, *seed);
  if (!mesh) return mesh.error();
  return writeMesh(arguments[1], *mesh);
}

Result<std::string> run(const std::vector<std::string>& arguments) {
  const std::string command = arguments.empty() ? "" : arguments[0];
  if (command == "embed") return runEmbed(arguments);
  if (command == "extract") return runExtract(arguments);
  if (command == "inspect") return runInspect(arguments);
  if (command == "attack") return runAttack(arguments);
  if (command == "generate") return runGenerate(arguments);
  return Error{ErrorCode::badOption, "expected embed, extract, inspect, attack or generate"};
}

}  // namespace

int main(int count, char** values) {
  const auto result = run(std::vector<std::string>(values + 1, values + count));
  if (result) {
    std::printf("%s\n", result->c_str());
    return 0;
  }
  const json error = {{"error", {{"code", errorCodeName(result.error().code)}, {"message", result.error().message}}}};
  std::printf("%s\n", error.dump().c_str());
  return 1;
}
