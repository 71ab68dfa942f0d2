// What stands in the way of light within the eye, and what that does to a lamp far away. SPDX-License-Identifier: MIT
#include "vision/eye_aperture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "vision/thresholds.h"

namespace vesper::test {
namespace {

using vision::restless_pupil;

constexpr int kSide = vision::EyeAperture::kSide;
constexpr double kSample = vision::EyeAperture::kWindow / kSide;

double transmitted(const std::vector<std::complex<double>>& amplitude) {
    double sum = 0;
    for (const auto& a : amplitude) sum += std::abs(a);
    return sum * kSample * kSample;  // mm^2
}

TEST(EyeAperture, ThePupilLetsItsAreaThrough) {
    const vision::EyeAperture eye;
    for (const double diameter : {2.0, 4.0, 6.5}) {
        const double area = std::numbers::pi * diameter * diameter / 4,
                     open = transmitted(eye.amplitude(diameter, 0)) / area;
        EXPECT_LT(open, 1) << diameter << ": something is in the way";
        EXPECT_GT(open, 0.9) << diameter;
        EXPECT_LT(transmitted(vision::EyeAperture({.lashes = true}).amplitude(diameter, 0)) / area, open - 0.01)
            << diameter << ": lashes";
    }
}

// The same by another way: a sum over all samples for one angle after the other.
TEST(EyeAperture, FarFieldIsTheFourierTransform) {
    constexpr int kSmall = 16;
    std::vector<std::complex<double>> amplitude;
    for (int i = 0; i < kSmall * kSmall; ++i)
        amplitude.push_back(std::polar(0.5 + 0.5 * std::sin(7.0 * i), std::cos(3.0 * i)));
    const std::vector<double> intensity = vision::far_field(amplitude, kSmall);
    for (int v = -kSmall / 2; v < kSmall / 2; ++v)
        for (int u = -kSmall / 2; u < kSmall / 2; ++u) {
            std::complex<double> sum = 0;
            for (int y = 0; y < kSmall; ++y)
                for (int x = 0; x < kSmall; ++x)
                    sum += amplitude[size_t(y * kSmall + x)] *
                           std::polar(1.0, -2 * std::numbers::pi * (u * x + v * y) / kSmall);
            EXPECT_NEAR(intensity[size_t((v + kSmall / 2) * kSmall + u + kSmall / 2)], std::norm(sum), 1e-9)
                << u << ", " << v;
        }
}

// A slit's diffraction: zero where its halves are half a wave apart.
TEST(EyeAperture, ASlitHasItsZeros) {
    constexpr int kSmall = 64, kWide = 8;
    std::vector<std::complex<double>> amplitude(size_t(kSmall) * kSmall);
    for (int y = 0; y < kSmall; ++y)
        for (int x = 0; x < kWide; ++x) amplitude[size_t(y * kSmall + x)] = 1;
    const std::vector<double> intensity = vision::far_field(amplitude, kSmall);
    const size_t row = size_t(kSmall) * kSmall / 2, straight = kSmall / 2;
    EXPECT_NEAR(intensity[row + straight], std::pow(kSmall * kWide, 2), 1e-6);
    for (int k = 1; k < kWide / 2; ++k)
        EXPECT_NEAR(intensity[row + straight + size_t(k * kSmall / kWide)], 0, 1e-18 * intensity[row + straight]);
    EXPECT_NEAR(intensity[row + size_t(kSmall) + straight], 0, 1e-18 * intensity[row + straight]) << "along the slit";
}

TEST(EyeAperture, ThePupilIsRestless) {
    double sum = 0, squares = 0, fastest = 0;
    constexpr int kSteps = 60 * 120;
    for (int i = 0; i < kSteps; ++i) {
        const double d = restless_pupil(5, i / 60.0, 3), next = restless_pupil(5, (i + 1) / 60.0, 3);
        sum += d - 5, squares += (d - 5) * (d - 5), fastest = std::max(fastest, std::abs(next - d) * 60);
    }
    EXPECT_NEAR(sum / kSteps, 0, 0.1);
    EXPECT_NEAR(std::sqrt(squares / kSteps), 0.2, 0.1) << "mm";
    EXPECT_LT(fastest, 2) << "mm/s";
    // Hours into a drive it is as calm as ever, though what it rests at changes a little from frame to frame.
    double late = 0;
    for (int i = 0; i < 600; ++i) {
        const double rest = 4 + 0.2 * std::sin(i * 0.01), after = 4 + 0.2 * std::sin((i + 1) * 0.01),
                     now = 7200 + i / 60.0;
        late = std::max(late, std::abs(restless_pupil(after, now + 1 / 60.0, 3) - restless_pupil(rest, now, 3)));
    }
    EXPECT_LT(late, 0.05) << "mm in a frame";
    EXPECT_EQ(restless_pupil(5, 7.25, 3), restless_pupil(5, 7.25, 3));
    EXPECT_NE(restless_pupil(5, 7.25, 3), restless_pupil(5, 7.25, 4));
    for (double luminance : {0.0, 1e-6, 1.0, 1e6}) {  // whatever the eye looks at
        const double d = restless_pupil(vision::pupil_moon_spencer(luminance), 1, 1);
        EXPECT_TRUE(d >= 1 && d <= 8) << luminance;
    }
}

}  // namespace
}  // namespace vesper::test
