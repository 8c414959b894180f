// SPDX-License-Identifier: MIT
#include "report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base64.h"

namespace quadmark {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity: a mark that moved nothing has no finite SNR.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string packBits(const std::vector<std::uint8_t>& bits) {
  std::vector<std::uint8_t> bytes((bits.size() + 7) / 8, 0);
  for (std::size_t i = 0; i < bits.size(); ++i)
    if (bits[i] != 0) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 0x80 >> i % 8);
  return toBase64(bytes);
}

Json nodeList(const std::vector<NodeCells>& nodes) {
  Json list = Json::array();
  for (const NodeCells& n : nodes)
    list.push_back({{"node", n.node}, {"name", n.name}, {"mesh", n.mesh}, {"cells", n.cells}});
  return list;
}

std::string line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::string formatId(std::uint64_t id) {
  std::string out(16, '0');
  for (int i = 15; i >= 0; --i, id >>= 4) out[i] = "0123456789abcdef"[id & 15];
  return out;
}

std::string formatReport(const EmbedReport& r) {
  const MarkedMesh& m = r.marked;
  const Distortion& d = r.distortion;
  return line({{"scheme", r.key.scheme},
               {"cells", m.cells},
               {"naturalCells", m.naturalCells},
               {"unusableCells", m.unusableCells},
               {"capacityBits", m.capacityBits},
               {"payloadBits", m.payloadBits},
               {"repeats", m.repeats},
               {"leastRepeats", m.leastRepeats},
               {"verified",
                {{"unattacked", m.guarantees.unattacked},
                 {"reordered", m.guarantees.reordered},
                 {"affine", m.guarantees.affine}}},
               {"distortion",
                {{"snrDb", finite(d.snrDb)},
                 {"rmsRel", d.rmsRel},
                 {"maxRel", d.maxRel},
                 {"hausdorffRel", d.hausdorffRel},
                 {"normalPsnrDb", finite(d.normalPsnrDb)},
                 {"meanNormalDeg", d.meanNormalDeg}}},
               {"bytesChanged", r.bytesChanged},
               {"warnings", r.warnings}});
}

std::string formatReport(const ExtractReport& r) {
  const Extraction& e = r.extraction;
  std::size_t erased = 0;
  for (std::uint8_t value : e.erased) erased += value;
  Json json = {{"scheme", r.key.scheme},
               {"verdict", verdictName(e.verdict)},
               {"falsePositive", e.falsePositive},
               {"image",
                {{"width", r.key.params.width},
                 {"height", r.key.params.height},
                 {"bits", packBits(e.bits)},
                 {"erased", erased},
                 {"erasedBits", packBits(e.erased)}}},
               {"id", r.id ? Json(formatId(*r.id)) : Json(nullptr)}};
  if (r.ber) json["ber"] = *r.ber;
  json["cells"] = e.cells;
  json["exactCells"] = e.exactCells;
  json["erasedCells"] = e.erasedCells;
  json["piecesRead"] = e.piecesRead;
  json["passes"] = e.passes;
  json["perNode"] = nodeList(r.perNode);
  json["warnings"] = r.warnings;
  return line(json);
}

std::string formatReport(const InspectReport& r) {
  Json capacity = Json::array();
  for (int digits = 1; digits <= 4; ++digits)
    capacity.push_back({{"digits", digits}, {"bits", std::uint64_t{3} * digits * r.cells}});
  return line({{"format", fileFormatName(r.info.format)},
               {"variant", r.info.variant},
               {"precision", r.mesh.precision == Precision::float32 ? "float32" : "float64"},
               {"meshes", r.info.meshes},
               {"primitives", r.info.primitives},
               {"nodes", r.info.nodes},
               {"extensionsUsed", r.info.extensionsUsed},
               {"vertices", r.mesh.vertexCount()},
               {"weldedVertices", r.weldedVertices},
               {"faces", r.mesh.faceCount()},
               {"components", r.components},
               {"diagonal", r.diagonal},
               {"cells", r.cells},
               {"naturalCells", r.naturalCells},
               {"capacity", capacity},
               {"perNode", nodeList(r.perNode)},
               {"warnings", r.info.warnings}});
}

}  // namespace quadmark
