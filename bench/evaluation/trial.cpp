// SPDX-License-Identifier: MIT
#include "trial.h"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "quadmark/metrics.h"
#include "quadmark/prf.h"
#include "quadmark/random.h"
#include "quadmark/verdict.h"
#include "schemes/secret.h"

namespace quadmark::bench {
namespace {

constexpr std::uint32_t kLargestSide = 128;

// A ring with a bar through it, as a logo might be: large areas of one value.
Bits emblem(std::uint32_t side) {
  Bits bits;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const double u = (x + 0.5) / side - 0.5, v = (y + 0.5) / side - 0.5, r = std::sqrt(u * u + v * v);
      bits.push_back((r > 0.33 && r < 0.46) || (std::fabs(u - v) < 0.06 && u > 0.05 && u < 0.45));
    }
  return bits;
}

Result<TrialPayload> payloadNamed(const std::string& name, std::uint64_t seed) {
  TrialPayload payload;
  if (name == "id") {
    Random random(Random::mix(seed));
    for (int i = 0; i < 64; ++i) payload.bits.push_back(static_cast<std::uint8_t>(random.next() >> 63));
    return payload;
  }
  const auto side = name.rfind("image:", 0) == 0 ? static_cast<std::uint32_t>(std::strtoul(name.c_str() + 6, nullptr, 10)) : 0;
  if (side < 2 || side > kLargestSide)
    return Error{ErrorCode::badOption, "payload \"" + name + "\" is neither id nor image:SIDE with a side of 2.." +
                                           std::to_string(kLargestSide)};
  payload.kind = TrialPayload::Kind::image;
  payload.width = payload.height = side;
  payload.bits = emblem(side);
  return payload;
}

void applyPad(Bits& bits, std::uint64_t key) {
  const Prf pad(secretOf(key, "evaluation"), "whitening");
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] ^= static_cast<std::uint8_t>(pad(i / 64) >> (i % 64) & 1);
}

}  // namespace

Result<Trial> makeTrial(const std::string& scheme, const std::string& settings, const std::string& payload,
                        std::uint64_t seed) {
  const auto found = schemeNamed(scheme);
  if (!found) return found.error();
  auto meant = payloadNamed(payload, seed);
  if (!meant) return meant.error();
  Trial trial{*found, settings.empty() ? (*found)->usualSettings() : settings, payload, seed, *meant, *meant};
  applyPad(trial.whitened.bits, seed);
  return trial;
}

Result<MarkedTrial> markTrial(const Trial& trial, const Mesh& mesh) {
  auto mark = trial.scheme->mark(mesh, trial.whitened, trial.seed, trial.settings);
  if (!mark) return mark.error();
  if (mark->positions.size() != mesh.positions.size())
    return Error{ErrorCode::internal, trial.scheme->name() + ": another number of positions than the model has"};
  MarkedTrial marked{mesh, std::move(*mark)};
  marked.mesh.positions = marked.mark.positions;
  roundToPrecision(marked.mesh);
  marked.mark.positions = marked.mesh.positions;
  return marked;
}

Judgement readTrial(const Trial& trial, const Mesh& mesh) {
  const Bits& expected = trial.payload.bits;
  const std::size_t count = expected.size();
  TrialReading reading;
  if (boundingDiagonal(mesh) > 0) reading = trial.scheme->read(mesh, trial.whitened, trial.seed, trial.settings);
  const bool found = reading.bits.size() == count;
  Judgement out;
  out.bits = found ? std::move(reading.bits) : Bits(count, 0);
  out.erased = !found ? Bits(count, 1) : reading.unread.size() == count ? std::move(reading.unread) : Bits(count, 0);
  applyPad(out.bits, trial.seed);
  std::size_t read = 0, right = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (out.erased[i] != 0) {
      out.bits[i] = 0;
      continue;
    }
    ++read;
    right += out.bits[i] == expected[i] ? 1 : 0;
  }
  out.bitErrorRate = bitErrorRate(expected, out.bits, out.erased);
  out.unread = static_cast<double>(count - read) / static_cast<double>(count);
  out.claim = reading.claim ? *reading.claim : referenceProbability(read, right);
  const bool certain = reading.certain.value_or(false), all = right == count;
  if (certain && !all) out.outcome = "wrong";
  else if (all && (certain || out.claim <= kMatchProbability)) out.outcome = "exact";
  else out.outcome = out.claim <= kMatchProbability ? "match" : "lost";
  return out;
}

}  // namespace quadmark::bench
