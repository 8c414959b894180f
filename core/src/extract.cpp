// SPDX-License-Identifier: MIT
#include "quadmark/extract.h"

#include <algorithm>
#include <cmath>

#include "purity.h"
#include "quadmark/exact_math.h"
#include "sorting.h"

namespace quadmark {
namespace {

constexpr double kLeastPurity = 0.02;      // kinds below this do not vote
constexpr double kLeastConfidence = 0.1;   // bits below this are erasures
constexpr float kSettledConfidence = 0.98f;  // below this on any bit, more tolerant passes are tried
constexpr double kPassFactor = 8;          // how fast the tolerance rises from pass to pass
constexpr double kTrustedPurity = 0.5;     // vertices of such cells are "used" for later passes
constexpr double kMaxRepeats = 4;          // identical readings (index, label, piece) count at most this often

// A reading that may vote. Kept small: there is one for every three or four vertices, more of them in later passes.
struct Candidate {
  std::uint32_t vertices[4];  ///< a, b, c, d
  Reading reading;
  float sigma;                ///< what rounding may do to the ratios, standard deviation in digits
  int kind;                   ///< in the pass's PurityTable
};

// Candidates in blocks: a growing vector would hold them twice for a while.
class CandidateList {
 public:
  void add(const Candidate& candidate) {
    if (blocks_.empty() || blocks_.back().size() == kBlock) {
      blocks_.emplace_back();
      blocks_.back().reserve(kBlock);
    }
    blocks_.back().push_back(candidate);
  }
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (const std::vector<Candidate>& block : blocks_)
      for (const Candidate& candidate : block) visit(candidate);
  }

 private:
  static constexpr std::size_t kBlock = 4096;
  std::vector<std::vector<Candidate>> blocks_;
};

class Extractor {
 public:
  Extractor(const WeldedMesh& welded, const std::vector<double>& positions, const Rounding& rounding, const Key& key,
            const ExtractOptions& options)
      : welded_(welded), positions_(positions), rounding_(rounding), key_(key), options_(options), pad_(key),
        codec_(key.params, pieceCount(key.params)), target_(scrambling(key)) {}

  Extraction run() {
    if (stopped()) return std::move(out_);
    pass(kExactUnits, 0);
    out_.passes = 1;
    out_.exactCells = voters();
    settle(1);
    if (options_.exactOnly && !complete()) {
      out_.cancelled = true;
      return std::move(out_);
    }
    // Pass 2 of the paper, in steps: only when something is missing, and only while it still finds more than chance.
    // "All pieces were seen" would be no reason to stop: garbage covers everything (D21).
    double units = kExactUnits;
    int fruitless = 0;
    while (key_.params.tau > 0 && !complete() && fruitless < 2) {
      if (stopped()) return std::move(out_);
      const double previous = units;
      units *= kPassFactor;
      const std::uint32_t before = voters();
      const bool more = pass(units, previous);
      ++out_.passes;
      fruitless = voters() > before ? 0 : fruitless + 1;
      settle(1);
      if (!more) break;
    }
    if (!options_.bitsOnly) judge();
    compareReadings();
    return std::move(out_);
  }

 private:
  // Reads all sets whose gap lies in (previous, units] rounding units. False when tau ends the series.
  bool pass(double units, double previous) {
    const double cap = previous == 0 ? 0 : key_.params.tau;
    CandidateList candidates;
    PurityTable table(previous == 0 ? welded_.vertexCount() / 5 : 0);
    bool reachedAny = previous == 0;
    forEachSet({units, cap}, [&](const Quad& quad) {
      const double unit = rounding_.unit(quad, positions_.data()), gapUnits = quad.gap / unit;
      if (gapUnits <= previous) return;
      if (gapUnits > units / 2) reachedAny = true;
      const double digit = std::min(codec_.indexSlot().cellWidth(), codec_.pieceSlot().cellWidth());
      const double sigma = 0.6 * unit / (std::min(quad.lengthAC, quad.lengthBD) * digit);
      const Reading reading = codec_.read(quad.ratioAC, quad.ratioBD);
      if (reading.state == ReadingState::outOfRange || reading.state == ReadingState::ambiguousOrder) return;
      if (!pad_.carries(reading.prefix1, reading.prefix2)) return;
      const int kind = PurityTable::kind(gapUnits, reading);
      table.add(kind, reading, quad.ratioAC, quad.ratioBD);
      if (reading.state == ReadingState::ok) {
        candidates.add({{quad.a, quad.b, quad.c, quad.d}, reading, static_cast<float>(sigma), kind});
      } else {
        ++out_.erasedCells;
      }
    });
    table.estimate();
    if (previous == 0) excess_ = table.excess();
    accept(candidates, table);
    return reachedAny;
  }

