// The glare of the display image on the device against its references. SPDX-License-Identifier: MIT
#include "passes/bloom_reference.h"

#include "render/passes/bloom.h"
#include "support/compare.h"
#include "support/texels.h"
#include "support/tones.h"

namespace vesper::test::bloom_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Inputs {
    gpu_scene::View view;
    std::vector<glm::vec4> scene;
    shared::ToneCurve curve = crooked_curve({});
    vision::Display display{};
    render::BloomSettings settings{};
};

gpu_scene::View view_of(VkExtent2D extent) {
    return gpu_scene::View::symmetric(extent, 0.02f * float(extent.height) / 57.2958f, glm::mat4(1));
}

Picture glare(PassRig& rig, const Inputs& in, uint32_t tone) {
    graph::FrameGraph graph;
    const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, in.view.extent, in.scene);
    const graph::Resource curve = graph.upload("curve", std::vector{in.curve}, VK_FORMAT_R32G32B32A32_SFLOAT);
    const graph::Resource kept = keep<uint64_t>(
        graph, render::add_bloom(rig.frame(graph, in.view), scene, curve, tone, in.display, in.settings));
    rig.run(graph);
    const uint32_t w = (in.view.extent.width + 3) / 4, h = (in.view.extent.height + 3) / 4;
    const auto texels = from_halves(rig.got<uint64_t>(kept));
    Picture p(w, h, 3);
    for (size_t i = 0; i < size_t(w) * h; ++i)
        for (size_t c = 0; c < 3; ++c) p.values[3 * i + c] = texels[i][int(c)];
    return p;
}

reference::LightImage shown(const Inputs& in, uint32_t tone) {
    reference::LightImage image{in.view.extent.width, in.view.extent.height, {}};
    for (const glm::vec4& p : in.scene)
        image.pixels.push_back(
            reference::displayed(glm::dvec3(p), tone, in.curve, in.display.low(), in.display.high()));
    return image;
}

Picture picture(const reference::LightImage& image) {
    Picture p(image.width, image.height, 3);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (size_t c = 0; c < 3; ++c) p.values[3 * i + c] = image.pixels[i][int(c)];
    return p;
}

/// A pixel that lies within rounding of the threshold would glare or not by chance: moves it away.
void avoid_threshold(Inputs& in, uint32_t tone) {
    for (glm::vec4& p : in.scene) {
        const auto light = reference::displayed(glm::dvec3(p), tone, in.curve, in.display.low(), in.display.high());
        if (std::abs(reference::luminance(light) - in.settings.threshold) < 1e-3)
            p *= tone == shared::kToneLdr ? 0.9f : 0.1f;
    }
}

void expect_reference(PassRig& rig, Inputs in, uint32_t tone) {
    avoid_threshold(in, tone);
    const double sigma = reference::small_sigma(in.settings.sigma_degrees, in.view.degrees_per_pixel());
    const auto want = reference::bloom(shown(in, tone), in.settings.threshold, sigma);
    // Stored three times in 16-bit floats, each time rounded to nearest or towards zero as the device likes: up to an
    // ulp of 2^-10 each, of at least the smallest normal number, 6e-5. The float arithmetic between is far below that.
    EXPECT_TRUE(same_light("glare of tone " + std::to_string(tone), glare(rig, in, tone), picture(want),
                           {6.1 * kHalfUlp16, 6e-5}));
}

TEST(Bloom, MatchesTheReferenceForEveryOperatorAndSize) {
    PassRig rig;
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {7, 5}, {64, 64}, {261, 37}})
        for (uint32_t tone : kEveryTone) {
            SCOPED_TRACE(std::to_string(extent.width) + " x " + std::to_string(extent.height));
            const float high = tone == shared::kToneLdr ? 0.3f : 5;
            expect_reference(
                rig, {view_of(extent), night_pixels(extent, extent.width + tone, -2, high), crooked_curve_of(tone, {})},
                tone);
        }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Bloom, MatchesTheReferenceOfAWholeFrame) {
    PassRig rig;
    const VkExtent2D extent{1680, 1050};
    expect_reference(rig, {gpu_scene::View::symmetric(extent, 0.6f, glm::mat4(1)), night_pixels(extent, 3, -2, 4)},
                     shared::kToneCurve);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Bloom, MatchesTheReferenceForEveryWidthAndThreshold) {
    PassRig rig;
    const VkExtent2D extent{90, 70};
    for (float sigma : {0.01f, 0.2f, 1.5f})
        for (float threshold : {0.0f, 0.5f, 0.99f}) {
            Inputs in{view_of(extent), night_pixels(extent, 5, -2, 5)};
            in.settings = {.threshold = threshold, .sigma_degrees = sigma};
            SCOPED_TRACE("sigma " + std::to_string(sigma) + ", threshold " + std::to_string(threshold));
            expect_reference(rig, in, shared::kToneCurve);
        }
    EXPECT_EQ(rig.complaints(), "");
}

