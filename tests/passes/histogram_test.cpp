// The histogram on the device against its reference. SPDX-License-Identifier: MIT
#include "passes/histogram_reference.h"

#include <random>

#include "base/error.h"
#include "render/passes/histogram.h"
#include "support/compare.h"
#include "support/texels.h"

namespace vesper::test::histogram_test {
namespace {

using render::HistogramSettings;

// Part of a bin by which a texel's position may be off: ln and the bin's position, up to 256, in float.
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
    const uint64_t pixels = uint64_t(image.width) * image.height;
    return {{image.width, image.height},
            {(image.width + side - 1) / side, (image.height + side - 1) / side},
            level,
            s.bins,
            s.ln_low(),
            s.bins_per_ln(),
            uint32_t(std::clamp<uint64_t>(0xf0000000u / (2 * pixels), 1, 4096)),
            s.split ? 1u : 0u,
            1,
            0};
}

/// `fine`: texels of level 1, if it votes too.
shared::Histogram count(PassRig& rig, const std::vector<glm::vec4>& texels, VkExtent2D image,
                        const shared::HistogramPush& p, const HistogramSettings& s,
                        const std::vector<glm::vec4>& fine = {}) {
    graph::FrameGraph graph;
    const VkExtent2D size{p.level_size.x, p.level_size.y}, first{(image.width + 1) / 2, (image.height + 1) / 2};
    const graph::Resource level = rig.image(graph, "level", render::kSceneFormat, size, texels);
    render::Pyramid pyramid{std::vector<graph::Resource>(p.level, level), std::vector<VkExtent2D>(p.level, size)};
    if (!fine.empty())
        pyramid.levels[0] = rig.image(graph, "first", render::kSceneFormat, first, fine), pyramid.extents[0] = first;
    const graph::Resource kept =
        keep<shared::Histogram>(graph, render::add_histogram(rig.frame(graph, image), pyramid, p.level, s));
    rig.run(graph);
    return rig.got<shared::Histogram>(kept).at(0);
}

TEST(Histogram, MatchesTheReferenceAtEverySizeAndLevel) {
    PassRig rig;
    for (VkExtent2D image : {VkExtent2D{1, 1}, {7, 5}, {131, 67}, {1680, 1050}})
        for (uint32_t level : {1u, 2u, 5u})
            for (uint32_t bins : {1u, 100u, 256u}) {
                const HistogramSettings settings{.bins = bins, .overlap = false};
                auto p = push_of(image, level, settings);
                const auto texels = random_level(p, -6, 9, image.width + level);
                reference::Votes want;
                reference::vote(want, std::span<const glm::vec4>(texels), p);
                std::vector<glm::vec4> fine;
                if (level > 1) {
                    auto first = push_of(image, 1, settings);
                    first.census = 0;
                    fine = random_level(first, -6, 9, image.width);
                    reference::vote(want, std::span<const glm::vec4>(fine), first);
                }
                // Each texel rounds its votes, and its position is in doubt; errors of many add up like a random walk,
                // so that a thousandth of a bin's votes is far more than they come to.
                const double rounding = std::sqrt(double(texels.size() + fine.size())) + 1;
                const double allowed =
                    rounding + kDoubt * want.counted.votes / std::sqrt(double(texels.size() + fine.size()));
                EXPECT_TRUE(want.admits(count(rig, texels, image, p, settings, fine), allowed))
                    << image.width << " x " << image.height << " level " << level << ", " << bins << " bins";
            }
    EXPECT_EQ(rig.complaints(), "");
}

// Texels that overlap by halvings of their side, as many as there are levels below; of pixels that are not finite, too.
TEST(Histogram, OverlappingTexelsMatchTheReference) {
    PassRig rig;
    std::mt19937 random(11);
    std::uniform_real_distribution<float> decades(-5, 7);
    for (VkExtent2D image : {VkExtent2D{2, 1}, {7, 5}, {131, 67}, {250, 1}})
        for (uint32_t level : {2u, 3u, 5u}) {
            std::vector<glm::vec4> pixels;
            for (uint32_t i = 0; i < image.width * image.height; ++i)
                pixels.emplace_back(
                    glm::vec3(i % 17 == 3 ? std::numeric_limits<float>::quiet_NaN() : std::pow(10.0f, decades(random))),
                    1);
            const auto levels = reference::pyramid(std::span<const glm::vec4>(pixels), image.width, image.height);
            if (level > levels.size()) continue;
            const HistogramSettings settings;
            const uint32_t halvings = std::min(level - 1, 3u);
            const auto texels = reference::overlapping(levels[level - halvings - 1], 1u << halvings);
            auto p = push_of(image, level, settings), first = push_of(image, 1, settings);
            p.level_size = {texels.width, texels.height}, p.census = 0, p.overlap = 2 * halvings;
            reference::Votes want;
            reference::vote(want, std::span<const glm::dvec4>(texels.texels), p);
            reference::vote(want, std::span<const glm::dvec4>(levels[0].texels), first);

            graph::FrameGraph graph;
            const render::Pyramid pyramid = render::add_pyramid(
                rig.frame(graph, image), rig.image(graph, "scene", render::kSceneFormat, image, pixels));
            const graph::Resource kept = keep<shared::Histogram>(
                graph, render::add_histogram(rig.frame(graph, image), pyramid, level, settings));
            rig.run(graph);
            // As above: texels round, and their positions are in doubt.
            const double count = std::sqrt(double(texels.texels.size() + levels[0].texels.size()));
            EXPECT_TRUE(want.admits(rig.got<shared::Histogram>(kept).at(0),
                                    count + 1 + 10 * kDoubt * want.counted.votes / count))
                << image.width << " x " << image.height << " level " << level;
        }
    EXPECT_EQ(rig.complaints(), "");
}

// As the paper has it: whole votes of the foveal level alone. A texel at an edge may fall on either side.
TEST(Histogram, WholeVotesOfOneLevel) {
    PassRig rig;
    const VkExtent2D image{1680, 1050};
    const HistogramSettings settings{.split = false, .fine = false, .overlap = false};
    const auto p = push_of(image, 5, settings);
    const auto texels = random_level(p, -6, 9, 3);
    reference::Votes want;
    reference::vote(want, std::span<const glm::vec4>(texels), p);
    const auto got = count(rig, texels, image, p, settings);
    EXPECT_EQ(got.votes, got.finite * p.votes);
    EXPECT_TRUE(want.admits(got, 1024.0 * p.votes));
    int whole = 0;
    for (uint32_t i = 0; i < settings.bins; ++i) whole += got.count[i] == want.count[i];
    EXPECT_GE(whole, 98) << "one texel at an edge at most";
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
    for (uint32_t i = 0; i < 100; ++i) EXPECT_NEAR(got.count[i], 4 * p.votes, 4 * p.votes * kDoubt) << "bin " << i;
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
    EXPECT_EQ(got.count[0], 12u * p.votes);
    EXPECT_EQ(got.count[99], 7u * p.votes);
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
    graph::FrameGraph graph;
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, image, pixels);
    const render::Pyramid pyramid = render::add_pyramid(rig.frame(graph, image), scene);
    const graph::Resource kept =
        keep<shared::Histogram>(graph, render::add_histogram(rig.frame(graph, image), pyramid, 3, {}));
    rig.run(graph);
    const auto got = rig.got<shared::Histogram>(kept).at(0);
    EXPECT_EQ(got.non_finite, 51u);
    EXPECT_EQ(got.finite, 561u - 51u);
    // log10 0.3 = -0.5229: 0.27 bins above the middle of bin 34. Both levels vote.
    EXPECT_EQ(got.count[34] + got.count[35], got.votes);
    EXPECT_NEAR(got.votes / (2.0 * got.finite * push_of(image, 3, {}).votes), 1, 1e-3)
        << "texels that overlap round their votes";
    EXPECT_NEAR(double(got.count[35]) / got.votes, 0.271213, kDoubt);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Histogram, RefusesImpossibleSettings) {
    PassRig rig;
    graph::FrameGraph graph;
    const graph::Resource level = rig.image(graph, "level", render::kSceneFormat, {1, 1}, std::vector{glm::vec4(1)});
    const render::Pyramid pyramid{{level}, {{1, 1}}};
    const render::FrameContext frame = rig.frame(graph, VkExtent2D{1, 1});
    EXPECT_THROW(render::add_histogram(frame, pyramid, 1, {.bins = 0}), Error);
    EXPECT_THROW(render::add_histogram(frame, pyramid, 1, {.bins = 257}), Error);
    EXPECT_THROW(render::add_histogram(frame, pyramid, 0, {}), Error);
    EXPECT_THROW(render::add_histogram(frame, pyramid, 2, {}), Error);
}

}  // namespace
}  // namespace vesper::test::histogram_test
