// SPDX-License-Identifier: MIT
#include "report.h"

#include "base64.h"
#include "json_writer.h"
#include "report_parts.h"

namespace quadmark {
namespace {

std::string packBits(const std::vector<std::uint8_t>& bits) {
  std::vector<std::uint8_t> bytes((bits.size() + 7) / 8, 0);
  for (std::size_t i = 0; i < bits.size(); ++i)
    if (bits[i] != 0) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 0x80 >> i % 8);
  return toBase64(bytes);
}

// "float32", "float64", or of integer grids "int8", "uint16 normalized", ...; "mixed" where vertices differ.
std::string precisionName(const Mesh& mesh) {
  const auto kindOf = [&](std::uint32_t vertex) { return mesh.gridOf.empty() ? 0 : mesh.gridOf[vertex]; };
  for (std::uint32_t vertex : mesh.faceVertices)
    if (kindOf(vertex) != kindOf(mesh.faceVertices[0])) return "mixed";
  const CoordinateGrid* grid = mesh.faceVertices.empty() ? nullptr : mesh.grid(mesh.faceVertices[0]);
  if (grid == nullptr) return mesh.precision == Precision::float32 ? "float32" : "float64";
  return std::string(grid->low < 0 ? "int" : "uint") + (grid->high > 255 ? "16" : "8") +
         (grid->divisor > 1 ? " normalized" : "");
}

}  // namespace

std::string formatId(std::uint64_t id) {
  std::string out(16, '0');
  for (int i = 15; i >= 0; --i, id >>= 4) out[i] = "0123456789abcdef"[id & 15];
  return out;
}

void writeImage(JsonWriter& json, const BitImage& image, const std::vector<std::uint8_t>& erased) {
  std::size_t unread = 0;
  for (std::uint8_t value : erased) unread += value;
  json.key("image");
  json.beginObject();
  json.member("width", image.width);
  json.member("height", image.height);
  json.member("bits", packBits(image.bits));
  json.member("erased", unread);
  json.member("erasedBits", packBits(erased));
  json.endObject();
}

void writeId(JsonWriter& json, const std::optional<std::uint64_t>& id) {
  json.key("id");
  if (id) {
    json.value(formatId(*id));
  } else {
    json.null();
  }
}

void writeDistortion(JsonWriter& json, const Distortion& d) {
  json.key("distortion");
  json.beginObject();
  json.member("snrDb", d.snrDb);
  json.member("rmsRel", d.rmsRel);
  json.member("maxRel", d.maxRel);
  json.member("hausdorffRel", d.hausdorffRel);
  json.member("normalPsnrDb", d.normalPsnrDb);
  json.member("meanNormalDeg", d.meanNormalDeg);
  json.endObject();
}

void writeNodes(JsonWriter& json, const std::vector<NodeCells>& nodes) {
  json.key("perNode");
  json.beginArray();
  for (const NodeCells& n : nodes) {
    json.beginObject();
    json.member("node", n.node);
    json.member("name", n.name);
    json.member("mesh", n.mesh);
    json.member("cells", n.cells);
    json.member("share", n.share);
    json.endObject();
  }
  json.endArray();
}

std::string formatReport(const EmbedReport& r) {
  const MarkedMesh& m = r.marked;
  JsonWriter json;
  json.beginObject();
  json.member("scheme", r.key.scheme);
  json.member("cells", m.cells);
  json.member("naturalCells", m.naturalCells);
  json.member("unusableCells", m.unusableCells);
  json.member("capacityBits", m.capacityBits);
  json.member("payloadBits", m.payloadBits);
  json.member("repeats", m.repeats);
  json.member("leastRepeats", m.leastRepeats);
  json.key("verified");
  json.beginObject();
  json.member("unattacked", m.guarantees.unattacked);
  json.member("reordered", m.guarantees.reordered);
  json.member("affine", m.guarantees.affine);
  json.endObject();
  writeDistortion(json, r.distortion);
  json.member("bytesChanged", r.bytesChanged);
  json.member("warnings", r.warnings);
  json.endObject();
  return json.text();
}

std::string formatReport(const ExtractReport& r) {
  const Extraction& e = r.extraction;
  JsonWriter json;
  json.beginObject();
  json.member("scheme", r.key.scheme);
  json.member("verdict", verdictName(e.verdict));
  json.member("falsePositive", e.falsePositive);
  writeImage(json, {r.key.params.width, r.key.params.height, e.bits}, e.erased);
  writeId(json, r.id);
  if (r.ber) json.member("ber", *r.ber);
  json.member("cells", e.cells);
  json.member("exactCells", e.exactCells);
  json.member("erasedCells", e.erasedCells);
  json.member("piecesRead", e.piecesRead);
  json.member("passes", e.passes);
  json.member("readFrom", r.readFrom);
  json.member("readFromVertices", r.readFromVertices);
  writeNodes(json, r.perNode);
  json.member("warnings", r.warnings);
  json.endObject();
  return json.text();
}

std::string formatReport(const InspectReport& r) {
  JsonWriter json;
  json.beginObject();
  json.member("format", fileFormatName(r.info.format));
  json.member("variant", r.info.variant);
  json.member("precision", precisionName(r.mesh));
  json.member("meshes", r.info.meshes);
  json.member("primitives", r.info.primitives);
  json.member("nodes", r.info.nodes);
  json.member("extensionsUsed", r.info.extensionsUsed);
  json.member("vertices", r.mesh.vertexCount());
  json.member("weldedVertices", r.weldedVertices);
  json.member("faces", r.mesh.faceCount());
  json.member("components", r.components);
  json.member("diagonal", r.diagonal);
  json.member("cells", r.cells);
  json.member("naturalCells", r.naturalCells);
  json.key("capacity");
  json.beginArray();
  for (int digits = 1; digits <= 4; ++digits) {
    json.beginObject();
    json.member("digits", digits);
    json.member("bits", std::uint64_t{3} * digits * r.cells);
    json.endObject();
  }
  json.endArray();
  json.key("robust");
  json.beginObject();
  json.member("carriers", r.robust.carriers);
  json.member("labels", r.robust.labels);
  json.member("diamonds", r.robust.diamonds);
  json.endObject();
  writeNodes(json, r.perNode);
  json.member("warnings", r.info.warnings);
  json.endObject();
  return json.text();
}

}  // namespace quadmark
