// SPDX-License-Identifier: MIT
// quadmark_robust: the harness behind docs/robust.md. Marks models, damages them, reads the marks back.
//
//   quadmark_robust [--keys FIRST-LAST] [--strength invisible|standard|strong] [--payload id|image]
//                   [--rows attacks|none|NAME,NAME...] [--results FILE] MODEL...
//
// MODEL is as in models.h. Prints, and appends to FILE, two kinds of lines; those that FILE has already are
// neither computed nor written again:
//   mark;MODEL;STRENGTH;PAYLOAD;KEY;VERTICES;CARRIERS;LABELS;CELLS;SNR dB;surface RMS %;largest move %;normals degrees;
//   read;MODEL;STRENGTH;PAYLOAD;KEY;ROW;OUTCOME;LAYERS;PROBABILITY;BER;
// OUTCOME: exact; verified (against the expected payload, p <= 1e-6; an image that is recognised, with its bit error
// rate); lost; wrong (another payload with certainty); refused (too little capacity: nothing was written); failed (the
// reader, not the mark). LAYERS: A rings, B diamonds, + their sum, s after sharpening. scripts/robust.sh runs it on
// everything, bench/robust_table.mjs makes the tables. Programs of web builds are bench/evaluate's.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "quadmark/metrics.h"
#include "quadmark/random.h"
#include "quadmark/robust/marker.h"
#include "quadmark/robust/mesh_source.h"
#include "robust_attacks.h"
#include "models.h"
#include "robust_results.h"
#include "surface_rms.h"

namespace {

using namespace quadmark;
using namespace quadmark::robust;
using Fields = std::vector<std::string>;

struct Settings {
  int firstKey = 1, lastKey = 3;
  Strength strength = Strength::standard;
  bool image = false, attacks = true;
  std::vector<std::string> rows;  // empty: all

  [[nodiscard]] bool wants(const std::string& row) const {
    return rows.empty() || std::find(rows.begin(), rows.end(), row) != rows.end();
  }
};

std::vector<std::string> splitAtCommas(const std::string& list) {
  std::vector<std::string> out;
  std::istringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');) out.push_back(item);
  return out;
}

SchemeKeys keysOf(int number) {
  std::vector<std::uint8_t> secret(32);
  for (std::size_t i = 0; i < secret.size(); ++i) secret[i] = static_cast<std::uint8_t>(31 * i + 7 * number);
  return deriveKeys(secret, "").value();
}

// An ID, or a picture of a ring and a bar with some noise, 24 pixels a side.
Payload payloadOf(int key, bool image) {
  if (!image) return Payload{0x0123456789abcdefu * static_cast<std::uint64_t>(2 * key + 1)};
  BitImage picture{24, 24, {}};
  Random random(static_cast<std::uint64_t>(key));
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) {
      const int r = (2 * x - 23) * (2 * x - 23) + (2 * y - 23) * (2 * y - 23);
      const bool drawn = (r < 480 && r > 260) || std::abs(x - y) < 2 || random.uniform() < 0.05;
      picture.bits.push_back(drawn ? 1 : 0);
    }
  return Payload{picture};
}

