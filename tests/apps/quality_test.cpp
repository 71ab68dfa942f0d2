// Named sets of what frames may leave out, and options beside them. SPDX-License-Identifier: MIT
#include "render/settings.h"

#include <algorithm>

#include "base/error.h"
#include "io/hdr_image.h"
#include "places.h"
#include "scene/scene_files.h"
#include "session/settings.h"
#include "support/program.h"

namespace vesper::test::quality_test {
namespace {

using render::Quality, render::RenderSettings, render::settings_of;

void expect_equal(const RenderSettings& a, const RenderSettings& b) {
    for (const render::LightSetting& row : render::light_rows()) EXPECT_EQ(row.get(a), row.get(b)) << row.name;
}

TEST(Quality, StandardIsTheDefault) { expect_equal(settings_of(Quality::Standard), {}); }

TEST(Quality, ExactLeavesNothingOut) {
    const RenderSettings exact = settings_of(Quality::Exact);
    EXPECT_LE(exact.threshold, 1e-9f);
    EXPECT_EQ(exact.merge_error, 0);
    EXPECT_EQ(exact.shadow_error, 0);
    EXPECT_EQ(exact.reflection_error, 0);
}

TEST(Quality, SetsAreInTheOrderOfTheirBounds) {
    for (const auto& [less, more] :
         {std::pair(Quality::Exact, Quality::Standard), {Quality::Standard, Quality::Interactive}}) {
        const RenderSettings a = settings_of(less), b = settings_of(more);
        EXPECT_LT(a.threshold, b.threshold);
        EXPECT_LT(a.merge_error, b.merge_error);
        EXPECT_LT(a.shadow_error, b.shadow_error);
        EXPECT_LT(a.reflection_error, b.reflection_error);
    }
    // The fast set differs by its pixels; nothing else is closer.
    const RenderSettings fast = settings_of(Quality::Fast), interactive = settings_of(Quality::Interactive);
    EXPECT_LT(fast.scale, interactive.scale);
    EXPECT_GE(fast.threshold, interactive.threshold);
    EXPECT_GE(fast.merge_error, interactive.merge_error);
    EXPECT_GE(fast.shadow_error, interactive.shadow_error);
    EXPECT_GE(fast.reflection_error, interactive.reflection_error);
}

std::string table() {
    std::string text =
        "| setting | value | `fast` | `interactive` | `standard` | `exact` | meaning |\n"
        "| --- | --- | ---: | ---: | ---: | ---: | --- |\n";
    for (const render::LightSetting& row : render::light_rows()) {
        text += "| `--" + row.option() + "` | " + row.range() + " | ";
        for (const double value : row.values) text += row.text(value) + " | ";
        text += std::string(row.help) + " |\n";
    }
    return text;
}

TEST(Quality, TheDocumentListsAllSettings) {
    const std::string text = read_text(VESPER_SOURCE_DIR "/docs/quality.md");
    const size_t from = text.find("<!-- settings"), until = text.find("<!-- /settings -->");
    ASSERT_TRUE(from != text.npos && until != text.npos && from < until);
    const size_t begin = text.find('\n', from) + 1;
    EXPECT_EQ(text.substr(begin, until - begin), table());
}

TEST(Quality, SettingsAreTextsThatReadBack) {
    for (const render::LightSetting& row : render::light_rows())
        for (const double value : row.values) {
            EXPECT_EQ(row.parse(row.text(value)), value) << row.name;
            RenderSettings settings;
            row.set(settings, value);
            EXPECT_EQ(row.get(settings), value) << row.name;
        }
    EXPECT_THROW(render::light_row("no-shadows"), Error);
    EXPECT_EQ(render::light_row("shadow-error").parse("0.01"), double(0.01f));
    for (const char* wrong : {"", "0.5x", "nan", "inf", "-0.1", "1.1", "on", " 1"})
        EXPECT_THROW(render::light_row("shadow_error").parse(wrong), Error) << wrong;
    for (const char* wrong : {"1.5", "1e3", "0", "65537", "all", "-1"})
        EXPECT_THROW(render::light_row("samples").parse(wrong), Error) << wrong;
}

TEST(Quality, OfADriveIsASettingLikeOthers) {
    drive::DriveSettings drive({{"quality", "fast"}, {"threshold", "0.0005"}});
    RenderSettings want = settings_of(Quality::Fast);
    want.threshold = 0.0005f;
    expect_equal(drive.render(), want);
    EXPECT_EQ(drive.quality(), "fast");
    drive.set("quality", "exact"), drive.set("threshold", "");
    expect_equal(drive.render(), settings_of(Quality::Exact));
    EXPECT_THROW(drive.set("quality", "best"), Error);
}

// Of a window, where none is chosen; what is chosen wins, and an empty text goes back.
TEST(Quality, OfADriveThatNamesNoneIsThatOfItsProgram) {
    drive::DriveSettings drive({{"threshold", "0.0005"}}, Quality::Interactive);
    EXPECT_EQ(drive.quality(), "interactive");
    EXPECT_EQ(drive.render().merge_error, settings_of(Quality::Interactive).merge_error);
    drive.set("quality", "standard");
    EXPECT_EQ(drive.quality(), "standard");
    drive.set("quality", "");
    EXPECT_EQ(drive.quality(), "interactive");
    EXPECT_FALSE(drive.values().contains("quality")) << "so that films of a recording have the standard";
    EXPECT_EQ(drive::DriveSettings().quality(), "standard");
}

TEST(Quality, TheSetOfOldIsNamed) {
    try {
        const drive::DriveSettings old(drive::DriveSettings::Values{{"quality", "draft"}});
        FAIL();
    } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("quality draft any more, it is fast now"), what.npos) << what;
    }
}

