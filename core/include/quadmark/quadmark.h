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
#include "quadmark/robust/embedder.h"

namespace quadmark {

/// The library's version, "major.minor.patch".
[[nodiscard]] const char* version();

/// Called between stages with a stage name ("read", "search", "write", "verify", "report") and the share done, 0..1.
/// Return false to cancel: the call then fails with `aborted`.
using Progress = std::function<bool(const char* stage, double done)>;

/// Of scheme `robust` alone.
struct RobustOptions {
  robust::Strength strength = robust::Strength::standard;
  double maxErrorRel = 0;  ///< cap on every vertex's displacement, of the bounding-box diagonal; 0 = the preset's own
  double maxSlideRel = 0;  ///< cap on its part along the surface; 0 = the preset's own
  std::string salt;        ///< names the asset; reading takes the same one
  bool selfTest = false;   ///< damage the marked mesh in six ways and report which it withstands
};

struct EmbedRequest {
  Key key;
  /// Exactly one payload. Scheme `paper`: image or id, of the kind and size the key names. Scheme `robust`: an image up
  /// to 128 x 128, any id, or 1 to 64 bytes of UTF-8.
  std::optional<BitImage> image{};
  std::optional<std::uint64_t> id{};
  std::optional<std::string> text{};
  RobustOptions robust{};
  Progress progress{};              ///< may be empty
};

struct EmbedResponse {
  PatchedFile file;
  std::string reportJson;  ///< the embed report of docs/format.md, one line
};

/// Marks a model. The output differs from the input only in position components (and glTF min / max).
/// Fails as readModel(), or with badOption, badKey, badImage, capacity (the message has the numbers), aborted.
/// Deterministic: equal input gives equal bytes on every platform. Cost: linear, some microseconds per vertex.
[[nodiscard]] Result<EmbedResponse> embed(std::span<const std::uint8_t> file, const Resources& resources,
                                          const EmbedRequest& request);

struct ExtractRequest {
  Key key;
  std::optional<BitImage> reference{};  ///< compare with this image and use its agreement for the verdict
  /// Scheme `robust`, at most one of these and `reference`: a mark too faint to be read may still be told to be this one. A
  /// mark of this key with another id or text is then no match.
  std::optional<std::uint64_t> expectedId{};
  std::optional<std::string> expectedText{};
  std::string salt{};                 ///< scheme `robust`: as given when marking
  Progress progress{};
};

struct ExtractResponse {
  std::string verdict;               ///< "match", "none" or "inconclusive"
  double falsePositive = 1;          ///< upper bound on the probability of so much agreement without this key's mark
  /// Scheme `paper`: always there, for an ID payload 64 x 1, most significant bit first. Scheme `robust`: 0 x 0 where no
  /// image was found.
  BitImage image;
  std::vector<std::uint8_t> erased;  ///< per pixel: 1 = not read (bits holds 0 there)
  std::vector<float> confidence;     ///< per pixel: 0 (guess) .. 1 (certain)
  std::optional<std::uint64_t> id;   ///< ID payloads that were read with certainty
  std::optional<std::string> text{}; ///< the same for texts
  /// Scheme `robust`: per vertex of the model how much its votes agree with the mark, -1 .. 1, 0 = no vote; empty without one.
  std::vector<float> evidence{};
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
  std::string scheme = "paper";  ///< or "robust", which has no parameters
  PaperParams params;            ///< width, height and payload are required
  bool chooseDigits = true;      ///< replace L1, H1, L2, H2 by Eq. (7) starting at params.L1
};
[[nodiscard]] Result<Key> makeKey(const KeyRequest& request);

}  // namespace quadmark
