// Means of what a display shows. SPDX-License-Identifier: MIT
#include "render/display_average.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/renderer.h"
#include "support/rooms.h"

namespace vesper::test::display_average_test {
namespace {

using render::DisplayAverage;

TEST(DisplayAverage, IsOfLightAndNotOfCodes) {
    const vision::Display display{.peak = 100, .black = 0, .gamma = 2.2f, .ambient = 0};
    DisplayAverage average(display, 2);
    average.add(std::vector<uint8_t>{0, 10, 255, 255, 7, 7, 7, 255});
    average.add(std::vector<uint8_t>{255, 10, 255, 255, 7, 7, 8, 255});
    const std::vector<uint8_t> got = average.codes();
    EXPECT_EQ(got[0], std::lround(255 * std::pow(0.5, 1 / 2.2))) << "186: half of the light";
    EXPECT_EQ((std::vector(got.begin() + 1, got.begin() + 6)), (std::vector<uint8_t>{10, 255, 255, 7, 7}));
    EXPECT_EQ(got[7], 255);
}

TEST(DisplayAverage, OfOnePictureIsThatPicture) {
    for (const vision::Eotf eotf : {vision::Eotf::Gamma, vision::Eotf::Srgb, vision::Eotf::Pq}) {
        const vision::Display display{.peak = 300, .black = 0.05f, .eotf = eotf};
        std::vector<uint8_t> codes;
        for (uint32_t i = 0; i < 256; ++i)
            codes.insert(codes.end(), {uint8_t(i), uint8_t(255 - i), uint8_t(i / 2), 255});
        DisplayAverage average(display, 256);
        average.add(codes);
        std::vector<uint8_t> got = average.codes();
        if (eotf == vision::Eotf::Pq) {  // whose codes above the peak and below black all show the same
            const vision::DisplayCurve curve(display);
            for (size_t i = 0; i < codes.size(); ++i)
                EXPECT_EQ(curve.emitted(got[i] / 255.0), curve.emitted(codes[i] / 255.0)) << i;
        } else {
            EXPECT_EQ(got, codes);
        }
    }
}

TEST(DisplayAverage, KnowsTenBits) {
    const vision::Display display{.peak = 100, .black = 0, .gamma = 2.2f, .ambient = 0, .bits = 10};
    DisplayAverage average(display, 1);
    const auto bytes_of = [](uint32_t r, uint32_t g, uint32_t b) {
        const uint32_t word = r | g << 10 | b << 20 | 3u << 30;
        return std::vector<uint8_t>{uint8_t(word), uint8_t(word >> 8), uint8_t(word >> 16), uint8_t(word >> 24)};
    };
    average.add(bytes_of(0, 1023, 3)), average.add(bytes_of(1023, 1023, 3));
    EXPECT_EQ(average.codes(), bytes_of(uint32_t(std::lround(1023 * std::pow(0.5, 1 / 2.2))), 1023, 3));
}

// Half of each pixel a panel of 1e5 cd/m^2, half black: shown as white and black side by side, their mean is half the
// light of white; the mean luminance, 5e4, is shown white.
TEST(DisplayAverage, OfAFrameIsWhatAFinerDisplayWouldShow) {
    gpu::Device device({.select = ""});
    scene::Scene scene;
    const uint32_t panel = add_material(scene, 0, 1e5f);
    for (int i = -8; i < 8; ++i) add_rectangle(scene, panel, {float(i) / 16, -1, -1}, {1 / 32.0f, 0, 0}, {0, 2, 0});
    render::Renderer renderer(device, scene);
    render::RenderSettings settings;
    settings.tone_operator = render::Operator::Linear, settings.tone.operators.linear.high = 1e4f;
    settings.samples = 16;
    const gpu_scene::View view = gpu_scene::View::symmetric({16, 16}, 2 * std::atan(0.5f), glm::dmat4(1));
    const auto code = [&] {
        renderer.reset_adaptation();
        const render::Frame frame = renderer.render(settings, view, {scene::world_transforms(scene, 0)}, 0, {});
        return int(frame.display[4 * (16 * 8 + 8)]);
    };
    const int of_luminance = code();
    settings.display_average = true;
    const int of_light = code();
    const vision::DisplayCurve curve(settings.display);
    EXPECT_NEAR(curve.emitted(of_light / 255.0), (curve.emitted(1) + curve.emitted(0)) / 2, 1.0);
    EXPECT_GT(of_luminance, of_light);
}

}  // namespace
}  // namespace vesper::test::display_average_test
