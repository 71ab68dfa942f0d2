// Attacks by names and contents of files on the programs. SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <thread>

#include "io/image_file.h"
#include "places.h"
#include "roads/road_texts.h"
#include "scene/scene_files.h"
#include "support/program.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;

const std::string kData = VESPER_SOURCE_DIR "/data";
const std::string kHeadlamps = kData + "/glare/headlamps.gltf", kStreet = kData + "/rivoli/rivoli.xodr";
const std::string kNight = R"({"version": 1, "ambient": {"illuminance_lx": 0.1}})";
constexpr const char* kReplaced = "would replace what is read";

/// A scene of a triangle whose buffer is the file of a URI.
std::string scene_with_buffer(const std::string& uri, size_t bytes) {
    GltfFile file;
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}});
    file.bytes.clear();
    file.root["buffers"] = {{{"byteLength", bytes}, {"uri", uri}}};
    return file.root.dump();
}

class ClosedDoors : public ProgramTest {
protected:
    explicit ClosedDoors(std::string program = VESPER_PROGRAM) : ProgramTest(std::move(program)) {
        folder.write("day.json", kNight);
    }
    void expect_kept(const std::string& name, const std::string& content) {
        EXPECT_EQ(read_text(folder / name), content) << name;
    }
    size_t files() const {
        return static_cast<size_t>(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
    }
};

class ClosedDrive : public ClosedDoors {
protected:
    ClosedDrive() : ClosedDoors(VESPER_DRIVE) {}
};

TEST_F(ClosedDoors, ABufferThatAnotherFileNamesIsNotReplaced) {
    const std::string buffer(36, '\0');
    folder.write("own.glb", buffer);
    folder.write("own.gltf", scene_with_buffer("own.glb", 36));
    expect_refused("convert own.gltf -p day.json -o own.glb", {"own.glb", kReplaced});
    expect_kept("own.glb", buffer);
    ASSERT_EQ(run("convert own.gltf -p day.json -o other.glb"), 0) << said;
}

TEST_F(ClosedDoors, AProfileIsNotReplacedByStatistics) {
    const std::string profile = R"({"version": 1, "eotf": "srgb", "peak_cd_m2": 100, "black_cd_m2": 0.1})";
    folder.write("p.json", profile);
    expect_refused("render " + kHeadlamps + " --size 33x21 --display p.json --stats-json p.json",
                   {"p.json", kReplaced});
    expect_kept("p.json", profile);
}

TEST_F(ClosedDoors, LinksToInputsAreNotWrittenThrough) {
    const std::string roads = read_text(kStreet), lamp = read_text(kData + "/road/luminaire.ldt");
    folder.write("r.xodr", roads), folder.write("lamp.ldt", lamp);
    fs::create_symlink("r.xodr", folder / "l.gltf");
    fs::create_symlink("lamp.ldt", folder / "m.gltf");
    fs::create_hard_link(folder / "r.xodr", folder / "h.gltf");
    expect_refused("convert r.xodr -o l.gltf", {"l.gltf", kReplaced});
    expect_refused("convert r.xodr -o h.gltf", {"h.gltf", kReplaced});
    expect_refused("convert r.xodr --luminaire lamp.ldt -o m.gltf", {"m.gltf", kReplaced});
    folder.write("lamps.json", R"({"version": 1, "lamps": [{"nodes": "left headlamp", "type": "distribution", )"
                               R"("file": "lamp.ldt", "aim": [0, -1, 0]}]})");
    fs::copy_file(kHeadlamps, folder / "day.gltf");
    folder.write("plain.gltf", scene_with_buffer("data:application/octet-stream;base64," + std::string(48, 'A'), 36));
    expect_refused("convert plain.gltf -p lamps.json -o m.gltf");
    expect_kept("r.xodr", roads);
    expect_kept("lamp.ldt", lamp);
}

TEST_F(ClosedDoors, ScenesNameNoFilesOutsideTheirFolder) {
    folder.write("secret", std::string(36, '\0'));
    fs::create_directory(folder / "scene"), fs::create_directory(folder / "elsewhere");
    fs::create_symlink("../secret", folder / "scene/link.bin");
    fs::copy_file(folder / "secret", folder / "scene/own.bin");
    const std::string outside = "lies outside the folder";
    for (const char* uri : {"../secret", "%2e%2e/secret", "link.bin", "./../scene/../secret"}) {
        folder.write("scene/s.gltf", scene_with_buffer(uri, 36));
        expect_refused("convert scene/s.gltf -p day.json -o made.glb", {"s.gltf", "buffers/0", outside});
        EXPECT_FALSE(exists("made.glb")) << uri;
        expect_refused("inspect scene/s.gltf", {outside});
        EXPECT_EQ(run("inspect --allow-outside . scene/s.gltf"), 0) << uri << said;
        EXPECT_EQ(run("inspect scene/s.gltf --allow-outside"), 0) << uri << said;
        EXPECT_EQ(run("inspect --allow-outside all scene/s.gltf"), 0) << uri << said;
        EXPECT_EQ(run("inspect --allow-outside=all scene/s.gltf"), 0) << uri << said;
        EXPECT_EQ(run("inspect scene/s.gltf --allow-outside elsewhere --allow-outside all"), 0) << uri << said;
        expect_refused("inspect scene/s.gltf --allow-outside ./all", {"./all", "no such folder"});
        expect_refused("inspect scene/s.gltf --allow-outside elsewhere", {outside});
    }
    expect_refused("inspect scene/s.gltf --allow-outside nowhere", {"nowhere", "no such folder"});
    folder.write("scene/s.gltf", scene_with_buffer("../scene/own.bin", 36));
    EXPECT_EQ(run("inspect scene/s.gltf"), 0) << "there and back: " << said;
    // Photometry may name what lies beside it or beside the scene.
    fs::create_directory(folder / "rules");
    fs::copy_file(kData + "/road/luminaire.ldt", folder / "lamp.ldt");
    folder.write("rules/p.json",
                 R"({"version": 1, "lamps": [{"nodes": "*", "type": "distribution", "file": "../lamp.ldt"}]})");
    expect_refused("convert scene/s.gltf -p rules/p.json -o made.glb", {"p.json", "lamp.ldt", outside});
    folder.write("s.gltf", scene_with_buffer("secret", 36));
    EXPECT_EQ(run("convert s.gltf -p rules/p.json -o made.glb"), 0) << said;
}

TEST_F(ClosedDoors, TextOfFilesReachesTheTerminalPlain) {
    GltfFile file;
    for (const char* name : {"\x1b[31mred\r\nvesper: all is well",
                             "b\xc2\x9b"
                             "31m"}) {
        file.root["cameras"].push_back(
            {{"name", name}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
        file.root["nodes"].push_back({{"name", name}, {"camera", file.root["cameras"].size() - 1}});
    }
    file.root["extensionsUsed"] = {"EXT_\x1b[2J"};
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}});
    folder.write("s.gltf", file.text());
    const auto plain = [](const std::string& text) {
        return std::all_of(text.begin(), text.end(),
                           [](char c) { return c == '\n' || static_cast<unsigned char>(c) >= 32; }) &&
               text.find("\xc2\x9b") == text.npos;
    };
    for (const char* command : {"inspect s.gltf", "convert s.gltf -p day.json -o n.gltf",
                                "render s.gltf --camera none --size 9x9 -o x.png"}) {
        run(command);
        EXPECT_TRUE(plain(printed) && plain(said)) << command << ": " << printed << said;
        EXPECT_EQ(printed.find("\nvesper: all is well"), printed.npos) << command << ": " << printed;
        EXPECT_EQ(said.find("\nvesper: all is well"), said.npos) << command << ": " << said;
    }
}

