// SPDX-License-Identifier: MIT
#include "fuzz/exercise.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fuzz/seeds.h"
#include "io/bytes.h"
#include "json_text.h"
#include "quadmark/adjacency.h"
#include "quadmark/embed.h"
#include "quadmark/extract.h"
#include "quadmark/quadmark.h"

namespace quadmark::test {
namespace {

/// A digest of the input, so that rare and slow work is done for some inputs and always for the same ones.
std::uint32_t digest(Bytes file) {
  std::uint32_t hash = 2166136261u;
  for (const std::uint8_t byte : file) hash = (hash ^ byte) * 16777619u;
  return hash ^ (hash >> 15);
}

Problem refusal(const Error& error) {
  if (error.code == ErrorCode::internal) return "internal: " + error.message;
  if (error.message.empty()) return "an error without a message";
  return "";
}

constexpr std::uint32_t kSearchOneIn = 8;

Key smallKey() {
  KeyRequest request;
  request.params.payload = PayloadType::id;
  request.params.width = 64;
  request.params.height = 1;
  return makeKey(request).value();
}

Problem checkReport(const std::string& report) {
  const Result<JsonValue> json = parseJson(report);
  return json.ok() && json->isObject() ? "" : "the report is no JSON object: " + report;
}

Problem mark(Bytes file, const Resources& resources) {
  const Result<std::string> facts = inspect(file, resources);
  if (!facts.ok()) return "read, but not inspected: " + facts.error().message;
  if (Problem problem = checkReport(*facts); !problem.empty()) return problem;

  ExtractRequest request{smallKey(), {}, {}};
  const Result<ExtractResponse> none = extract(file, resources, request);
  if (!none.ok()) return "read, but not extracted: " + none.error().message;
  if (Problem problem = checkReport(none->reportJson); !problem.empty()) return problem;

  constexpr std::uint32_t kEmbedOneIn = 8;
  if (digest(file) / kSearchOneIn % kEmbedOneIn != 0) return "";
  EmbedRequest embedding{request.key, {}, 0x0123456789abcdefu, {}};
  const Result<EmbedResponse> marked = embed(file, resources, embedding);
  if (!marked.ok()) return refusal(marked.error());
  return checkReport(marked->reportJson);
}

Problem patch(const Model& model, Bytes file, const Resources& resources) {
  Mesh moved = model.mesh();
  for (double& value : moved.positions) value = value * 0.75 + 0.1;
  roundToPrecision(moved);
  const Result<PatchedFile> patched = model.patch(file, resources, moved.positions);
  if (!patched.ok()) {
    // Reading needs the positions alone; patching takes every attribute out of the compressed stream.
    const bool isDraco = io::asText(file).find("KHR_draco_mesh_compression") != std::string_view::npos;
    const ErrorCode code = patched.error().code;
    const bool refused = code == ErrorCode::unsupportedFile || (isDraco && code == ErrorCode::badFile);
    return refused ? "" : "read, but not patched: " + patched.error().message;
  }
  Resources changed = resources;
  for (const auto& entry : patched->resources) changed[entry.first] = entry.second;
  const Result<std::unique_ptr<Model>> again = readModel(patched->bytes, changed);
  if (!again.ok()) {
    // Tiny extents vanish beside the shift.
    return again.error().code == ErrorCode::badMesh ? "" : "patched, but not read back: " + again.error().message;
  }
  if ((*again)->mesh().positions != moved.positions) return "patched positions read back differently";
  if ((*again)->mesh().faceVertices != moved.faceVertices) return "patched faces read back differently";
  const std::optional<TextureShift> shift = textureShift(patched->bytes, changed, model.mesh().positions);
  if (shift && (!(shift->uv >= 0) || !(shift->texels.value_or(0) >= 0))) return "a texture shifts by less than nothing";
  return "";
}

Problem reorder(const Model& model, Bytes file, const Resources& resources) {
  const Result<OrderFreedom> freedom = model.orderFreedom(file, resources);
  if (!freedom.ok()) return refusal(freedom.error());
  std::vector<std::uint32_t> order(model.mesh().vertexCount());
  std::iota(order.begin(), order.end(), 0u);
  for (const VertexRange& range : freedom->ranges) {
    if (range.count > order.size() || range.first > order.size() - range.count) return "a range beyond the vertices";
    std::reverse(order.begin() + range.first, order.begin() + range.first + range.count);
  }
  const Result<PatchedFile> reordered = model.reorder(file, resources, order);
  const bool fixed = freedom->ranges.empty();
  if (!reordered.ok() && fixed && reordered.error().code == ErrorCode::unsupportedFile) return "";
  if (!reordered.ok()) return "free to be reordered, but refused: " + reordered.error().message;
  return "";
}

/// Reads numbers off a span; zeros behind its end.
class Source {
 public:
  explicit Source(Bytes bytes) : bytes_(bytes) {}

