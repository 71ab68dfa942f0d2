// Needles and halo: means, energy, radii and colours, and how they move. SPDX-License-Identifier: MIT
#include "vision/glare_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/angle.h"
#include "base/luminance.h"

namespace vesper::test {
namespace {

using glm::dvec3;
using vision::EyeScatter, vision::GlarePattern, vision::SpencerState, vision::temporal_pattern;

constexpr int kColumns = GlarePattern::kColumns, kRows = GlarePattern::kRows;

EyeScatter cie(double age) {
    return EyeScatter([age](double theta) { return vision::cie_total_glare(theta, {age, 0.5}); });
}
EyeScatter veil(SpencerState state) {
    return EyeScatter([state](double theta) { return vision::spencer_veil(theta, state); });
}
const vision::EyeAperture& aperture() {
    static const vision::EyeAperture one;
    return one;
}

double middle(int row) { return GlarePattern::angle(row + 0.5); }
dvec3 modulation(const GlarePattern& p, int row, int column) {
    return dvec3(p.modulation[size_t(row) * kColumns + size_t(column)]);
}
/// sr of a row.
double steradians(int row) {
    return 2 * std::numbers::pi *
           (std::cos(GlarePattern::angle(row) * kRadiansPerDegree) -
            std::cos(GlarePattern::angle(row + 1) * kRadiansPerDegree));
}

/// What is seen about a lamp beside the smooth veil: mean of a row.
dvec3 mean(const GlarePattern& p, int row) {
    dvec3 sum(0);
    for (int c = 0; c < kColumns; ++c) sum += modulation(p, row, c);
    return dvec3(p.ring[size_t(row)]) + dvec3(p.needles[size_t(row)]) * sum / double(kColumns);
}

/// Root of the mean square of the luminance's modulation in a row.
double contrast(const GlarePattern& p, int row) {
    double sum = 0;
    for (int c = 0; c < kColumns; ++c) sum += std::pow(luminance(modulation(p, row, c)), 2);
    return std::sqrt(sum / kColumns);
}

TEST(GlarePattern, RowsAreAsFarApartAsColumns) {
    EXPECT_NEAR(GlarePattern::angle(kRows), 6, 1e-12);
    for (double row : {0.0, 0.5, 100.0, 447.5}) EXPECT_NEAR(GlarePattern::row_of(GlarePattern::angle(row)), row, 1e-9);
    EXPECT_NEAR(std::log(GlarePattern::angle(8) / GlarePattern::angle(7)), 2 * std::numbers::pi / kColumns, 1e-12);
}

// Issue: the azimuthal mean of temporal glare is the CIE function, so its energy is that of cie.
TEST(GlarePattern, TemporalHasTheMeanOfTheCieFunction) {
    for (const double age : {24.0, 70.0})
        for (const double pupil : {2.5, 4.2, 6.5}) {
            const EyeScatter smooth = cie(age);
            const GlarePattern p = temporal_pattern(smooth, aperture(), pupil, 0.7);
            dvec3 energy(0);
            for (int row = 0; row < kRows; ++row) {
                // 1e-6: single precision of the rows; the mean of 512 columns is good to 1e-6 of the needles.
                EXPECT_NEAR(luminance(mean(p, row)) / smooth(middle(row)), 0, 2e-6)
                    << age << " years, " << middle(row) << " degrees";
                energy += steradians(row) * mean(p, row);
            }
            // Of all light: channels have as much as they had. 1e-5: f3 itself is 0.9998 to 1.0002 over its
            // wavelengths.
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(energy[c], 0, 1e-5) << age << " years, " << pupil << " mm";
        }
}

// What is seen is nowhere darker than a tenth of the veil, which the pyramid gives to 8 %.
TEST(GlarePattern, LeavesATenthOfTheVeil) {
    const EyeScatter smooth = cie(24), photopic = veil(SpencerState::Photopic), scotopic = veil(SpencerState::Scotopic);
    const auto least = [](const GlarePattern& p, const EyeScatter& psf) {
        double darkest = 1e9;
        for (int row = 0; row < kRows; ++row)
            for (int c = 0; c < kColumns; ++c) {
                const dvec3 part =
                    (dvec3(p.ring[size_t(row)]) + dvec3(p.needles[size_t(row)]) * modulation(p, row, c)) /
                        psf(middle(row)) +
                    1.0;
                darkest = std::min({darkest, part.r, part.g, part.b});
            }
        return darkest;
    };
    EXPECT_GE(least(temporal_pattern(smooth, aperture(), 6, 2), smooth), 0.1 - 1e-6);
    EXPECT_LT(least(temporal_pattern(smooth, aperture(), 6, 2), smooth), 0.5) << "there are needles";
    EXPECT_GE(least(vision::spencer_pattern(photopic, SpencerState::Photopic, 1), photopic), 0.1);
    EXPECT_GE(least(vision::spencer_pattern(scotopic, SpencerState::Scotopic, 1), scotopic), 0.1);
}

// Radii of the published ring: 3 degrees times the wavelength over 568 nm, blue inside. Means over a channel's
// wavelengths: 2.4 degrees for 455 nm, 2.85 for 540, 3.2 for 605.
TEST(GlarePattern, TheHaloIsAtItsPublishedRadiiAndColours) {
    const EyeScatter smooth = veil(SpencerState::Scotopic);
    const GlarePattern p = vision::spencer_pattern(smooth, SpencerState::Scotopic, 1);
    const double wanted[]{3.2, 2.85, 2.4};
    for (int c = 0; c < 3; ++c) {
        int brightest = 0;
        for (int row = 0; row < kRows; ++row)
            if (middle(row) > 1.5 && p.ring[size_t(row)][c] > p.ring[size_t(brightest)][c]) brightest = row;
        EXPECT_NEAR(middle(brightest), wanted[c], 0.1) << "channel " << c;
    }
    // The light of the ring is what the weight of f3 says, over the plateau that stands for it elsewhere.
    dvec3 energy(0), ring(0);
    for (int row = 0; row < kRows; ++row) {
        const double theta = middle(row),
                     plateau = vision::spencer_veil(theta, SpencerState::Scotopic) -
                               vision::spencer_smooth_glare(theta, vision::spencer_weights(SpencerState::Scotopic));
        energy += steradians(row) * mean(p, row);
        ring += steradians(row) * (mean(p, row) + plateau / smooth.total());
    }
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(ring[c] * smooth.total(), 0.033, 1e-4) << "channel " << c;
        EXPECT_NEAR(energy[c], 0, 1e-4) << "no light is made: channel " << c;
    }
}

TEST(GlarePattern, TheHaloNeedsAWidePupil) {
    EXPECT_EQ(vision::halo_share(1.9), 0);
    EXPECT_EQ(vision::halo_share(3), 0);
    EXPECT_NEAR(vision::halo_share(3.92), 0.016, 2e-4) << "mesopic";
    EXPECT_NEAR(vision::halo_share(4.9), 0.033, 1e-12);
    EXPECT_EQ(vision::halo_share(8), vision::halo_share(4.9));
    const auto colours = [](const GlarePattern& p) {
        double most = 0;
        for (const glm::vec3& v : p.ring) most = std::max(most, double(std::abs(v.r)));
        return most;
    };
    EXPECT_EQ(colours(temporal_pattern(cie(24), aperture(), 2.9, 0)), 0);
    EXPECT_GT(colours(temporal_pattern(cie(24), aperture(), 4, 0)), 0.1);
    EXPECT_LT(colours(vision::spencer_pattern(veil(SpencerState::Photopic), SpencerState::Photopic, 1)), 1e-6);
    EXPECT_GT(colours(vision::spencer_pattern(veil(SpencerState::Mesopic), SpencerState::Mesopic, 1)), 1);
}

// Lines that all go through the lamp cover more of a small ring than of a large one.
TEST(GlarePattern, SpencersNeedlesStandOutFurtherFromTheLamp) {
    const GlarePattern p = vision::spencer_pattern(veil(SpencerState::Photopic), SpencerState::Photopic, 1);
    const auto at = [&](double degrees) { return contrast(p, int(GlarePattern::row_of(degrees))); };
    EXPECT_LT(at(0.03), 0.2);
    EXPECT_GT(at(1), 0.4);
    EXPECT_GT(at(3), at(1));
    for (int row = 0; row < kRows; ++row)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(mean(p, row)[c] /
                            vision::spencer_smooth_glare(middle(row), vision::spencer_weights(SpencerState::Photopic)),
                        0, 1e-5);
}

// White light draws the grains of one wavelength out to needles: along a radius the pattern changes slower than around.
TEST(GlarePattern, NeedlesAreRadial) {
    const GlarePattern p = temporal_pattern(cie(24), aperture(), 5, 0);
    for (const double theta : {0.3, 0.6, 1.0, 3.0}) {
        const int row = int(GlarePattern::row_of(theta));
        double along = 0, around = 0;
        for (int c = 0; c < kColumns; ++c) {
            const double here = luminance(modulation(p, row, c));
            along += std::pow(luminance(modulation(p, row + 4, c)) - here, 2);
            around += std::pow(luminance(modulation(p, row, (c + 4) % kColumns)) - here, 2);
        }
        EXPECT_LT(along, 0.25 * around) << theta;
        EXPECT_GT(contrast(p, row), 0.15) << theta;
    }
}

TEST(GlarePattern, MovesSlowlyAndOnlyWithTime) {
    const EyeScatter smooth = cie(24);
    const auto at = [&](double seconds) {
        return temporal_pattern(smooth, aperture(), vision::restless_pupil(5, seconds, 1), seconds);
    };
    const auto apart = [](const GlarePattern& a, const GlarePattern& b) {
        double difference = 0, all = 0;
        for (int row = int(GlarePattern::row_of(0.2)); row < kRows; ++row)
            for (int c = 0; c < kColumns; ++c) {
                const double x = luminance(modulation(a, row, c)), y = luminance(modulation(b, row, c));
                difference += (x - y) * (x - y), all += x * x + y * y;
            }
        return difference / all;  // 1: nothing in common
    };
    const GlarePattern first = at(10);
    EXPECT_EQ(apart(first, at(10)), 0) << "the same moment, the same picture";
    const double frame = apart(first, at(10 + 1.0 / 60)), blink = apart(first, at(10 + 1e-4)),
                 second = apart(first, at(11));
    EXPECT_GT(frame, 0);
    EXPECT_LT(blink, 1e-4);
    EXPECT_LT(frame, 0.1);
    EXPECT_GT(second, 3 * frame);
    const vision::EyeAperture other({.seed = 2});
    EXPECT_GT(apart(first, temporal_pattern(smooth, other, vision::restless_pupil(5, 10, 1), 10)), 0.5)
        << "another eye";
}

}  // namespace
}  // namespace vesper::test
