// `--cache` of the programs: the same bytes without a cache, with an empty one and with a full one; and what is
// said where nothing can be kept. SPDX-License-Identifier: MIT
#include <filesystem>

#include <gtest/gtest.h>

#include "io/cache_folder.h"
#include "places.h"
#include "support/program.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;

const std::string kScene = VESPER_SOURCE_DIR "/data/glare/headlamps.gltf --size 83x51 ";
constexpr const char* kNoVariables = "env -u VESPER_CACHE -u XDG_CACHE_HOME -u HOME";

size_t files_in(const fs::path& folder) {
    size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder)) files += entry.path().extension() == ".vesper-map" ? 1 : 0;
    return files;
}

class MapCacheOfRender : public ProgramTest {
protected:
    void render(const std::string& options, const std::string& environment = "") {
        ASSERT_EQ(run("render " + kScene + options, environment), 0) << said;
    }
    bool printed_has(const std::string& text) const { return printed.find(text) != printed.npos; }
    size_t notes() const { return size_t(std::count(said.begin(), said.end(), '\n')); }
};
struct MapCacheOfDrive : ProgramTest {
    MapCacheOfDrive() : ProgramTest(VESPER_DRIVE) {}
};
struct MapCacheOfBench : ProgramTest {
    MapCacheOfBench() : ProgramTest(VESPER_BENCH) {}
};

TEST_F(MapCacheOfRender, ChangesNoByte) {
    render("-o off.exr --indirect off --cache off --stats");
    EXPECT_TRUE(printed_has(" 0 taken from the cache"));
    render("-o cold.exr --indirect off --cache maps --stats");
    EXPECT_TRUE(printed_has(" 0 taken from the cache"));
    EXPECT_EQ(said, "");
    const size_t kept = files_in(folder / "maps");
    EXPECT_GT(kept, 0u);
    render("-o warm.exr --indirect off --cache maps --stats");
    EXPECT_TRUE(printed_has(" 0 were drawn anew, " + std::to_string(kept) + " taken from the cache"));
    for (const auto& entry : fs::directory_iterator(folder / "maps")) {
        if (entry.path().extension() != ".vesper-map") continue;
        fs::resize_file(entry.path(), fs::file_size(entry.path()) - 1);
        break;
    }
    render("-o damaged.exr --indirect off --cache maps --stats");
    EXPECT_TRUE(printed_has(" 1 were drawn anew, " + std::to_string(kept - 1) + " taken from the cache"));
    EXPECT_EQ(files_in(folder / "maps"), kept);
    EXPECT_EQ(said, "");
    const std::string off = read_text(folder / "off.exr");
    for (const char* name : {"cold.exr", "warm.exr", "damaged.exr"})
        EXPECT_TRUE(read_text(folder / name) == off) << name;
}

// Light between surfaces is two files, or gathered again where one of them is damaged.
TEST_F(MapCacheOfRender, KeepsLightBetweenSurfaces) {
    render("-o off.exr --shadows off --cache off");
    render("-o cold.exr --shadows off --cache light");
    ASSERT_EQ(files_in(folder / "light"), 2u);
    render("-o warm.exr --shadows off --cache light");
    for (const auto& entry : fs::directory_iterator(folder / "light"))
        if (entry.path().extension() == ".vesper-map") fs::resize_file(entry.path(), fs::file_size(entry.path()) - 1);
    render("-o damaged.exr --shadows off --cache light");
    EXPECT_EQ(files_in(folder / "light"), 2u);
    EXPECT_EQ(said, "");
    const std::string off = read_text(folder / "off.exr");
    for (const char* name : {"cold.exr", "warm.exr", "damaged.exr"})
        EXPECT_TRUE(read_text(folder / name) == off) << name;
    render("-o without.exr --shadows off --indirect off");
    EXPECT_FALSE(read_text(folder / "without.exr") == off);
}

