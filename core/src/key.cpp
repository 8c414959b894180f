// SPDX-License-Identifier: MIT
#include "quadmark/key.h"

#include <algorithm>

#include "concat.h"

namespace quadmark {

Status validate(const PaperParams& p) {
  const auto bad = [](const std::string& message) { return Error{ErrorCode::badOption, message}; };
  const auto digits = [&](const char* low, int L, const char* high, int H) -> std::string {
    if (L < 2 || L > 9) return concat(low, " = ", L, " is not in 2..9");
    if (H < L || H > 9) return concat(high, " = ", H, " is not in ", low, "..9");
    return {};
  };
  for (const std::string& message : {digits("L1", p.L1, "H1", p.H1), digits("L2", p.L2, "H2", p.H2)})
    if (!message.empty()) return bad(message);
  if (!(p.lambda > 0 && p.lambda <= 0.1)) return bad("lambda is not in (0, 0.1]");
  if (!(p.tau >= 0 && p.tau <= 0.1)) return bad("tau is not in [0, 0.1]");
  if (p.k < 1 || p.k > 3) return bad(concat("k = ", p.k, " is not in 1..3"));
  if (p.width < 1 || p.height < 1 || p.width > 1024 || p.height > 1024)
    return bad(concat("the payload size ", p.width, " x ", p.height, " is not within 1 x 1 .. 1024 x 1024"));
  if (p.payload == PayloadType::image && p.bitCount() < 2) return bad("a 1 x 1 image holds no mark");
  if (p.payload == PayloadType::id && (p.width != 64 || p.height != 1)) return bad("an ID payload is 64 x 1");
  std::uint64_t codes = 1;
  for (int d = p.L1; d <= p.H1; ++d) codes *= 10;
  const std::uint32_t width = 3 * static_cast<std::uint32_t>(p.H2 - p.L2 + 1);
  const std::uint32_t pieces = (p.bitCount() + width - 1) / width;
  if (pieces > codes)
    return bad(concat(p.bitCount(), " bits make ", pieces, " pieces, but digits L1..H1 count only to ", codes));
  return okStatus();
}

Result<PaperParams> chooseDigits(std::uint32_t bits, int L) {
  if (bits < 1) return Error{ErrorCode::badOption, "the payload is empty"};
  std::uint64_t codes = 1;
  for (int D = 1; L + D - 1 <= 9; ++D) {
    codes *= 10;
    const std::uint32_t width = 3 * static_cast<std::uint32_t>(D);
    if ((bits + width - 1) / width <= codes) {
      PaperParams params;
      params.L1 = params.L2 = L;
      params.H1 = params.H2 = L + D - 1;
      return params;
    }
  }
  return Error{ErrorCode::badOption, concat("L = ", L, " leaves too few digits for ", bits, " bits")};
}

}  // namespace quadmark
