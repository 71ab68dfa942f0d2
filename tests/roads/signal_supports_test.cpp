// Supports of signals: none stands in a carriageway. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "roads/lit_roads.h"
#include "roads/road_texts.h"
#include "roads/scene_parts.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

constexpr double kClearance = 4.2;  // m

roads::LitRoads lit_of(const roads::RoadNetwork& network) {
    roads::LitRoadOptions options;
    options.lamps.spacing = 0;
    return roads::lit_roads(network, options);
}

/// A road of 100 m: three lanes of 3.5 m to the right, and these objects and signals.
roads::RoadNetwork three_lanes(const std::string& objects, const std::string& signals) {
    const std::string lanes = "<laneSection s=\"0\"><center><lane id=\"0\"/></center><right>" + lane(-1, 3.5) +
                              lane(-2, 3.5) + lane(-3, 3.5) + "</right></laneSection>";
    return network_of(road("1", 100, geometry(0, 0, 0, 0, 100, "<line/>"), lanes,
                           "<objects>" + objects + "</objects><signals>" + signals + "</signals>"));
}

std::string head(const std::string& id, double t, double z, const std::string& rest = "height=\"1\" width=\"0.4\"") {
    return "<signal id=\"" + id + "\" name=\"Signal_3Light\" s=\"59.8\"" + quantity("t", t) + quantity("zOffset", z) +
           " orientation=\"+\" dynamic=\"yes\" country=\"OpenDRIVE\" type=\"1000001\" " + rest + "/>";
}

std::string thing(const std::string& name, double t, const std::string& rest) {
    return "<object id=\"1\" name=\"" + name + "\" type=\"-1\" s=\"60\"" + quantity("t", t) + " " + rest + "/>";
}

/// Triangles of steel that reach into the room of cars: lanes from Z = 0 to 10.5 m.
size_t in_carriageway(const scene::Scene& scene) {
    size_t count = 0;
    for (const char* material : {"pole", "signal housing", "concrete"})
        for (const Triangle& triangle : triangles_of(scene, material)) {
            const auto [low, high] = std::minmax({triangle.corners[0].z, triangle.corners[1].z, triangle.corners[2].z});
            const double bottom = std::min({triangle.corners[0].y, triangle.corners[1].y, triangle.corners[2].y});
            count += bottom < kClearance && high > 0.01 && low < 10.49;
        }
    return count;
}

/// Steel at a height, by its reach in Z.
std::pair<double, double> steel_between(const scene::Scene& scene, double bottom, double top) {
    double low = 1e9, high = -1e9;
    for (const Triangle& triangle : triangles_of(scene, "pole"))
        for (const glm::dvec3& c : triangle.corners)
            if (c.y > bottom && c.y < top) low = std::min(low, c.z), high = std::max(high, c.z);
    return {low, high};
}

bool says(const std::vector<std::string>& notes, const std::string& part) {
    return std::any_of(notes.begin(), notes.end(), [&](const std::string& n) { return n.find(part) != n.npos; });
}

TEST(SignalSupports, OverLanesHangOnTheMastArmOfTheFile) {
    const auto file = shared_data("bugs-t3/roads/mast-arm.xodr");
    if (!is_here(file)) GTEST_SKIP() << "no shared data";
    const roads::LitRoads lit = lit_of(roads::read_opendrive(file));
    EXPECT_EQ(in_carriageway(lit.scene), 0u);
    EXPECT_TRUE(says(lit.notes, "signals over lanes: 3 on masts, gantries or wires of the file"));
}

TEST(SignalSupports, OverLanesHangOnAnArmFromTheNearestPost) {
    const std::string signals = head("10", -5.25, 5.3) + head("11", -8.75, 5.3);
    for (const char* name : {"Signal_Post", "mast 3", "StreetLight"}) {
        const roads::LitRoads lit = lit_of(three_lanes(thing(name, -11.5, "height=\"7\" radius=\"0.15\""), signals));
        EXPECT_EQ(in_carriageway(lit.scene), 0u) << name;
        EXPECT_TRUE(says(lit.notes, "signals over lanes: 2 on arms")) << name;
        // An arm 0.15 m over the heads, 0.14 m thick, from the post's axis to the farther head.
        const auto [near, far] = steel_between(lit.scene, 6.3 + 0.05, 6.3 + 0.25);
        EXPECT_NEAR(near, 5.25, 0.2) << name;
        EXPECT_NEAR(far, 11.5, 0.2) << name;
    }
}

TEST(SignalSupports, OverLanesHangOnGantriesWhoseBoxIsStated) {
    const roads::LitRoads lit = lit_of(three_lanes(
        thing("SignGantry", -5.25, "height=\"7\" width=\"13\" length=\"0.5\""),
        head("10", -5.25, 5.4) + "<signal id=\"2\" s=\"59.8\" t=\"-5.25\" zOffset=\"5.3\" orientation=\"+\" "
                                 "dynamic=\"no\" type=\"332\" country=\"DE\" width=\"6\" height=\"1.4\"/>"));
    EXPECT_EQ(in_carriageway(lit.scene), 0u);
    EXPECT_TRUE(says(lit.notes, "signals over lanes: 2 on masts"));
    // Legs at the ends of the box, the beam at its top.
    const auto [near, far] = steel_between(lit.scene, -0.1, 7.1);
    EXPECT_NEAR(near, 5.25 - 6.5, 1e-3);
    EXPECT_NEAR(far, 5.25 + 6.5, 1e-3);
    double top = 0;
    for (const Triangle& triangle : triangles_of(lit.scene, "pole"))
        for (const glm::dvec3& c : triangle.corners) top = std::max(top, c.y);
    EXPECT_NEAR(top, 7, 1e-3);
}

