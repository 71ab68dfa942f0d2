// The geometry of maps of directional lamps: closed forms. SPDX-License-Identifier: MIT
#include "passes/shadows/draw_clipmaps_reference.h"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

namespace vesper::test::draw_clipmaps_reference_test {
namespace {

TEST(ClipmapReference, PlacesAndPointsAreInverse) {
    const glm::dmat3 rotation(glm::mat3_cast(glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, -0.5)))));
    const reference::Level level{rotation, {3, -2, 11}, 16, 64};
    for (double y = 0.5; y < 64; y += 7)
        for (double x = 0.5; x < 64; x += 5) {
            const glm::dvec3 back =
                reference::to_level(level, reference::on_level(level, {x, y}) + 4.0 * glm::transpose(rotation)[2]);
            EXPECT_NEAR(back.x, x, 1e-12);
            EXPECT_NEAR(back.y, y, 1e-12);
            EXPECT_NEAR(back.z, 4, 1e-12) << "m along the light";
        }
}

TEST(ClipmapReference, ASquareIsAsWideAsItSays) {
    const reference::Level level{glm::dmat3(1), {1, 2, 3}, 16, 64};
    EXPECT_EQ(reference::on_level(level, {0, 0}), glm::dvec3(-15, -14, 3));
    EXPECT_EQ(reference::on_level(level, {64, 32}), glm::dvec3(17, 2, 3));
}

}  // namespace
}  // namespace vesper::test::draw_clipmaps_reference_test
