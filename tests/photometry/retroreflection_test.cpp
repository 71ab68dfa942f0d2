// Retroreflection: tabulated values, and a sign in the headlamps. SPDX-License-Identifier: MIT
#include "photometry/retroreflection.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"

namespace vesper::test {
namespace {

using photometry::retroreflection;

// EN 12899-1, least R_A of new white sheets at an entrance angle of 5 degrees; ASTM D4956 type XI.
TEST(Retroreflection, ReproducesItsTables) {
    const photometry::Retroreflector ra1 = photometry::retroreflective_class("RA1"),
                                     ra2 = photometry::retroreflective_class("RA2"),
                                     xi = photometry::retroreflective_class("prismatic");
    EXPECT_NEAR(retroreflection(ra1, 0.2, 5), 70, 1e-9);
    EXPECT_NEAR(retroreflection(ra1, 0.33, 5), 50, 1e-9);
    EXPECT_NEAR(retroreflection(ra1, 2, 5), 5, 1e-9);
    EXPECT_NEAR(retroreflection(ra1, 0.2, 30), 30, 0.2);
    EXPECT_NEAR(retroreflection(ra2, 0.2, 5), 250, 1e-9);
    EXPECT_NEAR(retroreflection(ra2, 0.33, 5), 180, 1e-9);
    EXPECT_NEAR(retroreflection(ra2, 2, 5), 5, 1e-9);
    EXPECT_NEAR(retroreflection(ra2, 0.2, 30), 150, 1e-9);
    EXPECT_NEAR(retroreflection(xi, 0.5, 5), 420, 1e-9);
    EXPECT_NEAR(retroreflection(xi, 1, 0), 120, 1e-9);
    for (const photometry::Retroreflector& r : {ra1, ra2, xi}) {
        EXPECT_NO_THROW(photometry::check_retroreflector(r));
        EXPECT_EQ(retroreflection(r, 0.05, 0), retroreflection(r, 0.2, 5)) << "constant before the first angles";
        EXPECT_EQ(retroreflection(r, 0.2, 85), 0) << "nothing at grazing incidence";
        EXPECT_LT(retroreflection(r, 20, 5), 1e-6) << "nothing for the lamps of the street";
    }
    // Log-linear: half way between the logarithms.
    EXPECT_NEAR(retroreflection(ra1, 0.265, 5), std::sqrt(70.0 * 50), 1e-9);
}

// A white sign of class RA2 at 100 m, 500 cd towards it from each of two headlamps, seen half a degree from them: 0.05
// lx each and about 12 cd/m^2 in all.
TEST(Retroreflection, ASignInTheHeadlamps) {
    const double illuminance = 500.0 / (100 * 100);
    const photometry::Retroreflector ra2 = photometry::retroreflective_class("RA2");
    const double luminance = 2 * photometry::retroreflected_luminance(ra2, 0.5, 5, 5, illuminance);
    EXPECT_NEAR(luminance, 12, 1);
    EXPECT_NEAR(2 * photometry::retroreflected_luminance(photometry::rescaled(ra2, 1.5), 0.5, 5, 5, illuminance),
                1.5 * luminance, 1e-9);
    EXPECT_NEAR(photometry::retroreflected_luminance(ra2, 0.5, 5, 60, 1), 2 * retroreflection(ra2, 0.5, 5), 1e-9);
    EXPECT_NEAR(photometry::retroreflected_luminance(ra2, 0.5, 5, 89.9, 1), 20 * retroreflection(ra2, 0.5, 5), 1e-9);
}

// Beyond the last entrance angle the factor falls with the cosine, to nothing at 90 degrees.
TEST(Retroreflection, FallsBeyondItsEntranceAngles) {
    const photometry::Retroreflector own{"own", {0.2, 1}, {100, 10}, {5, 30}, {1, 0.4}, false};
    EXPECT_NEAR(retroreflection(own, 0.2, 30), 40, 1e-9);
    EXPECT_NEAR(retroreflection(own, 0.2, 60), 40 * 0.5 / std::sqrt(0.75), 1e-9);
    EXPECT_NEAR(retroreflection(own, 0.2, 90), 0, 1e-9);
    EXPECT_EQ(retroreflection(own, 0.2, 120), 0);
}

// EN 1436: L = R_L E at the geometry of 30 m, 1.05 degrees; no cosine of the view.
TEST(Retroreflection, AMarking) {
    const photometry::Retroreflector r3 = photometry::retroreflective_marking(150);
    EXPECT_NO_THROW(photometry::check_retroreflector(r3));
    EXPECT_NEAR(photometry::retroreflected_luminance(r3, 1.05, 88.76, 87.71, 2), 0.3, 1e-12);
    EXPECT_NEAR(photometry::retroreflected_luminance(r3, 2, 88.76, 10, 2), 0.3, 1e-12);
    EXPECT_NEAR(retroreflection(r3, 6, 80), 0.015, 1e-12);
    EXPECT_LT(retroreflection(r3, 60, 80), 1e-10);
}

TEST(Retroreflection, RefusesWhatCannotBe) {
    const photometry::Retroreflector good{"own", {0.2, 1}, {100, 10}, {0, 60}, {1, 0}, false};
    EXPECT_NO_THROW(photometry::check_retroreflector(good));
    const auto refused = [&](auto spoil) {
        photometry::Retroreflector bad = good;
        spoil(bad);
        EXPECT_THROW(photometry::check_retroreflector(bad), Error);
    };
    refused([](auto& r) { r.observation = {0.2}, r.coefficient = {100}; });
    refused([](auto& r) { r.observation = {1, 0.2}; });
    refused([](auto& r) { r.observation = {0.2, 91}; });
    refused([](auto& r) { r.coefficient = {10, 10}; });
    refused([](auto& r) { r.coefficient = {10, 0}; });
    refused([](auto& r) { r.coefficient = {std::nan(""), 1}; });
    refused([](auto& r) { r.coefficient = {10}; });
    refused([](auto& r) { r.entrance = {}, r.entrance_factor = {}; });
    refused([](auto& r) { r.entrance_factor = {1, 1.1}; });
    refused([](auto& r) { r.observation = {0, 1, 2, 3, 4, 5, 6, 7, 8}, r.coefficient = {9, 8, 7, 6, 5, 4, 3, 2, 1}; });
    EXPECT_THROW(photometry::retroreflective_class("RA9"), Error);
}

}  // namespace
}  // namespace vesper::test
