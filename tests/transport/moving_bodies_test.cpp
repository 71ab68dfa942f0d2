// What bodies hide, against closed forms and paths of rays. SPDX-License-Identifier: MIT
#include "transport/moving_bodies.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/luminance.h"
#include "passes/moving_light_reference.h"
#include "scene/placement.h"
#include "support/rooms.h"
#include "transport/light_tracer.h"

namespace vesper::test::moving_bodies_test {
namespace {

using glm::dvec3, glm::vec3, transport::MovingBodies;

constexpr double kPi = std::numbers::pi;

/// At and below the nodes from `first` on.
MovingBodies moving_from(const scene::Scene& scene, size_t first) {
    std::vector<bool> moving(scene.nodes.size(), false);
    for (size_t node = first; node < moving.size(); ++node) moving[node] = true;
    return transport::moving_bodies(scene, moving);
}

/// A node, and below it a box.
uint32_t add_body(scene::Scene& scene, vec3 half, vec3 middle = vec3(0)) {
    const auto root = uint32_t(scene.nodes.size());
    scene.nodes.emplace_back();
    add_box(scene, 0, half, middle);
    for (uint32_t node = root + 1; node < scene.nodes.size(); ++node) scene.nodes[node].parent = root;
    return root;
}

/// Form factor of a rectangle, seen from a point below one of its corners that faces it (Lambert's sum of edges).
double below_a_corner(double a, double b) {
    const double x = std::sqrt(1 + a * a), y = std::sqrt(1 + b * b);
    return (a / x * std::atan(b / x) + b / y * std::atan(a / y)) / (2 * kPi);
}

// A plate of 2 m x 2 m: under its middle, and under a corner. Places are a step before the surface; between them values
// are linear, and of 192 directions each is 1 % to 2 % of what is hidden.
TEST(MovingBodies, APlateHidesItsFormFactor) {
    scene::Scene scene;
    add_material(scene, 0.5f);
    const auto root = uint32_t(scene.nodes.size());
    scene.nodes.emplace_back().translation = {700, 3, -20};  // wherever it stands
    add_rectangle(scene, 0, {-1, 0, -1}, {2, 0, 0}, {0, 0, 2});
    scene.nodes.back().parent = root;
    const MovingBodies bodies = moving_from(scene, root);
    ASSERT_EQ(bodies.volumes.size(), 1u);
    const double step = bodies.volumes[0].step;
    EXPECT_NEAR(step, std::sqrt(8.0) / 14, 1e-6);
    for (const double down : {0.25, 0.5, 0.9}) {
        const auto hidden = [&](dvec3 at) {
            return reference::hidden(bodies, bodies.volumes[0], at - dvec3(0, step, 0), {0, 1, 0});
        };
        EXPECT_NEAR(hidden({0, -down, 0}), 4 * below_a_corner(1 / down, 1 / down), 0.04) << down;
        EXPECT_NEAR(hidden({1, -down, 1}), below_a_corner(2 / down, 2 / down), 0.04) << down;
    }
    EXPECT_EQ(reference::hidden(bodies, bodies.volumes[0], {0, -0.5, 0}, {0, -1, 0}), 0) << "it is behind";
    EXPECT_EQ(reference::hidden(bodies, bodies.volumes[0], {0, -3, 0}, {0, 1, 0}), 0) << "far away";
}

// Ground of no reflectance under an even sky, and a black box over it: paths of rays say what is left. Values are those
// of a step (36 cm) over the ground, so that near its edge the shadow is too dark by an eighth of all light at most.
TEST(MovingBodies, GroundAroundABoxIsAsDarkAsPathsSay) {
    scene::Scene scene;
    add_material(scene, 0);
    scene.sky_luminance = 100, scene.sky_colour = vec3(1);
    const uint32_t root = add_body(scene, {0.9f, 0.65f, 2.2f}, {0, 0.85f, 0});
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const MovingBodies bodies = moving_from(scene, root);
    const gpu_scene::SceneFrame poses{world};
    const transport::LightTracer tracer(scene, world);
    for (const dvec3 at : {dvec3(0, 0, 0), dvec3(0.8, 0, 1), dvec3(1.1, 0, 0), dvec3(1.6, 0, 0.5), dvec3(2.5, 0, -1),
                           dvec3(0.3, 0, 2.5), dvec3(0, 0, 3.5)}) {
        const double want = luminance(tracer.at(at, {0, 1, 0}).sum()) / (100 * kPi);
        EXPECT_NEAR(reference::left_open(bodies, poses, at, {0, 1, 0}), want, 0.13) << at.x << ", " << at.z;
    }
    EXPECT_LT(reference::left_open(bodies, poses, {0, 0, 0}, {0, 1, 0}), 0.12) << "black under it";
}

TEST(MovingBodies, HideNothingOfTheirOwnOuterSurfaces) {
    scene::Scene scene;
    add_material(scene, 0.5f);
    const MovingBodies bodies = moving_from(scene, add_body(scene, {0.9f, 0.65f, 2.2f}));
    for (const double u : {-0.9, -0.3, 0.0, 0.5, 0.99})
        for (int side = 0; side < 6; ++side) {
            dvec3 at = dvec3(u) * dvec3(0.9, 0.65, 2.2), normal(0);
            normal[side / 2] = side % 2 ? -1 : 1;
            at[side / 2] = dvec3(0.9, 0.65, 2.2)[side / 2] * normal[side / 2];
            EXPECT_LT(reference::hidden(bodies, bodies.volumes[0], at, normal), 0.03) << side << ", " << u;
        }
}

// A box that is animated below a node that is: two bodies, each at the pose of its own node.
TEST(MovingBodies, PartsWithAnimationsAreBodies) {
    scene::Scene scene;
    add_material(scene, 0.5f);
    const uint32_t above = add_body(scene, vec3(1)), below = add_body(scene, vec3(0.5f), {4, 0, 0});
    scene.nodes[below].parent = above;
    for (const uint32_t node : {above, below}) scene.channels.emplace_back().node = node;
    const MovingBodies bodies = moving_from(scene, 0);
    ASSERT_EQ(bodies.bodies.size(), 2u);
    EXPECT_EQ(bodies.bodies[0].node, above);
    EXPECT_EQ(bodies.bodies[1].node, below);
}

TEST(MovingBodies, EqualOnesShareAVolumeAndSmallOnesHaveNone) {
    scene::Scene scene;
    add_material(scene, 0.5f);
    add_room(scene, 0, vec3(9));
    const size_t first = scene.nodes.size();
    const uint32_t one = add_body(scene, vec3(1)), small = add_body(scene, vec3(0.05f));
    // The same meshes elsewhere and turned, and a part of them.
    const auto again = uint32_t(scene.nodes.size());
    scene.nodes.emplace_back().translation = {3, 0, 0};
    scene.nodes.back().rotation = glm::quat(0.6f, 0, 0.8f, 0);
    for (uint32_t k = 1; k <= 6; ++k) {
        scene.nodes.push_back(scene.nodes[one + k]);
        scene.nodes.back().parent = again;
    }
    const auto part = uint32_t(scene.nodes.size());
    scene.nodes.emplace_back();
    scene.nodes.push_back(scene.nodes[one + 1]);
    scene.nodes.back().parent = part;
    const MovingBodies bodies = moving_from(scene, first);
    ASSERT_EQ(bodies.bodies.size(), 3u);
    EXPECT_EQ(bodies.bodies[0].node, one);
    EXPECT_EQ(bodies.bodies[1].node, again);
    EXPECT_EQ(bodies.bodies[2].node, part);
    EXPECT_EQ(bodies.bodies[0].volume, bodies.bodies[1].volume);
    EXPECT_NE(bodies.bodies[0].volume, bodies.bodies[2].volume);
    EXPECT_EQ(bodies.volumes.size(), 2u);
    EXPECT_GT(small, one);
    EXPECT_TRUE(transport::moving_bodies(scene, {}).bodies.empty());
}

}  // namespace
}  // namespace vesper::test::moving_bodies_test
