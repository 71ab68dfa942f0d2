// Lists of events of a drive. SPDX-License-Identifier: MIT
#include "session/drive_events.h"

#include <malloc.h>

#include <gtest/gtest.h>

namespace vesper::test {
namespace {

using Kind = drive::DriveEvent::Kind;

TEST(DriveEvents, ComeOutAsTheyWentIn) {
    std::vector<drive::DriveEvent> wanted;
    const auto add = [&](Kind kind, traffic::DriverInput input = {}, std::optional<glm::dvec4> pose = {},
                         const std::string& name = "", uint64_t place = 0) {
        wanted.push_back({.kind = kind,
                          .input = input,
                          .pose = pose,
                          .name = name,
                          .value = name.empty() ? "" : name + " value",
                          .place = place});
    };
    add(Kind::Frame);
    add(Kind::Step);
    add(Kind::Step, {.throttle = 1});
    add(Kind::Set, {}, {}, "operator", 7);
    add(Kind::Step, {.throttle = 1}, glm::dvec4(1, 2, 3, 4));
    add(Kind::Frame);
    add(Kind::Step, {.throttle = 1});
    add(Kind::Step, {.steering = -0.5, .beam = traffic::Beam::High}, glm::dvec4(5, 6, 7, 8));
    add(Kind::Restart);
    add(Kind::Set, {}, {}, "age", 9);
    add(Kind::Step);
    add(Kind::Frame);
    wanted[2].shown = 1.5, wanted[7].shown = -2.5;
    drive::DriveEvents events;
    for (const drive::DriveEvent& event : wanted) events.push_back(event);
    EXPECT_EQ(events.size(), wanted.size());
    EXPECT_EQ(events.frames(), 3u);
    for (int again = 0; again < 2; ++again) {
        size_t i = 0;
        for (const drive::DriveEvent& event : events) {
            ASSERT_LT(i, wanted.size());
            EXPECT_EQ(event.kind, wanted[i].kind) << i;
            EXPECT_EQ(event.input, wanted[i].input) << i;
            EXPECT_EQ(event.pose, wanted[i].pose) << i;
            EXPECT_EQ(event.shown, wanted[i].shown) << i;
            EXPECT_EQ(event.name, wanted[i].name) << i;
            EXPECT_EQ(event.value, wanted[i].value) << i;
            EXPECT_EQ(event.place, wanted[i].place) << i;
            ++i;
        }
        EXPECT_EQ(i, wanted.size());
    }
    EXPECT_TRUE(drive::DriveEvents().begin() == drive::DriveEvents().end());
}

// A day of driving: 5 million steps and half as many frames.
TEST(DriveEvents, OfADayTakeFewMegabytes) {
    const auto taken = [] {
        const auto heap = mallinfo2();
        return heap.uordblks + heap.hblkhd;
    };
    constexpr size_t kSteps = 86400 * 60;
    const size_t before = taken();
    drive::DriveEvents events;
    for (size_t i = 0; i < kSteps; ++i) {
        events.push_back(
            {.kind = Kind::Step, .input = {.autopilot = true}, .pose = {}, .shown = {}, .name = {}, .value = {}});
        if (i % 2) events.push_back({.kind = Kind::Frame, .name = {}, .value = {}});
    }
    EXPECT_LT(taken() - before, 2 * events.size()) << "1 byte each, in a list that has room for twice as many";
    const size_t unknown = taken();
    drive::DriveEvents driven;
    for (size_t i = 0; i < kSteps; ++i)
        driven.push_back({.kind = Kind::Step, .pose = glm::dvec4(double(i)), .name = {}, .value = {}});
    EXPECT_LT(taken() - unknown, 36 * kSteps) << "33 bytes each, and some room";
}

}  // namespace
}  // namespace vesper::test
