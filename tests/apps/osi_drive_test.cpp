// Driving along with other simulators: traces, what is sent while one drives, and traces of one's own.
// SPDX-License-Identifier: MIT
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "external/model_table.h"
#include "osi/trace.h"
#include "places.h"
#include "session/scenery.h"
#include "session/session.h"
#include "support/complaints.h"
#include "support/driven_along.h"
#include "support/program.h"
#include "support/udp_sender.h"

namespace vesper::test {
namespace {

using osi::LampState;
using Kind = osi::MovingObject::Kind;

const std::string kWorld = std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.world.json";
const std::string kScene = std::string(VESPER_SOURCE_DIR) + "/data/photometry/yard.gltf";

// A host that goes along y, a car ahead of it that brakes at 1 s, and a pedestrian from 1 s on.
std::vector<osi::Message> messages() {
    std::vector<osi::Message> made;
    for (int i = 0; i <= 40; ++i) {
        osi::Message m{.nanoseconds = i * int64_t{50'000'000}, .host = 1};
        const double y = 100 + 0.5 * i;
        m.objects.push_back({.id = 1,
                             .kind = Kind::Car,
                             .size = {4.4, 1.8, 1.5},
                             .centre = {1.5, y, 0.75},
                             .yaw = M_PI / 2,
                             .velocity = glm::dvec3(0, 10, 0),
                             .lights = {.high = LampState::On}});
        m.objects.push_back({.id = 2,
                             .kind = Kind::Truck,
                             .size = {8, 2.4, 3.2},
                             .centre = {1.5, y + 20, 1.6},
                             .yaw = M_PI / 2,
                             .velocity = glm::dvec3(0, 10, 0),
                             .lights = {.brake = i < 20 ? LampState::Off : LampState::On,
                                        .rear_fog = i < 20 ? LampState::Off : LampState::On}});
        if (i >= 20)
            m.objects.push_back({.id = 3, .kind = Kind::Pedestrian, .centre = {4, 130, 0.875}, .velocity = {}});
        made.push_back(std::move(m));
    }
    made[20].environment = osi::Environment{.sun_elevation = 0.3, .time_of_day = {}};
    return made;
}

std::string trace_of(const std::vector<osi::Message>& all) {
    std::string bytes;
    for (const osi::Message& message : all) bytes += osi::trace_bytes_of(message);
    return bytes;
}

// Lit lamps of a name in the scene.
int lit_lamps(const DrivenAlong& along, const std::string& name, const drive::ExternalState& external) {
    const gpu_scene::SceneFrame frame = along.scenery.frame(along.world.actors(), drive::DriveSettings(), external);
    int count = 0;
    for (size_t i = 0; i < along.scenery.scene().nodes.size(); ++i) {
        const scene::Node& node = along.scenery.scene().nodes[i];
        count +=
            node.lamp != scene::kNone && along.scenery.scene().lamps[node.lamp].name == name && frame.dimming[i] > 0;
    }
    return count;
}

// In any scene: the host is the driver's car, others are bodies of their size.
TEST(OsiDrive, ObjectsAreWhereTheyAreAndLit) {
    const TempFolder folder;
    DrivenAlong along(kScene, {.file = folder.write("a.osi", trace_of(messages()))});
    drive::ExternalState now = along.at(0.5);
    ASSERT_TRUE(now.driver);
    EXPECT_LT(glm::distance(now.driver->position, glm::dvec3(1.5, 0, -105)), 1e-9);
    EXPECT_NEAR(std::remainder(now.driver->yaw, 2 * M_PI), 0, 1e-9) << "along -Z";
    EXPECT_TRUE(now.driver->lamps.high && now.driver->lamps.low);
    ASSERT_EQ(now.actors.size(), 1u);
    const traffic::Actor& truck = now.actors[0].actor;
    EXPECT_LT(glm::distance(truck.position, glm::dvec3(1.5, 0, -125)), 1e-9);
    EXPECT_LT(glm::distance(truck.scale, glm::dvec3(0.8, 2.4 / 2.5, 3.2 / 3)), 1e-12);
    EXPECT_EQ(lit_lamps(along, "low beam", now), 2);
    EXPECT_EQ(lit_lamps(along, "brake lamp", now), 0);
    EXPECT_EQ(now.sun_elevation, std::nullopt);
    now = along.at(1.5);
    EXPECT_EQ(now.actors.size(), 2u);
    EXPECT_EQ(lit_lamps(along, "brake lamp", now), 2);
    EXPECT_EQ(lit_lamps(along, "rear fog lamp", now), 2);
    EXPECT_NEAR(now.sun_elevation.value(), 0.3 * 180 / M_PI, 1e-9);
    EXPECT_GT(along.scenery.frame(along.world.actors(), drive::DriveSettings(), now).ambient->illuminance.y, 1000);

    // Lamps of a body that is scaled are on it.
    const gpu_scene::SceneFrame frame = along.scenery.frame(along.world.actors(), drive::DriveSettings(), now);
    for (size_t i = 0; i < along.scenery.scene().nodes.size(); ++i) {
        const scene::Node& node = along.scenery.scene().nodes[i];
        if (node.lamp == scene::kNone || node.name != "rear fog lamp" || frame.world[i][3].y < -10) continue;
        EXPECT_NEAR(frame.world[i][3].z, -135 + 4, 0.05) << "the rear end, 4 m behind the middle";
        EXPECT_NEAR(glm::length(glm::dvec3(frame.world[i][2])), 1, 1e-6);
    }

    // Somebody else is the host, or nobody; and messages may have another origin.
    EXPECT_EQ(DrivenAlong(kScene, {.file = folder / "a.osi", .host = "2"}).at(0.5).driver->position.z, -125);
    EXPECT_FALSE(DrivenAlong(kScene, {.file = folder / "a.osi", .host = "none"}).at(0.5).driver);
    const drive::ExternalState moved =
        DrivenAlong(kScene, {.file = folder / "a.osi", .origin = {10, 20, 0, M_PI / 2}}).at(0.5);
    EXPECT_LT(glm::distance(moved.driver->position, glm::dvec3(10 - 105, 0, -20 - 1.5)), 1e-9);
}

// Nose and right side down are positive; the ground of an object is below its middle as it is turned.
TEST(OsiDrive, ObjectsPitchAndRoll) {
    const drive::Scenery scenery(kScene, {.live = true});
    traffic::World world(scenery.world(), 1);
    const auto placed = [&](double yaw, double pitch, double roll) {
        drive::ExternalPlaces places = scenery.external_places();
        osi::Moment moment;
        moment.objects.push_back({{.id = 1,
                                   .kind = Kind::Car,
                                   .size = {4.4, 1.8, 1.5},
                                   .centre = {0, 0, 10},
                                   .yaw = yaw,
                                   .pitch = pitch,
                                   .roll = roll,
                                   .velocity = {}}});
        const drive::ExternalState external = places.place(moment);
        world.place(external.actors, external.driver);
        const gpu_scene::SceneFrame frame = scenery.frame(world.actors(), drive::DriveSettings(), external);
        for (size_t i = 0; i < scenery.scene().nodes.size(); ++i)
            if (scenery.scene().nodes[i].name == "external_0") return frame.world[i];
        return glm::dmat4(0);
    };
    // Yaw 90 degrees is north, which is -Z.
    const glm::dmat4 down = placed(M_PI / 2, 0.1, 0), right = placed(M_PI / 2, 0, 0.2), turned = placed(0.3, 0.1, 0.2);
    EXPECT_NEAR(-down[2].y, -std::sin(0.1), 1e-9) << "the nose is lower";
    EXPECT_NEAR(-down[2].z, -std::cos(0.1), 1e-9);
    EXPECT_NEAR(right[0].y, -std::sin(0.2), 1e-9) << "the right side is lower";
    EXPECT_NEAR(right[0].x, std::cos(0.2), 1e-9);
    EXPECT_LT(glm::distance(glm::dvec3(right[3]), glm::dvec3(-0.75 * std::sin(0.2), 10 - 0.75 * std::cos(0.2), 0)),
              1e-9);
    // By yaw, then pitch, then roll: where the middle of the box is, whatever the turn.
    EXPECT_LT(glm::distance(glm::dvec3(turned * glm::dvec4(0, 0.75, 0, 1)), glm::dvec3(0, 10, 0)), 1e-9);
    EXPECT_LT(glm::distance(-glm::dvec3(turned[2]),
                            glm::dvec3(std::cos(0.3) * std::cos(0.1), -std::sin(0.1), -std::sin(0.3) * std::cos(0.1))),
              1e-9);
}

TEST(OsiDrive, BodiesAreGivenAsLongAsThereAreSome) {
    const TempFolder folder;
    drive::Scenery scenery(kScene, {.live = true});
    drive::ExternalPlaces places = scenery.external_places();
    osi::Moment moment;
    for (uint64_t i = 0; i < 40; ++i) moment.objects.push_back({{.id = i, .kind = Kind::Car, .velocity = {}}});
    drive::ExternalState now = places.place(moment);
    EXPECT_EQ(now.actors.size(), 32u);
    EXPECT_EQ(now.without_body, 8u);
    const size_t third = now.actors[3].index;
    moment.objects.erase(moment.objects.begin(), moment.objects.begin() + 2);
    now = places.place(moment);
    EXPECT_EQ(now.actors.size(), 32u) << "two places are free again";
    EXPECT_EQ(now.actors[1].index, third) << "the others keep theirs";
    moment.objects[0].object.kind = Kind::Pedestrian;
    EXPECT_EQ(places.place(moment).actors.size(), 33u);
    moment.objects[1].object.id = moment.objects[2].object.id;
    EXPECT_LE(places.place(moment).actors.size(), 33u) << "of two with one id the first counts";
}

TEST(OsiDrive, ModelsAreWhatTheTableSays) {
    const drive::Model model{.reference = "*/Audi*.osgb", .scene = {}};
    EXPECT_TRUE(model.is_meant_by("cars/audi_a4.OSGB"));
    EXPECT_FALSE(model.is_meant_by("audi_a4.osgb"));
    EXPECT_FALSE(model.is_meant_by("cars/audi.osgb.old"));
    EXPECT_TRUE((drive::Model{.reference = "*", .scene = {}}).is_meant_by(""));
    EXPECT_FALSE((drive::Model{.reference = "a", .scene = {}}).is_meant_by(""));

    const TempFolder folder;
    std::vector<osi::Message> all = messages();
    for (osi::Message& m : all) m.objects[1].model = "cars/glare.osgb";
    folder.write("a.osi", trace_of(all));
    const std::string glare = std::string(VESPER_SOURCE_DIR) + "/data/glare/headlamps.gltf";
    std::filesystem::copy(glare, folder / "glare.gltf");
    folder.write("m.json", R"({"version": 1, "models": [{"reference": "cars/gl*", "scene": "glare.gltf", "front": "+z",
                               "lamps": {"low": ["headlamp"]}}]})");
    DrivenAlong along(kScene, {.file = folder / "a.osi", .models = folder / "m.json"});
    const drive::ExternalState now = along.at(0.5);
    ASSERT_EQ(now.actors.size(), 1u);
    EXPECT_EQ(now.actors[0].actor.scale, glm::dvec3(1)) << "models keep their size";
    EXPECT_EQ(along.scenery.external_places().place(along.timeline.at(0.5)).actors.size(), 1u);

    for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
             {R"({"version": 2, "models": []})", "/version"},
             {R"({"version": 1, "models": [{"reference": "a"}]})", "/models/0"},
             {R"({"version": 1, "models": [{"reference": "a", "scene": "no.glb", "front": "up"}]})", "/models/0/front"},
             {R"({"version": 1, "models": [{"reference": "a", "scene": "x.glb", "lamp": {}}]})", "lamp"}}) {
        folder.write("bad.json", text);
        const std::string said = complaint_of([&] { drive::read_models(folder / "bad.json"); });
        EXPECT_TRUE(contains(said, "bad.json")) << text;
        EXPECT_TRUE(contains(said, words)) << text;
    }
    folder.write("m.json", R"({"version": 1, "models": [{"reference": "cars/gl*", "scene": "glare.gltf",
                               "lamps": {"low": ["none of it"]}}]})");
    const std::string said =
        complaint_of([&] { drive::Scenery(kScene, {.file = folder / "a.osi", .models = folder / "m.json"}); });
    EXPECT_TRUE(contains(said, "m.json: /models/0/lamps/low: ")) << said;
    EXPECT_TRUE(contains(said, "none of it")) << said;
    folder.write("m.json", R"({"version": 1, "models": [{"reference": "cars/gl*", "scene": "no.gltf"}]})");
    EXPECT_TRUE(
        contains(complaint_of([&] { drive::Scenery(kScene, {.file = folder / "a.osi", .models = folder / "m.json"}); }),
                 "no.gltf"));
}

