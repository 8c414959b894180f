// SPDX-License-Identifier: MIT
// Marking, damaging and reading with the peers, in the words of their tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "../bench/peers/peers.h"
#include "models.h"
#include "quadmark/io/model.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/metrics.h"
#include "quadmark/random.h"

namespace quadmark::test {

inline bench::TrialPayload randomPayload(std::uint64_t seed, std::uint32_t width = 64, std::uint32_t height = 1) {
  bench::TrialPayload payload;
  payload.kind = height == 1 ? bench::TrialPayload::Kind::id : bench::TrialPayload::Kind::image;
  payload.width = width;
  payload.height = height;
  Random random(seed);
  for (std::uint32_t i = 0; i < width * height; ++i) payload.bits.push_back(static_cast<std::uint8_t>(random.next() & 1));
  return payload;
}

/// A model that a peer has marked with 64 bits under the key 7.
struct PeerTrial {
  const bench::Peer& peer;
  std::string settings;
  bench::TrialPayload payload = randomPayload(5);
  std::uint64_t key = 7;
  Mesh original, marked;  // as a file stores them
  bench::TrialMark mark;

  PeerTrial(const bench::Peer& of, const Mesh& mesh, const std::string& with = {},
            const std::optional<bench::TrialPayload>& of64 = {})
      : peer(of), settings(with.empty() ? of.usualSettings() : with), original(mesh) {
    if (of64) payload = *of64;
    auto result = peer.mark(mesh, payload, key, settings);
    EXPECT_TRUE(result) << peer.name() << ": " << result.error().message;
    if (!result) return;
    mark = std::move(*result);
    marked = mesh;
    marked.positions = mark.positions;
    roundToPrecision(marked);
  }

  [[nodiscard]] double errorRate(const Mesh& mesh) const { return errorRate(mesh, key); }
  /// One half where nothing is read.
  [[nodiscard]] double errorRate(const Mesh& mesh, std::uint64_t underKey) const {
    bench::TrialPayload asked = payload;
    asked.bits.clear();  // a blind reader does not know them
    const bench::TrialReading reading = peer.read(mesh, asked, underKey, settings);
    return reading.bits.empty() ? 0.5 : bitErrorRate(payload.bits, reading.bits, reading.unread);
  }
  [[nodiscard]] double after(const lab::AttackSpec& spec) const {
    const auto attacked = lab::attack(marked, spec);
    EXPECT_TRUE(attacked) << spec.kind;
    return attacked ? errorRate(*attacked) : 1;
  }
  [[nodiscard]] double rmsRel() const { return distortion(original, marked).rmsRel; }
};

/// A real model's mesh, or nothing where it is absent (said on stderr).
inline std::optional<Mesh> realMesh(const std::string& name) {
  const std::optional<FileBytes> bytes = modelBytes(name);
  if (!bytes) return std::nullopt;
  auto model = readModel(*bytes);
  EXPECT_TRUE(model) << name;
  if (!model) return std::nullopt;
  return (*model)->mesh();
}

/// A rotation by 30 degrees about x with a uniform scale of 1.7 and a shift.
inline lab::Affine similarityMap() { return {1.7, 0, 0, 3, 0, 1.47224319, -0.85, -2, 0, 0.85, 1.47224319, 5}; }

}  // namespace quadmark::test
