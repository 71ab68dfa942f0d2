// Plans of traffic lights: one lens each, and no two crossing ways green together. SPDX-License-Identifier: MIT
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "base/error.h"
#include "roads/crossing_text.h"
#include "roads/lit_roads.h"
#include "roads/scene_parts.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

using roads::SignalAspect, roads::SignalState;

std::map<std::string, std::string> lit_lenses(const roads::RoadNetwork& network, double time,
                                              SignalState state = SignalState::Plan) {
    roads::LitRoadOptions options;
    options.signals = state, options.signal_time = time;
    std::map<std::string, std::string> lit;
    for (const scene::Node& node : lamps_of(roads::lit_roads(network, options).scene, "signal_")) {
        const size_t slash = node.name.find('/');
        const auto [at, is_new] = lit.emplace(node.name.substr(0, slash), node.name.substr(slash + 1));
        EXPECT_TRUE(is_new) << node.name << " and " << at->second;
    }
    return lit;
}

TEST(SignalPlans, GoThroughTheirPhases) {
    const roads::SignalPhase phase{.cycle = 50, .from = 25, .green = 20, .amber = 3};
    EXPECT_EQ(roads::aspect_at(phase, 0), SignalAspect::Red);
    EXPECT_EQ(roads::aspect_at(phase, 24.9), SignalAspect::Red);
    EXPECT_EQ(roads::aspect_at(phase, 25), SignalAspect::Green);
    EXPECT_EQ(roads::aspect_at(phase, 45.1), SignalAspect::Amber);
    EXPECT_EQ(roads::aspect_at(phase, 48.1), SignalAspect::Red);
    EXPECT_EQ(roads::aspect_at(phase, 1000 + 25.5), SignalAspect::Green);
}

// Four roads meet; two heads on each. Ways straight on alone: opposite ones do not meet.
TEST(SignalPlans, LetOppositeWaysGoTogetherAndNoCrossingOnes) {
    const roads::RoadNetwork network = network_of(crossing_text(false));
    EXPECT_TRUE(network.notes.empty()) << network.notes[0];
    std::map<std::string, int> green;
    for (double time = 0.5; time < 100; time += 1) {
        const auto lit = lit_lenses(network, time);
        ASSERT_EQ(lit.size(), 8u);
        const auto shows = [&](const char* road, int head, const char* colour) {
            return lit.at("signal_" + std::string(road) + std::to_string(head)) == colour;
        };
        for (const char* road : {"W", "E", "S", "N"}) {
            EXPECT_EQ(lit.at("signal_" + std::string(road) + "1"), lit.at("signal_" + std::string(road) + "2")) << time;
            green[road] += shows(road, 1, "green");
        }
        EXPECT_EQ(shows("W", 1, "green"), shows("E", 1, "green"));
        EXPECT_TRUE(shows("W", 1, "red") || shows("S", 1, "red")) << time;
        EXPECT_TRUE(shows("E", 1, "red") || shows("N", 1, "red")) << time;
    }
    for (const char* road : {"W", "E", "S", "N"}) EXPECT_EQ(green[road], 40) << road << ": 20 s of 50 s";
}

// With ways to the left that cross oncoming ones, each road has its own stage; a controller joins two of them.
TEST(SignalPlans, SeparateOppositeWaysThatCross) {
    const roads::RoadNetwork network = network_of(crossing_text(true));
    for (double time = 0.5; time < 100; time += 1) {
        const auto lit = lit_lenses(network, time);
        int green = 0;
        for (const auto& [name, colour] : lit) green += colour == "green";
        EXPECT_LE(green, 2) << time;
    }
    const roads::RoadNetwork joined =
        network_of(crossing_text(true) +
                   "<controller id=\"c\" name=\"c\" sequence=\"0\"><control signalId=\"W1\" type=\"0\"/>"
                   "<control signalId=\"E2\" type=\"0\"/></controller>");
    for (double time = 0.5; time < 100; time += 1) {
        const auto lit = lit_lenses(joined, time);
        EXPECT_EQ(lit.at("signal_W1"), lit.at("signal_E2")) << time;
        EXPECT_EQ(lit.at("signal_W2"), lit.at("signal_E1")) << time;
    }
}

TEST(SignalPlans, AreReplacedByAChosenState) {
    const roads::RoadNetwork network = network_of(crossing_text(false));
    for (const auto& [state, word] : {std::pair{SignalState::Red, "red"}, std::pair{SignalState::Amber, "yellow"},
                                      std::pair{SignalState::Green, "green"}}) {
        const auto lit = lit_lenses(network, 0, state);
        EXPECT_EQ(lit.size(), 8u);
        for (const auto& [name, colour] : lit) EXPECT_EQ(colour, word) << name;
    }
    EXPECT_TRUE(lit_lenses(network, 0, SignalState::Off).empty());
    roads::LitRoadOptions never;
    never.signal_time = -1;
    EXPECT_THROW(roads::lit_roads(network, never), Error);
}

TEST(SignalPlans, LetPeopleOnFootGoAlone) {
    const auto file = shared_data("scenario/esmini/xodr/fabriksgatan_traffic_lights.xodr");
    if (!is_here(file)) GTEST_SKIP() << "no shared data";
    const roads::RoadNetwork network = roads::read_opendrive(file);
    int cars = 0, people = 0;
    for (double time = 0.5; time < 50; time += 1) {
        const auto lit = lit_lenses(network, time);
        ASSERT_EQ(lit.size(), 3u);
        EXPECT_TRUE(lit.at("signal_1") == "red" || (lit.at("signal_2") == "red" && lit.at("signal_3") == "red"));
        cars += lit.at("signal_1") == "green", people += lit.at("signal_2") == "green";
    }
    EXPECT_EQ(cars, 20);
    EXPECT_EQ(people, 12);
}

}  // namespace
}  // namespace vesper::test
