// Light of a display's codes against its description. SPDX-License-Identifier: MIT
#include "analysis/display_light.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/luminance.h"

namespace vesper::test {
namespace {

std::vector<double> luminances_of(const std::vector<float>& rgb) {
    std::vector<double> luminances;
    for (size_t i = 0; i < rgb.size(); i += 3) luminances.push_back(luminance({rgb[i], rgb[i + 1], rgb[i + 2]}));
    return luminances;
}

TEST(DisplayLight, IsThatOfTheDescription) {
    const vision::Display display{.peak = 200, .black = 0.5f, .gamma = 2, .ambient = 10, .reflection = 0.1f};
    const analysis::DisplayLight light(display);
    const double reflected = 0.1 * 10 / std::numbers::pi;
    const std::vector<uint16_t> codes{0, 0, 0, 7, 65535, 65535, 65535, 0, 32768, 32768, 32768, 0, 0, 65535, 0, 0};
    const std::vector<double> seen = luminances_of(light.of_wide(codes));
    const double half = 32768.0 / 65535;
    ASSERT_EQ(seen.size(), 4u);
    EXPECT_NEAR(seen[0], 0.5 + reflected, 1e-5);
    EXPECT_NEAR(seen[1], 200 + reflected, 1e-3);
    EXPECT_NEAR(seen[2], 0.5 + 199.5 * half * half + reflected, 1e-4);
    // The green of Rec. 709 has 0.715 of the white's luminance; the other channels have their black.
    EXPECT_NEAR(seen[3], 0.715169 * 200 + (1 - 0.715169) * 0.5 + reflected, 1e-3);
}

TEST(DisplayLight, ReadsWordsOfEightAndTenBits) {
    for (const uint32_t bits : {8u, 10u}) {
        vision::Display display;
        display.bits = bits;
        const uint32_t top = display.largest_code(), word = top << bits;  // green
        std::vector<uint8_t> bytes;
        for (int i = 0; i < 4; ++i) bytes.push_back(uint8_t(word >> (8 * i)));
        const analysis::DisplayLight light(display);
        const std::vector<float> words = light.of_words(bytes),
                                 wide = light.of_wide(std::vector<uint16_t>{0, 65535, 0, 0});
        ASSERT_EQ(words.size(), 3u);
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(words[c], wide[c], 1e-4) << bits;
        EXPECT_GT(words[1], 50 * words[0]) << "it is green";
    }
}

}  // namespace
}  // namespace vesper::test
