// The pattern as the device reads it: means keep its light, and the eye of a frame depends on its moment alone.
// SPDX-License-Identifier: MIT
#include "eye/corona.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/luminance.h"
#include "shared/corona.h"
#include "shared/tone.h"
#include "vision/thresholds.h"

namespace vesper::test {
namespace {

using glm::dvec3;

constexpr size_t kStride = shared::kPatternStride, kColumns = shared::kPatternColumns;

size_t first_of(uint32_t level) {
    size_t first = 0;
    for (uint32_t l = 0; l < level; ++l) first += kColumns >> l;
    return first;
}

// Texels are light times the square of the angle, so equal rows have equal solid angles: a mean of each level is all of
// its light.
TEST(EyeCorona, EveryLevelHasTheSameLight) {
    eye::CoronaCache cache;
    for (const auto model : {eye::ScatterSettings::Model::Temporal, eye::ScatterSettings::Model::Spencer}) {
        const auto texels = cache.at({.model = model, .state = vision::SpencerState::Scotopic}, 1, 0).texels;
        ASSERT_EQ(texels.size(), shared::kPatternRows * kStride);
        dvec3 light[shared::kPatternLevels]{};
        double strongest = 0;
        for (uint32_t level = 0; level < shared::kPatternLevels; ++level)
            for (size_t row = 0; row < shared::kPatternRows; ++row)
                for (size_t i = 0; i < kColumns >> level; ++i) {
                    const dvec3 texel(texels[row * kStride + first_of(level) + i]);
                    light[level] += texel / double(kColumns >> level);
                    if (level == 0) strongest = std::max(strongest, std::abs(texel.g));
                }
        // 1e-3: sums of 448 rows in single precision.
        for (uint32_t level = 1; level < shared::kPatternLevels; ++level)
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[level][c], light[0][c], 1e-3 * strongest) << level;
    }
}

// A lamp that is wide has no rings of its own: what is fine along the radius is blurred as what is fine around.
TEST(EyeCorona, MeansAreSmoothAlongTheRadius) {
    eye::CoronaCache cache;
    const auto texels = cache.at({.model = eye::ScatterSettings::Model::Temporal}, 1, 0).texels;
    constexpr uint32_t kLevel = 4, kWide = 1 << kLevel;
    const auto at = [&](int row, size_t texel) { return luminance(dvec3(texels[size_t(row) * kStride + texel])); };
    double changes = 0,
           around = 0;  // squares of what changes from row to row: of the level, and of means of columns alone
    for (int row = int(vision::GlarePattern::row_of(0.2)); row < int(vision::GlarePattern::row_of(1)); ++row)
        for (size_t i = 0; i < kColumns / kWide; ++i) {
            double here = 0, next = 0;
            for (size_t k = 0; k < kWide; ++k)
                here += at(row, kWide * i + k) / kWide, next += at(row + 1, kWide * i + k) / kWide;
            around += (next - here) * (next - here);
            changes += std::pow(at(row + 1, first_of(kLevel) + i) - at(row, first_of(kLevel) + i), 2);
        }
    EXPECT_GT(changes, 0);
    EXPECT_LT(changes, 0.7 * around);
}

TEST(EyeCorona, TheEyeOfAFrameDependsOnItsMomentAlone) {
    const eye::ScatterSettings settings{.model = eye::ScatterSettings::Model::Temporal};
    eye::CoronaCache one, other;
    const auto texels = one.at(settings, 4.1, 3.5).texels;
    EXPECT_GT(one.at(settings, 4.1, 3.6).milliseconds, 0);
    EXPECT_EQ(one.at(settings, 4.1, 3.6).milliseconds, 0) << "time stands still, and so does the eye";
    EXPECT_EQ(other.at(settings, 4.1, 3.5).texels, texels);
    EXPECT_EQ(one.at(settings, 4.1, 3.5).texels, texels);
    // The pupil closes within half a second to what it adapts to, and is never at rest.
    EXPECT_NEAR(one.at(settings, 0, 0).pupil, vision::pupil_moon_spencer(1), 0.6);
    EXPECT_NEAR(one.at(settings, 2.3, 5).pupil, 2.3, 0.6);
    const double next =
        std::lerp(vision::pupil_moon_spencer(1e3), double(shared::kFirstPupil),
                  std::exp(-0.01 / double(shared::kPupilSeconds)));  // as glsl/adapt/adapt.comp leaves it
    EXPECT_LT(std::abs(one.at(settings, next, 0.01).pupil - one.at(settings, 0, 0).pupil), 0.1)
        << "no step after the first frame";
}

}  // namespace
}  // namespace vesper::test
