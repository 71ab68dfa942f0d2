// Means over pixels whose results are known. SPDX-License-Identifier: MIT
#include "passes/edges_reference.h"

#include <gtest/gtest.h>

namespace vesper::test::edges_reference_test {
namespace {

using glm::dvec2, glm::dvec3, glm::ivec2;
using reference::SeenFacet, reference::SeenPicture;

// A picture of 5 x 5 px, 1 m wide at a distance of 1 m, of which each middle sees the nearest of these facets.
SeenPicture picture_of(const std::vector<SeenFacet>& facets, const std::vector<double>& luminance) {
    SeenPicture picture{ivec2(5), dvec2(0.2, -0.2), dvec2(-0.5, 0.5), {}, {}};
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) {
            const dvec3 ray(picture.scale * (dvec2(x, y) + 0.5) + picture.offset, -1);
            SeenFacet seen;
            double nearest = 0, light = luminance.back();  // of nothing
            for (size_t i = 0; i < facets.size(); ++i) {
                const auto [inside, inverse_depth] = reference::pass(facets[i].corners, ray, picture.scale);
                if (inside < 0 || inverse_depth <= nearest) continue;
                seen = facets[i], nearest = inverse_depth, light = luminance[i];
                seen.position = ray / inverse_depth;
            }
            picture.facets.push_back(seen);
            picture.luminance.emplace_back(light);
        }
    return picture;
}

// A rectangle facing the eye, from and to these places at this distance.
SeenFacet rectangle(uint32_t instance, dvec2 low, dvec2 high, double distance) {
    return {instance,
            instance,
            {{low.x, low.y, -distance},
             {high.x, low.y, -distance},
             {high.x, high.y, -distance},
             {low.x, high.y, -distance}},
            {0, 0, 1},
            {},
            {}};
}

TEST(EdgesReference, AnEdgeBetweenTwoWallsIsTheirMean) {
    // The near wall ends 0.3 px right of the middle of the middle pixel.
    const SeenPicture picture =
        picture_of({rectangle(1, {-2, -2}, {0.06, 2}, 1), rectangle(2, {-9, -9}, {9, 9}, 3)}, {10, 2, 0});
    EXPECT_TRUE(reference::is_edge(picture, {2, 2}));
    EXPECT_FALSE(reference::is_edge(picture, {0, 2}));
    const double covered = 13 / 16.0;  // of points in columns of 1/16: of 0.8
    EXPECT_NEAR(reference::edge_mean(picture, {2, 2}).luminance.g, 10 * covered + 2 * (1 - covered), 1e-12);
    EXPECT_NEAR(reference::edge_mean(picture, {3, 2}).luminance.g, 2, 1e-12);
}

// Each column and each row has one, and their mean is the middle.
TEST(EdgesReference, PointsAreSpreadEvenly) {
    for (const uint32_t n : {4u, 8u, 16u}) {
        dvec2 sum(0);
        std::vector<int> columns(n), rows(n);
        for (uint32_t i = 0; i < n; ++i) {
            const dvec2 at = reference::point_of(i, n);
            sum += at;
            ++columns.at(size_t((at.x + 0.5) * n)), ++rows.at(size_t((at.y + 0.5) * n));
        }
        EXPECT_NEAR(glm::length(sum), 0, 1e-12);
        EXPECT_EQ(columns, std::vector<int>(n, 1));
        EXPECT_EQ(rows, std::vector<int>(n, 1));
    }
    EXPECT_NEAR(reference::point_of(1, 8).y, 0.5 + 1 / 16.0 - 0.5, 1e-12);
    EXPECT_NEAR(reference::point_of(5, 6).y, 0.5 + 0.125 + 1 / 16.0 - 0.5, 1e-12) << "5 is 101";
}

// The middles of 6 of 8 columns are left of the border, 0.3 px right of the middle.
TEST(EdgesReference, FewerPointsAreCoarser) {
    SeenPicture picture =
        picture_of({rectangle(1, {-2, -2}, {0.06, 2}, 1), rectangle(2, {-9, -9}, {9, 9}, 3)}, {10, 2, 0});
    picture.points = 8;
    EXPECT_NEAR(reference::edge_mean(picture, {2, 2}).luminance.g, 10 * 0.75 + 2 * 0.25, 1e-12);
}

TEST(EdgesReference, BesideNothingItIsTheMeanWithNothing) {
    const SeenPicture picture = picture_of({rectangle(1, {-2, -2}, {0.001, 2}, 1)}, {8, 1});
    EXPECT_NEAR(reference::edge_mean(picture, {2, 2}).luminance.g, (8 + 1) / 2.0, 1e-12);
}

TEST(EdgesReference, OneSurfaceIsItself) {
    const SeenPicture picture =
        picture_of({rectangle(1, {-9, -9}, {0.01, 9}, 2), rectangle(1, {0.01, -9}, {9, 9}, 2)}, {4, 7, 0});
    EXPECT_FALSE(reference::is_edge(picture, {2, 2})) << "the same instance, plane and normal";
}

TEST(EdgesReference, ALightBehindAnEdgeKeepsItsShare) {
    // 1e4 cd/m^2 over a quarter of a pixel, on 1 cd/m^2: 2,501, whatever the display can show.
    const SeenPicture picture =
        picture_of({rectangle(1, {0.05, -9}, {9, 9}, 1), rectangle(2, {-9, -9}, {9, 9}, 3)}, {1e4, 1, 0});
    EXPECT_NEAR(reference::edge_mean(picture, {2, 2}).luminance.g, (4 * 1e4 + 12) / 16, 1e-9);
}

// Limits that are found nowhere else: 2 % of any channel, a cosine of 0.9, 1/5000 of the depth.
TEST(EdgesReference, SmallContrastsAndBendsAreNone) {
    SeenPicture picture =
        picture_of({rectangle(1, {-2, -2}, {0.06, 2}, 1), rectangle(2, {-9, -9}, {9, 9}, 3)}, {10, 10});
    EXPECT_FALSE(reference::is_edge(picture, {2, 2}));
    for (int c = 0; c < 3; ++c)
        for (const double more : {1.019, 1.021}) {
            SeenPicture other = picture;
            other.luminance[2 * 5 + 2][c] *= more;
            // The middle is on the near wall, its neighbour to the right is not.
            EXPECT_EQ(reference::is_edge(other, {3, 2}), more > 1.02) << c;
        }
    SeenFacet here = rectangle(1, {-1, -1}, {1, 1}, 10), there = here;
    here.position = {0, 0, -10}, there.position = {0.5, 0, -10};
    EXPECT_TRUE(reference::is_one_surface(here, there));
    for (const double degrees : {25.0, 26.5}) {
        const double bend = degrees * 0.017453292519943;
        there.normal = {std::sin(bend), 0, std::cos(bend)};
        EXPECT_EQ(reference::is_one_surface(here, there), degrees < 26);
    }
    there.normal = here.normal;
    for (const double step : {1.9e-3, 2.1e-3}) {
        there.position.z = -10 - step;
        EXPECT_EQ(reference::is_one_surface(here, there), step < 2e-3);
        EXPECT_EQ(reference::is_one_surface(there, here), step < 2e-3);
    }
    there.instance = 2, there.position.z = -10;
    EXPECT_FALSE(reference::is_one_surface(here, there));
}

TEST(EdgesReference, WidthsArePixels) {
    const std::vector<dvec3> square{{-1, -1, -2}, {1, -1, -2}, {1, 0, -2}, {-1, 0, -2}},
        triangle{{0, 0, -1}, {1, 0, -1}, {0, 1, -1}};
    EXPECT_NEAR(reference::width_of(square, {0, -0.1, -1}, {0.01, -0.01}), 50, 1e-9);
    EXPECT_NEAR(reference::width_of(triangle, {0.1, 0.1, -1}, {0.01, -0.01}), 50 * std::sqrt(0.5), 1e-9)
        << "half of the least height";
}

// What has holes, and what is narrower than a pixel, is in its pixels as a whole, and in no others.
TEST(EdgesReference, HolesAndNarrowThingsFillTheirPixels) {
    for (const bool masked : {false, true}) {
        const double half = masked ? 0.25 : 0.08;  // 2.5 or 0.8 px wide
        SeenFacet thing = rectangle(1, {-half, -9}, {half, 9}, 1);
        thing.masked = masked;
        const SeenPicture picture = picture_of({thing, rectangle(2, {-9, -9}, {9, 9}, 3)}, {3, 1, 0});
        const int beside = masked ? 4 : 3;
        EXPECT_EQ(reference::edge_mean(picture, {2, 2}).luminance.g, 3) << masked;
        EXPECT_EQ(reference::edge_mean(picture, {beside, 2}).luminance.g, 1) << masked;
    }
}

// A board of 5 px whose right half has holes, from 0.3 px right of the middle of the middle pixel.
TEST(EdgesReference, HolesShowWhatIsBehind) {
    SeenFacet board = rectangle(1, {-0.44, -9}, {0.56, 9}, 1);
    board.uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    SeenPicture picture = picture_of({board, rectangle(2, {-9, -9}, {9, 9}, 3)}, {10, 2, 0});
    auto mask = std::make_shared<reference::Mask>();
    mask->levels = {{2, 1, {{1, 1, 1, 1}, {1, 1, 1, 0}}, reference::Wrapping::Clamp, reference::Wrapping::Clamp}};
    for (const bool nearest : {false, true}) {
        mask->nearest = nearest;
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 5; ++x) {
                SeenFacet& facet = picture.facets[size_t(5 * y + x)];
                if (x <= 2)
                    facet.masked = true, facet.mask = mask;
                else
                    facet = rectangle(2, {-9, -9}, {9, 9}, 3), picture.luminance[size_t(5 * y + x)] = dvec3(2);
            }
        const double covered = 13 / 16.0;
        EXPECT_NEAR(reference::edge_mean(picture, {2, 2}).luminance.g, 10 * covered + 2 * (1 - covered), 1e-12);
        EXPECT_NEAR(reference::edge_mean(picture, {1, 2}).luminance.g, 10, 1e-12);
        EXPECT_NEAR(reference::edge_mean(picture, {3, 2}).luminance.g, 2, 1e-12);
    }
}

