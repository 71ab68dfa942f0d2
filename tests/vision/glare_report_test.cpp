// Veiling luminance, threshold increment and visibility read off pictures. SPDX-License-Identifier: MIT
#include "vision/glare_report.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "vision/visibility.h"

namespace vesper::test {
namespace {

using vision::report_glare;

struct Picture {
    vision::ImageAngles image{321, 201, {-0.6, -0.375}, {0.6, 0.375}};
    std::vector<float> rgba;

    explicit Picture(float luminance) {
        for (int i = 0; i < image.width * image.height; ++i)
            rgba.insert(rgba.end(), {luminance, luminance, luminance, 1});
    }
    void set(int x, int y, float value) {
        for (size_t c = 0; c < 3; ++c) rgba[4 * size_t(y * image.width + x) + c] = value;
    }
    glm::dvec3 towards(int x, int y) const { return glm::normalize(glm::dvec3(image.at(glm::dvec2(x, y) + 0.5), -1)); }
    double steradians(int x, int y) const { return image.pixel().x * image.pixel().y * std::pow(-towards(x, y).z, 3); }
};

TEST(GlareReport, LampsInAndBesideThePictureAddUp) {
    Picture picture(0.5f);
    picture.set(250, 60, 2e5f);
    const glm::dvec3 inside = picture.towards(250, 60), outside = glm::normalize(glm::dvec3(1, 0.2, -1));
    const vision::GlareReport report =
        report_glare(picture.image, picture.rgba, std::vector{vision::DazzlingLight{outside, 3}},
                     {.eye = {60, 0.5}, .source_luminance = 100});

    double want = 0, road = 0;
    for (const auto& [direction, lux] : {std::pair{inside, 2e5 * picture.steradians(250, 60)}, {outside, 3.0}}) {
        const double theta = std::acos(-direction.z) * kDegreesPerRadian, e = lux * -direction.z;
        want += e * (10 / std::pow(theta, 3) + (5 / (theta * theta) + 0.05 / theta) * (1 + std::pow(60 / 62.5, 4)) +
                     0.00125);
        road += e * 9.86 * (1 + std::pow(60 / 66.4, 4)) / (theta * theta);
    }
    // 1e-6: floats of the picture.
    EXPECT_NEAR(report.veil / want, 1, 1e-6);
    EXPECT_NEAR(report.road_veil / road, 1, 1e-6);
    EXPECT_NEAR(report.background, 0.5, 1e-6);
    EXPECT_NEAR(report.increment / (65 * road / std::pow(0.5, 0.8)), 1, 1e-6);
}

TEST(GlareReport, WhatIsLookedAtIsNoGlare) {
    Picture picture(1);
    picture.set(160, 100, 1e6f);  // in the middle
    const vision::GlareReport report = report_glare(picture.image, picture.rgba, {}, {.source_luminance = 100});
    EXPECT_EQ(report.veil, 0);
    EXPECT_GT(report.illuminance, 0);
    EXPECT_GT(report_glare(picture.image, picture.rgba, {}, {.gaze = {0.6, 0.5}, .source_luminance = 100}).veil, 0);
}

// What is a source follows from the picture, not from how it is shown: 100 times its log average.
TEST(GlareReport, SourcesStandOutFromThePicture) {
    Picture picture(0.5f);
    picture.set(250, 60, 49), picture.set(60, 60, 52);
    EXPECT_NEAR(report_glare(picture.image, picture.rgba, {}, {}).veil /
                    report_glare(picture.image, picture.rgba, {}, {.source_luminance = 50.01}).veil,
                1, 1e-12);
    EXPECT_LT(report_glare(picture.image, picture.rgba, {}, {}).veil,
              0.7 * report_glare(picture.image, picture.rgba, {}, {.source_luminance = 48}).veil);
}

// Half of the picture is a sky of nothing: the road is no source, the lamp above it is.
TEST(GlareReport, ABlackSkyMakesNoSourcesOfTheRoad) {
    Picture picture(1);
    for (int y = 0; y < picture.image.height / 2; ++y)
        for (int x = 0; x < picture.image.width; ++x) picture.set(x, y, 0);
    EXPECT_EQ(report_glare(picture.image, picture.rgba, {}, {}).illuminance, 0);
    EXPECT_NEAR(report_glare(picture.image, picture.rgba, {}, {}).background, 0.5, 0.05);
    picture.set(250, 60, 2e5f);
    EXPECT_GT(report_glare(picture.image, picture.rgba, {}, {}).veil, 0);
}

TEST(GlareReport, OnABlackRoadTheIncrementHasNoEnd) {
    Picture picture(0);
    EXPECT_EQ(report_glare(picture.image, picture.rgba, {}, {}).increment, 0);
    EXPECT_TRUE(std::isinf(report_glare(picture.image, picture.rgba,
                                        std::vector{vision::DazzlingLight{glm::normalize(glm::dvec3(1, 0, -4)), 3}}, {})
                               .increment));
}

TEST(GlareReport, NothingIsNotANumber) {
    Picture picture(0);
    picture.set(3, 3, std::numeric_limits<float>::quiet_NaN());
    picture.set(4, 3, std::numeric_limits<float>::infinity());
    const vision::GlareReport report =
        report_glare(picture.image, picture.rgba, std::vector{vision::DazzlingLight{{0, 0, 1}, 5}},
                     {.source_luminance = 1, .target = vision::MarkedTarget{{0.4, 0.4}, {0.1, 0.1}}});
    EXPECT_EQ(report.veil, 0);
    EXPECT_EQ(report.increment, 0);
    EXPECT_TRUE(std::isfinite(report.visibility));
}

// A headlamp beside a target takes most of its visibility.
TEST(GlareReport, GlareHidesATarget) {
    Picture picture(0.3f);
    for (int y = 98; y < 102; ++y)
        for (int x = 158; x < 162; ++x) picture.set(x, y, 0.6f);
    const vision::MarkedTarget target{{158.0 / 321, 98.0 / 201}, {4.0 / 321, 4.0 / 201}};
    const auto ask = [&] {
        return report_glare(picture.image, picture.rgba, {},
                            {.eye = {23, 0.5}, .source_luminance = 100, .target = target});
    };
    const vision::GlareReport free = ask();
    EXPECT_NEAR(free.target, 0.6, 1e-6);
    EXPECT_NEAR(free.around, 0.3, 1e-6);
    const double steradians = 16 * picture.steradians(160, 100);
    EXPECT_NEAR(free.visibility /
                    vision::visibility_level(
                        0.6, 0.3, {.size = 2 * std::sqrt(steradians / std::numbers::pi) * kDegreesPerRadian * 60}),
                1, 1e-3);
    picture.set(175, 99, float(2 / picture.steradians(175, 99)));  // 2 lx at 3.2 degrees
    const vision::GlareReport dazzled = ask();
    EXPECT_NEAR(dazzled.target_veil,
                2 * vision::cie_general_glare(
                        std::acos(glm::dot(picture.towards(175, 99),
                                           glm::normalize(glm::dvec3(picture.image.at({160, 100}), -1)))) *
                            kDegreesPerRadian,
                        {23, 0.5}),
                0.01);
    EXPECT_LT(dazzled.visibility, 0.5 * free.visibility);
}

TEST(GlareReport, RoadEquationHasItsRanges) {
    EXPECT_NEAR(vision::en13201_glare(10, 23), 0.1, 1e-3) << "10 / theta^2";
    EXPECT_NEAR(vision::en13201_glare(1, 62.5), 20, 1e-12);
    EXPECT_EQ(vision::en13201_glare(61, 23), 0);
    EXPECT_EQ(vision::en13201_glare(0.05, 23), 0);
}

}  // namespace
}  // namespace vesper::test
