// Pictures through the whole tone chain on the device, against its parts in double. SPDX-License-Identifier: MIT
#include "render/tone_mapper.h"

#include <gtest/gtest.h>

#include "support/reference_chain.h"
#include "support/tones.h"

namespace vesper::test {
namespace {

class ToneMapperTest : public testing::Test {
protected:
    std::string complaints;
    gpu::Device device{
        {.select = "", .validation = true, .on_message = [this](const std::string& m) { complaints += m + "\n"; }}};
    render::ToneMapper mapper{device};

    render::ToneMapped map(const std::vector<glm::vec4>& pixels, VkExtent2D extent,
                           const render::ToneChainSettings& settings = {}, float seconds = 0,
                           render::Outputs outputs = {}) {
        const std::span<const float> rgba(&pixels.front().x, pixels.size() * 4);
        return mapper.map(settings, {.extent = extent, .values = rgba, .channels = 4}, seconds, outputs);
    }
    void TearDown() override { EXPECT_EQ(complaints, ""); }
};

TEST_F(ToneMapperTest, EqualsTheReferencesOfItsPasses) {
    for (VkExtent2D extent : {VkExtent2D{1, 1}, {64, 1}, {201, 133}}) {
        const auto pixels = night_pixels(extent, extent.width, -3, 4);
        for (const render::OperatorInfo& op : render::operators()) {
            render::ToneChainSettings settings;
            settings.tone_operator = op.tone_operator;
            settings.tone.operators.linear.high = 100;
            settings.tone.colour_loss = settings.tone.purkinje = extent.height == 1;
            const uint32_t tone = op.form | (extent.height == 1 ? shared::kToneColourLoss | shared::kTonePurkinje : 0);
            mapper.reset_adaptation();
            const render::ToneMapped got = map(pixels, extent, settings);
            const auto want = reference_codes(pixels, extent, settings, tone, got.foveal_level, 0);
            // One pixel in 10,000; a texel on the edge of a bin may vote for either side.
            EXPECT_LE(pixels_off(got.display, want), pixels.size() / 10000) << extent.width << " tone " << tone;
            EXPECT_EQ(got.display.size(), pixels.size() * 4);
        }
    }
}

TEST_F(ToneMapperTest, TheEyeRemembersThroughAChangeOfSizeUntilItIsReset) {
    EXPECT_EQ(map(night_pixels({30, 20}, 1), {30, 20}).eye.seconds, 0);
    EXPECT_EQ(map(night_pixels({30, 20}, 1), {30, 20}, {}, 0.5f).eye.seconds, 0.5f);
    EXPECT_EQ(map(night_pixels({9, 70}, 2), {9, 70}, {}, 0.25f).eye.seconds, 0.75f);
    EXPECT_EQ(map(night_pixels({1, 1}, 2), {1, 1}, {}, 0.25f).eye.seconds, 1.0f);
    mapper.reset_adaptation();
    EXPECT_EQ(map(night_pixels({30, 20}, 1), {30, 20}, {}, 0.5f).eye.seconds, 0.5f);
}

TEST_F(ToneMapperTest, GivesWhatIsAskedFor) {
    const auto pixels = night_pixels({7, 5}, 3);
    const render::ToneMapped both = map(pixels, {7, 5}, {}, 0, {.display = true, .scene = true});
    ASSERT_EQ(both.scene.size(), pixels.size() * 4);
    EXPECT_EQ(std::memcmp(both.scene.data(), pixels.data(), pixels.size() * 16), 0);
    const render::ToneMapped neither = map(pixels, {7, 5}, {}, 0, {.display = false, .scene = false});
    EXPECT_TRUE(neither.scene.empty() && neither.display.empty());
    EXPECT_TRUE(neither.display_light.empty());
    EXPECT_EQ(std::memcmp(&neither.curve, &both.curve, sizeof both.curve), 0);
    EXPECT_NE(mapper.plan().find("adapt"), std::string::npos);
    for (const graph::Timing& timing : neither.timings) EXPECT_NE(timing.pass, "composite") << "nobody looks";
}

TEST_F(ToneMapperTest, ScalesToCandela) {
    const std::vector<float> rgb{1, 2, 3, 0.5f, 0.5f, 0.5f};
    const render::ToneMapped got =
        mapper.map({}, {.extent = {2, 1}, .values = rgb, .scale = 100}, 0, {.display = false, .scene = true});
    EXPECT_EQ(got.scene, (std::vector<float>{100, 200, 300, 1, 50, 50, 50, 1}));
}

// Reinhard shows the largest luminance as white; colours go beyond it where nothing limits them, and on the display
// they do not.
TEST_F(ToneMapperTest, LightOfTheDisplayGoesBeyondWhite) {
    render::ToneChainSettings settings;
    settings.tone_operator = render::Operator::Reinhard;
    const std::vector<float> rgb{0, 0, 100, 1, 1, 1};
    const render::ToneMapped got = mapper.map(settings, {.extent = {2, 1}, .values = rgb}, 0, {.display_light = true});
    const double low = double(settings.display.low()), high = double(settings.display.high());
    ASSERT_EQ(got.display_light.size(), 8u);
    EXPECT_NEAR(double(got.display_light[2]), low + (high - low) / 0.072192, 0.05);
    EXPECT_NEAR(double(got.display_light[0]), low, 1e-5);
    EXPECT_EQ(got.display[2], 255);
}

TEST_F(ToneMapperTest, RefusesWhatIsNoPicture) {
    EXPECT_THROW(map(night_pixels({3, 3}, 1), {3, 4}), Error);
    EXPECT_THROW(map(night_pixels({3, 3}, 1), {0, 9}), Error);
    const std::vector<float> grey(3, 1.0f);
    EXPECT_NO_THROW(mapper.map({}, {.extent = {1, 1}, .values = grey}, 0));
    EXPECT_THROW(mapper.map({}, {.extent = {1, 1}, .values = grey, .channels = 4}, 0), Error);
    EXPECT_THROW(mapper.map({}, {.extent = {3, 1}, .values = grey, .channels = 1}, 0), Error);
    for (double fov : {0.0, -1.0, 3.2, std::nan("")})
        EXPECT_THROW(mapper.map({}, {.extent = {1, 1}, .values = grey, .vertical_fov = fov}, 0), Error);
}

}  // namespace
}  // namespace vesper::test