TEST(OsiDrive, TheSkyIsAsItIsStated) {
    EXPECT_EQ(drive::sun_elevation_of({}), std::nullopt);
    EXPECT_NEAR(drive::sun_elevation_of({.sun_elevation = 0.1, .time_of_day = 0}).value(), 0.1 * 180 / M_PI, 1e-9);
    // At an equinox the sun rises at 6 and culminates at 45 degrees.
    EXPECT_NEAR(drive::sun_elevation_of({.sun_elevation = {}, .time_of_day = 43200}).value(), 45, 1e-9);
    EXPECT_NEAR(drive::sun_elevation_of({.sun_elevation = {}, .time_of_day = 21600}).value(), 0, 1e-9);
    EXPECT_NEAR(drive::sun_elevation_of({.sun_elevation = {}, .time_of_day = 0}).value(), -45, 1e-9);
    // Levels of illuminance: a moonlit night, twilight, day.
    double last = -90;
    for (int level = 1; level <= 9; ++level) {
        const double sun =
            drive::sun_elevation_of({.sun_elevation = {}, .time_of_day = {}, .ambient_level = level}).value();
        EXPECT_GT(sun, last) << level;
        last = sun;
    }
    EXPECT_LT(drive::sun_elevation_of({.sun_elevation = {}, .time_of_day = {}, .ambient_level = 2}).value(), -6);
    EXPECT_GT(last, 20);
}

