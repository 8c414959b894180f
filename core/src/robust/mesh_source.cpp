// SPDX-License-Identifier: MIT
#include "quadmark/robust/mesh_source.h"

namespace quadmark::robust {
namespace {

// The share of marked diamonds that the estimate exceeds on no unmarked model, but on every legible one.
constexpr double kLeastDiamondShare = 0.003;

}  // namespace

bool MeshSource::search(const AcceptHead& accept) { return reader_.search(limits_, accept); }

std::vector<Hypothesis> MeshSource::plan() const { return MeshReader::hypotheses(limits_); }

std::vector<float> MeshSource::headRatios(const Hypothesis& hypothesis) { return reader_.headRatios(hypothesis); }

std::vector<float> MeshSource::bodyRatios(const Hypothesis& hypothesis, const StreamCode& body) {
  return reader_.bodyRatios(hypothesis, body);
}

Agreement MeshSource::ringAgreement(const CodedPayload& expected, double sharpening) {
  return reader_.ringAgreement(expected, sharpening);
}

bool MeshSource::couldHaveRead() const {
  const ReaderCoverage& coverage = reader_.coverage();
  return 2 * coverage.ringPositions >= headCode().bits || coverage.diamondShare > kLeastDiamondShare;
}

}  // namespace quadmark::robust
