// SPDX-License-Identifier: MIT
// The calls on bytes: read the file, run the scheme on its mesh, patch the file, report.
#include "quadmark/quadmark.h"

#include <algorithm>
#include <numeric>

#include "concat.h"
#include "quadmark/adjacency.h"
#include "quadmark/embed.h"
#include "quadmark/extract_parts.h"
#include "quadmark/metrics.h"
#include "quadmark/prf.h"
#include "quadmark/robust/frame.h"
#include "quadmark/robust/reader.h"
#include "quadmark_calls.h"

namespace quadmark {
namespace {

// Cells per glTF node, by the mesh that the vertex of each cell belongs to. Nodes that share a mesh share its cells.
// @param evidenceOf  what a cell says, >= 0.
template <class Cells, class VertexOf, class EvidenceOf>
std::vector<NodeCells> cellsPerNode(const Model& model, const WeldedMesh& welded, const Cells& cells,
                                    const VertexOf& vertexOf, const EvidenceOf& evidenceOf) {
  std::vector<NodeCells> out;
  if (model.nodes().empty()) return out;
  std::vector<std::uint32_t> meshOfWelded(welded.vertexCount(), 0);
  std::uint32_t meshes = 0;
  for (std::size_t v = 0; v < welded.weldedOf.size(); ++v) {
    if (welded.weldedOf[v] == kNoVertex) continue;
    meshes = std::max(meshes, model.vertexMesh()[v] + 1);
    meshOfWelded[welded.weldedOf[v]] = model.vertexMesh()[v];
  }
  std::vector<std::uint32_t> count(meshes, 0);
  std::vector<double> evidence(meshes, 0);
  double total = 0;
  for (const auto& cell : cells) {
    const std::uint32_t mesh = meshOfWelded[vertexOf(cell)];
    ++count[mesh];
    evidence[mesh] += evidenceOf(cell);
    total += evidenceOf(cell);
  }
  for (const Model::NodeRef& node : model.nodes()) {
    const bool drawn = node.mesh < meshes;
    out.push_back({node.node, node.name, node.mesh, drawn ? count[node.mesh] : 0,
                   drawn && total > 0 ? evidence[node.mesh] / total : 0});
  }
  return out;
}

Result<std::vector<std::uint8_t>> payloadBits(const EmbedRequest& request) {
  const PaperParams& params = request.key.params;
  if (request.text) return Error{ErrorCode::badKey, "the key is of scheme \"paper\", which has no text payloads"};
  if (request.image.has_value() == request.id.has_value())
    return Error{ErrorCode::badOption, "give either an image or an id to embed"};
  if (request.id) {
    if (params.payload != PayloadType::id) return Error{ErrorCode::badKey, "the key is for an image, not for an id"};
    std::vector<std::uint8_t> bits(64);
    for (int i = 0; i < 64; ++i) bits[i] = static_cast<std::uint8_t>(*request.id >> (63 - i) & 1);
    return bits;
  }
  if (params.payload != PayloadType::image) return Error{ErrorCode::badKey, "the key is for an id, not for an image"};
  const BitImage& image = *request.image;
  if (image.width != params.width || image.height != params.height ||
      image.bits.size() != std::size_t{image.width} * image.height)
    return Error{ErrorCode::badImage, concat("the image is ", image.width, " x ", image.height, ", the key is for ",
                                             params.width, " x ", params.height)};
  return image.bits;
}

std::vector<std::string> embedWarnings(const Model& model, const MarkedMesh& marked) {
  std::vector<std::string> warnings = model.info().warnings;
  const Guarantees& g = marked.guarantees;
  if (!g.unattacked) warnings.push_back("the mark does not read back exactly from the output; choose more digits or a smaller payload");
  if (!g.reordered) warnings.push_back("the mark does not read back exactly after reordering the vertices");
  if (!g.affine) warnings.push_back("the mark does not read back exactly after an affine map");
  if (marked.repeats < 3) warnings.push_back("each bit is stored fewer than 3 times: little survives a crop");
  return warnings;
}

/// A keyed order: a Fisher-Yates shuffle of each range (docs/format.md, purpose "quadmark/paper/order"). It depends on the
/// payload too, so that copies with different payloads under one key differ in order, which is the point.
std::vector<std::uint32_t> keyedOrder(const Key& key, std::span<const std::uint8_t> bits, std::size_t vertexCount,
                                      const std::vector<VertexRange>& ranges) {
  const Prf prf(key.secret, "quadmark/paper/order");
  std::uint64_t payload = bits.size();
  for (std::size_t first = 0; first < bits.size(); first += 64) {
    std::uint64_t word = 0;
    for (std::size_t i = first; i < std::min(first + 64, bits.size()); ++i) word = word << 1 | bits[i];
    payload = prf(payload ^ word);
  }
  std::vector<std::uint32_t> order(vertexCount);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t range = 0; range < ranges.size(); ++range) {
    std::uint32_t* vertices = order.data() + ranges[range].first;
    for (std::uint32_t i = ranges[range].count; i > 1; --i)
      std::swap(vertices[i - 1], vertices[prf.below(payload ^ (std::uint64_t{range} << 32 | i), i)]);
  }
  return order;
}

/// Section 6.4: copies of one model whose vertices come in different orders cannot be averaged vertex by vertex.
/// @param marked    the patched file; resources that it does not hold are as before.
/// @param warnings  gets what was done and what was left alone.
Status scrambleOrder(std::span<const std::uint8_t> file, const Resources& resources, const Key& key,
                     std::span<const std::uint8_t> bits, PatchedFile& marked, std::vector<std::string>& warnings) {
  // Read anew: texts that the patch wrote may have moved everything behind them.
  Resources all = marked.resources;
  all.insert(resources.begin(), resources.end());  // keeps those that are already there
  auto model = readModel(marked.bytes, all);
  if (!model) return model.error();
  auto freedom = (*model)->orderFreedom(marked.bytes, all);
  if (!freedom) return freedom.error();
  const std::size_t vertexCount = (*model)->mesh().vertexCount();
  std::uint64_t moved = 0;
  for (const VertexRange& range : freedom->ranges) moved += range.count;
  if (moved > 0) {
    auto reordered = (*model)->reorder(marked.bytes, all, keyedOrder(key, bits, vertexCount, freedom->ranges));
    if (!reordered) return reordered.error();
    marked.bytes = std::move(reordered->bytes);
    for (auto& [uri, bytes] : reordered->resources) marked.resources[uri] = std::move(bytes);
    marked.bytesChanged = countChangedBytes(file, resources, marked);
    warnings.push_back(concat("the order of the vertices was scrambled (", moved, " of ", vertexCount, ")"));
  } else {
    warnings.push_back("the order of the vertices could not be scrambled");
  }
  warnings.insert(warnings.end(), freedom->warnings.begin(), freedom->warnings.end());
  return okStatus();
}

// Layers of the robust scheme: which vertices a key selects varies, how many it selects hardly does.
robust::ReaderCoverage robustPlaces(const Mesh& mesh, double diagonal) {
  if (!(diagonal > 0)) return {};
  robust::MeshReader reader(mesh, robust::RobustKeys{}, robust::headCode());
  robust::Hypothesis diamonds;  // they are counted when they are first looked at
  diamonds.layers = robust::Layers::diamonds;
  diamonds.diamondSigma = 1e-5;
  static_cast<void>(reader.headBits(diamonds));
  return reader.coverage();
}

}  // namespace

