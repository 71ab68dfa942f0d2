// Small emitters whose light in pixels is known. SPDX-License-Identifier: MIT
#include "passes/small_emitters_reference.h"

#include <gtest/gtest.h>

namespace vesper::test::small_emitters_reference_test {
namespace {

using glm::dvec2, glm::dvec3, glm::ivec2;
using reference::SeenFacet, reference::SeenPicture, reference::SmallTriangle;

// 3 x 3 px that see along (0.2 (pixel + 1/2) - 0.3, ..., -1): all of them a wall at 4 m, or nothing.
SeenPicture picture(bool wall) {
    SeenPicture picture{ivec2(3), dvec2(0.2, -0.2), dvec2(-0.3, 0.3), {}, {}};
    for (int i = 0; i < 9; ++i) {
        SeenFacet facet;
        if (wall) facet = {1, 1, {{-9, -9, -4}, {9, -9, -4}, {9, 9, -4}, {-9, 9, -4}}, {0, 0, 1}, {0, 0, -4}, false};
        picture.facets.push_back(facet), picture.luminance.emplace_back(0);
    }
    return picture;
}

// A square of 0.5 px in the middle pixel, at a depth, m.
SmallTriangle square(double depth, double widening = 1) {
    return {{{1.25, 1.25}, {1.75, 1.25}, {1.75, 1.75}, {1.25, 1.75}}, dvec3(100), {0, 0, 1 / depth}, {1, 1}, widening};
}

TEST(SmallEmittersReference, LuminanceCountsByArea) {
    for (const bool wall : {false, true})
        EXPECT_NEAR(reference::emitted({square(3)}, picture(wall), {1, 1}).luminance.g, 25, 1e-12);
    EXPECT_EQ(reference::emitted({square(3)}, picture(true), {0, 1}).luminance.g, 0);
    EXPECT_NEAR(reference::emitted({square(3), square(2)}, picture(true), {1, 1}).luminance.g, 25, 1e-12)
        << "what is before it hides it";
    const std::vector<SmallTriangle> widened(12, square(3, 2));
    EXPECT_NEAR(reference::emitted(std::vector(3, square(3, 2)), picture(true), {1, 1}).luminance.g, 37.5, 1e-12)
        << "but for what was widened";
    EXPECT_NEAR(reference::emitted(widened, picture(true), {1, 1}).luminance.g, 100, 1e-12) << "their own luminance";
}

TEST(SmallEmittersReference, WhatIsBeforeThemHidesThem) {
    EXPECT_EQ(reference::emitted({square(5)}, picture(true), {1, 1}).luminance.g, 0);
    EXPECT_NEAR(reference::emitted({square(4)}, picture(true), {1, 1}).luminance.g, 25, 1e-12) << "on the wall itself";
    // A bar over the right half of it: two of the four columns of points within.
    SmallTriangle bar = square(2, 0);
    bar.silhouette = {{1.5, 0}, {1.6, 0}, {1.6, 3}, {1.5, 3}};
    EXPECT_NEAR(reference::emitted({square(3), bar}, picture(true), {1, 1}).luminance.g, 25 * 0.75, 25 * 0.13);
    bar.inverse_depth.z = 1 / 3.5;
    EXPECT_NEAR(reference::emitted({square(3), bar}, picture(true), {1, 1}).luminance.g, 25, 1e-12) << "behind it";
}

TEST(SmallEmittersReference, HolesHideTheirOwnPixel) {
    SeenPicture seen = picture(false);
    SeenFacet& leaf = seen.facets[4];
    leaf = {1, 1, {{-9, -9, -2}, {9, -9, -2}, {9, 9, -2}, {-9, 9, -2}}, {0, 0, 1}, {0, 0, -2}, true};
    EXPECT_EQ(reference::emitted({square(3)}, seen, {1, 1}).luminance.g, 0);
    std::swap(seen.facets[4], seen.facets[3]);
    EXPECT_NEAR(reference::emitted({square(3)}, seen, {1, 1}).luminance.g, 25, 1e-12);
}

}  // namespace
}  // namespace vesper::test::small_emitters_reference_test
