// Contrast sensitivity against limits and a published standard. SPDX-License-Identifier: MIT
#include "analysis/contrast_sensitivity.h"

#include <cmath>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

using analysis::contrast_sensitivity, analysis::peak_sensitivity;

// DICOM PS3.14, the grayscale standard display function, equation 7-1: luminance of a just noticeable index.
double dicom_luminance(double index) {
    const double x = std::log(index);
    const double above = -1.3011877 + x * (8.0242636e-2 + x * (1.3646699e-1 + x * (-2.5468404e-2 + x * 1.3635334e-3)));
    const double below =
        1 + x * (-2.5840191e-2 + x * (-1.0320229e-1 + x * (2.8745620e-2 + x * (-3.1978977e-3 + x * 1.2992634e-4))));
    return std::pow(10, above / below);
}

// The standard is Barten's model of 1992 for a target of 2 degrees and 4 cycles/degree, with a signal to noise ratio of
// 3.3 in place of 3 and the amplitude of a square wave's fundamental, 4/pi: 1.4 times less sensitive. The rest is what
// he changed until 1999.
TEST(ContrastSensitivity, IsThatOfTheDicomStandardDisplay) {
    for (const double index : {5.0, 20.0, 50.0, 100.0, 200.0, 400.0, 600.0, 800.0, 1000.0}) {
        const double luminance = dicom_luminance(index),
                     step = (dicom_luminance(index + 0.5) - dicom_luminance(index - 0.5)) / luminance;
        const double standard = 2 / step;  // contrast is half of the step
        EXPECT_NEAR(contrast_sensitivity(4, luminance, {.field = 2}) / standard, 1.32, 0.16) << luminance;
    }
    EXPECT_NEAR(dicom_luminance(1), 0.05, 1e-4) << "the table of the standard";
    EXPECT_NEAR(dicom_luminance(1023), 3993.4, 0.1);
}

// Of a field of 10 degrees, computed apart from this program. Five digits.
TEST(ContrastSensitivity, HasTheValuesOfTheEquation) {
    const double table[][3]{
        // cycles/degree, cd/m^2, sensitivity
        {0.5, 0.01, 50.643}, {1, 0.1, 138.52}, {4, 1, 199.59}, {4, 100, 668.52}, {8, 100, 466.12}, {20, 500, 142.58}};
    for (const auto& [frequency, luminance, eye] : table)
        EXPECT_NEAR(contrast_sensitivity(frequency, luminance) / eye, 1, 5e-5) << frequency << ", " << luminance;
}

// With few photons it grows with the root of luminance (de Vries and Rose), with many not at all (Weber).
TEST(ContrastSensitivity, FollowsDeVriesAndRoseAndWeber) {
    // The pupil closes from 1e-5 to 1e-3 cd/m^2 by 5 % at most in this field.
    EXPECT_NEAR(contrast_sensitivity(1, 1e-3) / contrast_sensitivity(1, 1e-5), 10, 0.6);
    EXPECT_NEAR(contrast_sensitivity(1, 1e5) / contrast_sensitivity(1, 1e4), 1, 0.01);
}

TEST(ContrastSensitivity, HasAPeakAndEnds) {
    // Campbell and Robson 1968 at 500 cd/m^2: a peak of some hundred at 3 to 5 cycles/degree, nothing beyond 60.
    double best = 0;
    for (double u = 0.5; u < 30; u *= 1.02)
        if (contrast_sensitivity(u, 500) > contrast_sensitivity(best, 500)) best = u;
    EXPECT_GT(best, 2);
    EXPECT_LT(best, 6);
    EXPECT_NEAR(peak_sensitivity(500) / contrast_sensitivity(best, 500), 1, 1e-3);
    EXPECT_GT(peak_sensitivity(500), 200);
    EXPECT_LT(contrast_sensitivity(60, 500), 2);
    EXPECT_EQ(contrast_sensitivity(0, 500), 0);
    EXPECT_EQ(contrast_sensitivity(4, 0), 0);
}

TEST(ContrastSensitivity, EyesDiffer) {
    EXPECT_NEAR(contrast_sensitivity(4, 10) / contrast_sensitivity(4, 10, {.age = 64}), 1.93, 0.01) << "Adrian 1989";
    // Behind an eye that scatters there is less contrast, of which it is the more sensitive.
    for (const vision::ScatteringEye& scatters : {vision::ScatteringEye{23, 0.5}, vision::ScatteringEye{70, 1.2}}) {
        const analysis::ContrastEye whole{.age = scatters.age}, retina{.age = scatters.age, .scatters = scatters};
        for (const double u : {0.1, 4.0, 20.0})
            EXPECT_NEAR(contrast_sensitivity(u, 10, retina) * vision::cie_modulation(u, scatters),
                        contrast_sensitivity(u, 10, whole), 1e-9);
    }
}

TEST(JndScale, SlopeIsThePeakOverLuminance) {
    const analysis::JndScale scale{analysis::ContrastEye{}};
    for (const double l : {1e-5, 1e-3, 0.1, 1.0, 33.0, 1e3, 1e6}) {
        // Straight between nodes, 128 a decade.
        EXPECT_NEAR((scale.jnd(1.01 * l) - scale.jnd(0.99 * l)) / (0.02 * peak_sensitivity(l)), 1, 0.01) << l;
        EXPECT_NEAR(scale.luminance(scale.jnd(l)) / l, 1, 1e-9);
        EXPECT_NEAR(scale.peak(l) / peak_sensitivity(l), 1, 1e-3);
    }
    EXPECT_EQ(scale.jnd(0), 0);
    EXPECT_EQ(scale.jnd(std::nan("")), 0);
    EXPECT_EQ(scale.jnd(HUGE_VAL), scale.jnd(analysis::JndScale::kMost));
}

}  // namespace
}  // namespace vesper::test