const char* version() { return QUADMARK_VERSION; }

Result<EmbedResponse> embed(std::span<const std::uint8_t> file, const Resources& resources,
                            const EmbedRequest& request) {
  if (request.key.scheme == "robust") return embedRobustFile(file, resources, request);
  if (Status s = validate(request.key.params); !s) return s.error();
  auto bits = payloadBits(request);
  if (!bits) return bits.error();
  if (!tell(request.progress, "read", 0)) return cancelled();
  auto model = readModel(file, resources);
  if (!model) return model.error();
  if (Status s = (*model)->checkMarkable(); !s) return s.error();
  const Mesh& mesh = (*model)->mesh();

  auto marked = embedMesh(mesh, *bits, request.key, request.progress);
  if (!marked) return marked.error();
  if (!tell(request.progress, "report", 0.95)) return cancelled();

  const Distortion measured = distortion(mesh, marked->positions, marked->welding, marked->diagonal);
  marked->welding = Welding{};  // not needed while the file is copied

  EmbedResponse response;
  auto patched = (*model)->patch(file, resources, marked->positions);
  if (!patched) return patched.error();
  response.file = std::move(*patched);
  std::vector<std::string> warnings = embedWarnings(**model, *marked);
  warnings.insert(warnings.end(), response.file.warnings.begin(), response.file.warnings.end());
  if (request.key.params.scrambleOrder) {
    model->reset();  // the marked file is read instead
    if (Status s = scrambleOrder(file, resources, request.key, *bits, response.file, warnings); !s) return s.error();
  }
  response.reportJson = formatReport(EmbedReport{request.key, *marked, measured, response.file.bytesChanged, warnings});
  tell(request.progress, "report", 1);
  return response;
}

