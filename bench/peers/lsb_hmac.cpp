// SPDX-License-Identifier: MIT
// The payload and an HMAC-SHA256 (RFC 2104) of it and of everything else in the model, in the least significant bits of
// the coordinates, in file order: common practice for proving that a file is unchanged.
//
// Decided here:
// - Payload and the first 128 bits of the code repeat over all coordinates, so that the payload can still be read by
//   majority where a part was touched.
// - The code covers the payload, all positions but for the bits that carry, and all faces. The reading is certain of itself
//   only if the code agrees and no copy of any bit differs.
// - On integer grids the lowest bit of the integer carries. Twins carry the bit of the first of them.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "../schemes/secret.h"
#include "keyed_bits.h"
#include "peer_mesh.h"
#include "settings.h"

namespace quadmark::bench {
namespace {

constexpr std::size_t kCodeBits = 128;

// A coordinate as an integer whose lowest bit may change.
struct Code {
  const CoordinateGrid* grid = nullptr;
  Precision precision = Precision::float32;
  std::uint64_t bits = 0;

  Code(double x, const CoordinateGrid* gridOf, Precision stored) : grid(gridOf), precision(stored) {
    x = x == 0 ? 0.0 : x;  // -0 and +0 may be twins
    if (grid != nullptr) {
      bits = static_cast<std::uint64_t>(std::llround(x * grid->divisor - grid->low));
    } else if (precision == Precision::float32) {
      const float narrow = static_cast<float>(x);
      std::uint32_t word = 0;
      std::memcpy(&word, &narrow, sizeof word);
      bits = word;
    } else {
      std::memcpy(&bits, &x, sizeof bits);
    }
  }
  [[nodiscard]] bool one() const { return (bits & 1) != 0; }
  [[nodiscard]] std::uint64_t rest() const { return bits & ~std::uint64_t{1}; }
  // Whether both values of the lowest bit can be stored.
  [[nodiscard]] bool carries() const {
    return grid == nullptr || static_cast<double>(rest() + 1) <= grid->high - grid->low;
  }
  [[nodiscard]] double with(bool bit) const {
    const std::uint64_t code = rest() | (bit ? 1u : 0u);
    if (grid != nullptr) return (static_cast<double>(code) + grid->low) / grid->divisor;
    if (precision == Precision::float32) {
      const auto word = static_cast<std::uint32_t>(code);
      float narrow = 0;
      std::memcpy(&narrow, &word, sizeof narrow);
      return narrow;
    }
    double wide = 0;
    std::memcpy(&wide, &code, sizeof wide);
    return wide;
  }
};

Code codeOf(const Mesh& mesh, std::size_t vertex, std::size_t axis) {
  return {mesh.positions[3 * vertex + axis], mesh.grid(vertex), mesh.precision};
}

Bits authenticationCode(const Mesh& mesh, const WeldedMesh& welded, const Bits& payload, std::uint64_t key) {
  std::vector<std::uint8_t> data(payload.begin(), payload.end());
  const auto append = [&data](std::uint64_t word) {
    for (int i = 0; i < 8; ++i) data.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
  };
  append(mesh.vertexCount());
  append(mesh.faceCount());
  for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Code code = codeOf(mesh, v, axis);
      append(welded.weldedOf[v] != kNoVertex && code.carries() ? code.rest() : code.bits);
    }
  }
  for (const std::uint32_t offset : mesh.faceOffsets) append(offset);
  for (const std::uint32_t v : mesh.faceVertices) append(v);
  const Digest digest = hmacSha256(secretOf(key, "lsb-hmac code"), data);
  Bits out;
  for (std::size_t i = 0; i < kCodeBits; ++i) out.push_back(static_cast<std::uint8_t>(digest[i / 8] >> (i % 8) & 1));
  return out;
}

class LsbHmac final : public Peer {
 public:
  std::string name() const override { return "lsb-hmac"; }
  std::string usualSettings() const override { return usualText({}); }
  PeerInfo info() const override {
    return {"H. Krawczyk, M. Bellare, R. Canetti",
            "HMAC: keyed-hashing for message authentication (in least significant bits of coordinates, in file order)",
            "common practice after RFC 2104",
            1997,
            true,
            "the lowest bit of a coordinate",
            describe({}),
            "payload and code repeat over the whole model and are read by majority",
            "detects any change of any coordinate or face; moves no coordinate by more than its last bit"};
  }

  Result<TrialMark> mark(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                         const std::string& text) const override {
    if (const auto values = settingValues(text, {}); !values) return values.error();
    const WeldedMesh welded = weld(mesh);
    if (const Status ok = checkMarkable(mesh, welded, payload); !ok) return ok.error();
    Bits stream = payload.bits;
    const Bits code = authenticationCode(mesh, welded, payload.bits, key);
    stream.insert(stream.end(), code.begin(), code.end());
    const KeyedBits bits(key, name(), stream.size());
    TrialMark out;
    out.capacityBits = 3 * welded.vertexCount() < kCodeBits ? 1 : 3 * welded.vertexCount() - kCodeBits;
    if (payload.bits.size() > out.capacityBits)
      return Error{ErrorCode::capacity, "lsb-hmac has room for " + std::to_string(out.capacityBits) + " bits here"};
    const std::vector<std::uint32_t> first = firstTwins(welded);
    std::vector<double> moved = welded.positions;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const Code from = codeOf(mesh, first[i / 3], i % 3);
      if (!from.carries()) continue;
      const std::size_t bit = bits.bitAt(3 * std::uint64_t{first[i / 3]} + i % 3);
      moved[i] = from.with(bits.padded(bit, stream[bit]));
      ++out.carriers;
    }
    out.positions = unwelded(mesh, welded, moved);
    return readableMark(*this, mesh, payload, key, text, std::move(out));
  }

  TrialReading read(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                    const std::string& text) const override {
    if (bitCount(payload) == 0 || !settingValues(text, {})) return {};
    const WeldedMesh welded = weld(mesh);
    const std::vector<std::uint32_t> first = firstTwins(welded);
    const KeyedBits bits(key, name(), bitCount(payload) + kCodeBits);
    BitVotes votes(bits);
    for (std::size_t i = 0; i < welded.positions.size(); ++i) {
      const Code code = codeOf(mesh, first[i / 3], i % 3);
      if (code.carries()) votes.add(3 * std::uint64_t{first[i / 3]} + i % 3, code.one() ? 1 : -1);
    }
    TrialReading stream = votes.reading(), out;
    if (stream.bits.empty()) return out;
    const auto split = static_cast<std::ptrdiff_t>(bitCount(payload));
    out.bits.assign(stream.bits.begin(), stream.bits.begin() + split);
    out.unread.assign(stream.unread.begin(), stream.unread.begin() + split);
    const Bits code(stream.bits.begin() + split, stream.bits.end());
    out.certain = votes.unanimous() && std::count(stream.unread.begin(), stream.unread.end(), 1) == 0 &&
                  code == authenticationCode(mesh, welded, out.bits, key);
    return out;
  }
};

}  // namespace

std::unique_ptr<Peer> lsbHmac() {
  return std::make_unique<LsbHmac>();
}

}  // namespace quadmark::bench
