// SPDX-License-Identifier: MIT
// Reports as JSON, one line each: the same text natively, in Node and in the browser. Members: docs/format.md.
#pragma once

#include <string>
#include <vector>

#include "quadmark/embed.h"
#include "quadmark/extract.h"
#include "quadmark/io/model.h"
#include "quadmark/metrics.h"
#include "quadmark/robust/reader.h"

namespace quadmark {

/// Cells per glTF node: how much of the evidence each carries.
struct NodeCells {
  std::uint32_t node = 0;
  std::string name;
  std::uint32_t mesh = 0, cells = 0;
  double share = 0;  ///< of the weight of all cells that agree with what was read, 0..1
};

struct EmbedReport {
  const Key& key;
  const MarkedMesh& marked;
  const Distortion& distortion;
  std::uint64_t bytesChanged;
  std::vector<std::string> warnings;
};
[[nodiscard]] std::string formatReport(const EmbedReport& report);

struct ExtractReport {
  const Key& key;
  const Extraction& extraction;
  const char* readFrom;           ///< partName()
  std::uint32_t readFromVertices;
  const std::optional<std::uint64_t>& id;
  std::optional<double> ber;
  std::vector<NodeCells> perNode;
  std::vector<std::string> warnings;
};
[[nodiscard]] std::string formatReport(const ExtractReport& report);

struct InspectReport {
  const ModelInfo& info;
  const Mesh& mesh;
  std::uint32_t weldedVertices;
  std::uint32_t components;
  double diagonal;
  std::uint32_t cells, naturalCells;
  std::vector<NodeCells> perNode;
  robust::ReaderCoverage robust;  ///< places of the robust scheme, marked or not
};
[[nodiscard]] std::string formatReport(const InspectReport& report);

/// 16 lower-case hex digits.
[[nodiscard]] std::string formatId(std::uint64_t id);

}  // namespace quadmark