/// Black but for a lamp of some pixels.
Inputs lamp(VkExtent2D extent, glm::uvec2 corner, glm::uvec2 size, float luminance) {
    Inputs in{view_of(extent),
              std::vector<glm::vec4>(size_t(extent.width) * extent.height, glm::vec4(0.01f, 0.01f, 0.01f, 1))};
    for (uint32_t y = corner.y; y < corner.y + size.y; ++y)
        for (uint32_t x = corner.x; x < corner.x + size.x; ++x)
            in.scene[y * extent.width + x] = {luminance, luminance, luminance, 1};
    in.curve = crooked_curve_of(shared::kToneReinhard, {});
    return in;
}

TEST(Bloom, SpreadsTheLampsLightAndMakesNone) {
    PassRig rig;
    Inputs in = lamp({240, 200}, {101, 90}, {9, 7}, 1e6f);
    in.settings.sigma_degrees = 0.16f;  // 8 px
    const Picture got = glare(rig, in, shared::kToneReinhard);
    double sum = 0;
    for (uint32_t y = 0; y < got.height; ++y)
        for (uint32_t x = 0; x < got.width; ++x) sum += got.at(x, y, 1) * 16;
    EXPECT_NEAR(sum, 63, 63 * 6 * kHalfUlp16) << "63 pixels of white";
    EXPECT_EQ(rig.complaints(), "");
}

// A field of view of hardly any angle is narrower than the Gaussian, whose radius stays at 256 texels: weights of
// 1/513.
TEST(Bloom, ViewsOfHardlyAnyAngleGlareEvenly) {
    PassRig rig;
    Inputs in = lamp({240, 200}, {0, 0}, {240, 200}, 1e6f);
    for (float angle : {1e-4f, 1e-36f}) {
        in.view = gpu_scene::View::symmetric(in.view.extent, angle, glm::mat4(1));
        const Picture got = glare(rig, in, shared::kToneReinhard);
        const double want = 60 * 50 / (513.0 * 513.0);
        // At 1e-4 rad the weights fall by 0.35 % towards the radius; three roundings as above.
        for (const auto value : got.values) EXPECT_NEAR(value, want, want * 0.005) << angle;
    }
    EXPECT_EQ(rig.complaints(), "");
}

// Against the definition: every pixel of the full image, a round Gaussian, no blocks. The bound is the approximation's
// own, see glare_reference_test: 6 % of the peak at 9 px; and three roundings of 16-bit floats.
TEST(Bloom, IsNearTheFullResolutionConvolution) {
    PassRig rig;
    Inputs in = lamp({120, 96}, {51, 40}, {7, 6}, 1e6f);
    in.settings.sigma_degrees = 0.18f;  // 9 px
    const Picture small = glare(rig, in, shared::kToneReinhard);
    std::vector<glm::dvec3> texels;
    for (size_t i = 0; i < small.values.size(); i += 3)
        texels.emplace_back(small.values[i], small.values[i + 1], small.values[i + 2]);
    const auto exact = reference::direct_glare(shown(in, shared::kToneReinhard), in.settings.threshold,
                                               0.18 / in.view.degrees_per_pixel());
    double most = 0, worst = 0;
    for (uint32_t y = 0; y < exact.height; ++y)
        for (uint32_t x = 0; x < exact.width; ++x) {
            const auto up = reference::bilinear(std::span<const glm::dvec3>(texels), small.width, small.height,
                                                (glm::dvec2(x, y) + 0.5) / 4.0 - 0.5);
            most = std::max(most, exact.at(x, y).y), worst = std::max(worst, std::abs(up.y - exact.at(x, y).y));
        }
    EXPECT_GT(most, 0.05);
    EXPECT_LT(worst, 0.065 * most);
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Bloom, DarkImagesAndNanDoNotGlare) {
    PassRig rig;
    Inputs in = lamp({37, 29}, {0, 0}, {0, 0}, 0);
    for (size_t i = 0; i < in.scene.size(); i += 3) in.scene[i] = {kNan, 1e9f, 1e9f, 1};
    for (uint32_t tone : kEveryTone) {
        in.curve = crooked_curve_of(tone, {});
        const Picture got = glare(rig, in, tone);
        for (double v : got.values) EXPECT_EQ(v, 0);
    }
    EXPECT_EQ(rig.complaints(), "");
}

TEST(Bloom, WithoutGainThereIsNoPass) {
    PassRig rig;
    graph::FrameGraph graph;
    const render::FrameContext frame = rig.frame(graph, VkExtent2D{8, 8});
    const graph::Resource scene = graph.transient("scene", graph::image_shape(render::kSceneFormat, {8, 8}));
    EXPECT_EQ(render::add_bloom(frame, scene, {}, shared::kToneLinear, {}, {.gain = 0}), graph::Resource{});
    EXPECT_TRUE(graph.passes().empty());
}

}  // namespace
}  // namespace vesper::test::bloom_test
