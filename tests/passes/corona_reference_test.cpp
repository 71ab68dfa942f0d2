// The reference of needles and halo: which lamps are lamps, and that what they add has a mean of nothing.
// SPDX-License-Identifier: MIT
#include "passes/corona_reference.h"

#include <limits>

#include <gtest/gtest.h>

#include "eye/corona.h"

namespace vesper::test::corona_reference_test {
namespace {

using glm::dvec2, glm::dvec3;

gpu_scene::View view_of(VkExtent2D extent) { return gpu_scene::View::symmetric(extent, 0.4f, glm::mat4(1)); }

TEST(CoronaReference, ALampIsTheLightOfItsSquare) {
    const gpu_scene::View view = view_of({64, 48});
    std::vector<dvec3> scene(64 * 48, dvec3(0));
    scene[20 * 64 + 21] = {3000, 1000, 500};
    scene[20 * 64 + 25] = {3000, 1000, 500};
    scene[5 * 64 + 50] = {100, 100, 100};
    scene[6 * 64 + 50] = dvec3(std::numeric_limits<double>::quiet_NaN());
    const auto lamps = reference::corona_lights(view, scene);
    ASSERT_EQ(lamps.size(), 2u);
    EXPECT_LT(glm::length(lamps[0].direction - reference::corona_ray(view, {23.5, 20.5})), 1e-12)
        << "in the middle of both pixels";
    const double pixel = reference::corona_pixel(view, lamps[0].direction);
    EXPECT_NEAR(lamps[0].illuminance.r, 6000 * pixel, 1e-12);
    EXPECT_NEAR(lamps[0].width, std::sqrt(pixel * (1 + 12 * 4 / 2.0)), 1e-12) << "4 px^2 along x, 0 along y";
    EXPECT_NEAR(lamps[1].width, std::sqrt(reference::corona_pixel(view, lamps[1].direction)), 1e-12);
}

TEST(CoronaReference, WhatLeavesTheListHasNothingLeft) {
    const gpu_scene::View view = view_of({16 * 40, 16});
    std::vector<dvec3> scene(16 * 40 * 16, dvec3(0));
    for (size_t i = 0; i < 40; ++i) scene[8 * 640 + 16 * i + 3] = dvec3(100.0 + double(i));
    const auto lamps = reference::corona_lights(view, scene);
    ASSERT_EQ(lamps.size(), 32u);
    for (size_t i = 0; i < 32; ++i) {
        const double pixel = reference::corona_pixel(view, lamps[i].direction);
        EXPECT_NEAR(lamps[i].illuminance.g, (139.0 - double(i) - 107) * pixel, 1e-10) << i;
    }
}

// Summed over a ring about the lamp, and over the whole reach: as much light as before.
TEST(CoronaReference, AddsNoLight) {
    eye::CoronaCache cache;
    for (const auto model : {eye::ScatterSettings::Model::Temporal, eye::ScatterSettings::Model::Spencer}) {
        const eye::ScatterSettings settings{.model = model, .state = vision::SpencerState::Scotopic};
        const auto texels = cache.at(settings, 1, 0.5).texels;
        const vision::EyeScatter smooth = eye::eye_scatter(settings);
        const reference::CoronaLight lamp{glm::normalize(dvec3(0.3, -0.2, -1)), dvec3(1), 1e-4};
        const dvec3 right = glm::normalize(glm::cross(lamp.direction, dvec3(0, 1, 0))),
                    up = glm::cross(right, lamp.direction);
        dvec3 all(0);
        constexpr int kRings = 448, kParts = 1536;
        for (int ring = 0; ring < kRings; ++ring) {
            const double theta = vision::GlarePattern::angle(ring + 0.5) * std::numbers::pi / 180;
            dvec3 sum(0);
            for (int i = 0; i < kParts; ++i) {
                const double turn = 2 * std::numbers::pi * i / kParts;
                const dvec3 ray =
                    std::cos(theta) * lamp.direction + std::sin(theta) * (std::cos(turn) * right + std::sin(turn) * up);
                sum += reference::corona_added(texels, lamp, ray, 1e-4);
            }
            sum /= double(kParts);
            // 1e-4 of the veil: sums of single precision.
            if (model == eye::ScatterSettings::Model::Temporal) {
                EXPECT_NEAR((0.212639 * sum.r + 0.715169 * sum.g + 0.072192 * sum.b) /
                                smooth(vision::GlarePattern::angle(ring + 0.5)),
                            0, 1e-4)
                    << ring;
            }
            const double step = 2 * std::numbers::pi / 512;
            all += sum * 2.0 * std::numbers::pi * theta * std::sin(theta) * step;
        }
        // Of 1 lx: part of all light.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(all[c], 0, 2e-4) << c;
    }
}

}  // namespace
}  // namespace vesper::test::corona_reference_test
