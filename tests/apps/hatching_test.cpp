// Stripes over what a driver cannot see. SPDX-License-Identifier: MIT
#include "record/hatching.h"

#include <cstring>

#include <gtest/gtest.h>

namespace vesper::test::hatching_test {
namespace {

using render::SeenObstacle;

/// An obstacle of 10 arc minutes that is so much brighter than 1 cd/m^2 around it: its level is 12.4 times that.
SeenObstacle obstacle(double more) {
    return {.state = SeenObstacle::State::Measured, .steradians = 6.646e-6, .luminance = 1 + more, .around = 1};
}

/// 6 x 3 px, shown as 12 x 6: columns belong to nothing, and to obstacles 1 to 5, all of grey codes.
render::Frame picture(std::vector<SeenObstacle> obstacles, uint32_t word) {
    render::Frame frame;
    frame.extent = {6, 3}, frame.shown_extent = {12, 6};
    frame.obstacles = std::move(obstacles);
    for (uint8_t i = 0; i < 18; ++i) frame.obstacle_pixels.push_back(uint8_t(i % 6));
    frame.display.resize(12 * 6 * 4);
    for (size_t i = 0; i < frame.display.size(); i += 4) std::memcpy(&frame.display[i], &word, 4);
    return frame;
}

uint32_t word_at(const render::Frame& frame, uint32_t x, uint32_t y) {
    uint32_t word = 0;
    std::memcpy(&word, &frame.display[4 * (y * 12 + x)], 4);
    return word;
}

// Levels of 12, of -8 (darker; its threshold is lower), and of less than 7; one hidden, one on a background that is too
// dark for a level.
TEST(Hatching, IsOfObstaclesThatAreKnownNotToBeSeen) {
    SeenObstacle hidden = obstacle(0), dark = obstacle(0);
    hidden.state = SeenObstacle::State::Hidden, dark.around = 1e-6, dark.luminance = 2e-6;
    for (const uint32_t bits : {8u, 10u}) {
        const uint32_t grey = bits == 8 ? 0xff404040 : 3u << 30 | 256u << 20 | 256u << 10 | 256u;
        const uint32_t bright = bits == 8 ? 0xffbfbfbf : 3u << 30 | 767u << 20 | 767u << 10 | 767u;
        const uint32_t black = bits == 8 ? 0xff000000 : 3u << 30;
        render::RenderSettings settings;
        settings.display.bits = bits;
        render::Frame frame = picture({obstacle(1), obstacle(-0.4), obstacle(0.5), hidden, dark}, grey);
        drive::hatch_unseen(frame, settings, 7);
        for (uint32_t y = 0; y < 6; ++y)
            for (uint32_t x = 0; x < 12; ++x) {
                const uint32_t stripe = (x + y) / 2 % 4;
                const bool third = x == 6 || x == 7;  // the obstacle
                EXPECT_EQ(word_at(frame, x, y), !third || stripe > 1 ? grey
                                                : stripe == 0        ? bright
                                                                     : black)
                    << x << ", " << y;
            }
        // All that is known is below this.
        render::Frame all = picture({obstacle(1), obstacle(-0.4), obstacle(0.5), hidden, dark}, grey);
        drive::hatch_unseen(all, settings, 1000);
        EXPECT_EQ(word_at(all, 2, 0), black);
        EXPECT_EQ(word_at(all, 4, 4), bright);
        EXPECT_EQ(word_at(all, 8, 0), grey) << "hidden";
        EXPECT_EQ(word_at(all, 10, 6 - 1), grey) << "its level is not known";
        EXPECT_EQ(word_at(all, 0, 0), grey) << "nothing";
    }
}

TEST(Hatching, WithoutPixelsOrCodesNothingChanges) {
    render::Frame frame = picture({obstacle(0.1)}, 0xff404040);
    const std::vector<uint8_t> before = frame.display;
    frame.obstacle_pixels.clear();
    drive::hatch_unseen(frame, {}, 7);
    EXPECT_EQ(frame.display, before);
    frame = picture({obstacle(0.1), {}, {}, {}, {}}, 0xff404040);
    frame.display.clear();
    drive::hatch_unseen(frame, {}, 7);
    EXPECT_TRUE(frame.display.empty());
}

}  // namespace
}  // namespace vesper::test::hatching_test
