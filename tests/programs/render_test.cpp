// The `vesper` program as people run it: arguments, exit codes, outputs. SPDX-License-Identifier: MIT
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "places.h"

namespace {

namespace fs = std::filesystem;

class Program : public testing::Test {
protected:
    fs::path folder = fs::temp_directory_path() /
                      ("vesper-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "-" +
                       std::to_string(::getpid()));
    void SetUp() override {
        fs::remove_all(folder);
        fs::create_directories(folder);
        std::ofstream(folder / "empty.gltf") << R"({"asset":{"version":"2.0"}})";
    }
    void TearDown() override { fs::remove_all(folder); }

    std::string text_of(const fs::path& file) const {
        std::ifstream in(file);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    /// Runs `vesper render empty.gltf <arguments>`; what it said is in `said`.
    int render(const std::string& arguments) {
        const std::string command = "cd " + folder.string() + " && " VESPER_PROGRAM " render empty.gltf --size 16x8 " +
                                    arguments + " >out.txt 2>err.txt";
        const int status = std::system(command.c_str());
        said = text_of(folder / "err.txt");
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    void expect_refused(const std::string& arguments) {
        EXPECT_EQ(render(arguments), 2) << arguments;
        EXPECT_TRUE(said.starts_with("vesper: ")) << arguments << ": " << said;
        EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << arguments << ": " << said;
    }
    std::string said;
};

TEST_F(Program, WritesBothKindsOfPictures) {
    EXPECT_EQ(render("-o a.png -o a.exr --stats-json a.json"), 0) << said;
    for (const char* file : {"a.png", "a.exr", "a.json"}) EXPECT_TRUE(fs::exists(folder / file)) << file;
    EXPECT_EQ(render("--frames 2 -o b%03d.png"), 0) << said;
    EXPECT_TRUE(fs::exists(folder / "b000.png") && fs::exists(folder / "b001.png"));
    EXPECT_EQ(render("--plan"), 0);
    EXPECT_NE(text_of(folder / "out.txt").find("gbuffer"), std::string::npos);
}

// Who forgot to convert a scene is told; who did not is not.
TEST_F(Program, SaysWhereThereIsNoPhotometry) {
    ASSERT_EQ(render("-o a.png"), 0) << said;
    EXPECT_TRUE(said.starts_with("note: empty.gltf has no photometry: read as plain glTF")) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    std::ofstream(folder / "empty.gltf") << R"({"asset":{"version":"2.0"},"extras":{"vesper":{"version":1}}})";
    ASSERT_EQ(render("-o a.png"), 0) << said;
    EXPECT_EQ(said, "");
}

TEST_F(Program, DrawsLampsThatHaveAnOpening) {
    for (const bool opening : {true, false}) {
        std::ofstream(folder / "empty.gltf")
            << R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],)"
            << R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":20}]}},)"
            << R"("cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}],)"
            << R"("nodes":[{"name":"eye","camera":0},)"
            << R"({"translation":[0,0,-10],"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
            << R"("extras":{"vesper":{"version":1,"openings":[)"
            << (opening ? R"({"light":0,"width_m":0.1,"height_m":0.1})" : "") << "]}}}";
        ASSERT_EQ(render("--plan"), 0) << said;
        EXPECT_EQ(text_of(folder / "out.txt").find("\nluminaires\n") != std::string::npos, opening);
        for (const char* tone : {"ward", "ldr"})
            EXPECT_EQ(render("-o a.png --operator " + std::string(tone)), 0) << said;
    }
}