TEST(SignalSupports, OverLanesWithoutAPostHaveNone) {
    // Too far, too low.
    for (const std::string& post : {std::string(), thing("post", -40, "height=\"7\" radius=\"0.1\""),
                                    thing("bollard post", -11.5, "height=\"1\" radius=\"0.1\"")}) {
        const roads::LitRoads lit = lit_of(three_lanes(post, head("10", -5.25, 5.3)));
        EXPECT_EQ(in_carriageway(lit.scene), 0u) << post;
        EXPECT_TRUE(says(lit.notes, "signals over lanes: 1 without a support")) << post;
    }
    // Posts of the file that stand in a lane: too low, and not at the head.
    for (const std::string& post :
         {thing("post", -5.25, "height=\"3\" radius=\"0.1\""), thing("post", -8.75, "height=\"7\" radius=\"0.1\"")})
        EXPECT_TRUE(
            says(lit_of(three_lanes(post, head("10", -5.25, 5.3))).notes, "signals over lanes: 1 without a support"))
            << post;
}

TEST(SignalSupports, BesideLanesStandOnAPole) {
    const roads::LitRoads lit = lit_of(three_lanes("", head("10", -11.5, 3)));
    EXPECT_FALSE(says(lit.notes, "signals over lanes"));
    const auto [near, far] = steel_between(lit.scene, 0, 3);
    EXPECT_TRUE(near > 10.5 && far < 12) << near << " to " << far;
    // A low post, one of another level, and an outline called post carry none.
    const size_t alone = triangles_of(lit.scene, "pole").size();
    for (const std::string& post :
         {thing("post", -11.5, "height=\"1\" length=\"0.1\" width=\"0.1\""),
          thing("post", -11.5, "zOffset=\"-9\" height=\"12\" length=\"0.1\" width=\"0.1\"")}) {
        const roads::LitRoads both = lit_of(three_lanes(post, head("10", -11.5, 3)));
        EXPECT_GT(triangles_of(both.scene, "pole").size(), alone) << post;
    }
}

// Its own lane ends at 100 m.
TEST(SignalSupports, BeyondADeadEndNoLaneIsBelow) {
    const std::string beyond =
        "<signal id=\"10\" s=\"104\" t=\"-5.25\" zOffset=\"3\" orientation=\"+\" dynamic=\"yes\" "
        "country=\"OpenDRIVE\" type=\"1000001\" height=\"1\" width=\"0.4\"/>";
    const roads::LitRoads lit = lit_of(three_lanes("", beyond));
    EXPECT_FALSE(says(lit.notes, "signals over lanes"));
    EXPECT_FALSE(triangles_of(lit.scene, "pole").empty());
}

TEST(SignalSupports, WithoutAnOffsetAreMountedAsUsual) {
    const auto red = [](const std::string& signals) {
        const roads::LitRoads lit = lit_of(three_lanes("", signals));
        EXPECT_TRUE(says(lit.notes, "signals at zOffset 0: 1"));
        return lamps_of(lit.scene, "signal_10/red").at(0).translation.y;
    };
    // The red lens is the upper one of three.
    EXPECT_NEAR(red(head("10", -11.5, 0, "height=\"0.9\" width=\"0.3\"")), 2.1 + 0.75, 1e-3);
    EXPECT_NEAR(red(head("10", -5, 0, "height=\"0.9\" width=\"0.3\"")), 4.5 + 0.75, 1e-3);
    EXPECT_NEAR(red(head("10", -11.5, 0, "height=\"5\" width=\"0.3\"")), 5 - 0.15, 1e-3) << "with its pole";
    const auto edges = [](const std::string& type, const std::string& size) {
        double low = 1e9, high = 0;
        for (const Triangle& triangle :
             triangles_of(lit_of(three_lanes("",
                                             "<signal id=\"1\" s=\"50\" t=\"-14\" zOffset=\"0\" dynamic=\"no\" "
                                             "orientation=\"+\" country=\"DE\" type=\"" +
                                                 type + "\" " + size + "/>"))
                              .scene,
                          "sign white"))
            for (const glm::dvec3& c : triangle.corners) low = std::min(low, c.y), high = std::max(high, c.y);
        return std::pair(low, high);
    };
    const std::string small = "width=\"0.6\" height=\"0.6\"";
    EXPECT_GT(edges("209", small).first, 1.99);
    EXPECT_LT(edges("605", small).first, 0.1) << "beacons stand on the ground";
    // A board of 4 m by 3 is that high; 3 m of a narrow sign are those of its pole.
    const auto [low, high] = edges("332", "width=\"4\" height=\"3\"");
    EXPECT_NEAR(high - low, 3, 0.2);
    EXPECT_NEAR(low, 2, 0.1);
    EXPECT_NEAR(edges("209", "width=\"0.6\" height=\"3\"").second, 3, 0.1);
}

}  // namespace
}  // namespace vesper::test
