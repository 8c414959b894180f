// SPDX-License-Identifier: MIT
// The calls on bytes for the robust scheme.
#include <algorithm>
#include <utility>

#include "quadmark/exact_math.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/robust/mesh_source.h"
#include "quadmark/robust/self_test.h"
#include "quadmark_calls.h"
#include "report_robust.h"

namespace quadmark {
namespace {

using robust::BodyRate;
using robust::CodedPayload;
using robust::Payload;
using robust::PayloadBits;
using robust::RobustEmbedding;
using robust::SchemeKeys;

// A pixel whose log odds are below this is marked as unread, as in the other scheme.
constexpr float kLeastRatio = 0.2f;
// Head positions that one layer must reach: one and a half times the information.
constexpr std::uint32_t kLeastPositions = robust::kFrameBits * 3 / 2;

Result<Payload> payloadOf(const EmbedRequest& request) {
  if (int{request.image.has_value()} + int{request.id.has_value()} + int{request.text.has_value()} != 1)
    return Error{ErrorCode::badOption, "give either an image or an id or a text to embed"};
  if (request.image) return Payload{*request.image};
  if (request.id) return Payload{*request.id};
  return Payload{*request.text};
}

/// Coded forms of a body to try, the most robust that could fit first: a vote per coded bit and more is worth a code,
/// fewer are better spent on the pixels themselves.
std::vector<BodyRate> ratesFor(const Mesh& mesh, const PayloadBits& bits, const SchemeKeys& keys) {
  if (bits.body.empty()) return {BodyRate::half};
  const robust::MeshReader reader(mesh, keys.geometry, robust::headCode());
  const double votes = 2.0 * reader.coverage().labels / static_cast<double>(bits.body.size());
  if (votes >= 12) return {BodyRate::third, BodyRate::half, BodyRate::plain};
  return {BodyRate::half, BodyRate::plain};
}

struct Marked {
  PayloadBits bits;
  CodedPayload coded;
  RobustEmbedding embedding;
  robust::SelfTest unattacked;
};

Error tooSmall(const Marked& marked, bool readable) {
  const RobustEmbedding& e = marked.embedding;
  const std::string counts = std::to_string(e.carriers) + " carriers and " + std::to_string(e.cells) + " cells hold " +
                             std::to_string(std::max(e.ringPositions, e.diamondPositions)) + " of the " +
                             std::to_string(marked.coded.head.size()) + " bits that identify the mark";
  if (!readable)
    return {ErrorCode::capacity, counts + ": the payload does not read back" +
                                     (marked.bits.body.empty() ? "" : "; a smaller image or an ID may fit")};
  return {ErrorCode::capacity, counts + ", at least " + std::to_string(kLeastPositions) + " are needed"};
}

Result<Marked> markMesh(const Mesh& mesh, const Payload& payload, const SchemeKeys& keys, const EmbedRequest& request) {
  const robust::EmbedOptions options{request.robust.strength, request.robust.maxErrorRel, request.robust.maxSlideRel,
                                     request.progress};
  const auto strength = static_cast<std::uint8_t>(request.robust.strength);
  auto bits = robust::bitsOf(payload, BodyRate::half, strength, keys);
  if (!bits) return bits.error();
  Marked marked;
  for (const BodyRate rate : ratesFor(mesh, *bits, keys)) {
    auto atRate = robust::bitsOf(payload, rate, strength, keys);
    if (!atRate) return atRate.error();
    marked.bits = std::move(*atRate);
    marked.coded = robust::encode(marked.bits, keys);
    auto embedding = robust::embedRobust(mesh, marked.coded, keys.geometry, options);
    if (!embedding) return embedding.error();
    marked.embedding = std::move(*embedding);
    Mesh after = mesh;
    after.positions = marked.embedding.positions;
    roundToPrecision(after);  // integer grids are coarser than what the layers round to
    marked.embedding.positions = after.positions;
    if (!tell(request.progress, "verify", 0.9)) return cancelled();
    marked.unattacked = robust::readBack(after, marked.bits, keys);
    if (marked.unattacked.read) break;
  }
  if (!marked.unattacked.read) return tooSmall(marked, false);
  if (std::max(marked.embedding.ringPositions, marked.embedding.diamondPositions) < kLeastPositions)
    return tooSmall(marked, true);
  return marked;
}

std::vector<std::string> warningsFor(const Model& model, const Marked& marked) {
  std::vector<std::string> warnings = model.info().warnings;
  const RobustEmbedding& e = marked.embedding;
  if (e.ringPositions < kLeastPositions)
    warnings.push_back("few vertices have a neighbourhood of their own kind: noise and quantization below 14 bits will "
                       "destroy this mark");
  if (e.cells < e.goodCells) warnings.push_back("too few cells: the mark will not survive simplification");
  return warnings;
}

std::optional<Payload> expectedOf(const ExtractRequest& request) {
  if (request.reference) return Payload{*request.reference};
  if (request.expectedId) return Payload{*request.expectedId};
  if (request.expectedText) return Payload{*request.expectedText};
  return std::nullopt;
}

// Bits, erasures and confidences of an image as far as it was read.
void showImage(const robust::MarkReading& reading, ExtractResponse& response) {
  if (!reading.frame || !reading.body) return;
  const auto shape = robust::bodyShape(*reading.frame);
  if (!shape || shape->kind != robust::PayloadKind::image) return;
  BitImage image{shape->width, shape->height, reading.body->bits};
  response.erased.resize(image.bits.size());
  response.confidence.resize(image.bits.size());
  for (std::size_t i = 0; i < image.bits.size(); ++i) {
    const float ratio = reading.body->ratios[i] < 0 ? -reading.body->ratios[i] : reading.body->ratios[i];
    response.erased[i] = ratio < kLeastRatio ? 1 : 0;
    if (response.erased[i] != 0) image.bits[i] = 0;
    const double odds = exactExp(-ratio);
    response.confidence[i] = static_cast<float>((1 - odds) / (1 + odds));  // |P(1) - P(0)|
  }
  response.image = std::move(image);
}

struct Evidence {
  std::uint32_t vertices = 0;
  std::vector<NodeCells> perNode;  ///< nodes that share a mesh share its evidence
};

Evidence evidenceOf(const Model& model, const std::vector<float>& perVertex) {
  Evidence out;
  std::vector<std::uint32_t> count;
  std::vector<double> weight;
  double total = 0;
  for (std::size_t v = 0; v < perVertex.size(); ++v) {
    if (perVertex[v] == 0) continue;
    ++out.vertices;
    if (model.vertexMesh().empty()) continue;
    const std::uint32_t mesh = model.vertexMesh()[v];
    if (mesh >= count.size()) count.resize(mesh + 1, 0), weight.resize(mesh + 1, 0);
    ++count[mesh];
    if (perVertex[v] < 0) continue;
    weight[mesh] += double{perVertex[v]};
    total += double{perVertex[v]};
  }
  for (const Model::NodeRef& node : model.nodes()) {
    NodeCells cells{node.node, node.name, node.mesh};
    if (node.mesh < count.size()) {
      cells.cells = count[node.mesh];
      cells.share = total > 0 ? weight[node.mesh] / total : 0;
    }
    out.perNode.push_back(std::move(cells));
  }
  return out;
}

}  // namespace

Result<EmbedResponse> embedRobustFile(std::span<const std::uint8_t> file, const Resources& resources,
                                      const EmbedRequest& request) {
  const auto payload = payloadOf(request);
  if (!payload) return payload.error();
  const auto keys = robust::deriveKeys(request.key.secret, request.robust.salt);
  if (!keys) return keys.error();
  if (!tell(request.progress, "read", 0)) return cancelled();
  auto model = readModel(file, resources);
  if (!model) return model.error();
  const Mesh& mesh = (*model)->mesh();

  auto marked = markMesh(mesh, *payload, *keys, request);
  if (!marked) return marked.error();
  std::vector<robust::SelfTest> tests;
  if (request.robust.selfTest) {
    if (!tell(request.progress, "self-test", 0.92)) return cancelled();
    Mesh after = mesh;
    after.positions = marked->embedding.positions;
    tests = robust::selfTest(after, marked->bits, *keys);
  }
  if (!tell(request.progress, "report", 0.97)) return cancelled();
  const Distortion measured = distortion(mesh, marked->embedding.positions, weld(mesh), boundingDiagonal(mesh));

  EmbedResponse response;
  auto patched = (*model)->patch(file, resources, marked->embedding.positions);
  if (!patched) return patched.error();
  response.file = std::move(*patched);
  std::vector<std::string> warnings = warningsFor(**model, *marked);
  warnings.insert(warnings.end(), response.file.warnings.begin(), response.file.warnings.end());
  response.reportJson = formatReport(RobustEmbedReport{marked->bits, marked->coded, marked->embedding,
                                                       request.robust.strength, measured, marked->unattacked, tests,
                                                       response.file.bytesChanged, warnings});
  tell(request.progress, "report", 1);
  return response;
}

Result<ExtractResponse> extractRobustFile(std::span<const std::uint8_t> file, const Resources& resources,
                                          const ExtractRequest& request) {
  const auto keys = robust::deriveKeys(request.key.secret, request.salt);
  if (!keys) return keys.error();
  const int expectations = int{request.reference.has_value()} + int{request.expectedId.has_value()} +
                           int{request.expectedText.has_value()};
  if (expectations > 1) return Error{ErrorCode::badOption, "give at most one of reference image, expected id and expected text"};
  if (!tell(request.progress, "read", 0)) return cancelled();
  auto model = readModel(file, resources);
  if (!model) return model.error();
  if (!tell(request.progress, "search", 0.2)) return cancelled();

  robust::MeshReader reader((*model)->mesh(), keys->geometry, robust::headCode());
  robust::MeshSource source(reader);
  robust::ReadRequest read{*keys, expectedOf(request)};
  read.progress = [&](double done) { return tell(request.progress, "search", 0.2 + 0.7 * done); };
  auto reading = robust::readMark(source, read);
  if (!reading) return reading.error();
  if (reading->cancelled || !tell(request.progress, "report", 0.95)) return cancelled();

  ExtractResponse response;
  response.verdict = verdictName(reading->verdict);
  response.falsePositive = reading->falsePositive;
  response.id = reading->id();
  response.text = reading->text();
  showImage(*reading, response);
  std::optional<double> ber;
  if (request.reference && !response.erased.empty() && response.erased.size() == request.reference->bits.size())
    ber = bitErrorRate(request.reference->bits, response.image.bits, response.erased);
  if (reading->frame && reading->hypothesis) {
    const auto shape = robust::bodyShape(*reading->frame);
    PayloadBits bits{*reading->frame, {}};
    if (shape) bits.body = reading->body ? reading->body->bits : std::vector<std::uint8_t>(shape->bits(), 0);
    response.evidence = reader.evidence(robust::encode(bits, *keys), *reading->hypothesis);
  }
  const Evidence evidence = evidenceOf(**model, response.evidence);
  response.reportJson = formatReport(RobustExtractReport{*reading, reader.coverage(), response.image, response.erased, ber,
                                                         evidence.vertices, evidence.perNode,
                                                         (*model)->info().warnings});
  tell(request.progress, "report", 1);
  return response;
}

}  // namespace quadmark
