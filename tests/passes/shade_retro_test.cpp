// Shading of retroreflective surfaces, against the reference. SPDX-License-Identifier: MIT
#include "scene/scene.h"
#include "support/lamps.h"
#include "support/noise.h"
#include "support/shading.h"

namespace vesper::test::shade_retro_test {
namespace {

const std::vector<photometry::Retroreflector> kClasses{photometry::retroreflective_class("RA1"),
                                                       photometry::retroreflective_class("RA2"),
                                                       photometry::retroreflective_class("prismatic"),
                                                       photometry::retroreflective_marking(150),
                                                       {"eight nodes",
                                                        {0.1, 0.2, 0.33, 0.5, 1, 2, 4, 8},
                                                        {300, 250, 180, 90, 40, 5, 2, 0.5},
                                                        {0, 10, 20, 30, 40, 50, 60, 70},
                                                        {1, 0.9, 0.85, 0.6, 0.4, 0.2, 0.1, 0.02},
                                                        false}};

/// Signs facing the eye more or less, markings, beside matt and glossy surfaces, roads with a table and sky.
Surfaces signs(VkExtent2D extent, uint32_t seed, bool roads) {
    Noise random(seed);
    Surfaces p{extent, {}, {}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const float kinds[]{2, 3, 4, 5, 6, 0, random.fine(), roads ? -1.0f : 0.0f};
        const float kind = kinds[(i / 3 + i) % 8];
        p.reflectance.emplace_back(random.fine(), random.fine(), random.fine(), kind);
        const glm::dvec3 n =
            glm::normalize(glm::dvec3(0.5 * random.normal(), 0.5 * random.normal(), std::abs(random.normal()) + 0.3));
        p.surface.emplace_back(glm::vec2(reference::octahedral_encode(n)),
                               random.unit() < 0.1f ? 0 : 2 * std::pow(100.0f, random.unit()),
                               kind < 0 ? -0.6f
                               : i % 2  ? 1.0f
                                        : 0.2f + 0.8f * random.unit());
        p.emission.emplace_back(0);
    }
    return p;
}

/// Headlamps beside the eye, and lamps along the street.
gpu_scene::LampList headlamps(LampMix others, uint32_t seed) {
    gpu_scene::LampList list = street_lamps(others, 300, seed);
    for (float x : {-0.7f, 0.7f}) {
        shared::Lamp lamp{};
        lamp.position = {x, -0.55f, -1.5f}, lamp.intensity = 20000, lamp.axis = {0, 0, -1}, lamp.colour = {1, 1, 1},
        lamp.lobe_b = 1;
        list.lamps.insert(list.lamps.begin(), lamp);
        ++list.counts.cones;
    }
    return list;
}

// 2e-3 on roads for the device's angles, which are polynomials.
void expect_reference(PassRig& rig, const gpu_scene::LampList& list, const Surfaces& s, bool roads,
                      const render::ShadeSettings& settings) {
    scene::Scene scene;
    std::vector<reference::RoadSurface> tables;
    if (roads)
        scene.reflection_tables = {photometry::find_reflection_table("R3")},
        tables.emplace_back(photometry::extended(scene.reflection_tables[0]));
    const Shot shot = shade(rig, s, list, {}, settings, gpu_scene::intensity_tables(scene), kClasses);
    expect_reference(shot, s, list, settings, {{}, tables, kClasses}, {2e-5, 1e-7}, 2e-3);
}

TEST(ShadeRetro, MatchesTheReferenceAtEverySize) {
    PassRig rig;
    render::ShadeSettings settings;
    settings.ambient = {0.2f, 0.3f, 0.4f}, settings.sky = {0.01f, 0.02f, 0.03f};
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {33, 9}, {67, 65}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
        expect_reference(rig, headlamps({10, 6, 1}, extent.width), signs(extent, extent.height, false), false,
                         settings);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(ShadeRetro, MatchesTheReferenceBesideRoads) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{40, 24}, {65, 17}})
        expect_reference(rig, headlamps({8, 0, 0}, 3), signs(extent, 4, true), true, {.lambert = 1});
    EXPECT_EQ(rig.complaints(), "");
}

// A white sign of class RA2 at 100 m, 500 cd towards it from each of two headlamps, half a degree from the eye at the
// sign: about 12 cd/m^2 (and half a thousandth of that from its diffuse reflection).
TEST(ShadeRetro, ASignInTheHeadlamps) {
    PassRig rig;
    const VkExtent2D extent{9, 9};
    Surfaces s = signs(extent, 1, false);
    for (size_t i = 0; i < s.surface.size(); ++i) s.surface[i] = {0, 0, 100, 1}, s.reflectance[i] = {1, 1, 1, 3};
    gpu_scene::LampList list;
    for (float side : {-1.0f, 1.0f}) {
        shared::Lamp lamp{};
        const float off = 100 * std::tan(glm::radians(0.5f)) / std::sqrt(2.0f);
        lamp.position = {side * off, -off, 0}, lamp.intensity = 500, lamp.axis = {0, 0, -1}, lamp.colour = {1, 1, 1},
        lamp.lobe_b = 1;
        list.lamps.push_back(lamp);
    }
    list.counts.cones = 2;
    const auto luminance = [&](const std::vector<photometry::Retroreflector>& classes) {
        return shade(rig, s, list, {}, {}, {}, classes).pixels[4 * 9 + 4].g;
    };
    EXPECT_NEAR(luminance(kClasses), 12.5, 0.2);
    EXPECT_NEAR(luminance({}), 0.1 / 3.14159, 1e-3) << "without classes a sign is a matt surface";
    EXPECT_EQ(rig.complaints(), "");
}

// Pixels beside signs shade as they do without, to rounding, whatever loop their neighbours take.
TEST(ShadeRetro, NeighboursAreUntouched) {
    PassRig rig;
    const VkExtent2D extent{70, 20};
    const Surfaces s = signs(extent, 7, false);
    const gpu_scene::LampList list = headlamps({20, 10, 1}, 5);
    const auto with = shade(rig, s, list, {}, {}, {}, kClasses).pixels, without = shade(rig, s, list, {}, {}).pixels;
    size_t brighter = 0;
    for (size_t i = 0; i < with.size(); ++i) {
        if (s.reflectance[i].w < 2) {
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(with[i][k], without[i][k], 2e-6f * without[i][k]) << "pixel " << i;
        } else {
            brighter += with[i].g > without[i].g;
        }
    }
    EXPECT_GT(brighter, with.size() / 4);
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::shade_retro_test
