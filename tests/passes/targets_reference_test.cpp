// The reference of targets, by hand. SPDX-License-Identifier: MIT
#include "passes/targets_reference.h"

#include <numbers>

#include <gtest/gtest.h>

namespace vesper::reference::targets_reference_test {
namespace {

// A picture of `size` x `size` px that covers 90 degrees, with a square of `side` px at its middle.
TargetPicture square(int size, int side, double target, double around, double veil) {
    TargetPicture p{size, size, dvec2(2.0 / size, -2.0 / size), dvec2(-1, 1), {}, {}, {}};
    const int low = (size - side) / 2, high = low + side;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const bool in = x >= low && x < high && y >= low && y < high;
            p.target.push_back(in ? 1 : 0);
            p.scene.emplace_back(in ? target : around);
            p.retina.emplace_back((in ? target : around) + veil);
        }
    return p;
}

TEST(TargetsReference, AUniformSquareOnAUniformGround) {
    const TargetPicture p = square(100, 40, 3, 2, 0.5);
    const MeasuredTarget m = measure_target(p, 1, 10, 10, 90, 90);
    EXPECT_EQ(m.pixels, 40 * 40);
    EXPECT_EQ(m.inner, 38 * 38) << "without its border";
    EXPECT_EQ(m.around, 80 * 80 - 40 * 40 - 4 * 40) << "without those beside it, of which corners do not touch it";
    EXPECT_DOUBLE_EQ(m.luminance, 3);
    EXPECT_DOUBLE_EQ(m.around_scene, 2);
    EXPECT_NEAR(m.around_retina, 2.5, 1e-12);
    EXPECT_NEAR(glm::length(m.centre - dvec2(50)), 0, 1e-12);
    // The solid angle of a square of tangents +-a seen along its axis: 4 arcsin(a^2 / (1 + a^2)). A pixel is
    // (2 / 100)^2 of the plane; 1e-4: sums for integrals.
    const double a = 0.4;
    EXPECT_NEAR(m.solid_angle * 4e-4, 4 * std::asin(a * a / (1 + a * a)), 1e-4);
}

TEST(TargetsReference, EveryOtherPixelIsTheSameButForItsBorder) {
    const TargetPicture p = square(100, 40, 3, 2, 0.5);
    const MeasuredTarget m = measure_target(p, 1, 10, 10, 90, 90, 2);
    EXPECT_EQ(m.pixels, 20 * 20);
    EXPECT_EQ(m.inner, 19 * 19);
    EXPECT_NEAR(m.solid_angle, measure_target(p, 1, 10, 10, 90, 90).solid_angle, 0.1);
}

TEST(TargetsReference, SourcesAndDamagedPixelsDoNotCount) {
    TargetPicture p = square(9, 3, 3, 2, 0);
    p.scene[0] = dvec3(1e4), p.brightest = 1000;
    p.scene[1].g = std::nan(""), p.retina[2].b = HUGE_VAL;
    const MeasuredTarget m = measure_target(p, 1, 0, 0, 9, 9);
    EXPECT_EQ(m.around, 81 - 9 - 12 - 4) << "the source, two beside it, one more";
    EXPECT_DOUBLE_EQ(m.around_scene, 2);
    p.scene[40] = dvec3(1001);
    EXPECT_EQ(measure_target(p, 1, 0, 0, 9, 9).inner, 0) << "a lamp before it";
    p.scene[40].r = std::nan("");
    EXPECT_EQ(measure_target(p, 1, 0, 0, 9, 9).inner, 0) << "the only one within";
    EXPECT_EQ(measure_target(p, 1, 0, 0, 9, 9).pixels, 9);
    EXPECT_EQ(measure_target(p, 2, 0, 0, 9, 9).pixels, 0) << "there is no other";
}

TEST(TargetsReference, AGlareSourceIsAHundredTimesTheAverage) {
    EXPECT_NEAR(brightest_surroundings(std::vector<dvec3>(4, dvec3(50))), 5000, 1e-9);
    EXPECT_NEAR(brightest_surroundings({dvec3(20), dvec3(2000)}), 20000, 1e-9) << "the log average";
    EXPECT_NEAR(brightest_surroundings({dvec3(30), dvec3(HUGE_VAL)}), 3000, 1e-9);
    for (const double dark : {0.0, 0.002, 2.9})
        EXPECT_EQ(brightest_surroundings({dvec3(dark), dvec3(dark)}), 300) << "headlamps light so much";
}

}  // namespace
}  // namespace vesper::reference::targets_reference_test
