// Light is conserved: what sources emit is what surfaces and the sky get. SPDX-License-Identifier: MIT
#include "transport/flux_balance.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/gathered.h"
#include "support/rooms.h"

namespace vesper::test::flux_balance_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr uint32_t kReflections = 32;

transport::FluxBalance balance_of(const scene::Scene& scene, const std::vector<bool>& moving = {}) {
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    return transport::flux_balance(scene, world, moving, gathered(scene, kMetreCells, moving), kReflections);
}

// 2 %: noise of 150 cells of a cube of 5 m.
TEST(FluxBalance, AClosedRoomAbsorbsAll) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f), glm::vec3(2.5f));
    add_lamp(scene, 100, {0.3, 0.2, -0.4});
    const transport::FluxBalance found = balance_of(scene);
    EXPECT_NEAR(found.lamps, 4 * kPi * 100, 1e-3);
    EXPECT_EQ(found.emitters, 0);
    EXPECT_EQ(found.sky_directly, 0);
    EXPECT_EQ(found.sky_reflected, 0);
    EXPECT_NEAR(found.absorbed, found.emitted(), 0.02 * found.emitted());
}

// Half of the lamp's light goes up; of that on the floor half is reflected, to the sky.
TEST(FluxBalance, TheSkyGetsWhatNothingStops) {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0.5f), {-200, 0, 200}, {400, 0, 0}, {0, 0, -400});
    add_lamp(scene, 100, {0, 2, 0});
    const transport::FluxBalance found = balance_of(scene);
    // The floor is seen under all but the last 1 % of the lower half.
    EXPECT_NEAR(found.sky_directly, 0.505 * found.emitted(), 0.01 * found.emitted());
    EXPECT_NEAR(found.sky_reflected, 0.248 * found.emitted(), 0.02 * found.emitted());
    EXPECT_NEAR(found.found(), found.emitted(), 0.03 * found.emitted());
}

// A plate of 4 m^2 and 100 cd/m^2 emits pi L A, from both sides twice that.
TEST(FluxBalance, EmittersAreCountedBySides) {
    for (const bool both : {false, true}) {
        scene::Scene scene;
        const uint32_t glow = add_material(scene, 0, 100);
        scene.materials[glow].double_sided = both;
        add_room(scene, add_material(scene, 0.3f), glm::vec3(3));
        add_rectangle(scene, glow, {-1, 0.1f, 1}, {2, 0, 0}, {0, 0, -2});
        const transport::FluxBalance found = balance_of(scene);
        EXPECT_NEAR(found.emitters, (both ? 2 : 1) * 400 * kPi, 1e-6 * found.emitters);
        EXPECT_NEAR(found.absorbed, found.emitters, 0.04 * found.emitters) << both;
    }
}

TEST(FluxBalance, LampsThatMoveAreNotCounted) {
    scene::Scene scene;
    add_room(scene, add_material(scene, 0.5f), glm::vec3(2));
    add_lamp(scene, 100, {0, 0, 0});
    std::vector<bool> moving(scene.nodes.size());
    moving.back() = true;
    const transport::FluxBalance found = balance_of(scene, moving);
    EXPECT_EQ(found.emitted(), 0);
    EXPECT_EQ(found.found(), 0);
}

}  // namespace
}  // namespace vesper::test::flux_balance_test
