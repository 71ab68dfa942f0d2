// Shading on the device: against the reference, and clustered against every lamp. SPDX-License-Identifier: MIT
#include "base/error.h"
#include "support/lamps.h"
#include "support/noise.h"
#include "support/shading.h"

namespace vesper::test::shade_test {
namespace {

using gpu_scene::LampList;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// A street of noise: walls and road with every normal, depth, roughness and colour, some signs, some sky.
Surfaces street(VkExtent2D extent, uint32_t seed, float nearest = 0.5f, float farthest = 300) {
    Noise random(seed);
    Surfaces s{extent, {}, {}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        s.reflectance.emplace_back(random.fine(), random.fine(), random.fine(), i % 3 == 0 ? random.fine() : 0.0f);
        const glm::dvec3 n = random.facing(0.1);
        const bool sky = random.unit() < 0.1f;
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode(n)),
                               sky ? 0 : nearest * std::pow(farthest / nearest, random.unit()),
                               i % 4 == 0 ? 1.0f : 0.2f + 0.8f * random.unit());
        s.emission.emplace_back(
            i % 7 == 0 ? std::pow(10.0f, 12 * random.unit() - 4) * glm::vec3(1, 0.7f, 0.3f) : glm::vec3(0), 1);
    }
    return s;
}

