// SPDX-License-Identifier: MIT
#include "quadmark/robust/keys.h"

#include <algorithm>
#include <string>

#include "concat.h"
#include "quadmark/prf.h"

namespace quadmark::robust {

Result<SchemeKeys> deriveKeys(std::span<const std::uint8_t> secret, std::string_view salt) {
  if (salt.size() > kMaxSaltBytes)
    return Error{ErrorCode::badOption,
                 concat("salt: ", salt.size(), " bytes, at most ", kMaxSaltBytes, " are allowed")};
  if (salt.find('\0') != salt.npos) return Error{ErrorCode::badOption, "salt: contains a zero byte"};
  const auto* saltBytes = reinterpret_cast<const std::uint8_t*>(salt.data());
  const Digest master = hkdfSha256(secret, {saltBytes, salt.size()}, "qm/v1");
  const auto subKey = [&](std::string_view purpose) {
    const Digest derived = hkdfSha256(master, {}, "qm/v1/" + std::string(purpose));
    SubKey key;
    std::copy_n(derived.begin(), key.size(), key.begin());
    return key;
  };
  SchemeKeys keys;
  keys.geometry.select = subKey("select");
  keys.geometry.dither = subKey("dither");
  keys.geometry.constellation = subKey("constellation");
  keys.geometry.assignment = subKey("assignment");
  keys.geometry.share = subKey("share");
  keys.mac = subKey("mac");
  keys.whitening = subKey("whitening");
  return keys;
}

}  // namespace quadmark::robust
