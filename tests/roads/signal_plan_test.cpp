// Plans of traffic lights: one lens each, and no two crossing ways green together. SPDX-License-Identifier: MIT
#include <algorithm>
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

size_t index_of(const roads::RoadNetwork& network, const std::string& id) {
    const auto found = std::ranges::find(network.roads, id, &roads::Road::id);
    EXPECT_NE(found, network.roads.end()) << id;
    return static_cast<size_t>(found - network.roads.begin());
}

/// Seconds of 100 in which the first is green, and in which all of them are.
std::pair<int, int> greens(const roads::RoadNetwork& network, const std::vector<std::string>& signals) {
    const std::map<std::string, roads::SignalPhase> phases = roads::lit_roads(network, {.every_lens = true}).phases;
    int first = 0, all = 0;
    for (double time = 0.5; time < 100; time += 1) {
        const auto is_green = [&](const std::string& name) {
            return roads::aspect_at(phases.at(name), time) == SignalAspect::Green;
        };
        first += is_green(signals[0]), all += std::ranges::all_of(signals, is_green);
    }
    return {first, all};
}

// Heads on the far side, turned step by step from the way of W to that of S, join neither to the other.
TEST(SignalPlans, HeadsBehindAJunctionJoinNoWaysThatCross) {
    roads::RoadNetwork network = network_of(crossing_text(false));
    for (const char* road : {"E", "N"})
        for (int k = 0; k < 4; ++k) {
            std::vector<roads::RoadSignal>& signals = network.roads[index_of(network, road)].signals;
            roads::RoadSignal far = signals[0];
            far.id = "far " + std::string(road) + std::to_string(k), far.t = -5, far.orientation = '+';
            far.heading = (road[0] == 'E' ? 0.5 : -0.5) * k;
            signals.push_back(far);
        }
    EXPECT_EQ(greens(network, {"signal_W1", "signal_S1"}), (std::pair{40, 0}));
    EXPECT_EQ(greens(network, {"signal_W1", "signal_far E0"}), (std::pair{40, 40}));
    EXPECT_EQ(greens(network, {"signal_S1", "signal_far N0"}), (std::pair{40, 40}));
}

// Each faces nearly as the one before, and the last the other way.
TEST(SignalPlans, LightsOfARoadAreNotChained) {
    roads::RoadNetwork network = network_of(crossing_text(false));
    std::vector<roads::RoadSignal>& signals = network.roads[index_of(network, "W")].signals;
    for (int k = 1; k <= 6; ++k) {
        signals.push_back(signals[0]);
        signals.back().id = "turned " + std::to_string(k), signals.back().heading = 0.5 * k;
    }
    EXPECT_EQ(greens(network, {"signal_W1", "signal_turned 6"}).second, 0);
    EXPECT_GT(greens(network, {"signal_W1", "signal_turned 1"}).second, 0);
}

// Two heads for all of 2,000 ways: neither pairs of them without end, nor memory that nobody counts.
TEST(SignalPlans, ManyWaysAreTakenToConflict) {
    roads::RoadNetwork network = network_of(crossing_text(false));
    const size_t way = index_of(network, "c0");
    for (int i = 0; i < 2000; ++i) {
        network.roads.push_back(network.roads[way]);
        network.roads.back().id = "way " + std::to_string(i), network.roads.back().sections.clear();
        network.roads.back().signal_references = {i % 2 ? "W1" : "S1"};
    }
    EXPECT_EQ(greens(network, {"signal_W1", "signal_S1"}).second, 0);
}

// Each way has a light of its own: those from one road go together, though they begin at one point.
TEST(SignalPlans, WaysFromOneRoadDoNotConflict) {
    roads::RoadNetwork network = network_of(crossing_text(true));
    const roads::RoadSignal head = network.roads[index_of(network, "W")].signals[0];
    for (roads::Road& road : network.roads) {
        road.signals.clear();
        if (road.junction == roads::kNoRoad) continue;
        roads::RoadSignal own = head;
        own.id = road.id, own.s = 0.5, own.t = -1.75, own.orientation = '+';
        road.signals.push_back(own);
    }
    // Ways c0, c2, c4, c6 from E, N, W, S lead straight on; the next of each to the left.
    for (const auto& [straight, left] : {std::pair{"c0", "c1"}, {"c2", "c3"}, {"c4", "c5"}, {"c6", "c7"}}) {
        const auto [first, both] = greens(network, {"signal_" + std::string(straight), "signal_" + std::string(left)});
        EXPECT_GT(first, 0) << straight;
        EXPECT_EQ(both, first) << straight;
    }
    EXPECT_EQ(greens(network, {"signal_c0", "signal_c2"}).second, 0);
    EXPECT_EQ(greens(network, {"signal_c0", "signal_c5"}).second, 0) << "to the left across oncoming cars";
}

// A light that stands beside another road is for the one that states it.
TEST(SignalPlans, CountWhereTheyAreStated) {
    std::string text = crossing_text(false);
    const size_t at = text.find("<signal id=\"W1\""), end = text.find("/>", at);
    text.replace(end, 2, "><positionRoad roadId=\"S\" s=\"2.2\" t=\"3\" zOffset=\"5.3\"/></signal>");
    const roads::RoadNetwork network = network_of(text);
    EXPECT_TRUE(network.notes.empty()) << network.notes[0];
    EXPECT_EQ(network.roads[index_of(network, "S")].signals.size(), 3u);
    EXPECT_EQ(greens(network, {"signal_W1", "signal_W2"}), (std::pair{40, 40}));
    EXPECT_EQ(greens(network, {"signal_W1", "signal_S1"}), (std::pair{40, 0}));
}

TEST(SignalPlans, LightsOfOneIdAreNumbered) {
    roads::RoadNetwork network = network_of(crossing_text(false));
    for (const char* road : {"W", "S"}) network.roads[index_of(network, road)].signals[0].id = "7";
    // Roads come in the order E, N, W, S.
    EXPECT_EQ(greens(network, {"signal_7", "signal_7#2"}), (std::pair{40, 0}));
    EXPECT_EQ(greens(network, {"signal_7", "signal_W2"}), (std::pair{40, 40}));
    EXPECT_EQ(greens(network, {"signal_7#2", "signal_S2"}), (std::pair{40, 40}));
    const roads::LitRoads lit = roads::lit_roads(network, {.every_lens = true});
    EXPECT_EQ(lit.phases.size(), 8u);
    network.roads[index_of(network, "E")].signals[0].id = "7#2";  // the first of all
    EXPECT_EQ(roads::lit_roads(network, {.every_lens = true}).phases.size(), 8u);
    EXPECT_TRUE(std::ranges::any_of(lit.notes, [](const std::string& note) {
        return note.starts_with("traffic lights with the id of another: 1,");
    }));
}

// A million controls of one signal are one.
TEST(SignalPlans, RepeatsOfAControllerAreOne) {
    roads::RoadNetwork network = network_of(crossing_text(false));
    network.controllers.resize(40'000);
    for (size_t i = 0; i < network.controllers.size(); ++i) {
        network.controllers[i].id = i % 2 == 0 ? "a" : "b";
        network.controllers[i].signals.assign(25, i % 2 == 0 ? "W1" : "S1");
    }
    for (const char* road : {"W", "S"}) {
        std::vector<roads::RoadSignal>& signals = network.roads[index_of(network, road)].signals;
        signals.resize(100, signals[0]);
    }
    EXPECT_EQ(greens(network, {"signal_W1", "signal_S1"}), (std::pair{40, 0}));
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
