// SPDX-License-Identifier: MIT
#include "lattice.h"

#include "quadmark/random.h"

namespace quadmark::robust {

RingPlace RingCode::place(std::uint64_t label, int coordinate, std::uint32_t bits) const {
  RingPlace out;
  std::uint64_t item = label ^ (coordinate == 0 ? 0 : 0x9e3779b97f4a7c15u);
  for (std::uint32_t t = 0; t < bits; ++t, item += 0xd1342543de82ef95u) {
    const std::uint64_t word = dither_(item);
    out.slot[t].pad = (word & 1) != 0;
    out.slot[t].index = static_cast<std::uint32_t>(word >> 32);
    out.slot[t].headWhenSplit = share_(item) % 16 < kHeadSixteenths;
    if (t == 0) out.offset = static_cast<double>(Random::mix(word) >> 11) * 0x1p-53;
  }
  return out;
}

std::uint32_t valueAt(std::span<const RingSlot> slots, const CodedPayload& payload, Sharing sharing) {
  std::uint32_t value = 0;
  for (std::size_t t = 0; t < slots.size(); ++t) {
    const auto& coded = slots[t].stream(sharing) == Stream::head ? payload.head : payload.body;
    if (coded.empty()) continue;
    const bool bit = (coded[slots[t].index % coded.size()] != 0) != slots[t].pad;
    value |= static_cast<std::uint32_t>(bit) << t;
  }
  return value;
}

std::uint32_t valueOfPoint(std::uint32_t k, std::uint32_t bits) {
  const std::uint32_t turn = 2u << bits, phase = 2 * k + 1;
  std::uint32_t value = phase > turn / 2 ? 2 : 0;
  for (std::uint32_t t = 0; t < bits; ++t)
    if (t != 1) {
      const std::uint32_t quarters = 4 * (t == 0 ? phase : phase << (t - 1));
      value |= ((quarters + turn) % (4 * turn) > 2 * turn ? 1u : 0u) << t;  // the cosine is negative
    }
  return value;
}

double phaseOf(std::uint32_t value, std::uint32_t bits) {
  if (bits == 1) return 0.5 * value;
  std::uint32_t k = 0;
  while (valueOfPoint(k, bits) != value) ++k;
  return (k + 0.5) / (1u << bits);
}

double bitVote(double coordinate, double step, double offset, std::uint32_t t) {
  if (t == 0) return latticeVote(coordinate, step, offset);
  if (t == 1) return latticeVote(coordinate, step, offset + 0.25);
  const double times = 1u << (t - 1);
  return latticeVote(coordinate, step / times, offset * times);
}

}  // namespace quadmark::robust
