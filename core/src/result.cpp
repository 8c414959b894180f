// SPDX-License-Identifier: MIT
#include "quadmark/result.h"

namespace quadmark {

std::string_view errorCodeName(ErrorCode code) {
  switch (code) {
    case ErrorCode::badFile:
      return "bad_file";
    case ErrorCode::unsupportedFile:
      return "unsupported_file";
    case ErrorCode::badMesh:
      return "bad_mesh";
    case ErrorCode::badOption:
      return "bad_option";
    case ErrorCode::badKey:
      return "bad_key";
    case ErrorCode::badImage:
      return "bad_image";
    case ErrorCode::capacity:
      return "capacity";
    case ErrorCode::unsupportedVersion:
      return "unsupported_version";
    case ErrorCode::tooLarge:
      return "too_large";
    case ErrorCode::io:
      return "io";
    case ErrorCode::aborted:
      return "aborted";
    case ErrorCode::internal:
      return "internal";
  }
  return "internal";
}

}  // namespace quadmark
