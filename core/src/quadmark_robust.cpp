// SPDX-License-Identifier: MIT
// The calls on bytes for the robust scheme.
#include <algorithm>
#include <utility>

#include "quadmark/exact_math.h"
#include "quadmark/robust/marker.h"
#include "quadmark/robust/parts.h"
#include "quadmark_calls.h"
#include "report_robust.h"

namespace quadmark {
namespace {

using robust::kLeastPositions;
using robust::MarkedMesh;
using robust::Payload;
using robust::RobustEmbedding;

Result<Payload> payloadOf(const EmbedRequest& request) {
  if (int{request.image.has_value()} + int{request.id.has_value()} + int{request.text.has_value()} != 1)
    return Error{ErrorCode::badOption, "give either an image or an id or a text to embed"};
  if (request.image) return Payload{*request.image};
  if (request.id) return Payload{*request.id};
  return Payload{*request.text};
}

std::vector<std::string> warningsFor(const Model& model, const MarkedMesh& marked) {
  std::vector<std::string> warnings = model.info().warnings;
  const RobustEmbedding& e = marked.embedding;
  if (e.ringPositions < kLeastPositions)
    warnings.push_back("few vertices have a neighbourhood of their own kind: noise and quantization below 14 bits will "
                       "destroy this mark");
  if (e.cells < e.goodCells) warnings.push_back("too few cells: the mark will not survive simplification");
  return warnings;
}

std::optional<TextureShift> shiftOf(const PatchedFile& marked, const Resources& resources,
                                    const std::vector<double>& before) {
  if (marked.resources.empty()) return textureShift(marked.bytes, resources, before);
  Resources after = marked.resources;
  after.insert(resources.begin(), resources.end());  // keeps those that changed
  return textureShift(marked.bytes, after, before);
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
    response.erased[i] = robust::isUnread(ratio) ? 1 : 0;
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

  const robust::EmbedOptions options{request.robust.strength, request.robust.maxErrorRel, request.robust.maxSlideRel,
                                     request.progress};
  auto marked = robust::markMesh(mesh, *payload, *keys, options);
  if (!marked) return marked.error();
  std::vector<robust::SelfTest> tests;
  if (request.robust.selfTest) {
    if (!tell(request.progress, "self-test", 0.92)) return cancelled();
    Mesh after = mesh;
    after.positions = marked->embedding.positions;
    tests = robust::selfTest(after, marked->bits, *keys);
  }
  if (!tell(request.progress, "report", 0.97)) return cancelled();
  const RobustEmbedding& e = marked->embedding;
  const Distortion measured = distortion(mesh, e.positions, marked->welding, e.diagonal);

  EmbedResponse response;
  auto patched = (*model)->patch(file, resources, e.positions);
  if (!patched) return patched.error();
  response.file = std::move(*patched);
  const std::optional<TextureShift> shift = shiftOf(response.file, resources, mesh.positions);
  std::vector<std::string> warnings = warningsFor(**model, *marked);
  warnings.insert(warnings.end(), response.file.warnings.begin(), response.file.warnings.end());
  response.reportJson =
      formatReport(RobustEmbedReport{marked->bits, marked->coded, marked->embedding, request.robust.strength, measured,
                                     e.largestSlide / e.diagonal, shift, marked->unattacked, tests,
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

  robust::SceneRequest read{*keys, expectedOf(request)};
  read.progress = [&](double done) { return tell(request.progress, "search", 0.2 + 0.7 * done); };
  auto scene = robust::readScene((*model)->mesh(), read);
  if (!scene) return scene.error();
  const robust::MarkReading& reading = scene->reading;
  if (reading.cancelled || !tell(request.progress, "report", 0.95)) return cancelled();

  ExtractResponse response;
  response.verdict = verdictName(reading.verdict);
  response.falsePositive = reading.falsePositive;
  response.id = reading.id();
  response.text = reading.text();
  showImage(reading, response);
  std::optional<double> ber;
  if (request.reference && !response.erased.empty() && response.erased.size() == request.reference->bits.size())
    ber = bitErrorRate(request.reference->bits, response.image.bits, response.erased);
  response.evidence = std::move(scene->evidence);
  const Evidence evidence = evidenceOf(**model, response.evidence);
  response.reportJson = formatReport(RobustExtractReport{*scene, response.image, response.erased, ber,
                                                         evidence.vertices, evidence.perNode,
                                                         (*model)->info().warnings});
  tell(request.progress, "report", 1);
  return response;
}

}  // namespace quadmark
