// Points on roads against closed forms. SPDX-License-Identifier: MIT
#include <cmath>

#include <gtest/gtest.h>

#include "roads/lanes.h"
#include "roads/road_surface.h"
#include "roads/road_texts.h"

namespace vesper::test {

using roads::surface_point;

namespace {

roads::RoadNetwork profiled(const std::string& profiles, const std::string& lanes = two_way_section()) {
    return network_of("<road id=\"1\" length=\"100\"><planView>" + geometry(0, 0, 0, 0, 100, "<line/>") +
                      "</planView>" + profiles + "<lanes>" + lanes + "</lanes></road>");
}

void expect_at(const roads::RoadPoint& got, double x, double y, double z) {
    EXPECT_NEAR(got.position.x, x, 1e-9);
    EXPECT_NEAR(got.position.y, y, 1e-9);
    EXPECT_NEAR(got.position.z, z, 1e-9);
}

TEST(RoadPoints, SuperelevationTurnsTheCrossSection) {
    const auto network = profiled("<lateralProfile><superelevation s=\"0\" a=\"0.1\"/></lateralProfile>");
    const roads::RoadPoint left = surface_point(network.roads[0], 40, 5);
    expect_at(left, 40, 5 * std::cos(0.1), 5 * std::sin(0.1));
    EXPECT_NEAR(left.up.y, -std::sin(0.1), 1e-12);
    EXPECT_NEAR(left.up.z, std::cos(0.1), 1e-12);
    expect_at(surface_point(network.roads[0], 40, 0, 2), 40, -2 * std::sin(0.1), 2 * std::cos(0.1));
}

TEST(RoadPoints, ElevationIsACubicOfS) {
    const auto network = profiled(
        "<elevationProfile><elevation s=\"0\" a=\"1\" b=\"0.02\"/><elevation s=\"50\" a=\"2\" b=\"0.02\" c=\"0.001\" "
        "d=\"-0.00001\"/></elevationProfile>");
    expect_at(surface_point(network.roads[0], 30, -2), 30, -2, 1.6);
    expect_at(surface_point(network.roads[0], 80, 0), 80, 0, 2 + 0.6 + 0.9 - 0.27);
    const double slope = 0.02 + 0.06 - 0.027;
    EXPECT_NEAR(
        roads::reference_point(network.roads[0], 80).forward.z / roads::reference_point(network.roads[0], 80).forward.x,
        slope, 1e-12);
}

TEST(RoadPoints, ShapesLieBetweenTheirStations) {
    const auto network = profiled(
        "<lateralProfile><shape s=\"0\" t=\"-5\" a=\"0.5\" b=\"-0.1\"/><shape s=\"0\" t=\"0\" a=\"0\" "
        "b=\"0.02\"/><shape s=\"100\" t=\"-5\" a=\"0\"/></lateralProfile>");
    expect_at(surface_point(network.roads[0], 0, -3), 0, -3, 0.3);
    expect_at(surface_point(network.roads[0], 0, 4), 0, 4, 0.08);
    expect_at(surface_point(network.roads[0], 50, -3), 50, -3, 0.15);
}

TEST(RoadPoints, CrossfallFallsOutwards) {
    const auto network = profiled("<lateralProfile><crossfall side=\"both\" s=\"0\" a=\"0.025\"/></lateralProfile>");
    expect_at(surface_point(network.roads[0], 10, 4), 10, 4, -4 * std::tan(0.025));
    expect_at(surface_point(network.roads[0], 10, -4), 10, -4, -4 * std::tan(0.025));
}

TEST(RoadPoints, StripsOfACrossSectionFollowEachOther) {
    const auto network = profiled(
        "<lateralProfile><crossSectionSurface><tOffset><coefficients s=\"0\" a=\"0.5\"/></tOffset><surfaceStrips>"
        "<strip id=\"1\"><width><coefficients s=\"0\" a=\"2\"/></width><linear><coefficients s=\"0\" "
        "a=\"-0.1\"/></linear></strip>"
        "<strip id=\"2\"><quadratic><coefficients s=\"0\" a=\"0.05\"/></quadratic></strip>"
        "<strip id=\"-1\"><constant><coefficients s=\"0\" a=\"0.2\" "
        "b=\"0.01\"/></constant></strip></surfaceStrips></crossSectionSurface></lateralProfile>");
    expect_at(surface_point(network.roads[0], 10, 1.5), 10, 1.5, -0.1);
    expect_at(surface_point(network.roads[0], 10, 4.5), 10, 4.5, -0.2 + 0.05 * 4);
    expect_at(surface_point(network.roads[0], 10, -1), 10, -1, 0.3);
}

TEST(RoadPoints, LanesAddUpFromTheLaneOffset) {
    const auto network = profiled("", "<laneOffset s=\"0\" a=\"1\" b=\"0.01\"/>" + two_way_section());
    const roads::Road& r = network.roads[0];
    EXPECT_NEAR(roads::lane_border(r, r.sections[0], 0, 50), 1.5, 1e-12);
    EXPECT_NEAR(roads::lane_border(r, r.sections[0], 2, 50), 7, 1e-12);
    EXPECT_NEAR(roads::lane_border(r, r.sections[0], -2, 50), -4, 1e-12);
    expect_at(roads::lane_point(r, r.sections[0], -1, 50, 0.5), 50, 1.5 - 1.75, 0);
    expect_at(roads::lane_point(r, r.sections[0], 2, 50, 1), 50, 7, 0.12);
}

TEST(RoadPoints, BordersAreWhereTheyAreUnlessAnInnerOneIsFurtherOut) {
    const auto network = profiled("",
                                  "<laneSection s=\"0\"><left><lane id=\"2\" type=\"driving\"><border sOffset=\"0\" "
                                  "a=\"5\" b=\"-0.04\"/></lane><lane id=\"1\" type=\"driving\"><border sOffset=\"0\" "
                                  "a=\"4\"/></lane></left><center><lane id=\"0\"/></center></laneSection>");
    const roads::Road& r = network.roads[0];
    EXPECT_NEAR(roads::lane_border(r, r.sections[0], 2, 10), 4.6, 1e-12);
    EXPECT_NEAR(roads::lane_border(r, r.sections[0], 2, 75), 4, 1e-12) << "not inside lane 1";
    ASSERT_EQ(network.notes.size(), 1u);
    EXPECT_NE(network.notes[0].find("lane 2 is as little as -3"), std::string::npos) << network.notes[0];
}

TEST(RoadPoints, LevelLanesDoNotFollowTheSuperelevation) {
    const auto network = profiled("<lateralProfile><superelevation s=\"0\" a=\"0.1\"/></lateralProfile>",
                                  "<laneSection s=\"0\"><left><lane id=\"2\" type=\"sidewalk\" level=\"true\"><width "
                                  "sOffset=\"0\" a=\"2\"/></lane><lane id=\"1\" type=\"driving\"><width sOffset=\"0\" "
                                  "a=\"3\"/></lane></left><center><lane id=\"0\"/></center></laneSection>");
    const roads::Road& r = network.roads[0];
    expect_at(roads::lane_point(r, r.sections[0], 2, 0, 1), 0, 3 * std::cos(0.1) + 2, 3 * std::sin(0.1));
}

// The offset takes a step of a lane's width where lane 1 goes on as lane -1.
TEST(RoadPoints, AStepOfTheOffsetBelongsToTheNextSection) {
    const auto lanes = [](int first, const std::string& side, int to, int from) {
        return "<" + side + ">" +
               lane(first, 3.5, "driving",
                    "<link>" + (to ? "<successor id=\"" + std::to_string(to) + "\"/>" : "") +
                        (from ? "<predecessor id=\"" + std::to_string(from) + "\"/>" : "") + "</link>") +
               "</" + side + ">";
    };
    const auto network =
        profiled("", "<laneOffset s=\"0\" a=\"0\"/><laneOffset s=\"50\" a=\"3.5\"/><laneSection s=\"0\">" +
                         lanes(-1, "right", -2, 0) + "</laneSection><laneSection s=\"50\"><right>" + lane(-1, 3.5) +
                         lane(-2, 3.5, "driving", "<link><predecessor id=\"-1\"/></link>") + "</right></laneSection>");
    const roads::Road& r = network.roads[0];
    expect_at(roads::lane_point(r, r.sections[0], -1, 50, 1), 50, -3.5, 0);
    expect_at(roads::lane_point(r, r.sections[0], 0, 50, 0), 50, 0, 0);
    expect_at(roads::lane_point(r, r.sections[1], 0, 50, 0), 50, 3.5, 0);
    expect_at(roads::lane_point(r, r.sections[1], -2, 50, 1), 50, -3.5, 0);
    const roads::LaneGraph graph(network);
    ASSERT_EQ(graph.lanes().size(), 3u);
    EXPECT_EQ(graph.lanes()[0].successors.size(), 1u);
    for (const roads::LanePose& pose : graph.lanes()[0].poses) EXPECT_NEAR(pose.position.z, 1.75, 1e-9);
}

// Lane -1 grows by what lane -2 gets narrower: no border but the one between them bends.
TEST(RoadPoints, StationsFollowInnerBorders) {
    const auto wide = [](int id, double a, double c, double d, double last) {
        return "<lane id=\"" + std::to_string(id) + "\" type=\"driving\"><width sOffset=\"0\"" + quantity("a", a) +
               "/><width sOffset=\"40\"" + quantity("a", a) + quantity("c", c) + quantity("d", d) +
               "/><width sOffset=\"60\"" + quantity("a", last) + "/></lane>";
    };
    const auto network = profiled("", "<laneSection s=\"0\"><right>" + wide(-1, 3.5, 0.02625, -0.000875, 7) +
                                          wide(-2, 7, -0.02625, 0.000875, 3.5) + "</right></laneSection>");
    const roads::LaneSection& section = network.roads[0].sections[0];
    const auto stations = roads::road_stations(network.roads[0], section, 0.01, 20);
    EXPECT_LT(stations.size(), 60u);
    for (size_t i = 1; i < stations.size(); ++i)
        for (double f = 0.05; f < 1; f += 0.05) {
            const auto at = [&](double s) { return roads::lane_border(network.roads[0], section, -1, s); };
            EXPECT_NEAR(at(glm::mix(stations[i - 1], stations[i], f)),
                        glm::mix(at(stations[i - 1]), at(stations[i]), f), 0.011);
        }
}

// The bound that road_stations states, on an arc with a bump.
TEST(RoadPoints, StationsKeepToTheChord) {
    const auto network =
        network_of("<road id=\"1\" length=\"100\"><planView>" + geometry(0, 0, 0, 0, 100, "<arc curvature=\"0.02\"/>") +
                   "</planView><elevationProfile><elevation s=\"0\" a=\"0\"/><elevation s=\"40\" a=\"0\" c=\"0.01\" "
                   "d=\"-0.0005\"/><elevation s=\"60\" a=\"0\"/></elevationProfile><lanes>" +
                   two_way_section() + "</lanes></road>");
    const roads::Road& r = network.roads[0];
    const roads::LaneSection& section = r.sections[0];
    for (const double chord : {0.1, 0.01}) {
        const auto stations = roads::road_stations(r, section, chord, 20);
        EXPECT_EQ(stations.front(), 0);
        EXPECT_EQ(stations.back(), 100);
        EXPECT_LT(stations.size(), 300u);
        for (size_t i = 1; i < stations.size(); ++i) {
            EXPECT_GT(stations[i], stations[i - 1]);
            EXPECT_LE(stations[i] - stations[i - 1], 20);
            for (const int id : {0, 2, -2}) {
                const auto at = [&](double s) {
                    return surface_point(r, s, roads::lane_border(r, section, id, s)).position;
                };
                const glm::dvec3 a = at(stations[i - 1]), b = at(stations[i]), along = glm::normalize(b - a);
                for (double f = 0.05; f < 1; f += 0.05) {
                    const glm::dvec3 p = at(glm::mix(stations[i - 1], stations[i], f)) - a;
                    EXPECT_LT(glm::length(p - along * glm::dot(p, along)), chord * 1.1);
                }
            }
        }
    }
}

}  // namespace
}  // namespace vesper::test
