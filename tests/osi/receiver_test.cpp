// Messages over the loopback interface: lost, reordered, broken, and of somebody else. SPDX-License-Identifier: MIT
#include "osi/receiver.h"

#include <algorithm>
#include <thread>

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

// Only an address of which a message was read is a sender: nothing else keeps the simulator out.
TEST(Receiver, DatagramsThatAreNoMessagesMakeNoSender) {
    const std::string whole = osi::bytes_of(at(0)), without_time = std::string("\x1a\x02\x08\x07", 4);
    for (const std::string& noise :
         {std::string("x"), std::string(), without_time, whole.substr(0, whole.size() - 3)}) {
        osi::Receiver receiver({.port = 0});
        UdpSender squatter(receiver.port()), sender(receiver.port());
        squatter.send(noise);
        sender.send(whole);
        squatter.send(noise);
        squatter.send(whole);
        sender.send_packets(osi::bytes_of(at(20)), 10);
        size_t heard = 0;
        while (receiver.take(300ms)) ++heard;
        EXPECT_EQ(heard, 2u) << noise.size();
        EXPECT_EQ(receiver.counts().malformed, 1u) << noise.size();
        EXPECT_EQ(receiver.counts().foreign, 2u) << "once there is a sender; " << noise.size();
        EXPECT_FALSE(receiver.last_problem().empty());
    }
}

// Packets are put together by their address, also between others', and of more addresses than are kept.
TEST(Receiver, PacketsOfTheFirstMessageComeBetweenOthers) {
    osi::Receiver receiver({.port = 0});
    UdpSender squatter(receiver.port()), sender(receiver.port());
    const std::string bytes = osi::bytes_of(at(0));
    std::vector<std::string> packets;
    for (size_t from = 0; from < bytes.size(); from += 10) {
        const std::string part = bytes.substr(from, 10);
        const auto count = int32_t(packets.size() + 1);
        std::string packet;
        for (const uint32_t word : {uint32_t(from + 10 >= bytes.size() ? -count : count), uint32_t(part.size())})
            for (int i = 0; i < 4; ++i) packet += char(word >> 8 * i & 0xff);
        packets.push_back(packet + part);
    }
    for (int i = 0; i < 20; ++i) UdpSender(receiver.port()).send(packets[0]);
    for (const std::string& packet : packets) {
        squatter.send("x");
        sender.send(packet);
        squatter.send(packets[0]);
    }
    EXPECT_TRUE(receiver.take(500ms));
}

// A sender that goes on without messages is silent.
TEST(Receiver, NoiseDoesNotKeepASendersPlace) {
    osi::Receiver receiver({.port = 0});
    UdpSender first(receiver.port()), second(receiver.port());
    first.send(osi::bytes_of(at(0)));
    EXPECT_TRUE(receiver.take(500ms));
    for (int i = 0; i < 26; ++i) {
        std::this_thread::sleep_for(200ms);
        first.send("x");
    }
    second.send(osi::bytes_of(at(20)));
    EXPECT_TRUE(receiver.take(500ms));
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
