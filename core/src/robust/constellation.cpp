// SPDX-License-Identifier: MIT
#include "constellation.h"

#include <numeric>
#include <utility>

namespace quadmark::robust {
namespace {

// Fisher-Yates, driven by a keyed function of (domain, place).
void keyedShuffle(std::vector<std::uint32_t>& values, const Prf& prf, std::uint64_t domain) {
  for (std::size_t i = values.size(); i > 1; --i)
    std::swap(values[i - 1], values[prf.below(domain << 32 | i, static_cast<std::uint32_t>(i))]);
}

// The order in which a stream's coded bits get slots: generators 0 and 1 first, then the rest, each in keyed order.
std::vector<std::uint32_t> bitOrder(const StreamCode& code, const Prf& prf, std::uint64_t domain) {
  std::vector<std::uint32_t> out;
  for (int late = 0; late < 2; ++late) {
    std::vector<std::uint32_t> part;
    for (std::uint32_t i = 0; i < code.bits; ++i)
      if ((!code.generator.empty() && code.generator[i] >= 2) == (late == 1)) part.push_back(i);
    keyedShuffle(part, prf, 2 * domain + static_cast<std::uint64_t>(late));
    out.insert(out.end(), part.begin(), part.end());
  }
  return out;
}

}  // namespace

Constellation::Constellation(std::uint8_t deltaClass, const RobustKeys& keys, Sharing sharing, const StreamCode& head,
                             const StreamCode& body)
    : shape_(kDeltas[deltaClass]), groups_(shape_.groups()) {
  std::vector<std::uint32_t> cells(shape_.cells());
  std::iota(cells.begin(), cells.end(), 0u);
  keyedShuffle(cells, Prf(keys.constellation), deltaClass);
  meaning_.assign(cells.size(), kNone);
  for (std::uint32_t i = 0; i < groups_ * symbols(); ++i) meaning_[cells[i]] = i;

  // Which groups carry the head: all, or the first few of a keyed order.
  std::vector<std::uint32_t> order(groups_);
  std::iota(order.begin(), order.end(), 0u);
  keyedShuffle(order, Prf(keys.share), 1000 + std::uint64_t{deltaClass});
  const std::uint32_t headGroups = sharing == Sharing::headOnly ? groups_ : (groups_ * kHeadSixteenths + 8) / 16;
  slots_.resize(std::size_t{groups_} * shape_.symbol);
  const Prf assignment(keys.assignment);
  const auto assign = [&](Stream stream, const StreamCode& code, std::uint32_t begin, std::uint32_t end) {
    const std::uint64_t domain = 100 + 2 * std::uint64_t{deltaClass} + (stream == Stream::body ? 1 : 0);
    const std::vector<std::uint32_t> bits = bitOrder(code, assignment, domain);
    std::size_t next = 0;
    for (std::uint32_t g = begin; g < end; ++g)
      for (std::uint32_t t = 0; t < shape_.symbol; ++t)
        slots_[std::size_t{order[g]} * shape_.symbol + t] = {stream, bits.empty() ? 0 : bits[next++ % bits.size()]};
  };
  assign(Stream::head, head, 0, headGroups);
  assign(Stream::body, body, headGroups, groups_);
}

std::vector<std::uint32_t> Constellation::goodSymbols(const CodedPayload& payload) const {
  std::vector<std::uint32_t> out(groups_, 0);
  for (std::uint32_t g = 0; g < groups_; ++g)
    for (std::uint32_t t = 0; t < shape_.symbol; ++t) {
      const Slot& s = slot(g, t);
      const auto& bits = s.stream == Stream::head ? payload.head : payload.body;
      if (s.bit < bits.size() && bits[s.bit] != 0) out[g] |= 1u << t;
    }
  return out;
}

}  // namespace quadmark::robust