/// A lamp of 100 cd over a plane 20 m wide, which it gives from 25 to 0.08 lx.
std::string lit_plane() {
    GltfFile file;
    file.show({{"attributes", {{"POSITION", file.vec3({-10, 0, 10, 10, 0, 10, 10, 0, -10, -10, 0, -10})}}},
               {"indices", file.indices(std::vector<uint16_t>{0, 1, 2, 0, 2, 3})}},
              {{"name", "plane"}});
    file.root["nodes"].push_back(
        {{"name", "lamp"}, {"translation", {0, 2, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.root["nodes"].push_back(
        {{"name", "eye"}, {"camera", 0}, {"translation", {0, 20, 0}}, {"rotation", {-0.70710678, 0, 0, 0.70710678}}});
    file.root["cameras"] = {
        {{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.1}}}}};
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 100}}};
    return file.text();
}

std::string standard_of(const char* name) {
    const render::LightSetting& row = render::light_row(name);
    return row.text(row.value(Quality::Standard));
}

class QualityProgram : public ProgramTest {
protected:
    void SetUp() override { folder.write("a.gltf", lit_plane()); }
    io::HdrImage picture(const std::string& options) {
        EXPECT_EQ(run("render a.gltf --camera eye --size 64x64 --indirect off -o a.exr " + options), 0) << said;
        return io::read_exr(folder / "a.exr");
    }
    static std::string value(const io::HdrImage& image, const std::string& key) {
        const auto found = std::ranges::find(image.header, key, [](const auto& entry) { return entry.first; });
        return found == image.header.end() ? "none" : found->second;
    }
    static std::vector<float> dark_pixels(const io::HdrImage& image) {
        std::vector<float> dark;
        for (const float v : image.rgb)
            if (v == 0) dark.push_back(v);
        return dark;
    }
};

TEST_F(QualityProgram, PicturesOfTheStandardAreThoseOfNone) {
    const io::HdrImage without = picture(""), standard = picture("--quality standard"),
                       exact = picture("--quality exact");
    EXPECT_EQ(without.rgb, standard.rgb);
    EXPECT_NE(without.rgb, exact.rgb) << "light is merged";
    EXPECT_EQ(value(without, "vesper:quality"), "standard");
    EXPECT_EQ(value(exact, "vesper:quality"), "exact");
    EXPECT_EQ(picture("--threshold 1e-9 --merge-error 0 --shadow-error 0").rgb, exact.rgb);
}

TEST_F(QualityProgram, OptionsBesideItWinInAnyOrder) {
    const io::HdrImage fast = picture("--quality fast");
    for (const char* options : {"--quality fast --threshold 0.25", "--threshold 0.25 --quality fast"}) {
        const io::HdrImage picked = picture(options);
        EXPECT_EQ(value(picked, "vesper:threshold"), "0.25") << options;
        EXPECT_EQ(value(picked, "vesper:quality"), "fast") << options;
        EXPECT_GT(dark_pixels(picked).size(), dark_pixels(fast).size()) << options;
    }
}

