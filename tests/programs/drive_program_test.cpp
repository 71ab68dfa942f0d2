// `vesper-drive` as people run it: outputs, refusals, what is spared. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "io/hdr_image.h"
#include "places.h"
#include "scene/scene_files.h"
#include "support/program.h"

namespace vesper::test {
namespace {

class DriveProgram : public ProgramTest {
protected:
    DriveProgram() : ProgramTest(VESPER_DRIVE) {}
};

TEST_F(DriveProgram, DrivesRecordsAndReplays) {
    const std::string size = "--headless --size 96x60 --shadows off --indirect off ";
    ASSERT_EQ(
        run(size +
            "--autopilot --seconds 0.5 --fps 10 --record drive.json --video a%02d.png --log a.csv --probe 0.5,0.7"),
        0)
        << said;
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

// The program's own scenes have names of their own in recordings; what is no such name is refused with its place.
TEST_F(DriveProgram, RecordingsNameOwnScenes) {
    ASSERT_EQ(run("'" VESPER_SOURCE_DIR "/data/rivoli/rivoli.world.json' --headless --seconds 0 --record d.json"), 0)
        << said;
    EXPECT_NE(read_text(folder / "d.json").find(R"("scene":"vesper:rivoli/rivoli.world.json")"), std::string::npos);
    for (const char* bad :
         {"vesper:", "vesper:..", "vesper:rivoli/../../x.gltf", "vesper:/x.gltf", "vesper:rivoli/none.json"}) {
        const char* named = std::string(bad).ends_with("none.json") ? "rivoli/none.json" : "d.json: /scene";
        folder.write("d.json", std::string(R"({"vesper_drive":1,"scene":")") + bad + R"(","events":[{"frame":true}]})");
        expect_refused("--headless --size 16x10 --shadows off --indirect off --replay d.json --log l.csv", {named});
    }
    EXPECT_FALSE(exists("l.csv"));
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
    for (const char* option : {"--video x.mp4", "--fps 30", "--seconds 3"})
        expect_refused(option, {name(option), "--headless"});
    for (const char* option :
         {"--window 64x64", "--fullscreen", "--vsync off", "--limit 9", "--scaling fit", "--controllers c.json"})
        expect_refused(drive + option, {name(option), "--headless"});
    for (const char* option : {"--size 64x64", "--fov 30"})
        expect_refused(drive + "--channels c.json " + option, {name(option), "--channels"});
    expect_refused("--headless --record r.json --fps 30", {"--fps", "--video"});
    expect_refused("--headless --record r.json --probe 0.5,0.5", {"--probe", "--log"});
    expect_refused(drive + "--free 1,2,3,0,0", {"--free", "--camera free"});
    for (const char* probe : {",", "0.5", "0.5,", ",0.5", "0.5,0.5,0.5", "0.5,0.5x", "nan,0", "1.1,0", "0.5;0.5"})
        expect_refused(drive + "--probe '" + probe + "'", {"--probe", "X,Y"});
    EXPECT_FALSE(exists("l.csv") || exists("r.json") || exists("l.csv.part"));
}

// There are as many frames as steps of the world, at most.
TEST_F(DriveProgram, RatesAreThoseThatThereAre) {
    folder.write("s.gltf", R"({"asset": {"version": "2.0"}})");
    expect_refused("s.gltf --headless --seconds 0.1 --log l.csv --fps 100", {"--fps 100", "at most 60"});
    // Two frames after a step each, then one after three.
    const std::string step = R"({"step":{}})", frame = R"(,{"frame":true},)";
    folder.write("d.json", R"({"vesper_drive":1,"scene":"s.gltf","events":[)" + step + frame + step + frame + step +
                               "," + step + "," + step + R"(,{"frame":true}]})");
    ASSERT_EQ(run("--headless --size 16x10 --shadows off --indirect off --replay d.json --log l.csv"), 0)
        << "steps of a program need no pose: " << said;
    EXPECT_EQ(said.find("even rate"), std::string::npos) << said;
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not here";
    ASSERT_EQ(run("--headless --size 16x10 --shadows off --indirect off --replay d.json --video d.mp4"), 0) << said;
    EXPECT_NE(said.find("not recorded at an even rate: the film shows them at 60 a second"), std::string::npos) << said;
    folder.write("d.json", R"({"vesper_drive":1,"scene":"s.gltf","time_step_s":0.05,"events":[{"frame":true},)" + step +
                               frame + R"({"frame":true}]})");
    ASSERT_EQ(run("--headless --size 16x10 --shadows off --indirect off --replay d.json --video d.mp4"), 0) << said;
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
    for (const std::string& end :
         {std::string("{\"frame\":true},\n") + std::string(4, '\0'), std::string(""), std::string(R"({"st)"),
          std::string(R"({"step":{"steering":0.)"), std::string(R"({"frame":tr)")}) {
        folder.write("d.json", head + end);
        EXPECT_EQ(run("--headless --size 16x10 --shadows off --indirect off --replay d.json --log l.csv"), 0)
            << end << said;
        EXPECT_NE(said.find("breaks off"), std::string::npos) << end;
    }
}

// Names and places that nothing has.
TEST_F(DriveProgram, WorldsNameWhatThereIs) {
    folder.write(
        "s.gltf",
        R"({"asset":{"version":"2.0"},"nodes":[{"name":"car"},{"name":"lamp"}],"scene":0,"scenes":[{"nodes":[0,1]}]})");
    folder.write(
        "p.json",
        R"({"version": 1, "lamps": [{"name": "brake lamp", "nodes": "lamp", "type": "point", "intensity_cd": 60}]})");
    const auto world = [&](const std::string& more, const std::string& driver = R"("lane": "a")") {
        folder.write("w.json", R"({"version": 1, "scene": "s.gltf", "photometry": "p.json", "driver": {)" + driver +
                                   R"(}, "lanes": [{"name": "a", "points": [[0, 0, 9], [0, 0, -9]]}])" + more + "}");
        return std::string("w.json --headless --size 16x10 --seconds 0.05 --log l.csv");
    };
    EXPECT_EQ(run(world(R"(, "lamps": {"brake": ["brake lamp"]}, "lit_by_day": ["brake lamp"])")), 0) << said;
    expect_refused(world(R"(, "lamps": {"brake": ["brake lamp", "brake lmap"]})"),
                   {"w.json: /lamps/brake/1: ", "it has brake lamp"});
    expect_refused(world(R"(, "lit_by_day": ["zz"])"), {"w.json: /lit_by_day/0: "});
    for (const char* at : {"-5", "18.1"})
        expect_refused(world("", std::string(R"("lane": "a", "at_m": )") + at), {"/driver/at_m", "18 m long"});
    EXPECT_EQ(run(world("", R"("lane": "a", "at_m": 18)")), 0) << said;
}

// No output replaces what is read, also where only another file names it; nor does what there is of a log replace a
// good one.
TEST_F(DriveProgram, SparesWhatItReadsAndWhatIsGood) {
    GltfFile scene;
    scene.show({{"attributes", {{"POSITION", scene.vec3(kTriangle)}}}, {"material", 0}});
    scene.root["materials"] = nlohmann::json::array({nlohmann::json::object()});
    scene.root["nodes"].push_back({{"name", "lamp"}});
    scene.text();
    scene.root["buffers"][0]["uri"] = "s.bin";
    std::ofstream(folder / "s.bin", std::ios::binary)
        .write(reinterpret_cast<const char*>(scene.bytes.data()), std::streamsize(scene.bytes.size()));
    folder.write("s.gltf", scene.root.dump());
    folder.write(
        "s.photometry.json",
        R"({"version": 1, "lamps": [{"name": "lamp", "nodes": "lamp", "type": "distribution", "file": "l.csv"}]})");
    std::filesystem::copy(std::string(VESPER_SOURCE_DIR) + "/data/photometry/low-beam.csv", folder / "l.csv");
    folder.write(
        "w.json",
        R"({"version": 1, "scene": "s.gltf", "photometry": "s.photometry.json", "driver": {"lane": "a"}, "lanes": [{"name": "a", "points": [[0, 0, 9], [0, 0, -9]]}]})");
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
    std::filesystem::copy(std::string(VESPER_SOURCE_DIR) + "/data", folder / "data",
                          std::filesystem::copy_options::recursive);
    const std::string step = R"({"step":{},"pose":[0,0,0,0]},)";
    const auto replay = [&](const std::string& set) {
        folder.write("d.json",
                     R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","events":[{"frame":true},)" + step +
                         R"({"set":)" + set + "}," + step + R"({"frame":true}]})");
        return std::string(
            "--headless --allow-outside data --size 16x10 --shadows off --indirect off --replay d.json ");
    };
    expect_refused(replay(R"({"age":"50","lamp:strete lamp":"0"})") + "--log l.csv",
                   {"d.json: /events/2/set: ", "strete lamp"});
    expect_refused(replay(R"({"operator":"ldr"})") + "--video %d.exr", {"d.json: /events/2/set: ", "--video", "ldr"});
    expect_refused(replay(R"({"display":"hdr10"})") + "--video v.mp4",
                   {"d.json: /events/2/set: ", "--video", "display"});
    expect_refused("--headless --size 16x10 --seconds 0.1 --operator ldr --video %d.exr", {"--video", "ldr"});
    EXPECT_FALSE(exists("l.csv.part") || exists("0.exr") || exists("v.mp4"));
    // So is what it begins with; what is not of it is not.
    const auto begun = [&](const std::string& settings) {
        folder.write("d.json", R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","settings":)" + settings +
                                   R"(,"events":[)" + step + R"({"frame":true}]})");
        return std::string(
            "--headless --allow-outside data --size 16x10 --shadows off --indirect off --replay d.json ");
    };
    expect_refused(begun(R"({"age":"50","lamp:strete lamp":"0"})") + "--log l.csv",
                   {"d.json: /settings: ", "strete lamp"});
    expect_refused(begun(R"({"operator":"ldr"})") + "--video %d.exr", {"d.json: /settings: ", "--video", "ldr"});
    expect_refused(begun(R"({"age":"50"})") + "--log l.csv --lamp 'strete lamp=0'",
                   {"vesper-drive: --lamp strete lamp"});
    expect_refused(begun(R"({"age":"50"})") + "--video %d.exr --operator ldr", {"vesper-drive: --video"});
    // What no frame shows is no matter: it is set again before one, or behind the last.
    const std::string shown = R"({"frame":true},)";
    folder.write(
        "d.json",
        R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","settings":{"operator":"ldr"},"events":[{"set":{"operator":"ward"}},)" +
            shown + step + R"({"set":{"operator":"ldr"}},)" + step + R"({"set":{"age":"40","operator":"ward"}},)" +
            shown + R"({"set":{"operator":"ldr"}},)" + step + R"({"set":{"age":"50"}}]})");
    EXPECT_EQ(run("--headless --allow-outside data --size 16x10 --shadows off --indirect off --replay d.json --video "
                  "u%d.exr"),
              0)
        << said;
    EXPECT_TRUE(exists("u1.exr"));
    folder.write("d.json", R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","events":[)" + shown +
                               R"({"set":{"operator":"ldr"}},{"set":{"age":"40"}},)" + step + shown +
                               "{\"frame\":true}]}");
    expect_refused(
        "--headless --allow-outside data --size 16x10 --shadows off --indirect off --replay d.json --video v%d.exr",
        {"d.json: /events/1/set: ", "ldr"});
    // What is given beside the recording stands in its place.
    EXPECT_EQ(run(replay(R"({"operator":"ldr"})") + "--operator ward --video %d.exr"), 0) << said;
    EXPECT_TRUE(exists("1.exr"));
}

// Frames of a rate of their own begin where those of the recording do: after what is set before them.
TEST_F(DriveProgram, FramesOfARateBeginAfterWhatIsSet) {
    std::filesystem::copy(std::string(VESPER_SOURCE_DIR) + "/data", folder / "data",
                          std::filesystem::copy_options::recursive);
    folder.write(
        "d.json",
        R"({"vesper_drive":1,"scene":"data/rivoli/rivoli.world.json","events":[{"set":{"operator":"ldr"}},{"frame":true},{"step":{},"pose":[0,0,0,0]},{"frame":true}]})");
    const auto first_row = [&](const std::string& options) {
        EXPECT_EQ(run("--headless --allow-outside data --size 16x10 --shadows off --indirect off --replay d.json --log "
                      "l.csv " +
                      options),
                  0)
            << said;
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
    folder.write(
        "w.json",
        R"({"version": 1, "scene": "s.gltf", "driver": {"lane": "a", "speed_km_h": 50}, "lanes": [{"name": "a", "points": [[0, 0, 0], [0, 0, -500]], "speed_km_h": 1}],
                               "cars": [{"node": "van", "lane": "a", "at_m": 20, "wish": 0.05}]})");
    std::string second;
    for (int i = 0; i < 120; ++i) second += R"({"step":{},"pose":[0,0,0,0]},)";
    const std::string frame = R"({"frame":true})", restart = R"({"restart":true},)";
    folder.write("d.json", R"({"vesper_drive":1,"scene":"w.json","events":[)" + frame + "," + second + frame + "," +
                               restart + second + frame + "," + restart + second + restart + frame + "]}");
    ASSERT_EQ(run("--headless --size 16x10 --shadows off --indirect off --replay d.json --log l.csv"), 0) << said;
    std::istringstream rows(read_text(folder / "l.csv"));
    std::string row;
    std::vector<int> blows;
    while (std::getline(rows, row)) blows.push_back(int(row.find("van@") != row.npos));
    EXPECT_EQ(blows, (std::vector{0, 0, 1, 1, 1}));
}

TEST_F(DriveProgram, RefusesWhatItCannotUse) {
    folder.write("bad.json", R"({"version": 1, "scene": "no.gltf", "lanes": []})");
    expect_refused("--headless", {"nothing to do"});
    expect_refused("--headless no.world.json", {"no.world.json"});
    expect_refused("--headless bad.json", {"bad.json", "lane"});
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
