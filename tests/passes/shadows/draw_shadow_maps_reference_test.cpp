// The geometry of shadow maps: closed forms. SPDX-License-Identifier: MIT
#include "passes/shadows/draw_shadow_maps_reference.h"

#include <gtest/gtest.h>

#include "base/angle.h"

namespace vesper::test::draw_shadow_maps_reference_test {
namespace {

TEST(ShadowMapReference, DirectionsAndPlacesAreInverse) {
    for (const double zoom : {1.0, 2.5})
        for (double y = 0.5; y < 16; ++y)
            for (double x = 0.5; x < 16; ++x) {
                const glm::dvec3 p = reference::map_direction({x, y}, 16, zoom);
                EXPECT_NEAR(std::abs(p.x) + std::abs(p.y) + p.z, 1, 1e-15);
                const glm::dvec2 back = reference::map_texel(7.0 * p, 16, zoom);
                EXPECT_NEAR(back.x, x, 1e-12);
                EXPECT_NEAR(back.y, y, 1e-12);
            }
}

// The solid angle of a piece of the plane x + y + z = 1 at p is its area / sqrt 3 / |p|^3 (from the distance of the
// plane, 1 / sqrt 3); that plane's area is sqrt 3 times dx dy, and du dv = 2 dx dy.
TEST(ShadowMapReference, TexelsCoverTheHemisphere) {
    constexpr int kSide = 256;
    double sum = 0, least = 1e9, most = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const glm::dvec3 p = reference::map_direction({x + 0.5, y + 0.5}, kSide, 1);
            const double area = 2.0 / kSide / kSide;  // dx dy, of 4 / kSide^2 in (u, v)
            const double angle = area / std::pow(glm::length(p), 3);
            sum += angle, least = std::min(least, angle), most = std::max(most, angle);
        }
    EXPECT_NEAR(sum, kTwoPi, 1e-4 * kTwoPi);
    EXPECT_LT(most / least, 5.3);  // 3 sqrt 3 = 5.2: no texel is much smaller than another
}

TEST(ShadowMapReference, ABeamFillsTheZoomedSquare) {
    // zoom 4 holds what is within a quarter of the square: 45 degrees off the axes of x and y, sqrt 2 s / (sqrt 2 s +
    // c) = 1/4.
    const double angle = std::atan(1 / (3 * std::sqrt(2.0)));
    const glm::dvec3 p(std::sin(angle) / std::sqrt(2.0), std::sin(angle) / std::sqrt(2.0), std::cos(angle));
    EXPECT_NEAR(reference::map_texel(p, 64, 4).x, 64, 1e-9);
}

// Along a row of texels within a quadrant the inverse distance of a plane is linear.
TEST(ShadowMapReference, PlanesHaveNoEdgesWithinAQuadrant) {
    reference::HemisphereMap map{64, {}};
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.5, 1));
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double facing = glm::dot(normal, reference::map_direction({x + 0.5, y + 0.5}, 64, 1));
            map.norms.push_back(facing > 0.05 ? 3 / facing : 1e30);
        }
    int edges = 0, across = 0;
    for (int y = 1; y < 63; ++y)
        for (int x = 1; x < 63; ++x) {
            if (map.at(x, y) > 60 || map.at(x + 1, y) > 60 || map.at(x - 1, y) > 60 || map.at(x, y + 1) > 60 ||
                map.at(x, y - 1) > 60)
                continue;
            const bool seam = std::abs(x - y) <= 1 || std::abs(x + y - 63) <= 1;  // the borders of quadrants
            (seam ? across : edges) += map.edge(x, y) ? 1 : 0;
        }
    EXPECT_EQ(edges, 0);
    EXPECT_GT(across, 0);  // rows bend there
    map.norms[size_t(20 * 64 + 30)] *= 0.99;
    EXPECT_TRUE(map.edge(29, 20) && map.edge(30, 20) && map.edge(31, 20) && map.edge(30, 19) && map.edge(30, 21));
}

}  // namespace
}  // namespace vesper::test::draw_shadow_maps_reference_test