TEST_F(QualityProgram, DisplayImagesSayIt) {
    ASSERT_EQ(run("render a.gltf --camera eye --size 8x8 --indirect off --quality fast -o a.png"), 0) << said;
    const std::string png = read_text(folder / "a.png");
    const size_t at = png.find("vesper:quality");
    ASSERT_NE(at, png.npos);
    EXPECT_EQ(png.substr(at + std::string("vesper:quality").size() + 1, 4), "fast");
}

// The name says what was chosen, and numbers what held.
TEST_F(QualityProgram, BoundsAreRecordedBesideTheName) {
    const std::string options = "--quality standard --merge-error 1 --shadow-error 0.5 --threshold 10 ";
    const io::HdrImage image = picture(options + "-o a.png --stats-json a.json");
    const std::string png = read_text(folder / "a.png"), json = read_text(folder / "a.json");
    for (const auto& [key, text] : {std::pair<const char*, std::string>("quality", "standard"),
                                    {"threshold", "10"},
                                    {"mergeError", "1"},
                                    {"shadowError", "0.5"},
                                    {"reflectionError", standard_of("reflection-error")}}) {
        EXPECT_EQ(value(image, std::string("vesper:") + key), text);
        EXPECT_NE(png.find(std::string("vesper:") + key + '\0' + text), png.npos) << key;
    }
    const auto members = nlohmann::json::parse(json);
    EXPECT_EQ(members["quality"], "standard");
    EXPECT_EQ(members["threshold"], 10);
    EXPECT_EQ(members["merge_error"], 1);
    EXPECT_EQ(members["shadow_error"], 0.5);
    EXPECT_EQ(members["reflection_error"], render::light_row("reflection-error").value(Quality::Standard));
    EXPECT_EQ(members["shadows"], true);
    EXPECT_EQ(value(picture("--quality exact"), "vesper:mergeError"), "0");
    EXPECT_EQ(value(picture(""), "vesper:threshold"), standard_of("threshold"));
}

// Before the passes, so that a reader sees which settings led to them.
TEST_F(QualityProgram, ThePlanBeginsWithAllSettings) {
    ASSERT_EQ(run("render a.gltf --camera eye --size 8x8 --indirect off --quality fast --plan"), 0) << said;
    EXPECT_TRUE(printed.starts_with("settings of light, quality fast\n")) << printed;
    for (const render::LightSetting& row : render::light_rows())
        EXPECT_NE(printed.find("\n  " + row.option() + " "), std::string::npos) << row.name;
    const render::LightSetting& row = render::light_row("threshold");
    EXPECT_NE(printed.find(" " + row.text(row.value(Quality::Fast)) + " lx\n"), std::string::npos) << printed;
}

// A switch without a value is on.
TEST_F(QualityProgram, SwitchesTakeOnOffOrNothing) {
    const std::vector<float> lit = picture("").rgb;
    EXPECT_NE(picture("--paper-lambert").rgb, lit);
    EXPECT_EQ(picture("--paper-lambert").rgb, picture("--paper-lambert on").rgb);
    EXPECT_EQ(picture("--paper-lambert off").rgb, lit);
    EXPECT_EQ(picture("--paper-lambert=off").rgb, lit);
    EXPECT_EQ(run("render --paper-lambert a.gltf --camera eye --size 64x64 --indirect off -o b.exr"), 0) << said;
    expect_refused("render a.gltf -o a.png --paper-lambert maybe", {"not expected", "maybe"});
    expect_refused("render a.gltf -o a.png --paper-lambert=maybe", {"--paper-lambert", "maybe"});
}

TEST_F(QualityProgram, RefusesOthers) {
    expect_refused("render a.gltf -o a.png --quality best", {"--quality", "fast", "interactive", "standard", "exact"});
    expect_refused("render a.gltf -o a.png --threshold 5e3", {"--threshold", "5e3: a number from 1e-09 to 1000 lx"});
    expect_refused("render a.gltf -o a.png --merge-error -1", {"--merge-error", "-1: a number from 0 to 1 is"});
    expect_refused("render a.gltf -o a.png --shadow-error nan", {"--shadow-error"});
}

}  // namespace
}  // namespace vesper::test::quality_test
