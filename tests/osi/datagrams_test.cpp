// Messages in packets, whole, lost and out of order; and which moment of a sender is shown.
// SPDX-License-Identifier: MIT
#include "osi/datagrams.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "osi/sender_clock.h"

namespace vesper::test {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes packet(int32_t counter, const Bytes& data) {
    Bytes made;
    for (const uint32_t word : {uint32_t(counter), uint32_t(data.size())})
        for (int i = 0; i < 4; ++i) made.push_back(uint8_t(word >> 8 * i));
    made.insert(made.end(), data.begin(), data.end());
    return made;
}

TEST(Datagrams, PacketsAreOneMessage) {
    osi::DatagramReader reader;
    EXPECT_FALSE(reader.take(packet(1, {1, 2})));
    EXPECT_FALSE(reader.take(packet(2, {3})));
    EXPECT_EQ(reader.take(packet(-3, {4, 5})), (Bytes{1, 2, 3, 4, 5}));
    EXPECT_EQ(reader.take(packet(-1, {6})), Bytes{6});
    EXPECT_EQ(reader.take(Bytes{8, 1, 2}), (Bytes{8, 1, 2})) << "a plain one";
    EXPECT_EQ(reader.take(Bytes(20, 7)), Bytes(20, 7));
    EXPECT_EQ(reader.incomplete(), 0u);
}

// Every message of which a packet is missing counts once, whichever it is; the next one is read.
TEST(Datagrams, LostPacketsCostTheirMessage) {
    for (int lost = 1; lost <= 3; ++lost) {
        osi::DatagramReader reader;
        for (const int32_t counter : {1, 2, -3})
            if (std::abs(counter) != lost) {
                EXPECT_FALSE(reader.take(packet(counter, {9})));
            }
        EXPECT_FALSE(reader.take(packet(1, {1})));
        EXPECT_EQ(reader.take(packet(-2, {2})), (Bytes{1, 2})) << lost;
        EXPECT_EQ(reader.incomplete(), 1u) << lost;
    }
    osi::DatagramReader swapped;
    for (const int32_t counter : {1, 3, 2, -4}) EXPECT_FALSE(swapped.take(packet(counter, {9})));
    EXPECT_EQ(swapped.take(packet(-1, {1})), Bytes{1});
    EXPECT_EQ(swapped.incomplete(), 1u);
}

TEST(Datagrams, MessagesHaveAnEnd) {
    osi::DatagramReader reader;
    const Bytes much(60'000, 1);
    for (int32_t counter = 1; counter < 300; ++counter) EXPECT_FALSE(reader.take(packet(counter, much)));
    EXPECT_FALSE(reader.take(packet(-300, much)));
    EXPECT_EQ(reader.incomplete(), 1u);
    EXPECT_EQ(reader.take(packet(-1, {1})), Bytes{1});
}

// Messages each 50 ms that arrive up to 40 ms late, of a sender that runs at any speed.
TEST(SenderClock, FollowsASenderThroughJitter) {
    for (const double rate : {1.0, 0.5, 1.02}) {
        osi::SenderClock clock(0.1);
        std::mt19937 random(1);
        EXPECT_EQ(clock.shown(0), std::nullopt);
        double last = -1e9, worst = 0;
        for (int i = 0; i < 1000; ++i) {
            const double sent = 0.05 * i, arrives = sent / rate + 0.04 * double(random() % 100) / 100.0;
            clock.hear(sent, arrives);
            const double shown = clock.shown(arrives).value();
            EXPECT_GE(shown, last);
            EXPECT_LE(shown, sent);
            if (i > 500) worst = std::max(worst, std::abs(shown - (arrives * rate - 0.1 - 0.02 * rate)));
            last = shown;
        }
        EXPECT_LT(worst, 0.025) << rate;
    }
}

TEST(SenderClock, StopsAndGoesOnWithItsSender) {
    osi::SenderClock clock(0.1);
    for (int i = 0; i <= 100; ++i) clock.hear(0.05 * i, 0.05 * i);
    EXPECT_NEAR(clock.shown(5).value(), 4.9, 0.01);
    EXPECT_EQ(clock.shown(8), 5) << "no further than what is known";
    clock.hear(5.05, 20);
    EXPECT_EQ(clock.shown(20), 5) << "never back";
    for (int i = 1; i <= 20; ++i) clock.hear(5.05 + 0.05 * i, 20 + 0.05 * i);
    EXPECT_NEAR(clock.shown(21).value(), 5.95, 0.02);
}

}  // namespace
}  // namespace vesper::test
