// What the pixels of a view see. SPDX-License-Identifier: MIT
#include "gpu_scene/view.h"

#include <gtest/gtest.h>

namespace vesper::test::view_test {
namespace {

using gpu_scene::View;

glm::dvec2 seen(const View& view, glm::dvec2 pixel) {
    return glm::dvec2(view.ray_scale()) * (pixel + 0.5) + glm::dvec2(view.ray_offset());
}

// Within rounding of the tangents, 1/1000 px.
TEST(View, PixelsOfAMovedOneSeeWhatLiesBesideTheirMiddles) {
    const View view{.extent = {1680, 1050}, .tangent_low = {-0.3f, -0.6f}, .tangent_high = {0.9f, 0.2f}};
    const double pixel = 1.2 / 1680;
    for (const glm::dvec2 way : {glm::dvec2(0.25, 0), {0, -0.5}, {-0.4, 0.3}, {0, 0}})
        for (const glm::dvec2 at : {glm::dvec2(0, 0), {1679, 1049}, {840, 500}}) {
            const glm::dvec2 got = seen(view.moved(way), at), want = seen(view, at + way);
            EXPECT_NEAR(got.x, want.x, 1e-3 * pixel);
            EXPECT_NEAR(got.y, want.y, 1e-3 * pixel);
        }
    EXPECT_EQ(view.moved({0, 0}).tangent_low, view.tangent_low);
    EXPECT_EQ(view.moved({0, 0}).tangent_high, view.tangent_high);
}

}  // namespace
}  // namespace vesper::test::view_test