TEST(EdgesReference, ARegionIsOneSurface) {
    SeenFacet one = rectangle(1, {-1, -1}, {0, 1}, 1), other = rectangle(1, {0, -1}, {1, 1}, 1);
    one.position = {-0.1, 0, -1}, other.position = {0.1, 0, -1};
    EXPECT_TRUE(reference::is_one_surface(one, other));
    other.region = 1;
    EXPECT_FALSE(reference::is_one_surface(one, other));
}

TEST(EdgesReference, DistancesArePixels) {
    const auto [inside, inverse_depth] =
        reference::pass(rectangle(1, {-1, -1}, {0.1, 1}, 2).corners, {0, 0, -1}, {0.01, -0.01});
    EXPECT_NEAR(inside, 5, 1e-12);
    EXPECT_NEAR(inverse_depth, 0.5, 1e-12);
    // From behind it is the same, and to a place behind the eye it goes on.
    const std::vector<dvec3> road{{-1, -1, 5}, {1, -1, 5}, {1, -1, -50}, {-1, -1, -50}};
    EXPECT_NEAR(reference::pass(road, {0, -0.1, -1}, {0.01, -0.01}).inverse_depth, 0.1, 1e-12);
    EXPECT_NEAR(reference::pass(road, {0, -0.1, -1}, {0.01, -0.01}).inside, std::min(8.0, 0.1 / 0.01 / std::sqrt(1.01)),
                3);
}

}  // namespace
}  // namespace vesper::test::edges_reference_test
