// SPDX-License-Identifier: MIT
#include "quadmark/prf.h"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

namespace quadmark {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytesOf(std::string_view text) { return {text.begin(), text.end()}; }

Bytes counting(std::size_t count, std::uint8_t first = 0) {
  Bytes out(count);
  std::iota(out.begin(), out.end(), first);
  return out;
}

std::string hex(const Digest& digest) {
  std::string out;
  for (std::uint8_t byte : digest) {
    out += "0123456789abcdef"[byte >> 4];
    out += "0123456789abcdef"[byte & 15];
  }
  return out;
}

TEST(Sha256, GivesThePublishedDigests) {  // FIPS 180-4 examples
  EXPECT_EQ(hex(sha256({})), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hex(sha256(bytesOf("abc"))), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hex(sha256(bytesOf("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"))),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(hex(sha256(Bytes(1000000, 'a'))), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PadsEveryLengthAroundABlock) {  // values of Python's hashlib over 00 01 02 ...
  EXPECT_EQ(hex(sha256(counting(55))), "463eb28e72f82e0a96c0a4cc53690c571281131f672aa229e0d45ae59b598b59");
  EXPECT_EQ(hex(sha256(counting(56))), "da2ae4d6b36748f2a318f23e7ab1dfdf45acdc9d049bd80e59de82a60895f562");
  EXPECT_EQ(hex(sha256(counting(63))), "29af2686fd53374a36b0846694cc342177e428d1647515f078784d69cdb9e488");
  EXPECT_EQ(hex(sha256(counting(64))), "fdeab9acf3710362bd2658cdc9a29e8f9c757fcf9811603a8c447cd1d9151108");
  EXPECT_EQ(hex(sha256(counting(65))), "4bfd2c8b6f1eec7a2afeb48b934ee4b2694182027e6d0fc075074f2fabb31781");
  EXPECT_EQ(hex(sha256(counting(119))), "da18797ed7c3a777f0847f429724a2d8cd5138e6ed2895c3fa1a6d39d18f7ec6");
  EXPECT_EQ(hex(sha256(counting(120))), "f52b23db1fbb6ded89ef42a23ce0c8922c45f25c50b568a93bf1c075420bbb7c");
}

TEST(HmacSha256, GivesThePublishedTags) {  // RFC 4231, cases 1, 2, 3, 6
  EXPECT_EQ(hex(hmacSha256(Bytes(20, 0x0b), bytesOf("Hi There"))),
            "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7");
  EXPECT_EQ(hex(hmacSha256(bytesOf("Jefe"), bytesOf("what do ya want for nothing?"))),
            "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
  EXPECT_EQ(hex(hmacSha256(Bytes(20, 0xaa), Bytes(50, 0xdd))),
            "773ea91e36800e46854db8ebd09181a72959098b3ef8c122d9635514ced565fe");
  EXPECT_EQ(hex(hmacSha256(Bytes(131, 0xaa), bytesOf("Test Using Larger Than Block-Size Key - Hash Key First"))),
            "60e431591ee0b67f0d8a26aacbf5b77f8e0bc6213728c5140546040f0ee37f54");
  EXPECT_EQ(hex(hmacSha256({}, {})), "b613679a0814d9ec772f95d778c35fc5ff1697c493715653c6c712144292c5ad");
}

TEST(HkdfSha256, GivesThePublishedKeys) {  // RFC 5869, cases 1-3, first 32 bytes
  const Bytes info1 = counting(10, 0xf0), info2 = counting(80, 0xb0);
  const auto text = [](const Bytes& bytes) {
    return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  EXPECT_EQ(hex(hkdfSha256(Bytes(22, 0x0b), counting(13), text(info1))),
            "3cb25f25faacd57a90434f64d0362f2a2d2d0a90cf1a5a4c5db02d56ecc4c5bf");
  EXPECT_EQ(hex(hkdfSha256(counting(80), counting(80, 0x60), text(info2))),
            "b11e398dc80327a1c8e7f78c596a49344f012eda2d4efad8a050cc4c19afa97c");
  EXPECT_EQ(hex(hkdfSha256(Bytes(22, 0x0b), {}, "")),
            "8da4e775a563c18f715f802a063c5a31b8a11f5c5ee1879ec3454e5f3c738d2d");
}

// An independent SipHash-2-4, checked against the authors' vector 8 (93f5f5799a932462), gave these under the first 16
// bytes of HKDF(00 .. 1f, "quadmark/test").
TEST(Prf, IsSipHashUnderADerivedKey) {
  const Prf prf(counting(32), "quadmark/test");
  EXPECT_EQ(prf(0), 0x606aef3d709bad50u);
  EXPECT_EQ(prf(1), 0x50189acee376061au);
  EXPECT_EQ(prf(0x0706050403020100u), 0x99e8d708cccdad69u);
  EXPECT_EQ(prf(~std::uint64_t{0}), 0x1684f2c7de91ea1du);
}

TEST(Prf, SeparatesSecretsAndPurposes) {
  const Prf reference(counting(32), "quadmark/paper/pad"), purpose(counting(32), "quadmark/paper/cells"),
      secret(counting(32, 1), "quadmark/paper/pad");
  int samePurpose = 0, sameSecret = 0;
  for (std::uint64_t item = 0; item < 1000; ++item) {
    samePurpose += reference.below(item, 2) == purpose.below(item, 2);
    sameSecret += reference.below(item, 2) == secret.below(item, 2);
  }
  // Independent coins agree in 500 +- 16 of 1000 cases; five standard deviations are allowed.
  EXPECT_NEAR(samePurpose, 500, 80);
  EXPECT_NEAR(sameSecret, 500, 80);
}

TEST(Prf, BelowIsUniformAndInRange) {
  const Prf prf(counting(32), "quadmark/test");
  std::vector<int> count(10, 0);
  for (std::uint64_t item = 0; item < 20000; ++item) {
    const std::uint32_t value = prf.below(item, 10);
    ASSERT_LT(value, 10u);
    ++count[value];
  }
  for (int c : count) EXPECT_NEAR(c, 2000, 215);  // five standard deviations
  EXPECT_EQ(prf.below(7, 1), 0u);
}

}  // namespace
}  // namespace quadmark