  template <class T>
  T take() {
    T value{};
    if (bytes_.size() < sizeof(T)) {
      bytes_ = {};
      return value;
    }
    value = io::load<T>(bytes_.data());
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }

 private:
  Bytes bytes_;
};

Problem exercise(Bytes file, const Resources& resources, bool searchToo) {
  if (const Result<std::vector<std::string>> uris = externalUris(file); !uris.ok()) {
    if (Problem problem = refusal(uris.error()); !problem.empty()) return problem;
  }
  const Result<std::unique_ptr<Model>> model = readModel(file, resources);
  if (!model.ok()) return refusal(model.error());
  const Mesh& mesh = (*model)->mesh();
  if (const Status status = validate(mesh); !status.ok()) return "an invalid mesh was read: " + status.error().message;
  if (Problem problem = patch(**model, file, resources); !problem.empty()) return problem;
  if (Problem problem = reorder(**model, file, resources); !problem.empty()) return problem;
  constexpr std::size_t kMostCorners = 600;  // the search is for files that are whole, and costs more than reading
  return searchToo && mesh.faceVertices.size() <= kMostCorners ? mark(file, resources) : "";
}

const Resources& sharedResources() {
  static const Resources resources = seedResources();
  return resources;
}

}  // namespace

Problem exerciseModel(Bytes file, const Resources& resources) { return exercise(file, resources, true); }
Problem exerciseModel(Bytes file) { return exercise(file, sharedResources(), true); }

Problem exerciseReading(Bytes file) {
  return exercise(file, sharedResources(), digest(file) % kSearchOneIn == 0);
}

Problem exerciseKey(Bytes file) {
  const Result<Key> key = parseKey(io::asText(file));
  if (!key.ok()) return refusal(key.error());
  const std::string text = formatKey(*key);
  const Result<Key> again = parseKey(text);
  if (!again.ok()) return "written, but not parsed: " + again.error().message;
  return formatKey(*again) == text ? "" : "written differently the second time: " + text;
}

Problem exercisePng(Bytes file) {
  const Result<BitImage> image = decodePng(file);
  if (!image.ok()) return refusal(image.error());
  if (image->bits.size() != std::size_t{image->width} * image->height) return "a picture of the wrong size";
  ThresholdOptions half;
  half.threshold = 0.5;
  const Result<BitImage> again = decodePng(encodePng(*image), half);
  if (!again.ok()) return "encoded, but not decoded: " + again.error().message;
  return again->bits == image->bits ? "" : "decoded differently the second time";
}

Problem exerciseMesh(Bytes file) {
  Source source(file);
  Mesh mesh;
  const std::uint8_t kind = source.take<std::uint8_t>();
  mesh.precision = kind % 2 == 0 ? Precision::float32 : Precision::float64;
  // Enough for a 64-bit mark; marking any more takes too long to see many inputs.
  const std::size_t vertices = 3 + source.take<std::uint8_t>() % 80;
  const std::size_t faces = 1 + source.take<std::uint8_t>() % 160;
  for (std::size_t corner = 0; corner < 3 * faces; ++corner) {
    mesh.faceVertices.push_back(source.take<std::uint8_t>() % static_cast<std::uint32_t>(vertices));
  }
  for (std::size_t i = 0; i < 3 * vertices; ++i) {
    // Small integers on a grid, which make coplanar sets and ties, or any number at all.
    const double value = kind & 2   ? source.take<std::int8_t>() / 8.0
                         : kind & 4 ? source.take<double>()
                                    : static_cast<double>(source.take<float>());
    mesh.positions.push_back(std::isfinite(value) ? value : 0);
  }
  // As the readers have it: what float32 cannot hold does not come from a file.
  if (mesh.precision == Precision::float32) {
    for (double& value : mesh.positions) value = std::clamp(value, -3.4e38, 3.4e38);
  }
  roundToPrecision(mesh);
  if (boundingDiagonal(mesh) == 0) return "";

  const Key key = smallKey();
  const std::vector<std::uint8_t> bits(64, 1);
  const Result<MarkedMesh> marked = embedMesh(mesh, bits, key);
  if (!marked.ok()) return refusal(marked.error());
  Mesh output = mesh;
  output.positions = marked->positions;
  if (const Status status = validate(output); !status.ok()) return "marked badly: " + status.error().message;
  roundToPrecision(output);
  if (output.positions != marked->positions) return "marked positions are not of the mesh's precision";
  const WeldedMesh welded = weld(output);
  const Extraction read = extractMesh(welded, welded.positions, roundingOf(output.precision), key);
  if (marked->guarantees.unattacked && read.bits != bits) return "verified, but read differently";
  return "";
}

}  // namespace quadmark::test