Result<ExtractResponse> extract(std::span<const std::uint8_t> file, const Resources& resources,
                                const ExtractRequest& request) {
  if (request.key.scheme == "robust") return extractRobustFile(file, resources, request);
  const PaperParams& params = request.key.params;
  if (Status s = validate(params); !s) return s.error();
  if (request.expectedId || request.expectedText)
    return Error{ErrorCode::badKey, "the key is of scheme \"paper\": compare with a reference image instead"};
  if (request.reference && (request.reference->width != params.width || request.reference->height != params.height))
    return Error{ErrorCode::badImage,
                 concat("the reference is ", request.reference->width, " x ", request.reference->height,
                        ", the key is for ", params.width, " x ", params.height)};
  if (!tell(request.progress, "read", 0)) return cancelled();
  auto model = readModel(file, resources);
  if (!model) return model.error();
  if (!tell(request.progress, "search", 0.3)) return cancelled();
  const Precision precision = (*model)->mesh().precision;
  const WeldedMesh welded = weld((*model)->mesh());
  (*model)->mesh() = Mesh{};  // only the welded one is needed from here on

  ExtractOptions options;
  if (request.reference) options.reference = request.reference->bits;
  options.keepReadings = !(*model)->nodes().empty();
  options.progress = [&](int passes) { return tell(request.progress, "search", 0.3 + 0.1 * std::min(passes, 6)); };
  const PartsExtraction parts = extractParts(welded, precision, request.key, options);
  const Extraction& e = parts.extraction;
  if (e.cancelled || !tell(request.progress, "report", 0.95)) return cancelled();

  ExtractResponse response;
  response.verdict = verdictName(e.verdict);
  response.falsePositive = e.falsePositive;
  response.image = {params.width, params.height, e.bits};
  response.erased = e.erased;
  response.confidence = e.confidence;
  const bool complete = std::none_of(e.erased.begin(), e.erased.end(), [](std::uint8_t x) { return x != 0; });
  if (params.payload == PayloadType::id && e.verdict == Verdict::match && complete) {
    std::uint64_t id = 0;
    for (std::uint8_t bit : e.bits) id = id << 1 | bit;
    response.id = id;
  }
  std::optional<double> ber;
  if (request.reference) ber = bitErrorRate(request.reference->bits, e.bits, e.erased);
  std::vector<CellReading> voting;
  for (const CellReading& r : e.readings)
    if (r.weight > 0) voting.push_back(r);
  response.reportJson = formatReport(ExtractReport{
      request.key, e, partName(parts.part), parts.partVertices, response.id, ber,
      cellsPerNode(**model, welded, voting, [](const CellReading& r) { return r.vertices[0]; },
                   [](const CellReading& r) { return r.agrees ? double{r.weight} : 0.0; }),
      (*model)->info().warnings});
  tell(request.progress, "report", 1);
  return response;
}

Result<std::string> inspect(std::span<const std::uint8_t> file, const Resources& resources) {
  auto model = readModel(file, resources);
  if (!model) return model.error();
  const Mesh& mesh = (*model)->mesh();
  WeldedMesh welded = weld(mesh);
  const double diagonal = boundingDiagonal(mesh);
  SearchResult found;
  if (diagonal > 0) found = searchCells(mesh, welded, PaperParams{}, diagonal, roundingOf(mesh.precision, welded));
  std::uint32_t componentCount = 0;
  static_cast<void>(components(welded, componentCount));
  return formatReport(InspectReport{(*model)->info(), mesh, welded.vertexCount(), componentCount, diagonal,
                                    static_cast<std::uint32_t>(found.cells.size()), found.naturalCells,
                                    cellsPerNode(**model, welded, found.cells, [](const Quad& q) { return q.a; },
                                                 [](const Quad&) { return 1.0; }),
                                    robustPlaces(mesh, diagonal)});
}

Result<Key> makeKey(const KeyRequest& request) {
  Key key;
  key.secret = request.secret;
  key.owner = request.owner;
  key.scheme = request.scheme;
  if (key.scheme == "robust") return key;
  if (key.scheme != "paper")
    return Error{ErrorCode::badOption,
                 concat("scheme \"", key.scheme.substr(0, 40), "\" is not available in this version")};
  key.params = request.params;
  if (request.chooseDigits) {
    if (key.params.bitCount() == 0) return Error{ErrorCode::badOption, "the key needs the size of the image: width and height"};
    auto digits = chooseDigits(key.params.bitCount(), request.params.L1);
    if (!digits) return digits.error();
    key.params.L1 = digits->L1, key.params.H1 = digits->H1;
    key.params.L2 = digits->L2, key.params.H2 = digits->H2;
  }
  if (Status s = validate(key.params); !s) return s.error();
  return key;
}

}  // namespace quadmark
