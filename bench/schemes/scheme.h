// SPDX-License-Identifier: MIT
// What the evaluation asks of a watermarking scheme: ours and, in bench/peers, those of other people.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quadmark/mesh.h"
#include "quadmark/result.h"

namespace quadmark::bench {

using Bits = std::vector<std::uint8_t>;  ///< one bit a byte, 0 or 1

/// The payload of a trial. An image holds its pixels row by row; an ID its 64 bits, most significant first.
struct TrialPayload {
  enum class Kind : std::uint8_t { id, image };
  Kind kind = Kind::id;
  std::uint32_t width = 64, height = 1;
  Bits bits;
};

struct TrialMark {
  std::vector<double> positions;  ///< of every vertex of the model, not rounded to its precision yet
  std::size_t capacityBits = 0;   ///< the most that the scheme could have written here; 0 = the scheme knows no limit
  std::size_t carriers = 0;       ///< vertices, cells, bins or coefficients that carry the payload
};

struct TrialReading {
  Bits bits;    ///< as many as were asked for; empty where nothing was found
  Bits unread;  ///< per bit: 1 = could not be read (its bit is 0); empty = all were read
  /// The scheme's own bound on the probability of such a reading without the mark. Nothing where the scheme has none: the
  /// evaluation then takes the binomial tail of the bits that agree.
  std::optional<double> claim{};
  /// Whether the scheme by itself is certain of the payload (a checksum, an authentication code). Nothing where it cannot
  /// know.
  std::optional<bool> certain{};
};

/// A scheme at work. Deterministic: equal arguments give equal results. No state between calls, so that threads may share it.
class Scheme {
 public:
  virtual ~Scheme() = default;
  /// As the results name it: lower case, words joined by '-'.
  [[nodiscard]] virtual std::string name() const = 0;
  /// Settings that the evaluation takes where none are given, as in the results: "standard", "strength=0.04".
  [[nodiscard]] virtual std::string usualSettings() const = 0;

  /// Marks a model. @param key  any number; the scheme's secrets come from it.
  /// Fails with capacity where the payload has no room, badOption on settings it does not know.
  [[nodiscard]] virtual Result<TrialMark> mark(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                                               const std::string& settings) const = 0;
  /// Reads a model. Of `payload` a blind scheme may use kind, width and height; its bits only where the scheme compares
  /// with an expected payload (its claim then says so). Never fails: what cannot be read is empty bits.
  [[nodiscard]] virtual TrialReading read(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                                          const std::string& settings) const = 0;
};

/// Every scheme of the evaluation: ours first.
[[nodiscard]] const std::vector<std::unique_ptr<Scheme>>& schemes();
/// The one of that name, or badOption with the names there are.
[[nodiscard]] Result<const Scheme*> schemeNamed(const std::string& name);

}  // namespace quadmark::bench
