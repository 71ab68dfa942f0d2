// First reflections of lamps that move, against paths of rays. SPDX-License-Identifier: MIT
#include "transport/lamp_reflections.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/luminance.h"
#include "passes/moving_light_reference.h"
#include "scene/lamp.h"
#include "support/rooms.h"
#include "transport/light_tracer.h"

namespace vesper::test::lamp_reflections_test {
namespace {

using glm::dvec3, glm::vec3;

constexpr double kPi = std::numbers::pi;

/// A road between two facades, a wall across it, and a headlamp, a wide cone that looks down a little.
struct Lane {
    scene::Scene scene;
    uint32_t lamp;

    explicit Lane(float reflectance = 0.2f) {
        const uint32_t matt = add_material(scene, reflectance);
        add_rectangle(scene, matt, {-8, 0, 30}, {16, 0, 0}, {0, 0, -60});
        add_rectangle(scene, matt, {-8, 0, 30}, {0, 0, -60}, {0, 12, 0});
        add_rectangle(scene, matt, {8, 0, -30}, {0, 0, 60}, {0, 12, 0});
        add_rectangle(scene, matt, {-8, 0, -30}, {16, 0, 0}, {0, 12, 0});
        lamp = uint32_t(scene.nodes.size());
        add_lamp(scene, 9'000, {0, 0.7, 0});
        scene::Lamp& cone = scene.lamps.back();
        cone.kind = scene::Lamp::Kind::Spot, cone.inner_cone = 0.25f, cone.outer_cone = 0.5f;
        scene.nodes.back().rotation = glm::quat(std::cos(-0.1f), std::sin(-0.1f), 0, 0);  // 0.2 rad down
    }
    std::vector<glm::dmat4> world() const { return scene::world_transforms(scene, 0); }
    std::vector<bool> moving() const {
        std::vector<bool> moving(scene.nodes.size(), false);
        moving[lamp] = true;
        return moving;
    }
};

double by_patches(const std::vector<transport::LitPatch>& patches, dvec3 at, dvec3 normal) {
    double sum = 0;
    for (const transport::LitPatch& patch : patches) sum += luminance(reference::light_of(patch, at, normal));
    return sum;
}

// pi times the intensities is the flux that is reflected: that of the lamp times the reflectance, since all of it meets
// a surface.
TEST(LampReflections, KeepTheFlux) {
    const Lane lane;
    const transport::LampReflections reflections(lane.scene, lane.world(), lane.moving());
    double flux = 0;
    for (const transport::LitPatch& patch : reflections.patches(lane.world(), {}, dvec3(0)))
        flux += kPi * luminance(patch.intensity);
    EXPECT_NEAR(flux, 0.2 * scene::luminous_flux(lane.scene.lamps[0]), 0.005 * flux);
    const std::vector<float> half(lane.scene.nodes.size(), 0.5f);
    double dimmed = 0;
    for (const transport::LitPatch& patch : reflections.patches(lane.world(), half, dvec3(0)))
        dimmed += kPi * luminance(patch.intensity);
    EXPECT_NEAR(dimmed, flux / 2, 1e-9 * flux);
    EXPECT_TRUE(reflections.patches(lane.world(), {}, dvec3(0, 0, 200)).empty()) << "far from the eye";
}

// All walls of the street on which the first reflection of the lamp gives a tenth of a lux or more: within 35 %, and 15
// % on average. Patches stand for discs.
TEST(LampReflections, LightWallsAboutAsPathsSay) {
    const Lane lane;
    const std::vector<glm::dmat4> world = lane.world();
    const transport::LampReflections reflections(lane.scene, world, lane.moving());
    const std::vector<transport::LitPatch> patches = reflections.patches(world, {}, dvec3(0));
    const transport::LightTracer tracer(lane.scene, world);
    double off = 0, sum = 0, want_sum = 0;
    int count = 0;
    for (const double z : {4.0, 0.0, -4.0, -10.0, -18.0, -26.0})
        for (const double y : {0.5, 1.5, 3.0, 6.0, 10.0})
            for (const double side : {-1.0, 1.0}) {
                const dvec3 at(8 * side, y, z), normal(-side, 0, 0);
                const double want =
                    luminance(tracer.at(at, normal, {.paths = 32768, .most_reflections = 1})[transport::Origin::Once]);
                if (want < 0.1) continue;
                const double found = by_patches(patches, at, normal);
                EXPECT_NEAR(found, want, 0.4 * want) << y << " m up at " << z;
                off += std::abs(found / want - 1), sum += found, want_sum += want, ++count;
            }
    ASSERT_GT(count, 20);
    EXPECT_LT(off / count, 0.12);
    EXPECT_NEAR(sum, want_sum, 0.08 * want_sum);
}

// A metre of the lamp's way in steps of a centimetre: no step changes the light of a wall by a hundredth.
TEST(LampReflections, MoveSteadily) {
    const Lane lane;
    std::vector<glm::dmat4> world = lane.world();
    const transport::LampReflections reflections(lane.scene, world, lane.moving());
    double before = 0;
    for (int step = 0; step <= 100; ++step) {
        world[lane.lamp][3].z = -0.01 * step;
        const double now = by_patches(reflections.patches(world, {}, dvec3(0)), {8, 2, -12}, {-1, 0, 0});
        if (step > 0) {
            EXPECT_NEAR(now, before, 0.01 * before) << step;
        }
        before = now;
    }
}

// Two equal lamps below one node share patches; what moves neither hides nor reflects.
TEST(LampReflections, PairsSharePatches) {
    Lane lane;
    const auto car = uint32_t(lane.scene.nodes.size());
    lane.scene.nodes.emplace_back();
    for (const double x : {-0.5, 0.5}) {
        lane.scene.nodes.push_back(lane.scene.nodes[lane.lamp]);
        lane.scene.nodes.back().parent = car, lane.scene.nodes.back().translation.x = x;
    }
    add_rectangle(lane.scene, 0, {-8, 0, -1}, {16, 0, 0}, {0, 12, 0});
    lane.scene.nodes.back().parent = car;
    std::vector<bool> moving(lane.scene.nodes.size(), false);
    for (size_t node = car; node < moving.size(); ++node) moving[node] = true;
    const transport::LampReflections pair(lane.scene, lane.world(), moving);
    const auto patches = pair.patches(lane.world(), {}, dvec3(0));
    EXPECT_LE(patches.size(), 4 * transport::LampReflections::kParts) << "road and three walls";
    double flux = 0;
    for (const transport::LitPatch& patch : patches) flux += kPi * luminance(patch.intensity);
    EXPECT_NEAR(flux, 2 * 0.2 * scene::luminous_flux(lane.scene.lamps[0]), 0.005 * flux);
}

}  // namespace
}  // namespace vesper::test::lamp_reflections_test
