// Lookups in shadow maps: closed forms. SPDX-License-Identifier: MIT
#include "passes/shadows/visibility_reference.h"

#include <gtest/gtest.h>

namespace vesper::test::visibility_reference_test {
namespace {

// A map of planes normal . p = away, the nearest of them.
struct Plane {
    glm::dvec3 normal;
    double away;
};
reference::HemisphereMap map_of(std::initializer_list<Plane> planes, uint32_t side, double zoom) {
    reference::HemisphereMap map{side, {}};
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const glm::dvec3 way = reference::map_direction({x + 0.5, y + 0.5}, side, zoom);
            double nearest = 1e30;
            for (const auto& [normal, away] : planes)
                if (glm::dot(normal, way) * away > 0) nearest = std::min(nearest, away / glm::dot(normal, way));
            map.norms.push_back(nearest);
        }
    return map;
}

// However a plane is seen, it hides none of itself: the bias is never needed for it.
TEST(VisibilityReference, APlaneNeverHidesItself) {
    for (const glm::dvec3 tilt : {glm::dvec3(0, 0, 1), {0.4, 0.3, 1}, {-2, 0.5, 1}, {0, 5, 1}}) {
        const glm::dvec3 normal = glm::normalize(tilt);
        for (const double zoom : {1.0, 3.0}) {
            const reference::HemisphereMap map = map_of({{normal, 4}}, 64, zoom);
            for (double y = 2.3; y < 62; y += 1.37)
                for (double x = 2.1; x < 62; x += 1.13) {
                    const glm::dvec3 way = reference::map_direction({x, y}, 64, zoom);
                    if (glm::dot(normal, way) < 0.02) continue;
                    const glm::dvec3 point = way * (4 / glm::dot(normal, way));
                    EXPECT_EQ(reference::lookup(map, zoom, point, normal).share, 1) << x << " " << y;
                }
        }
    }
}

TEST(VisibilityReference, WhatIsBehindAPlaneIsDark) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, -0.1, 1));
    const reference::HemisphereMap map = map_of({{normal, 4}}, 128, 1);
    // Behind by more than the bias: 0.016 m, half a texel of 1/128 and a thousandth, of 4 m.
    const glm::dvec3 behind = normal * 4.1, before = normal * 3.9, just_behind = normal * 4.01;
    EXPECT_EQ(reference::lookup(map, 1, behind, normal).share, 0);
    EXPECT_EQ(reference::lookup(map, 1, before, normal).share, 1);
    EXPECT_EQ(reference::lookup(map, 1, just_behind, normal).share, 1);
    EXPECT_EQ(reference::lookup(map, 1, -behind, normal).share, 1) << "the map does not reach there";
}

// A half plane before a wall: the shadow's edge is straight and within half a texel of where it should be.
TEST(VisibilityReference, EdgesAreWithinHalfATexel) {
    constexpr uint32_t kSide = 128;
    reference::HemisphereMap map{kSide, {}};
    const auto hides = [](glm::dvec3 way) {
        return 2 * (way.x / way.z) + 0.3 * 2 * (way.y / way.z) > 0.4;
    };  // at z = 2
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
            const glm::dvec3 way = reference::map_direction({x + 0.5, y + 0.5}, kSide, 1);
            map.norms.push_back((hides(way) ? 2.0 : 5.0) / way.z);
        }
    for (double y = -1; y < 1; y += 0.031)
        for (double x = -2; x < 2; x += 0.017) {
            const glm::dvec3 point(x, y, 5);
            const glm::dvec2 texel = reference::map_texel(point, kSide, 1);
            int sides = 0;  // of the edge, of points half a texel away
            for (const glm::dvec2 d : {glm::dvec2(0.55, 0), {-0.55, 0}, {0, 0.55}, {0, -0.55}})
                sides |= hides(reference::map_direction(texel + d, kSide, 1)) ? 1 : 2;
            if (sides == 3) continue;
            EXPECT_EQ(reference::lookup(map, 1, point, {0, 0, 1}).share, sides == 2 ? 1 : 0) << x << " " << y;
        }
}

// The same with the edge along a column of texels, and pixels of a third of a texel: a pixel has the share of its own
// square that is lit; pixels wider than a texel have that of a texel.
TEST(VisibilityReference, PixelsAtAnEdgeHaveTheirShare) {
    constexpr uint32_t kSide = 128;
    reference::HemisphereMap map{kSide, {}};
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x) {
            const glm::dvec3 way = reference::map_direction({x + 0.5, y + 0.5}, kSide, 1);
            map.norms.push_back((x < 70 ? 2.0 : 5.0) / way.z);
        }
    const auto at = [&](double x) {
        const glm::dvec3 way = reference::map_direction({x, 60.3}, kSide, 1);
        return way * (5 / way.z);
    };
    for (const double pixel : {1 / 3.0, 0.8, 1.0, 4.0}) {
        const glm::dvec3 right = 1e3 * (at(70 + 1e-3 * pixel) - at(70));
        for (double x = 68; x < 72; x += 0.0613) {
            const double want = std::clamp((x - 70) / std::min(pixel, 1.0) + 0.5, 0.0, 1.0);
            EXPECT_NEAR(reference::lookup(map, 1, at(x), {0, 0, 1}, false, right).share, want, 0.02) << x;
        }
    }
}

}  // namespace
}  // namespace vesper::test::visibility_reference_test
