// The histogram on the device against its reference. SPDX-License-Identifier: MIT
#include "passes/histogram_reference.h"

#include <random>

#include "base/error.h"
#include "support/compare.h"
#include "support/texels.h"

namespace vesper::test {
namespace {

// A texel within this part of a bin of an edge may fall on either side: ln and the bin's position, up to 256, in float.
constexpr double kDoubt = 2e-4;

/// A level as the pyramid makes it: every texel with at most the pixels it covers.
std::vector<glm::vec4> random_level(shared::HistogramPush p, float log10_low, float log10_high, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> decades(log10_low, log10_high), unit(0, 1);
    std::vector<glm::vec4> texels;
    for (uint32_t y = 0; y < p.level_size.y; ++y)
        for (uint32_t x = 0; x < p.level_size.x; ++x) {
            const uint32_t pixels = reference::covered(p.image_size.x, p.image_size.y, p.level, x, y);
            const float finite = unit(random) < 0.7f ? float(pixels) : std::floor(unit(random) * float(pixels));
            const float l = std::pow(10.0f, decades(random));
            texels.push_back(finite > 0 ? glm::vec4(l, finite, std::log(l), l) : glm::vec4(0));
        }
    return texels;
}

shared::HistogramPush push_of(VkExtent2D image, uint32_t level, const HistogramSettings& s) {
    const uint32_t side = 1u << level;
    return {{image.width, image.height},
            {(image.width + side - 1) / side, (image.height + side - 1) / side},
            level,
            s.bins,
            s.ln_low(),
            s.bins_per_ln()};
}

shared::Histogram count(PassRig& rig, const std::vector<glm::vec4>& texels, VkExtent2D image,
                        const shared::HistogramPush& p, const HistogramSettings& s) {
    FrameGraph graph;
    const VkExtent2D size{p.level_size.x, p.level_size.y};
    const Resource level = rig.image(graph, "level", kSceneFormat, size, texels);
    const Pyramid pyramid{std::vector<Resource>(p.level, level), std::vector<VkExtent2D>(p.level, size)};
    const Resource kept =
        keep<shared::Histogram>(graph, add_histogram(graph, rig.kernels(), pyramid, p.level, image, s));
    rig.run(graph);
    return rig.got<shared::Histogram>(kept).at(0);
}

TEST(Histogram, MatchesTheReferenceAtEverySizeAndLevel) {
    PassRig rig;
    for (VkExtent2D image : {VkExtent2D{1, 1}, {7, 5}, {131, 67}, {1680, 1050}})
        for (uint32_t level : {1u, 2u, 5u})
            for (uint32_t bins : {1u, 100u, 256u}) {
                const HistogramSettings settings{.bins = bins};
                const auto p = push_of(image, level, settings);
                const auto texels = random_level(p, -6, 9, image.width + level);
                const auto want = reference::histogram(std::span<const glm::vec4>(texels), p, kDoubt);
                const auto got = count(rig, texels, image, p, settings);
                EXPECT_EQ(got.finite, want.exact.finite);
                EXPECT_EQ(got.non_finite, want.exact.non_finite);
                EXPECT_TRUE(want.admits(got))
                    << image.width << " x " << image.height << " level " << level << ", " << bins << " bins";
            }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Histogram, OneTexelInEveryBin) {
    PassRig rig;
    const HistogramSettings settings;
    const VkExtent2D image{200, 2};
    const auto p = push_of(image, 1, settings);
    std::vector<glm::vec4> texels;
    for (int i = 0; i < 100; ++i) texels.emplace_back(std::pow(10.0, -4 + (i + 0.5) / 10), 4, 0, 0);
    const auto got = count(rig, texels, image, p, settings);
    for (uint32_t i = 0; i < 100; ++i) EXPECT_EQ(got.count[i], 4u) << "bin " << i;
    EXPECT_EQ(got.finite, 400u);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Histogram, BlackNegativeAndExtremeTexelsCountInTheEndBins) {
    PassRig rig;
    const HistogramSettings settings;
    const auto p = push_of({12, 2}, 1, settings);
    const std::vector<glm::vec4> texels{{0, 4, 0, 0},     {-5, 4, 0, 0},   {1e-30f, 4, 0, 0},
                                        {1e30f, 4, 0, 0}, {1e8f, 3, 0, 0}, {0, 0, 0, 0}};
    const auto got = count(rig, texels, {12, 2}, p, settings);
    EXPECT_EQ(got.count[0], 12u);
    EXPECT_EQ(got.count[99], 7u);
    EXPECT_EQ(got.finite, 19u);
    EXPECT_EQ(got.non_finite, 5u);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Histogram, IsZeroedEveryFrame) {
    PassRig rig;
    const HistogramSettings settings;
    const auto p = push_of({7, 5}, 1, settings);
    const auto texels = random_level(p, -3, 3, 1);
    const auto once = count(rig, texels, {7, 5}, p, settings), again = count(rig, texels, {7, 5}, p, settings);
    EXPECT_EQ(once.finite, again.finite);
    EXPECT_TRUE(std::ranges::equal(once.count, again.count));
    EXPECT_EQ(rig.complaints(), "");
}

// The two passes together: an image of known luminances, counted through the pyramid, pixel by pixel.
TEST(Histogram, CountsThePyramidsTexels) {
    PassRig rig;
    const VkExtent2D image{33, 17};
    std::vector<glm::vec4> pixels(size_t(image.width) * image.height, glm::vec4(0.3f));
    for (size_t i = 0; i < pixels.size(); i += 11) pixels[i].x = std::numeric_limits<float>::quiet_NaN();
    FrameGraph graph;
    const Resource scene = rig.image(graph, "scene", kSceneFormat, image, pixels);
    const Pyramid pyramid = add_pyramid(graph, rig.kernels(), scene, image);
    const Resource kept = keep<shared::Histogram>(graph, add_histogram(graph, rig.kernels(), pyramid, 3, image, {}));
    rig.run(graph);
    const auto got = rig.got<shared::Histogram>(kept).at(0);
    EXPECT_EQ(got.non_finite, 51u);
    EXPECT_EQ(got.finite, 561u - 51u);
    EXPECT_EQ(got.count[34], got.finite) << "log10 0.3 = -0.523";
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Histogram, RefusesImpossibleSettings) {
    PassRig rig;
    FrameGraph graph;
    const Resource level = rig.image(graph, "level", kSceneFormat, {1, 1}, std::vector{glm::vec4(1)});
    const Pyramid pyramid{{level}, {{1, 1}}};
    EXPECT_THROW(add_histogram(graph, rig.kernels(), pyramid, 1, {1, 1}, {.bins = 0}), Error);
    EXPECT_THROW(add_histogram(graph, rig.kernels(), pyramid, 1, {1, 1}, {.bins = 257}), Error);
    EXPECT_THROW(add_histogram(graph, rig.kernels(), pyramid, 0, {1, 1}, {}), Error);
    EXPECT_THROW(add_histogram(graph, rig.kernels(), pyramid, 2, {1, 1}, {}), Error);
}

}  // namespace
}  // namespace vesper::test
