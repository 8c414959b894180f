// SPDX-License-Identifier: MIT
// A mesh as the source of coded bits for readMark().
#pragma once

#include <vector>

#include "quadmark/robust/mark.h"
#include "quadmark/robust/reader.h"

namespace quadmark::robust {

class MeshSource : public BitSource {
 public:
  /// @param reader  kept by reference; its search() must not have been called.
  explicit MeshSource(MeshReader& reader) : reader_(reader) {}

  bool search(const AcceptHead& accept) override;
  [[nodiscard]] std::vector<Hypothesis> plan() const override;
  SoftBits headBits(const Hypothesis& hypothesis) override;
  SoftBits bodyBits(const Hypothesis& hypothesis, const StreamCode& body) override;
  Agreement ringAgreement(const CodedPayload& expected, double sharpening, bool mirrored) override;
  /// Half of the head's coded positions have votes in layer A, or more diamonds look marked than chance makes.
  [[nodiscard]] bool couldHaveRead() const override;

 private:
  MeshReader& reader_;
  ReadLimits limits_;
};

}  // namespace quadmark::robust
