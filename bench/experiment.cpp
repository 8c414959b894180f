// SPDX-License-Identifier: MIT
// quadmark_experiment: the small harness behind docs/results.md. Marks models, damages them, reads the marks back.
//
//   quadmark_experiment [--keys N] [--side PIXELS] [--L DIGIT] [--attacks all|exact] MODEL...
//
// MODEL is a file, or sculpture:N or part:N for a generated model of about N vertices. Prints a Markdown table with one
// line per model: cells, repeats, SNR, then the bit error rate of each attack, averaged over the keys. An unread bit
// counts one half. "exact" stands for no wrong and no unread bit with every key; "no match" for a verdict other than match
// with some key.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "quadmark/embed.h"
#include "quadmark/extract.h"
#include "quadmark/io/model.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/metrics.h"

namespace {

using namespace quadmark;

struct Attack {
  std::string name;
  std::function<Mesh(const Mesh&)> apply;
};

std::vector<Attack> attacks(bool exactOnly) {
  std::vector<Attack> list = {
      {"none", [](const Mesh& m) { return m; }},
      {"reorder", [](const Mesh& m) { return lab::reorder(m, 7); }},
  };
  for (const char* name : {"R", "NS", "RE", "S", "SH", "CB"})
    list.push_back({name, [name](const Mesh& m) { return lab::affine(m, *lab::paperAffine(name)); }});
  list.push_back({"crop 50 %", [](const Mesh& m) { return lab::crop(m, 0.5); }});
  list.push_back({"crop 92 %", [](const Mesh& m) { return lab::crop(m, 0.92); }});
  list.push_back({"simplify 30 %", [](const Mesh& m) { return lab::simplifyMeshopt(m, 0.7); }});
  if (exactOnly) return list;
  list.push_back({"QEM 30 %", [](const Mesh& m) { return lab::simplifyQem(m, 0.7); }});
  list.push_back({"deform", [](const Mesh& m) { return lab::deform(m, 0.5, 1); }});
  list.push_back({"local noise 1e-3", [](const Mesh& m) { return lab::localNoise(m, 1e-3, 0.5, 1); }});
  for (const double a : {1e-6, 1e-5})
    list.push_back({a < 5e-6 ? "noise 1e-6" : "noise 1e-5", [a](const Mesh& m) { return lab::noise(m, a, 1); }});
  list.push_back({"16 bit", [](const Mesh& m) { return lab::quantize(m, 16, lab::Grid::common); }});
  list.push_back({"Taubin 1e-4", [](const Mesh& m) { return lab::smoothTaubin(m, 1e-4, 1); }});
  return list;
}

Result<Mesh> load(const std::string& name) {
  for (const auto& [prefix, kind] : {std::pair{"sculpture:", "sculpture"}, {"part:", "part"}})
    if (name.rfind(prefix, 0) == 0)
      return lab::generate(kind, static_cast<std::size_t>(std::strtoul(name.c_str() + std::strlen(prefix), nullptr, 10)), 1);
  std::ifstream stream(name, std::ios::binary);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  auto model = readModel(bytes);
  if (!model) return model.error();
  return std::move((*model)->mesh());
}

std::vector<std::uint8_t> emblem(std::uint32_t side) {
  std::vector<std::uint8_t> bits;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const double u = (x + 0.5) / side - 0.5, v = (y + 0.5) / side - 0.5, r = std::sqrt(u * u + v * v);
      bits.push_back((r > 0.33 && r < 0.46) || (std::fabs(u - v) < 0.06 && u > 0.05 && u < 0.45));
    }
  return bits;
}

Key keyFor(int number, std::uint32_t side, int L) {
  Key key;
  for (std::size_t i = 0; i < key.secret.size(); ++i) key.secret[i] = static_cast<std::uint8_t>(31 * i + 7 * number);
  key.params = *chooseDigits(side * side, L);
  key.params.width = key.params.height = side;
  return key;
}

struct Score {
  double errorRate = 0;
  bool exact = true, match = true;
};

std::string cell(const Score& score, int keys) {
  char text[64];
  std::snprintf(text, sizeof text, "%s%s", score.exact ? "exact" : std::to_string(score.errorRate / keys).substr(0, 6).c_str(),
                score.match ? "" : " (no match)");
  return text;
}

void row(const std::string& name, const Mesh& mesh, const std::vector<Attack>& list, int keys, std::uint32_t side, int L) {
  const std::vector<std::uint8_t> bits = emblem(side);
  std::vector<Score> scores(list.size());
  double cells = 0, snr = 0;
  for (int number = 1; number <= keys; ++number) {
    const Key key = keyFor(number, side, L);
    const auto marked = embedMesh(mesh, bits, key);
    if (!marked) {
      std::printf("| %s | refused: %s |\n", name.c_str(), marked.error().message.c_str());
      return;
    }
    Mesh copy = mesh;
    copy.positions = marked->positions;
    cells += marked->cells;
    snr += distortion(mesh, copy).snrDb;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Mesh damaged = list[i].apply(copy);
      const WeldedMesh welded = weld(damaged);
      const Extraction read = extractMesh(welded, welded.positions, roundingOf(damaged.precision), key);
      const double rate = bitErrorRate(bits, read.bits, read.erased);
      scores[i].errorRate += rate;
      scores[i].exact = scores[i].exact && rate == 0;
      scores[i].match = scores[i].match && read.verdict == Verdict::match;
    }
  }
  std::printf("| %s | %zu | %.0f | %.1f | %.1f |", name.c_str(), mesh.vertexCount(), cells / keys,
              cells / keys / pieceCount(keyFor(1, side, L).params), snr / keys);
  for (const Score& score : scores) std::printf(" %s |", cell(score, keys).c_str());
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  int keys = 3, L = 2;
  std::uint32_t side = 24;
  bool exactOnly = false;
  std::vector<std::string> models;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (argument == "--keys") keys = std::atoi(value), ++i;
    else if (argument == "--side") side = static_cast<std::uint32_t>(std::atoi(value)), ++i;
    else if (argument == "--L") L = std::atoi(value), ++i;
    else if (argument == "--attacks") exactOnly = std::strcmp(value, "exact") == 0, ++i;
    else models.push_back(argument);
  }
  if (models.empty() || keys < 1 || side < 2 || !chooseDigits(side * side, L)) {
    std::fprintf(stderr, "usage: quadmark_experiment [--keys N] [--side PIXELS] [--L DIGIT] [--attacks all|exact] MODEL...\n");
    return 2;
  }
  const std::vector<Attack> list = attacks(exactOnly);
  std::printf("| model | vertices | cells | repeats | SNR dB |");
  for (const Attack& attack : list) std::printf(" %s |", attack.name.c_str());
  std::printf("\n|%s\n", [&] {
    std::string line;
    for (std::size_t i = 0; i < list.size() + 5; ++i) line += " --- |";
    return line;
  }().c_str());
  for (const std::string& name : models) {
    const auto mesh = load(name);
    const std::size_t slash = name.rfind('/');
    const std::string shown = slash == name.npos ? name : name.substr(slash + 1);
    if (!mesh) {
      std::printf("| %s | %s |\n", shown.c_str(), mesh.error().message.c_str());
      continue;
    }
    row(shown, *mesh, list, keys, side, L);
  }
  return 0;
}
