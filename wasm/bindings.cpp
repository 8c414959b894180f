// SPDX-License-Identifier: MIT
// The product's binding table. Each function converts, calls the core, converts back, and decides nothing itself.
#include <emscripten/bind.h>

#include "convert.h"

namespace quadmark::wasm {
namespace {

/// request: { key: JSON text, image?: PNG bytes or bits, id?: 16 hex digits, progress?: function }
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
  embedRequest.progress = progressFrom(request["progress"]);

  auto response = embed(bytesFrom(file), resourcesFrom(resourceEntries), embedRequest);
  if (!response) return failure(response.error());
  val result = val::object();
  result.set("bytes", arrayFrom<std::uint8_t>(response->file.bytes));
  result.set("resources", entriesFrom(response->file.resources));
  result.set("report", response->reportJson);
  return result;
}

/// request: { key: JSON text, reference?: PNG bytes or bits, progress?: function }
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
  extractRequest.progress = progressFrom(request["progress"]);

  auto response = extract(bytesFrom(file), resourcesFrom(resourceEntries), extractRequest);
  if (!response) return failure(response.error());
  val image = imageTo(response->image);
  image.set("erased", arrayFrom<std::uint8_t>(response->erased));
  image.set("confidence", arrayFrom<float>(response->confidence));
  image.set("png", arrayFrom<std::uint8_t>(encodePng(response->image, response->erased)));
  image.set("confidencePng", arrayFrom<std::uint8_t>(encodeGreyPng(response->image.width, response->image.height,
                                                                   response->confidence)));
  val result = val::object();
  result.set("verdict", response->verdict);
  result.set("falsePositive", response->falsePositive);
  result.set("image", image);
  result.set("id", response->id ? val(idTo(*response->id)) : val::null());
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

/// request: { secret: 32 bytes, owner?, payload: "image" | "id", width?, height?, L?, H1, L1, H2, L2 (all four or none),
/// lambda?, tau?, k?, keyedCells?, scrambleOrder? } -> { key: JSON text }
val createKey(const val& request) {
  KeyRequest keyRequest;
  const std::vector<std::uint8_t> secret = bytesFrom(request["secret"]);
  if (secret.size() != keyRequest.secret.size()) {
    return failure({ErrorCode::badOption, "secret: expected 32 bytes, got " + std::to_string(secret.size())});
  }
  for (std::size_t i = 0; i < secret.size(); ++i) keyRequest.secret[i] = secret[i];
  if (isPresent(request["owner"])) keyRequest.owner = request["owner"].as<std::string>();

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

  auto key = makeKey(keyRequest);
  if (!key) return failure(key.error());
  val result = val::object();
  result.set("key", formatKey(*key));
  return result;
}

/// Checks a key file and writes it in its normal form: { key: JSON text }.
val normalizeKey(const std::string& json) {
  auto key = parseKey(json);
  if (!key) return failure(key.error());
  val result = val::object();
  result.set("key", formatKey(*key));
  return result;
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
