// The sky pass on the device, against the reference. SPDX-License-Identifier: MIT
#include "passes/sky_reference.h"

#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "gpu_scene/sky.h"
#include "render/passes/sky.h"
#include "support/noise.h"
#include "support/shading.h"

namespace vesper::test::sky_test {
namespace {

using gpu_scene::View;

/// A night sky: dim, brighter towards the horizon, with a town's lamps in it.
photometry::Environment night(uint32_t height, uint32_t seed) {
    photometry::Environment e{2 * height, height, std::vector<float>(size_t(height) * height * 6), 0.8};
    std::mt19937 random(seed);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < e.width; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                e.rgb[3 * (size_t(y) * e.width + x) + c] = 0.02f + 0.05f * float(y) / float(height) + 0.01f * float(c);
    for (int i = 0; i < 20; ++i) e.rgb[random() % e.rgb.size()] = 500;
    return e;
}

/// Surfaces, and what lamps gave them.
struct Lit : Surfaces {
    std::vector<glm::vec4> scene;
};

/// Noise: metals, dielectrics, mirrors, coded materials, matt surfaces, a quarter of sky.
Lit noise(VkExtent2D extent, uint32_t seed) {
    Noise random(seed);
    Lit s{{extent, {}, {}, {}}, {}};
    for (uint32_t i = 0; i < extent.width * extent.height; ++i) {
        const float codes[]{0, 0, random.fine(), 1, 2, 5, -1, -2};
        s.reflectance.emplace_back(random.fine(), random.fine(), random.fine(), codes[i % 8]);
        const glm::dvec3 n = random.facing(0.3);
        s.surface.emplace_back(glm::vec2(reference::octahedral_encode(n)), i % 4 == 1 ? 0.0f : 1 + 50 * random.unit(),
                               codes[i % 8] < 0 ? -1.5f * random.unit()
                               : i % 3 == 0     ? 1.0f
                                                : random.unit());
        s.scene.emplace_back(random.unit(), random.unit(), random.unit(), 1);
    }
    return s;
}

std::vector<glm::vec4> add(PassRig& rig, const Lit& s, const photometry::SkyMap& sky, const View& view, float lambert) {
    graph::FrameGraph graph;
    const render::GBuffer g = upload(graph, s);
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, s.extent, s.scene);
    const graph::Resource texels = graph.upload("sky", gpu_scene::sky_texels(sky), VK_FORMAT_R32G32B32A32_SFLOAT);
    const graph::Resource wanted =
        keep<glm::vec4>(graph, render::add_sky(rig.frame(graph, view), g, scene, {texels, sky.sharp.side, lambert}));
    rig.run(graph);
    return rig.got<glm::vec4>(wanted);
}

void expect_reference(const std::vector<glm::vec4>& got, const Lit& s, const photometry::SkyMap& sky, const View& view,
                      float lambert) {
    // Lamps in the sky are edges: a direction off by 3e-7 moves on the sharp map by a small part of a texel, and
    // what differs between neighbours comes in. Found by turning the ray. The table of fractions is within 0.008.
    const glm::dmat3 off = glm::dmat3(glm::rotate(glm::dmat4(1), 1e-6, glm::dvec3(0.6, 0.64, 0.48)));
    const glm::dmat3 world = glm::transpose(glm::dmat3(view.world_to_view));
    expect_light("sky", s.extent, got, {2e-5, 1e-6}, [&](size_t i) {
        const glm::dvec2 centre = glm::dvec2(s.pixel(i)) + 0.5;
        const reference::SurfaceTexel texel = s.texel(i);
        const glm::dvec2 slope = glm::dvec2(view.ray_scale()) * centre + glm::dvec2(view.ray_offset());
        const glm::dvec3 ray = world * glm::normalize(glm::dvec3(slope, -1));
        const bool drawn = s.surface[i].z > 0;
        const glm::dvec3 n = world * reference::octahedral_decode(glm::dvec2(texel.surface));
        const glm::dvec3 seen = drawn ? glm::reflect(ray, n) : ray;
        const double roughness = drawn ? texel.surface.w : 0;
        const glm::dvec3 sky_here = reference::blurred_sky(sky, seen, roughness);
        const glm::dvec3 moved = glm::abs(reference::blurred_sky(sky, off * seen, roughness) - sky_here);
        const bool shiny = drawn && texel.reflectance.w >= 0 && (texel.surface.w < 1 || texel.reflectance.w > 0);
        return reference::Shaded{reference::add_sky(sky, texel, glm::dvec3(s.scene[i]), centre, view, lambert),
                                 moved + (shiny ? 0.016 * sky_here : glm::dvec3(0))};
    });
}

TEST(Sky, MatchesTheReferenceAtEverySize) {
    PassRig rig;
    const photometry::SkyMap sky = photometry::make_sky_map(night(64, 1));
    const glm::mat4 turned = glm::rotate(glm::rotate(glm::mat4(1), 0.4f, {1, 0, 0}), 2.1f, {0, 1, 0});
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {33, 9}, {67, 65}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
        const View view = View::symmetric(extent, 1.2f, glm::translate(turned, {5, -3, 8}));
        const Lit s = noise(extent, extent.width);
        expect_reference(add(rig, s, sky, view, 0.318309886f), s, sky, view, 0.318309886f);
    }
    EXPECT_EQ(rig.complaints(), "");
}