  void forEachSet(const GapLimit& limit, const std::function<void(const Quad&)>& visit) const {
    if (limit.relative > 0 || options_.exactSets.empty())
      return forEachCoplanarSet(welded_, positions_, key_.params.k, rounding_, limit, used_, visit);
    for (const std::array<std::uint32_t, 4>& set : options_.exactSets) {
      Quad quad;
      if (makeQuad(set.data(), positions_.data(), kMinTriangleReading, quad) &&
          limit.admits(quad, rounding_.unit(quad, positions_.data())))
        visit(quad);
    }
  }

  // A vertex belongs to one cell. Where sets compete the purer kind wins, then the longer diagonals (the paper's rule).
  void accept(const CandidateList& candidates, const PurityTable& table) {
    std::vector<std::uint8_t> claims(welded_.vertexCount(), 0);
    const auto votes = [&](const Candidate& c) { return table.purity(c.kind) >= kLeastPurity; };
    std::size_t voters = 0;
    candidates.forEach([&](const Candidate& c) {
      if (!votes(c)) return;
      ++voters;
      for (std::uint32_t v : c.vertices) claims[v] = static_cast<std::uint8_t>(std::min(claims[v] + 1, 2));
    });
    accepted_.reserve(accepted_.size() + voters);
    std::vector<Rival> contested;
    candidates.forEach([&](const Candidate& c) {
      if (!votes(c)) return;
      const auto purity = static_cast<float>(table.purity(c.kind));
      bool alone = true;
      for (std::uint32_t v : c.vertices) alone = alone && claims[v] == 1;
      if (alone)
        take(c, purity);
      else
        contested.push_back({purity, diagonalSum(c), &c});
    });
    sortCompactly(contested.begin(), contested.end(), [&](const Rival& x, const Rival& y) {
      if (x.purity != y.purity) return x.purity > y.purity;
      if (x.diagonalSum != y.diagonalSum) return x.diagonalSum > y.diagonalSum;
      const auto &p = x.candidate->vertices, &q = y.candidate->vertices;
      for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) {
          const double a = positions_[3 * std::size_t{p[i]} + k], b = positions_[3 * std::size_t{q[i]} + k];
          if (a != b) return a < b;
        }
      return std::lexicographical_compare(p, p + 4, q, q + 4);
    });
    std::fill(claims.begin(), claims.end(), std::uint8_t{0});
    for (const Rival& rival : contested) {
      bool free = true;
      for (std::uint32_t v : rival.candidate->vertices) free = free && claims[v] == 0;
      if (!free) continue;
      for (std::uint32_t v : rival.candidate->vertices) claims[v] = 1;
      take(*rival.candidate, rival.purity);
    }
  }

  // Of sets that share vertices.
  struct Rival {
    float purity;
    double diagonalSum;
    const Candidate* candidate;
  };

  [[nodiscard]] double diagonalSum(const Candidate& c) const {
    Quad quad;
    (void)makeQuad(c.vertices, positions_.data(), kMinTriangleReading, quad);  // it was one before
    return quad.diagonalSum();
  }

  void take(const Candidate& c, float purity) {
    const Reading& r = c.reading;
    // Near the edge of its digit cell a reading may belong to the neighbour: the more so, the more rounding alone may
    // have moved it. z is the distance to the edge in standard deviations, the quartic a stand-in for the normal tail.
    const double off = std::max(std::fabs(r.residue1), std::fabs(r.residue2));
    const double z = 1 + (0.5 - off) / std::max(double{c.sigma}, 1e-3);
    const double sound = double{purity} * (1 - 2 / (1 + z * z * z * z));
    const double central = off <= 0.25 ? 1 : std::max(0.05, (0.5 - off) / 0.25);
    const double weight = exactLog((1 + sound) / (1 - sound)) * central;
    accepted_.push_back({label(r), r.index, r.piece ^ pad_(r.index, r.prefix1, r.prefix2), purity,
                         static_cast<float>(weight)});
    if (purity >= kTrustedPurity) {
      if (used_.empty()) used_.assign(welded_.vertexCount(), 0);
      for (std::uint32_t v : c.vertices) used_[v] = 1;
    }
    if (options_.keepReadings) {
      out_.readings.push_back({{c.vertices[0], c.vertices[1], c.vertices[2], c.vertices[3]}, c.reading, purity,
                               static_cast<float>(weight), false});
    }
  }

