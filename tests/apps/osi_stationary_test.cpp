// Things that stand and signs of messages: drawn of traces, never lost. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <osi/osi.pb.h>

#include "external/stationary.h"
#include "osi/trace.h"
#include "places.h"
#include "support/driven_along.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

namespace wire = osi::wire;
using Kind = osi::StationaryObject::Kind;

const std::string kYard = std::string(VESPER_SOURCE_DIR) + "/data/photometry/yard.gltf";

void place(wire::BaseStationary& base, glm::dvec3 at, glm::dvec3 size, double yaw = 0) {
    base.mutable_position()->set_x(at.x), base.mutable_position()->set_y(at.y), base.mutable_position()->set_z(at.z);
    base.mutable_dimension()->set_length(size.x), base.mutable_dimension()->set_width(size.y);
    base.mutable_dimension()->set_height(size.z), base.mutable_orientation()->set_yaw(yaw);
}
void add(wire::GroundTruth& truth, uint64_t id, int type, glm::dvec3 at, glm::dvec3 size, double yaw = 0) {
    wire::StationaryObject& o = *truth.add_stationary_object();
    o.mutable_id()->set_value(id), o.mutable_classification()->set_type(type);
    place(*o.mutable_base(), at, size, yaw);
}
// `height`: of the place of a car.
wire::GroundTruth truth_at(int64_t second, double height = 0.75) {
    wire::GroundTruth truth;
    truth.mutable_timestamp()->set_seconds(second);
    for (uint64_t id = 1; id <= 3; ++id) {
        wire::MovingObject& car = *truth.add_moving_object();
        car.mutable_id()->set_value(id), car.set_type(2);
        car.mutable_base()->mutable_position()->set_x(2);
        car.mutable_base()->mutable_position()->set_y(20.0 * double(id)),
            car.mutable_base()->mutable_position()->set_z(height);
    }
    return truth;
}
std::string in_trace(const std::string& bytes) {
    std::string made;
    for (size_t i = 0; i < 4; ++i) made += char(bytes.size() >> 8 * i & 0xff);
    return made + bytes;
}

struct Placed {
    glm::dvec3 low{1e9}, high{-1e9}, front{0};
    bool retroreflective = false;
};
Placed placed(const scene::Scene& scene, const std::string& name) {
    Placed made;
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].name != name) continue;
        made.front = -glm::normalize(glm::dvec3(world[i][2]));
        for (const scene::Primitive& p : scene.meshes[scene.nodes[i].mesh].primitives) {
            for (const scene::Vertex& v : p.vertices) {
                const glm::dvec3 at(world[i] * glm::dvec4(v.position, 1));
                made.low = glm::min(made.low, at), made.high = glm::max(made.high, at);
                EXPECT_NEAR(glm::length(v.normal), 1, 1e-5) << name;
            }
            made.retroreflective |= scene.materials[p.material].retroreflector != scene::kNone;
        }
    }
    return made;
}
void expect_box(const Placed& box, glm::dvec3 low, glm::dvec3 high) {
    EXPECT_LT(glm::distance(box.low, low), 0.02) << box.low.x << " " << box.low.y << " " << box.low.z;
    EXPECT_LT(glm::distance(box.high, high), 0.02) << box.high.x << " " << box.high.y << " " << box.high.z;
}
std::string notes_of(const drive::Scenery& scenery) {
    std::string all;
    for (const std::string& note : scenery.notes()) all += note + "\n";
    return all;
}

// Each has its place, size and turn, in any message, once.
TEST(OsiStationary, ThingsOfATraceAreDrawn) {
    wire::GroundTruth first = truth_at(1), second = truth_at(2);
    add(first, 10, 3, {10, 30, 5}, {12, 6, 10});             // a building along x
    add(first, 11, 8, {3, 50, 0.5}, {4, 0.5, 1}, M_PI / 2);  // a barrier along y
    add(second, 10, 3, {10, 30, 5}, {12, 6, 10});
    add(second, 12, 4, {6, 60, 2}, {0.2, 0.2, 4});       // a pole
    add(second, 13, 5, {6, 62, 0.35}, {0.4, 0.4, 0.7});  // a cone
    wire::TrafficSign& sign = *second.add_traffic_sign();
    sign.mutable_id()->set_value(14);
    place(*sign.mutable_main_sign()->mutable_base(), {5, 70, 2.2}, {0, 0.6, 0.9}, -M_PI / 2);
    place(*sign.add_supplementary_sign()->mutable_base(), {5, 70, 1.6}, {0, 0.6, 0.3}, -M_PI / 2);
    const TempFolder folder;
    folder.write("a.osi", in_trace(first.SerializeAsString()) + in_trace(second.SerializeAsString()));
    const drive::Scenery scenery(kYard, {.file = folder / "a.osi"});
    const scene::Scene& scene = scenery.scene();
    expect_box(placed(scene, "stationary 10"), {4, 0, -33}, {16, 10, -27});
    expect_box(placed(scene, "stationary 11"), {2.75, 0, -52}, {3.25, 1, -48});
    expect_box(placed(scene, "stationary 12"), {5.9, 0, -60.1}, {6.1, 4, -59.9});
    expect_box(placed(scene, "stationary 13"), {5.8, 0, -62.2}, {6.2, 0.7, -61.8});
    const Placed plates = placed(scene, "stationary 14");
    expect_box(plates, {4.7, 1.45, -70.01}, {5.3, 2.65, -69.99});
    EXPECT_LT(glm::distance(plates.front, glm::dvec3(0, 0, 1)), 1e-5) << "faces those that come along y";
    EXPECT_TRUE(plates.retroreflective);
    const std::string notes = notes_of(scenery);
    EXPECT_NE(notes.find("barrier: 1, building: 1, pole: 1, pylon: 1, traffic sign: 2"), notes.npos) << notes;
}

