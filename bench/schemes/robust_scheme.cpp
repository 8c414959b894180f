// SPDX-License-Identifier: MIT
#include <utility>

#include "ours.h"
#include "quadmark/robust/marker.h"
#include "quadmark/robust/parts.h"
#include "secret.h"

namespace quadmark::bench {
namespace {

using namespace robust;

SchemeKeys keysOf(std::uint64_t key) { return deriveKeys(secretOf(key, "robust"), "").value(); }

Payload payloadOf(const TrialPayload& payload) {
  if (payload.kind == TrialPayload::Kind::image) return BitImage{payload.width, payload.height, payload.bits};
  std::uint64_t id = 0;
  for (const std::uint8_t bit : payload.bits) id = id << 1 | bit;
  return id;
}

Bits bitsOfId(std::uint64_t id) {
  Bits bits(64);
  for (int i = 0; i < 64; ++i) bits[i] = static_cast<std::uint8_t>(id >> (63 - i) & 1);
  return bits;
}

class RobustScheme : public Scheme {
 public:
  std::string name() const override { return "robust"; }
  std::string usualSettings() const override { return strengthName(Strength::standard); }

  Result<TrialMark> mark(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                         const std::string& settings) const override {
    const auto strength = strengthFrom(settings);
    if (!strength) return strength.error();
    auto marked = markMesh(mesh, payloadOf(payload), keysOf(key), EmbedOptions{*strength});
    if (!marked) return marked.error();
    RobustEmbedding& e = marked->embedding;
    return TrialMark{std::move(e.positions), 0, std::size_t{e.carriers} + e.cells};
  }

  TrialReading read(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                    const std::string&) const override {
    const SchemeKeys keys = keysOf(key);
    const auto scene = readScene(mesh, {keys, payloadOf(payload)});
    if (!scene) return {};
    const MarkReading& reading = scene->reading;
    TrialReading out;
    out.claim = reading.falsePositive;
    if (!reading.framed || reading.readProbability > kMatchProbability) return out;
    const Frame& frame = *reading.frame;
    if (payload.kind == TrialPayload::Kind::id) {
      out.certain = true;
      if (frame.kind == PayloadKind::id) out.bits = bitsOfId(frame.field);
      return out;
    }
    const auto shape = bodyShape(frame);
    if (!shape || shape->kind != PayloadKind::image || shape->width != payload.width || shape->height != payload.height) {
      out.certain = true;  // of something else
      return out;
    }
    if (!reading.body) return out;
    if (reading.body->exact) out.certain = true;
    out.bits = reading.body->bits;
    for (std::size_t i = 0; i < out.bits.size(); ++i) {
      out.unread.push_back(isUnread(reading.body->ratios[i]) ? 1 : 0);
      if (out.unread[i] != 0) out.bits[i] = 0;
    }
    return out;
  }
};

}  // namespace

std::unique_ptr<Scheme> makeRobust() { return std::make_unique<RobustScheme>(); }

}  // namespace quadmark::bench