  // Which readings voted for what was read in the end.
  void compareReadings() {
    const std::uint32_t width = static_cast<std::uint32_t>(codec_.bitsPerPiece());
    for (CellReading& cell : out_.readings) {
      const Reading& r = cell.reading;
      if (cell.weight <= 0) continue;
      const std::uint32_t piece = r.piece ^ pad_(r.index, r.prefix1, r.prefix2);
      cell.agrees = true;
      for (std::uint32_t bit = 0; bit < width; ++bit) {
        const double sum = sums_[std::size_t{r.index} * width + bit];
        cell.agrees = cell.agrees && ((piece >> (width - 1 - bit) & 1) != 0) == (sum > 0);
      }
    }
  }

  // Index and label in one word: both digit strings are below 10^9, so r1's digits and r2's prefix fit.
  [[nodiscard]] std::uint64_t label(const Reading& r) const {
    return (std::uint64_t{r.prefix1} * codec_.indexSlot().codeCount() + r.index) << 32 | r.prefix2;
  }

  [[nodiscard]] std::uint32_t voters() const { return static_cast<std::uint32_t>(accepted_.size()); }

  // Nothing left to gain: every bit is read, and none on thin ice.
  [[nodiscard]] bool complete() const {
    return excess_ > 0 && std::all_of(out_.confidence.begin(), out_.confidence.end(),
                                      [](float confidence) { return confidence >= kSettledConfidence; });
  }

  bool stopped() {
    out_.cancelled = options_.progress && !options_.progress(out_.passes);
    return out_.cancelled;
  }

  // Votes by label, those with one label by piece, those for one piece from the heaviest to the lightest.
  void sortVotes() {
    std::vector<KeyedIndex> order;
    order.reserve(accepted_.size());
    for (const Vote& vote : accepted_) order.push_back({vote.label, static_cast<std::uint32_t>(order.size())});
    sortByKey(order);
    std::vector<Vote> sorted;
    sorted.reserve(accepted_.size());
    for (const KeyedIndex& entry : order) sorted.push_back(accepted_[entry.index]);
    for (auto begin = sorted.begin(), end = begin; begin != sorted.end(); begin = end) {
      while (end != sorted.end() && end->label == begin->label) ++end;
      sortShort(begin, end, [](const Vote& x, const Vote& y) {
        return x.piece != y.piece ? x.piece < y.piece : x.weight > y.weight;
      });
    }
    accepted_.swap(sorted);
  }

  // Sums the votes of everything accepted so far: bits, erasures, confidence (D22).
  // @param trust  0..1, factor on all log odds.
  void settle(double trust) {
    sortVotes();
    const std::uint32_t width = static_cast<std::uint32_t>(codec_.bitsPerPiece());
    sums_.assign(std::size_t{codec_.pieces()} * width, 0);
    for (std::size_t begin = 0; begin < accepted_.size();) {
      double total = 0;
      std::size_t end = begin;
      for (; end < accepted_.size() && accepted_[end].label == accepted_[begin].label &&
             accepted_[end].piece == accepted_[begin].piece;
           ++end)
        if (static_cast<double>(end - begin) < kMaxRepeats) total += accepted_[end].weight;
      const Vote& v = accepted_[begin];
      for (std::uint32_t bit = 0; bit < width; ++bit)
        sums_[std::size_t{v.index} * width + bit] += (v.piece >> (width - 1 - bit) & 1) != 0 ? total : -total;
      begin = end;
    }
    const std::uint32_t count = key_.params.bitCount();
    out_.bits.assign(count, 0);
    out_.erased.assign(count, 0);
    out_.confidence.assign(count, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double sum = trust * sums_[target_[i]];
      // |P(1) - P(0)| of log odds `sum`: tanh(sum / 2).
      const double odds = exactExp(-std::fabs(sum)), confidence = (1 - odds) / (1 + odds);
      out_.confidence[i] = static_cast<float>(confidence);
      out_.erased[i] = confidence < kLeastConfidence;
      out_.bits[i] = sum > 0 && confidence >= kLeastConfidence;
    }
  }

