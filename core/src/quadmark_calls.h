// SPDX-License-Identifier: MIT
// What the calls on bytes share between schemes.
#pragma once

#include <vector>

#include "quadmark/adjacency.h"
#include "quadmark/quadmark.h"
#include "report.h"

namespace quadmark {

inline bool tell(const Progress& progress, const char* stage, double done) {
  return !progress || progress(stage, done);
}

inline Error cancelled() { return {ErrorCode::aborted, "cancelled by the caller"}; }

/// The robust scheme's part of embed() and extract().
[[nodiscard]] Result<EmbedResponse> embedRobustFile(std::span<const std::uint8_t> file, const Resources& resources,
                                                    const EmbedRequest& request);
[[nodiscard]] Result<ExtractResponse> extractRobustFile(std::span<const std::uint8_t> file, const Resources& resources,
                                                        const ExtractRequest& request);

}  // namespace quadmark