class OsiDriveProgram : public ProgramTest {
protected:
    OsiDriveProgram() : ProgramTest(VESPER_DRIVE) {}
    const std::string common_ = "--headless --size 64x40 --indirect off --shadows off ";
    /// Runs the program, and `send` once it says where it listens.
    int run_along(const std::string& arguments, const std::function<void(const UdpSender&)>& send) {
        std::atomic<bool> ends{false};
        std::filesystem::remove(folder / "err.txt");
        std::thread simulator([&] {
            std::string port;
            while (port.empty() && !ends) {
                std::this_thread::sleep_for(std::chrono::milliseconds(50));
                std::ifstream file(folder / "err.txt");
                for (std::string line; std::getline(file, line);)
                    if (line.find("listening at 127.0.0.1:") != line.npos) port = line.substr(line.rfind(':') + 1);
            }
            if (!port.empty()) send(UdpSender(uint16_t(std::stoi(port))));
        });
        const int code = run(arguments);
        ends = true;
        simulator.join();
        return code;
    }
    void same_pictures(const std::string& one, const std::string& other, int count) {
        for (int i = 0; i < count; ++i)
            EXPECT_TRUE(read_text(folder / (one + std::to_string(i) + ".png")) ==
                        read_text(folder / (other + std::to_string(i) + ".png")))
                << i;
    }
};

