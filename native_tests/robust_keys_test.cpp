// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "quadmark/prf.h"
#include "quadmark/robust/keys.h"

namespace quadmark::robust {
namespace {

std::vector<std::uint8_t> countingSecret() {
  std::vector<std::uint8_t> secret(32);
  std::iota(secret.begin(), secret.end(), std::uint8_t{0});
  return secret;
}

std::string hex(const SubKey& key) {
  std::string out;
  for (std::uint8_t byte : key) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 15];
  }
  return out;
}

std::vector<std::string> allOf(const SchemeKeys& keys) {
  const RobustKeys& g = keys.geometry;
  return {hex(g.select), hex(g.dither), hex(g.constellation), hex(g.assignment),
          hex(g.share),  hex(keys.mac), hex(keys.whitening)};
}

// Values of Python's hmac and hashlib for the secret 00 01 .. 1f.
TEST(RobustKeys, AreHkdfOfSecretSaltAndPurpose) {
  const auto plain = deriveKeys(countingSecret(), "");
  ASSERT_TRUE(plain);
  EXPECT_EQ(allOf(*plain),
            (std::vector<std::string>{"e0f9cfb31d2caf45b4ca3ce094cc8468", "f153ee34af75624a7a62252852310ccc",
                                      "df2db57ec6fcd7bcf0d30aba05c57e5b", "295a576b25eb83fdfd334f207fc8f566",
                                      "97a9bce1905b882f696a2260d7fba4c7", "1c55d58bb0901af0ae64468297eafa12",
                                      "a180c3917d83c8d082ab706ad57af2d7"}));
  const auto salted = deriveKeys(countingSecret(), "asset 7");
  ASSERT_TRUE(salted);
  EXPECT_EQ(allOf(*salted),
            (std::vector<std::string>{"dd6790e9956b5a964b2166987ddfa059", "0876af66d38d24909b991ea462160546",
                                      "f2623aca5117a672560084dadcc7993c", "b02004c536b47e0c1e8f52ce669f1282",
                                      "a2ade97e8bd6f534f196f30724d32fee", "d3663160a8d2502d7658f1347267faab",
                                      "7150a7d57999a946b9e027e8d1cd8d64"}));
}

TEST(RobustKeys, GiveNothingAwayAboutOtherPurposesOrSalts) {
  // Streams of any two sub-keys are unrelated: bits agree in 500 +- 16 of 1000 cases, five deviations are allowed.
  std::vector<Prf> streams;
  for (const char* salt : {"", "a", "b"}) {
    const auto keys = deriveKeys(countingSecret(), salt);
    ASSERT_TRUE(keys);
    for (const SubKey& key : {keys->geometry.select, keys->geometry.dither, keys->geometry.constellation,
                              keys->geometry.assignment, keys->geometry.share, keys->mac, keys->whitening})
      streams.emplace_back(key);
  }
  for (std::size_t i = 0; i < streams.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      int same = 0;
      for (std::uint64_t item = 0; item < 1000; ++item) same += streams[i].below(item, 2) == streams[j].below(item, 2);
      EXPECT_NEAR(same, 500, 80) << i << " and " << j;
    }
}

TEST(RobustKeys, RefuseSaltsThatHmacWouldConfuse) {
  const auto zero = deriveKeys(countingSecret(), std::string_view("a\0", 2));
  ASSERT_FALSE(zero);
  EXPECT_EQ(zero.error().code, ErrorCode::badOption);
  EXPECT_EQ(zero.error().message, "salt: contains a zero byte");
  EXPECT_TRUE(deriveKeys(countingSecret(), std::string(kMaxSaltBytes, 's')));
  const auto longer = deriveKeys(countingSecret(), std::string(kMaxSaltBytes + 1, 's'));
  ASSERT_FALSE(longer);
  EXPECT_EQ(longer.error().message, "salt: 257 bytes, at most 256 are allowed");
}

}  // namespace
}  // namespace quadmark::robust
