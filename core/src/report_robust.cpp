// SPDX-License-Identifier: MIT
#include "report_robust.h"

#include "json_writer.h"
#include "report_parts.h"

namespace quadmark {
namespace {

using robust::Comparison;
using robust::Layers;
using robust::PayloadKind;

const char* kindName(PayloadKind kind) {
  return kind == PayloadKind::id ? "id" : kind == PayloadKind::image ? "image" : "text";
}

const char* layersName(Layers layers) {
  return layers == Layers::ring ? "ring" : layers == Layers::diamonds ? "diamonds" : "both";
}

void writeTest(JsonWriter& json, const robust::SelfTest& test) {
  json.key(test.name);
  json.beginObject();
  json.member("read", test.read);
  json.member("falsePositive", test.falsePositive);
  json.endObject();
}

}  // namespace

const char* capacityClassName(CapacityClass value) {
  return value == CapacityClass::full ? "full" : value == CapacityClass::standard ? "standard" : "basic";
}

CapacityClass capacityClass(const robust::RobustEmbedding& e) {
  if (e.labels >= 800 && e.cells >= 8 * e.goodCells) return CapacityClass::full;
  if (e.labels >= 150 && e.cells >= 2 * e.goodCells) return CapacityClass::standard;
  return CapacityClass::basic;
}

std::string formatReport(const RobustEmbedReport& r) {
  const robust::RobustEmbedding& e = r.embedding;
  const std::size_t codedBits = r.coded.head.size() + r.coded.body.size();
  // Both coordinates of a carrier carry a bit each, a cell as many as its symbol has.
  const std::uint64_t written = 2 * std::uint64_t{e.carriers} + std::uint64_t{e.symbolBits} * e.cells;
  JsonWriter json;
  json.beginObject();
  json.member("scheme", "robust");
  json.member("payload", kindName(r.payload.frame.kind));
  json.member("strength", robust::strengthName(r.strength));
  json.member("capacityClass", capacityClassName(capacityClass(e)));
  json.member("cells", std::uint64_t{e.carriers} + e.cells);
  json.member("capacityBits", written);
  json.member("payloadBits", robust::kFrameBits + r.payload.body.size());
  json.member("repeats", static_cast<double>(written) / static_cast<double>(codedBits));
  json.key("ring");
  json.beginObject();
  json.member("selected", e.selected);
  json.member("carriers", e.carriers);
  json.member("labels", e.labels);
  json.member("positions", e.ringPositions + e.ringBodyPositions);
  json.endObject();
  json.key("diamonds");
  json.beginObject();
  json.member("cells", e.cells);
  json.member("vetoed", e.vetoed);
  json.member("goodCells", e.goodCells);
  json.member("positions", e.diamondPositions + e.diamondBodyPositions);
  json.endObject();
  json.member("codedBits", codedBits);
  json.key("verified");
  json.beginObject();
  json.member("unattacked", r.unattacked.read);
  json.member("falsePositive", r.unattacked.falsePositive);
  json.endObject();
  if (!r.selfTests.empty()) {
    json.key("selfTest");
    json.beginObject();
    for (const robust::SelfTest& test : r.selfTests) writeTest(json, test);
    json.endObject();
  }
  writeDistortion(json, r.distortion);
  json.member("slideRel", r.slideRel);
  json.key("textureShift");
  if (r.textureShift) {
    json.beginObject();
    json.member("uv", r.textureShift->uv);
    json.member("texels", r.textureShift->texels);
    json.member("place", r.textureShift->place);
    json.endObject();
  } else {
    json.null();
  }
  json.member("bytesChanged", r.bytesChanged);
  json.member("warnings", r.warnings);
  json.endObject();
  return json.text();
}

std::string formatReport(const RobustExtractReport& r) {
  const robust::MarkReading& m = r.scene.reading;
  JsonWriter json;
  json.beginObject();
  json.member("scheme", "robust");
  json.member("verdict", verdictName(m.verdict));
  json.member("falsePositive", m.falsePositive);
  json.key("payload");
  if (m.frame) {
    json.value(kindName(m.frame->kind));
  } else {
    json.null();
  }
  json.member("readProbability", m.readProbability);
  if (r.image.width != 0) {
    writeImage(json, r.image, r.erased);
  } else {
    json.key("image");
    json.null();
  }
  if (m.body) json.member("exact", m.body->exact);
  writeId(json, m.id());
  json.member("text", m.text());
  if (m.comparison != Comparison::notAsked) {
    json.key("expected");
    json.beginObject();
    json.member("comparison", m.comparison == Comparison::agrees    ? "agrees"
                              : m.comparison == Comparison::differs ? "differs"
                                                                    : "unknown");
    json.member("falsePositive", m.expectedProbability);
    json.endObject();
  }
  if (r.ber) json.member("ber", *r.ber);
  if (m.frame)
    if (const auto shape = robust::bodyShape(*m.frame)) json.member("strength", robust::strengthName(static_cast<robust::Strength>(shape->strength)));
  json.key("hypothesis");
  if (m.hypothesis) {
    json.beginObject();
    json.member("layers", layersName(m.hypothesis->layers));
    json.member("deltaClass", std::uint32_t{m.hypothesis->deltaClass});
    json.member("ringSigma", m.hypothesis->ringSigma);
    json.member("diamondSigma", m.hypothesis->diamondSigma);
    json.member("sharpening", m.hypothesis->sharpening);
    json.endObject();
  } else {
    json.null();
  }
  json.member("hypotheses", m.hypotheses);
  json.member("cells", r.cells);
  json.member("readFrom", r.scene.component ? "component" : "model");
  json.member("readFromVertices", r.scene.coverage.vertices);
  json.member("partsTried", r.scene.tried);
  json.key("coverage");
  json.beginObject();
  json.member("carriers", r.scene.coverage.carriers);
  json.member("labels", r.scene.coverage.labels);
  json.member("positions", r.scene.coverage.ringPositions);
  json.member("diamonds", r.scene.coverage.diamonds);
  json.member("diamondShare", r.scene.coverage.diamondShare);
  json.endObject();
  writeNodes(json, r.perNode);
  json.member("warnings", r.warnings);
  json.endObject();
  return json.text();
}

}  // namespace quadmark
