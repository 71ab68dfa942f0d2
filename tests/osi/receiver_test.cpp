// Messages over the loopback interface: lost, reordered, broken, and of somebody else. SPDX-License-Identifier: MIT
#include "osi/receiver.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/error.h"
#include "osi/timeline.h"
#include "support/complaints.h"
#include "support/udp_sender.h"

namespace vesper::test {
namespace {

using namespace std::chrono_literals;

osi::Message at(int milliseconds) {
    osi::Message made{.nanoseconds = milliseconds * int64_t{1'000'000}};
    made.objects.push_back({.id = 1, .centre = {0.01 * milliseconds, 0, 0}, .velocity = {}});
    return made;
}

TEST(Receiver, HearsWhatIsSentAndCountsTheRest) {
    osi::Receiver receiver({.port = 0});
    UdpSender sender(receiver.port()), stranger(receiver.port());
    // Every tenth is lost, and every seventh comes after the one behind it.
    std::vector<int> order;
    for (int i = 0; i < 100; ++i)
        if (i % 10 != 9) order.push_back(i);
    for (size_t i = 0; i + 1 < order.size(); i += 7) std::swap(order[i], order[i + 1]);
    for (const int i : order) {
        const std::string bytes = osi::bytes_of(at(20 * i));
        i % 2 == 0 ? sender.send(bytes) : sender.send_packets(bytes, 10);
        if (i == 20) sender.send("nothing that can be read");
        if (i == 30) stranger.send(bytes);
        if (i == 40) sender.send_packets(bytes, 10, 1);
    }
    osi::Timeline timeline;
    size_t accepted = 0;
    while (const auto arrival = receiver.take(500ms))
        accepted += timeline.add(arrival->message) == osi::Timeline::Added::Accepted;
    const osi::StreamCounts counts = receiver.counts();
    EXPECT_EQ(counts.messages, 90u);
    EXPECT_EQ(counts.malformed, 1u);
    EXPECT_EQ(counts.foreign, 1u);
    EXPECT_EQ(counts.incomplete, 1u);
    EXPECT_EQ(accepted, 89u) << "one came before the first";
    EXPECT_NEAR(timeline.latest(), 1.94, 1e-9);
    EXPECT_FALSE(receiver.take());
}

// A simulation that begins again has earlier times: it goes on where the one before ended.
TEST(Receiver, ASenderMayBeginAgain) {
    osi::Receiver receiver({.port = 0});
    UdpSender sender(receiver.port());
    for (int run = 0; run < 2; ++run)
        for (int i = 0; i < 50; ++i) sender.send(osi::bytes_of(at(100 * i)));
    osi::Timeline timeline;
    while (const auto arrival = receiver.take(500ms)) timeline.add(arrival->message);
    EXPECT_EQ(receiver.counts().restarts, 1u);
    EXPECT_NEAR(timeline.latest(), 4.9 + 0.05 + 4.5, 1e-9) << "five messages tell that it began again";
}

// One message of another time is none of it; several in turn are a sender that went on elsewhere.
TEST(Receiver, LeavesOutWhatIsFarFromTheRest) {
    osi::Receiver receiver({.port = 0});
    UdpSender sender(receiver.port());
    for (int i = 0; i < 20; ++i) {
        sender.send(osi::bytes_of(at(100 * i)));
        if (i == 10) sender.send(osi::bytes_of({.nanoseconds = 3'999'999'999'000'000'000}));
        if (i == 12) sender.send(osi::bytes_of({.nanoseconds = -3'999'999'999'000'000'000}));
    }
    for (int i = 0; i < 10; ++i) sender.send(osi::bytes_of(at(100 * i + 60'000)));
    osi::Timeline timeline;
    while (const auto arrival = receiver.take(500ms)) timeline.add(arrival->message);
    EXPECT_EQ(receiver.counts().astray, 2u + 4u);
    EXPECT_EQ(receiver.counts().restarts, 1u);
    EXPECT_NEAR(timeline.latest(), 1.9 + 0.05 + 0.5, 1e-9);
}

TEST(Receiver, AddressesAreChecked) {
    EXPECT_EQ(osi::parse_address("48198").host, "127.0.0.1");
    EXPECT_EQ(osi::parse_address("0.0.0.0:7").port, 7);
    for (const char* wrong : {"", "x", "1:2:3", "127.0.0.1", "127.0.0.1:", "70000", "-1", "host:5", "1.2.3:5", "5 "})
        EXPECT_THROW(osi::parse_address(wrong), Error) << wrong;
    const osi::Receiver first({.port = 0});
    EXPECT_TRUE(contains(complaint_of([&] { osi::Receiver({.port = first.port()}); }), "in use"));
    EXPECT_TRUE(contains(complaint_of([&] { osi::Receiver({.host = "8.8.8.8", .port = 0}); }), "8.8.8.8:0: "));
}

}  // namespace
}  // namespace vesper::test