TEST_F(ClosedDoors, NotesAreCounted) {
    std::string roads;
    for (int i = 0; i < 150; ++i)
        roads += road(std::to_string(i), 10,
                      geometry(0, 0, 40.0 * i, 0, 5, "<line/>") + geometry(5, 5.5, 40.0 * i, 0, 5, "<line/>"),
                      two_way_section());
    folder.write("many.xodr", opendrive(roads));
    ASSERT_EQ(run("convert many.xodr --lamp-spacing 0 -o many.glb"), 0) << said;
    EXPECT_LE(std::count(said.begin(), said.end(), '\n'), 101) << said;
    EXPECT_NE(said.find(" more like these"), said.npos) << said;
}

TEST_F(ClosedDoors, WorkAndMemoryOfAFileAreBounded) {
    const std::string little = "VESPER_LIMITS=0.01";  // 0.6 s, 20 MiB
    folder.write("spiral.xodr",
                 opendrive(road("1", 4e4, geometry(0, 0, 0, 0, 4e4, "<spiral curvStart=\"0.09\" curvEnd=\"0.1\"/>"),
                                "<laneSection s=\"0\"><center><lane id=\"0\"/></center><right>" + lane(-1, 3) +
                                    "</right></laneSection>")));
    expect_refused("convert spiral.xodr -o s.glb", {"spiral.xodr:5", "turns round more often"}, little);
    const std::string trees =
        "<objects><object id=\"1\" type=\"tree\" s=\"0\" t=\"9\" height=\"6\" radius=\"2\"><repeat s=\"0\" "
        "length=\"20000\" "
        "distance=\"1\" tStart=\"9\" tEnd=\"9\" heightStart=\"6\" heightEnd=\"6\" zOffsetStart=\"0\" "
        "zOffsetEnd=\"0\"/></object></objects>";
    std::string text = road("1", 20000, geometry(0, 0, 0, 0, 20000, "<line/>"), two_way_section());
    text.insert(text.find("</road>"), trees);
    folder.write("trees.xodr", opendrive(text));
    expect_refused("convert trees.xodr -o t.glb", {"trees.xodr", "takes more than", "VESPER_LIMITS"}, little);
    // A picture of one colour: 20 kB for 64 MiB of texels.
    const std::vector<uint8_t> white(size_t(4096) * 4096 * 4, 255);
    io::write_png(folder / "white.png", 4096, 4096, white, {}, {});
    GltfFile file;
    file.root["images"] = {{{"uri", "white.png"}}};
    file.root["textures"] = {{{"source", 0}}};
    file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    const size_t positions = file.vec3(kTriangle), uv = file.vec2({0, 0, 1, 0, 0, 1});
    file.show({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv}}}, {"material", 0}});
    folder.write("white.gltf", file.text());
    expect_refused("inspect white.gltf", {"white.gltf", "images/0", "VESPER_LIMITS"}, little);
    // It can be read with 120 MiB, but not prepared for the device.
    expect_refused("render white.gltf --size 9x9 -o x.png", {"white.gltf", "takes more than", "VESPER_LIMITS"},
                   "VESPER_LIMITS=0.06");
    EXPECT_EQ(run("inspect white.gltf"), 0) << said;
    EXPECT_FALSE(exists("s.glb") || exists("t.glb") || exists("x.png"));
}

