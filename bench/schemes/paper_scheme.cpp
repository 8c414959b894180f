// SPDX-License-Identifier: MIT
#include <algorithm>
#include <sstream>
#include <utility>

#include "ours.h"
#include "quadmark/adjacency.h"
#include "quadmark/embed.h"
#include "quadmark/extract_parts.h"
#include "quadmark/payload.h"
#include "secret.h"

namespace quadmark::bench {
namespace {

// "L=2" or "L=2 H=4".
Result<PaperParams> digitsOf(std::uint32_t bits, const std::string& settings) {
  int L = 0, H = 0;
  std::istringstream words(settings);
  for (std::string word; words >> word;) {
    const bool single = word.size() == 3 && word[1] == '=' && word[2] >= '0' && word[2] <= '9';
    if (!single || (word[0] != 'L' && word[0] != 'H'))
      return Error{ErrorCode::badOption, "paper: settings are \"L=2\" or \"L=2 H=4\", not \"" + settings + "\""};
    (word[0] == 'L' ? L : H) = word[2] - '0';
  }
  auto params = chooseDigits(bits, L);
  if (!params || H == 0) return params;
  if (H < params->H1)
    return Error{ErrorCode::badOption, "paper: " + std::to_string(bits) + " bits need H >= " + std::to_string(params->H1)};
  params->H1 = params->H2 = H;
  return params;
}

Result<Key> keyOf(const TrialPayload& payload, std::uint64_t key, const std::string& settings) {
  Key out;
  out.secret = secretOf(key, "paper");
  const auto params = digitsOf(payload.width * payload.height, settings);
  if (!params) return params.error();
  out.params = *params;
  out.params.payload = payload.kind == TrialPayload::Kind::id ? PayloadType::id : PayloadType::image;
  out.params.width = payload.width, out.params.height = payload.height;
  if (const Status fits = validate(out.params); !fits) return fits.error();
  return out;
}

class PaperScheme : public Scheme {
 public:
  std::string name() const override { return "paper"; }
  std::string usualSettings() const override { return "L=2"; }

  Result<TrialMark> mark(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                         const std::string& settings) const override {
    const auto made = keyOf(payload, key, settings);
    if (!made) return made.error();
    auto marked = embedMesh(mesh, payload.bits, *made);
    if (!marked) return marked.error();
    return TrialMark{std::move(marked->positions), marked->capacityBits, marked->cells};
  }

  TrialReading read(const Mesh& mesh, const TrialPayload& payload, std::uint64_t key,
                    const std::string& settings) const override {
    const auto made = keyOf(payload, key, settings);
    if (!made) return {};
    ExtractOptions options;
    options.reference = payload.bits;
    PartsExtraction parts = extractParts(weld(mesh), mesh.precision, *made, options);
    Extraction& e = parts.extraction;
    return {std::move(e.bits), std::move(e.erased), e.falsePositive, std::nullopt};
  }
};

}  // namespace

std::unique_ptr<Scheme> makePaper() { return std::make_unique<PaperScheme>(); }

}  // namespace quadmark::bench