  void judge() {
    compareWithReference();
    const std::uint32_t width = static_cast<std::uint32_t>(codec_.bitsPerPiece());
    AgreementTest test(codec_.pieces() * width);
    // One bounded vote per bit and label: cells with one label share their pad, so they are one coin, not many.
    const std::size_t bits = std::size_t{codec_.pieces()} * width;
    std::vector<double> unit(width), weighted(bits, 0), promised(bits, 0), own(bits, 0);
    std::vector<std::uint8_t> seen(codec_.pieces(), 0);
    for (std::size_t begin = 0, end = 0; begin < accepted_.size(); begin = end) {
      std::fill(unit.begin(), unit.end(), 0.0);
      double purity = 0;
      for (end = begin; end < accepted_.size() && accepted_[end].label == accepted_[begin].label; ++end) {
        const Vote& v = accepted_[end];
        purity = std::max(purity, double{v.purity});
        for (std::uint32_t bit = 0; bit < width; ++bit)
          unit[bit] += (v.piece >> (width - 1 - bit) & 1) != 0 ? double{v.weight} : -double{v.weight};
      }
      const std::uint32_t index = accepted_[begin].index;
      seen[index] = 1;
      for (std::uint32_t bit = 0; bit < width; ++bit) {
        const int vote = unit[bit] > 0 ? 1 : unit[bit] < 0 ? -1 : 0;
        const std::size_t at = std::size_t{index} * width + bit;
        test.add(static_cast<std::uint32_t>(at), vote, purity);
        weighted[at] += vote * purity;
        promised[at] += purity * purity;
        own[at] += purity * purity * purity * purity;
      }
    }
    // Purity says that readings are cells of some mark, agreement that they are cells of this key's: the mean product of
    // two units' votes on a bit, over what their purities promise. Under a wrong key it is near 0, and what was read
    // deserves no confidence.
    double agree = 0, promise = 0;
    for (std::size_t at = 0; at < bits; ++at) {
      agree += weighted[at] * weighted[at] - promised[at];
      promise += promised[at] * promised[at] - own[at];
    }
    if (promise > 1) {
      out_.agreement = std::clamp(agree / promise, 0.0, 1.0);
      settle(out_.agreement);
    }
    for (std::uint8_t s : seen) out_.piecesRead += s;
    out_.cells = voters();
    out_.agreementProbability = test.probability();
    out_.falsePositive = out_.agreementProbability;
    if (!options_.reference.empty())
      // Two tests were tried, so the better one counts double.
      out_.falsePositive = std::min(1.0, 2 * std::min(out_.agreementProbability, out_.referenceProbability));
    if (out_.falsePositive <= kMatchProbability) {
      out_.verdict = Verdict::match;
    } else if (out_.falsePositive <= kDoubtProbability) {
      out_.verdict = Verdict::inconclusive;
    } else {
      // Cells of some mark are there, but too few repeats to say whose: not enough to deny it either.
      const bool couldHaveShown = test.bestProbability() <= kMatchProbability;
      out_.verdict = !couldHaveShown && excess_ > 4 ? Verdict::inconclusive : Verdict::none;
    }
  }

  // On the bits as the votes have them: doubts about the key must not take evidence for it away.
  void compareWithReference() {
    std::uint64_t read = 0, equal = 0;
    for (std::size_t i = 0; i < options_.reference.size(); ++i)
      if (!out_.erased[i]) ++read, equal += out_.bits[i] == options_.reference[i];
    if (read > 0) out_.referenceProbability = referenceProbability(read, equal);
  }

  struct Vote {
    std::uint64_t label;
    std::uint32_t index, piece;
    float purity, weight;
  };

  const WeldedMesh& welded_;
  const std::vector<double>& positions_;
  const Rounding rounding_;
  const Key& key_;
  const ExtractOptions& options_;
  const Pad pad_;
  const PairCodec codec_;
  const std::vector<std::uint32_t> target_;  ///< scrambled position per payload bit
  std::vector<Vote> accepted_;
  std::vector<double> sums_;                 ///< log odds per scrambled bit
  std::vector<std::uint8_t> used_;
  double excess_ = 0;
  Extraction out_;
};

}  // namespace

Extraction extractMesh(const WeldedMesh& welded, const std::vector<double>& positions, const Rounding& rounding,
                       const Key& key, const ExtractOptions& options) {
  return Extractor(welded, positions, rounding, key, options).run();
}

}  // namespace quadmark