TEST(Shade, MatchesTheReferenceAtEverySize) {
    PassRig rig;
    render::ShadeSettings settings;
    settings.ambient = {0.2f, 0.3f, 0.4f}, settings.sky = {0.01f, 0.02f, 0.03f};
    // 33 x 9: one past the CPU device's workgroup of 32 x 8 pixels in both directions.
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {33, 9}, {67, 65}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
        const Surfaces s = street(extent, extent.width);
        const LampList list = street_lamps({40, 24, 2}, 300, extent.height);
        expect_reference(shade(rig, s, list, {}, settings), s, list, settings);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Shade, MatchesTheReferenceWithDimAndWithManyLamps) {
    PassRig rig;
    const Surfaces s = street({64, 40}, 2);
    for (auto [count, candela] : {std::pair{1u, 1000.0f}, {64u, 0.3f}, {1000u, 0.3f}}) {
        SCOPED_TRACE(std::to_string(count) + " lamps of " + std::to_string(candela) + " cd");
        const LampList list = street_lamps(half_and_half(count), candela, count);
        expect_reference(shade(rig, s, list, {}, {}), s, list, {});
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Shade, ThePapersLambertAndTheLdrBaselinesLimit) {
    PassRig rig;
    const Surfaces s = street({31, 17}, 3);
    const LampList list = street_lamps({10, 5, 1}, 500, 3);
    const render::ShadeSettings settings{.lambert = 1, .emission_limit = 1};
    expect_reference(shade(rig, s, list, {}, settings), s, list, settings);
    EXPECT_EQ(rig.complaints(), "");
}

// Issue: within float rounding at 1, 64, 1,000 and 4,000 lamps. Lists are ascending, so that both add the same numbers
// in the same order, and a lamp that is not listed adds exact zeros: the results are the same bits.
TEST(Shade, ClusteredIsEveryLight) {
    PassRig rig;
    const Surfaces s = street({200, 130}, 4);
    for (auto [count, candela] : {std::pair{1u, 3000.0f}, {64u, 300.0f}, {64u, 1.0f}, {1000u, 3.0f}, {4000u, 0.1f}}) {
        SCOPED_TRACE(std::to_string(count) + " lamps of " + std::to_string(candela) + " cd");
        LampList list = street_lamps(half_and_half(count), candela, count);
        const Shot clustered = shade(rig, s, list, {.capacity = 4000}, {});
        const Shot all = shade(rig, s, list, {.capacity = 4000}, {.all_lamps = true});
        EXPECT_EQ(clustered.report.overflowed, 0u);
        EXPECT_TRUE(
            same_light("clustered", picture(s.extent, clustered.pixels), picture(s.extent, all.pixels), {0, 0}));
        if (count > 1) {
            EXPECT_LT(clustered.report.listed, count * clustered.cluster.grid.slices * 12) << "nothing was left out";
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

/// A street canyon: a road 1.2 m under the eye between walls at 8 m, sky above 20 m, in a whole frame.
Surfaces canyon(const gpu_scene::View& view) {
    Surfaces s{view.extent, {}, {}, {}};
    const glm::vec2 up = reference::octahedral_encode({0, 1, 0});
    const glm::vec2 left = reference::octahedral_encode({-1, 0, 0}), right = reference::octahedral_encode({1, 0, 0});
    for (uint32_t i = 0; i < view.extent.width * view.extent.height; ++i) {
        const glm::vec2 pixel(i % view.extent.width, i / view.extent.width);
        const glm::vec2 ray = view.ray_scale() * (pixel + 0.5f) + view.ray_offset();
        const float road = ray.y < 0 ? 1.2f / -ray.y : 1e6f, wall = 8 / std::max(std::abs(ray.x), 1e-6f);
        const float depth = std::min(road, wall);
        s.reflectance.emplace_back(0.25f, 0.375f, 0.5f, 0), s.emission.emplace_back(0);
        s.surface.emplace_back(road < wall ? up
                               : ray.x < 0 ? right
                                           : left,
                               depth * ray.y > 20 || depth > 1000 ? 0 : depth, road < wall ? 0.5f : 1.0f);
    }
    return s;
}

TEST(Shade, ClusteredIsEveryLightInAWholeFrame) {
    PassRig rig;
    const Surfaces s = canyon(gpu_scene::View::symmetric({1680, 1050}, 0.7f, glm::mat4(1)));
    const LampList list = street_lamps({50, 30, 1}, 300, 16);
    const Shot clustered = shade(rig, s, list, {.far = 400}, {.merge_error = 0}),
               all = shade(rig, s, list, {}, {.all_lamps = true});
    EXPECT_EQ(clustered.report.overflowed, 0u);
    EXPECT_TRUE(same_light("clustered", picture(s.extent, clustered.pixels), picture(s.extent, all.pixels), {0, 0}));
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Shade, OverflowedFroxelsLookAtEveryLight) {
    PassRig rig;
    const Surfaces s = street({140, 70}, 5);
    const LampList list = street_lamps({300, 300, 1}, 3, 5);
    const Shot all = shade(rig, s, list, {}, {.all_lamps = true});
    for (uint32_t capacity : {1u, 30u}) {
        const Shot tight = shade(rig, s, list, {.capacity = capacity}, {});
        EXPECT_GT(tight.report.overflowed, 0u) << "capacity " << capacity;
        EXPECT_TRUE(same_light("overflowed", picture(s.extent, tight.pixels), picture(s.extent, all.pixels), {0, 0}));
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Dim lamps: the lists of most froxels overflow, and yet hardly any lamp lamps a given pixel. Every pixel has a slice
// of its own. Lavapipe runs no more than 65,535 turns of all of an invocation's loops together, which must not cost a
// light.
TEST(Shade, ThousandsOfLampsInOverflowedFroxels) {
    PassRig rig;
    const Surfaces s = street({64, 24}, 15);
    for (uint32_t count : {4000u, 12000u}) {
        const LampList list = street_lamps(half_and_half(count), 0.05f, count);
        const Shot all = shade(rig, s, list, {}, {.all_lamps = true});
        for (uint32_t capacity : {1u, 256u}) {
            const Shot got = shade(rig, s, list, {.capacity = capacity}, {});
            EXPECT_TRUE(same_light("overflowed", picture(s.extent, got.pixels), picture(s.extent, all.pixels), {0, 0}))
                << count << ", capacity " << capacity;
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

// The most that add_clusters takes, all in every pixel, glossy pixels beside dull ones: none may be lost.
TEST(Shade, AsManyLampsAsThereMayBe) {
    PassRig rig;
    constexpr uint32_t kMost = 21000;
    Surfaces s = street({64, 8}, 17);
    for (size_t i = 0; i < s.surface.size(); ++i) {
        s.surface[i] = {0, 0, 10, i % 2 ? 0.5f : 1.0f};
        s.reflectance[i] = {0.5f, 0.5f, 0.5f, 0}, s.emission[i] = glm::vec4(0);
    }
    LampList one = street_lamps({1, 0, 0}, 1);
    one.lamps[0] = {{0, 0, 0}, 1000, {0, 0, -1}, 0, {1, 1, 1}, 1, {1, 0, 0}, -1};
    LampList most = one;
    most.lamps.assign(kMost, one.lamps[0]), most.counts.cones = kMost;
    const Shot single = shade(rig, s, one, {}, {});
    for (bool all_lamps : {false, true}) {
        const Shot got = shade(rig, s, most, {}, {.all_lamps = all_lamps});
        // 1e-3: the sum of 21,000 equal floats; a lost lamp in a thousand would show.
        for (size_t i = 0; i < s.surface.size(); ++i)
            ASSERT_NEAR(got.pixels[i].y / single.pixels[i].y / kMost, 1, 1e-3) << "pixel " << i;
    }
    most.lamps.push_back(one.lamps[0]), ++most.counts.cones;
    EXPECT_THROW(shade(rig, s, most, {}, {}), Error);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Shade, SlicesAndFarDoNotChangeTheResult) {
    PassRig rig;
    const Surfaces s = street({70, 66}, 6, 0.2f, 900);
    const LampList list = street_lamps(half_and_half(64), 20, 6);
    const Shot all = shade(rig, s, list, {}, {.all_lamps = true});
    for (uint32_t slices : {2u, 7u, 32u})
        for (float far : {0.0f, 900.0f}) {
            const Shot got = shade(rig, s, list, {.slices = slices, .far = far}, {});
            EXPECT_TRUE(same_light("slices", picture(s.extent, got.pixels), picture(s.extent, all.pixels), {0, 0}))
                << slices << " slices, far " << far;
        }
    EXPECT_EQ(rig.complaints(), "");
}

// Done when: a road surface lit by one lamp of known candela shows rho I cos / (pi d^2) within 0.5 %. Here 1e-5.
TEST(Shade, OneLampOverTheRoad) {
    PassRig rig;
    const VkExtent2D extent{64, 48};
    Surfaces s{extent, {}, {}, {}};
    const gpu_scene::View view = gpu_scene::View::symmetric(extent, 0.7f, glm::mat4(1));
    const glm::vec2 up = reference::octahedral_encode({0, 1, 0});
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const float slope = view.ray_scale().y * (float(i / extent.width) + 0.5f) + view.ray_offset().y;
        s.reflectance.emplace_back(0.25f, 0.25f, 0.25f, 0), s.emission.emplace_back(0);
        s.surface.emplace_back(up, slope < 0 ? 1.2f / -slope : 0, 1);  // a floor 1.2 m under the eye
    }
    LampList list = street_lamps({1, 0, 0}, 1);
    list.lamps[0] = {{1, 5.3f, -15}, 4000, {0, -1, 0}, 0, {1, 1, 1}, 1, {1, 0, 0}, -1};  // 6.5 m over the road
    const Shot shot = shade(rig, s, list, {}, {});
    for (uint32_t y = extent.height / 2; y < extent.height; ++y)
        for (uint32_t x = 0; x < extent.width; ++x) {
            const glm::dvec3 point =
                reference::view_position(shot.cluster.grid, {x + 0.5, y + 0.5}, s.surface[y * extent.width + x].z);
            const double d2 = glm::dot(glm::dvec3(1, 5.3, -15) - point, glm::dvec3(1, 5.3, -15) - point);
            const double want =
                4000 / d2 < 0.001 ? 0 : 0.25 * 4000 * (5.3 - point.y) / std::sqrt(d2) / (3.14159265358979 * d2);
            EXPECT_NEAR(shot.pixels[y * extent.width + x].y, want, 1e-5 * want) << x << ", " << y;
        }
    EXPECT_EQ(rig.complaints(), "");
}

// The oncoming headlamps' reflections: light and view direction are nearly opposite, so that l + v all but cancels.
TEST(Shade, HeadlampsDownAWetRoad) {
    PassRig rig;
    const VkExtent2D extent{48, 64};
    const gpu_scene::View view = gpu_scene::View::symmetric(extent, 0.1f, glm::mat4(1));
    Surfaces s{extent, {}, {}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const float slope = view.ray_scale().y * (float(i / extent.width) + 0.5f) + view.ray_offset().y;
        s.reflectance.emplace_back(0.25f, 0.25f, 0.25f, 0), s.emission.emplace_back(0);
        s.surface.emplace_back(reference::octahedral_encode({0, 1, 0}), slope < 0 ? 1.2f / -slope : 0,
                               i % 2 ? 0.3f : 0.5f);
    }
    LampList list = street_lamps({2, 0, 0}, 1);
    for (uint32_t i = 0; i < 2; ++i)
        list.lamps[i] = {{1.4f * float(i) - 2, -0.55f, -250}, 30000, {0, 0, 1}, 0, {1, 1, 1}, 1, {1, 0, 0}, -1};
    expect_reference(shade(rig, s, list, {}, {}), s, list, {});
    EXPECT_EQ(rig.complaints(), "");
}

// 1e-4 to 1e8 cd/m^2 in one frame with under 1 % error: emission passes through, and so does what one lamp gives.
TEST(Shade, KeepsTwelveDecades) {
    PassRig rig;
    Surfaces s = street({13, 1}, 7);
    for (int i = 0; i < 13; ++i) {
        s.surface[size_t(i)] = {0, 0, 5, 1};
        s.emission[size_t(i)] = glm::vec4(glm::vec3(std::pow(10.0f, float(i) - 4)), 1);
    }
    const Shot shot = shade(rig, s, {}, {}, {});
    for (int i = 0; i < 13; ++i) EXPECT_NEAR(shot.pixels[size_t(i)].y / std::pow(10.0, i - 4), 1, 1e-6);
    // A wall 0.5 m in front of a lamp of 1e5 cd up to 1 km away from it.
    Surfaces walls = street({5, 1}, 8);
    LampList list = street_lamps({1, 0, 0}, 1);
    list.lamps[0] = {{0, 0, 0}, 1e5f, {0, 0, -1}, 0, {1, 1, 1}, 1, {1, 0, 0}, -1};
    for (int i = 0; i < 5; ++i) {
        walls.surface[size_t(i)] = {0, 0, 0.5 * std::pow(10.0, i), 1};
        walls.reflectance[size_t(i)] = {0.5f, 0.5f, 0.5f, 0}, walls.emission[size_t(i)] = glm::vec4(0);
    }
    const Shot lit = shade(rig, walls, list, {}, {});
    expect_reference(lit, walls, list, {});
    EXPECT_GT(lit.pixels[2].y / lit.pixels[4].y, 0.9e4f);
    EXPECT_GT(lit.pixels[2].y, 1);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Shade, WhatIsNotFiniteStaysInItsPixel) {
    PassRig rig;
    const Surfaces clean = street({80, 40}, 9, 3, 30);
    Surfaces s = clean;
    const LampList list = street_lamps({8, 8, 1}, 300, 9);
    const auto poisoned = [](size_t i) { return i % 7 == 5; };
    for (size_t i = 0; i < s.emission.size(); ++i) {
        if (!poisoned(i)) continue;
        if (i % 4 == 0) s.emission[i] = {kNan, kInf, 1, 1};
        if (i % 4 == 1) s.surface[i] = {kNan, kNan, kInf, kNan};
        if (i % 4 == 2) s.surface[i] = {kNan, kNan, s.surface[i].z, 0.5f};  // a normal of no length
        if (i % 4 == 3) s.reflectance[i] = {kInf, kNan, 1, kNan};
    }
    const render::ClusterSettings all{.threshold =
                                          1e-9f};  // blocks with a pixel that is no number are shaded lamp by lamp
    const Shot got = shade(rig, s, list, all, {}), want = shade(rig, clean, list, all, {});
    for (size_t i = 0; i < got.pixels.size(); ++i)
        if (!poisoned(i)) {
            EXPECT_EQ(got.pixels[i], want.pixels[i]) << "pixel " << i;
        }
    EXPECT_EQ(rig.complaints(), "");
}

// A block's lamps are chosen by a box around its normals, which a normal that is no number must not undo.
TEST(Shade, ANormalOfNoLengthCostsItsNeighboursNoLight) {
    PassRig rig;
    Surfaces s = street({8, 8}, 10);
    LampList list = street_lamps({1, 0, 0}, 1);
    list.lamps[0] = {{-20, 0, -5}, 1e4f, {1, 0, 0}, 0, {1, 1, 1}, 1, {1, 0, 0}, -1};
    for (uint32_t broken : {0u, 31u, 32u, 63u}) {
        for (uint32_t i = 0; i < 64; ++i) {
            const float side = i < 32 ? -1 : 1;  // half of the surfaces face the lamp
            s.surface[i] =
                glm::vec4(glm::vec2(reference::octahedral_encode(glm::normalize(glm::dvec3(side, 0, 0.1)))), 5, 1);
            if (i == broken) s.surface[i].x = s.surface[i].y = kNan;
        }
        const Shot got = shade(rig, s, list, {}, {}), all = shade(rig, s, list, {}, {.all_lamps = true});
        for (uint32_t i = 0; i < 64; ++i) {
            if (i != broken) {
                EXPECT_EQ(got.pixels[i], all.pixels[i]) << "pixel " << i << " beside " << broken;
            }
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::shade_test
