// Mip levels of textures whose opacity masks. SPDX-License-Identifier: MIT
#include "gpu_scene/textures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "scene/scene.h"

namespace vesper::test {
namespace {

using gpu_scene::Level;

// Closed forms: what is painted flat, and two slopes whose mean is shorter than they are.
TEST(ReliefTextures, HoldTheMeanNormalAndHowNormalsSpread) {
    const auto image = [](std::vector<std::array<uint8_t, 3>> codes) {
        Image made{"relief", uint32_t(codes.size()), 1, {}};
        for (const auto& code : codes) made.rgba.insert(made.rgba.end(), {code[0], code[1], code[2], 255});
        return made;
    };
    for (const uint8_t flat : {uint8_t(127), uint8_t(128)})
        EXPECT_EQ(gpu_scene::relief_levels(image({{flat, flat, 255}}), 1)[0].rgba, (std::vector<float>{0, 0, 1, 0}));
    const double slope = 100.0 / 110;
    for (const float scale : {1.0f, 0.5f}) {
        const std::vector<Level> levels = gpu_scene::relief_levels(image({{228, 128, 238}, {27, 128, 238}}), scale);
        ASSERT_EQ(levels.size(), 2u);
        const double length = 1 / std::sqrt(1 + scale * scale * slope * slope);
        EXPECT_NEAR(levels[0].rgba[0], scale * slope * length, 1e-6);
        EXPECT_NEAR(levels[0].rgba[2], length, 1e-6);
        EXPECT_NEAR(levels[0].rgba[3], 0, 1e-3);
        EXPECT_NEAR(levels[1].rgba[0], 0, 1e-6);
        EXPECT_NEAR(levels[1].rgba[2], length, 1e-6);
        EXPECT_NEAR(levels[1].rgba[3], std::sqrt(1 - length), 1e-6);
    }
    const std::vector<float> steep = gpu_scene::relief_levels(image({{255, 0, 0}}), 100)[0].rgba;
    EXPECT_NEAR(std::hypot(steep[0], steep[1], steep[2]), 1, 1e-5);
    // Painted holes and opposite directions give numbers.
    for (const auto& level : gpu_scene::relief_levels(image({{0, 0, 0}, {255, 255, 0}}), 1000))
        for (const float value : level.rgba) EXPECT_TRUE(std::isfinite(value));
}

/// Discs of one colour on black that is not there.
Level leaves(uint32_t side, float radius, uint32_t apart) {
    Level level{side, side, {}};
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const float u = float(x % apart) - 0.5f * float(apart), v = float(y % apart) - 0.5f * float(apart);
            const bool there = u * u + v * v < radius * radius;
            for (const float value : {0.1f, 0.3f, 0.05f, 1.0f}) level.rgba.push_back(there ? value : 0.0f);
        }
    return level;
}

/// Of a level's area, seen through a linear filter with its picture repeated.
double covered(const Level& level, float cutoff) {
    constexpr uint32_t kSteps = 8;
    const auto opacity = [&](uint32_t x, uint32_t y) {
        return level.rgba[(size_t(y % level.height) * level.width + x % level.width) * 4 + 3];
    };
    size_t count = 0;
    for (uint32_t j = 0; j < level.height * kSteps; ++j)
        for (uint32_t i = 0; i < level.width * kSteps; ++i) {
            const uint32_t x = i / kSteps, y = j / kSteps;
            const float u = float(i % kSteps) / kSteps, v = float(j % kSteps) / kSteps;
            count += std::lerp(std::lerp(opacity(x, y), opacity(x + 1, y), u),
                               std::lerp(opacity(x, y + 1), opacity(x + 1, y + 1), u), v) >= cutoff;
        }
    return double(count) / (double(level.width) * level.height * kSteps * kSteps);
}

// What is not there gives no colour and takes none; what is there keeps its area down to the smallest level.
TEST(MaskedLevels, KeepColourAndArea) {
    for (const auto& [side, radius, apart] : {std::tuple(128u, 9.0f, 32u), std::tuple(128u, 3.0f, 16u),
                                              std::tuple(96u, 10.0f, 24u), std::tuple(64u, 28.0f, 64u)})
        for (const float cutoff : {0.3f, 0.5f}) {
            const Level base = leaves(side, radius, apart);
            const double part = covered(base, cutoff);
            const std::vector<Level> levels = gpu_scene::masked_levels(base, cutoff);
            EXPECT_GE(levels.back().width, 8u);
            EXPECT_LT(levels.back().width, 33u);
            for (const Level& level : levels) {
                for (size_t i = 0; i < level.rgba.size(); i += 4) {
                    ASSERT_NEAR(level.rgba[i], 0.1f, 1e-6f) << level.width;
                    ASSERT_NEAR(level.rgba[i + 1], 0.3f, 1e-6f) << level.width;
                    ASSERT_NEAR(level.rgba[i + 2], 0.05f, 1e-6f) << level.width;
                    ASSERT_LE(level.rgba[i + 3], 1.0f);
                }
                // A tenth of the whole: the scale ends where opacities do, at 1, and a texel of the smallest level is a
                // hundredth.
                EXPECT_NEAR(covered(level, cutoff), part, 0.1) << level.width << " of " << side << ", " << radius;
            }
        }
}

TEST(MaskedLevels, WhatIsAllThereOrNotAtAllStaysSo) {
    for (const float opacity : {0.0f, 1.0f}) {
        Level base{32, 16, {}};
        for (int i = 0; i < 32 * 16; ++i)
            for (const float value : {0.5f, 0.5f, 0.5f, opacity}) base.rgba.push_back(value);
        for (const Level& level : gpu_scene::masked_levels(base, 0.5f))
            for (size_t i = 3; i < level.rgba.size(); i += 4) EXPECT_EQ(level.rgba[i], opacity);
    }
}

}  // namespace
}  // namespace vesper::test
