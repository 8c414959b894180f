// SPDX-License-Identifier: MIT
// Reports of the robust scheme. Members: docs/format.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "quadmark/image.h"
#include "quadmark/io/gltf.h"
#include "quadmark/metrics.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/robust/parts.h"
#include "quadmark/robust/self_test.h"
#include "report.h"

namespace quadmark {

/// How much a marked model can take.
enum class CapacityClass : std::uint8_t { basic, standard, full };
[[nodiscard]] const char* capacityClassName(CapacityClass value);

/// From what was written: labels of layer A, and cells of layer B per good fine cell.
[[nodiscard]] CapacityClass capacityClass(const robust::RobustEmbedding& embedding);

struct RobustEmbedReport {
  const robust::PayloadBits& payload;
  const robust::CodedPayload& coded;
  const robust::RobustEmbedding& embedding;
  robust::Strength strength;
  const Distortion& distortion;
  double slideRel;  ///< largest displacement along the surface, of the diagonal
  const std::optional<TextureShift>& textureShift;
  const robust::SelfTest& unattacked;
  const std::vector<robust::SelfTest>& selfTests;  ///< empty unless asked for
  std::uint64_t bytesChanged;
  const std::vector<std::string>& warnings;
};
[[nodiscard]] std::string formatReport(const RobustEmbedReport& report);

struct RobustExtractReport {
  const robust::SceneReading& scene;
  const BitImage& image;                     ///< 0 x 0 for none
  const std::vector<std::uint8_t>& erased;
  std::optional<double> ber;
  std::uint32_t cells;  ///< vertices with evidence
  const std::vector<NodeCells>& perNode;
  const std::vector<std::string>& warnings;
};
[[nodiscard]] std::string formatReport(const RobustExtractReport& report);

}  // namespace quadmark
