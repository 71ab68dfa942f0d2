// Where what hides a lamp from a view can stand.
#include "render/shadows/casters.h"

#include <random>

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "base/angle.h"

namespace vesper::test::casters_test {
namespace {

using render::light_paths, render::may_lie_in;

bool holds(const gpu_scene::View& view, glm::dvec3 lamp, glm::dvec3 point) {
    return may_lie_in(light_paths(view, lamp), {point, 1e-9});
}

// A view from the origin along -z, 90 degrees wide and high.
TEST(Casters, EndAtTheView) {
    const gpu_scene::View view = gpu_scene::View::symmetric({64, 64}, float(kPi / 2), glm::dmat4(1));
    const glm::dvec3 before(0, 0, -10), behind(0, 0, 10), aside(20, 0, -5);
    EXPECT_TRUE(holds(view, before, {0, 0, -50}));
    EXPECT_TRUE(holds(view, before, {4, 4, -5}));
    EXPECT_FALSE(holds(view, before, {0, 0, 1})) << "behind the eye";
    EXPECT_FALSE(holds(view, before, {7, 0, -5})) << "beside what is seen";
    EXPECT_TRUE(holds(view, behind, {0, 0, 5}));
    EXPECT_TRUE(holds(view, behind, {9, 0, 1})) << "on the way to the right edge";
    EXPECT_FALSE(holds(view, behind, {0, 0, 11}));
    EXPECT_FALSE(holds(view, behind, {25, 0, -5}));
    EXPECT_TRUE(holds(view, aside, {10, 0, -5}));
    EXPECT_TRUE(holds(view, aside, {19, 0, -9}));
    EXPECT_FALSE(holds(view, aside, {21, 0, -5})) << "behind the lamp";
    EXPECT_FALSE(holds(view, aside, {-6, 0, -5})) << "past what is seen";
    EXPECT_FALSE(holds(view, aside, {10, 0, 1}));
    EXPECT_FALSE(holds(view, aside, {15, 9, -5})) << "the lamp sees no more than the edge above";
    EXPECT_TRUE(may_lie_in(light_paths(view, aside), {{-6, 0, -5}, 2})) << "a sphere that reaches in";
}

// Every straight way between a lamp and something that is seen.
TEST(Casters, HoldAllWaysFromLamps) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto somewhere = [&](double size) { return size * glm::dvec3(unit(random), unit(random), unit(random)); };
    size_t beside = 0, all = 0;
    for (int i = 0; i < 200; ++i) {
        const glm::dmat4 pose = glm::lookAt(somewhere(30), somewhere(30), glm::normalize(somewhere(1)));
        gpu_scene::View view = gpu_scene::View::symmetric({64, 48}, float(1.2 + unit(random)), pose);
        view.tangent_low.x *= 0.3f;  // as that of one of several channels
        const glm::dvec3 lamp = somewhere(40);
        const std::vector<render::HalfSpace> paths = light_paths(view, lamp);
        const glm::dmat4 to_world = glm::inverse(pose);
        for (int k = 0; k < 50; ++k) {
            const double across = 0.5 + 0.5 * unit(random), up = 0.5 + 0.5 * unit(random),
                         away = 50 + 49.9 * unit(random);
            const glm::dvec2 tangent =
                glm::mix(glm::dvec2(view.tangent_low), glm::dvec2(view.tangent_high), glm::dvec2(across, up));
            const glm::dvec3 seen(to_world * glm::dvec4(away * glm::dvec3(tangent, -1), 1));
            const glm::dvec3 between = glm::mix(lamp, seen, 0.5 + 0.5 * unit(random));
            ASSERT_TRUE(may_lie_in(paths, {between, 1e-4})) << i << ", " << k;
            const glm::dvec3 beyond = glm::mix(lamp, seen, 1.5 + 0.5 * unit(random));
            ASSERT_TRUE(may_lie_in(light_paths(view, lamp, 2), {beyond, 1e-4})) << i << ", " << k;
            ++all, beside += may_lie_in(paths, {somewhere(40), 1e-4}) ? 0 : 1;
        }
    }
    EXPECT_GT(beside, all / 3) << "they leave something out";
}

// Of a spot of 30 degrees to either side, and of a cosine.
TEST(Casters, TellTheLargestIntensityTowardsASphere) {
    gpu_scene::LampList list;
    const float a = 1 / (1 - std::cos(float(kPi / 6)));
    list.lamps = {{.intensity = 100, .axis = {0, 0, -1}, .lobe_a = a, .lobe_b = 1 - a},
                  {.intensity = 100, .axis = {0, 0, -1}, .lobe_a = 1}};
    list.counts = {1, 1, 0, 0};
    const auto towards = [&](uint32_t lamp, double angle, double radius) {
        return render::intensity_towards(list, lamp, 10.0 * glm::dvec3(std::sin(angle), 0, -std::cos(angle)), radius);
    };
    EXPECT_NEAR(towards(0, 0, 0), 100, 1e-4);
    EXPECT_EQ(towards(0, kPi / 5, 0), 0);
    EXPECT_GT(towards(0, kPi / 5, 2), 0) << "some of it is in the beam";
    const double ramp = double(a) * std::cos(0.2) + 1 - double(a);
    EXPECT_NEAR(towards(0, 0.2, 0), 100 * ramp * ramp, 1e-3);
    EXPECT_NEAR(towards(0, 0.2, 10 * std::sin(0.2)), 100, 1e-3) << "it reaches the axis";
    EXPECT_NEAR(towards(1, 1, 0), 100 * std::cos(1.0), 1e-3);
    EXPECT_EQ(towards(1, 2, 1), 0);
    EXPECT_EQ(towards(0, 3, 11), 100) << "the lamp is in it";
}

// Spheres in larger ones, around lamps of both kinds.
TEST(Casters, AreFoundByTheirGroup) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto somewhere = [&](double size) { return size * glm::dvec3(unit(random), unit(random), unit(random)); };
    size_t empty = 0, cast = 0;
    for (int i = 0; i < 20000; ++i) {
        const gpu_scene::View view = gpu_scene::View::symmetric({64, 48}, float(1.2 + unit(random)),
                                                                glm::lookAt(somewhere(30), somewhere(30), {0, 1, 0}));
        gpu_scene::LampList list;
        list.lamps = {{.intensity = 100, .axis = glm::normalize(glm::vec3(somewhere(1)))}};
        list.lamps[0].lobe_a = i % 2 ? 4 : 2, list.lamps[0].lobe_b = i % 2 ? -3 : 0;
        list.counts = {uint32_t(i % 2), uint32_t(1 - i % 2), 0, 0};
        const render::ShadowMapLayout layout{.side = 16u << i % 3u, .zoom = 1, .range = 100, .radius = 0.01f};
        const render::IsCaster is_caster({0, somewhere(30), layout, 0.1}, list, view, i % 5 != 0);
        const gpu_scene::WorldSphere group{somewhere(40), 8 + 7 * unit(random)};
        const double radius = group.radius * (0.5 + 0.4 * unit(random));
        const glm::dvec3 aside = (group.radius - radius) * glm::normalize(somewhere(1));
        const bool casts = is_caster({group.centre + aside, radius});
        ASSERT_TRUE(is_caster(group) || !casts) << i;
        empty += is_caster(group) ? 0 : 1, cast += casts ? 1 : 0;
    }
    EXPECT_GT(empty, 4000u) << "they leave something out";
    EXPECT_GT(cast, 1000u);
}

}  // namespace
}  // namespace vesper::test::casters_test
