// The graph of lanes on networks of known geometry. SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "places.h"
#include "roads/lanes.h"
#include "roads/road_texts.h"

namespace vesper::test {

using roads::LaneGraph;

namespace {

uint32_t find(const LaneGraph& graph, const std::string& name) {
    for (uint32_t i = 0; i < graph.lanes().size(); ++i)
        if (graph.lanes()[i].name == name) return i;
    ADD_FAILURE() << name;
    return 0;
}

/// Road a 100 m to the north, then road b on a quarter circle of 50 m radius to the left.
roads::RoadNetwork bend(const std::string& attributes = "") {
    const std::string links = "<link><successor id=\"1\"/></link>", back = "<link><predecessor id=\"1\"/></link>";
    const std::string right = "<link><successor id=\"-1\"/></link>",
                      right_back = "<link><predecessor id=\"-1\"/></link>";
    return network_of(road("a", 100, geometry(0, 10, 20, M_PI / 2, 100, "<line/>"), two_way_section(0, links, right),
                           "<link><successor elementType=\"road\" elementId=\"b\" contactPoint=\"start\"/></link><type "
                           "s=\"0\" type=\"town\"><speed max=\"50\" unit=\"km/h\"/></type>",
                           attributes) +
                      road("b", 25 * M_PI, geometry(0, 10, 120, M_PI / 2, 25 * M_PI, "<arc curvature=\"0.02\"/>"),
                           two_way_section(0, back, right_back),
                           "<link><predecessor elementType=\"road\" elementId=\"a\" contactPoint=\"end\"/></link>",
                           attributes));
}

TEST(Lanes, LieWhereTheRoadSays) {
    const LaneGraph graph(bend());
    const uint32_t right = find(graph, "road a, section 0, lane -1"), left = find(graph, "road a, section 0, lane 1");
    // x is X, y is -Z: north is -Z; right-hand traffic northwards is at x = 10 + 1.75.
    const roads::LanePose there = graph.pose(right, 30);
    EXPECT_NEAR(there.position.x, 11.75, 1e-9);
    EXPECT_NEAR(there.position.y, 0, 1e-9);
    EXPECT_NEAR(there.position.z, -50, 1e-9);
    EXPECT_NEAR(there.forward.z, -1, 1e-9);
    EXPECT_NEAR(there.up.y, 1, 1e-9);
    EXPECT_NEAR(there.left().x, -1, 1e-9);
    EXPECT_NEAR(there.width, 3.5, 1e-9);
    EXPECT_NEAR(graph.lanes()[right].length, 100, 1e-9);
    EXPECT_NEAR(graph.lanes()[right].speed_limit, 50 / 3.6, 1e-9);
    const roads::LanePose back = graph.pose(left, 30);
    EXPECT_NEAR(back.position.x, 8.25, 1e-9);
    EXPECT_NEAR(back.position.z, -90, 1e-9);
    EXPECT_NEAR(back.forward.z, 1, 1e-9);
    EXPECT_EQ(graph.lanes()[right].oncoming, left);
    EXPECT_EQ(graph.lanes()[right].left, roads::kNoLane);
    // Beyond the ends: straight on.
    EXPECT_NEAR(graph.pose(right, -5).position.z, -15, 1e-9);
    EXPECT_NEAR(graph.pose_beside(right, 105, 1).position.z, -125, 1e-9);
    EXPECT_NEAR(graph.pose_beside(right, 105, 1).position.x, 10.75, 1e-9);
}

TEST(Lanes, CurveAsTheRoadDoes) {
    const LaneGraph graph(bend());
    const uint32_t bent = find(graph, "road b, section 0, lane -1");
    const double radius = 51.75;
    EXPECT_NEAR(graph.lanes()[bent].length, radius * M_PI / 2, 0.01);
    for (double along = 0; along < radius * M_PI / 2; along += 0.37) {
        const roads::LanePose pose = graph.pose(bent, along);
        const double angle = along / radius;
        const glm::dvec3 want{-40 + radius * std::cos(angle), 0, -120 - radius * std::sin(angle)};
        EXPECT_LT(glm::distance(pose.position, want), 0.01) << along;
        EXPECT_NEAR(std::atan2(-pose.forward.z, pose.forward.x), M_PI / 2 + angle, 2e-3) << along;
        EXPECT_NEAR(pose.curvature, 1 / radius, 2e-4) << along;
    }
}

TEST(Lanes, FollowEachOther) {
    const LaneGraph graph(bend());
    const uint32_t a = find(graph, "road a, section 0, lane -1"), b = find(graph, "road b, section 0, lane -1");
    const uint32_t a_back = find(graph, "road a, section 0, lane 1"), b_back = find(graph, "road b, section 0, lane 1");
    EXPECT_EQ(graph.lanes()[a].successors, std::vector<uint32_t>{b});
    EXPECT_EQ(graph.lanes()[b].predecessors, std::vector<uint32_t>{a});
    EXPECT_EQ(graph.lanes()[b_back].successors, std::vector<uint32_t>{a_back});
    EXPECT_TRUE(graph.lanes()[b].successors.empty());
    EXPECT_EQ(graph.route(a, b), (std::vector<uint32_t>{a, b}));
    EXPECT_TRUE(graph.route(b, a).empty());
    EXPECT_EQ(graph.long_route(a), (std::vector<uint32_t>{a, b}));
    const roads::LanePlace on = graph.advance({a, 90, 0.5}, 20);
    EXPECT_EQ(on.lane, b);
    EXPECT_NEAR(on.along, 10, 1e-6);
    EXPECT_EQ(on.offset, 0.5);
    EXPECT_EQ(graph.advance(on, -20).lane, a);
    EXPECT_NEAR(graph.advance({b, 0}, 1e6).along, graph.lanes()[b].length, 1e-9);
}

TEST(Lanes, KeepToTheLeftWhereTheRuleSaysSo) {
    const LaneGraph graph(bend("rule=\"LHT\""));
    EXPECT_NEAR(graph.pose(find(graph, "road a, section 0, lane 1"), 0).forward.z, -1, 1e-9);
    EXPECT_NEAR(graph.pose(find(graph, "road a, section 0, lane -1"), 0).forward.z, 1, 1e-9);
}

TEST(Lanes, LinkWhereTheyMeetThoughNothingSaysSo) {
    const LaneGraph graph(network_of(road("a", 100, geometry(0, 0, 0, 0, 100, "<line/>"), two_way_section()) +
                                     road("b", 50, geometry(0, 150, 0, M_PI, 50, "<line/>"), two_way_section())));
    const uint32_t a = find(graph, "road a, section 0, lane -1"), b = find(graph, "road b, section 0, lane 1");
    EXPECT_EQ(graph.lanes()[a].successors, std::vector<uint32_t>{b});
    EXPECT_EQ(graph.lanes()[b].predecessors, std::vector<uint32_t>{a});
}

// Of one road the section that adjoins follows, however near others begin; and no way is looked for without end.
TEST(Lanes, OfOneRoadOnlyTheNextSectionFollows) {
    std::string sections;
    for (int i = 0; i < 700; ++i) sections += two_way_section(i * 0.1);
    const LaneGraph graph(network_of(road("a", 70, geometry(0, 0, 0, 0, 70, "<line/>"), sections)));
    const uint32_t first = find(graph, "road a, section 0, lane -1"), next = find(graph, "road a, section 1, lane -1");
    EXPECT_EQ(graph.lanes()[first].successors, std::vector<uint32_t>{next});
    EXPECT_EQ(graph.long_route(first).size(), 700u);
    const uint32_t back = find(graph, "road a, section 699, lane 1");
    EXPECT_EQ(graph.long_route(back).size(), 700u);
}

// 300 rings through one point: every lane's end is where all begin.
TEST(Lanes, ThatMeetInOnePointAreLinkedToSome) {
    std::string roads;
    for (int i = 0; i < 300; ++i)
        roads += road(std::to_string(i), 100, geometry(0, 0, 0, 0, 100, "<arc curvature=\"0.06283185307179587\"/>"),
                      two_way_section());
    const LaneGraph graph(network_of(roads));
    for (const roads::Lane& lane : graph.lanes()) ASSERT_LE(lane.successors.size(), 64u);
    EXPECT_GT(graph.long_route(find(graph, "road 0, section 0, lane -1")).size(), 60u);
}

TEST(Lanes, LimitsChangeAlongTheWay) {
    const auto type = [](double s, const std::string& speed) {
        return "<type" + quantity("s", s) + " type=\"town\">" + speed + "</type>";
    };
    const std::string types = type(0, "<speed max=\"no limit\"/>") + type(33.3, "<speed max=\"100\" unit=\"km/h\"/>") +
                              type(66.6, "<speed max=\"30\" unit=\"mph\"/>") + type(90, "");
    const LaneGraph graph(network_of(road(
        "a", 100, geometry(0, 0, 0, 0, 100, "<line/>"),
        two_way_section(0, "", "<speed sOffset=\"70\" max=\"undefined\"/><speed sOffset=\"50\" max=\"8\"/>"), types)));
    const uint32_t right = find(graph, "road a, section 0, lane -1"), left = find(graph, "road a, section 0, lane 1");
    const auto limit = [&](uint32_t lane, double along) {
        return roads::allowed_speed(graph.lanes()[lane], graph.pose(lane, along)) * 3.6;
    };
    EXPECT_TRUE(std::isinf(graph.lanes()[right].speed_limit));
    for (const auto& [s, of_road, of_lane] : {std::tuple{0.0, 130.0, 130.0},
                                              {33.29, 130.0, 130.0},
                                              {33.31, 100.0, 100.0},
                                              {49.99, 100.0, 100.0},
                                              {50.01, 100.0, 28.8},
                                              {66.59, 100.0, 28.8},
                                              {66.61, 48.28, 28.8},
                                              {69.99, 48.28, 28.8},
                                              {70.01, 48.28, 48.28},
                                              {90.01, 50.0, 50.0},
                                              {99.9, 50.0, 50.0}}) {
        EXPECT_NEAR(limit(right, s), of_lane, 0.01) << s;
        EXPECT_NEAR(limit(left, 100 - s), of_road, 0.01) << s;
    }
    // In junctions what was allowed before goes on.
    roads::Lane crossing;
    crossing.in_junction = true;
    EXPECT_EQ(roads::allowed_speed(crossing, {}, 25), 25);
    EXPECT_NEAR(roads::allowed_speed(crossing, {}), 50 / 3.6, 1e-9);
    crossing.in_junction = false;
    EXPECT_NEAR(roads::allowed_speed(crossing, {}, 25), 50 / 3.6, 1e-9);
}

TEST(Lanes, NearestKnowsOffsetsAndDirections) {
    const LaneGraph graph(bend());
    const uint32_t right = find(graph, "road a, section 0, lane -1"), left = find(graph, "road a, section 0, lane 1");
    const auto place = graph.nearest({12.25, 0.3, -60});
    ASSERT_TRUE(place);
    EXPECT_EQ(place->lane, right);
    EXPECT_NEAR(place->along, 40, 1e-9);
    EXPECT_NEAR(place->offset, -0.5, 1e-9);
    EXPECT_NEAR(place->distance, std::hypot(0.5, 0.3), 1e-9);
    EXPECT_FALSE(graph.nearest({500, 0, 0}));
    // A car over the middle line belongs to the lane of its direction.
    EXPECT_EQ(graph.nearest({9.6, 0, -60})->lane, left);
    EXPECT_EQ(graph.nearest_along({9.6, 0, -60}, {0, 0, -1})->lane, right);
    EXPECT_EQ(graph.nearest_along({9.6, 0, -60}, {0, 0, 1})->lane, left);
    EXPECT_EQ(graph
                  .lanes()[graph
                               .nearest({15, 0, -60}, 5,
                                        [](const roads::Lane& lane) { return lane.type == roads::LaneType::Sidewalk; })
                               ->lane]
                  .id,
              -2);
}

TEST(Lanes, KerbsLieBetweenRoadAndPavement) {
    const LaneGraph graph(bend());
    const auto near = graph.kerbs_near({11.75, 0, -60}, 2);
    ASSERT_FALSE(near.empty());
    for (const uint32_t index : near) {
        const roads::Kerb& kerb = graph.kerbs()[index];
        EXPECT_NEAR(kerb.from.x, 13.5, 1e-9);
        EXPECT_NEAR(kerb.height, 0.12, 1e-9);
        EXPECT_NEAR(kerb.inside.x, -1, 1e-9);
        EXPECT_NEAR(kerb.from.y, 0, 1e-9);
    }
    EXPECT_TRUE(graph.kerbs_near({11.75, 0, -60}, 1.7).empty());
    double length = 0;
    for (const roads::Kerb& kerb : graph.kerbs()) length += glm::distance(kerb.from, kerb.to);
    EXPECT_NEAR(length, 200 + (46.5 + 53.5) * M_PI / 2, 0.1);
}

TEST(Lanes, OfTheRivoliStreet) {
    const roads::RoadNetwork network =
        roads::read_opendrive(std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.xodr");
    EXPECT_TRUE(network.notes.empty());
    const LaneGraph graph(network);
    // The driver's lane of data/rivoli: x = 1.55 or 4.65, towards -Z from +120 to -320.
    const auto place = graph.nearest({1.6, 0, 0});
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->offset, -0.05, 1e-9);
    EXPECT_NEAR(graph.lanes()[place->lane].speed_limit, 50 / 3.6, 1e-9);
    double length = 0;
    const auto first = graph.nearest({1.55, 0, 119});
    const auto way = graph.long_route(first->lane);
    for (const uint32_t lane : way) length += graph.lanes()[lane].length;
    EXPECT_NEAR(length, 440, 1e-6);
    EXPECT_NEAR(graph.pose(way.back(), 1e9).forward.z, -1, 1e-9);
    const auto kerbs = graph.kerbs_near({4.65, 0, 0}, 4);
    ASSERT_FALSE(kerbs.empty());
    EXPECT_NEAR(graph.kerbs()[kerbs[0]].from.x, 8.3, 1e-9);
    EXPECT_NEAR(graph.kerbs()[kerbs[0]].height, 0.12, 1e-9);
    EXPECT_TRUE(graph.kerbs_near({4.65, 0, 56}, 4).empty()) << "a side street";
}

}  // namespace
}  // namespace vesper::test
