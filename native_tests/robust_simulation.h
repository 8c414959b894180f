// SPDX-License-Identifier: MIT
// Log-likelihood ratios as a mesh would give them, without a mesh: for the layers of the robust scheme above the waist.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "quadmark/random.h"
#include "quadmark/robust/mark.h"

namespace quadmark::robust {

inline std::vector<std::uint8_t> randomBits(std::size_t count, Random& random) {
  std::vector<std::uint8_t> bits(count);
  for (std::uint8_t& bit : bits) bit = static_cast<std::uint8_t>(random.below(2));
  return bits;
}

inline double gaussian(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

/// Honest ratios of a codeword sent as +1 (bit 0) and -1 through Gaussian noise of the given deviation.
inline std::vector<float> noisy(const std::vector<std::uint8_t>& codeword, double deviation, Random& random) {
  std::vector<float> ratios(codeword.size());
  for (std::size_t i = 0; i < codeword.size(); ++i) {
    const double received = (codeword[i] != 0 ? -1 : 1) + deviation * gaussian(random);
    ratios[i] = static_cast<float>(2 * received / (deviation * deviation));
  }
  return ratios;
}

/// Hypotheses of which one fits the mark (if there is one); the others give noise.
class SimulatedSource : public BitSource {
 public:
  SimulatedSource(std::optional<CodedPayload> mark, double deviation, std::uint64_t seed)
      : mark_(std::move(mark)), deviation_(deviation), seed_(seed) {}

  bool search(const AcceptHead& accept) override {
    for (const Hypothesis& h : plan())
      if (accept(headBits(h), h)) return true;
    return false;
  }
  [[nodiscard]] std::vector<Hypothesis> plan() const override {
    std::vector<Hypothesis> all(20);
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].sharing = i % 2 == 0 ? Sharing::headOnly : Sharing::split;
      all[i].number = static_cast<std::uint32_t>(i + 1);
    }
    return all;
  }
  SoftBits headBits(const Hypothesis& h) override {
    const bool fits = mark_ && rightHypothesis(h);
    return {ratios(fits ? mark_->head : std::vector<std::uint8_t>(headCode().bits), fits, 2 * h.number)};
  }
  SoftBits bodyBits(const Hypothesis& h, const StreamCode& body) override {
    const bool fits = mark_ && rightHypothesis(h) && mark_->body.size() == body.bits;
    return {ratios(fits ? mark_->body : std::vector<std::uint8_t>(body.bits), fits, 2 * h.number + 1)};
  }
  Agreement ringAgreement(const CodedPayload& expected, double sharpening, bool mirrored) override {
    Random random(seed_ ^ 0x51 ^ static_cast<std::uint64_t>(sharpening * 1000));
    Agreement out{labels, 0};
    const bool right = mark_ && expected.head == mark_->head && sharpening == 0 && !mirrored;
    for (std::uint32_t i = 0; i < labels; ++i) out.agreeing += random.below(100) < (right ? 80u : 50u) ? 1 : 0;
    return out;
  }
  [[nodiscard]] bool couldHaveRead() const override { return covered; }

  bool covered = true;
  std::uint32_t labels = 0;
  double overstatement = 1;  ///< factor by which the ratios claim too much
  double erasedShare = 0;

 private:
  [[nodiscard]] bool rightHypothesis(const Hypothesis& h) const { return h.number == (mark_->hasBody() ? 8u : 7u); }
  std::vector<float> ratios(const std::vector<std::uint8_t>& codeword, bool fits, std::uint64_t stream) const {
    Random random(Random::mix(seed_) ^ Random::mix(stream));
    std::vector<float> out = noisy(codeword, deviation_, random);
    for (float& ratio : out) {
      if (!fits && random.below(2) == 1) ratio = -ratio;
      ratio = random.uniform() < erasedShare ? 0 : static_cast<float>(ratio * overstatement);
    }
    return out;
  }

  std::optional<CodedPayload> mark_;
  double deviation_;
  std::uint64_t seed_;
};

}  // namespace quadmark::robust
