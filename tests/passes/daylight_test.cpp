// The daylight pass on the device, against the reference. SPDX-License-Identifier: MIT
#include "passes/daylight_reference.h"

#include <glm/gtc/matrix_transform.hpp>

#include "render/passes/daylight.h"
#include "support/noise.h"
#include "support/shading.h"

namespace vesper::test::daylight_test {
namespace {

using glm::dvec3;
const std::vector<scene::Tunnel> kTunnels{{{0, 0, -3}, {1, 1, -43}, 14, 5}, {{20, -1, -10}, {60, -1, -20}, 8, 4}};
const glm::vec3 kLight(900, 1000, 1300);

/// Surfaces, and what lamps gave them.
struct Lit : Surfaces {
    std::vector<glm::vec4> scene;
};

/// Noise: surfaces near and far in and around the tunnels, roads, sky.
Lit noise(VkExtent2D extent, uint32_t seed) {
    Noise random(seed);
    Lit s{{extent, {}, {}, {}}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        s.reflectance.emplace_back(random.fine(), random.fine(), random.fine(), i % 5 == 2 ? -1.0f : 0.0f);
        const glm::dvec3 n = random.facing(0.3);
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode(n)), i % 7 == 1 ? 0.0f : 1 + 60 * random.unit(),
                               i % 5 == 2   ? -1.5f * random.unit()
                               : i % 3 == 0 ? 1.0f
                                            : random.unit());
        s.scene.emplace_back(random.unit(), random.unit(), random.unit(), 1);
    }
    return s;
}

gpu_scene::View looking(VkExtent2D extent) {
    return gpu_scene::View::symmetric(extent, 0.9f,
                                      glm::rotate(glm::translate(glm::mat4(1), {0.4f, -1.3f, 0}), 0.15f, {0, 1, 0}));
}

std::vector<glm::vec4> add(PassRig& rig, const Lit& s, const std::vector<scene::Tunnel>& tunnels,
                           const gpu_scene::View& view) {
    graph::FrameGraph graph;
    const render::GBuffer g = upload(graph, s);
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, s.extent, s.scene);
    const graph::Resource wanted =
        keep<glm::vec4>(graph, render::add_daylight(rig.frame(graph, view), g, scene, {tunnels, kLight, 0.318309886f}));
    rig.run(graph);
    return rig.got<glm::vec4>(wanted);
}

// 2e-5: arcs and cross products of up to ten edges in float, of which differences remain: 3e-6 of all the light
// besides. Where the shader's rounding of a place (some 1e-6 of its distance) would put it inside or outside, either is
// right.
TEST(Daylight, MatchesTheReferenceAtEverySize) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {33, 9}, {97, 61}}) {
        const gpu_scene::View view = looking(extent);
        const Lit s = noise(extent, extent.width);
        for (const size_t count : {size_t(1), size_t(2)}) {
            const std::vector<scene::Tunnel> tunnels(kTunnels.begin(), kTunnels.begin() + std::ptrdiff_t(count));
            const auto got = add(rig, s, tunnels, view);
            expect_light("daylight", extent, got, {2e-5, 1e-6}, [&](size_t i) {
                const glm::dvec2 centre = glm::dvec2(s.pixel(i)) + 0.5;
                const auto at = [&](dvec3 moved) {
                    return reference::add_daylight(tunnels, s.texel(i), dvec3(s.scene[i]), centre, view, dvec3(kLight),
                                                   0.318309886, moved);
                };
                const dvec3 here = at(dvec3(0));
                dvec3 rounding = 3e-6 * dvec3(kLight);
                for (int axis = 0; axis < 3; ++axis)
                    for (const double way : {-1e-4, 1e-4}) {
                        dvec3 moved(0);
                        moved[axis] = way;
                        rounding = glm::max(rounding, 0.1 * glm::abs(at(moved) - here));
                        if (glm::length(at(moved) - here) > 0.02 * glm::length(here))
                            rounding = glm::max(rounding, glm::abs(at(moved) - here));
                    }
                return reference::Shaded{here, rounding};
            });
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Daylight, WhatIsNotFiniteStaysInItsPixel) {
    PassRig rig;
    const VkExtent2D extent{40, 16};
    const Lit clean = noise(extent, 4);
    Lit s = clean;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (size_t i = 3; i < s.scene.size(); i += 7)
        s.surface[i] = {kNan, kNan, i % 2 ? kNan : 5, kNan}, s.scene[i].g = std::numeric_limits<float>::infinity();
    const auto got = add(rig, s, kTunnels, looking(extent)), want = add(rig, clean, kTunnels, looking(extent));
    expect_others_equal(got, want);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Daylight, WithoutTunnelsThereIsNoPass) {
    expect_no_pass([](const render::FrameContext& frame, graph::Resource scene) {
        return render::add_daylight(frame, {}, scene, {{}, kLight, 1});
    });
}

}  // namespace
}  // namespace vesper::test::daylight_test
