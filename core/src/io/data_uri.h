// SPDX-License-Identifier: MIT
// Base64 data: URIs inside a JSON string: decoding, and re-encoding that leaves the spelling of unchanged parts alone.
#pragma once

#include <string>
#include <vector>

#include "bytes.h"

namespace quadmark::io {

/// True for a URI that begins with "data:" (scheme names have no case).
bool isDataUri(std::string_view uri);

/// Decodes the URI's bytes.
/// @param spelled  the URI as spelled in the JSON text between its quotes; JSON escapes (such as \/) and %XX are
/// resolved.
/// @param place    named in errors, for example "buffer 2".
/// Fails with badFile (broken base64) or unsupportedFile (a data URI that is not base64).
Result<std::vector<std::uint8_t>> decodeDataUri(std::string_view spelled, const std::string& place);

/// The same URI carrying `bytes` instead; as many as it decodes to. Characters of unchanged quads keep their spelling.
Result<std::string> recodeDataUri(std::string_view spelled, Bytes bytes, const std::string& place);

}  // namespace quadmark::io
