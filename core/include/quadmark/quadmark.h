// SPDX-License-Identifier: MIT
// The whole product in four calls on bytes: makeKey, embed, extract, inspect.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "quadmark/image.h"
#include "quadmark/io/model.h"
#include "quadmark/key.h"
#include "quadmark/result.h"

namespace quadmark {

/// The library's version, "major.minor.patch".
[[nodiscard]] const char* version();

/// Called between stages with a stage name ("read", "search", "write", "verify", "report") and the share done, 0..1.
/// Return false to cancel: the call then fails with `aborted`.
using Progress = std::function<bool(const char* stage, double done)>;

struct EmbedRequest {
  Key key;
  std::optional<BitImage> image;    ///< exactly one of image and id, of the kind and size the key names
  std::optional<std::uint64_t> id;
  Progress progress;                ///< may be empty
};

struct EmbedResponse {
  PatchedFile file;
  std::string reportJson;  ///< the embed report of docs/format.md, one line
};

/// Marks a model. The output differs from the input only in position components (and glTF min / max).
/// Fails as readModel(), or with badOption, badKey, badImage, capacity (the message has the numbers), aborted.
/// Deterministic: equal input gives equal bytes on every platform. Cost: linear, about 2 microseconds per vertex.
[[nodiscard]] Result<EmbedResponse> embed(std::span<const std::uint8_t> file, const Resources& resources,
                                          const EmbedRequest& request);

struct ExtractRequest {
  Key key;
  std::optional<BitImage> reference;  ///< compare with this image and use its agreement for the verdict
  Progress progress;
};

struct ExtractResponse {
  std::string verdict;               ///< "match", "none" or "inconclusive"
  double falsePositive = 1;          ///< upper bound on the probability of so much agreement without this key's mark
  BitImage image;                    ///< for an ID payload 64 x 1, most significant bit first
  std::vector<std::uint8_t> erased;  ///< per pixel: 1 = not read (bits holds 0 there)
  std::vector<float> confidence;     ///< per pixel: 0 (guess) .. 1 (certain)
  std::optional<std::uint64_t> id;   ///< ID payloads with verdict "match" and no erasure
  std::string reportJson;            ///< the extract report of docs/format.md, one line
};

/// Reads the mark. A model without one is a result (verdict "none"), not an error.
/// Fails as readModel(), or with badKey, badImage (a reference of another size), aborted.
[[nodiscard]] Result<ExtractResponse> extract(std::span<const std::uint8_t> file, const Resources& resources,
                                              const ExtractRequest& request);

/// Describes a model without a key: format, sizes, cells and capacity at default parameters, as a JSON report.
[[nodiscard]] Result<std::string> inspect(std::span<const std::uint8_t> file, const Resources& resources);

/// Makes a key around 32 random bytes. Digit positions come from Eq. (7) unless request.params fixes them.
struct KeyRequest {
  std::array<std::uint8_t, 32> secret{};
  std::string owner;
  PaperParams params;            ///< width, height and payload are required
  bool chooseDigits = true;      ///< replace L1, H1, L2, H2 by Eq. (7) starting at params.L1
};
[[nodiscard]] Result<Key> makeKey(const KeyRequest& request);

}  // namespace quadmark