// A uniform sky of L: rho L on matt surfaces, L where nothing is drawn, and no metal brighter
// than L; rough metals lose up to 70 % to masking, as they do of the light of lamps (single scattering).
TEST(Sky, AUniformSkyIsAFurnace) {
    PassRig rig;
    const photometry::SkyMap sky = photometry::make_sky_map({64, 32, std::vector<float>(64 * 32 * 3, 2.0f)});
    const VkExtent2D extent{40, 21};
    const View view = View::symmetric(extent, 0.8f, glm::mat4(1));
    Lit s = noise(extent, 9);
    for (size_t i = 0; i < s.scene.size(); ++i) {
        s.scene[i] = {0, 0, 0, 1};
        if (i % 8 == 3) s.reflectance[i] = {1, 1, 1, 1};  // a perfect metal
    }
    const auto got = add(rig, s, sky, view, 0.318309886f);
    for (size_t i = 0; i < got.size(); ++i) {
        if (s.surface[i].z == 0) {
            EXPECT_NEAR(got[i].g, 2, 1e-5);
        } else if (i % 8 == 3) {
            EXPECT_LE(got[i].g, 2 * 1.01) << "roughness " << s.surface[i].w;
            EXPECT_GE(got[i].g, 2 * 0.3) << "roughness " << s.surface[i].w;
            if (s.surface[i].w < 0.3f) {
                EXPECT_GE(got[i].g, 2 * 0.85) << "roughness " << s.surface[i].w;
            }
        } else if (s.surface[i].w == 1 && (i % 8 < 2 || i % 8 == 4 || i % 8 == 5)) {
            EXPECT_NEAR(got[i].g, 2 * s.reflectance[i].g, 0.005) << i;
        }
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Sky, WhatIsNotFiniteStaysInItsPixel) {
    PassRig rig;
    const photometry::SkyMap sky = photometry::make_sky_map(night(64, 3));
    const VkExtent2D extent{40, 16};
    const View view = View::symmetric(extent, 0.8f, glm::mat4(1));
    const Lit clean = noise(extent, 4);
    Lit s = clean;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (size_t i = 3; i < s.scene.size(); i += 7)
        s.surface[i] = {kNan, kNan, i % 2 ? kNan : 5, kNan}, s.reflectance[i].w = kNan;
    const auto got = add(rig, s, sky, view, 1), want = add(rig, clean, sky, view, 1);
    expect_others_equal(got, want);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Sky, WithoutASkyThereIsNoPass) {
    expect_no_pass(
        [](const render::FrameContext& frame, graph::Resource scene) { return render::add_sky(frame, {}, scene, {}); });
}

}  // namespace
}  // namespace vesper::test::sky_test