// Things that are not drawn are counted by their kinds.
TEST(OsiStationary, OthersAreCounted) {
    wire::GroundTruth truth = truth_at(1);
    add(truth, 10, 2, {0, 30, 3}, {40, 10, 6});  // a bridge: its box would close the road
    add(truth, 11, 14, {0, 60, 6}, {1, 12, 1});
    add(truth, 12, 7, {8, 30, 3}, {0, 0, 0});                    // of no size
    truth.add_stationary_object()->mutable_id()->set_value(13);  // nowhere
    const TempFolder folder;
    folder.write("a.osi", in_trace(truth.SerializeAsString()));
    const std::string notes = notes_of(drive::Scenery(kYard, {.file = folder / "a.osi"}));
    EXPECT_NE(notes.find("bridge: 1, overhead structure: 1, tree: 1"), notes.npos) << notes;
    EXPECT_NE(notes.find("1 stationary objects and signs are left out"), notes.npos) << notes;

    // Of a sender all are, each once; without ids by their places.
    drive::StationaryCensus census;
    osi::Message message;
    for (int i = 0; i < 3; ++i) message.stationary.push_back({.kind = Kind::Tree, .centre = {double(i), 0, 0}});
    message.stationary.push_back({.id = 9, .kind = Kind::Sign}),
        message.stationary.push_back({.id = 9, .kind = Kind::Wall});
    census.add(message), census.add(message);
    EXPECT_EQ(drive::text_of(census.counts()), "traffic sign: 1, tree: 3, wall: 1");
}

// Where the road file has a thing, that of the messages is the same; and things stand where moving objects do.
TEST(OsiStationary, ThingsOfRoadsAreThereOnce) {
    const TempFolder folder;
    folder.write("road.xodr", R"(<?xml version="1.0"?><OpenDRIVE><header revMajor="1" revMinor="6"/>
<road length="100" id="1" junction="-1"><planView><geometry s="0" x="0" y="0" hdg="0" length="100"><line/></geometry>
</planView><lanes><laneSection s="0"><center><lane id="0" type="none"/></center>
<right><lane id="-1" type="driving"><width sOffset="0" a="7" b="0" c="0" d="0"/></lane></right></laneSection></lanes>
<objects><object id="7" type="building" s="50" t="10" zOffset="0" length="4" width="4" height="5"/></objects>
<signals><signal id="8" s="30" t="-9" zOffset="2" orientation="+" dynamic="no" type="205" country="DE"/></signals>
</road></OpenDRIVE>)");
    wire::GroundTruth truth;
    truth.mutable_timestamp()->set_seconds(1);
    add(truth, 10, 3, {50, 10, 0}, {4, 4, 5});
    add(truth, 11, 8, {70, -8, 0}, {1, 1, 1});
    wire::TrafficSign& sign = *truth.add_traffic_sign();
    place(*sign.mutable_main_sign()->mutable_base(), {30, -9, 2}, {0, 0.6, 0.6}, M_PI);
    for (uint64_t id = 1; id <= 3; ++id) {
        wire::MovingObject& car = *truth.add_moving_object();
        car.mutable_id()->set_value(id), car.set_type(2);
        car.mutable_base()->mutable_position()->set_x(20.0 * double(id));
        car.mutable_base()->mutable_position()->set_y(-3.5), car.mutable_base()->mutable_position()->set_z(0);
    }
    folder.write("a.osi", in_trace(truth.SerializeAsString()));
    const drive::Scenery scenery(folder / "road.xodr", {.file = folder / "a.osi"});
    const std::string notes = notes_of(scenery);
    EXPECT_NE(notes.find("that the roads have already: building: 1, traffic sign: 1"), notes.npos) << notes;
    EXPECT_NE(notes.find("panels: barrier: 1"), notes.npos) << notes;
    EXPECT_NE(notes.find("taken as the ground"), notes.npos) << notes;
    const double ground = scenery.message_frame().point({0, 0, 0}).y;
    EXPECT_NEAR(placed(scenery.scene(), "stationary 11").low.y, ground, 1e-5);
}

}  // namespace
}  // namespace vesper::test
