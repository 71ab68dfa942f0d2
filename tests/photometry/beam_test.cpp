// Widths, symmetry and cut-off of distributions of known shape. SPDX-License-Identifier: MIT
#include "photometry/beam.h"

#include <algorithm>

#include "photometry/distributions.h"
#include "places.h"

namespace vesper::test {
namespace {

using photometry::BeamSymmetry;

/// 1000 cd times cos^n of the angle to the nadir, below the horizontal.
photometry::Distribution cosine_lamp(double exponent) {
    return tabulate(photometry::Goniometry::CGamma, {0}, steps(0, 90, 0.25), [=](double, double g) {
        return 1000 * std::pow(std::cos(std::min(g, 89.9999) * kRadiansPerDegree), exponent);
    });
}

TEST(Beam, WidthsOfACosineLobe) {
    for (const double n : {1.0, 4.0, 30.0}) {
        const photometry::Cut cut = photometry::plane_cut(cosine_lamp(n), 0);
        ASSERT_EQ(cut.angle.size(), 2 * 361 - 1);
        for (const double share : {0.5, 0.1}) {
            const auto width = photometry::width_of(cut, share);
            ASSERT_TRUE(width);
            EXPECT_NEAR(width->angle(), 2 * std::acos(std::pow(share, 1 / n)) / kRadiansPerDegree, 0.02)
                << n << " " << share;
            EXPECT_NEAR(width->from, -width->to, 1e-9);
        }
    }
    EXPECT_FALSE(photometry::width_of({{0, 1}, {0, 0}}, 0.5));
    const auto all = photometry::width_of({{-5, 5}, {2, 2}}, 0.5);
    ASSERT_TRUE(all);
    EXPECT_EQ(all->angle(), 10);
}

TEST(Beam, FiguresOfALambertianLamp) {
    photometry::Distribution d = cosine_lamp(1);
    d.lamp_flux = 4000;
    const photometry::BeamFigures f = photometry::beam_figures(d);
    EXPECT_NEAR(f.flux, 1000 * kPi, 0.1);
    EXPECT_NEAR(f.output_ratio, kPi / 4, 1e-4);
    EXPECT_EQ(f.upward_share, 0);
    EXPECT_EQ(f.symmetry, BeamSymmetry::Rotational);
    EXPECT_EQ(f.largest_v, 0);
    EXPECT_NEAR(f.at_70_80_90_95[0], 1000 / kPi * std::cos(70 * kRadiansPerDegree), 0.1);
    EXPECT_NEAR(f.at_70_80_90_95[1], 1000 / kPi * std::cos(80 * kRadiansPerDegree), 0.1);
    EXPECT_EQ(f.glare_class, "G*6");
}

TEST(Beam, ClassesByTheirLimits) {
    // 100 cd everywhere below 85 deg, then `over` up to 100 deg.
    const auto lamp = [](double over) {
        return tabulate(photometry::Goniometry::CGamma, {0}, steps(0, 180, 1), [=](double, double g) {
            return g <= 85 ? 100 : g <= 100 ? over : 0;
        });
    };
    EXPECT_EQ(photometry::beam_figures(lamp(0)).glare_class, "G*1");  // 80 deg: 174 cd/klm
    EXPECT_EQ(photometry::beam_figures(lamp(100)).glare_class, "");
    EXPECT_GT(photometry::beam_figures(lamp(100)).upward_share, 0.1);
    // A full sphere: half the light is above.
    const auto sphere =
        tabulate(photometry::Goniometry::CGamma, {0}, steps(0, 180, 1), [](double, double) { return 100; });
    EXPECT_NEAR(photometry::beam_figures(sphere).upward_share, 0.5, 1e-9);
}

TEST(Beam, FindsSymmetries) {
    const auto lamp = [](double about_c0, double about_c90) {
        return tabulate(photometry::Goniometry::CGamma, steps(0, 360, 15), steps(0, 90, 5), [=](double c, double g) {
            return 100 + std::sin(g * kRadiansPerDegree) *
                             (20 * std::cos(2 * c * kRadiansPerDegree) + about_c90 * std::sin(c * kRadiansPerDegree) +
                              about_c0 * std::cos(c * kRadiansPerDegree));
        });
    };
    EXPECT_EQ(photometry::symmetry_of(lamp(0, 0)), BeamSymmetry::Quadrants);
    EXPECT_EQ(photometry::symmetry_of(lamp(30, 0)), BeamSymmetry::AboutC0);
    photometry::Distribution noisy = lamp(30, 0);
    for (size_t h = 0; h < noisy.horizontal.size(); ++h)
        noisy.candela[h * noisy.vertical.size()] += double(h % 3);  // nadir as each plane has measured it
    EXPECT_EQ(photometry::symmetry_of(noisy), BeamSymmetry::AboutC0);
    EXPECT_EQ(photometry::symmetry_of(lamp(0, 30)), BeamSymmetry::AboutC90);
    EXPECT_EQ(photometry::symmetry_of(lamp(30, 30)), BeamSymmetry::None);
    const auto beam = [](double skew) {
        return tabulate(photometry::Goniometry::TypeA, steps(-20, 20, 1), steps(-5, 5, 1),
                        [=](double h, double v) { return 1000 + skew * h + 10 * v - h * h; });
    };
    EXPECT_EQ(photometry::symmetry_of(beam(0)), BeamSymmetry::LeftRight);
    EXPECT_EQ(photometry::symmetry_of(beam(5)), BeamSymmetry::None);
}

TEST(Beam, OurLowBeamHoldsTheLimitsOfR112) {
    const photometry::Distribution beam =
        photometry::read_distribution(VESPER_SOURCE_DIR "/data/photometry/low-beam.csv");
    for (const photometry::BeamPoint& point : photometry::passing_beam_points()) {
        const double candela = photometry::intensity_at(beam, point.h, point.v);
        EXPECT_GE(candela, point.least) << point.name;
        if (point.most > 0) {
            EXPECT_LE(candela, point.most) << point.name;
        }
    }
    const photometry::BeamFigures f = photometry::beam_figures(beam);
    EXPECT_NEAR(f.largest, 28150, 50);
    EXPECT_NEAR(f.largest_h, 1.5, 0.3);
    EXPECT_NEAR(f.largest_v, -1.1, 0.2);
    EXPECT_EQ(f.glare_class, "");
}

}  // namespace
}  // namespace vesper::test