TEST_F(ClosedDoors, EveryPictureOfManyHasItsOwnName) {
    const std::string frames = "render " + kHeadlamps + " --size 9x9 --frames 3 -o 'f.%d.png' ";
    for (const char* rest : {"--stats-json f.2.png", "--log f.2.png", "-o 'f.%01d.png'"})
        expect_refused(frames + rest, {"would be written twice"});
    // One of them is a picture of the scene: nothing is written.
    folder.write("f.0.png", "mine");
    io::write_png(folder / "f.1.png", 1, 1, std::vector<uint8_t>(4, 255), {}, {});
    GltfFile file;
    file.root["images"] = {{{"uri", "f.1.png"}}};
    file.root["textures"] = {{{"source", 0}}};
    file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    const size_t positions = file.vec3(kTriangle), uv = file.vec2({0, 0, 1, 0, 0, 1});
    file.show({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv}}}, {"material", 0}});
    folder.write("s.gltf", file.text());
    expect_refused("render s.gltf --size 9x9 --frames 2 -o 'f.%d.png'", {"f.1.png", kReplaced});
    expect_kept("f.0.png", "mine");
}

TEST_F(ClosedDoors, ReportsOfFilesEnd) {
    std::string table = "code,luminance\n";
    for (int i = 0; i < 1000; ++i) table += std::to_string(i % 256) + "," + std::to_string(0.1 + i % 256) + "\n";
    folder.write("m.csv", table);
    ASSERT_EQ(run("display fit m.csv -o d.json"), 0) << said;
    EXPECT_LT(std::count(printed.begin(), printed.end(), '\n'), 420) << printed;
    EXPECT_NE(printed.find("and 600 more lines"), printed.npos);
}

