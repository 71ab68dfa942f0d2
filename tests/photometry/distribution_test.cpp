// Intensity and flux of distributions against closed forms. SPDX-License-Identifier: MIT
#include "photometry/distribution.h"

#include <algorithm>
#include <tuple>

#include "photometry/distributions.h"

namespace vesper::test {
namespace {

using photometry::Distribution, photometry::Goniometry, photometry::intensity, photometry::luminous_flux;

const std::vector<double> kGammas = steps(0, 180, 5), kPlanes = steps(0, 360, 15);

/// Flux by brute force over directions, independent of the goniometry's angles.
double counted_flux(const Distribution& d) {
    double sum = 0;
    constexpr int kRows = 1000, kColumns = 1000;
    for (int i = 0; i < kRows; ++i)
        for (int j = 0; j < kColumns; ++j) {
            const double z = -1 + 2 * (i + 0.5) / kRows, turn = 2 * kPi * (j + 0.5) / kColumns;
            const double r = std::sqrt(1 - z * z);
            sum += intensity(d, {r * std::cos(turn), r * std::sin(turn), z});
        }
    return sum * 4 * kPi / (kRows * kColumns);
}

TEST(Distribution, FluxOfAnIsotropicLampIsFourPi) {
    const auto one = [](double, double) { return 100.0; };
    for (const auto& [goniometry, h, v] :
         {std::tuple(Goniometry::CGamma, steps(0, 0, 1), kGammas), std::tuple(Goniometry::CGamma, kPlanes, kGammas),
          std::tuple(Goniometry::TypeA, steps(-180, 180, 10), steps(-90, 90, 10)),
          std::tuple(Goniometry::TypeB, steps(-90, 90, 10), steps(-180, 180, 10))})
        EXPECT_NEAR(luminous_flux(tabulate(goniometry, h, v, one)), 400 * kPi, 1e-9);
}

TEST(Distribution, FluxIsExactForALinearRampInGamma) {
    // I = gamma (rad): the integral of gamma sin gamma over [0, pi] is pi.
    const auto ramp = [](double, double gamma) { return gamma * kRadiansPerDegree; };
    EXPECT_NEAR(luminous_flux(tabulate(Goniometry::CGamma, {0}, {0, 45, 46, 180}, ramp)), 2 * kPi * kPi, 1e-12);
    EXPECT_NEAR(luminous_flux(tabulate(Goniometry::CGamma, kPlanes, {0, 180}, ramp)), 2 * kPi * kPi, 1e-11);
    // I = 1 + |V| (rad) about the equator: the integral of (1 + V) cos V over [0, pi/2] is pi/2.
    const auto wedge = [](double, double v) { return 1 + std::abs(v) * kRadiansPerDegree; };
    EXPECT_NEAR(luminous_flux(tabulate(Goniometry::TypeA, {-180, 0, 180}, {-90, 0, 90}, wedge)), 2 * kPi * kPi, 1e-12);
    const auto turned = [](double h, double) { return 1 + std::abs(h) * kRadiansPerDegree; };
    EXPECT_NEAR(luminous_flux(tabulate(Goniometry::TypeB, {-90, 0, 90}, {-180, 180}, turned)), 2 * kPi * kPi, 1e-12);
}

TEST(Distribution, FluxConvergesToCosinePowers) {
    for (const double n : {1.0, 2.0, 20.0}) {
        const auto lobe = [n](double, double gamma) {
            return gamma < 90 ? 1000 * std::pow(std::cos(gamma * kRadiansPerDegree), n) : 0.0;
        };
        const double wanted = 2 * kPi * 1000 / (n + 1);
        EXPECT_NEAR(luminous_flux(tabulate(Goniometry::CGamma, {0}, steps(0, 180, 0.5), lobe)), wanted, 2e-4 * wanted);
    }
    // The same Lambertian lamp on each goniometer.
    const auto a = [](double h, double v) { return std::max(0.0, -type_a(h, v).z); };
    const auto b = [](double h, double v) { return std::max(0.0, -type_b(h, v).z); };
    EXPECT_NEAR(luminous_flux(tabulate(Goniometry::TypeA, steps(-90, 90, 1), steps(-90, 90, 1), a)), kPi, 2e-4);
    EXPECT_NEAR(luminous_flux(tabulate(Goniometry::TypeB, steps(-90, 90, 1), steps(-90, 90, 1), b)), kPi, 2e-4);
}

TEST(Distribution, FluxIsTheIntegralOfIntensity) {
    const auto uneven = [](double h, double v) {
        return 50 + 30 * std::sin(h * kRadiansPerDegree) + 20 * std::cos(v * 0.05);
    };
    for (const auto& [goniometry, h, v] :
         {std::tuple(Goniometry::CGamma, kPlanes, std::vector<double>{0, 30, 70, 71, 110}),
          std::tuple(Goniometry::TypeA, std::vector<double>{-100, -3, 0, 40}, std::vector<double>{-20, 5, 60}),
          std::tuple(Goniometry::TypeB, std::vector<double>{-50, -3, 0, 40}, std::vector<double>{-120, 5, 60})}) {
        const Distribution d = tabulate(goniometry, h, v, uneven);
        EXPECT_NEAR(luminous_flux(d), counted_flux(d), 3e-3 * luminous_flux(d));
    }
}

TEST(Distribution, NamesDirectionsAsTheFrameDoes) {
    const auto index = [](double h, double v) { return 1000 * (h + 200) + v + 200; };
    const Distribution c =
        tabulate(Goniometry::CGamma, kPlanes, kGammas, [](double h, double v) { return std::fmod(h, 360) + 1000 * v; });
    for (const double gamma : {5.0, 60.0, 90.0, 175.0})
        for (const double plane : {0.0, 15.0, 90.0, 195.0, 345.0})
            EXPECT_NEAR(intensity(c, 3.0 * c_gamma(plane, gamma)), plane + 1000 * gamma, 1e-6);
    EXPECT_NEAR(intensity(tabulate(Goniometry::CGamma, {0}, kGammas, index), {0, 0, -1}), 200'200, 1e-9);
    const Distribution a = tabulate(Goniometry::TypeA, steps(-90, 90, 5), steps(-45, 45, 5), index);
    const Distribution b = tabulate(Goniometry::TypeB, steps(-45, 45, 5), steps(-90, 90, 5), index);
    for (const double h : {-45.0, -10.0, 0.0, 35.0})
        for (const double v : {-45.0, -5.0, 0.0, 20.0}) {
            EXPECT_NEAR(intensity(a, type_a(h, v)), index(h, v), 1e-6);
            EXPECT_NEAR(intensity(b, type_b(h, v)), index(h, v), 1e-6);
        }
    EXPECT_EQ(intensity(a, {0, 0, 0}), 0);
}

TEST(Distribution, IsBilinearPeriodicAndDarkOutside) {
    const Distribution d = tabulate(Goniometry::CGamma, {0, 90, 180, 270, 360}, {0, 60, 90},
                                    [](double c, double gamma) { return std::fmod(c, 360) / 90 + gamma; });
    EXPECT_NEAR(intensity(d, c_gamma(45, 30)), 0.5 + 30, 1e-9);
    EXPECT_NEAR(intensity(d, c_gamma(315, 75)), 1.5 + 75, 1e-9);  // between 270 (3) and 360 (0)
    EXPECT_NEAR(intensity(d, c_gamma(0, 90)), 90, 1e-6);
    EXPECT_EQ(intensity(d, c_gamma(0, 91)), 0);
    const Distribution a = tabulate(Goniometry::TypeA, {-10, 10}, {-5, 5}, [](double, double) { return 1.0; });
    EXPECT_EQ(intensity(a, type_a(9, 4)), 1);
    for (const auto& outside : {type_a(10.5, 0), type_a(0, -5.5), type_a(180, 0)}) EXPECT_EQ(intensity(a, outside), 0);
}

TEST(Distribution, MirroringExchangesLeftAndRight) {
    const auto uneven = [](double h, double v) {
        return 300 + std::fmod(h, 360) + v * std::sin(h * kRadiansPerDegree + 1);
    };
    const auto check = [](const Distribution& d) {
        const Distribution other = photometry::mirrored(d);
        for (const auto& way : {type_a(7, 3), type_a(-8, -2), type_a(1, -30), c_gamma(200, 120), c_gamma(5, 60)})
            EXPECT_NEAR(intensity(other, way), intensity(d, {-way.x, way.y, way.z}), 1e-6);
        EXPECT_NEAR(luminous_flux(other), luminous_flux(d), 1e-9 * luminous_flux(d));
    };
    check(tabulate(Goniometry::TypeA, {-10, -5, 12, 20}, {-40, 0, 40}, uneven));
    check(tabulate(Goniometry::TypeB, {-10, -5, 12, 20}, {-40, 0, 40}, uneven));
    check(tabulate(Goniometry::CGamma, kPlanes, kGammas, [](double h, double v) {
        return 300 + 100 * std::cos(h * kRadiansPerDegree - 1) * std::sin(v * kRadiansPerDegree);
    }));
}

TEST(Distribution, AreaOfTheOpening) {
    EXPECT_NEAR((photometry::LuminousOpening{0.6, 0.2, 0, false}.area()), 0.12, 1e-12);
    EXPECT_NEAR((photometry::LuminousOpening{0.2, 0.2, 0, true}.area()), kPi * 0.01, 1e-12);
    EXPECT_EQ(photometry::LuminousOpening{}.area(), 0);
}

}  // namespace
}  // namespace vesper::test
