// SPDX-License-Identifier: MIT
#include "quadmark/payload.h"

#include <numeric>
#include <utility>

namespace quadmark {
namespace {

std::uint64_t labelItem(std::uint32_t prefix1, std::uint32_t prefix2) {
  return std::uint64_t{prefix1} << 32 | prefix2;
}

std::vector<std::uint32_t> arnold(std::uint64_t a, std::uint64_t b, std::uint32_t rounds, std::uint32_t side) {
  std::vector<std::uint32_t> target(std::size_t{side} * side);
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      std::uint64_t u = x, v = y;
      for (std::uint32_t i = 0; i < rounds; ++i) {
        const std::uint64_t next = (u + a * v) % side;
        v = (b * u + (a * b + 1) * v) % side;
        u = next;
      }
      target[std::size_t{y} * side + x] = static_cast<std::uint32_t>(v * side + u);
    }
  return target;
}

// Arnold maps have short periods where the side has small factors: of the maps for 24 x 24 every ninth is the identity.
// So the key gives a series of maps, of which the first that moves nearly everything is taken.
std::vector<std::uint32_t> keyedArnold(const Prf& prf, std::uint32_t side) {
  constexpr std::uint64_t kAttempts = 32;
  std::vector<std::uint32_t> best;
  std::size_t fewest = 0;
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    const std::uint64_t a = 1 + prf.below(3 * attempt, side - 1), b = 1 + prf.below(3 * attempt + 1, side - 1);
    std::vector<std::uint32_t> target = arnold(a, b, 2 + prf.below(3 * attempt + 2, 14), side);
    std::size_t unmoved = 0;
    for (std::size_t i = 0; i < target.size(); ++i) unmoved += target[i] == i;
    if (best.empty() || unmoved < fewest) {
      best = std::move(target);
      fewest = unmoved;
    }
    if (fewest <= side) break;
  }
  return best;
}

}  // namespace

std::uint32_t pieceCount(const PaperParams& params) {
  const std::uint32_t bits = 3 * static_cast<std::uint32_t>(params.H2 - params.L2 + 1);
  return (params.bitCount() + bits - 1) / bits;
}

std::vector<std::uint32_t> scrambling(const Key& key) {
  const Prf prf(key.secret, "quadmark/paper/scramble");
  if (key.params.width == key.params.height && key.params.width > 1) return keyedArnold(prf, key.params.width);
  std::vector<std::uint32_t> target(key.params.bitCount());
  std::iota(target.begin(), target.end(), 0u);
  for (std::uint32_t i = static_cast<std::uint32_t>(target.size()); i > 1; --i)
    std::swap(target[i - 1], target[prf.below(i, i)]);
  return target;
}

std::vector<std::uint32_t> toPieces(std::span<const std::uint8_t> bits, const Key& key) {
  const std::vector<std::uint32_t> target = scrambling(key);
  const std::uint32_t width = 3 * static_cast<std::uint32_t>(key.params.H2 - key.params.L2 + 1);
  std::vector<std::uint32_t> pieces(pieceCount(key.params), 0);
  for (std::size_t i = 0; i < bits.size(); ++i)
    if (bits[i]) pieces[target[i] / width] |= 1u << (width - 1 - target[i] % width);
  return pieces;
}

Pad::Pad(const Key& key)
    : pad_(key.secret, "quadmark/paper/pad"), choice_(key.secret, "quadmark/paper/cells"),
      decoy_(key.secret, "quadmark/paper/decoys"), mask_((1u << (3 * (key.params.H2 - key.params.L2 + 1))) - 1),
      keyedCells_(key.params.keyedCells) {}

std::uint32_t Pad::operator()(std::uint32_t index, std::uint32_t prefix1, std::uint32_t prefix2) const {
  // Two rounds, since index and both prefixes need more than 64 bits at the largest digit positions.
  return static_cast<std::uint32_t>(pad_(pad_(labelItem(prefix1, prefix2)) ^ index)) & mask_;
}

bool Pad::carries(std::uint32_t prefix1, std::uint32_t prefix2) const {
  return !keyedCells_ || (choice_(labelItem(prefix1, prefix2)) & 1) != 0;
}

}  // namespace quadmark
