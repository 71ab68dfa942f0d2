// Pictures through the whole tone chain to a projector. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "render/tone_mapper.h"
#include "support/complaints.h"
#include "support/operator_chain.h"
#include "support/rooms.h"
#include "support/texels.h"

namespace vesper::test::projection_chain_test {
namespace {

using eye::Projection, eye::projection_of, render::ToneMapped;

class ProjectionChain : public testing::Test {
protected:
    std::string complaints;
    gpu::Device device{
        {.select = "", .validation = true, .on_message = [this](const std::string& m) { complaints += m + "\n"; }}};
    render::ToneMapper mapper{device};

    ToneMapped map(const std::vector<glm::vec4>& pixels, VkExtent2D extent, const Projection* projection,
                   const render::ToneChainSettings& settings = {}) {
        mapper.reset_adaptation();
        const std::span<const float> rgba(&pixels.front().x, pixels.size() * 4);
        return mapper.map(settings, {.extent = extent, .values = rgba, .channels = 4}, 0, {.projection = projection});
    }
    void TearDown() override { EXPECT_EQ(complaints, ""); }
};

/// Displays and glare that take other ways through the composite.
std::vector<render::ToneChainSettings> ways() {
    std::vector<render::ToneChainSettings> made(3);
    made[1].glare = render::Glare::Ldr;
    for (const vision::NamedDisplay& known : vision::known_displays())
        if (known.display.bits == 10) made[2].display = known.display;
    return made;
}

// Pixels that are not finite among them.
TEST_F(ProjectionChain, TheStraightOneHasTheVeryCodes) {
    for (const VkExtent2D extent : {VkExtent2D{1, 1}, {37, 23}, {131, 67}})
        for (const render::ToneChainSettings& settings : ways()) {
            const auto pixels = damaged_pixels(extent);
            const ToneMapped plain = map(pixels, extent, nullptr, settings);
            EXPECT_EQ(plain.shown_extent.width, extent.width);
            EXPECT_EQ(plain.shown_extent.height, extent.height);
            EXPECT_EQ(mapper.plan().find("projection"), std::string::npos);
            const Projection straight = projection_of(extent, extent);
            const ToneMapped got = map(pixels, extent, &straight, settings);
            EXPECT_NE(mapper.plan().find("projection"), std::string::npos);
            EXPECT_EQ(got.display, plain.display) << extent.width << " x " << extent.height;
            EXPECT_EQ(std::memcmp(&got.curve, &plain.curve, sizeof got.curve), 0);
            const double aspect = double(extent.width) / extent.height;
            const vision::WarpMesh mesh{
                "m",
                2,
                2,
                {{-aspect, -1, 0, 0, 1}, {aspect, -1, 1, 0, 1}, {-aspect, 1, 0, 1, 1}, {aspect, 1, 1, 1, 1}}};
            const Projection meshed = projection_of(extent, extent, &mesh);
            EXPECT_EQ(map(pixels, extent, &meshed, settings).display, plain.display);
        }
}

TEST_F(ProjectionChain, AMaskOfOneHalfHalvesTheLightAboveBlack) {
    const VkExtent2D extent{37, 23};
    const auto pixels = damaged_pixels(extent);
    const vision::BlendMask mask{"half.png", 37, 23, std::vector<float>(size_t{37} * 23, 0.5f)};
    const Projection half = projection_of(extent, extent, nullptr, &mask);
    const std::vector<uint8_t> plain = map(pixels, extent, nullptr).display, got = map(pixels, extent, &half).display;
    const vision::Display display;
    const vision::DisplayCurve curve(display);
    const auto light = [&](double code) { return curve.emitted(code / 255) - double(display.black); };
    ASSERT_EQ(got.size(), plain.size());
    size_t lit = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        if (i % 4 == 3) {
            ASSERT_EQ(got[i], 255) << "alpha";
            continue;
        }
        lit += plain[i] > 20;
        // Both codes are rounded: the light is within half a code, and what is half of it within half a code more.
        ASSERT_GE(light(got[i] + 1.0), light(plain[i]) / 2) << i;
        ASSERT_LE(got[i] > 0 ? light(got[i] - 1.0) : 0, light(plain[i]) / 2) << i;
    }
    EXPECT_GT(lit, 1000u);
}

TEST_F(ProjectionChain, TheProjectorsPictureHasItsOwnSize) {
    const VkExtent2D extent{37, 23}, projector{64, 11};
    const auto pixels = damaged_pixels(extent);
    const Projection projection = projection_of(extent, projector);
    const ToneMapped got = map(pixels, extent, &projection);
    EXPECT_EQ(got.extent.width, 37u);
    EXPECT_EQ(got.shown_extent.width, 64u);
    EXPECT_EQ(got.shown_extent.height, 11u);
    EXPECT_EQ(got.display.size(), size_t{64} * 11 * 4);
    const Projection foreign = projection_of({23, 37}, projector);
    EXPECT_TRUE(contains(complaint_of([&] { map(pixels, extent, &foreign); }), "cannot show one of 37 x 23 px"));
}

// Pixels that are not finite spread no further than between pixels: they are black, and what is not drawn is darkest.
TEST_F(ProjectionChain, WhatIsNotDrawnIsDarkest) {
    const VkExtent2D extent{37, 23};
    const std::vector<glm::vec4> bright(size_t{37} * 23, glm::vec4(100, 100, 100, 1));
    Projection holes = projection_of(extent, extent);
    for (size_t i = 0; i < holes.pixels.size(); i += 3) holes.pixels[i].factor = eye::kNotDrawn;
    for (const render::ToneChainSettings& settings : ways()) {
        const ToneMapped plain = map(bright, extent, nullptr, settings), got = map(bright, extent, &holes, settings);
        const ToneMapped black = map(std::vector<glm::vec4>(bright.size(), glm::vec4(0, 0, 0, 1)), extent, nullptr,
                                     {.tone_operator = render::Operator::Ldr, .display = settings.display});
        for (size_t i = 0; i < bright.size(); ++i)
            ASSERT_EQ(std::memcmp(&got.display[4 * i], &(i % 3 ? plain : black).display[4 * i], 4), 0) << i;
    }
}

// A rendered frame, and the mean of what the display shows of its samples.
TEST_F(ProjectionChain, RenderedFramesHaveIt) {
    scene::Scene scene;
    const uint32_t panel = add_material(scene, 0, 20);
    for (int i = -4; i < 4; ++i) add_rectangle(scene, panel, {i / 7.0, -1, -1}, {0.1, 0, 0}, {0, 0.3 * (i + 5), 0});
    render::Renderer renderer(device, scene);
    const VkExtent2D extent{33, 17}, projector{20, 9};
    const gpu_scene::View view = gpu_scene::View::symmetric(extent, 0.9f, glm::dmat4(1));
    const Projection straight = projection_of(extent, extent), small = projection_of(extent, projector);
    for (const bool average : {false, true}) {
        render::RenderSettings settings;
        settings.samples = average ? 4 : 1, settings.display_average = average;
        const auto render = [&](const Projection* projection) {
            renderer.reset_adaptation();
            return renderer.render(settings, view, {scene::world_transforms(scene, 0)}, 0, {.projection = projection});
        };
        const render::Frame plain = render(nullptr), same = render(&straight), other = render(&small);
        EXPECT_EQ(same.display, plain.display) << average;
        EXPECT_NE(*std::max_element(plain.display.begin(), plain.display.end() - 1), 0);
        EXPECT_EQ(other.shown_extent.width, 20u);
        EXPECT_EQ(other.display.size(), size_t{20} * 9 * 4) << average;
    }
}

// The image of a host, blue first, has the codes of the projector's picture, and its extent.
TEST(ProjectionShown, InAnImageOfAHost) {
    PassRig rig;
    const VkExtent2D extent{37, 23}, projector{20, 31};
    const auto pixels = night_pixels(extent, 3, -3, 4);
    gpu::Arena arena(rig.device());
    const gpu::OwnedImage image =
        gpu::make_image(rig.device(), gpu::image_info(VK_FORMAT_B8G8R8A8_UNORM, projector, 1,
                                                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
    arena.bind(image.get());
    graph::ExternalImage shown{image.get(), VK_FORMAT_B8G8R8A8_UNORM, projector, VK_IMAGE_LAYOUT_UNDEFINED,
                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const Projection projection = projection_of(extent, projector);
    const auto run = [&](const render::Outputs& outputs) {
        graph::FrameGraph graph;
        const graph::Resource scene = rig.image(graph, "scene", render::kSceneFormat, extent, pixels);
        const render::ToneChain chain = render::add_tone_chain(rig.frame(graph, extent), scene, {}, {}, outputs);
        rig.run(graph);
        return rig.got<uint32_t>(chain.display);
    };
    const std::vector<uint32_t> plain = run({.projection = &projection});
    run({.shown = shown, .projection = &projection});
    shown.before = shown.after;
    graph::FrameGraph graph;
    const graph::Resource kept = keep<uint32_t>(graph, graph.external("shown", shown));
    rig.run(graph);
    const std::vector<uint32_t> got = rig.got<uint32_t>(kept);
    ASSERT_EQ(got.size(), plain.size());
    for (size_t i = 0; i < got.size(); ++i)
        ASSERT_EQ(got[i], (plain[i] & 0xff00ff00u) | (plain[i] & 0xffu) << 16 | (plain[i] >> 16 & 0xffu)) << i;
    shown.before = VK_IMAGE_LAYOUT_UNDEFINED;
    EXPECT_TRUE(contains(complaint_of([&] { run({.shown = shown}); }), "of another extent"));
    EXPECT_EQ(rig.complaints(), "");
}

}  // namespace
}  // namespace vesper::test::projection_chain_test
