// SPDX-License-Identifier: MIT
// The robust scheme's waist: coded bits above (codes, frames, verdicts), geometry below (carriers, embedder, reader).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace quadmark::robust {

/// One stream of coded bits as the geometry needs to know it.
struct StreamCode {
  std::uint32_t bits = 0;  ///< length; 0 = the stream does not exist
  /// Per coded bit the number of the generator polynomial that made it. Where there are fewer slots than bits, those of
  /// the highest numbers go without one first (puncturing). Empty: all alike.
  std::vector<std::uint8_t> generator;
};

/// What is written: two streams of coded bits. The head is what a blind reader needs first (an ID frame, or the header
/// of an image or text); its length is fixed by the format. The body's length follows from the header.
struct CodedPayload {
  std::vector<std::uint8_t> head;           ///< one coded bit (0, 1) per byte
  std::vector<std::uint8_t> body;           ///< empty for IDs
  std::vector<std::uint8_t> headGenerator;  ///< see StreamCode::generator; empty or as long as head
  std::vector<std::uint8_t> bodyGenerator;  ///< empty or as long as body

  [[nodiscard]] bool hasBody() const { return !body.empty(); }
  /// Bits of the body before coding: outputs of generator 0.
  [[nodiscard]] std::size_t bodyInformation() const {
    std::size_t others = 0;
    for (const std::uint8_t g : bodyGenerator) others += g != 0 ? 1 : 0;
    return body.size() - others;
  }
  [[nodiscard]] StreamCode headCode() const { return {static_cast<std::uint32_t>(head.size()), headGenerator}; }
  [[nodiscard]] StreamCode bodyCode() const { return {static_cast<std::uint32_t>(body.size()), bodyGenerator}; }
};

using SubKey = std::array<std::uint8_t, 16>;

/// Independent sub-keys, one per purpose (HKDF of the master secret and the asset's salt, by the caller).
struct RobustKeys {
  SubKey select{};        ///< layer A: which vertices are carriers
  SubKey dither{};        ///< layer A: coded bits, pads and lattice offset of each label and coordinate
  SubKey constellation{}; ///< layer B: which fine cell means what
  SubKey assignment{};    ///< layer B: which coded bit each slot carries
  SubKey share{};         ///< which slots of both layers belong to the head when there is a body
};

/// Coded bits are shared out in one of two ways; a blind reader tries both.
enum class Sharing : std::uint8_t {
  headOnly,  ///< every slot carries the head: the payload has no body
  split,     ///< a keyed part of the slots carries the head, the others the body
};

enum class Layers : std::uint8_t { ring, diamonds, both };

/// One way to look at a mesh: what the reader assumed when it computed a set of log-likelihood ratios.
struct Hypothesis {
  Layers layers = Layers::ring;
  Sharing sharing = Sharing::headOnly;
  std::uint8_t deltaClass = 0;  ///< side of layer B's fine cells, index into kDeltas (ratio_plane.h); of no meaning for ring
  double ringSigma = 0;         ///< vertex noise assumed by layer A, of the largest extent
  double diamondSigma = 0;      ///< the same for layer B
  double sharpening = 0;        ///< total lambda of the Laplacian sharpening undone before reading; 0 for none
  std::uint8_t ringRank = 0;    ///< layer A's lattice step: the one that fits the model best, second best, third
  std::uint32_t number = 0;     ///< sets of ratios handed out so far, this one included: multiplies every probability
  bool mirrored = false;        ///< read with all faces turned over: what a mirrored copy with mended winding looks like
};

/// What a mesh says about the coded bits of one stream under a hypothesis. Layer A speaks about single bits, layer B about
/// the few bits of a symbol together: ratios of its bits follow (demapper.h), but the symbol says more than they do once
/// some of its bits are known from elsewhere.
struct SoftBits {
  std::vector<float> single;          ///< per coded bit a log-likelihood ratio: positive where 0 is likelier, 0 = unknown
  std::uint32_t symbolBits = 0;       ///< bits per symbol, at most 4; 0: no symbols
  std::vector<std::uint32_t> bitOf{}; ///< [symbol][symbolBits]: the coded bit each of them carries, below single.size()
  std::vector<float> score{};         ///< [symbol][1 << symbolBits]: log-likelihood of each value up to a common term, 0..25
};

/// Called with what is known of the head's coded bits. True stops the search: the caller could decode.
using AcceptHead = std::function<bool(const SoftBits& head, const Hypothesis& hypothesis)>;

/// Independent votes of which some agree with an expected payload: Binomial(votes, 1/2) on unmarked models.
struct Agreement {
  std::uint32_t votes = 0;
  std::uint32_t agreeing = 0;
};

}  // namespace quadmark::robust
