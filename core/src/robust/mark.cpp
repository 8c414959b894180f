// SPDX-License-Identifier: MIT
#include "quadmark/robust/mark.h"

#include <algorithm>
#include <array>

#include "quadmark/exact_math.h"
#include "quadmark/robust/code.h"
#include "quadmark/robust/demapper.h"
#include "quadmark/robust/evidence.h"
#include "sorting.h"

namespace quadmark::robust {
namespace {

// IDs are 2^64 frames, short texts fewer than that, images and long texts 2^57 each.
constexpr double kLogFrames = 66 * kLn2;
// Of an expected payload: ratios of the head, labels, pixels.
constexpr double kLogExpectedTests = 0x1.193ea7aad030bp+0;  // log 3
constexpr std::array<double, 5> kSharpenings = {0, 0.1, 0.3, 0.6, 1.0};
// Where no hypothesis gives an exact body, this many are decoded, best head first.
constexpr std::size_t kBodyHypotheses = 8;

double logOf(double count) { return exactLog(count); }

// All coded forms of an expected payload: a writer may have chosen any rate and strength for a body.
std::vector<PayloadBits> variantsOf(const Payload& expected, const SchemeKeys& keys, Error& error) {
  std::vector<PayloadBits> variants;
  for (const BodyRate rate : {BodyRate::half, BodyRate::third, BodyRate::plain})
    for (std::uint8_t strength = 0; strength < 3; ++strength) {
      auto bits = bitsOf(expected, rate, strength, keys);
      if (!bits) {
        error = bits.error();
        return {};
      }
      const bool hasBody = !bits->body.empty();
      variants.push_back(std::move(*bits));
      if (!hasBody) return variants;
    }
  return variants;
}

class Reading {
 public:
  Reading(BitSource& source, const ReadRequest& request, std::vector<PayloadBits> variants)
      : source_(source), request_(request), variants_(std::move(variants)), plan_(source.plan()) {
    for (const PayloadBits& variant : variants_) coded_.push_back(encode(variant, request.keys));
    logAll_ = logOf(static_cast<double>(std::max<std::size_t>(1, plan_.size())));
    logTag_ = std::min(0.0, logAll_ + logOf(kListSize) - kTagBits * kLn2);
  }

  MarkReading run() {
    const bool stopped = source_.search([this](const SoftBits& head, const Hypothesis& h) { return look(head, h); });
    static_cast<void>(stopped);
    if (out_.cancelled) return out_;
    if (out_.frame) {
      out_.framed = true;
      strengthen();
    }
    verify();
    readBody();
    decide();
    return out_;
  }

 private:
  // One hypothesis: try to read a frame, remember how well the expected one fits. True ends the search.
  bool look(const SoftBits& bits, const Hypothesis& hypothesis) {
    out_.hypotheses = hypothesis.number;
    if (request_.progress &&
        !request_.progress(static_cast<double>(hypothesis.number) / static_cast<double>(plan_.size() + 1))) {
      out_.cancelled = true;
      return true;
    }
    // Tried: Demapper::iterate() here, two and four rounds: not one more of 240 readings near the limit. Bodies gain by it.
    const std::vector<float> head = Demapper(bits).ratios();
    for (std::size_t i = 0; i < coded_.size(); ++i) {
      if (coded_[i].hasBody() != (hypothesis.sharing == Sharing::split)) continue;
      const double chance = logChance(head, coded_[i].head);
      if (chance < expectedChance_) {
        expectedChance_ = chance;
        expectedVariant_ = i;
        expectedHypothesis_ = hypothesis;
      }
    }
    std::optional<Frame> frame;
    static_cast<void>(decodeList(thirdRateCode(), head, kListSize, [&](std::span<const std::uint8_t> input) {
      frame = parseFrame(input, request_.keys);
      // A payload with a body has shared its slots out, one without has not: the wrong kind is an accident.
      if (frame && bodyShape(*frame).has_value() != (hypothesis.sharing == Sharing::split)) frame.reset();
      return frame.has_value();
    }));
    if (!frame) return false;
    const std::vector<std::uint8_t> codeword = headOf(*frame);
    const double chance = std::min(logTag_, kLn2 + logAll_ + kLogFrames + logChance(head, codeword));
    if (!out_.frame || chance < logFrame_) {
      logFrame_ = chance;
      out_.frame = frame;
      out_.hypothesis = hypothesis;
    }
    return probabilityFromLog(logFrame_ + logKeys()) <= kMatchProbability;
  }

