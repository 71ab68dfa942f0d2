// Published functions of light scattered in the eye: values, integrals, what they say of age and iris.
// SPDX-License-Identifier: MIT
#include "vision/glare.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

using vision::EyeScatter, vision::SpencerState;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Evaluated from the printed formulas by another program, to six digits.
struct Row {
    double theta, total24, total35, total70, general24, general70, age24, age70, photopic, mesopic, scotopic;
};
constexpr Row kTable[]{
    {0, 9.14656e+06, 9.09905e+06, 8.20788e+06, kNone, kNone, kNone, kNone, 2.27658e+06, 2.23482e+06, 2.02284e+06},
    {0.005, 2.93801e+06, 2.92281e+06, 2.63762e+06, kNone, kNone, kNone, kNone, 1.59718e+06, 1.55795e+06, 1.35507e+06},
    {0.02, 214299, 213264, 193846, kNone, kNone, kNone, kNone, 531117, 515754, 436301},
    {0.1, 11442.6, 11417.5, 10946.7, 10511.4, 11288, 1013.82, 2000, 6477.68, 6477.68, 6824.45},
    {0.3, 572.088, 573.97, 609.278, 427.305, 513.774, 112.646, 222.222, 402.552, 402.552, 451.317},
    {1, 18.851, 19.1244, 24.255, 15.1611, 22.9975, 10.1382, 20, 19.0177, 19.0177, 23.8174},
    {2.5, 1.6096, 1.65699, 2.54611, 1.47908, 2.75154, 1.62211, 3.2, 2.19724, 2.24737, 3.08698},
    {3, 1.0104, 1.04369, 1.66811, 0.956285, 1.84425, 1.12646, 2.22222, 1.4579, 8.4483, 16.4231},
    {5, 0.288458, 0.300824, 0.532812, 0.295816, 0.621689, 0.405527, 0.8, 0.475314, 0.475314, 0.673466},
    {10, 0.0601565, 0.0634232, 0.124706, 0.0674459, 0.152794, 0.101382, 0.2, 0.109408, 0.109408, 0.159144},
    {30, 0.00758544, 0.00801745, 0.0161216, 0.00899963, 0.0202069, 0.0112646, 0.0222222, 0.0114514, 0.0114514,
     0.0169924},
    {60, 0.00318038, 0.00331983, 0.00593587, 0.00356684, 0.00701523, 0.00281616, 0.00555556, 0.00281856, 0.00281856,
     0.00420473},
    {90, 0.00242674, 0.00251353, 0.00414175, 0.00246206, 0.00428204, 0.00125163, 0.00246914, 0.00124612, 0.00124612,
     0.00186234},
};

// 1e-5: the table has six digits.
void near(double got, double want, double theta) {
    if (std::isnan(want)) return;
    EXPECT_NEAR(got / want, 1, 1e-5) << "at " << theta << " degrees";
}

// The integral of the function times J0, in rings of a fiftieth of its angle; it is known to four digits, and the part
// from 30 degrees on changes its sign within a degree.
TEST(Glare, ModulationIsItsHankelTransform) {
    for (const vision::ScatteringEye& eye : {vision::ScatteringEye{23, 0.5}, vision::ScatteringEye{70, 1.2}})
        for (const double frequency : {0.1, 0.5, 2.0, 8.0, 30.0}) {
            double sum = 0;
            constexpr double kDegree = M_PI / 180;
            for (double theta = 1e-5; theta < 30;) {
                const double step = std::min(theta / 50, 0.02 / frequency), middle = theta + step / 2;
                sum += vision::cie_total_glare(middle, eye) * std::cyl_bessel_j(0, 2 * M_PI * frequency * middle) * 2 *
                       M_PI * middle * kDegree * step * kDegree;
                theta += step;
            }
            EXPECT_NEAR(vision::cie_modulation(frequency, eye), sum, 2e-3) << frequency;
        }
}

TEST(Glare, HasThePublishedValues) {
    for (const Row& r : kTable) {
        near(vision::cie_total_glare(r.theta, {24, 0.5}), r.total24, r.theta);
        near(vision::cie_total_glare(r.theta, {35, 0.5}), r.total35, r.theta);
        near(vision::cie_total_glare(r.theta, {70, 0.5}), r.total70, r.theta);
        near(vision::cie_general_glare(r.theta, {24, 0.5}), r.general24, r.theta);
        near(vision::cie_general_glare(r.theta, {70, 0.5}), r.general70, r.theta);
        near(vision::cie_age_adjusted_glare(r.theta, 24), r.age24, r.theta);
        near(vision::cie_age_adjusted_glare(r.theta, 70), r.age70, r.theta);
        near(vision::spencer_glare(r.theta, SpencerState::Photopic), r.photopic, r.theta);
        near(vision::spencer_glare(r.theta, SpencerState::Mesopic), r.mesopic, r.theta);
        near(vision::spencer_glare(r.theta, SpencerState::Scotopic), r.scotopic, r.theta);
    }
    EXPECT_DOUBLE_EQ(vision::cie_small_angle_glare(2, 40), vision::cie_general_glare(2, {40, 0}));
}