// A street of one bright wall that comes nearer: states and curves in the log, and any frame again from it.
TEST_F(Program, LogsTheEyeAndReplaysItToTheLastBit) {
    std::ofstream(folder / "empty.gltf")
        << R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],)"
        << R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","intensity":500}]}},)"
        << R"("cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.1}}],)"
        << R"("nodes":[{"name":"eye","camera":0},{"translation":[0,0,-10],"extensions":{"KHR_lights_punctual":{"light":0}}}],)"
        << R"("extras":{"vesper":{"version":1,"openings":[{"light":0,"width_m":3,"height_m":2}]}}})";
    for (const char* op : {"irawan", "ward", "reinhard"}) {
        const std::string chosen = "--operator " + std::string(op);
        ASSERT_EQ(render(chosen + " --frames 6 --dt 0.05 --log log.csv -o a%d.png -o a%d.exr"), 0) << said;
        const std::string log = text_of(folder / "log.csv");
        EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 7);
        ASSERT_EQ(render(chosen + " --replay log.csv --start 0.17 --frames 2 --log again.csv -o b%d.png"), 0) << said;
        EXPECT_EQ(text_of(folder / "b0.png"), text_of(folder / "a4.png")) << op;
        EXPECT_EQ(text_of(folder / "b1.png"), text_of(folder / "a5.png")) << op;
        ASSERT_EQ(render(chosen + " --replay log.csv --log again.csv"), 0) << said;
        EXPECT_EQ(text_of(folder / "again.csv"), log) << op;
    }
    const std::string header = text_of(folder / "a5.exr").substr(0, 20000);
    // What was chosen is there, where it was written to is not.
    EXPECT_NE(header.find("vesper:options"), std::string::npos);
    EXPECT_NE(header.find("--frames 6 --dt 0.05"), std::string::npos);
    EXPECT_EQ(header.find("a%d.exr"), std::string::npos);
    for (const char* name : {"vesper:eye:cone_pigment", "vesper:eye:nodes", "vesper:toneCurve"})
        EXPECT_NE(header.find(name), std::string::npos) << name;
    for (const char* bad : {"", "frame\n1\n"}) {
        std::ofstream(folder / "bad.csv") << bad;
        expect_refused("--replay bad.csv -o c.png");
    }
    std::ofstream(folder / "bad.csv") << text_of(folder / "log.csv").substr(0, 5000);
    expect_refused("--replay bad.csv -o c.png");
    expect_refused("--replay none.csv -o c.png");
    expect_refused("--operator reinhard --replay log.csv --start 9 -o c.png");
    // The log is of reinhard with 100 bins.
    expect_refused("--operator ward --replay log.csv -o c.png");
    ASSERT_EQ(render("--operator irawan --frames 2 --log curve.csv"), 0) << said;
    expect_refused("--operator irawan --bins 50 --replay curve.csv -o c.png");
    expect_refused("--operator irawan --histogram-high 1e5 --replay curve.csv -o c.png");
    expect_refused("--operator reinhard --dt 0.1 --replay log.csv -o c.png");
    std::string crlf = text_of(folder / "log.csv");
    for (size_t at = 0; (at = crlf.find('\n', at)) != crlf.npos; at += 2) crlf.insert(at, 1, '\r');
    std::ofstream(folder / "crlf.csv", std::ios::binary) << crlf;
    EXPECT_EQ(render("--operator reinhard --replay crlf.csv -o c.png"), 0) << said;
}

TEST_F(Program, HasThePresetOfThePaper) {
    ASSERT_EQ(render("--preset paper --foveal-level 2 --stats -o a.png"), 0) << said;
    const std::string report = text_of(folder / "out.txt");
    EXPECT_NE(report.find("irawan"), std::string::npos) << report;
    EXPECT_NE(report.find("16x8"), std::string::npos) << "--size was given";
}

TEST_F(Program, NeverReplacesWhatItReadsOrWrites) {
    ASSERT_EQ(render("-o a.png --log log.csv"), 0) << said;
    const std::string scene = text_of(folder / "empty.gltf"), log = text_of(folder / "log.csv");
    for (const char* arguments :
         {"-o a.png --log empty.gltf", "-o a.png --stats-json ./empty.gltf", "-o a.png --replay log.csv --log log.csv",
          "-o a.png --log ./a.png", "-o a.png -o a.png", "-o a.png --log b --stats-json b"})
        expect_refused(arguments);
    EXPECT_EQ(text_of(folder / "empty.gltf"), scene);
    EXPECT_EQ(text_of(folder / "log.csv"), log);
}

