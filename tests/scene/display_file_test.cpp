// Display profiles: out and in again, and refused where they are wrong. SPDX-License-Identifier: MIT
#include "scene/display_file.h"

#include <chrono>
#include <filesystem>

#include "scene/scene_files.h"
#include "support/complaints.h"

namespace vesper::test {
namespace {

void expect_same(const vision::Display& a, const vision::Display& b) {
    EXPECT_EQ(a.peak, b.peak);
    EXPECT_EQ(a.black, b.black);
    EXPECT_EQ(a.ambient, b.ambient);
    EXPECT_EQ(a.reflection, b.reflection);
    EXPECT_EQ(a.eotf, b.eotf);
    EXPECT_EQ(a.bits, b.bits);
    EXPECT_EQ(a.primaries, b.primaries);
    if (a.eotf == vision::Eotf::Gamma) {
        EXPECT_EQ(a.gamma, b.gamma);
    }
    ASSERT_EQ(a.table.size(), b.table.size());
    for (size_t i = 0; i < a.table.size(); ++i) {
        EXPECT_NEAR(a.table[i].code, b.table[i].code, 1e-12);
        EXPECT_EQ(a.table[i].luminance, b.table[i].luminance);
    }
}

TEST(DisplayFile, ComesBackAsItWas) {
    const TempFolder folder;
    std::vector<vision::Display> displays;
    for (const vision::NamedDisplay& known : vision::known_displays()) {
        displays.push_back(known.display);
        expect_same(scene::find_display(known.name), known.display);
    }
    displays.push_back({.peak = 90,
                        .black = 0.3f,
                        .ambient = 3.7f,
                        .eotf = vision::Eotf::Table,
                        .bits = 10,
                        .primaries = {{0.66, 0.32}, {0.28, 0.65}, {0.15, 0.05}, {0.30, 0.32}},
                        .table = {{0, double(0.3f)}, {7 / 1023.0, 0.31}, {320 / 1023.0, 8}, {1, 90}}});
    for (const vision::Display& display : displays) {
        const auto file = folder.write("d.json", scene::display_json(display, "a name"));
        expect_same(scene::read_display(file), display);
        expect_same(scene::find_display(file.string()), display);
    }
}

// Edited, replaced by a file of the same size, gone; and as it was known where neither time nor size tells of a change.
TEST(DisplayFile, IsReadAgainWhenItHasChanged) {
    const TempFolder folder;
    const auto write = [&](float peak) {
        return folder.write("d.json", scene::display_json({.peak = peak}, "")).string();
    };
    const std::string file = write(90);
    const auto first = std::filesystem::last_write_time(file);
    scene::DisplayFinder displays;
    EXPECT_EQ(displays.find(file).peak, 90);
    write(50);
    std::filesystem::last_write_time(file, first);
    EXPECT_EQ(displays.find(file).peak, 90);
    std::filesystem::last_write_time(file, first + std::chrono::seconds(1));
    EXPECT_EQ(displays.find(file).peak, 50);
    write(120);
    std::filesystem::last_write_time(file, first + std::chrono::seconds(1));
    EXPECT_EQ(displays.find(file).peak, 120) << "another size";
    expect_same(displays.find("projector"), scene::find_display("projector"));
    EXPECT_EQ(displays.find(file).peak, 120);
    std::filesystem::remove(file);
    EXPECT_THROW(displays.find(file), Error);
    EXPECT_THROW(displays.find(file), Error);
    write(70);
    EXPECT_EQ(displays.find(file).peak, 70);
}

TEST(DisplayFile, IsRefusedWhereItIsWrong) {
    const TempFolder folder;
    const std::string good = R"({"version":1,"eotf":"gamma","gamma":2.2,"peak_cd_m2":100,"black_cd_m2":0.1})";
    EXPECT_NO_THROW(scene::read_display(folder.write("d.json", good)));
    const std::pair<const char*, const char*> cases[]{
        {R"({"eotf":"gamma"})", "version"},
        {R"({"version":2,"eotf":"gamma"})", "/version"},
        {R"({"version":1,"eotf":"log"})", "/eotf"},
        {R"({"version":1,"eotf":"gamma","gamma":9,"peak_cd_m2":100,"black_cd_m2":0.1})", "/gamma"},
        {R"({"version":1,"eotf":"srgb","gamma":2.2,"peak_cd_m2":100,"black_cd_m2":0.1})", "/gamma"},
        {R"({"version":1,"eotf":"srgb","black_cd_m2":0.1})", "peak_cd_m2"},
        {R"({"version":1,"eotf":"srgb","peak_cd_m2":1,"black_cd_m2":2})", "peak"},
        {R"({"version":1,"eotf":"srgb","peak_cd_m2":"1","black_cd_m2":2})", "/peak_cd_m2"},
        {R"({"version":1,"eotf":"srgb","peak_cd_m2":100,"black_cd_m2":0.1,"bits":9})", "/bits"},
        {R"({"version":1,"eotf":"srgb","peak_cd_m2":100,"black_cd_m2":0.1,"primaries":"adobe"})", "/primaries"},
        {R"({"version":1,"eotf":"srgb","peak_cd_m2":100,"black_cd_m2":0.1,"primaries":{"red":[1,0.3],"green":[1,0.3],"blue":[1,0.3],"white":[0.3,0.3]}})",
         "/primaries"},
        {R"({"version":1,"eotf":"srgb","peak_cd_m2":100,"black_cd_m2":0.1,"colour":1})", "colour"},
        {R"({"version":1,"eotf":"pq","peak_cd_m2":20000,"black_cd_m2":0.1})", "PQ"},
        {R"({"version":1,"eotf":"table","peak_cd_m2":100,"table":[[0,0.1],[255,100]]})", "/peak_cd_m2"},
        {R"({"version":1,"eotf":"table","table":[[0,0.1]]})", "/table"},
        {R"({"version":1,"eotf":"table","table":[[1,0.1],[255,100]]})", "/table/0/0"},
        {R"({"version":1,"eotf":"table","table":[[0,0.1],[128,0.1],[255,100]]})", "/table/1/1"},
        {R"({"version":1,"eotf":"table","table":[[0,0.1],[128,5],[128,6],[255,100]]})", "/table/2/0"},
        {R"({"version":1,"eotf":"table","table":[[0,0.1],[254,100]]})", "/table/1"},
        {R"({"version":1,"eotf":"table","table":[[0,0.1],[256,100]]})", "/table/1/0"},
        {R"({"version":1,"eotf":"table","table":[[0,0.1],[127.5,5],[255,100]]})", "/table/1/0"},
        {R"({"version":1,"eotf":"srgb","peak_cd_m2":100,"black_cd_m2":0.1,"primaries":{"red":[0.64,0.33],"green":[0.3,0.6],"blue":[0.15,0.06],"white":[0.6,0.37]}})",
         "/primaries/white"},
        {R"({"version":1,"eotf":"srgb","peak_cd_m2":100,"black_cd_m2":0.1,"primaries":{"red":[0.64,0.33],"green":[0.3,0.6],"blue":[0.15,0.06],"white":[0.1,0.05]}})",
         "/primaries/white"},
        {R"({"version":1,"eotf":)", "d.json"},
        {R"([1])", "d.json"}};
    for (const auto& [text, place] : cases) {
        const auto file = folder.write("d.json", text);
        const std::string complaint = complaint_of([&] { scene::read_display(file); });
        EXPECT_TRUE(contains(complaint, "d.json")) << text;
        EXPECT_TRUE(contains(complaint, place)) << text;
    }
    EXPECT_THROW(scene::find_display("unheard-of"), Error);
    EXPECT_THROW(scene::find_display((folder / "none.json").string()), Error);
}

}  // namespace
}  // namespace vesper::test