std::string text(double value, const char* format = "%.4g") {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string layerOf(const MarkReading& reading) {
  if (!reading.hypothesis) return "-";
  const Hypothesis& h = *reading.hypothesis;
  if (h.sharpening > 0) return "s";
  return h.layers == Layers::ring ? "A" : h.layers == Layers::diamonds ? "B" : "+";
}

// OUTCOME;LAYERS;PROBABILITY;BER
Fields outcomeOf(const Mesh& damaged, const SchemeKeys& keys, const PayloadBits& bits, const Payload& payload) {
  MeshReader reader(damaged, keys.geometry, headCode());
  MeshSource source(reader);
  const auto reading = readMark(source, {.keys = keys, .expected = payload});
  if (!reading) return {"failed", "-", "1", "-"};
  std::string ber = "-";
  if (!bits.body.empty() && reading->body && reading->body->bits.size() == bits.body.size()) {
    double wrong = 0;
    for (std::size_t i = 0; i < bits.body.size(); ++i) wrong += reading->body->bits[i] != bits.body[i] ? 1 : 0;
    ber = text(wrong / static_cast<double>(bits.body.size()));
  }
  const bool certain = reading->framed && reading->readProbability <= kMatchProbability;
  std::string outcome = "lost";
  if (certain && !(reading->frame == bits.frame)) {
    outcome = "wrong";
  } else if (certain && (bits.body.empty() || (reading->body && reading->body->exact))) {
    outcome = "exact";
  } else if (reading->verdict == Verdict::match) {
    outcome = "verified";
  }
  return {outcome, layerOf(*reading), text(reading->falsePositive, "%.1e"), ber};
}

void runKey(const bench::NamedModel& model, int key, const Settings& settings, bench::ResultFile& results) {
  const Fields what = {model.name, strengthName(settings.strength), settings.image ? "image" : "id",
                       std::to_string(key)};
  const auto keyOf = [&](const char* kind, const std::string& row) {
    Fields fields = {kind};
    fields.insert(fields.end(), what.begin(), what.end());
    if (!row.empty()) fields.push_back(row);
    return fields;
  };
  std::vector<bench::NamedAttack> attacks;
  if (settings.attacks)
    for (const bench::NamedAttack& attack : bench::robustAttacks())
      if (settings.wants(attack.name) && (!settings.image || bench::isForImages(attack.name)) &&
          !results.has(keyOf("read", attack.name)))
        attacks.push_back(attack);
  if (attacks.empty() && results.has(keyOf("mark", ""))) return;

  const SchemeKeys keys = keysOf(key);
  const Payload payload = payloadOf(key, settings.image);
  EmbedOptions options;
  options.strength = settings.strength;
  const auto marked = markMesh(model.mesh, payload, keys, options);
  if (!marked) {
    std::fprintf(stderr, "%s: %s\n", model.name.c_str(), marked.error().message.c_str());
    for (const auto& attack : attacks) results.add(keyOf("read", attack.name), {"refused", "-", "1", "-"});
    return;
  }
  Mesh copy = model.mesh;
  copy.positions = marked->embedding.positions;
  if (!results.has(keyOf("mark", ""))) {
    const Distortion d = distortion(model.mesh, copy);
    const RobustEmbedding& e = marked->embedding;
    results.add(keyOf("mark", ""),
                {std::to_string(model.mesh.vertexCount()), std::to_string(e.carriers), std::to_string(e.labels),
                 std::to_string(e.cells), text(d.snrDb), text(100 * bench::surfaceRms(model.mesh, copy.positions).meanRel),
                 text(100 * d.maxRel), text(d.meanNormalDeg)});
  }
  for (const auto& attack : attacks)
    results.add(keyOf("read", attack.name), outcomeOf(attack.apply(copy), keys, marked->bits, payload));
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  std::string path;
  std::vector<std::string> models;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
    if (argument.rfind("--", 0) == 0) ++i;
    if (argument == "--keys") {
      settings.firstKey = settings.lastKey = std::atoi(value.c_str());
      if (const std::size_t dash = value.find('-'); dash != value.npos)
        settings.lastKey = std::atoi(value.c_str() + dash + 1);
    } else if (argument == "--strength") {
      const auto strength = strengthFrom(value);
      if (!strength) return std::fprintf(stderr, "%s\n", strength.error().message.c_str()), 2;
      settings.strength = *strength;
    } else if (argument == "--payload") {
      settings.image = value == "image";
    } else if (argument == "--rows") {
      settings.attacks = value != "none";
      if (settings.attacks && value != "attacks") settings.rows = splitAtCommas(value);
    } else if (argument == "--results") {
      path = value;
    } else {
      models.push_back(argument);
    }
  }
  bench::ResultFile results(path);
  for (const std::string& name : models) {
    const auto model = bench::loadModel(name);
    if (!model) {
      std::fprintf(stderr, "%s: %s\n", name.c_str(), model.error().message.c_str());
      return 1;
    }
    for (int key = settings.firstKey; key <= settings.lastKey; ++key) runKey(*model, key, settings, results);
  }
  return 0;
}
