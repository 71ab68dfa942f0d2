// The distributions of data/photometry: the limits of UN Regulation No. 112 for a class B passing beam (right-hand
// traffic), and what a road luminaire should be like. SPDX-License-Identifier: MIT
#include <algorithm>

#include "photometry/distributions.h"
#include "places.h"

namespace vesper::test {
namespace {

using photometry::intensity;

const std::filesystem::path kData = std::filesystem::path(VESPER_SOURCE_DIR) / "data" / "photometry";

class LowBeam : public testing::Test {
protected:
    const photometry::Distribution beam_ = photometry::read_distribution(kData / "low-beam.csv");
    double at(double h, double v) const { return intensity(beam_, type_a(h, v)); }
    /// Least and largest intensity over a rectangle.
    std::pair<double, double> range(double left, double right, double bottom, double top) const {
        double least = 1e9, largest = 0;
        for (double h = left; h <= right + 1e-9; h += 0.05)
            for (double v = bottom; v <= top + 1e-9; v += 0.02)
                least = std::min(least, at(h, v)), largest = std::max(largest, at(h, v));
        return {least, largest};
    }
};

TEST_F(LowBeam, KeepsTheLimitsAtThePointsOfR112) {
    constexpr double kNone = 1e9;
    const struct {
        const char* point;
        double h, v, least, largest;
    } rows[] = {
        {"B50L", -3.43, 0.57, 0, 350},   {"BR", 2.5, 1.0, 0, 1750},       {"75R", 1.15, -0.57, 10100, kNone},
        {"75L", -3.43, -0.57, 0, 10600}, {"50L", -3.43, -0.86, 0, 13200}, {"50R", 1.72, -0.86, 10100, kNone},
        {"50V", 0, -0.86, 5100, kNone},  {"25L", -9, -1.72, 1700, kNone}, {"25R", 9, -1.72, 1700, kNone},
        {"P7", -8, 0, 65, kNone},        {"P8", -4, 0, 125, kNone},
    };
    for (const auto& row : rows) {
        EXPECT_GE(at(row.h, row.v), row.least) << row.point;
        EXPECT_LE(at(row.h, row.v), row.largest) << row.point;
    }
    EXPECT_GE(at(-8, 4) + at(0, 4) + at(8, 4), 190);  // overhead signs: P1 + P2 + P3
    EXPECT_GE(at(-4, 2) + at(0, 2) + at(4, 2), 375);  // P4 + P5 + P6
}

TEST_F(LowBeam, KeepsTheLimitsInTheZonesOfR112) {
    // Zone III above the cut-off: (8L,1U) (8L,4U) (8R,4U) (8R,2U) (6R,1.5U) (1.5R,1.5U) (0,0) (4L,0).
    const auto floor = [](double h) {
        if (h <= -4) return (-4 - h) / 4;
        if (h <= 0) return 0.0;
        if (h <= 1.5) return h;
        return h <= 6 ? 1.5 : 1.5 + (h - 6) / 4;
    };
    for (double h = -8; h <= 8; h += 0.05)
        for (double v = floor(h); v <= 4; v += 0.02) EXPECT_LE(at(h, v), 625) << h << " " << v;
    EXPECT_GE(range(-5.15, 5.15, -1.72, -0.86).first, 2500);         // zone IV
    EXPECT_LE(range(-9, 9, -4, -1.72).second, 2 * at(1.72, -0.86));  // zone I: twice the value at 50R
}

TEST_F(LowBeam, HasItsCutOffAndFlux) {
    // The cut-off on the left is where the logarithm of intensity falls fastest: 0.57 deg below the horizontal.
    double steepest = 0, where = 0;
    for (double v = -1.5; v < 0.5; v += 0.01) {
        const double fall = at(-2.5, v - 0.05) - at(-2.5, v + 0.05);
        if (fall > steepest) steepest = fall, where = v;
    }
    EXPECT_NEAR(where, -0.57, 0.12);
    EXPECT_NEAR(photometry::luminous_flux(beam_), 403, 1);
    EXPECT_NEAR(photometry::largest_intensity(beam_), 28150, 10);
    EXPECT_LT(at(2.5, 1.0), 400);
    const photometry::Distribution left_hand = photometry::mirrored(beam_);
    EXPECT_NEAR(intensity(left_hand, type_a(3.43, 0.57)), at(-3.43, 0.57), 1e-6);
}

TEST(HighBeam, IsStrongAhead) {
    const photometry::Distribution beam = photometry::read_distribution(kData / "high-beam.csv");
    EXPECT_NEAR(photometry::largest_intensity(beam), 57000, 1);
    EXPECT_NEAR(photometry::luminous_flux(beam), 724.7, 1);
    const auto at = [&](double h) { return intensity(beam, type_a(h, 0)); };
    // UN R149, table 5, class B: I_M >= 40 500 cd, HV >= 0.8 I_M, 2.5 deg >= 20 300, 5 deg >= 5 100, I_M <= 215 000.
    EXPECT_GE(at(0), 0.8 * photometry::largest_intensity(beam));
    EXPECT_GE(photometry::largest_intensity(beam), 40500);
    for (const double side : {-1.0, 1.0}) {
        EXPECT_GE(at(side * 2.5), 20300);
        EXPECT_GE(at(side * 5), 5100);
    }
}

// UN R19, class F3 (03 series, 6.4.3): lines 1 to 9 and zone D.
TEST(FrontFog, KeepsTheLimitsOfR19) {
    const photometry::Distribution lamp = photometry::read_distribution(kData / "front-fog.csv");
    const auto at = [&](double h, double v) { return intensity(lamp, type_a(h, v)); };
    const std::pair<double, double> above[]{{8, 90}, {4, 105}, {2, 170}, {1, 250}};
    for (const auto& [v, most] : above)
        for (double h = -26; h <= 26; h += 0.5) EXPECT_LE(at(h, v), most) << h << " " << v;
    double largest = 0;
    for (double h = -10; h <= 10; h += 0.5) {
        EXPECT_LE(at(h, 0), 340) << h;
        EXPECT_GE(at(h, -2.5), 2000) << h;
        largest = std::max(largest, at(h, -2.5));
        for (double v = -3.5; v <= -1.5; v += 0.1) EXPECT_LE(at(h, v), 8400) << h << " " << v;
    }
    for (double h = -10; h <= 10; h += 0.5) EXPECT_LT(at(h, -6), largest / 2) << h;
    for (const double side : {-1.0, 1.0}) {
        for (double v = -3.5; v <= -1.5; v += 0.1) EXPECT_GE(at(22 * side, v), 800) << v;
        for (double v = -4.5; v <= -1.5; v += 0.1) EXPECT_GE(at(35 * side, v), 320) << v;
    }
    EXPECT_NEAR(photometry::luminous_flux(lamp), 223.9, 0.5);
}

TEST(StreetLamp, LightsTheRoad) {
    const photometry::Distribution lamp = photometry::read_distribution(kData / "street-lamp.ies");
    EXPECT_EQ(lamp.goniometry, photometry::Goniometry::CGamma);
    EXPECT_NEAR(photometry::luminous_flux(lamp), 8000, 10);
    double best = 0, best_c = 0, best_gamma = 0;
    for (size_t h = 0; h < lamp.horizontal.size(); ++h)
        for (size_t v = 0; v < lamp.vertical.size(); ++v)
            if (lamp.at(h, v) > best) best = lamp.at(h, v), best_c = lamp.horizontal[h], best_gamma = lamp.vertical[v];
    EXPECT_GE(best_gamma, 60);
    EXPECT_LE(best_gamma, 68);
    EXPECT_GE(std::min(best_c, 180 - best_c), 10);
    EXPECT_LE(std::min(best_c, 180 - best_c), 25);
    EXPECT_GT(best, 4000);
    EXPECT_LT(best, 7000);
    for (double c = 0; c < 360; c += 7) {
        EXPECT_EQ(intensity(lamp, c_gamma(c, 90)), 0);
        EXPECT_LT(intensity(lamp, c_gamma(c, 80)), 100 * 8);  // 100 cd/klm: glare class G3 of EN 13201-2
        EXPECT_NEAR(intensity(lamp, c_gamma(c, 45)), intensity(lamp, c_gamma(180 - c, 45)), 0.2);
    }
    EXPECT_LT(intensity(lamp, c_gamma(270, 45)), 0.1 * intensity(lamp, c_gamma(90, 45)));
}

}  // namespace
}  // namespace vesper::test