TEST_F(ClosedDoors, PatternsAndPicturesOfASeriesAreBounded) {
    const std::string little = "VESPER_LIMITS=0.01";
    GltfFile file;
    for (int i = 0; i < 100; ++i) file.root["nodes"].push_back({{"name", std::string(4000, 'a')}});
    folder.write("names.gltf", file.text());
    nlohmann::json rules = {{"version", 1}, {"lamps", nlohmann::json::array()}};
    for (int i = 0; i < 20; ++i)
        rules["lamps"].push_back({{"nodes", "*" + std::string(1990, 'a') + "b" + std::to_string(i)},
                                  {"type", "point"},
                                  {"intensity_cd", 1}});
    folder.write("rules.json", rules.dump());
    expect_refused("convert names.gltf -p rules.json -o n.glb", {"names.gltf", "takes more than", "VESPER_LIMITS"},
                   little);
    const std::vector<uint8_t> white(size_t(2048) * 2048 * 4, 255);
    for (const char* name : {"a.png", "b.png"}) io::write_png(folder / name, 2048, 2048, white, {}, {});
    expect_refused("merge a.png b.png -e 1,2 -o m.exr", {"b.png", "takes more than", "VESPER_LIMITS"}, little);
    ASSERT_EQ(mkfifo((folder / "f.exr").c_str(), 0600), 0);
    expect_refused("inspect f.exr", {"f.exr", "not a regular file"});
}

TEST_F(ClosedDoors, APipeThatNobodyReadsIsRefused) {
    ASSERT_EQ(mkfifo((folder / "pipe.png").c_str(), 0600), 0);
    expect_refused("render " + kHeadlamps + " --size 9x9 -o pipe.png", {"pipe.png", "nobody reads"});
}

TEST_F(ClosedDoors, ASizeLimitIsAnErrorOfWriting) {
    folder.write("old.glb", "old");
    ASSERT_EQ(std::system(("cd " + folder.path().string() + " && bash -c 'ulimit -f 8; " VESPER_PROGRAM " convert " +
                           kStreet + " -o old.glb' >out.txt 2>err.txt; [ $? = 2 ]")
                              .c_str()),
              0);
    EXPECT_TRUE(contains(read_text(folder / "err.txt"), "old.glb: cannot be written")) << read_text(folder / "err.txt");
    expect_kept("old.glb", "old");
    EXPECT_EQ(files(), 4u) << "old.glb, day.json, and what was printed";
}

