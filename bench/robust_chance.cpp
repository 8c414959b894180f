// SPDX-License-Identifier: MIT
// quadmark_chance: how often chance looks like a mark. Wrong keys on unmarked models and on other keys' marks; the table
// "claimed and observed" of docs/robust.md.
//
//   quadmark_chance [--trials N] [--searches N] [--minutes M]     keys per model; of these, how many search a mesh whole;
//                                                                 after so much processor time no more do
//
// Prints a Markdown table of the share of trials with p at most the claimed one, for each layer's own test, for the bounds
// that verdicts are made of, and for whole searches. 2000 keys on each of the five models take an hour.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "quadmark/exact_math.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/random.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/robust/demapper.h"
#include "quadmark/robust/evidence.h"
#include "quadmark/robust/mesh_source.h"

namespace {

using namespace quadmark;
using namespace quadmark::robust;

SchemeKeys keysOf(std::uint64_t seed) {
  std::vector<std::uint8_t> secret(32, 9);
  for (int i = 0; i < 8; ++i) secret[i] = static_cast<std::uint8_t>(seed >> (8 * i));
  return deriveKeys(secret, "").value();
}

Mesh markedByAnother(Mesh mesh) {
  const SchemeKeys keys = keysOf(1);
  const auto bits = bitsOf(Payload{std::uint64_t{1}}, BodyRate::half, 1, keys);
  mesh.positions = embedRobust(mesh, encode(*bits, keys), keys.geometry)->positions;
  return mesh;
}

constexpr double kClaims[] = {0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001};

// How often a probability was at most each claim.
struct Curve {
  const char* name;
  int count = 0;
  std::array<int, std::size(kClaims)> atMost{};
  void add(double p) {
    ++count;
    for (std::size_t i = 0; i < std::size(kClaims); ++i) atMost[i] += p <= kClaims[i] ? 1 : 0;
  }
};

// Fewer votes cannot give small probabilities.
constexpr std::uint32_t kLeastVotes = 30;

}  // namespace

int main(int argc, char** argv) {
  int trials = 200, searches = 20, minutes = 10000;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    (name == "--trials" ? trials : name == "--searches" ? searches : minutes) = std::max(1, std::atoi(argv[i + 1]));
  }
  const Mesh plain = lab::sculpture(3000), marked = markedByAnother(plain);
  const std::vector<Mesh> innocents = {
      plain, marked, lab::quantize(lab::simplifyMeshopt(marked, 0.8), 14, lab::Grid::common), lab::machinedPart(2500),
      lab::quantize(markedByAnother(lab::machinedPart(2500)), 12, lab::Grid::common)};

  Curve ring{"A: labels that agree with an expected ID"}, diamonds{"B: coded bits that agree with it"},
      ringBound{"bound from A's ratios"}, diamondBound{"bound from B's ratios"}, verify{"whole search: expected ID"},
      read{"whole search: a frame read"};
  int frames = 0, readings = 0, matches = 0;
  Hypothesis ringView, diamondView;
  ringView.ringSigma = 1e-4;
  diamondView.layers = Layers::diamonds;
  diamondView.diamondSigma = 1.8e-5;
  for (int trial = 0; trial < trials; ++trial) {
    const SchemeKeys keys = keysOf(1000 + static_cast<std::uint64_t>(trial));
    const std::uint64_t id = Random::mix(static_cast<std::uint64_t>(trial));
    const CodedPayload expected = encode(*bitsOf(Payload{id}, BodyRate::half, 1, keys), keys);
    const bool search = trial < searches && static_cast<double>(std::clock()) / CLOCKS_PER_SEC < 60.0 * minutes;
    for (const Mesh& mesh : innocents) {
      MeshReader reader(mesh, keys.geometry, headCode());
      const Agreement labels = reader.ringAgreement(expected), bits = reader.diamondAgreement(expected, diamondView);
      if (labels.votes >= kLeastVotes) ring.add(exactExp(logChance(labels)));
      if (bits.votes >= kLeastVotes) diamonds.add(exactExp(logChance(bits)));
      ringBound.add(exactExp(logChance(Demapper(reader.headBits(ringView)).ratios(), expected.head)));
      diamondBound.add(exactExp(logChance(Demapper(reader.headBits(diamondView)).ratios(), expected.head)));
      if (!search) continue;
      MeshSource source(reader);
      const auto reading = readMark(source, {.keys = keys, .expected = Payload{id}});
      frames += reading->framed ? 1 : 0;
      readings += reading->id() ? 1 : 0;
      matches += reading->verdict == Verdict::match ? 1 : 0;
      verify.add(reading->expectedProbability);
      read.add(reading->readProbability);
    }
  }

  std::printf("| claimed p | ");
  for (const double claim : kClaims) std::printf("%g | ", claim);
  std::printf("trials |\n| --- |");
  for (std::size_t i = 0; i <= std::size(kClaims); ++i) std::printf(" --- |");
  std::printf("\n");
  for (const Curve* curve : {&ring, &diamonds, &ringBound, &diamondBound, &verify, &read}) {
    std::printf("| %s |", curve->name);
    for (const int n : curve->atMost) std::printf(" %.4f |", static_cast<double>(n) / std::max(1, curve->count));
    std::printf(" %d |\n", curve->count);
  }
  std::printf("\nWhole searches: %d. Frames whose 24-bit tag was right by accident: %d; IDs read: %d; matches: %d.\n",
              read.count, frames, readings, matches);
  return 0;
}
