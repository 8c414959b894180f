// SPDX-License-Identifier: MIT
// quadmark_conceal: can marked models be told from unmarked ones without the key? The figures under "Concealment" in
// docs/robust.md.
//
//   quadmark_conceal [--strength S] [--keys N] MODEL...
//
// Each model is looked at as it is and with a mark of each key. Per test the best accuracy that any threshold reaches, an
// unmarked model counting as much as all its marked ones together; the threshold is chosen on the same models, so it
// flatters the attacker. 50 % is guessing.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "quadmark/robust/embedder.h"
#include "quadmark/robust/frame.h"
#include "robust/carriers.h"
#include "robust/constellation.h"
#include "robust/diamonds.h"
#include "models.h"

namespace {

using namespace quadmark;
using namespace quadmark::robust;

// What an attacker sees of a model.
struct View {
  std::vector<double> gaps;       ///< of all diamonds, of the diagonal
  std::vector<double> ratios[2];  ///< of the same
  std::vector<double> rings[2];   ///< coordinates of all vertices that have a name, ring radii
};

View viewOf(const Mesh& mesh) {
  View view;
  const Surface surface = makeSurface(mesh);
  const std::vector<double>& positions = surface.welded.positions;
  const double diagonal = boundingDiagonal(mesh);
  DiamondShape s;
  for (const Diamond& q : collectDiamonds(surface)) {
    if (!diamondShape(positions, q, s)) continue;
    view.gaps.push_back(s.gapLength / diagonal);
    view.ratios[0].push_back(ratiosOf(s).edge);
    view.ratios[1].push_back(ratiosOf(s).span);
  }
  const Labels labels = refineLabels(surface);
  const SymmetricTensor tensor = edgeTensor(surface, positions);
  std::uint32_t order[kMaxRing];
  RingFrame frame;
  for (std::uint32_t v = 0; v < surface.vertexCount(); ++v) {
    if (labels.label[v] == 0 || !labels.orderRing(surface, v, order)) continue;
    if (!ringFrame(positions, {order, surface.ring(v).size()}, tensor, frame)) continue;
    const RingCoordinates p = coordinatesIn(frame, at(positions, v));
    view.rings[0].push_back(p.alpha);
    view.rings[1].push_back(p.beta);
  }
  return view;
}

// How many diamonds are flatter than a limit, for each that is up to twice as flat.
double flatness(const View& view, double limit) {
  double below = 0, next = 0;
  for (const double gap : view.gaps) (gap < limit ? below : next) += gap < 2 * limit ? 1 : 0;
  return (below + 1) / (next + 1);
}

// How uneven numbers lie between the points of a lattice: chi-square over 16 bins for each 1000 of them.
double unevenness(const std::vector<double>& numbers, double step) {
  double bins[16] = {};
  for (const double x : numbers) {
    const double cells = x / step;
    ++bins[std::min(15, static_cast<int>(16 * (cells - std::floor(cells))))];
  }
  const double expected = static_cast<double>(numbers.size()) / 16;
  double sum = 0;
  for (const double n : bins) sum += (n - expected) * (n - expected);
  return numbers.empty() ? 0 : (sum / expected - 15) * 1000 / static_cast<double>(numbers.size());
}

struct Test {
  std::string name;
  std::function<double(const View&)> statistic;
};

std::vector<Test> tests() {
  std::vector<Test> list;
  for (const double limit : {1e-7, 1e-6, 5e-6, 1e-5, 2e-5, 4e-5}) {
    char name[64];
    std::snprintf(name, sizeof name, "quads flatter than %g of the diagonal", limit);
    list.push_back({name, [limit](const View& v) { return flatness(v, limit); }});
  }
  for (const DeltaClass& shape : {kDeltas[0], kDeltas[1], kDeltas[2]}) {
    char name[64];
    std::snprintf(name, sizeof name, "ratios of all quads on a lattice of %g", shape.delta);
    list.push_back({name, [delta = shape.delta](const View& v) {
                      return unevenness(v.ratios[0], delta) + unevenness(v.ratios[1], delta);
                    }});
    std::snprintf(name, sizeof name, "ratios of flat quads on a lattice of %g", shape.delta);
    list.push_back({name, [delta = shape.delta](const View& v) {
                      std::vector<double> flat[2];
                      for (std::size_t i = 0; i < v.gaps.size(); ++i)
                        if (v.gaps[i] < 2e-5)
                          for (int k = 0; k < 2; ++k) flat[k].push_back(v.ratios[k][i]);
                      return unevenness(flat[0], delta) + unevenness(flat[1], delta);
                    }});
  }
  for (const double step : kRingSteps) {
    char name[64];
    std::snprintf(name, sizeof name, "coordinates of all vertices on a lattice of %g", step / 2);
    list.push_back({name, [step](const View& v) {
                      return unevenness(v.rings[0], step / 2) + unevenness(v.rings[1], step / 2);
                    }});
  }
  return list;
}

struct Sample {
  double statistic, weight;
  bool marked;
};

double bestAccuracy(std::vector<Sample> samples) {
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.statistic < b.statistic; });
  double total[2] = {0, 0}, below[2] = {0, 0}, best = 0.5;
  for (const Sample& s : samples) total[s.marked] += s.weight;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    below[samples[i].marked] += samples[i].weight;
    if (i + 1 < samples.size() && samples[i + 1].statistic == samples[i].statistic) continue;
    best = std::max(best, (below[0] + total[1] - below[1]) / (total[0] + total[1]));
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  EmbedOptions options;
  int keyCount = 2;
  std::vector<std::string> models;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--strength" && i + 1 < argc) {
      if (const auto strength = strengthFrom(argv[++i])) options.strength = *strength;
    } else if (argument == "--keys" && i + 1 < argc) {
      keyCount = std::max(1, std::atoi(argv[++i]));
    } else {
      models.push_back(argument);
    }
  }
  const std::vector<Test> all = tests();
  std::vector<std::vector<Sample>> samples(all.size());
  for (const std::string& name : models) {
    const auto model = bench::loadModel(name);
    if (!model) return std::fprintf(stderr, "%s: %s\n", name.c_str(), model.error().message.c_str()), 1;
    const auto look = [&](const Mesh& mesh, double weight, bool marked) {
      const View view = viewOf(mesh);
      for (std::size_t i = 0; i < all.size(); ++i) samples[i].push_back({all[i].statistic(view), weight, marked});
    };
    look(model->mesh, 1, false);
    for (int key = 1; key <= keyCount; ++key) {
      const SchemeKeys keys = *deriveKeys(std::vector<std::uint8_t>(32, static_cast<std::uint8_t>(key)), "");
      const auto bits = bitsOf(Payload{std::uint64_t{1}}, BodyRate::half, static_cast<std::uint8_t>(options.strength), keys);
      Mesh marked = model->mesh;
      const auto embedding = embedRobust(marked, encode(*bits, keys), keys.geometry, options);
      if (!embedding) return std::fprintf(stderr, "%s: %s\n", name.c_str(), embedding.error().message.c_str()), 1;
      marked.positions = embedding->positions;
      look(marked, 1.0 / keyCount, true);
    }
  }
  std::printf("| test | best accuracy |\n| --- | --- |\n");
  for (std::size_t i = 0; i < all.size(); ++i)
    std::printf("| %s | %.0f %% |\n", all[i].name.c_str(), 100 * bestAccuracy(samples[i]));
  return 0;
}