TEST_F(ClosedDoors, FilmsFollowNoLinksAndKeepModes) {
    if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "there is no ffmpeg";
    fs::create_directory(folder / "-y");
    folder.write("film.mp4", "old");
    fs::permissions(folder / "film.mp4", fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink("film.mp4", folder / "link.mp4");
    const std::string frames = "render " + kHeadlamps + " --size 32x20 --frames 3 -o f.%02d.exr";
    ASSERT_EQ(run(frames), 0) << said;
    const size_t before = files();
    ASSERT_EQ(run("tonemap f.%02d.exr -o link.mp4"), 0) << said;
    EXPECT_TRUE(fs::is_symlink(folder / "link.mp4"));
    EXPECT_GT(fs::file_size(folder / "film.mp4"), 500u);
    EXPECT_EQ(fs::status(folder / "film.mp4").permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(files(), before) << "nothing else is left";
    for (const char* name : {"-y/a.mp4", "http:", "file:a.mp4"}) {
        if (std::string(name) == "http:") fs::create_directory(folder / "http:");
        const std::string film = name == std::string("http:") ? "./http:/a.mp4" : "./" + std::string(name);
        EXPECT_EQ(run("tonemap f.%02d.exr -o " + film), 0) << said;
        EXPECT_TRUE(exists(film)) << film;
    }
}

/// Starts a program without a shell, waits until `begun` holds, and sends a signal.
void start_and_signal(const std::vector<std::string>& words, const fs::path& folder, int signal,
                      const std::function<bool()>& begun) {
    const pid_t child = ::fork();
    if (child == 0) {
        std::vector<char*> argv;
        for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
        argv.push_back(nullptr);
        const int null = ::open("/dev/null", O_RDWR);
        ::dup2(null, 1), ::dup2(null, 2);
        if (::chdir(folder.c_str()) == 0) ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    for (int i = 0; i < 600 && !begun(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "it ended by itself";
}

TEST_F(ClosedDoors, KilledProgramsLeaveNoTemporaries) {
    if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "there is no ffmpeg";
    for (const int signal : {SIGTERM, SIGKILL}) {
        fs::remove(folder / "log.csv.part");
        start_and_signal({VESPER_PROGRAM, "render", kHeadlamps, "--size", "32x20", "--frames", "100000", "--log",
                          "log.csv", "-o", "f.png"},
                         folder.path(), signal, [&] { return exists("f.0003.png"); });
        for (const auto& entry : fs::directory_iterator(folder.path()))
            EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
        EXPECT_TRUE(exists("log.csv.part")) << "a log stays readable";
        EXPECT_FALSE(exists("log.csv"));
        fs::remove(folder / "f.0003.png");
    }
}

TEST_F(ClosedDoors, TheSecondWriterOfALogIsRefused) {
    start_and_signal(
        {VESPER_PROGRAM, "render", kHeadlamps, "--size", "32x20", "--frames", "100000", "--log", "log.csv"},
        folder.path(), SIGTERM, [&] {
            if (!exists("log.csv.part") || read_text(folder / "log.csv.part").empty()) return false;
            expect_refused("render " + kHeadlamps + " --size 9x9 --log log.csv", {"log.csv.part", "another program"});
            EXPECT_TRUE(exists("log.csv.part"));
            return true;
        });
    EXPECT_TRUE(read_text(folder / "log.csv.part").starts_with("frame,"))
        << read_text(folder / "log.csv.part").substr(0, 100);
}

TEST_F(ClosedDoors, ExtrasOfAnyKindAreKept) {
    GltfFile file;
    file.root["extras"] = "made by hand";
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}});
    folder.write("s.gltf", file.text());
    ASSERT_EQ(run("convert s.gltf -p day.json -o n.gltf"), 0) << said;
    const auto made = nlohmann::json::parse(read_text(folder / "n.gltf"));
    EXPECT_EQ(made["extras"]["extras"], "made by hand");
    EXPECT_TRUE(made["extras"]["vesper"].is_object());
}

TEST_F(ClosedDoors, RefusalsOfMergeNameFiles) {
    const std::vector<uint8_t> grey(size_t(16) * 16 * 4, 128);
    io::write_png(folder / "a.png", 16, 16, grey, {}, {}), io::write_png(folder / "b.png", 16, 16, grey, {}, {});
    for (const char* rest : {"-e 1,1 -o m.exr", "-e 1,2 --curve srgb --luminance 99,99,1 -o m.exr", "-o m.exr"})
        expect_refused("merge a.png b.png " + std::string(rest), {"a.png"});
}

// A file that a world names and that is not there is told with the world.
TEST_F(ClosedDrive, AMissingFileIsNamedWithTheOneThatNamesIt) {
    fs::copy_file(kData + "/rivoli/rivoli.world.json", folder / "w.json");
    expect_refused("w.json --headless --seconds 0.1", {"w.json: ", "rivoli-drive.photometry.json: cannot be opened"});
}

TEST_F(ClosedDrive, RampsAloneAreDrivenOn) {
    folder.write("ramps.xodr", opendrive(road("1", 200, geometry(0, 0, 0, 0, 200, "<line/>"),
                                              "<laneSection s=\"0\"><center><lane id=\"0\"/></center><right>" +
                                                  lane(-1, 3.5, "onRamp") + "</right></laneSection>")));
    EXPECT_EQ(run("ramps.xodr --headless --seconds 0.1 --record d.json"), 0) << said;
}

TEST_F(ClosedDrive, ARecordingIsWrittenByOneProgram) {
    folder.write("d.json", "old");
    fs::create_symlink("d.json", folder / "d.link");
    expect_refused("--headless --replay d.json --record d.link");
    expect_kept("d.json", "old");
}

}  // namespace
}  // namespace vesper::test
