// SPDX-License-Identifier: MIT
// The product's binding table. Each function converts, calls the core, converts back, and decides nothing itself.
#include <emscripten/bind.h>

#include <utility>

#include "convert.h"

namespace quadmark::wasm {
namespace {

/// Members that only keys of scheme `robust` take; fails with badOption for others.
Status robustOptionsFrom(const val& request, const Key& key, RobustOptions& options) {
  for (const char* name : {"strength", "maxError", "maxSlide", "salt", "selfTest"}) {
    if (key.scheme != "robust" && isPresent(request[name])) {
      return Error{ErrorCode::badOption, std::string(name) + ": only with a key of scheme \"robust\""};
    }
  }
  if (isPresent(request["strength"])) {
    const auto strength = robust::strengthFrom(request["strength"].as<std::string>());
    if (!strength) return strength.error();
    options.strength = *strength;
  }
  for (const auto& [name, target] : {std::pair("maxError", &options.maxErrorRel), std::pair("maxSlide", &options.maxSlideRel)}) {
    const auto number = numberFrom(request, name, 0);
    if (!number) return number.error();
    *target = *number;
  }
  if (isPresent(request["salt"])) options.salt = request["salt"].as<std::string>();
  options.selfTest = isPresent(request["selfTest"]) && request["selfTest"].as<bool>();
  return okStatus();
}

/// request: { key: JSON text, image?: PNG bytes or bits, id?: 16 hex digits, text?, strength?, maxError?, maxSlide?, salt?,
/// selfTest?, progress?: function }
val embedModel(const val& file, const val& resourceEntries, const val& request) {
  auto key = parseKey(request["key"].as<std::string>());
  if (!key) return failure(key.error());
  EmbedRequest embedRequest;
  embedRequest.key = std::move(*key);
  if (isPresent(request["image"])) {
    auto image = imageFrom(request["image"]);
    if (!image) return failure(image.error());
    embedRequest.image = std::move(*image);
  }
  if (isPresent(request["id"])) embedRequest.id = idFrom(request["id"].as<std::string>());
  if (isPresent(request["text"])) embedRequest.text = request["text"].as<std::string>();
  if (Status status = robustOptionsFrom(request, embedRequest.key, embedRequest.robust); !status) {
    return failure(status.error());
  }
  embedRequest.progress = progressFrom(request["progress"]);

  auto response = embed(bytesFrom(file), resourcesFrom(resourceEntries), embedRequest);
  if (!response) return failure(response.error());
  val result = val::object();
  result.set("bytes", arrayFrom<std::uint8_t>(response->file.bytes));
  result.set("resources", entriesFrom(response->file.resources));
  result.set("report", response->reportJson);
  return result;
}

/// request: { key: JSON text, reference?: PNG bytes or bits, expectId?: 16 hex digits, expectText?, salt?,
/// progress?: function }
val extractMark(const val& file, const val& resourceEntries, const val& request) {
  auto key = parseKey(request["key"].as<std::string>());
  if (!key) return failure(key.error());
  ExtractRequest extractRequest;
  extractRequest.key = std::move(*key);
  if (isPresent(request["reference"])) {
    auto reference = imageFrom(request["reference"]);
    if (!reference) return failure(reference.error());
    extractRequest.reference = std::move(*reference);
  }
  if (isPresent(request["expectId"])) extractRequest.expectedId = idFrom(request["expectId"].as<std::string>());
  if (isPresent(request["expectText"])) extractRequest.expectedText = request["expectText"].as<std::string>();
  RobustOptions options;
  if (Status status = robustOptionsFrom(request, extractRequest.key, options); !status) return failure(status.error());
  extractRequest.salt = options.salt;
  extractRequest.progress = progressFrom(request["progress"]);

  auto response = extract(bytesFrom(file), resourcesFrom(resourceEntries), extractRequest);
  if (!response) return failure(response.error());
  val image = val::null();
  if (response->image.width != 0) {
    image = imageTo(response->image);
    image.set("erased", arrayFrom<std::uint8_t>(response->erased));
    image.set("confidence", arrayFrom<float>(response->confidence));
    image.set("png", arrayFrom<std::uint8_t>(encodePng(response->image, response->erased)));
    image.set("confidencePng", arrayFrom<std::uint8_t>(encodeGreyPng(response->image.width, response->image.height,
                                                                     response->confidence)));
  }
  val result = val::object();
  result.set("verdict", response->verdict);
  result.set("falsePositive", response->falsePositive);
  result.set("image", image);
  result.set("id", response->id ? val(idTo(*response->id)) : val::null());
  result.set("text", response->text ? val(*response->text) : val::null());
  result.set("evidence", arrayFrom<float>(response->evidence));
  result.set("report", response->reportJson);
  return result;
}

val inspectModel(const val& file, const val& resourceEntries) {
  auto report = inspect(bytesFrom(file), resourcesFrom(resourceEntries));
  if (!report) return failure(report.error());
  val result = val::object();
  result.set("report", *report);
  return result;
}

/// { uris: [...] } of the external buffers a model refers to.
val listExternalUris(const val& file) {
  auto uris = externalUris(bytesFrom(file));
  if (!uris) return failure(uris.error());
  val list = val::array();
  for (const std::string& uri : *uris) list.call<void>("push", uri);
  val result = val::object();
  result.set("uris", list);
  return result;
}

val keyOf(const Result<Key>& key) {
  if (!key) return failure(key.error());
  val result = val::object();
  result.set("key", formatKey(*key));
  return result;
}

/// request: { secret: 32 bytes, owner?, scheme: "paper" | "robust", and for "paper" payload: "image" | "id", width?, height?, L?, H1, L1, H2, L2 (all four or none),
/// lambda?, tau?, k?, keyedCells?, scrambleOrder? } -> { key: JSON text }
val createKey(const val& request) {
  KeyRequest keyRequest;
  const std::vector<std::uint8_t> secret = bytesFrom(request["secret"]);
  if (secret.size() != keyRequest.secret.size()) {
    return failure({ErrorCode::badOption, "secret: expected 32 bytes, got " + std::to_string(secret.size())});
  }
  for (std::size_t i = 0; i < secret.size(); ++i) keyRequest.secret[i] = secret[i];
  if (isPresent(request["owner"])) keyRequest.owner = request["owner"].as<std::string>();
  keyRequest.scheme = request["scheme"].as<std::string>();
  if (keyRequest.scheme != "paper") return keyOf(makeKey(keyRequest));

  PaperParams& params = keyRequest.params;
  const bool isId = request["payload"].as<std::string>() == "id";
  params.payload = isId ? PayloadType::id : PayloadType::image;
  Error problem;
  bool failed = false;
  const auto keep = [&](const Result<double>& number) {
    if (!number && !failed) {
      failed = true;
      problem = number.error();
    }
    return number ? *number : 0.0;
  };
  const auto integer = [&](const char* name, int fallback, int low, int high) {
    return static_cast<int>(keep(integerFrom(request, name, fallback, low, high)));
  };
  params.width = isId ? 64 : static_cast<std::uint32_t>(integer("width", 0, 1, kMaxImageSide));
  params.height = isId ? 1 : static_cast<std::uint32_t>(integer("height", 0, 1, kMaxImageSide));
  params.L1 = params.L2 = integer("L", params.L1, 2, 8);
  keyRequest.chooseDigits = !isPresent(request["H1"]);
  params.H1 = integer("H1", params.H1, 2, 9);
  params.L1 = integer("L1", params.L1, 2, 9);
  params.H2 = integer("H2", params.H2, 2, 9);
  params.L2 = integer("L2", params.L2, 2, 9);
  params.k = integer("k", params.k, 1, 3);
  params.lambda = keep(numberFrom(request, "lambda", params.lambda));
  params.tau = keep(numberFrom(request, "tau", params.tau));
  params.keyedCells = isPresent(request["keyedCells"]) && request["keyedCells"].as<bool>();
  params.scrambleOrder = isPresent(request["scrambleOrder"]) && request["scrambleOrder"].as<bool>();
  if (failed) return failure(problem);

  return keyOf(makeKey(keyRequest));
}

/// Checks a key file and writes it in its normal form: { key: JSON text }.
val normalizeKey(const std::string& json) {
  return keyOf(parseKey(json));
}

/// { image } of a PNG; threshold < 0 lets Otsu's method choose.
val decodeImage(const val& png, double threshold) {
  ThresholdOptions options;
  options.threshold = threshold;
  auto image = decodePng(bytesFrom(png), options);
  if (!image) return failure(image.error());
  val result = val::object();
  result.set("image", imageTo(*image));
  return result;
}

/// { png } of { width, height, bits, erased? }.
val encodeImage(const val& value) {
  auto image = imageFrom(value);
  if (!image) return failure(image.error());
  std::vector<std::uint8_t> erased;
  if (isPresent(value["erased"])) erased = bytesFrom(value["erased"]);
  if (!erased.empty() && erased.size() != image->bits.size()) {
    return failure({ErrorCode::badImage, "image: erased and bits differ in length"});
  }
  val result = val::object();
  result.set("png", arrayFrom<std::uint8_t>(encodePng(*image, erased)));
  return result;
}

/// Every code in the order of the enumeration, for the test that compares the tables.
val errorCodes() {
  val list = val::array();
  for (int code = 0; code <= static_cast<int>(ErrorCode::internal); ++code) {
    list.call<void>("push", std::string(errorCodeName(static_cast<ErrorCode>(code))));
  }
  return list;
}

std::string versionText() { return version(); }

}  // namespace

EMSCRIPTEN_BINDINGS(quadmark) {
  installNewHandler();
  emscripten::function("embed", &embedModel);
  emscripten::function("extract", &extractMark);
  emscripten::function("inspect", &inspectModel);
  emscripten::function("externalUris", &listExternalUris);
  emscripten::function("createKey", &createKey);
  emscripten::function("parseKey", &normalizeKey);
  emscripten::function("decodeImage", &decodeImage);
  emscripten::function("encodeImage", &encodeImage);
  emscripten::function("errorCodes", &errorCodes);
  emscripten::function("version", &versionText);
}

}  // namespace quadmark::wasm