TEST_F(MapCacheOfRender, HasADefaultFolder) {
    const std::string home = "HOME=" + (folder / "home").string(), xdg = " XDG_CACHE_HOME=" + (folder / "xdg").string();
    const std::string bare =
        std::string(kNoVariables) + " MESA_SHADER_CACHE_DIR=" + (folder / "shaders").string() + " ";
    fs::create_directory(folder / "home");
    render("-o a.png", bare + home);
    EXPECT_GT(files_in(folder / "home/.cache/vesper"), 0u);
    fs::remove_all(folder / "home");
    render("-o a.png", bare + home + xdg);
    EXPECT_GT(files_in(folder / "xdg/vesper"), 0u);
    fs::remove_all(folder / "xdg");
    render("-o a.png", bare + home + xdg + " VESPER_CACHE=named");
    EXPECT_GT(files_in(folder / "named"), 0u);
    fs::remove_all(folder / "named");
    for (const char* none : {"", " HOME=relative XDG_CACHE_HOME=relative", " VESPER_CACHE=off"}) {
        render("-o a.png", bare + none);
        EXPECT_EQ(said, "") << none;
    }
    render("-o a.png --cache off", bare + xdg);
    render("-o a.png");  // as all tests run them
    for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
        EXPECT_FALSE(entry.path().string().ends_with(".vesper-map")) << entry.path();
}

// One note, whatever the number of maps and frames, and the same picture.
TEST_F(MapCacheOfRender, SaysOnceThatNothingIsKept) {
    render("-o off.png --indirect off --frames 3");
    folder.write("file", "");
    // The second: files may not grow beyond 4 KiB, which pictures of this size do not.
    const std::pair<std::string, const char*> ways[]{{"", "file/maps: cannot be written: Not a directory"},
                                                     {"ulimit -f 8;", "maps: cannot be written: File too large"}};
    for (const auto& [limit, reason] : ways) {
        const std::string place = limit.empty() ? "file/maps" : "maps";
        render("-o a.png --indirect off --frames 3 --cache " + place, limit);
        EXPECT_TRUE(said.starts_with("note: ")) << said;
        EXPECT_NE(said.find(reason), said.npos) << said;
        EXPECT_EQ(notes(), 1u) << said;
        for (const char* number : {".0000.png", ".0002.png"})
            EXPECT_EQ(read_text(folder / (std::string("a") + number)),
                      read_text(folder / (std::string("off") + number)));
    }
    for (const auto& entry : fs::directory_iterator(folder / "maps"))
        EXPECT_EQ(entry.path().filename(), io::CacheFolder::kSecretName) << "nothing else is left";
}

TEST_F(MapCacheOfRender, RefusesWhatIsNoFolder) {
    expect_refused("render " + kScene + "-o a.png --cache ''", {"--cache", "a folder or off"});
}

TEST_F(MapCacheOfDrive, ChangesNoByteAndIsNotRecorded) {
    const std::string scene = VESPER_SOURCE_DIR "/data/glare/headlamps.gltf",
                      drive = scene + " --headless --seconds 0.2 --fps 10 --size 83x51 ";
    ASSERT_EQ(run(drive + "--video off%d.png"), 0) << said;
    ASSERT_EQ(run(drive + "--video cold%d.png --cache maps --record drive.json"), 0) << said;
    EXPECT_GT(files_in(folder / "maps"), 0u);
    EXPECT_EQ(read_text(folder / "drive.json").find("cache"), std::string::npos);
    ASSERT_EQ(run("--headless --replay drive.json --allow-outside --video warm%d.png --cache maps"), 0) << said;
    for (const char* number : {"0.png", "1.png"})
        for (const char* name : {"cold", "warm"})
            EXPECT_EQ(read_text(folder / (name + std::string(number))),
                      read_text(folder / (std::string("off") + number)))
                << name << number;
    folder.write("file", "");
    ASSERT_EQ(run(drive + "--video a%d.png --cache file"), 0) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
    EXPECT_NE(said.find("note: shadow maps and light are not kept"), said.npos) << said;
}

TEST_F(MapCacheOfBench, IsOffUnlessNamed) {
    const std::string bench =
        "--scene street --lamps 8 --triangles 100 --size 83x51 --frames 1 --laps 1 --warm-up 0 --no-start ";
    const std::string xdg = std::string(kNoVariables) + " XDG_CACHE_HOME=" + folder.path().string();
    ASSERT_EQ(run(bench, xdg), 0) << said;
    EXPECT_FALSE(exists("vesper"));
    ASSERT_EQ(run(bench + "--cache maps", xdg), 0) << said;
    EXPECT_EQ(files_in(folder / "maps"), 8u + 2u) << "eight maps; cells of casters, and their lists";
    for (const char* memory : {"63", "1025", "64.5", "all"})
        expect_refused(bench + "--shadow-memory " + memory,
                       {"--shadow-memory", std::string(memory) + ": a whole number from 64 to 1024 MiB is expected"});
}

}  // namespace
}  // namespace vesper::test
