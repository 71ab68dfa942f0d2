// Pictures that change over time: what the eye remembers, and what must not be seen. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>

#include "render/tone_mapper.h"
#include "support/tones.h"

namespace vesper::test {
namespace {

using render::Operator, render::ToneMapped;

constexpr VkExtent2D kLookExtent{96, 60};

class ToneTime : public testing::Test {
protected:
    std::string complaints;
    gpu::Device device{
        {.select = "", .validation = true, .on_message = [this](const std::string& m) { complaints += m + "\n"; }}};

    static ToneMapped map(render::ToneMapper& mapper, const std::vector<glm::vec4>& pixels, float seconds,
                          Operator op = Operator::Irawan, VkExtent2D extent = kLookExtent) {
        render::ToneChainSettings settings;
        settings.tone_operator = op;
        settings.foveal_level = 3;
        return mapper.map(
            settings,
            {.extent = extent, .values = {&pixels.front().x, pixels.size() * 4}, .channels = 4, .vertical_fov = 0.7},
            seconds, {});
    }
    void TearDown() override { EXPECT_EQ(complaints, ""); }
};

/// A road from 0.02 to 5 cd/m^2 below a dark sky, with a lamp of 4 x 3 pixels.
std::vector<glm::vec4> road(float lamp, float level = 1) {
    std::vector<glm::vec4> pixels;
    for (uint32_t y = 0; y < kLookExtent.height; ++y)
        for (uint32_t x = 0; x < kLookExtent.width; ++x) {
            const bool is_lamp = x >= 40 && x < 44 && y >= 10 && y < 13;
            const float l = is_lamp ? lamp
                            : y < 25
                                ? 0.005f
                                : level * 0.02f * std::pow(250.0f, float(y - 25) / 35 * (0.5f + 0.5f * float(x) / 96));
            pixels.emplace_back(l, l, 0.8f * l, 1);
        }
    return pixels;
}

int largest_step(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b, bool without_lamp) {
    int most = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const size_t x = i / 4 % kLookExtent.width, y = i / 4 / kLookExtent.width;
        if (without_lamp && x >= 40 && x < 44 && y >= 10 && y < 13) continue;
        most = std::max(most, std::abs(int(a[i]) - int(b[i])));
    }
    return most;
}

TEST_F(ToneTime, ALampThatFlickersMovesNothingElse) {
    for (Operator op : {Operator::Irawan, Operator::Ward}) {
        render::ToneMapper mapper(device);
        std::vector<uint8_t> before;
        for (int frame = 0; frame < 60; ++frame) {
            const double t = frame / 60.0;
            const auto got = map(mapper, road(float(3000 * (1 + 0.8 * std::sin(2 * 3.14159265 * 90 * t + 0.3)))),
                                 frame ? 1.0f / 60 : 0, op);
            if (frame > 12) {
                EXPECT_LE(largest_step(got.display, before, true), 1) << "frame " << frame;
            }
            before = got.display;
        }
    }
}

// The whole road grows brighter by 0.2 % a frame, over eight edges of bins: what is shown follows, one code at a time.
TEST_F(ToneTime, NothingJumpsAsPixelsCrossTheEdgesOfBins) {
    render::ToneMapper mapper(device);
    std::vector<uint8_t> before;
    for (int frame = 0; frame < 120; ++frame) {
        const auto got = map(mapper, road(3000, 4 * std::pow(1.002f, float(frame))), frame ? 1.0f / 60 : 0);
        if (frame > 1) {
            EXPECT_LE(largest_step(got.display, before, false), 1) << "frame " << frame;
        }
        before = got.display;
    }
}

// An edge of 1 : 3,000 to 300,000 moves by a pixel at a time, over a texel of the foveal level: the rest is shown as
// before. A pixel is half a percent of the picture, and of its light.
TEST_F(ToneTime, AnEdgeThatMovesByAPixelMovesNothingElse) {
    constexpr VkExtent2D extent{224, 96};
    for (Operator op : {Operator::Irawan, Operator::Ward}) {
        render::ToneMapper mapper(device);
        std::vector<double> before;
        for (uint32_t edge = 130; edge < 164; ++edge) {
            std::vector<glm::vec4> pixels;
            for (uint32_t y = 0; y < extent.height; ++y)
                for (uint32_t x = 0; x < extent.width; ++x) {
                    const float road = 0.02f * std::pow(100.0f, float((7 * x + 13 * y) % 96) / 96);
                    pixels.emplace_back(glm::vec3(x < edge ? road : 6000.0f), 1.0f);
                }
            mapper.reset_adaptation();
            render::ToneChainSettings settings;
            settings.tone_operator = op;
            settings.foveal_level = 5;
            settings.tone.gaze = {0.2f, 0.5f};
            const ToneMapped got = mapper.map(settings,
                                              {.extent = extent,
                                               .values = {&pixels.front().x, pixels.size() * 4},
                                               .channels = 4,
                                               .vertical_fov = 0.7},
                                              0, {});
            std::vector<double> shown;
            for (float luminance : {0.03f, 0.1f, 0.3f, 1.0f})
                shown.push_back(std::exp(
                    got.curve.node[size_t((std::log(luminance) - got.curve.ln_low) * got.curve.bins_per_ln)].x));
            for (size_t i = 0; i < before.size(); ++i)
                EXPECT_NEAR(shown[i] / before[i], 1, 0.05)
                    << render::operator_info(op).name << ", edge at " << edge << ", " << i;
            before = shown;
        }
    }
}

TEST_F(ToneTime, FrameRatesDoNotMatter) {
    const auto run = [&](int steps) {
        render::ToneMapper mapper(device);
        map(mapper, road(3000, 2000), 0);
        ToneMapped got;
        for (int i = 0; i < steps; ++i) got = map(mapper, road(3000, 3), 1.0f / float(steps));
        return got;
    };
    const ToneMapped many = run(60), few = run(30);
    EXPECT_NEAR(many.curve.cone_sigma / few.curve.cone_sigma, 1, 1e-3) << "0.5 % are asked for";
    EXPECT_LE(largest_step(many.display, few.display, false), 1);
}

TEST_F(ToneTime, ACutForgetsAndAPauseFreezes) {
    render::ToneMapper mapper(device), fresh(device);
    map(mapper, road(3000, 2000), 0);
    const ToneMapped before = map(mapper, road(3000, 3), 0.1f), paused = map(mapper, road(3000, 3), 0);
    EXPECT_EQ(paused.display, before.display);
    EXPECT_EQ(std::memcmp(&paused.eye, &before.eye, sizeof before.eye), 0);
    mapper.reset_adaptation();
    const ToneMapped cut = map(mapper, road(3000, 3), 0.1f), first = map(fresh, road(3000, 3), 0.1f);
    EXPECT_EQ(cut.display, first.display);
    EXPECT_NE(cut.display, before.display);
}

TEST_F(ToneTime, TheStateSurvivesANewSizeAndCanBeCarriedOver) {
    render::ToneMapper mapper(device), other(device);
    const ToneMapped day = map(mapper, road(3000, 2000), 0);
    const std::vector<glm::vec4> small(40 * 20, glm::vec4(0.5f));
    const ToneMapped night = map(mapper, small, 0.05f, Operator::Irawan, {40, 20});
    EXPECT_LT(night.curve.cone_sigma, day.curve.cone_sigma);
    EXPECT_GT(night.curve.cone_sigma, 40) << "adapted to 0.5 cd/m^2 it would be 23";
    other.set_eye(day.eye);
    const ToneMapped carried = map(other, small, 0.05f, Operator::Irawan, {40, 20});
    EXPECT_EQ(carried.display, night.display);
    EXPECT_EQ(std::memcmp(&carried.eye, &night.eye, sizeof night.eye), 0);
}

}  // namespace
}  // namespace vesper::test