  std::vector<float> headRatios(const Hypothesis& hypothesis) {
    const SoftBits bits = source_.headBits(hypothesis);
    return Demapper(bits).ratios();
  }

  std::vector<std::uint8_t> headOf(const Frame& frame) const {
    const auto shape = bodyShape(frame);
    PayloadBits bits{frame, {}};
    if (shape) bits.body.assign(shape->bits(), 0);
    return encode(bits, request_.keys).head;
  }

  // Thousands of labels say more than the few hundred sums that were decoded.
  void strengthen() {
    if (bodyShape(*out_.frame)) return;
    const CodedPayload coded = encode({*out_.frame, {}}, request_.keys);
    const Agreement votes = source_.ringAgreement(coded, out_.hypothesis->sharpening, out_.hypothesis->mirrored);
    logFrame_ = std::min(logFrame_, kLn2 + logOf(2 * kSharpenings.size()) + kLogFrames + logChance(votes));
  }

  void verify() {
    if (variants_.empty()) return;
    const double tests = logOf(static_cast<double>(variants_.size()));
    double best = tests + logAll_ + expectedChance_;
    // Labels are counted only where the rest is not clear: sharpening the mesh anew takes time.
    if (probabilityFromLog(best + logKeys()) > 1e-12)
      for (std::size_t i = 0; i < coded_.size(); ++i)
        for (const double sharpening : kSharpenings) {
          const double chance = tests + logOf(kSharpenings.size()) + logChance(source_.ringAgreement(coded_[i], sharpening, false));
          if (chance >= best) continue;
          best = chance;
          expectedVariant_ = i;
        }
    logExpected_ = std::min(0.0, kLogExpectedTests + best);
    out_.expectedProbability = probabilityFromLog(logExpected_ + logKeys());
  }

  void readBody() {
    // Verified, but not read: the expected shape says how to read what is left of the body.
    const bool verified = !out_.frame && out_.expectedProbability <= kMatchProbability && expectedHypothesis_;
    const std::optional<Frame> frame = verified ? std::optional(variants_[expectedVariant_].frame) : out_.frame;
    if (!frame) return;
    if (verified) {
      out_.frame = frame;
      out_.hypothesis = expectedHypothesis_;
    }
    const std::optional<BodyShape> shape = bodyShape(*frame);
    if (!shape) return;
    const StreamCode code = bodyCode(*shape);
    const std::vector<std::uint8_t> head = headOf(*frame);
    std::uint32_t tried = 0;
    const auto decode = [&](const Hypothesis& h, float scale) {
      BodyReading reading = decodeBody(*shape, source_.bodyBits(h, code), request_.keys, scale);
      ++tried;
      if (!out_.body || reading.exact) {
        out_.body = std::move(reading);
        out_.hypothesis = h;
      }
      return out_.body->exact;
    };

    const std::vector<float> found = headRatios(*out_.hypothesis);
    if (!decode(*out_.hypothesis, honestScale(found, head))) {
      // The first hypothesis that gave the short head need not be the best for the rest: ask the head which one is.
      struct Candidate {
        double chance;
        std::size_t index;
        float scale;
      };
      std::vector<Candidate> candidates;
      for (std::size_t i = 0; i < plan_.size(); ++i) {
        if (plan_[i].sharing != Sharing::split || plan_[i].mirrored != out_.hypothesis->mirrored) continue;
        const std::vector<float> ratios = headRatios(plan_[i]);
        candidates.push_back({logChance(ratios, head), i, honestScale(ratios, head)});
      }
      sortCompactly(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.chance != b.chance ? a.chance < b.chance : a.index < b.index;
      });
      if (candidates.size() > kBodyHypotheses) candidates.resize(kBodyHypotheses);
      out_.body.reset();  // the best of them is shown if none is exact
      for (const Candidate& c : candidates)
        if (decode(plan_[c.index], c.scale)) break;
    }
    if (out_.framed && out_.body && out_.body->exact)
      logFrame_ = std::min(logFrame_, kLn2 + logTag_ + logOf(tried * kBodyTries) - kBodyTagBits * kLn2);
    comparePixels();
  }