// A drive written as a trace moves the same nodes at the same times when it is read.
TEST_F(OsiDriveProgram, WritesWhatItReads) {
    ASSERT_EQ(run(common_ + "--autopilot --seconds 1 --fps 5 --osi-out a.osi --video a%d.png"), 0) << said;
    const osi::Trace trace = osi::read_trace(folder / "a.osi");
    ASSERT_EQ(trace.messages.size(), 61u);
    EXPECT_EQ(trace.messages[60].nanoseconds, 1'000'000'000);
    EXPECT_EQ(trace.messages[0].host, 1u);
    ASSERT_EQ(run(common_ + kWorld + " --osi a.osi --seconds 1 --osi-out b.osi --video b%d.png"), 0) << said;
    const osi::Trace again = osi::read_trace(folder / "b.osi");
    ASSERT_EQ(again.messages.size(), 61u);
    for (size_t i = 0; i < 61; ++i) {
        const auto& one = trace.messages[i].objects;
        const auto& other = again.messages[i].objects;
        ASSERT_EQ(one.size(), other.size());
        for (size_t k = 0; k < one.size(); ++k) {
            const auto same = std::find_if(other.begin(), other.end(), [&](const osi::MovingObject& o) {
                return o.model == one[k].model && glm::distance(o.centre, one[k].centre) < 1e-6;
            });
            ASSERT_TRUE(same != other.end()) << i << " " << one[k].model;
            EXPECT_NEAR(std::remainder(same->yaw - one[k].yaw, 2 * M_PI), 0, 1e-9);
            EXPECT_EQ(same->lights.brake, one[k].lights.brake) << i << " " << one[k].model;
            EXPECT_EQ(same->lights.low, one[k].lights.low);
        }
    }
}

TEST_F(OsiDriveProgram, ATraceIsRecordedAndReplayedToTheBit) {
    folder.write("a.osi", trace_of(messages()));
    ASSERT_EQ(run(common_ + kScene + " --osi a.osi --seconds 1.5 --fps 4 --record d.json --video a%d.png"), 0) << said;
    ASSERT_EQ(run(common_ + "--replay d.json --video b%d.png"), 0) << said;
    same_pictures("a", "b", 7);
    EXPECT_TRUE(read_text(folder / "a2.png") != read_text(folder / "a6.png"));
    expect_refused(common_ + "--replay d.json --osi a.osi --log l.csv", {"--osi", "recording"});
    expect_refused(common_ + kScene + " --osi no.osi --log l.csv", {"no.osi"});
    expect_refused(common_ + kScene + " --osi d.json --log l.csv", {"--osi", ".osi"});
    expect_refused(common_ + kScene + " --osi a.osi --osi-udp 0 --log l.csv", {"--osi-udp", "a.osi"});
    expect_refused(common_ + kScene + " --osi a.osi --osi-out a.osi", {"a.osi"});
    expect_refused(common_ + kScene + " --osi a.osi --host me --log l.csv", {"--host", "number"});
    expect_refused(common_ + kScene + " --osi a.osi --osi-origin 1,2 --log l.csv", {"--osi-origin", "X,Y,Z,YAW"});
    expect_refused(common_ + kScene + " --osi-udp nowhere:1 --log l.csv", {"--osi-udp"});
    expect_refused(common_ + kScene + " --osi-delay 1 --log l.csv", {"--osi-delay"});
    folder.write("a.mcap", "\x89MCAP0\r\n");
    expect_refused(common_ + kScene + " --osi a.mcap --log l.csv", {"a.mcap", "pip install mcap", "TRACE.osi"});
    folder.write("bad.osi", "nothing of the kind");
    expect_refused(common_ + kScene + " --osi bad.osi --log l.csv", {"bad.osi", "message 1"});
}

// A simulator sends while one drives, with loss and out of order; the recording has the same pictures.
TEST_F(OsiDriveProgram, DrivesAlongWithWhatIsSent) {
    const int code = run_along(common_ + kScene + " --osi-udp 0 --seconds 1.5 --fps 4 --record d.json --video a%d.png",
                               [](const UdpSender& sender) {
                                   std::vector<osi::Message> all = messages();
                                   for (size_t i = 3; i + 1 < all.size(); i += 8) std::swap(all[i], all[i + 1]);
                                   all.erase(all.begin() + 30);
                                   for (size_t i = 0; i < all.size(); ++i) {
                                       const std::string bytes = osi::bytes_of(all[i]);
                                       i % 2 == 0 ? sender.send_packets(bytes, 100) : sender.send(bytes);
                                       if (i == 10) sender.send("noise");
                                       std::this_thread::sleep_for(std::chrono::milliseconds(10));
                                   }
                               });
    ASSERT_EQ(code, 0) << said;
    EXPECT_TRUE(contains(said, "1 malformed"));
    ASSERT_TRUE(exists("d.osi"));
    EXPECT_GT(osi::read_trace(folder / "d.osi").messages.size(), 25u);
    ASSERT_EQ(run(common_ + "--replay d.json --video b%d.png"), 0) << said;
    same_pictures("a", "b", 7);
    // A program that ended early leaves both as parts.
    std::filesystem::rename(folder / "d.osi", folder / "d.osi.part");
    std::filesystem::rename(folder / "d.json", folder / "d.json.part");
    ASSERT_EQ(run(common_ + "--replay d.json.part --video c%d.png"), 0) << said;
    same_pictures("a", "c", 7);
}

// The wait for a first message ends, and says what came instead.
TEST_F(OsiDriveProgram, WaitsNoLongerThanStated) {
    const std::string arguments = common_ + kScene + " --osi-udp 0 --seconds 0.1 --log l.csv";
    for (const std::string noise : {"", "x", "\x1a\x02\x08\x07"}) {
        const int code = run_along(arguments + " --osi-wait 1", [&](const UdpSender& sender) {
            if (!noise.empty()) sender.send(noise);
        });
        EXPECT_EQ(code, 2);
        EXPECT_TRUE(contains(said, "no message came in 1 s (--osi-wait)")) << said;
        EXPECT_EQ(contains(said, "1 malformed"), !noise.empty()) << said;
    }
    expect_refused(common_ + kScene + " --osi-wait 1 --log l.csv", {"--osi-wait", "--osi-udp"});
}

// More objects than there are bodies, away from the roads, of a sender that falls silent; an older trace has the name.
TEST_F(OsiDriveProgram, EndsWithItsSenderAndIsReplayed) {
    const std::string roads = std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.xodr";
    folder.write("d.osi", "of another drive");
    const auto begins = std::chrono::steady_clock::now();
    ASSERT_EQ(run_along(common_ + roads + " --osi-udp 0 --seconds 3 --fps 4 --record d.json --video a%d.png",
                        [](const UdpSender& sender) {
                            for (int i = 0; i <= 20; ++i) {
                                osi::Message m{.nanoseconds = i * int64_t{50'000'000}};
                                for (uint64_t k = 0; k < 40; ++k)
                                    m.objects.push_back({.id = k,
                                                         .kind = Kind::Car,
                                                         .centre = {4.0 * double(k), 5000 + 0.5 * i, 0.75},
                                                         .velocity = {}});
                                sender.send(osi::bytes_of(m));
                            }
                        }),
              0)
        << said;
    EXPECT_TRUE(contains(said, "the sender is silent"));
    EXPECT_LT(std::chrono::steady_clock::now() - begins, std::chrono::seconds(60)) << "5 s, and not at each step";
    ASSERT_EQ(run(common_ + "--replay d.json --video b%d.png"), 0) << said;
    same_pictures("a", "b", 4);
    ASSERT_EQ(run(common_ + "--replay d.json --fps 4 --video c%d.png"), 0) << said;
    same_pictures("a", "c", 4);
}

// What leaves as a trace is what came: kinds, sizes, names, lamps.
TEST_F(OsiDriveProgram, PassesOnWhatItHears) {
    folder.write("a.osi", trace_of(messages()));
    ASSERT_EQ(run(common_ + kScene + " --osi a.osi --seconds 1.5 --osi-out b.osi"), 0) << said;
    const osi::Message last = osi::read_trace(folder / "b.osi").messages.back();
    const osi::Message wanted = messages()[30];
    EXPECT_EQ(last.host, 1u);
    ASSERT_EQ(last.objects.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(last.objects[i].id, wanted.objects[i].id);
        EXPECT_EQ(last.objects[i].kind, wanted.objects[i].kind);
        EXPECT_EQ(last.objects[i].size, wanted.objects[i].size);
        EXPECT_LT(glm::distance(last.objects[i].centre, wanted.objects[i].centre), 1e-6);
    }
    EXPECT_EQ(last.objects[1].lights.rear_fog, LampState::On);
    const std::string roads =
        std::string(VESPER_SHARED_DATA) + "/scenario/esmini/xodr/fabriksgatan_traffic_lights.xodr";
    if (!std::filesystem::exists(roads)) return;
    ASSERT_EQ(run(common_ + roads + " --seconds 0.1 --osi-out c.osi"), 0) << said;
    EXPECT_EQ(osi::read_trace(folder / "c.osi").messages.back().traffic_lights.size(), 3u);
    // The plan of the roads: one light a signal, which changes its colour.
    ASSERT_EQ(run(common_ + roads + " --seconds 26 --osi-out d.osi"), 0) << said;
    const auto colour_of = [&](const osi::Message& message, const std::string& signal) {
        std::vector<std::pair<uint64_t, osi::TrafficLight::Colour>> found;
        for (const osi::TrafficLight& light : message.traffic_lights)
            if (light.signal == signal) found.emplace_back(light.id, light.colour);
        return found;
    };
    const auto trace = osi::read_trace(folder / "d.osi").messages;
    const auto before = colour_of(trace.front(), "1"), after = colour_of(trace.back(), "1");
    ASSERT_EQ(before.size(), 1u);
    ASSERT_EQ(after.size(), 1u);
    EXPECT_EQ(before[0].first, after[0].first);
    EXPECT_EQ(before[0].second, osi::TrafficLight::Colour::Red);
    EXPECT_EQ(after[0].second, osi::TrafficLight::Colour::Green);
}

}  // namespace
}  // namespace vesper::test
