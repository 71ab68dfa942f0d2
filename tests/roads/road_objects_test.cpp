// Objects and signals: what they are taken for, and how they stand. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "roads/lit_roads.h"
#include "roads/object_kind.h"
#include "roads/road_texts.h"
#include "roads/scene_parts.h"

namespace vesper::test {

using roads::ObjectKind, roads::RoadNetwork;

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

RoadNetwork with(const std::string& rest, const std::string& attributes = "") {
    return network_of(road("1", 90, geometry(0, 0, 0, 0, 90, "<line/>"), two_way_section(), rest, attributes) +
                      road("2", 90, geometry(0, 0, 100, 0, 90, "<line/>"), two_way_section()));
}

scene::Scene built(const RoadNetwork& network, roads::StreetLampOptions lamps = {.spacing = 0}) {
    roads::LitRoadOptions options;
    options.lamps = lamps;
    return roads::lit_roads(network, options).scene;
}

ObjectKind kind(const std::string& type, const std::string& subtype, const std::string& name) {
    roads::RoadObject object;
    object.type = type, object.subtype = subtype, object.name = name;
    return roads::kind_of(object);
}

bool object_noted(const RoadNetwork& network, const std::string& what) {
    for (const std::string& note : network.notes)
        if (note.find(what) != note.npos) return true;
    return false;
}

/// Bounds in the file's frame (x, y, z) of what a material is on.
std::pair<glm::dvec3, glm::dvec3> bounds_of(const scene::Scene& scene, const std::string& material) {
    glm::dvec3 low(kInfinite), high(-kInfinite);
    for (const Triangle& triangle : triangles_of(scene, material))
        for (const glm::dvec3& c : triangle.corners)
            low = glm::min(low, {c.x, -c.z, c.y}), high = glm::max(high, {c.x, -c.z, c.y});
    return {low, high};
}

TEST(RoadObjects, AreKnownByWholeWords) {
    for (const char* name : {"StreetLight", "street light 3", "streetlamp", "Street_Lamp_07", "lampPost",
                             "street lamps", "LEDStreetLamp", "lamppole", "LightPole02"})
        EXPECT_EQ(kind("pole", "", name), ObjectKind::StreetLamp) << name;
    EXPECT_EQ(kind("streetLamp", "", "tree"), ObjectKind::StreetLamp) << "its type says";
    for (const char* name : {"Main Street kiosk", "Bushaltestelle", "Bus stop", "Dispatch", "Market hall"})
        EXPECT_EQ(kind("building", "", name), ObjectKind::Building) << name;
    for (const char* name :
         {"Main Street kiosk", "Bushaltestelle", "Dispatch", "Polestar", "trailer", "landmark", "concrete stopper"})
        EXPECT_EQ(kind("obstacle", "-1", name), ObjectKind::Other) << name;
    for (const char* name : {"TrafficLightPost", "TrafficLightPole", "Signal_Light_Pole 2", "traffic lamp post"})
        EXPECT_EQ(kind("none", "", name), ObjectKind::Pole) << name;
    for (const char* name : {"Signal_Lamp", "warning lamp", "brake lamps", "Tunnel_Portal", "stop lantern"})
        EXPECT_EQ(kind("none", "", name), ObjectKind::Other) << name;
    EXPECT_EQ(kind("none", "", "bus stop lamp"), ObjectKind::StreetLamp);
    EXPECT_EQ(kind("none", "", "Post Office Building"), ObjectKind::Building);
    EXPECT_EQ(kind("none", "", "SignPortal"), ObjectKind::Gantry);
    EXPECT_EQ(kind("vegetation", "bush", "VegBush06"), ObjectKind::Bush);
    EXPECT_EQ(kind("none", "", "oak tree"), ObjectKind::Tree);
    EXPECT_EQ(kind("none", "", "VegBush06"), ObjectKind::Bush);
    EXPECT_EQ(kind("rail-pole", "", "../models/railing-pole.osgb"), ObjectKind::Pole);
    EXPECT_EQ(kind("guide-post", "", ""), ObjectKind::GuidePost);
    EXPECT_EQ(kind("barrier", "guardRail", ""), ObjectKind::Barrier);
    EXPECT_EQ(kind("none", "guardRail", ""), ObjectKind::Railing);
    EXPECT_EQ(kind("parkingSpace", "", ""), ObjectKind::ParkingSpace);
    EXPECT_EQ(kind("trafficIsland", "", ""), ObjectKind::Island);
    EXPECT_EQ(kind("roadMark", "arrowLeft", ""), ObjectKind::RoadMark);
}

TEST(RoadObjects, LampsAreKnownInSeveralLanguages) {
    for (const char* name :
         {"luminaire",     "Lamp_03",   "light standard", "LightingColumn02", "Laterne",   "Straßenlaterne_04",
          "Strassenlampe", "Lichtmast", "lampadaire",     "réverbère 7",      "Reverbere", "éclairage public",
          "farola",        "farolas",   "luminaria",      "lampione",         "lantaarn",  "straatlantaarn",
          "lantaarnpaal",  "latarnia",  "lampa",          "gatulampa",        "katuvalo",  "фонарь",
          "路灯",          "路灯杆_01", "街灯",           "道路照明",         "가로등 2"}) {
        EXPECT_EQ(kind("pole", "", name), ObjectKind::StreetLamp) << name;
        EXPECT_EQ(kind("-1", "", name), ObjectKind::StreetLamp) << name;
    }
    EXPECT_EQ(kind("pole", "streetLamp", ""), ObjectKind::StreetLamp);
    for (const char* name : {"Signal_Post", "信号灯", "powerPole", "clamp", "red light"})
        EXPECT_EQ(kind("pole", "", name), ObjectKind::Pole) << name;
}

TEST(RoadObjects, PolesWithoutLightAreCountedByName) {
    roads::LitRoadOptions options;
    options.lamps.spacing = 0;
    const auto notes =
        roads::lit_roads(with("<objects><object id=\"1\" name=\"mystery\" type=\"pole\" s=\"40\" t=\"6\" "
                              "height=\"8\"><repeat s=\"10\" length=\"20\" distance=\"10\"/></object><object id=\"2\" "
                              "type=\"pole\" name=\"farola\" s=\"50\" t=\"6\" height=\"8\"/></objects>"),
                         options)
            .notes;
    EXPECT_EQ(std::count(notes.begin(), notes.end(), "poles without light: mystery (3)"), 1);
}

// Poles of the height of lamps, where the file names no lamp; none with a signal, of another height, or with a name.
TEST(RoadObjects, PolesWithoutANameAreLampsByTheirHeight) {
    const auto lamps = [](const std::string& name, double height, const std::string& more = "",
                          std::optional<double> spacing = {}) {
        char number[32];
        std::snprintf(number, sizeof number, "%g", height);
        roads::LitRoadOptions options;
        options.lamps.spacing = spacing;
        const roads::LitRoads lit = roads::lit_roads(
            with("<objects><object id=\"1\" name=\"" + name + "\" type=\"pole\" s=\"20\" t=\"6\" height=\"" + number +
                 "\"><repeat s=\"20\" length=\"50\" distance=\"25\" tStart=\"6\" tEnd=\"6\"/></object>" +
                 (more.starts_with("<object ") ? more + "</objects>" : "</objects>" + more)),
            options);
        for (const std::string& note : lit.notes)
            if (note.starts_with("the file names no street lamp: ")) return note[31] - '0';
        return 0;
    };
    EXPECT_EQ(lamps("", 8), 3);
    EXPECT_EQ(lamps("Pole_03", 8), 3);
    EXPECT_EQ(lamps("mystery", 8), 0);
    EXPECT_EQ(lamps("", 3), 0);
    EXPECT_EQ(lamps("", 25), 0);
    EXPECT_EQ(lamps("", 8, "", 0), 0) << "none are wanted";
    EXPECT_EQ(lamps("", 8, "<object id=\"2\" name=\"lamp\" type=\"pole\" s=\"5\" t=\"6\" height=\"8\"/>"), 0);
    EXPECT_EQ(lamps("", 8,
                    "<signals><signal id=\"3\" s=\"45.2\" t=\"6\" zOffset=\"2\" orientation=\"+\" type=\"209\" "
                    "country=\"DE\"/></signals>"),
              2);
}

constexpr const char* kCorners =
    "<cornerLocal u=\"0\" v=\"0\" z=\"0\" height=\"1\"/><cornerLocal u=\"4\" v=\"0\" z=\"0\" height=\"1\"/>"
    "<cornerLocal u=\"4\" v=\"2\" z=\"0\" height=\"1\"/></outline></object></objects>";

// ASAM OpenDRIVE 1.8, 13.2: orientation says in which direction an object counts.
TEST(RoadObjects, OrientationDoesNotTurnThem) {
    for (const char* orientation : {"+", "-", "none"}) {
        const auto [low, high] = bounds_of(
            built(with("<objects><object id=\"1\" type=\"building\" s=\"40\" t=\"10\" hdg=\"0\" orientation=\"" +
                       std::string(orientation) + "\"><outline>" + kCorners)),
            "wall");
        EXPECT_NEAR(low.x, 40, 1e-4) << orientation;
        EXPECT_NEAR(high.x, 44, 1e-4);
        EXPECT_NEAR(low.y, 10, 1e-4);
        EXPECT_NEAR(high.y, 12, 1e-4);
    }
}

TEST(RoadObjects, OpenOutlinesAreWallsAlone) {
    const auto area = [&](const std::string& closed) {
        return area_of(
            triangles_of(built(with("<objects><object id=\"1\" type=\"building\" s=\"40\" t=\"10\"><outline closed=\"" +
                                    closed + "\">" + kCorners)),
                         "wall"));
    };
    EXPECT_NEAR(area("false"), 2 * (4 + 2), 1e-3) << "either side of two walls";
    EXPECT_NEAR(area("true"), 4 + 2 + std::sqrt(20.0) + 4, 1e-3) << "three walls and a roof";
}

TEST(RoadObjects, RowsOfLampsStandBesideOwnOnesIfAsked) {
    const RoadNetwork network =
        with("<objects><object id=\"1\" type=\"streetLamp\" s=\"40\" t=\"6\" height=\"8\"/></objects>");
    const auto lamps = [&](const roads::LitRoadOptions& options) {
        return lamps_of(roads::lit_roads(network, options).scene, "street_lamp_").size();
    };
    roads::LitRoadOptions options;
    EXPECT_EQ(lamps(options), 1u);
    options.lamps.overhang = 2;
    EXPECT_EQ(lamps(options), 1u);
    options.lamps.spacing = 30;
    EXPECT_GT(lamps(options), 3u);
}

// Of a signal that counts for traffic with and against s, in right- and left-hand traffic: at y < 0 lies the lane -1.
TEST(RoadSignals, StopLinesLieAcrossTheLanesTheyAreFor) {
    for (const char* rule : {"RHT", "LHT"})
        for (const char* orientation : {"+", "-"}) {
            const auto [low, high] =
                bounds_of(built(with("<signals><signal s=\"50\" t=\"-5\" id=\"7\" dynamic=\"no\" orientation=\"" +
                                         std::string(orientation) + "\" type=\"294\" country=\"DE\"/></signals>",
                                     "rule=\"" + std::string(rule) + "\"")),
                          "marking white");
            const bool right = (orientation[0] == '+') == (rule[0] == 'R');
            EXPECT_NEAR(low.y, right ? -3.5 : 0, 1e-3) << rule << orientation;
            EXPECT_NEAR(high.y, right ? 0 : 3.5, 1e-3) << rule << orientation;
        }
}

TEST(RoadSignals, StandWhereTheirPositionSays) {
    const auto signal = [](const std::string& position) {
        return with(
            "<signals><signal s=\"50\" t=\"-5\" id=\"7\" dynamic=\"yes\" orientation=\"+\" zOffset=\"3\" "
            "type=\"1000001\" country=\"OpenDRIVE\" "
            "height=\"0.9\" width=\"0.3\">" +
            position + "</signal></signals>");
    };
    const auto place = [](const RoadNetwork& network) {
        return lamps_of(built(network), "signal_7/red").at(0).translation;
    };
    EXPECT_NEAR(place(signal("")).x, 50, 0.2);
    for (const char* id : {"1", "2"}) {
        const RoadNetwork network =
            signal("<positionRoad roadId=\"" + std::string(id) + "\" s=\"70\" t=\"6\" zOffset=\"2\" hOffset=\"0\"/>");
        EXPECT_TRUE(network.notes.empty()) << network.notes[0];
        const glm::vec3 at = place(network);
        EXPECT_NEAR(at.x, 70, 0.2) << id;
        EXPECT_NEAR(-at.z, 6 + (id[0] == '2' ? 100 : 0), 1e-3) << id;
        EXPECT_NEAR(at.y, 2.75, 1e-3) << id;
    }
    const RoadNetwork inertial = signal("<positionInertial x=\"7\" y=\"6\" z=\"2\" hdg=\"0\"/>"),
                      nowhere = signal("<positionRoad roadId=\"9\" s=\"7\" t=\"6\"/>");
    EXPECT_NEAR(place(inertial).x, 50, 0.2);
    EXPECT_TRUE(object_noted(inertial, "positionInertial: is not read"));
    EXPECT_NEAR(place(nowhere).x, 50, 0.2);
    EXPECT_TRUE(object_noted(nowhere, "positionRoad: there is no road '9'"));
}

TEST(RoadSignals, BeyondTheEndOfTheirRoadAreSaid) {
    // The place that counts is looked at, and that alone.
    const auto moved = [](const std::string& s, const std::string& id, const std::string& there) {
        return with("<signals><signal s=\"" + s + "\" t=\"5\" id=\"7\"><positionRoad roadId=\"" + id + "\" s=\"" +
                    there + "\" t=\"6\"/></signal></signals>");
    };
    for (const char* id : {"1", "2"}) {
        EXPECT_TRUE(object_noted(moved("50", id, "1e8"),
                                 "positionRoad: s = 100000000.000000 is not on road '" + std::string(id) + "'"));
        EXPECT_TRUE(moved("1e8", id, "50").notes.empty());
    }
    const RoadNetwork network = with(
        "<objects><object id=\"1\" type=\"pole\" s=\"95\" t=\"6\"/></objects><signals><signal s=\"-4\" t=\"5\" "
        "id=\"7\"/></signals>");
    EXPECT_TRUE(object_noted(network, "object: s = 95.000000 is not on road '1', which is 90.0"));
    EXPECT_TRUE(object_noted(network, "signal: s = -4.0"));
    EXPECT_EQ(network.notes.size(), 2u);
}

}  // namespace
}  // namespace vesper::test