  // Pixels were whitened by the key, so under any other key each agrees with the reference by a coin flip.
  void comparePixels() {
    if (variants_.empty() || !out_.body || variants_[0].body.size() != out_.body->bits.size()) return;
    Agreement pixels;
    for (std::size_t i = 0; i < out_.body->bits.size(); ++i) {
      if (out_.body->ratios[i] == 0) continue;
      ++pixels.votes;
      pixels.agreeing += out_.body->bits[i] == variants_[0].body[i] ? 1 : 0;
    }
    logExpected_ = std::min(logExpected_, kLogExpectedTests + logChance(pixels));
    out_.expectedProbability = probabilityFromLog(logExpected_ + logKeys());
  }

  void decide() {
    const bool asked = !variants_.empty();
    double chance = out_.framed ? logFrame_ : 0;
    out_.readProbability = probabilityFromLog(chance + logKeys());
    if (asked) {
      chance = std::min(0.0, kLn2 + std::min(chance, logExpected_));
      out_.comparison = compare();
    }
    out_.falsePositive = probabilityFromLog(chance + logKeys());
    const bool exactKind = asked && variants_[0].frame.kind != PayloadKind::image;
    if (out_.comparison == Comparison::differs && exactKind) {
      out_.verdict = Verdict::none;  // certainly this key's, but not what was asked for
      out_.falsePositive = 1;
    } else if (out_.falsePositive <= kMatchProbability) {
      out_.verdict = Verdict::match;
    } else if (out_.falsePositive <= kDoubtProbability || !source_.couldHaveRead()) {
      out_.verdict = Verdict::inconclusive;
    } else {
      out_.verdict = Verdict::none;
    }
  }

  Comparison compare() const {
    const bool readSurely = out_.readProbability <= kMatchProbability;
    if (readSurely)
      for (const PayloadBits& variant : variants_)
        if (variant.frame == *out_.frame) return Comparison::agrees;
    // An image need not be equal to be recognised.
    if (out_.expectedProbability <= kMatchProbability && (!readSurely || out_.body)) return Comparison::agrees;
    return readSurely ? Comparison::differs : Comparison::unknown;
  }

  double logKeys() const { return logOf(std::max(1u, request_.keysTried)); }

  BitSource& source_;
  const ReadRequest& request_;
  std::vector<PayloadBits> variants_;
  std::vector<CodedPayload> coded_;
  std::vector<Hypothesis> plan_;
  double logAll_ = 0;         ///< log of the number of hypotheses in the plan
  double logTag_ = 0;         ///< log of the probability that any tag is right by accident
  double logFrame_ = 0;       ///< log of the bound for the frame that was read
  double logExpected_ = 0;
  double expectedChance_ = 0; ///< best over hypotheses and variants, uncorrected
  std::size_t expectedVariant_ = 0;
  std::optional<Hypothesis> expectedHypothesis_;
  MarkReading out_;
};

}  // namespace

std::optional<std::uint64_t> MarkReading::id() const {
  if (readProbability > kMatchProbability || frame->kind != PayloadKind::id) return std::nullopt;
  return frame->field;
}

std::optional<std::string> MarkReading::text() const {
  if (readProbability > kMatchProbability) return std::nullopt;
  if (frame->kind == PayloadKind::shortText) return shortText(*frame);
  if (frame->kind != PayloadKind::text || !body || !body->exact) return std::nullopt;
  std::string text(body->bits.size() / 8, '\0');
  for (std::size_t i = 0; i < body->bits.size(); ++i)
    text[i / 8] = static_cast<char>(static_cast<std::uint8_t>(text[i / 8]) << 1 | body->bits[i]);
  return isUtf8(text) ? std::optional(text) : std::nullopt;
}

Result<MarkReading> readMark(BitSource& source, const ReadRequest& request) {
  std::vector<PayloadBits> variants;
  if (request.expected) {
    Error error;
    variants = variantsOf(*request.expected, request.keys, error);
    if (variants.empty()) return error;
  }
  return Reading(source, request, std::move(variants)).run();
}

}  // namespace quadmark::robust