// What a scene names is spared, too; and a log that does not get to its end is beside the old one, as far as it goes.
TEST_F(Program, SparesFilesOfScenesAndKeepsLogs) {
    const std::string bytes(36, '\0');
    std::ofstream(folder / "s.bin", std::ios::binary) << bytes;
    std::ofstream(folder / "s.gltf")
        << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"buffers":[{"byteLength":36,"uri":"s.bin"}],"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0,0,0]}]})";
    fs::create_symlink("s.bin", folder / "1.png");
    for (const char* arguments : {"-o a.png --log s.bin", "--stats-json s.bin", "--frames 2 -o %d.png"}) {
        const std::string command = "cd " + folder.string() + " && " VESPER_PROGRAM " render s.gltf --size 16x8 " +
                                    arguments + " >out.txt 2>err.txt";
        EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2) << arguments;
        EXPECT_NE(text_of(folder / "err.txt").find("would replace what is read"), std::string::npos)
            << arguments << text_of(folder / "err.txt");
    }
    EXPECT_EQ(text_of(folder / "s.bin"), bytes);

    EXPECT_EQ(render("--log /dev/stdout | cat"), 0) << said;
    EXPECT_TRUE(text_of(folder / "out.txt").starts_with("frame,")) << "a pipe is written to";

    std::ofstream(folder / "log.csv") << "old";
    fs::create_directory(folder / "b2.png");
    EXPECT_EQ(render("--frames 4 -o b%d.png --log log.csv"), 2) << said;
    EXPECT_EQ(text_of(folder / "log.csv"), "old");
    const std::string part = text_of(folder / "log.csv.part");
    EXPECT_EQ(std::count(part.begin(), part.end(), '\n'), 3) << "a heading and two frames";
}

TEST_F(Program, RefusesWhatCannotBeInOneLine) {
    for (const char* arguments : {"",
                                  "-o a.tiff",
                                  "-o none/a.png",
                                  "-o a.png --stats-json none/a.json",
                                  "-o a.png --operator foo",
                                  "-o a.exr --operator ldr",
                                  "-o a.png --threshold nan",
                                  "-o a.png --dt nan",
                                  "-o a.png --frames 0",
                                  "-o a.png --frames 2 -o b%99d.png",
                                  "-o a.png --operator ldr --target .1,.1,.2,.2",
                                  "-o a.png --linear-min 5 --linear-max 1",
                                  "-o a.png --display-peak 1 --display-black 5",
                                  "-o a.png --camera nope",
                                  "-o a.png --foveal-level 14",
                                  "-o a.png --gaze 0.5",
                                  "-o a.png --gaze 2,0",
                                  "-o a.png --age 0",
                                  "-o a.png --smoothing -1",
                                  "-o a.png --adapt-to sun",
                                  "-o a.png --nonsense",
                                  "-o a.png --size 0x5",
                                  "-o a.png --device nowhere"})
        expect_refused(arguments);
    EXPECT_FALSE(fs::exists(folder / "a.png"));
    EXPECT_EQ(render(""), 2);
    EXPECT_NE(said.find("nothing to do"), std::string::npos) << said;
    std::ofstream(folder / "empty.gltf") << R"({"asset":{"version":"7.0"}})";
    expect_refused("");  // the first error is said: a scene that cannot be read is not nothing to do
    EXPECT_NE(said.find("empty.gltf"), std::string::npos) << said;
    std::ofstream(folder / "empty.gltf") << R"({"asset":{"version":"2.0"}})";
    EXPECT_NE(render("-o a.png --camera nope"), 0);
    EXPECT_NE(said.find("empty.gltf"), std::string::npos) << said;
}

}  // namespace
