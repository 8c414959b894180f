// SPDX-License-Identifier: MIT
#include "quadmark/robust/mesh_source.h"

namespace quadmark::robust {
namespace {

// The share of marked diamonds that the estimate exceeds on no unmarked model, but on every legible one.
constexpr double kLeastDiamondShare = 0.003;

}  // namespace

bool MeshSource::search(const AcceptHead& accept) { return reader_.search(limits_, accept); }

std::vector<Hypothesis> MeshSource::plan() const { return MeshReader::hypotheses(limits_); }

SoftBits MeshSource::headBits(const Hypothesis& hypothesis) { return reader_.headBits(hypothesis); }

SoftBits MeshSource::bodyBits(const Hypothesis& hypothesis, const StreamCode& body) {
  return reader_.bodyBits(hypothesis, body);
}

Agreement MeshSource::ringAgreement(const CodedPayload& expected, double sharpening, bool mirrored) {
  return reader_.ringAgreement(expected, sharpening, mirrored);
}

bool MeshSource::couldHaveRead() const {
  const ReaderCoverage& coverage = reader_.coverage();
  return 2 * coverage.ringPositions >= headCode().bits || coverage.diamondShare > kLeastDiamondShare;
}

}  // namespace quadmark::robust
