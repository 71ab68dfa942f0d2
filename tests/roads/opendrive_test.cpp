// What OpenDRIVE files may be like, and what they may not. SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "base/error.h"
#include "roads/lanes.h"
#include "roads/road_texts.h"

namespace vesper::test {
namespace {

const std::string kLine = geometry(0, 0, 0, 0, 100, "<line/>");

std::string complaint(const std::string& text, const roads::RoadLimits& limits = {}) {
    try {
        roads::parse_opendrive(text, "file.xodr", limits);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

std::string complaint_of_plan(const std::string& plan) {
    return complaint(opendrive(road("1", 100, plan, two_way_section())));
}

bool has_note(const roads::RoadNetwork& network, const std::string& what) {
    for (const std::string& note : network.notes)
        if (note.find(what) != note.npos) return true;
    return false;
}

TEST(OpenDrive, ErrorsNameFileLineAndReason) {
    EXPECT_NE(complaint("<OpenDRIVE><road").find("file.xodr:1: is no XML"), std::string::npos);
    EXPECT_NE(complaint("").find("is no XML"), std::string::npos);
    const std::string sound = opendrive(road("1", 100, kLine, two_way_section()));
    EXPECT_EQ(complaint(sound), "");
    EXPECT_EQ(complaint(sound + "\n<!-- the end -->\n"), "");
    EXPECT_NE(complaint(sound + "\n<OpenDRIVE/>").find("is no XML: a second root"), std::string::npos);
    EXPECT_NE(complaint(sound + "more").find("is no XML: text beside the root"), std::string::npos);
    EXPECT_NE(complaint(sound + '\0' + sound).find("is no XML: a NUL"), std::string::npos);
    EXPECT_NE(complaint("<OpenDRIVE>\n<road id=\"1\"\nid=\"2\"/></OpenDRIVE>")
                  .find("file.xodr:2: is no XML: the attribute 'id' is there twice"),
              std::string::npos);
    EXPECT_NE(complaint_of_plan("<geometry s=\"0\" x=\"0\" y=\"0\" hdg=\" \" length=\"100\"><line/></geometry>")
                  .find("hdg '' is no number"),
              std::string::npos);
    EXPECT_NE(complaint("<a/>").find("file.xodr:1: a: the root of an OpenDRIVE file must be OpenDRIVE"),
              std::string::npos);
    EXPECT_NE(complaint(opendrive("")).find("has no road"), std::string::npos);
    EXPECT_NE(complaint(opendrive("<road id=\"7\" length=\"10\"><planView>" + geometry(0, 0, 0, 0, 10, "<line/>") +
                                  "</planView></road>"))
                  .find("file.xodr:2: OpenDRIVE: none of its roads has lanes"),
              std::string::npos);
    EXPECT_NE(
        complaint(opendrive("<road id=\"7\" length=\"10\"/>")).find("file.xodr:4: road: road '7' has no planView"),
        std::string::npos);
    EXPECT_NE(complaint_of_plan("").find("has no geometry"), std::string::npos);
    EXPECT_NE(complaint_of_plan(geometry(0, 0, 0, 0, 10, "")).find("file.xodr:5: geometry: has no line, arc"),
              std::string::npos)
        << complaint_of_plan(geometry(0, 0, 0, 0, 10, ""));
    EXPECT_NE(complaint_of_plan("<geometry s=\"0\" x=\"nan\" y=\"0\" hdg=\"0\" length=\"1\"><line/></geometry>")
                  .find("x 'nan' is no number"),
              std::string::npos);
    EXPECT_NE(complaint_of_plan("<geometry s=\"0\" x=\"1e300\" y=\"0\" hdg=\"0\" length=\"1\"><line/></geometry>")
                  .find("x '1e300' is out of range"),
              std::string::npos);
    EXPECT_NE(
        complaint_of_plan("<geometry s=\"0\" y=\"0\" hdg=\"0\" length=\"1\"><line/></geometry>").find("x is missing"),
        std::string::npos);
    EXPECT_NE(complaint_of_plan(geometry(0, 0, 0, 0, -5, "<line/>")).find("length '-5' is out of range"),
              std::string::npos);
    // A point of a spiral takes work for each rad: one of 400 bytes took a minute.
    for (const char* spiral :
         {"<spiral curvStart=\"0\" curvEnd=\"10\"/>", "<spiral curvStart=\"-10\" curvEnd=\"0\"/>",
          "<spiral curvStart=\"9\" curvEnd=\"-10\"/>", "<spiral curvStart=\"10\" curvEnd=\"10\"/>"}) {
        EXPECT_NE(complaint_of_plan(geometry(0, 0, 0, 0, 10.1, spiral)).find("turns round more often"),
                  std::string::npos)
            << spiral;
        EXPECT_EQ(complaint_of_plan(geometry(0, 0, 0, 0, 9.9, spiral)), "") << spiral;
    }
    EXPECT_NE(complaint_of_plan(geometry(0, 0, 0, 0, 1e5, "<arc curvature=\"5000\"/>")).find("turns round more often"),
              std::string::npos);
    EXPECT_NE(complaint_of_plan(geometry(0, 0, 0, 0, 10, "<paramPoly3 pRange=\"normalized\" bU=\"1e8\"/>"))
                  .find("more than a hundred times"),
              std::string::npos);
    EXPECT_NE(complaint_of_plan(kLine + geometry(100, 1e6, 0, 0, 100, "<line/>")).find("jumps by 999900"),
              std::string::npos);
    EXPECT_NE(complaint_of_plan(geometry(0, 0, 0, 0, 10, "<paramPoly3 pRange=\"arcLength\"/>")).find("does not move"),
              std::string::npos);
    EXPECT_NE(complaint_of_plan(geometry(0, 0, 0, 0, 10, "<paramPoly3 pRange=\"other\"/>")).find("pRange must be"),
              std::string::npos);
    EXPECT_NE(
        complaint(opendrive(road("1", 100, kLine, "<laneSection s=\"0\"><left><lane id=\"-1\"/></left></laneSection>")))
            .find("lane -1 cannot be under left"),
        std::string::npos);
    EXPECT_NE(
        complaint(opendrive(road("1", 100, kLine,
                                 "<laneSection s=\"0\"><left><lane id=\"1\"/><lane id=\"1\"/></left></laneSection>")))
            .find("has lane 1 twice"),
        std::string::npos);
    EXPECT_NE(complaint(opendrive(road("1", 100, kLine,
                                       "<laneSection s=\"0\"><left><lane id=\"100000\"/></left></laneSection>")))
                  .find("id '100000' is out of range"),
              std::string::npos);
}

TEST(OpenDrive, LimitsHold) {
    EXPECT_NE(complaint(opendrive(road("1", 100, kLine, "<laneOffset s=\"0\" b=\"1e6\"/>" + two_way_section())))
                  .find("reaches from t ="),
              std::string::npos);
    EXPECT_NE(complaint(opendrive(road("1", 100, kLine,
                                       "<laneSection s=\"0\"><left>" + lane(1, 5000) + "</left></laneSection>")))
                  .find("reaches from t ="),
              std::string::npos);
    EXPECT_NE(
        complaint(opendrive("<road id=\"1\" length=\"100\"><planView>" + kLine +
                            "</planView><elevationProfile><elevation s=\"0\" a=\"1e8\"/></elevationProfile></road>"))
            .find("m high"),
        std::string::npos);
    // For a tenth of a metre between those places that are looked at anyway.
    const std::string wide =
        lane(-1, 3, "driving", "<width sOffset=\"0\" a=\"3\"/><width sOffset=\"10.1\" a=\"3\" c=\"1e8\"/>");
    const std::string back = "<width sOffset=\"10.2\" a=\"3\"/></lane>";
    EXPECT_NE(complaint(opendrive(road("1", 100, kLine,
                                       "<laneSection s=\"0\"><right>" + wide.substr(0, wide.rfind("<width")) + back +
                                           "</right></laneSection>")))
                  .find("m wide"),
              std::string::npos);
    EXPECT_NE(
        complaint(
            opendrive(
                road("1", 100, kLine,
                     "<laneOffset s=\"0\" a=\"0\"/><laneOffset s=\"10.1\" a=\"1e5\"/><laneOffset s=\"10.2\" a=\"0\"/>" +
                         two_way_section())))
            .find("has a lane offset of 100000"),
        std::string::npos);
    roads::RoadLimits limits;
    limits.elements = 5;
    EXPECT_NE(complaint(opendrive(road("1", 100, kLine, two_way_section())), limits).find("more than 5 elements"),
              std::string::npos);
    limits = {};
    limits.roads = 1;
    EXPECT_NE(complaint(opendrive(road("1", 100, kLine, two_way_section()) + road("2", 100, kLine, two_way_section())),
                        limits)
                  .find("more than 1 roads"),
              std::string::npos);
    limits = {};
    limits.total_length = 150;
    EXPECT_NE(complaint(opendrive(road("1", 100, kLine, two_way_section()) + road("2", 100, kLine, two_way_section())),
                        limits)
                  .find("roads of more than"),
              std::string::npos);
}

TEST(OpenDrive, PrefixesAndMissingAttributesAreFine) {
    const roads::RoadNetwork network = roads::parse_opendrive(
        "<odr:OpenDRIVE xmlns:odr=\"x\"><odr:road odr:id=\"1\" length=\"10\"><odr:planView><odr:geometry s=\"0\" "
        "x=\"+1.5\" y=\" 2 \" length=\"10\"><odr:line/></odr:geometry>"
        "</odr:planView><odr:lanes><odr:laneSection s=\"0\"><odr:right><odr:lane id=\"-1\" type=\"driving\"><odr:width "
        "a=\"3\"/></odr:lane></odr:right></odr:laneSection>"
        "</odr:lanes></odr:road></odr:OpenDRIVE>",
        "file.xodr");
    EXPECT_EQ(network.roads[0].plan[0].x, 1.5);
    EXPECT_EQ(network.roads[0].plan[0].y, 2);
    EXPECT_TRUE(has_note(network, "has no header"));
    EXPECT_EQ(roads::LaneGraph(network).lanes().size(), 1u);
}

TEST(OpenDrive, WhatBreaksARuleIsReadAndNoted) {
    const auto jump = network_of(
        road("1", 100, geometry(50, 50, 3, 0, 50, "<line/>") + geometry(0, 0, 0, 0, 50, "<line/>"), two_way_section()));
    EXPECT_TRUE(has_note(jump, "not in ascending order of s: sorted"));
    EXPECT_TRUE(has_note(jump, "the reference line jumps by 3"));
    const auto gap = network_of(
        road("1", 100, geometry(0, 0, 0, 0, 50, "<line/>") + geometry(80, 80, 0, 0, 20, "<line/>"), two_way_section()));
    EXPECT_TRUE(has_note(gap, "road '1': a geometry ends at s = 50.000000, the next begins at 80.000000"));
    EXPECT_TRUE(
        has_note(network_of(road("1", 100, geometry(0, 0, 0, 0, 60, "<line/>") + geometry(50, 50, 0, 0, 50, "<line/>"),
                                 two_way_section())),
                 "a geometry ends at s = 60"));
    EXPECT_TRUE(has_note(
        network_of(road("1", 100, geometry(0, 0, 0, 0, 100, "<line/><arc curvature=\"0.01\"/>"), two_way_section())),
        "geometry: has 2 shapes"));
    EXPECT_TRUE(network_of(road("1", 100, geometry(0, 0, 0, 0, 50, "<line/>") + geometry(50, 50, 0, 0, 50, "<line/>"),
                                two_way_section()))
                    .notes.empty());
    EXPECT_TRUE(has_note(network_of(road("1", 200, kLine, two_way_section())), "its geometry is 100.0"));
    EXPECT_EQ(network_of(road("1", 200, kLine, two_way_section())).roads[0].length, 100);
    EXPECT_TRUE(
        has_note(network_of(road("1", 100, kLine, "") + road("2", 100, kLine, two_way_section())), "has no lanes"));
    EXPECT_TRUE(has_note(
        network_of(road("1", 100, kLine, two_way_section(),
                        "<link><successor elementType=\"road\" elementId=\"9\" contactPoint=\"start\"/></link>")),
        "there is no road '9'"));
    EXPECT_TRUE(
        has_note(network_of(road("1", 100, kLine, two_way_section()) + road("1", 100, kLine, two_way_section())),
                 "is there twice"));
    EXPECT_TRUE(
        has_note(network_of(road("1", 100, geometry(0, 0, 0, 0, 100, "<paramPoly3 pRange=\"normalized\" bU=\"90\"/>"),
                                 two_way_section())),
                 "the curve is 90.0"));
    const std::string linked = "<link><successor elementType=\"road\" elementId=\"2\" contactPoint=\"start\"/></link>";
    EXPECT_TRUE(has_note(network_of(road("1", 100, kLine, two_way_section(), linked) +
                                    road("2", 50, geometry(0, 101, 0, 0, 50, "<line/>"), two_way_section())),
                         "are linked but 1.0"));
}

TEST(OpenDrive, LinksThatGoRoundInCirclesDoNotHang) {
    const std::string links =
        "<link><predecessor elementType=\"road\" elementId=\"1\" contactPoint=\"end\"/><successor elementType=\"road\" "
        "elementId=\"1\" contactPoint=\"start\"/></link>";
    const std::string lane_links = "<link><predecessor id=\"-1\"/><successor id=\"-1\"/></link>";
    const roads::LaneGraph graph(
        network_of(road("1", 100, geometry(0, 0, 0, 0, 100, "<arc curvature=\"0.06283185307179587\"/>"),
                        two_way_section(0, "", lane_links), links)));
    uint32_t lane = 0;
    while (graph.lanes()[lane].id != -1) ++lane;
    ASSERT_EQ(graph.lanes()[lane].successors, std::vector<uint32_t>{lane});
    EXPECT_EQ(graph.long_route(lane).size(), 1u);
    EXPECT_EQ(graph.advance({lane, 0}, 1000).lane, lane);
    EXPECT_EQ(graph.route(lane, lane).size(), 1u);
}

TEST(OpenDrive, MarksMeanWhatTheirNamesSay) {
    const auto network =
        network_of(road("1", 100, kLine,
                        "<laneSection s=\"0\"><center><lane id=\"0\"><roadMark sOffset=\"0\" type=\"solid broken\" "
                        "weight=\"bold\" color=\"yellow\"/><roadMark sOffset=\"50\" type=\"broken\" "
                        "width=\"0.2\"><type name=\"broken\"><line length=\"4\" space=\"8\" tOffset=\"0.1\" "
                        "sOffset=\"2\"/></type></roadMark></lane></center><right>" +
                            lane(-1, 3) + "</right></laneSection>"));
    const auto& marks = network.roads[0].sections[0].find(0)->marks;
    ASSERT_EQ(marks.size(), 2u);
    ASSERT_EQ(marks[0].lines.size(), 2u);
    EXPECT_EQ(marks[0].lines[0].length, 0);
    EXPECT_GT(marks[0].lines[0].t_offset, 0);
    EXPECT_GT(marks[0].lines[1].space, 0);
    EXPECT_EQ(marks[0].lines[0].colour, roads::MarkColour::Yellow);
    EXPECT_EQ(marks[0].lines[0].width, 0.25);
    EXPECT_EQ(marks[1].lines[0].length, 4);
    EXPECT_EQ(marks[1].lines[0].width, 0.2);
    EXPECT_EQ(marks[1].lines[0].s_offset, 2);
}

// Of lanes from the inside outwards, of the centre from the left to the right.
TEST(OpenDrive, DoubleLinesKnowTheirSides) {
    for (const std::string& type : {std::string("solid broken"), std::string("broken solid")}) {
        const std::string mark = "<roadMark sOffset=\"0\" type=\"" + type + "\"/>";
        const auto network = network_of(road("1", 100, kLine,
                                             "<laneSection s=\"0\"><left>" + lane(1, 3, "driving", mark) +
                                                 "</left><center><lane id=\"0\">" + mark + "</lane></center><right>" +
                                                 lane(-1, 3, "driving", mark) + "</right></laneSection>"));
        for (const int id : {1, 0, -1}) {
            const auto& lines = network.roads[0].sections[0].find(id)->marks.at(0).lines;
            ASSERT_EQ(lines.size(), 2u);
            const roads::MarkLine& solid = lines[lines[0].length > 0 ? 1 : 0];
            EXPECT_EQ(solid.length, 0);
            EXPECT_EQ(solid.t_offset > 0, (type == "solid broken") != (id > 0)) << type << " of " << id;
        }
    }
}

TEST(OpenDrive, FarAwayRoadsGetAnOriginNearThem) {
    const auto network =
        network_of(road("1", 100, geometry(0, 4'500'123, 700'456, 0, 100, "<line/>"), two_way_section()));
    const glm::dvec3 at = network.to_world({4'500'123, 700'456, 5});
    EXPECT_LT(glm::length(at), 1000);
    EXPECT_EQ(at.y, 5);
}

}  // namespace
}  // namespace vesper::test
