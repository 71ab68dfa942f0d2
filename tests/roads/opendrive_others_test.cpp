// OpenDRIVE as other programs write it, where the standard has another way. SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "base/error.h"
#include "roads/crossing_text.h"
#include "roads/lanes.h"
#include "roads/lit_roads.h"
#include "roads/road_surface.h"
#include "roads/road_texts.h"

namespace vesper::test {

using roads::RoadNetwork;

namespace {

bool noted(const RoadNetwork& network, const std::string& what) {
    for (const std::string& note : network.notes)
        if (note.find(what) != note.npos) return true;
    return false;
}

uint32_t lane_named(const roads::LaneGraph& graph, const std::string& name) {
    for (uint32_t i = 0; i < graph.lanes().size(); ++i)
        if (graph.lanes()[i].name == name) return i;
    ADD_FAILURE() << name;
    return 0;
}

size_t street_lamps(const RoadNetwork& network) {
    size_t count = 0;
    const roads::LitRoads lit = roads::lit_roads(network);
    for (const scene::Node& node : lit.scene.nodes)
        count += node.lamp != scene::kNone && node.name.starts_with("street_lamp_");
    return count;
}

/// One lane to the east from (x, 0).
std::string to_east(const std::string& id, double x, double length, const std::string& links,
                    const std::string& attributes = "") {
    return road(id, length, geometry(0, x, 0, 0, length, "<line/>"),
                "<laneSection s=\"0\"><right>" +
                    lane(-1, 3.5, "driving", "<link><predecessor id=\"-1\"/><successor id=\"-1\"/></link>") +
                    "</right></laneSection>",
                "<link>" + links + "</link>", attributes);
}

// Two ways from a: straight on over a connecting road without length, and round a bend.
TEST(OthersOpenDrive, RoadsWithoutLengthLeadOn) {
    for (const double length : {0.0, 1e-7}) {
        const RoadNetwork network =
            network_of(to_east("a", 0, 50, "<successor elementType=\"junction\" elementId=\"j\"/>") +
                       to_east("point", 50, length,
                               "<predecessor elementType=\"road\" elementId=\"a\" contactPoint=\"end\"/><successor "
                               "elementType=\"road\" elementId=\"b\" contactPoint=\"start\"/>",
                               "junction=\"j\"") +
                       road("bend", 10, geometry(0, 50, 0, 0, 10, "<arc curvature=\"0.1\"/>"), two_way_section(), "",
                            "junction=\"j\"") +
                       to_east("b", 50, 50, "<predecessor elementType=\"junction\" elementId=\"j\"/>") +
                       "<junction id=\"j\"><connection incomingRoad=\"a\" connectingRoad=\"point\" "
                       "contactPoint=\"start\"><laneLink from=\"-1\" to=\"-1\"/></connection>"
                       "<connection incomingRoad=\"a\" connectingRoad=\"bend\" contactPoint=\"start\"><laneLink "
                       "from=\"-1\" to=\"-1\"/></connection></junction>");
        EXPECT_TRUE(noted(network, "road 'point' has no length"));
        const roads::LaneGraph graph(network);
        const uint32_t a = lane_named(graph, "road a, section 0, lane -1"),
                       b = lane_named(graph, "road b, section 0, lane -1");
        EXPECT_EQ(graph.route(a, b).size(), 3u);
        EXPECT_EQ(graph.lanes()[a].successors.size(), 2u);
        EXPECT_NEAR(graph.pose(b, 10).position.x, 60, 1e-9);
        EXPECT_EQ(street_lamps(network), 4u);
    }
}

// Whatever else stands in a road of no length: the geometry of it does not count.
TEST(OthersOpenDrive, NoLengthIsNoneOfAnyGeometry) {
    for (const char* shape : {"<line/>", "<arc curvature=\"100\"/>", "<spiral curvStart=\"0\" curvEnd=\"9\"/>",
                              "<paramPoly3 pRange=\"normalized\"/>", "<poly3/>"}) {
        const RoadNetwork network = network_of(road("1", 0, geometry(0, 5, 0, 0, 0, shape), two_way_section()) +
                                               road("2", 50, geometry(0, 0, 20, 0, 50, "<line/>"), two_way_section()));
        EXPECT_TRUE(noted(network, "has no length")) << shape;
        EXPECT_GT(street_lamps(network), 0u) << shape;
    }
    // But a road that only says it had none has that of its geometry.
    EXPECT_EQ(network_of(road("1", 0, geometry(0, 0, 0, 0, 50, "<line/>"), two_way_section())).roads[0].length, 50);
}

TEST(OthersOpenDrive, LanesLieBesideEachOtherAcrossGapsOfTheirNumbers) {
    const auto section = [](int first, int second, int third) {
        const std::string high = "<height sOffset=\"0\" inner=\"0.12\" outer=\"0.12\"/>";
        return "<laneSection s=\"0\"><left>" + lane(-first, 3.5) + "</left><center><lane id=\"0\"/></center><right>" +
               lane(first, 3.5) + lane(second, 3) + lane(third, 2, "sidewalk", high) + "</right></laneSection>";
    };
    const auto with = [](const std::string& lanes) {
        return network_of(road("1", 90, geometry(0, 0, 0, 0, 90, "<line/>"), lanes));
    };
    const RoadNetwork dense = with(section(-1, -2, -3)), sparse = with(section(-2, -5, -9));
    EXPECT_TRUE(noted(sparse, "lane ids have a gap"));
    const roads::LaneGraph whole(dense), graph(sparse);
    ASSERT_EQ(graph.lanes().size(), whole.lanes().size());
    for (uint32_t i = 0; i < graph.lanes().size(); ++i) {
        EXPECT_EQ(graph.lanes()[i].poses[0].position, whole.lanes()[i].poses[0].position);
        EXPECT_EQ(graph.lanes()[i].left, whole.lanes()[i].left) << i;
        EXPECT_EQ(graph.lanes()[i].right, whole.lanes()[i].right) << i;
        EXPECT_EQ(graph.lanes()[i].oncoming, whole.lanes()[i].oncoming) << i;
    }
    ASSERT_EQ(graph.kerbs().size(), whole.kerbs().size());
    for (size_t i = 0; i < graph.kerbs().size(); ++i) {
        EXPECT_EQ(graph.kerbs()[i].from, whole.kerbs()[i].from);
        EXPECT_EQ(graph.kerbs()[i].height, whole.kerbs()[i].height);
    }
    EXPECT_EQ(street_lamps(sparse), street_lamps(dense));
    EXPECT_EQ(street_lamps(sparse), 3u);
}

// Borders count from the reference line, whatever lanes are left out between.
TEST(OthersOpenDrive, GapsBetweenBordersHaveNoWidth) {
    const auto bordered = [](int id, double t) {
        return "<lane id=\"" + std::to_string(id) + "\" type=\"driving\"><border sOffset=\"0\"" + quantity("a", t) +
               "/></lane>";
    };
    const RoadNetwork network = network_of(
        road("1", 50, geometry(0, 0, 0, 0, 50, "<line/>"),
             "<laneSection s=\"0\"><right>" + bordered(-1, -3) + bordered(-3, -7) + "</right></laneSection>"));
    const roads::LaneGraph graph(network);
    ASSERT_EQ(graph.lanes().size(), 2u);
    EXPECT_NEAR(graph.lanes()[1].poses[0].width, 4, 1e-9);
    EXPECT_NEAR(graph.lanes()[1].poses[0].position.z, 5, 1e-9);
    EXPECT_EQ(roads::stated_width(network.roads[0].sections[0], *network.roads[0].sections[0].find(-3), 10), 4);
}

// Where they are cut shorter than can be built, lanes lead over it; the ids change there, so that places alone do not
// tell.
TEST(OthersOpenDrive, SectionsWithoutLengthAreLinkedAcross) {
    const auto section = [](double s, int id, int before, int after) {
        return "<laneSection" + quantity("s", s) + "><right>" + (id == -2 ? lane(-1, 0.5, "none") : "") +
               lane(id, 3.5, "driving",
                    "<link><predecessor id=\"" + std::to_string(before) + "\"/><successor id=\"" +
                        std::to_string(after) + "\"/></link>") +
               "</right></laneSection>";
    };
    const RoadNetwork network =
        network_of(road("1", 100, geometry(0, 0, 0, 0, 100, "<line/>"),
                        section(50, -1, -2, 0) + section(0, -1, 0, -2) + section(49.9996, -2, -1, -1)));
    EXPECT_TRUE(noted(network, "lane sections are not in ascending order"));
    ASSERT_EQ(network.roads[0].sections.size(), 2u);
    EXPECT_EQ(network.roads[0].sections[0].end, 50);
    EXPECT_EQ(network.roads[0].sections[0].find(-1)->successors, std::vector<int>{-1});
    EXPECT_EQ(network.roads[0].sections[1].find(-1)->predecessors, std::vector<int>{-1});
    const roads::LaneGraph graph(network);
    ASSERT_EQ(graph.lanes().size(), 2u);
    EXPECT_EQ(graph.lanes()[0].successors, std::vector<uint32_t>{1});
}

// However many there are: links neither grow with every one, nor is each looked at for each.
TEST(OthersOpenDrive, ManySectionsWithoutLengthAreNoMatter) {
    const std::string
        both =
            "<link><predecessor id=\"-1\"/><predecessor id=\"-2\"/><successor id=\"-1\"/><successor id=\"-2\"/></link>",
        lanes = lane(-1, 3, "driving", both) + lane(-2, 3, "driving", both);
    std::string sections = "<laneSection s=\"0\"><right>" + lanes + "</right></laneSection>";
    for (int i = 0; i < 5000; ++i) sections += "<laneSection s=\"50\"><right>" + lanes + "</right></laneSection>";
    const RoadNetwork network = network_of(road("1", 100, geometry(0, 0, 0, 0, 100, "<line/>"), sections));
    ASSERT_EQ(network.roads[0].sections.size(), 2u);
    EXPECT_EQ(network.roads[0].sections[0].find(-1)->successors.size(), 2u);
    EXPECT_EQ(roads::LaneGraph(network).lanes()[0].successors.size(), 2u);
}

// A bridge that rises from the ground: no lamp of the road below it stands in its way.
TEST(OthersOpenDrive, NoLampStandsInABridge) {
    const std::string rising =
        "<elevationProfile><elevation s=\"0\" c=\"0.0012\" d=\"-0.000008\"/><elevation s=\"100\" a=\"4\"/><elevation "
        "s=\"200\" a=\"4\" c=\"-0.0012\" d=\"0.000008\"/></elevationProfile>";
    const std::string below = road("2", 90, geometry(0, 150, -45, M_PI / 2, 90, "<line/>"), two_way_section());
    const auto in_the_way = [](const RoadNetwork& network) {
        size_t count = 0;
        for (const scene::Node& node : roads::lit_roads(network).scene.nodes)
            count += node.lamp != scene::kNone && node.name.starts_with("street_lamp_") &&
                     std::abs(node.translation.x - 150) < 8 && std::abs(node.translation.z) < 5;
        return count;
    };
    EXPECT_EQ(in_the_way(network_of(below)), 1u);
    EXPECT_EQ(
        in_the_way(network_of(below + road("1", 300, geometry(0, 0, 0, 0, 300, "<line/>"), two_way_section(), rising))),
        0u);
}

// Files in UTF-16 have the lines that an editor shows, too.
TEST(OthersOpenDrive, PlacesAreTheSameInUtf16) {
    const auto many = [](const std::string& of, int times) {
        std::string text;
        for (int i = 0; i < times; ++i) text += of;
        return text;
    };
    const std::string text = opendrive(
        "<!-- " + many("\u65e5\u672c", 100) + many("\U0001F697", 100) + many("\u00fc", 100) +
        " -->\n<road id=\"1\" length=\"10\">\n" +
        std::string(
            "<planView>\n<geometry s=\"0\" x=\"a\" y=\"0\" length=\"10\"><line/></geometry></planView></road>"));
    const std::u16string wide = std::filesystem::path(text).u16string();
    const auto complaint = [](const std::string& of) {
        try {
            roads::parse_opendrive(of, "file.xodr");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(complaint(text), "file.xodr:7: geometry: x 'a' is no number");
    for (const bool low_first : {true, false})
        for (const bool marked : {true, false}) {
            std::string bytes = !marked ? "" : low_first ? "\xFF\xFE" : "\xFE\xFF";
            for (const char16_t unit : wide) {
                bytes += static_cast<char>(low_first ? unit & 0xFF : unit >> 8);
                bytes += static_cast<char>(low_first ? unit >> 8 : unit & 0xFF);
            }
            EXPECT_EQ(complaint(bytes), complaint(text)) << low_first << marked;
        }
}

TEST(OthersOpenDrive, WhatCannotBeKnownIsLeftOutAndSaid) {
    const auto line = geometry(0, 0, 0, 0, 50, "<line/>");
    const RoadNetwork network = network_of(
        "<include file=\"more.xml\"/>"
        "<road id=\"1\" length=\"50\"><type s=\"0\" type=\"town\"><speed max=\"-1\"/></type><planView>" +
        line + "</planView><lanes><laneSection s=\"0\"><right>" +
        lane(-1, 3, "driving", "<roadMark type=\"solid\" width=\"-1\"/>") +
        "</right></laneSection></lanes><objects><object id=\"o\"/><object id=\"p\" s=\"1\" t=\"2\"/></objects>"
        "<signals><signal id=\"a\" s=\"4\"/><signal id=\"b\" s=\"4\" t=\"1\"/></signals></road>");
    EXPECT_TRUE(noted(network, "include: 'more.xml' is not read"));
    EXPECT_TRUE(noted(network, "object: has no s and t: left out"));
    EXPECT_TRUE(noted(network, "signal: has no s and t: left out"));
    EXPECT_EQ(network.roads[0].objects.size(), 1u);
    EXPECT_EQ(network.roads[0].signals.size(), 1u);
    EXPECT_EQ(network.roads[0].speeds[0].limit, 0) << "none stated";
    EXPECT_EQ(network.roads[0].sections[0].find(-1)->marks[0].lines[0].width, 0.12) << "as if not stated";
    try {
        network_of("<include file=\"more.xml\"/>");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("has no road of its own, and includes are not read"),
                  std::string::npos)
            << error.what();
    }
}

TEST(OthersOpenDrive, ValuesThatNobodyKnowsAreSaid) {
    const std::string line = geometry(0, 0, 0, 0, 50, "<line/>"),
                      speed = "<type s=\"0\" type=\"town\"><speed max=\"50\" unit=\"";
    const auto said = [&](const std::string& what, const std::string& types, const std::string& lanes,
                          const std::string& attributes = "", const std::string& plan = "") {
        const RoadNetwork network = network_of(road("1", 50, plan.empty() ? line : plan, lanes, types, attributes));
        EXPECT_EQ(network.notes.size(), what.empty() ? 0u : 1u) << what;
        EXPECT_TRUE(what.empty() || noted(network, what)) << what;
        EXPECT_TRUE(what.empty() || noted(network, "test.xodr:")) << what;
        return network;
    };
    EXPECT_EQ(
        said("the unit 'kmh' is none of m/s", speed + "kmh\"/></type>", two_way_section()).roads[0].speeds[0].limit, 0);
    EXPECT_EQ(said("", speed + "m/s\"/></type>", two_way_section()).roads[0].speeds[0].limit, 50);
    EXPECT_TRUE(std::isinf(
        said("", "<type s=\"0\"><speed max=\"no limit\"/></type>", two_way_section()).roads[0].speeds[0].limit));
    said("the lane type 'drving' is not known", "",
         "<laneSection s=\"0\"><right>" + lane(-1, 3) + lane(-2, 3, "drving") + lane(-3, 3, "drving") +
             "</right></laneSection>");
    EXPECT_TRUE(
        said("the rule 'left' is neither RHT nor LHT", "", two_way_section(), "rule=\"left\"").roads[0].right_hand);
    EXPECT_FALSE(said("", "", two_way_section(), "rule=\"LHT\"").roads[0].right_hand);
    EXPECT_EQ(said("begins where the lane section before it does", "", two_way_section(0) + two_way_section(0))
                  .roads[0]
                  .sections.size(),
              1u);
    said("a kink of 5.7", "", two_way_section(), "",
         geometry(0, 0, 0, 0, 25, "<line/>") + geometry(25, 25, 0, 0.1, 25, "<line/>"));
    said("", "", two_way_section(), "",
         geometry(0, 0, 0, 0, 25, "<line/>") + geometry(25, 25, 0, 0.01 + 2 * M_PI, 25, "<line/>"));
}

// Elements and attributes that no reader asks for are counted, wherever they are: one more of each in each element.
TEST(OpenDriveOthers, NothingIsSkippedInSilence) {
    const std::string text = opendrive(crossing_text(true));
    std::string more;
    std::map<std::string, size_t> wanted;
    std::vector<std::string> open;
    for (size_t at = 0; at < text.size();) {
        const size_t begin = std::min(text.find('<', at), text.size()), end = text.find('>', begin);
        more += text.substr(at, begin - at);
        if (begin == text.size()) break;
        std::string tag = text.substr(begin, end - begin);
        const bool closed = tag.back() == '/';
        if (tag[1] == '?' || tag[1] == '/') {
            more += tag + ">";
        } else {
            const std::string name = tag.substr(1, tag.find_first_of(" /", 1) - 1);
            if (closed) tag.pop_back();
            more += tag + " strange=\"1\"><odd><even strange=\"2\"/></odd>" + (closed ? "</" + name + ">" : "");
            ++wanted[name + "/odd"], ++wanted[name + "@strange"];
        }
        at = end + 1;
    }
    const std::map<std::string, size_t> before = roads::parse_opendrive(text, "a.xodr").unread,
                                        unread = roads::parse_opendrive(more, "b.xodr").unread;
    for (const auto& [name, count] : before) wanted.emplace(name, count);
    EXPECT_GT(wanted.size(), 40u);
    EXPECT_EQ(unread, wanted);
}

}  // namespace
}  // namespace vesper::test
