// Sessions: drives that are recorded, broken off, read and driven again to the bit. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/luminance.h"
#include "places.h"
#include "record/playback.h"
#include "scene/scene_files.h"
#include "session/drive_file.h"
#include "session/session.h"

namespace vesper::test {
namespace {

using drive::DriveEvent, drive::Session;
using render::Frame;

const std::string kWorld = std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.world.json";
constexpr VkExtent2D kSize{160, 100};

template <class Events>
std::vector<Frame> play(Session& session, const Events& events) {
    std::vector<Frame> frames;
    for (const DriveEvent& event : events) {
        switch (event.kind) {
            case DriveEvent::Kind::Step:
                session.step(event.input);
                break;
            case DriveEvent::Kind::Set:
                session.set(event.name, event.value);
                break;
            case DriveEvent::Kind::Restart:
                session.restart();
                break;
            case DriveEvent::Kind::Frame:
                frames.push_back(session.render(kSize, {.display = true, .scene = true}));
                break;
        }
    }
    return frames;
}

// Mean luminance of the road 8 to 20 m ahead, cd/m^2.
double road_luminance(const Frame& frame) {
    double sum = 0;
    int pixels = 0;
    for (uint32_t y = 58; y < 70; ++y)
        for (uint32_t x = 70; x < 95; ++x, ++pixels) {
            const float* p = &frame.scene[4 * (size_t(y) * kSize.width + x)];
            sum += luminance(glm::dvec3(p[0], p[1], p[2]));
        }
    return sum / pixels;
}

// Steering, pedals, lamps, cameras, operators and frames at uneven times, as a window makes them.
std::vector<DriveEvent> adventure() {
    std::vector<DriveEvent> events;
    const auto add = [&](DriveEvent::Kind kind, const traffic::DriverInput& input = {}, const std::string& name = "",
                         const std::string& value = "") {
        events.push_back({.kind = kind, .input = input, .pose = {}, .shown = {}, .name = name, .value = value});
    };
    using EventKind = DriveEvent::Kind;
    add(EventKind::Frame);
    for (int i = 0; i < 90; ++i) {
        traffic::DriverInput input{.steering = 0.1 * std::sin(i * 0.1), .throttle = 0.4, .brake = i > 70 ? 0.7 : 0.0};
        input.beam = i > 30 ? traffic::Beam::High : traffic::Beam::Low;
        input.indicator = i > 50 ? traffic::Indicator::Left : traffic::Indicator::None;
        input.autopilot = i > 80;
        add(EventKind::Step, input);
        if (i == 20) add(EventKind::Set, {}, "operator", "ward");
        if (i == 40) add(EventKind::Set, {}, "lamp:street lamp", "0.5");
        if (i == 60) add(EventKind::Set, {}, "camera", "chase");
        if (i == 65) add(EventKind::Set, {}, "operator", "irawan");
        if (i % 17 == 3 || i == 64) add(EventKind::Frame);
    }
    add(EventKind::Restart);
    add(EventKind::Frame);
    return events;
}

TEST(Drive, AReplayHasTheSameBytes) {
    const TempFolder scratch;
    gpu::Device device({.select = ""});
    std::vector<Frame> driven;
    {
        Session session(device, {.scene = kWorld, .seed = 3, .settings = {{"age", "60"}}});
        const std::vector<DriveEvent> events = adventure();
        // Recording begins in the middle, and the file has the drive from its start.
        driven = play(session, std::vector(events.begin(), events.begin() + 40));
        session.record(scratch / "drive.json");
        for (Frame& frame : play(session, std::vector(events.begin() + 40, events.end())))
            driven.push_back(std::move(frame));
        EXPECT_FALSE(std::filesystem::exists(scratch / "drive.json"));
        const drive::Drive unfinished = drive::read_drive(scratch / "drive.json.part");
        EXPECT_FALSE(unfinished.complete);
        EXPECT_EQ(unfinished.events.size(), events.size());
        session.stop_recording();
    }
    const drive::Drive drive = drive::read_drive(scratch / "drive.json");
    EXPECT_TRUE(drive.complete);
    EXPECT_EQ(drive.start.seed, 3u);
    Session session(device, {.scene = drive.start.scene,
                             .seed = drive.start.seed,
                             .time_step = drive.start.time_step,
                             .settings = drive.start.settings});
    const std::vector<Frame> again = play(session, drive.events);
    ASSERT_EQ(again.size(), driven.size());
    for (size_t i = 0; i < again.size(); ++i) {
        EXPECT_EQ(again[i].display, driven[i].display) << "frame " << i;
        EXPECT_EQ(again[i].scene, driven[i].scene) << "frame " << i;
        EXPECT_EQ(std::memcmp(&again[i].eye, &driven[i].eye, sizeof(shared::EyeState)), 0) << "frame " << i;
    }
    EXPECT_NE(driven[1].display, driven[2].display);
}

// Whatever the place where a program ended: all whole lines are there.
TEST(Drive, ARecordingThatBreaksOffCanBeRead) {
    const TempFolder scratch;
    {
        drive::DriveRecorder recorder(
            {.scene = kWorld, .messages = {}, .seed = 1, .time_step = 1.0 / 60, .settings = {}});
        recorder.open(scratch / "whole.json");
        for (const DriveEvent& event : adventure()) recorder.add(event);
        recorder.close();
    }
    const std::string text = read_text(scratch / "whole.json");
    const size_t whole = drive::read_drive(scratch / "whole.json").events.size(), head = text.find('\n') + 1;
    EXPECT_EQ(whole, adventure().size());
    for (size_t length = head; length < text.size(); length += 7) {
        std::ofstream(scratch / "cut.json") << text.substr(0, length);
        const drive::Drive cut = drive::read_drive(scratch / "cut.json");
        const auto lines = size_t(std::count(text.begin() + long(head), text.begin() + long(length), '\n'));
        EXPECT_GE(cut.events.size() + (length + 4 > text.size()), std::min(lines, whole)) << length;
    }
    for (const char* bad :
         {"", "{", "[]", "{\"vesper_drive\":2,\"scene\":\"x\",\"events\":[]}",
          "{\"vesper_drive\":1,\"scene\":\"x\",\"events\":[{\"step\":{\"steering\":7},\"pose\":[0,0,0,0]}]}",
          "{\"vesper_drive\":1,\"scene\":\"x\",\"events\":[{\"jump\":1}]}"}) {
        std::ofstream(scratch / "bad.json") << bad;
        EXPECT_THROW(drive::read_drive(scratch / "bad.json"), Error) << bad;
    }
}

TEST(Drive, SettingsAreTheOptionsOfRender) {
    drive::DriveSettings settings;
    settings.set("operator", "reinhard");
    settings.set("display-peak", "500");
    settings.set("rods", "on");
    settings.set("sun", "-4");
    settings.set("free", "1,2,3,90,-10");
    EXPECT_EQ(settings.render().tone_operator, render::Operator::Reinhard);
    EXPECT_EQ(settings.render().display.peak, 500);
    EXPECT_EQ(settings.sun(), -4.0);
    EXPECT_EQ(settings.free_camera().position, glm::dvec3(1, 2, 3));
    const auto before = settings.values();
    for (const auto& [name, value] : std::map<std::string, std::string>{{"operator", "magic"},
                                                                        {"age", "old"},
                                                                        {"nothing", "1"},
                                                                        {"lamp:x", "-1"},
                                                                        {"display", "no such display"},
                                                                        {"sun", "95"}})
        EXPECT_THROW(settings.set(name, value), Error) << name;
    EXPECT_EQ(settings.values(), before);
    settings.set("operator", "");
    EXPECT_EQ(settings.render().tone_operator, render::Operator::Irawan);
}

TEST(Drive, SettingsAreRefusedWithTheirPlace) {
    const TempFolder scratch;
    const auto refused = [&](const std::string& settings, const std::string& events) {
        scratch.write("d.json", "{\"vesper_drive\":1,\"scene\":\"x.gltf\",\"settings\":{" + settings +
                                    "},\"events\":[" + events + "]}");
        return complaint_of([&] { drive::read_drive(scratch / "d.json"); });
    };
    EXPECT_EQ(refused("", R"({"set":{"age":"50"}})"), "");
    for (const auto& [name, value] : std::map<std::string, std::string>{{"help", "1"},
                                                                        {"help", ""},
                                                                        {"age", "old"},
                                                                        {"age=5 --fov", "1"},
                                                                        {"free", "1,2,nan,0,0"},
                                                                        {"free", "0,0,0,0,91"},
                                                                        {"free", "1,1e308,0,0,0"},
                                                                        {"lamp:x", "-1"}}) {
        const std::string pair = "\"" + name + "\":\"" + value + "\"";
        const std::string event = refused("", "{\"frame\":true},{\"set\":{" + pair + "}}");
        EXPECT_TRUE(contains(event, "d.json: /events/1/set: ")) << event;
        EXPECT_EQ(event.find('\n'), event.npos) << event;
        if (!value.empty()) {
            EXPECT_TRUE(contains(refused(pair, ""), "d.json: /settings: ")) << pair;
        }
    }
    drive::DriveSettings settings;
    settings.set("free", "0,0,0,720,0");
    EXPECT_NEAR(settings.free_camera().yaw, 0, 1e-12);
}

// What is given beside a recording wins over what it sets, and starting again brings back the settings of the start.
TEST(Drive, GivenSettingsWinOverRecordedOnes) {
    gpu::Device device({.select = ""});
    const drive::DriveSettings::Values given{{"operator", "grave"}};
    Session session(device, {.scene = kWorld, .settings = {{"operator", "grave"}, {"age", "30"}}});
    drive::DriveEvents events;
    events.push_back({.kind = DriveEvent::Kind::Set, .pose = {}, .shown = {}, .name = "operator", .value = "ward"});
    events.push_back({.kind = DriveEvent::Kind::Set, .pose = {}, .shown = {}, .name = "age", .value = "70"});
    drive::DriveEvents elsewhere = events;
    events.push_back(
        {.kind = DriveEvent::Kind::Step, .input = {.throttle = 1}, .pose = {}, .shown = {}, .name = {}, .value = {}});
    elsewhere.push_back({.kind = DriveEvent::Kind::Step,
                         .input = {.throttle = 1},
                         .pose = glm::dvec4(1, 2, 3, 4),
                         .name = {},
                         .value = {}});
    drive::Playback playback(events, given);
    while (playback.next(session)) {
    }
    EXPECT_EQ(session.settings().values().at("operator"), "grave");
    EXPECT_EQ(session.settings().values().at("age"), "70");
    EXPECT_FALSE(playback.strayed());
    session.set("operator", "reinhard");
    playback.rewind(session);
    EXPECT_EQ(session.settings().values(), (drive::DriveSettings::Values{{"operator", "grave"}, {"age", "30"}}));
    EXPECT_EQ(session.world().steps(), 0u);
    EXPECT_EQ(playback.next(session), DriveEvent::Kind::Set);
    drive::Playback other(elsewhere);
    while (other.next(session)) {
    }
    EXPECT_TRUE(other.strayed());
    EXPECT_EQ(session.settings().values().at("operator"), "ward");
}

/// A lamp over a plate over a wide floor, and a camera that takes a plate of its own along.
std::string plates() {
    GltfFile file;
    const auto square = [&](float half, nlohmann::json node) {
        file.show({{"attributes",
                    {{"POSITION", file.vec3({-half, 0, -half, half, 0, -half, half, 0, half, -half, 0, half})}}},
                   {"indices", file.indices({0, 2, 1, 0, 3, 2})}},
                  node);
    };
    square(40, {{"name", "floor"}});
    square(1, {{"name", "plate"}, {"translation", {0, 2, -10}}});
    square(0.5f, {{"name", "bonnet"}, {"translation", {0, -0.8, -3}}});
    file.root["nodes"].push_back({{"name", "eye"}, {"camera", 0}, {"translation", {0, 1.5, 0}}, {"children", {2}}});
    file.root["nodes"].push_back(
        {{"name", "lamp"}, {"translation", {0, 4, -10}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 1000}}};
    file.root["extras"]["vesper"] = {{"version", 1}};
    return file.text();
}

TEST(Drive, ShadowsAreSwitchedAndRecorded) {
    const TempFolder scratch;
    const auto scene = scratch.write("plates.gltf", plates());
    gpu::Device device({.select = ""});
    Session session(device, {.scene = scene, .settings = {}});
    const auto frame = [&](Session& of) { return of.render(kSize, {.display = true, .scene = true}); };
    session.set("shadows", "off");
    session.record(scratch / "drive.json");
    const Frame without = frame(session);
    EXPECT_EQ(without.maps.lamps, 0u);
    session.set("shadows", "on");
    const Frame with = frame(session);
    EXPECT_EQ(with.maps.maps, 1u);
    EXPECT_NE(with.scene, without.scene);
    for (int i = 0; i < 6; ++i) session.step({.throttle = 1});
    const Frame moved = frame(session);
    EXPECT_EQ(moved.maps.maps, 0u);
    EXPECT_GT(moved.maps.bodies, 0u);
    session.set("shadows", "off");
    EXPECT_EQ(frame(session).maps.lamps, 0u);
    session.stop_recording();

    const drive::Drive drive = drive::read_drive(scratch / "drive.json");
    Session again(device, {.scene = drive.start.scene, .settings = drive.start.settings});
    const std::vector<Frame> replayed = play(again, drive.events);
    ASSERT_EQ(replayed.size(), 4u);
    EXPECT_EQ(replayed[0].scene, without.scene);
    EXPECT_EQ(replayed[1].scene, with.scene);
    EXPECT_EQ(replayed[2].scene, moved.scene);
    EXPECT_TRUE(contains(complaint_of([&] { session.set("shadows", "soft"); }), "--shadows"));
}

TEST(Drive, LampsThatAreNotThereAreRefused) {
    gpu::Device device({.select = ""});
    EXPECT_TRUE(contains(complaint_of([&] {
                             Session(device, {.scene = kWorld, .settings = {{"lamp:strete lamp", "0"}}});
                         }),
                         "--lamp strete lamp: the scene has no lamp of that name; it has arcade lantern"));
    Session session(device, {.scene = kWorld, .settings = {}});
    EXPECT_THROW(session.set("lamp:strete lamp", "0"), Error);
    EXPECT_TRUE(session.settings().values().empty());
    session.set("lamp:street lamp", "0");
}

TEST(Drive, MovingLampsLightTheStreetAndGroupsDim) {
    gpu::Device device({.select = ""});
    Session session(device, {.scene = kWorld, .settings = {}});
    const render::Outputs outputs{.display = false, .scene = true};
    std::vector<std::string> lamps;
    for (const drive::LampGroup& group : session.scenery().lamp_groups()) lamps.push_back(group.name);
    for (const char* name :
         {"street lamp", "low beam", "high beam", "brake lamp", "tunnel lamp", "left front indicator"})
        EXPECT_TRUE(std::find(lamps.begin(), lamps.end(), name) != lamps.end()) << name;
    for (const std::string& lamp : lamps)
        if (lamp != "low beam" && lamp != "high beam") session.set("lamp:" + lamp, "0");
    session.step({.beam = traffic::Beam::Low});
    const Frame low = session.render(kSize, outputs);
    session.step({.beam = traffic::Beam::High});
    const Frame high = session.render(kSize, outputs);
    session.set("lamp:low beam", "0");
    session.set("lamp:high beam", "0");
    session.step({.beam = traffic::Beam::Low});
    const Frame dark = session.render(kSize, outputs);
    EXPECT_EQ(dark.lamps, 0u);
    EXPECT_EQ(high.lamps, low.lamps + 2);  // of the driver's car
    EXPECT_GT(road_luminance(low), 2 * road_luminance(dark));
    EXPECT_GT(road_luminance(high), road_luminance(low));
    // They go with the car: the road before it stays lit.
    session.set("lamp:low beam", "1");
    for (int i = 0; i < 120; ++i) session.step({.beam = traffic::Beam::Low, .autopilot = true});
    EXPECT_GT(road_luminance(session.render(kSize, outputs)), 2 * road_luminance(dark));
}

TEST(Drive, EveryCameraSeesTheStreet) {
    gpu::Device device({.select = ""});
    Session session(device, {.scene = kWorld, .settings = {}});
    std::vector<std::vector<uint8_t>> seen;
    for (const char* camera : {"driver", "chase", "bird", "free"}) {
        session.set("camera", camera);
        if (std::string(camera) == "free") session.set("free", "9.9,1.7,-190,45,0");
        seen.push_back(session.render(kSize, {.display = true}).display);
        for (size_t other = 0; other + 1 < seen.size(); ++other) EXPECT_NE(seen[other], seen.back()) << camera;
    }
}

// Another device, as after one was lost: the eye goes on where it was.
TEST(Drive, GoesOnWithAnotherDevice) {
    gpu::Device device({.select = ""}), spare({.select = ""});
    const drive::DriveStart start{.scene = kWorld, .settings = {{"shadows", "off"}}};
    Session session(device, start), same(device, start);
    const auto drive = [&](Session& s) {
        for (int i = 0; i < 10; ++i) s.step({.autopilot = true});
        return s.render(kSize, {.display = true});
    };
    drive(session), drive(same);
    session.use(spare);
    EXPECT_EQ(drive(session).display, drive(same).display);
}

}  // namespace
}  // namespace vesper::test
