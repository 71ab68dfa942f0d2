// The reference of light of what moves: values between places, and the closed form of a disc.
// SPDX-License-Identifier: MIT
#include "passes/moving_light_reference.h"

#include <numbers>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace vesper::test::moving_light_reference_test {
namespace {

using glm::dvec3;

/// 4 x 3 x 3 places at steps of 0.5 m from (1, 2, 3), of which one hides a part.
transport::MovingBodies one_place() {
    transport::MovingBodies bodies;
    bodies.volumes = {{.low = {1, 2, 3}, .step = 0.5, .count = {4, 3, 3}, .first = 2}};
    bodies.hidden.resize(2 + 36);
    bodies.hidden[2 + (1 * 3 + 1) * 4 + 2] = {1, 2, 6, 12, 18, 24};  // at (2, 1, 1): 2, 2.5, 3.5
    bodies.bodies = {{1, 0}};
    return bodies;
}

TEST(MovingLightReference, IsLinearBetweenPlacesOneStepBeforeTheSurface) {
    const transport::MovingBodies bodies = one_place();
    const auto at = [&](dvec3 point, dvec3 normal) {
        return reference::hidden(bodies, bodies.volumes[0], point, normal);
    };
    EXPECT_NEAR(at({2, 2, 3.5}, {0, 1, 0}), 6 / 31.0, 1e-12);
    EXPECT_NEAR(at({2, 3, 3.5}, {0, -1, 0}), 12 / 31.0, 1e-12);
    EXPECT_NEAR(at({2.2, 2.15, 3.6}, {0, 1, 0}), 0.6 * 0.7 * 0.8 * 6 / 31.0, 1e-12);
    const dvec3 normal(-0.6, 0, 0.8);
    EXPECT_NEAR(at(dvec3(2, 2.5, 3.5) - 0.5 * normal, normal), (0.36 * 2 + 0.64 * 18) / 31, 1e-12);
    EXPECT_EQ(at({2, 3, 3.5}, {0, 1, 0}), 0) << "one step before it the volume ends";
    EXPECT_EQ(at({0.9, 2, 3.5}, {0, 1, 0}), 0);
}

TEST(MovingLightReference, BodiesHideOfWhatOthersLeave) {
    transport::MovingBodies bodies = one_place();
    bodies.bodies.push_back({2, 0});
    gpu_scene::SceneFrame poses{{glm::dmat4(1), glm::dmat4(1), glm::dmat4(1)}};
    poses.world[1] = glm::translate(glm::dmat4(1), {100, 0, 0});
    poses.world[2] = poses.world[1];
    EXPECT_NEAR(reference::left_open(bodies, poses, {102, 2, 3.5}, {0, 1, 0}), 25 / 31.0 * 25 / 31.0, 1e-12);
    // Turned so that its y is the world's x: what it hides from a surface that faces x is what it has of y.
    poses.world[2] = glm::rotate(glm::translate(glm::dmat4(1), {0, 0, 50}), -std::numbers::pi / 2, {0, 0, 1});
    const dvec3 place(glm::dvec3(poses.world[2] * glm::dvec4(2, 2.5, 3.5, 1)));
    EXPECT_NEAR(reference::left_open(bodies, poses, place - dvec3(0.5, 0, 0), {1, 0, 0}), 25 / 31.0, 1e-12);
}

// A disc of the radius r and the luminance L: on its axis E = pi L r^2 / (d^2 + r^2), far from it I cos cos / d^2.
TEST(MovingLightReference, APatchIsADisc) {
    const double luminance = 40, radius = 1.5;
    const transport::LitPatch patch{.position = {0, 3, 0},
                                    .normal = {0, -1, 0},
                                    .radius = radius,
                                    .intensity = dvec3(luminance * std::numbers::pi * radius * radius)};
    EXPECT_NEAR(reference::light_of(patch, {0, 1, 0}, {0, 1, 0}).x,
                std::numbers::pi * luminance * radius * radius / (4 + radius * radius), 1e-9);
    const double far = reference::light_of(patch, {400, -297, 0}, {0, 1, 0}).x;
    EXPECT_NEAR(far, patch.intensity.x * 0.6 * 0.6 / 250'000, 1e-4 * far);
    EXPECT_EQ(reference::light_of(patch, {0, 4, 0}, {0, -1, 0}).x, 0) << "behind it";
    EXPECT_EQ(reference::light_of(patch, {0, 1, 0}, {0, -1, 0}).x, 0) << "turned away";
}

}  // namespace
}  // namespace vesper::test::moving_light_reference_test
