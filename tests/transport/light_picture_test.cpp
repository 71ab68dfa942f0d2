// Light of many points: closed forms, and errors that have nothing in common. SPDX-License-Identifier: MIT
#include "transport/light_picture.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/luminance.h"
#include "support/rooms.h"

namespace vesper::test::light_picture_test {
namespace {

using glm::dvec3, transport::LightTracer, transport::LitPoint, transport::Origin, transport::PointLight;

constexpr double kPi = std::numbers::pi;

double lux_of(glm::vec3 rgb) { return luminance(dvec3(rgb)); }

std::vector<PointLight> traced(const scene::Scene& scene, const std::vector<LitPoint>& points, uint32_t paths,
                               uint64_t seed = 1) {
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    return transport::light_of(LightTracer(scene, world), points, {.paths = paths, .seed = seed});
}

/// A square of side 3 m and 100 cd/m^2 over the origin, 2 m high, that shines down.
scene::Scene square() {
    scene::Scene scene;
    add_rectangle(scene, add_material(scene, 0, 100), {-1.5f, 2, -1.5f}, {3, 0, 0}, {0, 0, 3});
    return scene;
}

/// E on the ground below it: from each corner of the point's foot L / 2 times the form factor of a rectangle whose
/// corner is over the point (Lambert 1760).
double of_square(double x, double z) {
    const auto corner = [](double a, double b) {
        const double p = std::sqrt(a * a + 4), q = std::sqrt(b * b + 4);
        return 100.0 / 2 * (a / p * std::atan(b / p) + b / q * std::atan(a / q));
    };
    return corner(1.5 - x, 1.5 - z) + corner(1.5 + x, 1.5 - z) + corner(1.5 - x, 1.5 + z) + corner(1.5 + x, 1.5 + z);
}

std::vector<LitPoint> ground(int side, double width) {
    std::vector<LitPoint> points;
    for (int i = 0; i < side * side; ++i)
        points.push_back(
            {{width * ((i % side + 0.5) / side - 0.5), 0, width * ((i / side + 0.5) / side - 0.5)}, {0, 1, 0}});
    return points;
}

TEST(LightPicture, IsTheLightOfASquareOnTheGround) {
    const std::vector<LitPoint> points = ground(40, 8);
    const std::vector<PointLight> light = traced(square(), points, 64);
    double off = 0, want = 0, variance = 0, chi = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const double here = of_square(points[i].point.x, points[i].point.z), found = lux_of(light[i][Origin::Emitters]);
        const double error = double(light[i].standard_error);
        EXPECT_NEAR(found, here, 6 * error + 1e-3 * here) << i;
        off += found - here, want += here, variance += error * error;
        chi += (found - here) * (found - here);
        EXPECT_EQ(lux_of(light[i].other()), found);
    }
    // 1,600 points of 64 paths: the mean within four of its own errors, which are below 0.3 %.
    EXPECT_NEAR(off, 0, 4 * std::sqrt(variance));
    EXPECT_LT(std::sqrt(variance), 3e-3 * want);
    // First directions are spread evenly: errors are what is stated or less.
    EXPECT_LT(chi, 1.3 * variance);
    EXPECT_GT(chi, 0.01 * variance);
}

TEST(LightPicture, AnEvenSkyGivesPiL) {
    scene::Scene scene;
    scene.sky_luminance = 3;
    for (const PointLight& light : traced(scene, ground(9, 100), 16)) {
        EXPECT_NEAR(lux_of(light[Origin::Sky]), 3 * kPi, 1e-5);
        EXPECT_EQ(lux_of(light.other()), lux_of(light[Origin::Sky]));
    }
}

TEST(LightPicture, OtherLightIsWithoutLamps) {
    scene::Scene scene = square();
    add_lamp(scene, 40, {0, 1, 0});
    const PointLight light = traced(scene, {{{0, 0, 0}, {0, 1, 0}}}, 256)[0];
    EXPECT_NEAR(lux_of(light[Origin::Lamps]), 40, 1e-4);
    EXPECT_NEAR(lux_of(light.other()), of_square(0, 0), 5 * double(light.standard_error));
}

// Up to 64 points are the work of one thread.
TEST(LightPicture, TheNumberOfThreadsChangesNothing) {
    const std::vector<LitPoint> points = ground(20, 6);
    const std::vector<PointLight> all = traced(square(), points, 16);
    for (const size_t size : {1u, 64u, 200u}) {
        const std::vector<PointLight> some = traced(square(), {points.begin(), points.begin() + ptrdiff_t(size)}, 16);
        for (size_t i = 0; i < size; ++i) {
            EXPECT_EQ(some[i].lux, all[i].lux);
            EXPECT_EQ(some[i].standard_error, all[i].standard_error);
        }
    }
    EXPECT_NE(traced(square(), points, 16, 2)[0].lux, all[0].lux);
}

// One place many times: errors of neighbours in a row, and of those below each other, are not alike.
TEST(LightPicture, ErrorsOfNeighboursHaveNothingInCommon) {
    constexpr size_t kWidth = 64;
    const std::vector<PointLight> light =
        traced(square(), std::vector<LitPoint>(kWidth * kWidth, LitPoint{{1.2, 0, 0.7}, {0, 1, 0}}), 8);
    std::vector<double> errors;
    double mean = 0, squares = 0;
    for (const PointLight& here : light) mean += lux_of(here.other()) / double(light.size());
    for (const PointLight& here : light) errors.push_back(lux_of(here.other()) - mean);
    for (const double error : errors) squares += error * error / double(errors.size());
    ASSERT_GT(squares, 0);
    for (const size_t step : {size_t(1), size_t(2), kWidth, kWidth + 1}) {
        double product = 0;
        for (size_t i = 0; i + step < errors.size(); ++i) product += errors[i] * errors[i + step];
        const auto pairs = double(errors.size() - step);
        EXPECT_NEAR(product / pairs / squares, 0, 4 / std::sqrt(pairs)) << step;
    }
}

TEST(LightPicture, PointsWithoutSurfaceHaveNone) {
    std::vector<LitPoint> points = ground(3, 1);
    points[4] = {};
    const std::vector<PointLight> light = traced(square(), points, 16);
    EXPECT_EQ(light[4].lux, PointLight{}.lux);
    EXPECT_GT(lux_of(light[5].other()), 1);
    EXPECT_TRUE(traced(square(), {}, 16).empty());
}

TEST(LightPicture, EndsWhereProgressSaysSo) {
    const scene::Scene scene = square();
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    const LightTracer tracer(scene, world);
    const std::vector<LitPoint> points = ground(30, 4);
    EXPECT_TRUE(transport::light_of(tracer, points, {.paths = 4}, [](double) { return false; }).empty());
    double last = 0;
    EXPECT_EQ(transport::light_of(tracer, points, {.paths = 4},
                                  [&](double share) {
                                      EXPECT_GE(share, last);
                                      last = share;
                                      return share <= 1;
                                  })
                  .size(),
              points.size());
    EXPECT_GT(last, 0);
}

}  // namespace
}  // namespace vesper::test::light_picture_test
