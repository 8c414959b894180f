// SPDX-License-Identifier: MIT
// Reading a payload from soft bits, and what the reading is worth.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "quadmark/robust/coded.h"
#include "quadmark/robust/frame.h"
#include "quadmark/verdict.h"

namespace quadmark::robust {

/// Candidates of the list decoder per hypothesis. Of 1, 8, 64 and 512, measured with noise at 92 bits: 64 gains 0.6 dB
/// over 1, which is as much as two more bits of memory (five times the work); 512 gains nothing more.
inline constexpr std::uint32_t kListSize = 64;

/// Where coded bits come from: a mesh, or a test's simulation of one.
class BitSource {
 public:
  virtual ~BitSource() = default;
  virtual bool search(const AcceptHead& accept) = 0;
  [[nodiscard]] virtual std::vector<Hypothesis> plan() const = 0;
  virtual SoftBits headBits(const Hypothesis& hypothesis) = 0;
  virtual SoftBits bodyBits(const Hypothesis& hypothesis, const StreamCode& body) = 0;
  virtual Agreement ringAgreement(const CodedPayload& expected, double sharpening, bool mirrored) = 0;
  /// Whether a mark would have been found if there were one: enough places voted.
  [[nodiscard]] virtual bool couldHaveRead() const = 0;
};

/// How a mark compares with the payload the caller expects.
enum class Comparison : std::uint8_t { notAsked, agrees, differs, unknown };

struct MarkReading {
  Verdict verdict = Verdict::none;
  double falsePositive = 1;          ///< of the verdict: multiplied by everything that was tried
  double readProbability = 1;        ///< of reading the frame by chance; 1 if none was read
  std::optional<Frame> frame;        ///< read, or (verified only) the expected one
  bool framed = false;               ///< the frame was read, not only verified
  std::optional<BodyReading> body;   ///< images and longer texts
  std::optional<Hypothesis> hypothesis;  ///< under which frame and body were read
  Comparison comparison = Comparison::notAsked;
  double expectedProbability = 1;    ///< of so much agreement with the expected payload by chance
  std::uint32_t hypotheses = 0;      ///< tried
  bool cancelled = false;

  /// ID and text where readProbability is a match; texts only if all of it was read and confirmed.
  [[nodiscard]] std::optional<std::uint64_t> id() const;
  [[nodiscard]] std::optional<std::string> text() const;
};

struct ReadRequest {
  const SchemeKeys& keys;
  std::optional<Payload> expected{};
  std::uint32_t keysTried = 1;             ///< keys, or parts of a scene, tried: multiplies every probability
  std::function<bool(double done)> progress{};  ///< share of the hypotheses; false cancels
};

/// Reads a payload blindly, or verifies an expected one where too little is left to read.
///
/// falsePositive is the least of
/// - hypotheses * kListSize * 2^-24: that some tag is right by accident (some 3e-4: no match by itself);
/// - hypotheses * 2^66 frames * logChance() of the frame's codeword, or for IDs 5 sharpenings * 2 sides * 2^66 * the
///   binomial tail of layer A's labels, each counted double;
/// - for bodies with the right tag the first one times bodies tried * 2^-40, counted double;
/// - for an expected payload hypotheses * logChance() of its codeword, or 5 sharpenings * the tail of layer A's labels, or
///   the binomial tail of the pixels, each counted as often as there are such tests.
/// Hypotheses are all that the search could have tried, not only those before it stopped.
///
/// `match` up to kMatchProbability, `inconclusive` up to kDoubtProbability or where couldHaveRead() says no, else
/// `none`. With an expected ID or text, a mark that certainly carries another one is `none`, too.
/// Fails like bitsOf() for an expected payload that cannot be one.
[[nodiscard]] Result<MarkReading> readMark(BitSource& source, const ReadRequest& request);

}  // namespace quadmark::robust
