// SPDX-License-Identifier: MIT
// quadmark_robust: the harness behind docs/robust.md. Marks models with 64-bit IDs, damages them, reads the IDs back.
//
//   quadmark_robust [--keys N] [--strength invisible|standard|strong] [--attacks NAME,NAME,...] MODEL...
//
// MODEL is a file, or KIND:VERTICES[:SEED] for a generated model (lab/generate.h); KEEP in MODEL@KEEP decimates it
// first (QEM, to that share of its vertices). Prints two Markdown tables: what was written and what it cost, one row
// per model; then what was read, one row per attack and one column per model: in how many of the N keys the ID was read
// exactly, "+k" where k more were verified against the expected ID (p <= 1e-6), and the layers that read it (A rings, B
// diamonds, + their sum, s after sharpening). Any wrong ID is shouted about. The last lines give CPU times.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "quadmark/io/model.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/metrics.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/robust/frame.h"
#include "quadmark/robust/keys.h"
#include "quadmark/robust/mark.h"
#include "quadmark/robust/mesh_source.h"
#include "quadmark/robust/reader.h"
#include "robust_attacks.h"
#include "surface_rms.h"

namespace {

using namespace quadmark;
using namespace quadmark::robust;

Result<Mesh> load(const std::string& name) {
  const std::size_t keep = name.find('@');
  if (keep != name.npos) {
    const auto whole = load(name.substr(0, keep));
    if (!whole) return whole.error();
    return lab::simplifyQem(*whole, std::strtod(name.c_str() + keep + 1, nullptr));
  }
  const std::size_t colon = name.find(':');
  if (colon != name.npos) {
    const std::size_t second = name.find(':', colon + 1);
    const std::uint64_t seed = second == name.npos ? 1 : std::strtoull(name.c_str() + second + 1, nullptr, 10);
    return lab::generate(name.substr(0, colon), std::strtoull(name.c_str() + colon + 1, nullptr, 10), seed);
  }
  std::ifstream stream(name, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  auto model = readModel(bytes);
  if (!model) return model.error();
  return std::move((*model)->mesh());
}

SchemeKeys keysOf(int number) {
  std::vector<std::uint8_t> secret(32);
  for (std::size_t i = 0; i < secret.size(); ++i) secret[i] = static_cast<std::uint8_t>(31 * i + 7 * number);
  return deriveKeys(secret, "").value();
}

struct Score {
  int read = 0, verified = 0, wrong = 0;
  std::set<char> layers;
};

struct Column {
  std::string name;
  std::vector<Score> scores;  // per attack
};

struct Times {
  double embed = 0, read = 0;
  double embedded = 0, readVertices = 0;
};

char layerName(const Hypothesis& h) {
  if (h.sharpening > 0) return 's';
  return h.layers == Layers::ring ? 'A' : h.layers == Layers::diamonds ? 'B' : '+';
}

double cpuSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void readBack(const Mesh& damaged, const SchemeKeys& keys, std::uint64_t id, Score& score, Times& times) {
  const double start = cpuSeconds();
  MeshReader reader(damaged, keys.geometry, headCode());
  MeshSource source(reader);
  const auto reading = readMark(source, {.keys = keys, .expected = Payload{id}});
  times.read += cpuSeconds() - start;
  times.readVertices += static_cast<double>(damaged.vertexCount());
  if (!reading) return;
  if (reading->id()) {
    if (*reading->id() != id) {
      ++score.wrong;
    } else {
      ++score.read;
      score.layers.insert(layerName(*reading->hypothesis));
    }
  } else if (reading->comparison == Comparison::agrees && reading->verdict == Verdict::match) {
    ++score.verified;
  }
}

// Marks one model under all keys; prints its row of the first table.
bool run(const std::string& name, int keyCount, Strength strength, const std::vector<bench::NamedAttack>& attacks,
         Column& column, Times& times) {
  const auto mesh = load(name);
  if (!mesh) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), mesh.error().message.c_str());
    return false;
  }
  column.name = name.substr(name.rfind('/') + 1);
  column.scores.resize(attacks.size());
  double carriers = 0, labels = 0, cells = 0, snr = 0, rms = 0, most = 0, normal = 0;
  for (int number = 1; number <= keyCount; ++number) {
    const SchemeKeys keys = keysOf(number);
    const std::uint64_t id = 0x0123456789abcdefu * static_cast<std::uint64_t>(2 * number + 1);
    const auto bits = bitsOf(Payload{id}, BodyRate::half, static_cast<std::uint8_t>(strength), keys);
    EmbedOptions options;
    options.strength = strength;
    const double start = cpuSeconds();
    const auto marked = embedRobust(*mesh, encode(*bits, keys), keys.geometry, options);
    times.embed += cpuSeconds() - start;
    times.embedded += static_cast<double>(mesh->vertexCount());
    if (!marked) {
      std::fprintf(stderr, "%s: %s\n", name.c_str(), marked.error().message.c_str());
      return false;
    }
    Mesh copy = *mesh;
    copy.positions = marked->positions;
    const Distortion d = distortion(*mesh, copy);
    carriers += marked->carriers, labels += marked->labels, cells += marked->cells, snr += d.snrDb;
    rms += bench::surfaceRmsRel(*mesh, copy.positions), most += d.maxRel, normal += d.meanNormalDeg;
    for (std::size_t i = 0; i < attacks.size(); ++i)
      readBack(attacks[i].apply(copy), keys, id, column.scores[i], times);
  }
  std::printf("| %s | %zu | %.0f | %.0f | %.0f | %.1f | %.4f | %.2f | %.2f |\n", column.name.c_str(),
              mesh->vertexCount(), carriers / keyCount, labels / keyCount, cells / keyCount, snr / keyCount,
              100 * rms / keyCount, 100 * most / keyCount, normal / keyCount);
  std::fflush(stdout);
  return true;
}

