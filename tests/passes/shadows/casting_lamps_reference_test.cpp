// Shares of light by hand. SPDX-License-Identifier: MIT
#include "passes/shadows/casting_lamps_reference.h"

#include <gtest/gtest.h>

namespace vesper::reference {
namespace {

shared::Lamp point(glm::vec3 position, float candela) {
    shared::Lamp lamp{};
    lamp.position = position, lamp.intensity = candela, lamp.axis = {0, -1, 0}, lamp.lobe_b = 1,
    lamp.colour = glm::vec3(2, 1, 0.5f);
    return lamp;
}

// 90 cd at 3 m above give 10 lx; 20 cd at 2 m 5 lx; the third is below the ground.
TEST(CastingLampsReference, SharesAreThoseOfIlluminance) {
    const glm::vec3 ground(0, -1.5f, -4);
    const std::vector<shared::Lamp> lamps{point(ground + glm::vec3(0, 3, 0), 90),
                                          point(ground + glm::vec3(0, 2, 0), 20),
                                          point(ground - glm::vec3(0, 1, 0), 500)};
    const std::vector<double> shares = light_shares(lamps, {3, 0, 0, 0}, ground, {0, 1, 0}, 1e-9);
    EXPECT_NEAR(shares[0], 10.0 / 15, 1e-6);
    EXPECT_NEAR(shares[1], 5.0 / 15, 1e-6);
    EXPECT_EQ(shares[2], 0);
    EXPECT_EQ(light_shares(std::span(lamps).first(2), {2, 0, 0, 0}, ground, {0, -1, 0}, 1e-9), std::vector<double>(2));
}

TEST(CastingLampsReference, TheFaintestAreLeftOut) {
    const std::vector<double> shares{0.5, 0.01, 0.02, 0.3, 0.02, 0.15};
    EXPECT_EQ(unshadowed(shares, {1, 2, 3, 4}, 0.045), (std::vector<uint32_t>{1, 2}));
    EXPECT_EQ(unshadowed(shares, {1, 2, 3, 4}, 0.055), (std::vector<uint32_t>{1, 2, 4}));
    EXPECT_EQ(unshadowed(shares, {0, 3}, 0.1), std::vector<uint32_t>());
}

}  // namespace
}  // namespace vesper::reference
