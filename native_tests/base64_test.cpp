// SPDX-License-Identifier: MIT
#include "base64.h"

#include <gtest/gtest.h>

#include "quadmark/random.h"

namespace quadmark {
namespace {

std::vector<std::uint8_t> bytesOf(std::string_view text) { return {text.begin(), text.end()}; }

TEST(Base64, GivesThePublishedStrings) {  // RFC 4648 section 10
  const std::pair<const char*, const char*> vectors[] = {{"", ""},         {"f", "Zg=="},     {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},  {"foob", "Zm9vYg=="}, {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, encoded] : vectors) {
    EXPECT_EQ(toBase64(bytesOf(plain)), encoded);
    ASSERT_TRUE(fromBase64(encoded).has_value()) << encoded;
    EXPECT_EQ(*fromBase64(encoded), bytesOf(plain));
  }
}

TEST(Base64, BringsAnyBytesBack) {
  Random random(3);
  for (std::size_t length = 0; length < 70; ++length) {
    std::vector<std::uint8_t> bytes(length);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
    EXPECT_EQ(fromBase64(toBase64(bytes)), bytes);
  }
}

TEST(Base64, RefusesWhatIsNotStrictBase64) {
  for (const char* text : {"Z", "Zg", "Zg=", "Zg==\n", " Zg==", "Zm9v Zm9", "Zg==Zg==", "Zm=v", "====", "Z===", "Zm9-",
                           "Zm9_", "Zm9\xc3"})
    EXPECT_FALSE(fromBase64(text).has_value()) << text;
}

}  // namespace
}  // namespace quadmark
