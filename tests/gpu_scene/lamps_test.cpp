// Lamps of a scene as the shaders get them. SPDX-License-Identifier: MIT
#include "gpu_scene/lamps.h"
#include "scene/scene.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

using scene::Lamp;

constexpr float kDegree = 3.14159265f / 180;

shared::Lamp shine(const Lamp& lamp) {
    const gpu_scene::SceneFrame frame{{glm::mat4(1)}};
    const gpu_scene::View view;
    return gpu_scene::lamp_list({{lamp, 0}}, {}, frame, view).lamps.at(0);
}

// KHR_lights_punctual: full intensity within the inner cone, none beyond the outer, the square of a ramp in the cosine
// between. What floats allow: a cosine near one has 6e-8 of rounding, times the slope of the ramp, a few times.
TEST(Lights, SpotsOfEveryWidthAreFullOnTheirAxis) {
    for (const float outer : {1.0f, 2.0f, 5.0f, 30.0f, 80.0f, 90.0f})
        for (const float share : {0.0f, 0.5f, 0.9f}) {
            const float inner = outer * share;
            const shared::Lamp lamp = shine({.name = {},
                                             .kind = Lamp::Kind::Spot,
                                             .intensity = 100,
                                             .inner_cone = inner * kDegree,
                                             .outer_cone = outer * kDegree});
            const float rounding = 1e-4f + 3e-7f * lamp.lobe_a;
            const auto ramp = [&](float degrees) {
                return std::clamp(lamp.lobe_a * std::cos(degrees * kDegree) + lamp.lobe_b, 0.0f, 1.0f);
            };
            EXPECT_NEAR(ramp(0), 1, rounding) << inner << " to " << outer;
            EXPECT_NEAR(ramp(inner), 1, rounding) << inner << " to " << outer;
            EXPECT_NEAR(ramp(outer), 0, rounding) << inner << " to " << outer;
            const double middle = (inner + outer) / 2 * double(kDegree);
            const double want = (std::cos(middle) - std::cos(double(outer * kDegree))) /
                                (std::cos(double(inner * kDegree)) - std::cos(double(outer * kDegree)));
            EXPECT_NEAR(ramp(float((inner + outer) / 2)), want, rounding) << inner << " to " << outer;
        }
}

TEST(Lights, ASpotWhoseConesCoincideIsFullInside) {
    const shared::Lamp lamp = shine({.name = {},
                                     .kind = Lamp::Kind::Spot,
                                     .intensity = 100,
                                     .inner_cone = 20 * kDegree,
                                     .outer_cone = 20 * kDegree});
    EXPECT_GE(lamp.lobe_a * std::cos(19.9f * kDegree) + lamp.lobe_b, 1);
    EXPECT_LE(lamp.lobe_a * std::cos(20.1f * kDegree) + lamp.lobe_b, 0);
}

TEST(Lights, KindsFollowOneAnotherAndDarkLampsAreLeftOut) {
    const gpu_scene::SceneFrame frame{{glm::mat4(1)}};
    const Lamp point{.name = {}, .kind = Lamp::Kind::Point, .intensity = 1},
        power{.name = {}, .kind = Lamp::Kind::CosinePower, .intensity = 2},
        moon{.name = {}, .kind = Lamp::Kind::Directional, .intensity = 3},
        dark{.name = {}, .kind = Lamp::Kind::Point, .intensity = 0};
    scene::Scene scene;
    scene.lamps = {moon, power, dark, point};
    for (uint32_t i = 0; i < 4; ++i) {
        scene.nodes.emplace_back();
        scene.nodes.back().lamp = i;
    }
    const gpu_scene::SceneFrame four{std::vector<glm::dmat4>(4, glm::dmat4(1))};
    const gpu_scene::LampList list = gpu_scene::lamp_list(gpu_scene::placed_lamps(scene), {}, four, gpu_scene::View());
    ASSERT_EQ(list.lamps.size(), 3u);
    EXPECT_EQ(list.counts.cones, 1u);
    EXPECT_EQ(list.counts.powers, 1u);
    EXPECT_EQ(list.counts.directional, 1u);
    EXPECT_EQ(list.lamps[0].intensity, 1);
    EXPECT_EQ(list.lamps[1].intensity, 2);
    EXPECT_EQ(list.lamps[2].intensity, 3);
}

// A culling takes cones of directions for cones of a table's angles: also on a node that is sheared, mirrored or flat.
TEST(Lights, TheFrameOfAMapIsOrthonormal) {
    for (const photometry::Goniometry goniometry :
         {photometry::Goniometry::CGamma, photometry::Goniometry::TypeB, photometry::Goniometry::TypeA}) {
        const photometry::Distribution d{.name = {},
                                         .goniometry = goniometry,
                                         .horizontal = {0, 90},
                                         .vertical = {0, 90},
                                         .candela = {1, 1, 1, 1},
                                         .opening = {},
                                         .metadata = {}};
        scene::Scene scene;
        scene.distributions = {d};
        const Lamp lamp{.name = {}, .kind = Lamp::Kind::Measured, .intensity = 1, .distribution = 0};
        for (const glm::mat4& pose : {glm::mat4(1), glm::mat4(1, 0, 0, 0, 0.3f, 1, 0, 0, 0.4f, 0.5f, 1, 0, 0, 0, 0, 1),
                                      glm::mat4(-1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1),
                                      glm::mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)}) {
            const shared::Lamp packed =
                gpu_scene::lamp_list({{lamp, 0}}, gpu_scene::intensity_tables(scene), {{pose}}, gpu_scene::View())
                    .lamps.at(0);
            EXPECT_NEAR(glm::dot(packed.start, packed.pole), 0, 1e-6) << int(goniometry);
            EXPECT_NEAR(glm::length(packed.start), 1, 1e-6) << int(goniometry);
            EXPECT_NEAR(glm::length(packed.pole), 1, 1e-6) << int(goniometry);
            EXPECT_GT(packed.grid.x, 0) << int(goniometry);
            if (glm::determinant(pose) != 0) {
                EXPECT_EQ(packed.last_azimuth < 0, glm::determinant(pose) < 0) << int(goniometry);
            }
        }
    }
}

TEST(Lights, AreDimmedNodeByNode) {
    const Lamp point{.name = {}, .kind = Lamp::Kind::Point, .intensity = 10};
    const gpu_scene::SceneFrame frame{.world = std::vector<glm::dmat4>(3, glm::dmat4(1)), .dimming = {0.5f, 0, 1}};
    const gpu_scene::LampList list =
        gpu_scene::lamp_list({{point, 0}, {point, 1}, {point, 2}}, {}, frame, gpu_scene::View());
    ASSERT_EQ(list.lamps.size(), 2u);
    EXPECT_EQ(list.counts.cones, 2u);
    EXPECT_EQ(list.lamps[0].intensity, 5);
    EXPECT_EQ(list.lamps[1].intensity, 10);
}

}  // namespace
}  // namespace vesper::test
