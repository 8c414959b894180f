// SPDX-License-Identifier: MIT
// quadmark_chance: how often chance looks like a mark to each layer of the robust scheme. Wrong keys on unmarked models
// and on other keys' marks; the table "claimed and observed" of docs/robust.md. Whole readings, of every scheme, are
// counted by bench/evaluate --experiment chance.
//
//   quadmark_chance [--trials N]     keys per model
//
// Prints a Markdown table of the share of trials with p at most the claimed one, for each layer's own test and for the
// bounds that verdicts are made of.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "quadmark/exact_math.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/random.h"
#include "quadmark/robust/demapper.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/robust/evidence.h"
#include "quadmark/robust/frame.h"
#include "quadmark/robust/keys.h"
#include "quadmark/robust/reader.h"

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
  std::array<double, std::size(kClaims)> exact{};  // of counted votes: how many trials should be
  void add(double p) {
    ++count;
    for (std::size_t i = 0; i < std::size(kClaims); ++i) atMost[i] += p <= kClaims[i] ? 1 : 0;
  }
  // Tails come in steps: of so many votes, the largest that is at most a claim is what happens.
  void add(const Agreement& votes) {
    add(exactExp(logChance(votes)));
    for (std::size_t i = 0; i < std::size(kClaims); ++i) {
      std::uint32_t agreeing = votes.votes / 2;
      double p = 1;
      while (agreeing <= votes.votes && (p = exactExp(logChance(Agreement{votes.votes, agreeing}))) > kClaims[i])
        ++agreeing;
      exact[i] += agreeing <= votes.votes ? p : 0;
    }
  }
};

// Fewer votes cannot give small probabilities.
constexpr std::uint32_t kLeastVotes = 30;

}  // namespace

int main(int argc, char** argv) {
  const bool asked = argc == 3 && std::string(argv[1]) == "--trials";
  if (argc != 1 && !asked) {
    std::fprintf(stderr, "usage: quadmark_chance [--trials N]\n");
    return 2;
  }
  const int trials = asked ? std::max(1, std::atoi(argv[2])) : 200;
  const Mesh plain = lab::sculpture(3000), marked = markedByAnother(plain);
  const std::vector<Mesh> innocents = {
      plain, marked, lab::quantize(lab::simplifyMeshopt(marked, 0.8), 14, lab::Grid::common), lab::machinedPart(2500),
      lab::quantize(markedByAnother(lab::machinedPart(2500)), 12, lab::Grid::common)};

  Curve ring{"A: labels that agree with an expected ID"}, diamonds{"B: coded bits that agree with it"},
      ringBound{"bound from A's ratios"}, diamondBound{"bound from B's ratios"};
  Hypothesis ringView, diamondView;
  ringView.ringSigma = 1e-4;
  diamondView.layers = Layers::diamonds;
  diamondView.diamondSigma = 1.8e-5;
  for (int trial = 0; trial < trials; ++trial) {
    const SchemeKeys keys = keysOf(1000 + static_cast<std::uint64_t>(trial));
    const std::uint64_t id = Random::mix(static_cast<std::uint64_t>(trial));
    const CodedPayload expected = encode(*bitsOf(Payload{id}, BodyRate::half, 1, keys), keys);
    for (const Mesh& mesh : innocents) {
      MeshReader reader(mesh, keys.geometry, headCode());
      const Agreement labels = reader.ringAgreement(expected), bits = reader.diamondAgreement(expected, diamondView);
      if (labels.votes >= kLeastVotes) ring.add(labels);
      if (bits.votes >= kLeastVotes) diamonds.add(bits);
      ringBound.add(exactExp(logChance(Demapper(reader.headBits(ringView)).ratios(), expected.head)));
      diamondBound.add(exactExp(logChance(Demapper(reader.headBits(diamondView)).ratios(), expected.head)));
    }
  }

  std::printf("| claimed p | ");
  for (const double claim : kClaims) std::printf("%g | ", claim);
  std::printf("trials |\n| --- |");
  for (std::size_t i = 0; i <= std::size(kClaims); ++i) std::printf(" --- |");
  std::printf("\n");
  for (const Curve* curve : {&ring, &diamonds, &ringBound, &diamondBound}) {
    std::printf("| %s |", curve->name);
    for (const int n : curve->atMost) std::printf(" %.4f |", static_cast<double>(n) / std::max(1, curve->count));
    std::printf(" %d |\n", curve->count);
    if (curve->exact[0] == 0) continue;
    std::printf("| exact tails of as many votes |");
    for (const double n : curve->exact) std::printf(" %.4f |", n / std::max(1, curve->count));
    std::printf(" |\n");
  }
  return 0;
}
