// Simulators that state the ground below objects in place of the middle of their boxes. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "osi/trace.h"
#include "places.h"
#include "support/driven_along.h"
#include "support/program.h"

namespace vesper::test {
namespace {

using drive::HeightReading;
using Kind = osi::MovingObject::Kind;

const std::string kYard = std::string(VESPER_SOURCE_DIR) + "/data/photometry/yard.gltf";  // level ground at 0
constexpr double kSlope = 0.05;

// A road along x that climbs.
std::string climbing_road() {
    return R"(<?xml version="1.0"?><OpenDRIVE><header revMajor="1" revMinor="6"/><road length="200" id="1" junction="-1">
<planView><geometry s="0" x="0" y="0" hdg="0" length="200"><line/></geometry></planView>
<elevationProfile><elevation s="0" a="2" b="0.05" c="0" d="0"/></elevationProfile><lanes><laneSection s="0">
<left><lane id="1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></left>
<center><lane id="0" type="none"/></center>
<right><lane id="-1" type="driving"><width sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right>
</laneSection></lanes></road></OpenDRIVE>)";
}

// A car, a truck and a person that stand or drive along on the ground; `share`: of half the height above it.
osi::Message standing(double seconds, const std::function<glm::dvec3(double)>& way, double share, double pitch = 0) {
    osi::Message made{.nanoseconds = int64_t(seconds * 1e9), .host = 1};
    const std::pair<Kind, glm::dvec3> kinds[]{
        {Kind::Car, {4.4, 1.8, 1.5}}, {Kind::Truck, {8, 2.4, 3.4}}, {Kind::Pedestrian, {0.5, 0.5, 1.8}}};
    for (const auto& [kind, size] : kinds) {
        const double along = 10 + 20 * double(made.objects.size()) + 8 * seconds;
        made.objects.push_back({.id = made.objects.size() + 1,
                                .kind = kind,
                                .size = size,
                                .centre = way(along) + glm::dvec3(0, 0, share * size.z / 2),
                                .pitch = pitch,
                                .velocity = {}});
    }
    return made;
}
glm::dvec3 over_yard(double along) { return {2, along, 0}; }
glm::dvec3 up_the_road(double along) { return {along, -1.75, 2 + kSlope * along}; }

std::string trace_of(const std::function<glm::dvec3(double)>& way, double share, double pitch = 0) {
    std::string bytes;
    for (int i = 0; i <= 20; ++i) bytes += osi::trace_bytes_of(standing(0.1 * i, way, share, pitch));
    return bytes;
}

bool is_noted(const drive::Scenery& scenery, const std::string& words) {
    return std::any_of(scenery.notes().begin(), scenery.notes().end(),
                       [&](const std::string& note) { return note.find(words) != note.npos; });
}

// Wherever the sender has its places, all stand on the ground: in a scene, and on a road that climbs.
TEST(OsiHeights, EverybodyStandsOnTheGround) {
    const TempFolder folder;
    folder.write("climb.xodr", climbing_road());
    for (const double share : {1.0, 0.0, 0.1, 0.9}) {
        for (const bool road : {false, true}) {
            const double pitch = road ? -std::atan(kSlope) : 0;
            folder.write("a.osi", road ? trace_of(up_the_road, share, pitch) : trace_of(over_yard, share));
            DrivenAlong along(road ? (folder / "climb.xodr").string() : kYard, {.file = folder / "a.osi"});
            const drive::ExternalState now = along.at(1);
            ASSERT_EQ(now.actors.size(), 2u);
            const glm::dvec3 origin = along.scenery.message_frame().point({0, 0, 0});
            const double tolerance = 0.18 + 0.02;  // a tenth of half a truck, and the surface
            const auto ground = [&](double where) { return road ? origin.y + up_the_road(where).z : 0.0; };
            EXPECT_NEAR(now.driver->position.y, ground(18), tolerance) << share << road;
            EXPECT_NEAR(now.actors[0].actor.position.y, ground(38), tolerance) << share << road;
            EXPECT_NEAR(now.actors[1].actor.position.y, ground(58), tolerance) << share << road;
            EXPECT_EQ(is_noted(along.scenery, "taken as the ground"), share < 0.5) << share << road;
            EXPECT_NEAR(now.objects[0].centre.z - (now.driver->position.y - origin.y), 0.75, 0.01) << "as it leaves";
        }
    }
}

// As it is asked for, whatever the ground tells.
TEST(OsiHeights, AreTakenAsTheOptionSays) {
    const TempFolder folder;
    folder.write("middle.osi", trace_of(over_yard, 1)), folder.write("ground.osi", trace_of(over_yard, 0));
    const auto height = [&](const char* file, HeightReading reading) {
        return DrivenAlong(kYard, {.file = folder / file, .heights = reading}).at(1).driver->position.y;
    };
    EXPECT_NEAR(height("ground.osi", HeightReading::Middle), -0.75, 1e-9);
    EXPECT_NEAR(height("middle.osi", HeightReading::Ground), 0.75, 1e-9);
    EXPECT_NEAR(height("ground.osi", HeightReading::Ground), 0, 1e-9);
    EXPECT_EQ(drive::height_reading_of("ground"), HeightReading::Ground);
    EXPECT_THROW(drive::height_reading_of("floor"), Error);
}

// Without ground, with too few objects, and where senders disagree, the standard counts.
TEST(OsiHeights, DoubtsAreTheStandards) {
    const TempFolder folder;
    const auto driver = [&](const std::string& trace) {
        folder.write("a.osi", trace);
        DrivenAlong along(kYard, {.file = folder / "a.osi"});
        EXPECT_FALSE(is_noted(along.scenery, "taken as the ground"));
        const double height = along.at(1).driver->position.y;
        return std::pair(height, is_noted(along.scenery, "taken as the middle"));
    };
    EXPECT_EQ(driver(trace_of([](double along) { return glm::dvec3(500, along, 0); }, 0)), std::pair(-0.75, false));
    EXPECT_EQ(driver(trace_of([](double along) { return glm::dvec3(2, along, -6); }, 0)), std::pair(-6.75, false))
        << "below the ground";
    osi::Message two = standing(0, over_yard, 0);
    two.objects.pop_back();
    EXPECT_EQ(driver(osi::trace_bytes_of(two)), std::pair(-0.75, true)) << "two objects once";
    std::string mixed;
    for (int i = 0; i <= 20; ++i) mixed += osi::trace_bytes_of(standing(0.1 * i, over_yard, i < 10 ? 1 : 0));
    EXPECT_EQ(driver(mixed).second, true);
}

// While messages come: not at once, and not back for a few that differ.
TEST(OsiHeights, OfASenderAreJudgedOverTime) {
    const drive::Scenery scenery(kYard, {.live = true});
    drive::ExternalPlaces places = scenery.external_places();
    int number = 0;
    const auto heights = [&](double share, int moments) {
        double height = 0;
        for (int i = 0; i < moments; ++i) {
            osi::Moment moment;
            const osi::Message message = standing(0.01 * number++, over_yard, share);
            for (const osi::MovingObject& object : message.objects) moment.objects.push_back({object});
            moment.host = 1;
            height = places.place(moment).driver->position.y;
        }
        return height;
    };
    EXPECT_NEAR(heights(1, 60), 0, 1e-9);
    EXPECT_NEAR(heights(0, 5), -0.75, 1e-9);
    EXPECT_NEAR(heights(0, 60), 0, 1e-9);
    EXPECT_TRUE(places.at_ground());
    EXPECT_NEAR(heights(1, 10), 0.75, 1e-9) << "a few";
    EXPECT_NEAR(heights(0, 10), 0, 1e-9);
    EXPECT_NEAR(heights(1, 60), 0, 1e-9) << "it changed its mind";
    EXPECT_FALSE(places.at_ground());
    drive::ExternalPlaces stated =
        drive::Scenery(kYard, {.live = true, .heights = HeightReading::Ground}).external_places();
    EXPECT_TRUE(stated.at_ground());
}

class OsiHeightsProgram : public ProgramTest {
protected:
    OsiHeightsProgram() : ProgramTest(VESPER_DRIVE) {}
};

// A recording keeps the option, and its replay has the same pictures.
TEST_F(OsiHeightsProgram, AreRecorded) {
    const std::string common = "--headless --size 64x40 --indirect off --shadows off ";
    folder.write("a.osi", trace_of(over_yard, 1));
    const std::string drive = common + kYard + " --osi a.osi --seconds 0.5 --fps 4 ";
    ASSERT_EQ(run(drive + "--osi-z ground --record d.json --video a%d.png"), 0) << said;
    ASSERT_EQ(run(common + "--replay d.json --video b%d.png"), 0) << said;
    ASSERT_EQ(run(drive + "--video c%d.png"), 0) << said;
    EXPECT_TRUE(read_text(folder / "a1.png") == read_text(folder / "b1.png"));
    EXPECT_FALSE(read_text(folder / "a1.png") == read_text(folder / "c1.png"));
    expect_refused(drive + "--osi-z floor --log l.csv", {"--osi-z", "floor"});
    expect_refused(common + kYard + " --osi-z ground --log l.csv", {"--osi-z", "--osi-udp"});
}

}  // namespace
}  // namespace vesper::test
