// Senders whose angles or lengths are not those of OSI. SPDX-License-Identifier: MIT
#include "osi/unit_check.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "osi/trace.h"
#include "support/complaints.h"

namespace vesper::test {
namespace {

constexpr double kPi = std::numbers::pi;

// Two cars on circles about one middle, counter-clockwise, 15 s of them: every direction.
std::vector<osi::Message> circling(const std::function<double(double)>& yaw_of, double unit = 1) {
    std::vector<osi::Message> messages;
    for (int i = 0; i <= 150; ++i) {
        osi::Message message{.nanoseconds = int64_t{100'000'000} * i, .host = 1};
        for (const uint64_t id : {1, 2}) {
            const double turn = 0.05 * i + 2 * double(id), radius = 20 * double(id);
            const double direction = std::remainder(turn + kPi / 2, 2 * kPi);
            message.objects.push_back({.id = id,
                                       .kind = osi::MovingObject::Kind::Car,
                                       .size = unit * glm::dvec3(4.4, 1.8, 1.5),
                                       .centre = unit * glm::dvec3(radius * std::cos(turn), radius * std::sin(turn), 0),
                                       .yaw = yaw_of(direction),
                                       .velocity = {}});
        }
        messages.push_back(message);
    }
    return messages;
}

std::vector<std::string> doubts_of(const std::vector<osi::Message>& messages) {
    osi::UnitCheck check;
    for (const osi::Message& message : messages) check.add(message);
    return check.doubts();
}

void expect_doubt(const std::vector<std::string>& doubts, const char* words) {
    ASSERT_EQ(doubts.size(), 1u) << words;
    EXPECT_TRUE(contains(doubts[0], words)) << doubts[0];
}

TEST(OsiUnits, ThoseOfTheStandardAreNotDoubted) {
    EXPECT_TRUE(doubts_of(circling([](double d) { return d; })).empty());
    EXPECT_TRUE(doubts_of(circling([](double d) { return d + 6 * kPi; })).empty()) << "turned more than once";
    EXPECT_TRUE(doubts_of(circling([](double d) { return d + 0.2; })).empty()) << "a drift";
    EXPECT_TRUE(doubts_of(circling([](double d) { return d + kPi; })).empty()) << "backwards";
    EXPECT_TRUE(doubts_of(circling([](double) { return 0; })).empty()) << "none is stated";
    EXPECT_TRUE(doubts_of({}).empty());
}

TEST(OsiUnits, OtherAnglesAreToldByTheWay) {
    const auto degrees = [](double rad) { return rad * 180 / kPi; };
    expect_doubt(doubts_of(circling([&](double d) { return degrees(d); })), "only as degrees: OSI has radians");
    expect_doubt(doubts_of(circling([&](double d) { return degrees(d) + 360; })), "only as degrees: OSI has radians");
    expect_doubt(doubts_of(circling([](double d) { return -d; })), "radians, clockwise from x");
    expect_doubt(doubts_of(circling([&](double d) { return -degrees(d); })), "degrees, clockwise from x");
    expect_doubt(doubts_of(circling([](double d) { return kPi / 2 - d; })), "radians, clockwise from y");
    expect_doubt(doubts_of(circling([&](double d) { return degrees(kPi / 2 - d); })), "degrees, clockwise from y");
}

TEST(OsiUnits, CentimetresAreToldByCars) {
    const std::vector<std::string> doubts = doubts_of(circling([](double d) { return d; }, 100));
    ASSERT_EQ(doubts.size(), 2u);
    EXPECT_TRUE(contains(doubts[0], "100 % of the cars are longer than 30 m"));
    EXPECT_TRUE(contains(doubts[1], "faster than 150 m/s"));
    // Millimetres without sizes: told by the speeds alone.
    std::vector<osi::Message> sizeless = circling([](double d) { return d; }, 1000);
    for (osi::Message& message : sizeless)
        for (osi::MovingObject& object : message.objects) object.size = {};
    expect_doubt(doubts_of(sizeless), "faster than 150 m/s");
    std::vector<osi::Message> one = circling([](double d) { return d; });
    for (osi::Message& message : one) message.objects[0].size.x = 40;
    EXPECT_TRUE(doubts_of(one).empty()) << "one of two";
}

// Few, standing, and jumping back in time: nothing is said.
TEST(OsiUnits, FewTellNothing) {
    std::vector<osi::Message> messages = circling([](double d) { return d * 180 / kPi; });
    EXPECT_TRUE(doubts_of({messages.begin(), messages.begin() + 3}).empty());
    std::vector<osi::Message> still(50, messages[0]);
    EXPECT_TRUE(doubts_of(still).empty());
    for (osi::Message& message : messages) message.nanoseconds = 0;
    EXPECT_TRUE(doubts_of(messages).empty());
}

TEST(OsiUnits, TracesAreNoted) {
    std::string bytes;
    for (const osi::Message& message : circling([](double d) { return d * 180 / kPi; }))
        bytes += osi::trace_bytes_of(message);
    const osi::Trace trace = osi::parse_trace({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "a.osi");
    ASSERT_EQ(trace.notes.size(), 1u);
    EXPECT_TRUE(contains(trace.notes[0], "a.osi: 100 % of the yaws"));
}

}  // namespace
}  // namespace vesper::test
