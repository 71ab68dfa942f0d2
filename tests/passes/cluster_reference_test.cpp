// The froxel grid and the laws of lamps, in double. SPDX-License-Identifier: MIT
#include "passes/cluster_reference.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace vesper::reference::cluster_reference_test {
namespace {

constexpr shared::uvec2 kSize{150, 97};  // 3 x 2 tiles, the last ones cut

/// Slice 0 from the eye to `near`, the others of equal ratio to `far`.
shared::ClusterPush grid_of(float near, float far, uint32_t slices, shared::uvec2 size = kSize) {
    shared::ClusterPush p{};
    p.grid.tiles_x = (size.x + shared::kTileSize - 1) / shared::kTileSize;
    p.grid.tiles_y = (size.y + shared::kTileSize - 1) / shared::kTileSize;
    p.grid.slices = slices;
    p.grid.capacity = 64;
    p.grid.slice_scale = float((slices - 1) / std::log2(double(far) / near));
    p.grid.slice_bias = float(1 - std::log2(double(near)) * p.grid.slice_scale);
    const float tangent = 0.7f, aspect = float(size.x) / float(size.y);
    p.grid.ray_scale = {2 * tangent * aspect / float(size.x), -2 * tangent / float(size.y)};
    p.grid.ray_offset = {-tangent * aspect, tangent};
    p.far = far, p.threshold = 0.001f;
    return p;
}

shared::Lamp point_lamp(glm::vec3 position, float candela) {
    return {position, candela, {0, -1, 0}, 0.0f, {1, 1, 1}, 1.0f, {1, 0, 0}, -1.0f};
}

TEST(ClusterReference, SlicesAreOfEqualRatioFromNearToFar) {
    const shared::ClusterPush p = grid_of(1, 1000, 31);
    EXPECT_EQ(slice_depth(p.grid, 0), 0);
    EXPECT_NEAR(slice_depth(p.grid, 1), 1, 1e-6);
    EXPECT_NEAR(slice_depth(p.grid, 11), 10, 1e-4);  // three decades in thirty slices: a decade in ten
    EXPECT_NEAR(slice_depth(p.grid, 31), 1000, 1e-2);
    EXPECT_EQ(slice_of(p.grid, 0.5), 0u);
    for (uint32_t s = 1; s < 31; ++s) {
        const double from = slice_depth(p.grid, s), to = slice_depth(p.grid, s + 1);
        EXPECT_NEAR(to / from, std::pow(10, 0.1), 1e-6);
        EXPECT_EQ(slice_of(p.grid, std::sqrt(from * to)), s);
    }
    EXPECT_EQ(slice_of(p.grid, 0.01), 0u) << "the first slice reaches to the eye";
    EXPECT_EQ(slice_of(p.grid, 1e7), 30u) << "pixels beyond the end are looked up in the last slice";
}

TEST(ClusterReference, TilesCountWholePixels) {
    EXPECT_EQ(tile_of(0), 0u);
    EXPECT_EQ(tile_of(63), 0u);
    EXPECT_EQ(tile_of(64), 1u);
}

TEST(ClusterReference, EveryPixelAndDepthLiesInItsFroxel) {
    const shared::ClusterPush p = grid_of(0.5f, 80, 7);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const uint32_t x = uint32_t(uniform(random) * kSize.x), y = uint32_t(uniform(random) * kSize.y);
        const double z = 79.9 * uniform(random) + 0.01;
        const Froxel f = froxel(p, kSize, tile_of(x), tile_of(y), slice_of(p.grid, z));
        EXPECT_LE(f.pixel_low.x, x + 0.5);
        EXPECT_GE(f.pixel_high.x, x + 0.5);
        EXPECT_LE(f.pixel_low.y, y + 0.5);
        EXPECT_GE(f.pixel_high.y, y + 0.5);
        EXPECT_LE(f.near, z * (1 + 1e-5));  // slice_scale is a float
        EXPECT_GE(f.far, z * (1 - 1e-5));
    }
}

