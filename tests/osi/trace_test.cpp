// Traces of other simulators, whole and broken. SPDX-License-Identifier: MIT
#include "osi/trace.h"

#include <gtest/gtest.h>

#include "osi/written_messages.h"
#include "support/complaints.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

using Bytes = std::vector<uint8_t>;

TEST(OsiTrace, HasItsMessagesInOrder) {
    const osi::Trace trace = osi::parse_trace(written_messages(), "a.osi");
    ASSERT_EQ(trace.messages.size(), 3u);
    EXPECT_TRUE(trace.notes.empty());
    std::string again;
    for (const osi::Message& message : trace.messages) again += osi::trace_bytes_of(message);
    const osi::Trace same = osi::parse_trace(Bytes(again.begin(), again.end()), "b.osi");
    ASSERT_EQ(same.messages.size(), 3u);
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(same.messages[i].nanoseconds, trace.messages[i].nanoseconds);
}

TEST(OsiTrace, WhatCannotBeReadIsSaid) {
    const auto refused = [](const Bytes& bytes, const std::vector<std::string>& words) {
        const std::string said = complaint_of([&] { osi::parse_trace(bytes, "a.osi"); });
        for (const std::string& word : words) EXPECT_TRUE(contains(said, word));
    };
    const size_t second = kWrittenMessages[1].begin;
    const std::string place = "message 2 at byte " + std::to_string(second - 4);
    Bytes huge = written_messages();
    huge[second - 1] = 255;  // of the second length
    refused(huge, {"a.osi", place, "at most"});
    Bytes broken = written_messages();
    broken[second] = 0xff;  // a field of no kind
    refused(broken, {"a.osi", place, "GroundTruth"});
    refused({}, {"a.osi", "has no message"});
    refused({1, 0, 0}, {"message 1 at byte 0", "cut off"});
    refused({0, 0, 0, 0}, {"message 1", "no timestamp"});
    refused({0x89, 'M', 'C', 'A', 'P', '0'}, {"MCAP", "pip install mcap", "iter_messages", "TRACE.osi"});
}

// The rest is read where a part is missing.
TEST(OsiTrace, WhatIsMissingIsNoted) {
    Bytes cut = written_messages();
    cut.resize(cut.size() - 7);
    const osi::Trace shorter = osi::parse_trace(cut, "a.osi");
    EXPECT_EQ(shorter.messages.size(), 2u);
    ASSERT_EQ(shorter.notes.size(), 1u);
    EXPECT_TRUE(contains(shorter.notes[0], "ends within message 3"));

    const Bytes all = written_messages();
    const auto second = all.begin() + ptrdiff_t(kWrittenMessages[1].begin - 4);
    Bytes turned(second, all.end());  // the first message last
    turned.insert(turned.end(), all.begin(), second);
    const osi::Trace late = osi::parse_trace(turned, "a.osi");
    EXPECT_EQ(late.messages.size(), 2u);
    ASSERT_EQ(late.notes.size(), 1u);
    EXPECT_TRUE(contains(late.notes[0], "1 messages are not later"));
}

// A trace of another program: two cars for 7 s.
TEST(OsiTrace, OfOthersIsRead) {
    const auto file =
        shared_data("scenario/openmaterial/20250320T135754Z_sv_360_2112_140_scenario_example_two_vehicles.osi");
    if (!is_here(file)) GTEST_SKIP() << "no shared data";
    const osi::Trace trace = osi::read_trace(file);
    ASSERT_EQ(trace.messages.size(), 140u);
    for (const osi::Message& message : trace.messages) ASSERT_EQ(message.objects.size(), 2u);
    EXPECT_NEAR(trace.messages[0].objects[0].size.x, 3.854, 1e-6);
    EXPECT_NEAR(glm::length(*trace.messages[0].objects[0].velocity), 14, 0.1);
    EXPECT_NEAR(double(trace.messages.back().nanoseconds - trace.messages.front().nanoseconds), 6.95e9, 1e3);
}

// A trace of other things, such as of lanes alone, is no drive: it is noted, and one message with an object is enough.
TEST(OsiTrace, IsNotedWhereNothingMoves) {
    const auto notes_of = [](const osi::Message& last) {
        const std::string bytes = osi::trace_bytes_of({.nanoseconds = 1}) + osi::trace_bytes_of(last);
        return osi::parse_trace({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "a.osi").notes;
    };
    osi::Message last{.nanoseconds = 2};
    last.traffic_lights.push_back({.id = 1});
    ASSERT_EQ(notes_of(last).size(), 1u);
    EXPECT_NE(notes_of(last)[0].find("nothing moves"), std::string::npos);
    last.objects.push_back({.id = 2, .velocity = {}});
    EXPECT_TRUE(notes_of(last).empty());
}

}  // namespace
}  // namespace vesper::test
