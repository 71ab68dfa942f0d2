// The luminance pyramid on the device against its reference. SPDX-License-Identifier: MIT
#include "passes/pyramid_reference.h"

#include <random>

#include "render/passes/pyramid.h"
#include "support/compare.h"
#include "support/texels.h"

namespace vesper::test::pyramid_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// Twelve decades in one frame, coloured.
std::vector<glm::vec4> night(VkExtent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> decades(-4, 8), tint(0.3f, 1.5f);
    std::vector<glm::vec4> pixels(size_t(extent.width) * extent.height);
    for (glm::vec4& p : pixels) {
        const float l = std::pow(10.0f, decades(random));
        p = {l * tint(random), l * tint(random), l * tint(random), 1};
    }
    return pixels;
}

void expect_pyramid(const std::vector<glm::vec4>& pixels, VkExtent2D extent, float log_epsilon = 0) {
    PassRig rig;
    graph::FrameGraph graph;
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, extent, pixels);
    const render::Pyramid pyramid = render::add_pyramid(rig.frame(graph, extent), scene, log_epsilon);
    std::vector<graph::Resource> kept;
    for (graph::Resource level : pyramid.levels) kept.push_back(keep<glm::vec4>(graph, level));
    rig.run(graph);

    const auto want =
        reference::pyramid(std::span<const glm::vec4>(pixels), extent.width, extent.height, double(log_epsilon));
    ASSERT_EQ(kept.size(), want.size());
    for (size_t k = 0; k < want.size(); ++k) {
        ASSERT_EQ(pyramid.extents[k].width, want[k].width);
        ASSERT_EQ(pyramid.extents[k].height, want[k].height);
        const auto got = rig.got<glm::vec4>(kept[k]);
        Picture got_means(want[k].width, want[k].height, 2), want_means = got_means,
                                                             got_ln(want[k].width, want[k].height, 1), want_ln = got_ln;
        for (size_t i = 0; i < got.size(); ++i) {
            EXPECT_EQ(got[i].g, want[k].texels[i].y) << "pixels of texel " << i << " of level " << k + 1;
            got_means.values[2 * i] = got[i].r, got_means.values[2 * i + 1] = got[i].a;
            want_means.values[2 * i] = want[k].texels[i].x, want_means.values[2 * i + 1] = want[k].texels[i].w;
            got_ln.values[i] = got[i].b, want_ln.values[i] = want[k].texels[i].z;
        }
        const std::string level = "level " + std::to_string(k + 1);
        // 2e-6: eleven levels of four-term sums in float, each good to half an ulp per operation.
        EXPECT_TRUE(same_light(level + " mean and maximum", got_means, want_means, {2e-6, 1e-30}));
        // 1e-5 of ln, absolute: lavapipe's logarithm is good to about 1e-6, times values of up to 20.
        EXPECT_TRUE(same_light(level + " ln", got_ln, want_ln, {1e-6, 10}));
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Pyramid, MatchesTheReferenceAtEverySize) {
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {2, 1}, {1, 3}, {7, 5}, {64, 64}, {131, 67}, {130, 3}}) {
        SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
        expect_pyramid(night(extent, extent.width), extent);
    }
}

TEST(Pyramid, MatchesTheReferenceOfAWholeFrame) { expect_pyramid(night({1680, 1050}, 5), {1680, 1050}); }

TEST(Pyramid, LeavesOutWhatIsNotFinite) {
    const VkExtent2D extent{37, 22};
    auto pixels = night(extent, 9);
    for (size_t i = 0; i < pixels.size(); i += 5) pixels[i][int(i % 3)] = i % 2 ? kNan : kInf;
    for (uint32_t y = 0; y < 4; ++y)
        for (uint32_t x = 8; x < 12; ++x)
            pixels[y * extent.width + x] = {kNan, -kInf, 1, 1};  // a whole texel of level 2
    expect_pyramid(pixels, extent);
}

TEST(Pyramid, CountsBlackAndNegativePixels) {
    const VkExtent2D extent{9, 6};
    auto pixels = night(extent, 3);
    for (size_t i = 0; i < pixels.size(); i += 4) pixels[i] = i % 8 ? glm::vec4(0) : glm::vec4(-2, -1, -3, 1);
    pixels[0] = pixels[1] = pixels[9] = pixels[10] = {-1, -1, -1, 1};  // a texel whose maximum is negative
    expect_pyramid(pixels, extent);
}

TEST(Pyramid, TakesLogarithmsOfAnyFloat) {
    const VkExtent2D extent{23, 14};
    std::vector<glm::vec4> pixels(23 * 14);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> decades(-37, 36);
    for (glm::vec4& p : pixels) p = glm::vec4(std::pow(10.0f, decades(random)));
    expect_pyramid(pixels, extent);
    expect_pyramid(pixels, extent, 1e-6f);
    expect_pyramid(pixels, extent, 1e-30f);
}

TEST(Pyramid, FovealTexelIsNearestToADegree) {
    // tone-mapping.md, 2.3: 1920 px over 60 degrees: 29 px to the degree, level 5; over 90 degrees 16.8, level 4.
    render::Pyramid pyramid;
    pyramid.levels.resize(11);
    const auto level = [&](uint32_t width, double horizontal_degrees) {
        gpu_scene::View view;
        view.extent = {width, width / 2};
        const float tangent = float(std::tan(horizontal_degrees / 2 * 3.14159265358979 / 180));
        view.tangent_high = {tangent, tangent / 2}, view.tangent_low = -view.tangent_high;
        return render::foveal_level(view, pyramid);
    };
    EXPECT_EQ(level(1920, 60), 5u);
    EXPECT_EQ(level(1920, 90), 4u);
    EXPECT_EQ(level(3840, 60), 6u);
    EXPECT_EQ(level(20, 90), 1u) << "never the image itself";
}

}  // namespace
}  // namespace vesper::test::pyramid_test