TEST(ClusterReference, CornersSpanTheFroxel) {
    const shared::ClusterPush p = grid_of(1, 64, 7);
    const Froxel f = froxel(p, kSize, 1, 0, 4);
    EXPECT_NEAR(f.near, 8, 1e-5);
    EXPECT_NEAR(f.far, 16, 1e-5);
    const auto corners = f.corners(p.grid);
    for (int i = 0; i < 8; ++i) EXPECT_NEAR(-corners[size_t(i)].z, i < 4 ? f.near : f.far, 1e-12);
    EXPECT_LT(corners[0].x, corners[1].x);
    EXPECT_GT(corners[0].y, corners[2].y) << "pixels count down, the view frame up";
    EXPECT_NEAR(corners[4].x / corners[0].x, f.far / f.near, 1e-9);
}

TEST(ClusterReference, IlluminanceIsIntensityOverDistanceSquared) {
    const auto lamp = point_lamp({0, 0, 0}, 1000);
    EXPECT_DOUBLE_EQ(facing_illuminance(lamp, LampKind::Cone, {0, 0, -10}), 10);
    EXPECT_DOUBLE_EQ(facing_illuminance(lamp, LampKind::Cone, {0, 20, 0}), 2.5);
}

// KHR_lights_punctual: a = 1 / (cos inner - cos outer), b = -cos outer a; the ramp is squared.
TEST(ClusterReference, ConeFallsFromFullToNothing) {
    const double inner = std::cos(0.3), outer = std::cos(0.6);
    shared::Lamp spot = point_lamp({0, 0, 0}, 100);
    spot.lobe_a = float(1 / (inner - outer)), spot.lobe_b = float(-outer / (inner - outer));
    EXPECT_NEAR(intensity(spot, LampKind::Cone, 1), 100, 1e-9);
    EXPECT_NEAR(intensity(spot, LampKind::Cone, inner), 100, 1e-3);
    EXPECT_NEAR(intensity(spot, LampKind::Cone, outer), 0, 1e-6);
    EXPECT_NEAR(intensity(spot, LampKind::Cone, (inner + outer) / 2), 25, 1e-3);
    EXPECT_EQ(intensity(spot, LampKind::Cone, -1), 0);
}

// A lobe I cos^n emits 2 pi I / (n + 1) lumens: 2 pi I for n = 0, pi I for Lambert's n = 1.
TEST(ClusterReference, CosinePowerEmitsItsFlux) {
    for (float exponent : {0.0f, 1.0f, 3.0f, 40.0f}) {
        shared::Lamp lobe = point_lamp({0, 0, 0}, 10);
        lobe.lobe_a = exponent;
        double flux = 0;
        const int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const double angle = (i + 0.5) * std::numbers::pi / steps;
            flux += intensity(lobe, LampKind::Power, std::cos(angle)) * 2 * std::numbers::pi * std::sin(angle) *
                    std::numbers::pi / steps;
        }
        EXPECT_NEAR(flux, 2 * std::numbers::pi * 10 / (exponent + 1), 1e-4 * flux) << "exponent " << exponent;
    }
}

// glare-photometry, B1: a headlamp of 30 kcd is above 0.001 lx to 5.5 km.
TEST(ClusterReference, ReachEndsWhereTheThresholdIs) {
    const auto headlamp = point_lamp({0, 0, 0}, 30000);
    const double d = light_radius(headlamp, LampKind::Cone, 0.001);
    EXPECT_NEAR(d, 5477.2, 0.1);
    EXPECT_NEAR(facing_illuminance(headlamp, LampKind::Cone, {d, 0, 0}), 0.001, 1e-12);
}

TEST(ClusterReference, BrightestOfAPointLampIsAtTheNearestPoint) {
    const shared::ClusterPush p = grid_of(1, 64, 7);
    const Froxel f = froxel(p, kSize, 1, 0, 4);
    // In front of the near face, over its middle: the nearest point is the lamp's foot on that face.
    const dvec3 foot = f.at(p.grid, {0.4, 0.6, 0});
    const auto lamp = point_lamp(glm::vec3(foot + dvec3(0, 0, 2)), 8);
    EXPECT_NEAR(brightest(p.grid, f, lamp, LampKind::Cone), 2, 1e-5);
}

