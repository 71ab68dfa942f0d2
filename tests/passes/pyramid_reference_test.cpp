// Area means in double. SPDX-License-Identifier: MIT
#include "passes/pyramid_reference.h"

#include <random>

#include <gtest/gtest.h>

#include "shared/photometry.h"

namespace vesper::reference::pyramid_reference_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

std::vector<dvec3> random_image(uint32_t width, uint32_t height, uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> decades(-4, 8);
    std::vector<dvec3> image(size_t(width) * height);
    for (dvec3& p : image) p = dvec3(std::pow(10, decades(random)));
    return image;
}

std::vector<PyramidLevel> pyramid_of(const std::vector<dvec3>& image, uint32_t width, uint32_t height) {
    return pyramid(std::span<const dvec3>(image), width, height);
}

TEST(PyramidReference, WhiteHasLuminanceOne) {
    EXPECT_NEAR(luminance(dvec3(1)), 1, 1e-15);
    EXPECT_DOUBLE_EQ(luminance({0, 1, 0}), 0.715169);
    EXPECT_EQ(shared::kRed + shared::kGreen + shared::kBlue, 1.0f);
    EXPECT_FLOAT_EQ(shared::kLuminanceFloor, float(kFloor));
}

TEST(PyramidReference, SizesHalveRoundingUp) {
    const auto sizes = [](uint32_t w, uint32_t h) {
        std::vector<std::pair<uint32_t, uint32_t>> all;
        for (const auto& level : pyramid_of(std::vector<dvec3>(size_t(w) * h, dvec3(1)), w, h))
            all.emplace_back(level.width, level.height);
        return all;
    };
    using Sizes = std::vector<std::pair<uint32_t, uint32_t>>;
    EXPECT_EQ(sizes(1, 1), (Sizes{{1, 1}}));
    EXPECT_EQ(sizes(2, 1), (Sizes{{1, 1}}));
    EXPECT_EQ(sizes(7, 5), (Sizes{{4, 3}, {2, 2}, {1, 1}}));
    EXPECT_EQ(sizes(1680, 1050).size(), 11u);
    EXPECT_EQ(sizes(1680, 1050)[4], std::make_pair(53u, 33u)) << "the paper's fifth level";
}

TEST(PyramidReference, SmallImageByHand) {
    const auto levels = pyramid_of({dvec3(1), dvec3(2), dvec3(9), dvec3(4), dvec3(5), dvec3(7)}, 3, 2);
    const dvec4 want(3, 4, (std::log(1) + std::log(2) + std::log(4) + std::log(5)) / 4, 5);
    EXPECT_NEAR(glm::length(levels[0].at(0, 0) - want), 0, 1e-12);
    EXPECT_NEAR(levels[0].at(1, 0).x, 8, 1e-12);
    EXPECT_NEAR(levels[0].at(1, 0).z, std::log(63) / 2, 1e-12);
    EXPECT_NEAR(levels[1].at(0, 0).x, 28.0 / 6, 1e-12) << "weighted by pixels, not by texels";
    EXPECT_EQ(levels[1].at(0, 0).y, 6);
    EXPECT_DOUBLE_EQ(levels[1].at(0, 0).w, 9);
}

TEST(PyramidReference, EveryLevelHasTheMeanOfTheImage) {
    for (auto [w, h] : {std::pair{65u, 33u}, {127u, 1u}, {50u, 75u}}) {
        const auto image = random_image(w, h);
        double mean = 0, mean_ln = 0, largest = 0;
        for (dvec3 p : image)
            mean += luminance(p), mean_ln += std::log(luminance(p)), largest = std::max(largest, luminance(p));
        for (const auto& level : pyramid_of(image, w, h)) {
            dvec3 sum(0);
            double top = 0;
            for (const dvec4& t : level.texels) sum += dvec3(t.x * t.y, t.y, t.z * t.y), top = std::max(top, t.w);
            EXPECT_NEAR(sum.x / mean, 1, 1e-12);
            EXPECT_EQ(sum.y, double(w) * h);
            EXPECT_NEAR(sum.z, mean_ln, 1e-8);
            EXPECT_EQ(top, largest);
        }
    }
}

TEST(PyramidReference, EachLevelIsTheWeightedMeanOfTheOneBelow) {
    const auto levels = pyramid_of(random_image(37, 21), 37, 21);
    for (size_t k = 1; k < levels.size(); ++k)
        for (uint32_t y = 0; y < levels[k].height; ++y)
            for (uint32_t x = 0; x < levels[k].width; ++x) {
                double sum = 0, count = 0;
                for (uint32_t j = 2 * y; j < std::min(2 * y + 2, levels[k - 1].height); ++j)
                    for (uint32_t i = 2 * x; i < std::min(2 * x + 2, levels[k - 1].width); ++i)
                        sum += levels[k - 1].at(i, j).x * levels[k - 1].at(i, j).y, count += levels[k - 1].at(i, j).y;
                EXPECT_NEAR(levels[k].at(x, y).x / (sum / count), 1, 1e-12);
            }
}

TEST(PyramidReference, LeavesOutWhatIsNotFinite) {
    std::vector<dvec3> image(16, dvec3(2));
    image[0] = {1, kNan, 1}, image[1] = {kInf, 1, 1}, image[4] = {-kInf, kInf, 0}, image[5] = dvec3(0, 0, kNan);
    const auto levels = pyramid_of(image, 4, 4);
    EXPECT_EQ(levels[0].at(0, 0), dvec4(0)) << "nothing left";
    EXPECT_EQ(levels[1].at(0, 0).y, 12);
    EXPECT_NEAR(levels[1].at(0, 0).x, 2, 1e-12);
    EXPECT_NEAR(levels[1].at(0, 0).z, std::log(2), 1e-12);
}

TEST(PyramidReference, DarkAndNegativePixelsCountAtTheFloorOfTheLogarithm) {
    const auto levels = pyramid_of({dvec3(0), dvec3(-3), dvec3(1e-9), dvec3(5)}, 2, 2);
    EXPECT_NEAR(levels[0].at(0, 0).x, 0.5 + 1e-9 / 4, 1e-12);
    EXPECT_EQ(levels[0].at(0, 0).y, 4);
    EXPECT_NEAR(levels[0].at(0, 0).z, (3 * std::log(1e-4) + std::log(5)) / 4, 1e-12);
}

TEST(PyramidReference, CoveredPixelsAddUpToTheImage) {
    for (uint32_t level : {1u, 3u, 7u}) {
        uint32_t sum = 0;
        for (uint32_t y = 0; y < 60; ++y)
            for (uint32_t x = 0; x < 60; ++x) sum += covered(101, 53, level, x, y);
        EXPECT_EQ(sum, 101u * 53u) << level;
    }
}

}  // namespace
}  // namespace vesper::reference::pyramid_reference_test
