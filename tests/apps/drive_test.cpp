// Sessions: drives that are recorded, broken off, read and driven again to the bit. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/luminance.h"
#include "drive_file.h"
#include "places.h"
#include "playback.h"
#include "session.h"
#include "support/program.h"

namespace vesper::test {
namespace {

const std::string kWorld = std::string(VESPER_SOURCE_DIR) + "/data/rivoli/rivoli.world.json";
constexpr VkExtent2D kSize{160, 100};

template <class Events>
std::vector<Frame> play(Session& session, const Events& events) {
    std::vector<Frame> frames;
    for (const DriveEvent& event : events) {
        switch (event.kind) {
            case DriveEvent::Kind::Step: session.step(event.input); break;
            case DriveEvent::Kind::Set: session.set(event.name, event.value); break;
            case DriveEvent::Kind::Restart: session.restart(); break;
            case DriveEvent::Kind::Frame: frames.push_back(session.render(kSize, {.display = true, .scene = true})); break;
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
    const auto add = [&](DriveEvent::Kind kind, const DriverInput& input = {}, const std::string& name = "", const std::string& value = "") {
        events.push_back({.kind = kind, .input = input, .pose = {}, .name = name, .value = value});
    };
    using Kind = DriveEvent::Kind;
    add(Kind::Frame);
    for (int i = 0; i < 90; ++i) {
        DriverInput input{.steering = 0.1 * std::sin(i * 0.1), .throttle = 0.4, .brake = i > 70 ? 0.7 : 0.0};
        input.beam = i > 30 ? Beam::High : Beam::Low;
        input.indicator = i > 50 ? Indicator::Left : Indicator::None;
        input.autopilot = i > 80;
        add(Kind::Step, input);
        if (i == 20) add(Kind::Set, {}, "operator", "ward");
        if (i == 40) add(Kind::Set, {}, "lamp:street lamp", "0.5");
        if (i == 60) add(Kind::Set, {}, "camera", "chase");
        if (i == 65) add(Kind::Set, {}, "operator", "irawan");
        if (i % 17 == 3 || i == 64) add(Kind::Frame);
    }
    add(Kind::Restart);
    add(Kind::Frame);
    return events;
}

TEST(Drive, AReplayHasTheSameBytes) {
    const TempFolder scratch;
    Device device({.select = ""});
    std::vector<Frame> driven;
    {
        Session session(device, {.scene = kWorld, .seed = 3, .settings = {{"age", "60"}}});
        const std::vector<DriveEvent> events = adventure();
        // Recording begins in the middle, and the file has the drive from its start.
        driven = play(session, std::vector(events.begin(), events.begin() + 40));
        session.record(scratch / "drive.json");
        for (Frame& frame : play(session, std::vector(events.begin() + 40, events.end()))) driven.push_back(std::move(frame));
        EXPECT_FALSE(std::filesystem::exists(scratch / "drive.json"));
        const Drive unfinished = read_drive(scratch / "drive.json.part");
        EXPECT_FALSE(unfinished.complete);
        EXPECT_EQ(unfinished.events.size(), events.size());
        session.stop_recording();
    }
    const Drive drive = read_drive(scratch / "drive.json");
    EXPECT_TRUE(drive.complete);
    EXPECT_EQ(drive.start.seed, 3u);
    Session session(device, {.scene = drive.start.scene, .seed = drive.start.seed, .time_step = drive.start.time_step, .settings = drive.start.settings});
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
        DriveRecorder recorder({.scene = kWorld, .run = {}, .scenario = {}, .seed = 1, .time_step = 1.0 / 60, .settings = {}});
        recorder.open(scratch / "whole.json");
        for (const DriveEvent& event : adventure()) recorder.add(event);
        recorder.close();
    }
    const std::string text = read_text(scratch / "whole.json");
    const size_t whole = read_drive(scratch / "whole.json").events.size(), head = text.find('\n') + 1;
    EXPECT_EQ(whole, adventure().size());
    for (size_t length = head; length < text.size(); length += 7) {
        std::ofstream(scratch / "cut.json") << text.substr(0, length);
        const Drive cut = read_drive(scratch / "cut.json");
        const auto lines = size_t(std::count(text.begin() + long(head), text.begin() + long(length), '\n'));
        EXPECT_GE(cut.events.size() + (length + 4 > text.size()), std::min(lines, whole)) << length;
    }
    for (const char* bad : {"", "{", "[]", "{\"vesper_drive\":2,\"scene\":\"x\",\"events\":[]}", "{\"vesper_drive\":1,\"scene\":\"x\",\"events\":[{\"step\":{\"steering\":7},\"pose\":[0,0,0,0]}]}",
                            "{\"vesper_drive\":1,\"scene\":\"x\",\"events\":[{\"jump\":1}]}"}) {
        std::ofstream(scratch / "bad.json") << bad;
        EXPECT_THROW(read_drive(scratch / "bad.json"), Error) << bad;
    }
}

TEST(Drive, SettingsAreTheOptionsOfRender) {
    DriveSettings settings;
    settings.set("operator", "reinhard");
    settings.set("display-peak", "500");
    settings.set("rods", "true");
    settings.set("sun", "-4");
    settings.set("free", "1,2,3,90,-10");
    EXPECT_EQ(settings.render().tone_operator, Operator::Reinhard);
    EXPECT_EQ(settings.render().display.peak, 500);
    EXPECT_EQ(settings.sun(), -4.0);
    EXPECT_EQ(settings.free_camera().position, glm::dvec3(1, 2, 3));
    const auto before = settings.values();
    for (const auto& [name, value] : std::map<std::string, std::string>{{"operator", "magic"}, {"age", "old"}, {"nothing", "1"}, {"lamp:x", "-1"}, {"display", "no such display"}, {"sun", "95"}})
        EXPECT_THROW(settings.set(name, value), Error) << name;
    EXPECT_EQ(settings.values(), before);
    settings.set("operator", "");
    EXPECT_EQ(settings.render().tone_operator, Operator::Irawan);
}

TEST(Drive, SettingsAreRefusedWithTheirPlace) {
    const TempFolder scratch;
    const auto refused = [&](const std::string& settings, const std::string& events) {
        scratch.write("d.json", "{\"vesper_drive\":1,\"scene\":\"x.gltf\",\"settings\":{" + settings + "},\"events\":[" + events + "]}");
        return complaint_of([&] { read_drive(scratch / "d.json"); });
    };
    EXPECT_EQ(refused("", R"({"set":{"age":"50"}})"), "");
    for (const auto& [name, value] : std::map<std::string, std::string>{{"help", "1"}, {"help", ""}, {"age", "old"}, {"age=5 --fov", "1"}, {"free", "1,2,nan,0,0"}, {"free", "0,0,0,0,91"}, {"free", "1,1e308,0,0,0"}, {"lamp:x", "-1"}}) {
        const std::string pair = "\"" + name + "\":\"" + value + "\"";
        const std::string event = refused("", "{\"frame\":true},{\"set\":{" + pair + "}}");
        EXPECT_TRUE(contains(event, "d.json: /events/1/set: ")) << event;
        EXPECT_EQ(event.find('\n'), event.npos) << event;
        if (!value.empty()) {
            EXPECT_TRUE(contains(refused(pair, ""), "d.json: /settings: ")) << pair;
        }
    }
    DriveSettings settings;
    settings.set("free", "0,0,0,720,0");
    EXPECT_NEAR(settings.free_camera().yaw, 0, 1e-12);
}

// What is given beside a recording wins over what it sets, and starting again brings back the settings of the start.
TEST(Drive, GivenSettingsWinOverRecordedOnes) {
    Device device({.select = ""});
    const DriveSettings::Values given{{"operator", "grave"}};
    Session session(device, {.scene = kWorld, .settings = {{"operator", "grave"}, {"age", "30"}}});
    DriveEvents events;
    events.push_back({.kind = DriveEvent::Kind::Set, .pose = {}, .name = "operator", .value = "ward"});
    events.push_back({.kind = DriveEvent::Kind::Set, .pose = {}, .name = "age", .value = "70"});
    DriveEvents elsewhere = events;
    events.push_back({.kind = DriveEvent::Kind::Step, .input = {.throttle = 1}, .pose = {}, .name = {}, .value = {}});
    elsewhere.push_back({.kind = DriveEvent::Kind::Step, .input = {.throttle = 1}, .pose = glm::dvec4(1, 2, 3, 4), .name = {}, .value = {}});
    Playback playback(events, given);
    while (playback.next(session)) {}
    EXPECT_EQ(session.settings().values().at("operator"), "grave");
    EXPECT_EQ(session.settings().values().at("age"), "70");
    EXPECT_FALSE(playback.strayed());
    session.set("operator", "reinhard");
    playback.rewind(session);
    EXPECT_EQ(session.settings().values(), (DriveSettings::Values{{"operator", "grave"}, {"age", "30"}}));
    EXPECT_EQ(session.world().steps(), 0u);
    EXPECT_EQ(playback.next(session), DriveEvent::Kind::Set);
    Playback other(elsewhere);
    while (other.next(session)) {}
    EXPECT_TRUE(other.strayed());
    EXPECT_EQ(session.settings().values().at("operator"), "ward");
}

TEST(Drive, LampsThatAreNotThereAreRefused) {
    Device device({.select = ""});
    EXPECT_TRUE(contains(complaint_of([&] { Session(device, {.scene = kWorld, .settings = {{"lamp:strete lamp", "0"}}}); }), "--lamp strete lamp: the scene has no lamp of that name; it has arcade lantern"));
    Session session(device, {.scene = kWorld, .settings = {}});
    EXPECT_THROW(session.set("lamp:strete lamp", "0"), Error);
    EXPECT_TRUE(session.settings().values().empty());
    session.set("lamp:street lamp", "0");
}

TEST(Drive, MovingLampsLightTheStreetAndGroupsDim) {
    Device device({.select = ""});
    Session session(device, {.scene = kWorld, .settings = {}});
    const Outputs outputs{.display = false, .scene = true};
    std::vector<std::string> lamps;
    for (const LampGroup& group : session.scenery().lamp_groups()) lamps.push_back(group.name);
    for (const char* name : {"street lamp", "low beam", "high beam", "brake lamp", "tunnel lamp", "left front indicator"}) EXPECT_TRUE(std::find(lamps.begin(), lamps.end(), name) != lamps.end()) << name;
    for (const std::string& lamp : lamps)
        if (lamp != "low beam" && lamp != "high beam") session.set("lamp:" + lamp, "0");
    session.step({.beam = Beam::Low});
    const Frame low = session.render(kSize, outputs);
    session.step({.beam = Beam::High});
    const Frame high = session.render(kSize, outputs);
    session.set("lamp:low beam", "0");
    session.set("lamp:high beam", "0");
    session.step({.beam = Beam::Low});
    const Frame dark = session.render(kSize, outputs);
    EXPECT_EQ(dark.lights, 0u);
    EXPECT_EQ(high.lights, low.lights + 2);  // of the driver's car
    EXPECT_GT(road_luminance(low), 2 * road_luminance(dark));
    EXPECT_GT(road_luminance(high), road_luminance(low));
    // They go with the car: the road before it stays lit.
    session.set("lamp:low beam", "1");
    for (int i = 0; i < 120; ++i) session.step({.beam = Beam::Low, .autopilot = true});
    EXPECT_GT(road_luminance(session.render(kSize, outputs)), 2 * road_luminance(dark));
}

TEST(Drive, EveryCameraSeesTheStreet) {
    Device device({.select = ""});
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
    Device device({.select = ""}), spare({.select = ""});
    Session session(device, {.scene = kWorld, .settings = {}}), same(device, {.scene = kWorld, .settings = {}});
    const auto drive = [&](Session& s) {
        for (int i = 0; i < 10; ++i) s.step({.autopilot = true});
        return s.render(kSize, {.display = true});
    };
    drive(session), drive(same);
    session.use(spare);
    EXPECT_EQ(drive(session).display, drive(same).display);
}

class DriveProgram : public ProgramTest {
protected:
    DriveProgram() : ProgramTest(VESPER_DRIVE) {}
};

TEST_F(DriveProgram, DrivesRecordsAndReplays) {
    const std::string size = "--headless --size 96x60 ";
    ASSERT_EQ(run(size + "--autopilot --seconds 0.5 --fps 10 --record drive.json --video a%02d.png --log a.csv --probe 0.5,0.7"), 0) << said;
    ASSERT_EQ(run(size + "--replay drive.json --video b%02d.png --log b.csv --probe 0.5,0.7"), 0) << said;
    EXPECT_EQ(said, "");
    for (int i = 0; i < 6; ++i) {
        const std::string name = "0" + std::to_string(i) + ".png";
        ASSERT_TRUE(exists("a" + name));
        EXPECT_EQ(read_text(folder / ("a" + name)), read_text(folder / ("b" + name))) << i;
    }
    // The recording has their size, too.
    ASSERT_EQ(run("--headless --replay drive.json --video c%02d.png"), 0) << said;
    EXPECT_EQ(read_text(folder / "a05.png"), read_text(folder / "c05.png"));
    for (const char* bad : {"[96]", "[0,60]", "[96,60.5]", "[96,20000]", "\"96x60\""}) {
        folder.write("bad.json", std::string(R"({"vesper_drive":1,"scene":"x","size_px":)") + bad + R"(,"events":[]})");
        expect_refused("--headless --replay bad.json --log l.csv", {"bad.json: /size_px"});
    }
    // Rows are the same but for the times they took, which are last.
    std::istringstream a(read_text(folder / "a.csv")), b(read_text(folder / "b.csv"));
    std::string one, other;
    int rows = 0;
    const auto cut = [](std::string line) {
        for (int i = 0; i < 2; ++i) line.resize(line.rfind(','));
        return line;
    };
    std::ptrdiff_t commas = 0;
    while (std::getline(a, one) && std::getline(b, other)) {
        EXPECT_EQ(cut(one), cut(other));
        if (rows++ == 0) commas = std::count(one.begin(), one.end(), ',');
        EXPECT_EQ(std::count(one.begin(), one.end(), ','), commas);
    }
    EXPECT_EQ(rows, 7);
    // Luminance, and rows without it.
    EXPECT_EQ(run(size + "--replay drive.json --fps 2 --video %d.exr"), 0) << said;
    EXPECT_TRUE(exists("1.exr"));
    EXPECT_EQ(run(size + "--replay drive.json --operator ldr --log ldr.csv --probe 0.5,0.7"), 0) << said;
    const std::string ldr = read_text(folder / "ldr.csv");
    EXPECT_EQ(std::count(ldr.begin(), ldr.end(), ','), 7 * commas);
}

// Options that would say nothing are named, with what they would need.
TEST_F(DriveProgram, RefusesIdleOptions) {
    const std::string replay = "--headless --log l.csv --replay d.json ", drive = "--headless --log l.csv --seconds 0 ";
    for (const char* option : {"--seed", "--seconds"}) expect_refused(replay + option + " 3", {option, "--replay"});
    expect_refused(replay + "--autopilot", {"--autopilot", "--replay"});
    expect_refused(replay + "--record r.json", {"--record", "replay"});
    expect_refused(replay + "x.xodr", {"scene", "--replay"});
    expect_refused(replay + "--scenario x.csv", {"--scenario", "--replay"});
    const auto name = [](const std::string& option) { return option.substr(0, option.find(' ')) + ": "; };
    for (const char* option : {"--video x.mp4", "--fps 30", "--seconds 3"}) expect_refused(option, {name(option), "--headless"});
    for (const char* option : {"--window 64x64", "--fullscreen", "--vsync off", "--limit 9", "--scaling fit", "--controllers c.json"}) expect_refused(drive + option, {name(option), "--headless"});
    for (const char* option : {"--size 64x64", "--fov 30"}) expect_refused(drive + "--channels c.json " + option, {name(option), "--channels"});
    expect_refused("--headless --record r.json --fps 30", {"--fps", "--video"});
    expect_refused("--headless --record r.json --probe 0.5,0.5", {"--probe", "--log"});
    expect_refused(drive + "--free 1,2,3,0,0", {"--free", "--camera free"});
    for (const char* probe : {",", "0.5", "0.5,", ",0.5", "0.5,0.5,0.5", "0.5,0.5x", "nan,0", "1.1,0", "0.5;0.5"}) expect_refused(drive + "--probe '" + probe + "'", {"--probe", "X,Y"});
    EXPECT_FALSE(exists("l.csv") || exists("r.json") || exists("l.csv.part"));
}

// There are as many frames as steps of the world, at most.
TEST_F(DriveProgram, RatesAreThoseThatThereAre) {
    folder.write("s.gltf", R"({"asset": {"version": "2.0"}})");
    expect_refused("s.gltf --headless --seconds 0.1 --log l.csv --fps 100", {"--fps 100", "at most 60"});
    // Two frames after a step each, then one after three.
    const std::string step = R"({"step":{}})", frame = R"(,{"frame":true},)";
    folder.write("d.json", R"({"vesper_drive":1,"scene":"s.gltf","events":[)" + step + frame + step + frame + step + "," + step + "," + step + R"(,{"frame":true}]})");
    ASSERT_EQ(run("--headless --size 16x10 --replay d.json --log l.csv"), 0) << "steps of a program need no pose: " << said;
    EXPECT_EQ(said.find("even rate"), std::string::npos) << said;
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not here";
    ASSERT_EQ(run("--headless --size 16x10 --replay d.json --video d.mp4"), 0) << said;
    EXPECT_NE(said.find("not recorded at an even rate: the film shows them at 60 a second"), std::string::npos) << said;
    folder.write("d.json", R"({"vesper_drive":1,"scene":"s.gltf","time_step_s":0.05,"events":[{"frame":true},)" + step + frame + R"({"frame":true}]})");
    ASSERT_EQ(run("--headless --size 16x10 --replay d.json --video d.mp4"), 0) << said;
    EXPECT_NE(said.find("--fps 20 takes frames"), std::string::npos) << "two at one moment: " << said;
}

// Only what ends too early is a drive that broke off, on however many lines.
TEST_F(DriveProgram, ErrorsAreNotEnds) {
    folder.write("s.gltf", R"({"asset": {"version": "2.0"}})");
    const std::string head = R"({"vesper_drive":1,"scene":"s.gltf","events":[{"step":{}},{"frame":true},)";
    folder.write("d.json", head + R"({"step":{"steering":NaN}},{"frame":true}]})");
    expect_refused("--headless --replay d.json --log l.csv", {"d.json: byte ", "not valid JSON"});
    folder.write("d.json", head + R"({"pose":[0,0,0,0]},{"frame":true}]})");
    expect_refused("--headless --replay d.json --log l.csv", {"/events/2", "a pose without a step"});
    folder.write("d.json", head + R"({"frame":true}]}x)");
    expect_refused("--headless --replay d.json --log l.csv", {"d.json: byte ", "not valid JSON"});
    for (const std::string& end : {std::string("{\"frame\":true},\n") + std::string(4, '\0'), std::string(""), std::string(R"({"st)"), std::string(R"({"step":{"steering":0.)"), std::string(R"({"frame":tr)")}) {
        folder.write("d.json", head + end);
        EXPECT_EQ(run("--headless --size 16x10 --replay d.json --log l.csv"), 0) << end << said;
        EXPECT_NE(said.find("breaks off"), std::string::npos) << end;
    }
}

// Names and places that nothing has.
TEST_F(DriveProgram, WorldsNameWhatThereIs) {
    folder.write("s.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"name":"car"},{"name":"lamp"}],"scene":0,"scenes":[{"nodes":[0,1]}]})");
    folder.write("p.json", R"({"version": 1, "lamps": [{"name": "brake lamp", "nodes": "lamp", "type": "point", "intensity_cd": 60}]})");
    const auto world = [&](const std::string& more, const std::string& driver = R"("lane": "a")") {
        folder.write("w.json", R"({"version": 1, "scene": "s.gltf", "photometry": "p.json", "driver": {)" + driver + R"(}, "lanes": [{"name": "a", "points": [[0, 0, 9], [0, 0, -9]]}])" + more + "}");
        return std::string("w.json --headless --size 16x10 --seconds 0.05 --log l.csv");
    };
    EXPECT_EQ(run(world(R"(, "lamps": {"brake": ["brake lamp"]}, "lit_by_day": ["brake lamp"])")), 0) << said;
    expect_refused(world(R"(, "lamps": {"brake": ["brake lamp", "brake lmap"]})"), {"w.json: /lamps/brake/1: ", "it has brake lamp"});
    expect_refused(world(R"(, "lit_by_day": ["zz"])"), {"w.json: /lit_by_day/0: "});
    for (const char* at : {"-5", "18.1"}) expect_refused(world("", std::string(R"("lane": "a", "at_m": )") + at), {"/driver/at_m", "18 m long"});
    EXPECT_EQ(run(world("", R"("lane": "a", "at_m": 18)")), 0) << said;
}

// No output replaces what is read, also where only another file names it; nor does what there is of a log replace a good one.
TEST_F(DriveProgram, SparesWhatItReadsAndWhatIsGood) {
    GltfFile scene;
    scene.show({{"attributes", {{"POSITION", scene.vec3(kTriangle)}}}, {"material", 0}});
    scene.root["materials"] = nlohmann::json::array({nlohmann::json::object()});
    scene.root["nodes"].push_back({{"name", "lamp"}});
    scene.text();
    scene.root["buffers"][0]["uri"] = "s.bin";
    std::ofstream(folder / "s.bin", std::ios::binary).write(reinterpret_cast<const char*>(scene.bytes.data()), std::streamsize(scene.bytes.size()));
    folder.write("s.gltf", scene.root.dump());
    folder.write("s.photometry.json", R"({"version": 1, "lamps": [{"name": "lamp", "nodes": "lamp", "type": "distribution", "file": "l.csv"}]})");
    std::filesystem::copy(std::string(VESPER_SOURCE_DIR) + "/data/photometry/low-beam.csv", folder / "l.csv");
    folder.write("w.json", R"({"version": 1, "scene": "s.gltf", "photometry": "s.photometry.json", "driver": {"lane": "a"}, "lanes": [{"name": "a", "points": [[0, 0, 9], [0, 0, -9]]}]})");
    const std::string common = "w.json --headless --size 16x10 --seconds 0.1 ";
    const auto whole = [&](const std::string& name) { return read_text(folder / name); };
    for (const char* input : {"w.json", "s.gltf", "s.bin", "s.photometry.json", "l.csv"}) {
        const std::string before = whole(input);
        ASSERT_FALSE(before.empty()) << input;
        expect_refused(common + "--log " + input, {"--log", input, "replace"});
        expect_refused(common + "--record " + input, {"--record", input, "replace"});
        EXPECT_EQ(whole(input), before) << input;
    }
    std::filesystem::create_symlink("s.bin", folder / "00002.exr");
    expect_refused(common + "--video %05d.exr", {"00002.exr", "replace"});
    expect_refused(common + "--log 00001.exr --video %05d.exr", {"00001.exr", "twice"});
    EXPECT_FALSE(exists("00000.exr")) << "before the first frame";
    // A link grows beside what it points at, which may be something that is read.
    std::filesystem::rename(folder / "s.bin", folder / "t.part");
    std::filesystem::create_symlink("t.part", folder / "s.bin");
    folder.write("t", "old");
    std::filesystem::create_symlink("t", folder / "link");
    expect_refused(common + "--log link", {"--log", "t.part", "replace"});
    expect_refused(common + "--record link", {"--record", "t.part", "replace"});
    EXPECT_EQ(whole("t.part"), std::string(scene.bytes.begin(), scene.bytes.end()));
    EXPECT_EQ(run(common + "--log good.csv"), 0) << said;
    EXPECT_FALSE(exists("good.csv.part"));
    const std::string good = whole("good.csv");
    // Frames end at a film that is none: the rows until then are beside the good ones.
    std::filesystem::remove_all(folder / "00002.exr");
    std::filesystem::create_directory(folder / "00002.exr");
    expect_refused(common + "--log good.csv --record good.json --video %05d.exr", {"00002.exr"});
    EXPECT_EQ(whole("good.csv"), good);
    const std::string part = whole("good.csv.part");
    EXPECT_EQ(std::count(part.begin(), part.end(), '\n'), 3);  // a heading and two frames
    EXPECT_FALSE(exists("good.json"));
    ASSERT_EQ(run("--headless --replay good.json.part --log replayed.csv --size 16x10"), 0) << said;
    EXPECT_NE(said.find("breaks off"), said.npos);
}

// What a recording comes to set is tried before the first frame, and named with its place.
TEST_F(DriveProgram, RefusesSettingsThatCannotBeShown) {
    std::filesystem::copy(std::string(VESPER_SOURCE_DIR) + "/data", folder / "data", std::filesystem::copy_options::recursive);
    const std::string step = R"({"step":{},"pose":[0,0,0,0]},)";
    const auto replay = [&](const std::string& set) {
        folder.write("d.json", R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","events":[{"frame":true},)" + step + R"({"set":)" + set + "}," + step + R"({"frame":true}]})");
        return std::string("--headless --size 16x10 --replay d.json ");
    };
    expect_refused(replay(R"({"age":"50","lamp:strete lamp":"0"})") + "--log l.csv", {"d.json: /events/2/set: ", "strete lamp"});
    expect_refused(replay(R"({"operator":"ldr"})") + "--video %d.exr", {"d.json: /events/2/set: ", "--video", "ldr"});
    expect_refused(replay(R"({"display":"hdr10"})") + "--video v.mp4", {"d.json: /events/2/set: ", "--video", "display"});
    expect_refused("--headless --size 16x10 --seconds 0.1 --operator ldr --video %d.exr", {"--video", "ldr"});
    EXPECT_FALSE(exists("l.csv.part") || exists("0.exr") || exists("v.mp4"));
    // So is what it begins with; what is not of it is not.
    const auto begun = [&](const std::string& settings) {
        folder.write("d.json", R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","settings":)" + settings + R"(,"events":[)" + step + R"({"frame":true}]})");
        return std::string("--headless --size 16x10 --replay d.json ");
    };
    expect_refused(begun(R"({"age":"50","lamp:strete lamp":"0"})") + "--log l.csv", {"d.json: /settings: ", "strete lamp"});
    expect_refused(begun(R"({"operator":"ldr"})") + "--video %d.exr", {"d.json: /settings: ", "--video", "ldr"});
    expect_refused(begun(R"({"age":"50"})") + "--log l.csv --lamp 'strete lamp=0'", {"vesper-drive: --lamp strete lamp"});
    expect_refused(begun(R"({"age":"50"})") + "--video %d.exr --operator ldr", {"vesper-drive: --video"});
    // What no frame shows is no matter: it is set again before one, or behind the last.
    const std::string shown = R"({"frame":true},)";
    folder.write("d.json", R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","settings":{"operator":"ldr"},"events":[{"set":{"operator":"ward"}},)" + shown + step +
                               R"({"set":{"operator":"ldr"}},)" + step + R"({"set":{"age":"40","operator":"ward"}},)" + shown + R"({"set":{"operator":"ldr"}},)" + step + R"({"set":{"age":"50"}}]})");
    EXPECT_EQ(run("--headless --size 16x10 --replay d.json --video u%d.exr"), 0) << said;
    EXPECT_TRUE(exists("u1.exr"));
    folder.write("d.json", R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","events":[)" + shown + R"({"set":{"operator":"ldr"}},{"set":{"age":"40"}},)" + step + shown + "{\"frame\":true}]}");
    expect_refused("--headless --size 16x10 --replay d.json --video v%d.exr", {"d.json: /events/1/set: ", "ldr"});
    // What is given beside the recording stands in its place.
    EXPECT_EQ(run(replay(R"({"operator":"ldr"})") + "--operator ward --video %d.exr"), 0) << said;
    EXPECT_TRUE(exists("1.exr"));
}

// Frames of a rate of their own begin where those of the recording do: after what is set before them.
TEST_F(DriveProgram, FramesOfARateBeginAfterWhatIsSet) {
    std::filesystem::copy(std::string(VESPER_SOURCE_DIR) + "/data", folder / "data", std::filesystem::copy_options::recursive);
    folder.write("d.json", R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","events":[{"set":{"operator":"ldr"}},{"frame":true},{"step":{},"pose":[0,0,0,0]},{"frame":true}]})");
    const auto first_row = [&](const std::string& options) {
        EXPECT_EQ(run("--headless --size 16x10 --replay d.json --log l.csv " + options), 0) << said;
        const std::string log = read_text(folder / "l.csv");
        const size_t row = log.find('\n') + 1;
        return log.substr(row, log.find('\n', row) - row);
    };
    EXPECT_NE(first_row("").find("ldr"), std::string::npos);
    EXPECT_NE(first_row("--fps 30").find("ldr"), std::string::npos);
}

// A blow is in the row after it, also where the drive begins again before that, and as often.
TEST_F(DriveProgram, LogsContactsOfEveryStart) {
    GltfFile scene;
    scene.show({{"attributes", {{"POSITION", scene.vec3(kTriangle)}}}});
    scene.root["nodes"].push_back({{"name", "van"}});
    folder.write("s.gltf", scene.text());
    folder.write("w.json", R"({"version": 1, "scene": "s.gltf", "driver": {"lane": "a", "speed_km_h": 50}, "lanes": [{"name": "a", "points": [[0, 0, 0], [0, 0, -500]], "speed_km_h": 1}],
                               "cars": [{"node": "van", "lane": "a", "at_m": 20, "wish": 0.05}]})");
    std::string second;
    for (int i = 0; i < 120; ++i) second += R"({"step":{},"pose":[0,0,0,0]},)";
    const std::string frame = R"({"frame":true})", restart = R"({"restart":true},)";
    folder.write("d.json", R"({"vesper_drive":1,"scene":"w.json","events":[)" + frame + "," + second + frame + "," + restart + second + frame + "," + restart + second + restart + frame + "]}");
    ASSERT_EQ(run("--headless --size 16x10 --replay d.json --log l.csv"), 0) << said;
    std::istringstream rows(read_text(folder / "l.csv"));
    std::string row;
    std::vector<int> blows;
    while (std::getline(rows, row)) blows.push_back(int(row.find("van@") != row.npos));
    EXPECT_EQ(blows, (std::vector{0, 0, 1, 1, 1}));
}

TEST_F(DriveProgram, RefusesWhatItCannotUse) {
    folder.write("bad.json", R"({"version": 1, "scene": "no.gltf", "lanes": []})");
    expect_refused("--headless", {"nothing to do"});
    expect_refused("--headless no.world.json --log l.csv", {"no.world.json"});
    expect_refused("--headless bad.json --log l.csv", {"bad.json", "lane"});
    expect_refused("--headless --replay no.json --log l.csv", {"no.json"});
    expect_refused("--headless --video x.avi", {"x.avi"});
    expect_refused("--headless --video x.png", {"%05d"});
    expect_refused("--headless --operator magic --log l.csv", {"magic"});
    expect_refused("--headless --lamp street --log l.csv", {"NAME=FACTOR"});
    EXPECT_FALSE(exists("l.csv"));
}

}  // namespace
}  // namespace vesper::test