TEST(ClusterReference, BrightestIsNoLessThanDenseSampling) {
    const shared::ClusterPush p = grid_of(1, 64, 7);
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int k = 0; k < 12; ++k) {
        shared::Lamp spot = point_lamp({30 * uniform(random), 30 * uniform(random), -30 + 30 * uniform(random)}, 500);
        spot.axis = glm::normalize(glm::vec3(uniform(random), uniform(random), uniform(random)));
        spot.lobe_a = 3, spot.lobe_b = -1.8f;
        const Froxel f = froxel(p, kSize, uint32_t(k) % 3, uint32_t(k) % 2, uint32_t(k) % 7);
        double dense = 0;
        for (int i = 0; i < 30 * 30 * 30; ++i) {
            const dvec3 t = dvec3(i % 30, i / 30 % 30, i / 900) / 29.0;
            dense = std::max(dense, facing_illuminance(spot, LampKind::Cone, f.at(p.grid, t)));
        }
        EXPECT_GE(brightest(p.grid, f, spot, LampKind::Cone, 9), dense * 0.999) << k;
    }
}

TEST(ClusterReference, BrightestFindsANarrowBeam) {
    const shared::ClusterPush p = grid_of(1, 64, 7);
    const Froxel f = froxel(p, kSize, 1, 1, 5);
    const dvec3 target = f.at(p.grid, {0.37, 0.81, 0.43});
    EXPECT_NEAR(glm::length(f.nearest(p.grid, target) - dvec3(0.37, 0.81, 0.43)), 0, 1e-9);
    shared::Lamp beam = point_lamp({12, 9, -3}, 1e4f);
    beam.axis = glm::normalize(glm::vec3(target) - beam.position);
    beam.lobe_a = 1e5f;  // half of the intensity 0.2 degrees off the axis
    const double d = glm::length(target - dvec3(beam.position));
    EXPECT_GT(brightest(p.grid, f, beam, LampKind::Power), 0.9e4 / (d * d));
}

// What clustering is for: wherever a lamp counts, it is listed; and a higher threshold lists no more.
TEST(ClusterReference, ListsHoldEveryLampThatLightsAPointThere) {
    shared::ClusterPush p = grid_of(1, 100, 5);
    p.lamps = {6, 2, 0, 0};
    std::mt19937 random(3);
    std::uniform_real_distribution<float> uniform(-1, 1);
    std::vector<shared::Lamp> lamps;
    for (int i = 0; i < 8; ++i) {
        lamps.push_back(point_lamp({20 * uniform(random), 5 * uniform(random), -40 + 39 * uniform(random)}, 0.05f));
        if (i >= 6) lamps.back().lobe_a = 4;
        lamps.back().axis = glm::normalize(glm::vec3(uniform(random), -1, uniform(random)));
    }
    const auto lists = lit_froxels(p, kSize, lamps);
    p.threshold *= 5;
    const auto shorter = lit_froxels(p, kSize, lamps);
    p.threshold /= 5;
    size_t all = 0;
    for (size_t i = 0; i < lists.size(); ++i) {
        all += lists[i].size();
        EXPECT_TRUE(std::includes(lists[i].begin(), lists[i].end(), shorter[i].begin(), shorter[i].end()));
    }
    EXPECT_GT(all, 8u);
    EXPECT_LT(all, 8 * lists.size()) << "some lamp is dark somewhere";

    std::uniform_real_distribution<double> unit(0, 1);
    for (int k = 0; k < 20000; ++k) {
        const uint32_t x = uint32_t(unit(random) * kSize.x), y = uint32_t(unit(random) * kSize.y);
        const double z = std::pow(100, unit(random));
        const dvec3 point = view_position(p.grid, dvec2(x, y) + 0.5, z);
        const auto& list = lists[froxel_index(p.grid, tile_of(x), tile_of(y), slice_of(p.grid, z))];
        for (uint32_t i = 0; i < lamps.size(); ++i)
            if (facing_illuminance(lamps[i], kind_of(i, p.lamps), point) >= p.threshold * 1.0001) {
                EXPECT_TRUE(std::binary_search(list.begin(), list.end(), i)) << "lamp " << i << " depth " << z;
            }
    }
}

}  // namespace
}  // namespace vesper::reference::cluster_reference_test