EyeScatter cie(double age, double pigmentation) {
    return EyeScatter([=](double theta) { return vision::cie_total_glare(theta, {age, pigmentation}); });
}

// The normalisation that CIE built in leaves 0.5 to 2.3 %.
TEST(Glare, TotalGlareIntegratesToWhatIsStated) {
    EXPECT_NEAR(cie(24, 0).total(), 1.005, 6e-4);
    EXPECT_NEAR(cie(24, 0.5).total(), 1.010, 6e-4);
    EXPECT_NEAR(cie(35, 0.5).total(), 1.011, 6e-4);
    EXPECT_NEAR(cie(70, 0.5).total(), 1.017, 6e-4);
    EXPECT_NEAR(cie(70, 1).total(), 1.023, 6e-4);
}

TEST(Glare, LightBeyondAnAngle) {
    // Of the function as given, three digits of another quadrature: what is beyond 0.017, 0.1, 1 and 10 degrees.
    const EyeScatter middle = cie(35, 0.5), old = cie(70, 0.5);
    const auto beyond = [](const EyeScatter& psf, double theta) { return psf.total() * (1 - psf.within(theta)); };
    EXPECT_NEAR(beyond(middle, 0.017), 0.704, 2e-3);
    EXPECT_NEAR(beyond(middle, 0.1), 0.324, 2e-3);
    EXPECT_NEAR(beyond(middle, 1), 0.078, 2e-3);
    EXPECT_NEAR(beyond(middle, 10), 0.033, 2e-3);
    EXPECT_NEAR(beyond(old, 0.017), 0.740, 3e-3);
    EXPECT_NEAR(beyond(old, 0.1), 0.389, 2e-3);
    EXPECT_NEAR(beyond(old, 1), 0.133, 2e-3);
    EXPECT_NEAR(beyond(old, 10), 0.063, 2e-3);
}

TEST(Glare, EveryPartOfSpencerIntegratesToOne) {
    EXPECT_NEAR(EyeScatter(vision::spencer_core).total(), 0.9991, 1e-4);
    EXPECT_NEAR(EyeScatter(vision::spencer_corona).total(), 0.9999, 1e-4);
    EXPECT_NEAR(EyeScatter(vision::spencer_bloom).total(), 0.9999, 1e-4);
    for (double nanometres : {450.0, 568.0, 700.0})
        EXPECT_NEAR(EyeScatter([=](double t) { return vision::spencer_halo(t, nanometres); }).total(), 1, 3e-4)
            << nanometres;
    for (SpencerState state : {SpencerState::Photopic, SpencerState::Mesopic, SpencerState::Scotopic}) {
        const vision::SpencerWeights w = vision::spencer_weights(state);
        EXPECT_NEAR(w.core + w.corona + w.bloom + w.halo, 1, 1e-12);
        EXPECT_NEAR(EyeScatter([=](double t) { return vision::spencer_glare(t, state); }).total(), 0.9996, 2e-4);
    }
}

TEST(Glare, WardScattersAnEighthAsTheSquareOfTheAngleFalls) {
    const EyeScatter psf(vision::ward_veil);
    EXPECT_NEAR(psf.total(), 1, 1e-6);
    EXPECT_NEAR(1 - psf.within(0.02), 0.08, 2e-5);  // 1.3e-5 of it is scattered within
    EXPECT_NEAR(psf(1) / psf(2), 4 * std::cos(1 * 3.14159265 / 180) / std::cos(2 * 3.14159265 / 180), 1e-6);
    EXPECT_NEAR(psf(0.1) / psf(0.4), 1, 1e-4);
}

TEST(Glare, TheHaloIsARingWhoseRadiusFollowsTheWavelength) {
    for (const auto& [nanometres, radius] : {std::pair{450.0, 2.38}, {530.0, 2.80}, {610.0, 3.22}}) {
        double brightest = 0;
        for (double t = 1; t < 5; t += 0.001)
            if (vision::spencer_halo(t, nanometres) > vision::spencer_halo(brightest, nanometres)) brightest = t;
        EXPECT_NEAR(brightest, radius, 0.005) << nanometres;
    }
    EXPECT_EQ(vision::spencer_weights(SpencerState::Photopic).halo, 0)
        << "a small pupil covers the fibres that make it";
}

TEST(Glare, OneFunctionScatteredIsOne) {
    const EyeScatter psf = cie(70, 0.5);
    EXPECT_DOUBLE_EQ(psf.within(90), 1);
    EXPECT_DOUBLE_EQ(psf.within(0), 0);
    EXPECT_DOUBLE_EQ(psf(2) * psf.total(), vision::cie_total_glare(2, {70, 0.5}));
    double last = 0;  // rises everywhere, also within the rings it is summed over
    for (double t = 1e-5; t < 90; t *= 1.013) {
        EXPECT_GT(psf.within(t), last) << t;
        last = psf.within(t);
    }
    // A core of constant value: pi sin(t)^2 with t small.
    EXPECT_NEAR(psf.within(1e-4) / (psf(0) * 3.14159265 * std::pow(1e-4 * 3.14159265 / 180, 2)), 1, 1e-3);
}

}  // namespace
}  // namespace vesper::test
