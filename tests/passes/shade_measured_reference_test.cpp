// The reference of measured lamps and roads against what CIE 144 and the square law say. SPDX-License-Identifier: MIT
#include <numbers>

#include <gtest/gtest.h>

#include "passes/shade_reference.h"

namespace vesper::reference::shade_measured_reference_test {
namespace {

const dvec3 kUp(0, 1, 0);

/// The direction at which an observer sees the road `degrees` below the horizon, looking along -Z: from the point to
/// the eye.
dvec3 sight(double degrees) { return {0, std::sin(glm::radians(degrees)), std::cos(glm::radians(degrees))}; }

TEST(ShadeMeasuredReference, ARoadSeenAtOneDegreeHasTheTablesLuminance) {
    const photometry::ReflectionTable table = photometry::find_reflection_table("R3");
    const double height = 8, candela = 3000;
    for (dvec3 lamp : {dvec3(0, height, 0), {3, height, -20}, {-6, height, -40}, {2, height, 25}}) {
        const double d2 = glm::dot(lamp, lamp), tan_gamma = std::hypot(lamp.x, lamp.z) / height;
        // From the observer on is -Z, so a lamp beyond the point is at beta 0.
        const double beta = glm::degrees(std::atan2(std::abs(lamp.x), -lamp.z));
        const double luminance =
            candela / d2 * road_coefficient(photometry::extended(table), kUp, glm::normalize(lamp), sight(1));
        EXPECT_NEAR(luminance,
                    photometry::reduced_luminance_coefficient(table, tan_gamma, beta) * candela / (height * height),
                    1e-9);
    }
}

TEST(ShadeMeasuredReference, BeyondTheTableItsLastValueStays) {
    const photometry::ReflectionTable table = photometry::extended(photometry::find_reflection_table("R3"));
    const auto at = [&](double tan_gamma) {
        return road_coefficient(table, kUp, glm::normalize(dvec3(0, 1, -tan_gamma)), sight(1));
    };
    EXPECT_NEAR(at(12), photometry::reduced_luminance_coefficient(table, 12, 0) * 145, 1e-6);
    EXPECT_NEAR(at(40), at(12), 1e-9);
}

TEST(ShadeMeasuredReference, SheenIsGoneAtTenDegrees) {
    const photometry::ReflectionTable table = photometry::extended(photometry::find_reflection_table("W4"));
    const auto at = [&](double degrees, double beta) {
        const double b = glm::radians(beta);
        return road_coefficient(table, kUp, glm::normalize(dvec3(5 * std::sin(b), 1, -5 * std::cos(b))),
                                sight(degrees));
    };
    EXPECT_GT(at(1, 0), 10 * at(1, 90));
    EXPECT_NEAR(at(1.5, 0), at(0.6, 0), 1e-12);
    EXPECT_NEAR(at(10, 0), at(1, 90), 1e-9);
    EXPECT_NEAR(at(30, 180), at(1, 90), 1e-9);
    EXPECT_LT(at(4, 0), at(2, 0));
    // Of narrow lobes and wide ones, dark and bright ones alike.
    for (const double beta : {0.0, 7.0, 30.0, 140.0})
        EXPECT_NEAR(at(3, beta), std::lerp(at(10, beta), at(1, beta), sheen_seen(std::sin(glm::radians(3.0)))), 1e-9);
    EXPECT_NEAR(sheen_seen((std::sin(glm::radians(1.5)) + std::sin(glm::radians(10.0))) / 2), 0.5, 1e-12);
}

// A sky of 1 cd/m^2, as ambient light and as lamps from every half degree.
TEST(ShadeMeasuredReference, LightFromAllSidesIsTheSumOfItsDirections) {
    for (const char* name : {"R3", "W4"}) {
        const RoadSurface road(photometry::extended(photometry::find_reflection_table(name)));
        const double plain = photometry::diffuse_luminance_coefficient(photometry::without_sheen(road.table)) /
                             photometry::diffuse_luminance_coefficient(road.table);
        EXPECT_LT(plain, 0.7);
        for (const double degrees : {1.0, 3.0, 6.0, 20.0}) {
            const double step = glm::radians(0.5);
            double luminance = 0;
            for (double gamma = step / 2; gamma < std::numbers::pi / 2; gamma += step)
                for (double beta = step / 2; beta < std::numbers::pi; beta += step)
                    luminance += 2 * step * step * std::sin(gamma) *
                                 road_coefficient(road.table, kUp,
                                                  {std::sin(gamma) * std::sin(beta), std::cos(gamma),
                                                   -std::sin(gamma) * std::cos(beta)},
                                                  sight(degrees));
            EXPECT_NEAR(
                luminance / std::numbers::pi / (road.diffuse * road_in_diffuse(plain, std::sin(glm::radians(degrees)))),
                1, 3e-3)
                << name << " " << degrees;
        }
    }
}

TEST(ShadeMeasuredReference, ALampsFrameTurnsWithIt) {
    photometry::Distribution d;
    d.horizontal = {0, 180, 360}, d.vertical = {0, 90}, d.candela = {10, 20, 10, 40, 10, 20};
    // Its nadir looks along the view, its C0 up.
    const MeasuredLamp lamp{&d, glm::dmat3(dvec3(0, 1, 0), dvec3(-1, 0, 0), dvec3(0, 0, 1)), 2};
    EXPECT_NEAR(lamp.intensity({0, 0, -1}), 20, 1e-12);
    EXPECT_NEAR(lamp.intensity({0, 1, 0}), 40, 1e-9);
    EXPECT_NEAR(lamp.intensity({0, -1, 0}), 80, 1e-9);
    EXPECT_NEAR(lamp.intensity({0, 0, 1}), 0, 1e-12);
}

}  // namespace
}  // namespace vesper::reference::shade_measured_reference_test
