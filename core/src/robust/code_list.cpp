// SPDX-License-Identifier: MIT
// List Viterbi decoding on the tail-biting trellis.
#include <algorithm>
#include <cstddef>

#include "quadmark/robust/code.h"
#include "trellis.h"

namespace quadmark::robust {
namespace {

struct Lap {
  std::vector<float> loss;            ///< [step][state]: metric that the path into the state gives up by the other branch
  std::vector<std::uint8_t> fromOdd;  ///< [step][state]: the better branch comes from the odd predecessor
};

// One step of add, compare, select; writes decisions when `loss` is given.
void advance(const Trellis& t, const std::vector<float>& branch, const std::vector<float>& before,
             std::vector<float>& after, float* loss, std::uint8_t* fromOdd) {
  for (std::uint32_t j = 0; j < t.half; ++j) {
    const float even = before[2 * j], odd = before[2 * j + 1], x = branch[j];
    const float a = even + x, b = odd - x, c = even - x, d = odd + x;
    after[j] = a >= b ? a : b;
    after[j + t.half] = c >= d ? c : d;
    if (loss != nullptr) {
      loss[j] = a >= b ? a - b : b - a;
      loss[j + t.half] = c >= d ? c - d : d - c;
      fromOdd[j] = a >= b ? 0 : 1;
      fromOdd[j + t.half] = c >= d ? 0 : 1;
    }
  }
}

// A path of the last lap: the one it branches off from, and where. States before the deviation follow the decisions.
struct Path {
  float metric;
  std::uint32_t order;   ///< creation number: breaks ties the same way everywhere
  std::int32_t parent;   ///< index of a traced path, -1 for the best path into an end state
  std::uint32_t at;      ///< step whose other branch is taken; the end state for parent -1
};

bool worse(const Path& a, const Path& b) { return a.metric != b.metric ? a.metric < b.metric : a.order > b.order; }

class PathSearch {
 public:
  PathSearch(const Trellis& trellis, const Lap& lap, const std::vector<float>& end, std::uint32_t steps,
             std::uint32_t limit)
      : trellis_(trellis), lap_(lap), steps_(steps), limit_(limit) {
    for (std::uint32_t s = 0; s < trellis.states(); ++s) push(end[s], -1, s);
  }

  /// The states 0 .. steps of the next best path; empty when there are no more.
  std::span<const std::uint16_t> next() {
    if (heap_.empty() || traced_.size() / (steps_ + 1) >= limit_) return {};
    std::pop_heap(heap_.begin(), heap_.end(), worse);
    const Path path = heap_.back();
    heap_.pop_back();
    const std::size_t first = traced_.size();
    traced_.resize(first + steps_ + 1);
    std::uint16_t* states = traced_.data() + first;
    std::uint32_t step = steps_;
    if (path.parent < 0) {
      states[steps_] = static_cast<std::uint16_t>(path.at);
    } else {
      const std::uint16_t* parent = traced_.data() + std::size_t(path.parent) * (steps_ + 1);
      for (; step > path.at; --step) states[step] = parent[step];
      states[path.at] = previous(path.at, parent[path.at + 1], true);
    }
    const std::uint32_t free = step;  // steps before this one may deviate
    for (; step-- > 0;) states[step] = previous(step, states[step + 1], false);
    const auto self = static_cast<std::int32_t>(first / (steps_ + 1));
    for (std::uint32_t s = 0; s < free; ++s)
      push(path.metric - lap_.loss[std::size_t{s} * trellis_.states() + states[s + 1]], self, s);
    return {states, steps_ + 1};
  }

 private:
  std::uint16_t previous(std::uint32_t step, std::uint32_t state, bool other) const {
    const bool odd = (lap_.fromOdd[std::size_t{step} * trellis_.states() + state] != 0) != other;
    return static_cast<std::uint16_t>((2 * state & (trellis_.states() - 1)) | (odd ? 1u : 0u));
  }

  void push(float metric, std::int32_t parent, std::uint32_t at) {
    heap_.push_back({metric, order_++, parent, at});
    std::push_heap(heap_.begin(), heap_.end(), worse);
  }

  const Trellis& trellis_;
  const Lap& lap_;
  std::uint32_t steps_, limit_, order_ = 0;
  std::vector<Path> heap_;
  std::vector<std::uint16_t> traced_;  ///< steps + 1 states per path handed out
};

}  // namespace

ListResult decodeList(const ConvolutionalCode& code, std::span<const float> ratios, std::uint32_t listSize,
                      const std::function<bool(std::span<const std::uint8_t> input)>& accept) {
  const Trellis trellis(code);
  const auto steps = static_cast<std::uint32_t>(ratios.size() / trellis.rate);
  std::vector<float> before(trellis.states(), 0), after(before), branch(trellis.half);
  Lap lap;
  lap.loss.resize(std::size_t{steps} * trellis.states());
  lap.fromOdd.resize(lap.loss.size());
  for (int round = 0; round < 3; ++round)
    for (std::uint32_t step = 0; step < steps; ++step) {
      trellis.branches(ratios, step, branch);
      const std::size_t at = std::size_t{step} * trellis.states();
      advance(trellis, branch, before, after, round == 2 ? lap.loss.data() + at : nullptr, lap.fromOdd.data() + at);
      std::swap(before, after);
    }

  // Most paths that do not close are near misses of ones that do; looking at a few times the list's size is enough.
  PathSearch search(trellis, lap, before, steps, 4 * listSize);
  ListResult result;
  std::vector<std::uint8_t> input(steps);
  while (result.tried < listSize) {
    const std::span<const std::uint16_t> states = search.next();
    if (states.empty()) break;
    if (states[0] != states[steps]) continue;
    for (std::uint32_t step = 0; step < steps; ++step)
      input[step] = static_cast<std::uint8_t>(states[step + 1] >> (code.memory - 1));
    ++result.tried;
    if (accept(input)) {
      result.accepted = true;
      break;
    }
  }
  return result;
}

}  // namespace quadmark::robust
