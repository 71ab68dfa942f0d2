// The reference of daylight in tunnels against closed forms and sums. SPDX-License-Identifier: MIT
#include "passes/daylight_reference.h"

#include <tuple>

#include <gtest/gtest.h>

namespace vesper::test::daylight_reference_test {
namespace {

using glm::dvec3;
constexpr double kPi = std::numbers::pi;
const scene::Tunnel kTunnel{{0, 0, -10}, {0, 0, -110}, 14, 5};

// Howell's catalogue, B-4: an element below the corner of a parallel rectangle a x b at distance c.
TEST(DaylightReference, AParallelRectangleHasItsClosedForm) {
    for (const auto& [a, b, c] : {std::tuple(1.0, 2.0, 1.0), {14.0, 5.0, 3.0}, {0.1, 0.1, 5.0}}) {
        const double x = a / c, y = b / c, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
        const double expected = (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
        EXPECT_NEAR(reference::polygon_form_factor({{0, 0, c}, {a, 0, c}, {a, b, c}, {0, b, c}}, {0, 0, 1}), expected,
                    1e-12);
    }
}

// A rectangle through the horizon: half of it counts. And one below it: none.
TEST(DaylightReference, TheHorizonCuts) {
    const std::vector<dvec3> across{{-3, -2, -4}, {3, -2, -4}, {3, 2, -4}, {-3, 2, -4}},
        upper{{-3, 0, -4}, {3, 0, -4}, {3, 2, -4}, {-3, 2, -4}};
    EXPECT_NEAR(reference::polygon_form_factor(across, {0, 1, 0}), reference::polygon_form_factor(upper, {0, 1, 0}),
                1e-12);
    EXPECT_EQ(reference::polygon_form_factor({{-3, -2, -4}, {3, -2, -4}, {3, -1, -4}}, {0, 1, 0}), 0);
}

// Against a sum of cos cos' dA / (pi d^2) over both ends.
TEST(DaylightReference, IsTheSumOverBothEnds) {
    for (const auto& [position, n] : {std::pair(dvec3(1.5, 0, -14), dvec3(0, 1, 0)),
                                      {dvec3(-6.9, 2, -30), dvec3(1, 0, 0)},
                                      {dvec3(2, 1, -60), glm::normalize(dvec3(0.2, 0.5, 0.8))}}) {
        double sum = 0;
        constexpr int kCells = 400;
        for (const double z : {-10.0, -110.0})
            for (int i = 0; i < kCells; ++i)
                for (int k = 0; k < kCells; ++k) {
                    const dvec3 to = dvec3(14 * ((i + 0.5) / kCells - 0.5), 5 * (k + 0.5) / kCells, z) - position;
                    const double d2 = glm::dot(to, to);
                    sum += std::max(0.0, glm::dot(n, to)) * std::abs(to.z) / (kPi * d2 * d2) * (14.0 / kCells) *
                           (5.0 / kCells);
                }
        EXPECT_NEAR(reference::daylight_part({kTunnel}, position, n) / sum, 1, 1e-3);
    }
}

// In the open everything counts. Just inside, a wall that faces out sees the end all around it; deep inside little is
// left.
TEST(DaylightReference, FadesIntoTheTunnel) {
    const auto floor = [](double z) { return reference::daylight_part({kTunnel}, {0, 0, z}, {0, 1, 0}); };
    EXPECT_EQ(floor(-9.9), 1);
    EXPECT_EQ(floor(-110.1), 1);
    EXPECT_EQ(reference::daylight_part({kTunnel}, {0, 8, -50}, {0, 1, 0}), 1);
    EXPECT_NEAR(reference::daylight_part({kTunnel}, {0, 2.5, -10.001}, {0, 0, 1}), 1, 1e-3);
    EXPECT_NEAR(floor(-10.001), 0.5, 0.01);
    double last = 1;
    for (double z = -10.5; z > -60; z -= 0.5) {
        EXPECT_LT(floor(z), last);
        last = floor(z);
    }
    EXPECT_LT(last, 0.002);
}

}  // namespace
}  // namespace vesper::test::daylight_reference_test
