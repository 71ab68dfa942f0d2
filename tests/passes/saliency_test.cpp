// Saliency on the device against its reference. SPDX-License-Identifier: MIT
#include "passes/saliency_reference.h"

#include <random>

#include "render/passes/saliency.h"
#include "support/compare.h"
#include "support/texels.h"

namespace vesper::test::saliency_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// A dim textured scene with lamps and coloured signs.
std::vector<glm::vec4> street(VkExtent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<glm::vec4> pixels(size_t(extent.width) * extent.height);
    for (size_t i = 0; i < pixels.size(); ++i) {
        const float l = 0.02f * std::pow(10.0f, float(i % extent.width) / 300) * (0.5f + unit(random));
        pixels[i] = {l * 1.2f, l, l * 0.6f, 1};
    }
    for (int lamp = 0; lamp < 9; ++lamp) {
        const auto x = uint32_t(unit(random) * float(extent.width)), y = uint32_t(unit(random) * float(extent.height));
        const glm::vec4 rgb{std::pow(10.0f, 5 * unit(random)), std::pow(10.0f, 5 * unit(random)),
                            std::pow(10.0f, 5 * unit(random)), 1};
        for (uint32_t v = y; v < std::min(y + 3 + uint32_t(lamp), extent.height); ++v)
            for (uint32_t u = x; u < std::min(x + 12 - uint32_t(lamp), extent.width); ++u)
                pixels[size_t(v) * extent.width + u] = rgb;
    }
    return pixels;
}

std::vector<glm::vec4> saliency(PassRig& rig, VkExtent2D extent, const std::vector<glm::vec4>& pixels) {
    graph::FrameGraph graph;
    const render::Saliency made =
        render::add_saliency(rig.frame(graph, extent), rig.image(graph, "scene", render::kSceneFormat, extent, pixels));
    const graph::Resource kept = keep<glm::vec4>(graph, made.map);
    rig.run(graph);
    return rig.got<glm::vec4>(kept);
}

void expect_reference(PassRig& rig, VkExtent2D extent, const std::vector<glm::vec4>& pixels, double tolerance = 2e-5) {
    const auto got = saliency(rig, extent, pixels);
    const auto want = reference::saliency(std::span<const glm::vec4>(pixels), int(extent.width), int(extent.height));
    Picture got_maps(uint32_t(want[0].width), uint32_t(want[0].height), 4), want_maps = got_maps;
    ASSERT_EQ(4 * got.size(), want_maps.values.size());
    for (size_t i = 0; i < got.size(); ++i)
        for (size_t k = 0; k < 4; ++k)
            got_maps.values[4 * i + k] = double(got[i][int(k)]), want_maps.values[4 * i + k] = want[k].values[i];
    // 2e-5: maps of at most 1, from differences of means of up to 65536 floats (1e-6 of them), which promotion squares
    // twice.
    EXPECT_TRUE(same_light(std::to_string(extent.width) + " x " + std::to_string(extent.height), got_maps, want_maps,
                           {tolerance, 1}));
}

TEST(Saliency, MatchesTheReferenceAtEverySize) {
    PassRig rig;
    for (const VkExtent2D extent :
         {VkExtent2D{32, 32}, {33, 64}, {131, 67}, {149, 300}, {257, 256}, {420, 263}, {1021, 517}})
        expect_reference(rig, extent, street(extent, extent.width));
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Saliency, MatchesTheReferenceWhereThereAreHolesAndWildValues) {
    PassRig rig;
    const VkExtent2D extent{300, 270};
    auto pixels = street(extent, 5);
    for (size_t i = 0; i < pixels.size(); i += 7) pixels[i][int(i % 3)] = i % 2 ? kNan : kInf;
    for (uint32_t y = 100; y < 180; ++y)
        for (uint32_t x = 0; x < 110; ++x) pixels[y * extent.width + x] = {kNan, -kInf, 1, 1};
    for (uint32_t x = 0; x < 300; x += 3) pixels[40 * extent.width + x] = {-3, 2, -1, 1};
    expect_reference(rig, extent, pixels);
    for (uint32_t y = 200; y < 208; ++y)  // around it all contrasts are the same but for rounding
        for (uint32_t x = 200; x < 208; ++x) pixels[y * extent.width + x] = {3e38f, 1, 1, 1};
    const auto wild = saliency(rig, extent, pixels);
    for (const glm::vec4& texel : wild)
        for (int k = 0; k < 4; ++k) EXPECT_TRUE(texel[k] >= 0 && texel[k] <= 1.00001f) << texel[k];
    const auto least = [](const glm::vec4& a, const glm::vec4& b) { return a.y < b.y; };
    EXPECT_EQ(std::max_element(wild.begin(), wild.end(), least) - wild.begin(), 200 / 16 * 19 + 200 / 16);
    std::fill(pixels.begin(), pixels.end(), glm::vec4(kNan));
    for (const glm::vec4& texel : saliency(rig, extent, pixels)) EXPECT_EQ(texel, glm::vec4(0));
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Saliency, MatchesTheReferenceWhereContrastIsTooLittleToBeStretched) {
    PassRig rig;
    const VkExtent2D extent{279, 301};
    std::vector<glm::vec4> pixels(size_t(extent.width) * extent.height, glm::vec4(2, 2, 2, 1));
    for (uint32_t y = 90; y < 130; ++y)
        for (uint32_t x = 150; x < 170; ++x) pixels[y * extent.width + x] = {2.003f, 2.003f, 2.003f, 1};
    // Luminance is rounded by 1e-7 of it, which is 1e-4 of this contrast, and promotion takes its third power twice.
    expect_reference(rig, extent, pixels, 1e-3);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Saliency, NothingStandsOutOfEvenLight) {
    PassRig rig;
    for (const float l : {0.0f, 0.37f, 1e8f})
        for (const glm::vec4& texel : saliency(rig, {279, 301}, std::vector<glm::vec4>(279 * 301, glm::vec4(l))))
            for (int k = 0; k < 4; ++k) ASSERT_LT(texel[k], 1e-9f) << l;
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Saliency, IsTheSameBitsAgain) {
    PassRig rig;
    const auto pixels = street({301, 299}, 8);
    const auto first = saliency(rig, {301, 299}, pixels), second = saliency(rig, {301, 299}, pixels);
    EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof first[0]), 0);
}

TEST(Saliency, HasNoMapWithoutLevelsToCompare) {
    PassRig rig;
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {31, 500}, {500, 31}}) {
        graph::FrameGraph graph;
        const graph::Resource scene = graph.transient("scene", graph::image_shape(render::kSceneFormat, extent));
        EXPECT_FALSE(render::add_saliency(rig.frame(graph, extent), scene).map);
        EXPECT_TRUE(graph.passes().empty());
    }
    EXPECT_EQ(render::saliency_pairs({32, 90}).size(), 1u);
    EXPECT_EQ(render::saliency_pairs({64, 64}).size(), 3u);
    EXPECT_EQ(render::saliency_pairs({128, 200}).size(), 5u);
    EXPECT_EQ(render::saliency_pairs({256, 256}).size(), 6u);
}

}  // namespace
}  // namespace vesper::test::saliency_test
