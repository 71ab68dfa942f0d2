// The observers' views of a road: where grid points are seen, and what is read there. SPDX-License-Identifier: MIT
#include "road_view.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

roads::RoadLayout layout_of(double spacing, double width, int lanes) {
    roads::RoadLayout layout;
    layout.width = width;
    layout.lanes = lanes;
    layout.spacing = spacing;
    return layout;
}

/// Where a pixel place meets the road: the inverse of project().
glm::dvec2 on_road(const gpu_scene::View& view, const roads::LaneObserver& observer, glm::dvec2 place) {
    const glm::dvec2 tangent = glm::dvec2(view.ray_scale()) * place + glm::dvec2(view.ray_offset());
    const double away = observer.eye.z / -tangent.y;
    return {observer.eye.x + away, observer.eye.y - tangent.x * away};
}

TEST(RoadView, HoldsEveryPointOfTheGrid) {
    for (const roads::RoadLayout& layout :
         {layout_of(30, 7, 2), layout_of(12, 3.5, 1), layout_of(60, 14, 4), layout_of(100, 36, 12)})
        for (const roads::LaneObserver& observer : roads::lane_observers(layout)) {
            const gpu_scene::View view = commands::road_view(layout, observer);
            const roads::CalculationField field = roads::calculation_field(layout);
            for (const double x : field.x)
                for (const double y : field.y) {
                    const glm::dvec2 place = commands::project(view, {x, y, 0});
                    EXPECT_TRUE(place.x > 1 && place.y > 1 && place.x < view.extent.width - 1 &&
                                place.y < view.extent.height - 1)
                        << x << " " << y;
                    const glm::dvec2 back = on_road(view, observer, place);
                    EXPECT_NEAR(back.x, x, 2e-3);
                    EXPECT_NEAR(back.y, y, 2e-3);
                    const glm::dvec2 next = on_road(view, observer, place - glm::dvec2(0, 1));
                    EXPECT_NEAR(commands::depth_of_pixel(view, observer, x), next.x - x, 0.01 * (next.x - x) + 2e-3);
                    EXPECT_LE(next.x - x, view.extent.height < 4096 ? 0.052 : 0.1);
                }
        }
    // The standard observer sees the road of the worked example under 1.42 to 0.97 degrees.
    const roads::RoadLayout layout = layout_of(30, 7, 2);
    const gpu_scene::View view = commands::road_view(layout, roads::lane_observers(layout)[0]);
    EXPECT_GT(view.extent.height, 500u);
    const gpu_scene::View few = commands::road_view(layout, roads::lane_observers(layout)[0], 300);
    EXPECT_EQ(few.extent.height, 300u);
}

TEST(RoadView, OfAPointHasItInTheMiddle) {
    for (const roads::RoadLayout& layout : {layout_of(30, 7, 2), layout_of(12, 3.5, 1), layout_of(60, 14, 4)})
        for (const roads::LaneObserver& observer : roads::lane_observers(layout))
            for (const double x : roads::calculation_field(layout).x)
                for (const double y : roads::calculation_field(layout).y) {
                    const gpu_scene::View view = commands::road_point_view(observer, {x, y});
                    const glm::dvec2 place = commands::project(view, {x, y, 0});
                    EXPECT_NEAR(place.x, 4, 0.02);  // tangents are floats
                    EXPECT_NEAR(place.y, 4, 0.02);
                    EXPECT_NEAR(on_road(view, observer, place + glm::dvec2(0, -1)).x - x, 0.001, 1e-4);
                    EXPECT_NEAR(on_road(view, observer, place + glm::dvec2(1, 0)).y - y, -0.001, 1e-4);
                }
}

TEST(RoadView, OverviewHasSquarePixelsAndTheHorizon) {
    const roads::RoadLayout layout = layout_of(30, 7, 2);
    const roads::LaneObserver observer = roads::lane_observers(layout)[1];
    const gpu_scene::View view = commands::road_overview(layout, observer, 800);
    EXPECT_NEAR(view.ray_scale().x / -view.ray_scale().y, 1, 0.01);
    EXPECT_GT(view.tangent_high.y, 0);
    const glm::dvec2 middle = commands::project(view, {1e6, observer.eye.y, 0}),
                     left = commands::project(view, {0, 7, 0}), right = commands::project(view, {0, 0, 0});
    EXPECT_GT(left.x, 0);
    EXPECT_LT(right.x, 800);
    EXPECT_LT(left.x, middle.x);
    EXPECT_LT(middle.x, right.x);
    EXPECT_LT(middle.y, left.y);
}

TEST(RoadView, ReadsBetweenCentresOfPixels) {
    const VkExtent2D extent{5, 4};
    std::vector<float> rgba;
    for (uint32_t y = 0; y < extent.height; ++y)
        for (uint32_t x = 0; x < extent.width; ++x) {
            const float grey = 1 + 2 * (float(x) + 0.5f) + 3 * (float(y) + 0.5f);
            rgba.insert(rgba.end(), {grey, grey, grey, 1});
        }
    for (const glm::dvec2 place : {glm::dvec2(0.5, 0.5), glm::dvec2(2.25, 1.75), glm::dvec2(4.2, 3.3)})
        EXPECT_NEAR(commands::luminance_at(rgba, extent, place), 1 + 2 * place.x + 3 * place.y, 1e-5);
    for (const glm::dvec2 place :
         {glm::dvec2(0.4, 2), glm::dvec2(4.6, 2), glm::dvec2(2, 0), glm::dvec2(2, 3.8), glm::dvec2(NAN, 1)})
        EXPECT_TRUE(std::isnan(commands::luminance_at(rgba, extent, place)));
    rgba[4 * (5 * 1 + 2)] = 1e6f;  // red counts by 0.212639
    EXPECT_NEAR(commands::luminance_at(rgba, extent, {2.5, 1.5}), 0.212639e6 + 0.787361 * 10.5, 1);
}

}  // namespace
}  // namespace vesper::test