std::string cell(const Score& score) {
  std::string text = std::to_string(score.read);
  if (score.verified > 0) text += "+" + std::to_string(score.verified);
  if (score.read > 0) text += " " + std::string(score.layers.begin(), score.layers.end());
  if (score.wrong > 0) text += " **WRONG " + std::to_string(score.wrong) + "**";
  return text;
}

void printReads(const std::vector<Column>& columns, const std::vector<bench::NamedAttack>& attacks) {
  std::printf("\n| attack |");
  for (const Column& c : columns) std::printf(" %s |", c.name.c_str());
  std::printf("\n| --- |");
  for (std::size_t i = 0; i < columns.size(); ++i) std::printf(" --- |");
  std::printf("\n");
  for (std::size_t i = 0; i < attacks.size(); ++i) {
    std::printf("| %s |", attacks[i].name.c_str());
    for (const Column& c : columns) std::printf(" %s |", cell(c.scores[i]).c_str());
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  int keys = 3;
  Strength strength = Strength::standard;
  std::set<std::string> wanted;
  std::vector<std::string> models;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--keys" && i + 1 < argc) {
      keys = std::max(1, std::atoi(argv[++i]));
    } else if (argument == "--strength" && i + 1 < argc) {
      const std::string name = argv[++i];
      strength = name == "strong" ? Strength::strong : name == "invisible" ? Strength::invisible : Strength::standard;
    } else if (argument == "--attacks" && i + 1 < argc) {
      const std::string list = argv[++i];
      for (std::size_t from = 0; from <= list.size();) {
        const std::size_t comma = std::min(list.find(',', from), list.size());
        wanted.insert(list.substr(from, comma - from));
        from = comma + 1;
      }
    } else {
      models.push_back(argument);
    }
  }
  std::vector<bench::NamedAttack> attacks;
  for (const bench::NamedAttack& attack : bench::robustAttacks())
    if (wanted.empty() || wanted.count(attack.name) == 1) attacks.push_back(attack);
  std::printf(
      "| model | vertices | carriers | labels | cells | SNR dB | surface RMS %% | largest move %% | normals deg |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  std::vector<Column> columns;
  Times times;
  for (const std::string& name : models) {
    Column column;
    if (run(name, keys, strength, attacks, column, times)) columns.push_back(std::move(column));
  }
  printReads(columns, attacks);
  std::fprintf(stderr, "CPU: embedding %.2f us per vertex, reading %.2f us per vertex\n",
               1e6 * times.embed / times.embedded, 1e6 * times.read / times.readVertices);
  return 0;
}
