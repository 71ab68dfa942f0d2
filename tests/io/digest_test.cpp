// Digests: those of another program (mmh3 5 of Python, mmh3.hash64 with x64arch). SPDX-License-Identifier: MIT
#include "base/digest.h"

#include <numeric>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

std::string digest_of(std::string_view text) {
    Digest digest;
    digest.add(std::as_bytes(std::span(text)));
    return hexadecimal(digest.value());
}

TEST(MapDigest, IsThatOfThePublication) {
    EXPECT_EQ(digest_of(""), "00000000000000000000000000000000");
    EXPECT_EQ(digest_of("a"), "85555565f6597889e6b53a48510e895a");
    EXPECT_EQ(digest_of("The quick brown fox jumps over the lazy dog"), "e34bbc7bbc071b6c7a433ca9c49a9347");
    EXPECT_EQ(digest_of("0123456789abcdef"), "4be06d94cf4ad1a787c35b5c63a708da");
    EXPECT_EQ(digest_of("0123456789abcdef0"), "eb24ae8785a5c07573fb68b3313128ca");
}

TEST(MapDigest, IsTheSameHoweverBytesCome) {
    std::vector<uint8_t> bytes(256);
    std::iota(bytes.begin(), bytes.end(), uint8_t{0});
    for (size_t step = 1; step <= bytes.size(); ++step) {
        Digest digest;
        for (size_t at = 0; at < bytes.size(); at += step)
            digest.add(std::as_bytes(std::span(bytes).subspan(at, std::min(step, bytes.size() - at))));
        EXPECT_EQ(hexadecimal(digest.value()), "1c99c313dc6f12b970d6077fab34cc1e") << step;
    }
}

// Lists that follow one another are told apart.
TEST(MapDigest, KnowsWhereListsEnd) {
    const std::vector<uint32_t> values{1, 2, 3};
    const auto of = [&](size_t first) {
        Digest digest;
        digest.add_list(std::span(values).first(first)), digest.add_list(std::span(values).subspan(first));
        return digest.value();
    };
    EXPECT_NE(of(1), of(2));
}

}  // namespace
}  // namespace vesper::test
