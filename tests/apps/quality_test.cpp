// Named sets of what frames may leave out, and options beside them. SPDX-License-Identifier: MIT
#include "render/quality.h"

#include <algorithm>

#include "base/error.h"
#include "io/hdr_image.h"
#include "settings.h"
#include "support/program.h"

namespace vesper::test::quality_test {
namespace {

using render::Quality, render::QualityInfo, render::RenderSettings;

RenderSettings settings_of(Quality quality) {
    RenderSettings settings;
    render::set_quality(settings, quality);
    return settings;
}

void expect_equal(const RenderSettings& a, const RenderSettings& b) {
    EXPECT_EQ(a.clusters.threshold, b.clusters.threshold);
    EXPECT_EQ(a.merge_error, b.merge_error);
    EXPECT_EQ(a.shadow_error, b.shadow_error);
    EXPECT_EQ(a.reflections_left_out, b.reflections_left_out);
    EXPECT_EQ(a.shadow_budget, b.shadow_budget);
}

TEST(Quality, StandardIsTheDefault) { expect_equal(settings_of(Quality::Standard), {}); }

TEST(Quality, ExactLeavesNothingOut) {
    const RenderSettings exact = settings_of(Quality::Exact);
    EXPECT_LE(exact.clusters.threshold, 1e-9f);
    EXPECT_EQ(exact.merge_error, render::kMergesNothing);
    EXPECT_EQ(exact.shadow_error, 0);
    EXPECT_EQ(exact.reflections_left_out, 0);
    EXPECT_EQ(exact.shadow_budget, render::kNoShadowBudget);
}

TEST(Quality, SetsAreInTheOrderOfTheirBounds) {
    const auto sets = render::qualities();
    for (size_t i = 0; i < sets.size(); ++i) EXPECT_EQ(size_t(sets[i].quality), i);
    for (const auto& [less, more] :
         {std::pair(Quality::Exact, Quality::Standard), {Quality::Standard, Quality::Draft}}) {
        const QualityInfo &a = sets[size_t(less)], &b = sets[size_t(more)];
        EXPECT_LT(a.threshold, b.threshold);
        EXPECT_LT(a.merge_error, b.merge_error);
        EXPECT_LT(a.shadow_error, b.shadow_error);
        EXPECT_LT(a.reflections_left_out, b.reflections_left_out);
    }
}

TEST(Quality, OfADriveIsASettingLikeOthers) {
    drive::DriveSettings drive({{"quality", "draft"}, {"threshold", "0.0005"}});
    RenderSettings want = settings_of(Quality::Draft);
    want.clusters.threshold = 0.0005f;
    expect_equal(drive.render(), want);
    EXPECT_EQ(drive.quality().quality, "draft");
    drive.set("quality", "exact"), drive.set("threshold", "");
    expect_equal(drive.render(), settings_of(Quality::Exact));
    EXPECT_THROW(drive.set("quality", "best"), Error);
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
    const io::HdrImage draft = picture("--quality draft");
    for (const char* options : {"--quality draft --threshold 0.25", "--threshold 0.25 --quality draft"}) {
        const io::HdrImage picked = picture(options);
        EXPECT_EQ(value(picked, "vesper:illuminanceThreshold"), "0.25") << options;
        EXPECT_EQ(value(picked, "vesper:quality"), "draft") << options;
        EXPECT_GT(dark_pixels(picked).size(), dark_pixels(draft).size()) << options;
    }
}

TEST_F(QualityProgram, DisplayImagesSayIt) {
    ASSERT_EQ(run("render a.gltf --camera eye --size 8x8 --indirect off --quality draft -o a.png"), 0) << said;
    const std::string png = read_text(folder / "a.png");
    const size_t at = png.find("vesper:quality");
    ASSERT_NE(at, png.npos);
    EXPECT_EQ(png.substr(at + std::string("vesper:quality").size() + 1, 5), "draft");
}

// The name says what was chosen, and numbers what held.
TEST_F(QualityProgram, BoundsAreRecordedBesideTheName) {
    const std::string options = "--quality standard --merge-error 1 --shadow-error 0.5 --threshold 10 ";
    const io::HdrImage image = picture(options + "-o a.png --stats-json a.json");
    const std::string png = read_text(folder / "a.png"), json = read_text(folder / "a.json");
    for (const auto& [key, text] : {std::pair("quality", "standard"),
                                    {"illuminanceThreshold", "10"},
                                    {"mergeError", "1"},
                                    {"shadowError", "0.5"},
                                    {"reflectionsLeftOut", "0.002"}}) {
        EXPECT_EQ(value(image, std::string("vesper:") + key), text);
        EXPECT_NE(png.find(std::string("vesper:") + key + '\0' + text), png.npos) << key;
    }
    EXPECT_TRUE(
        json.starts_with(R"({"quality": "standard", "threshold_lx": 10, "merge_error": 1, "shadow_error": 0.5, )"
                         R"("reflections_left_out": 0.002, )"))
        << json;
    EXPECT_EQ(value(picture("--quality exact"), "vesper:mergeError"), "0");
    EXPECT_EQ(value(picture(""), "vesper:illuminanceThreshold"), "0.001");
}

TEST_F(QualityProgram, RefusesOthers) {
    expect_refused("render a.gltf -o a.png --quality best", {"--quality", "standard"});
    expect_refused("render a.gltf -o a.png --merge-error -1", {"--merge-error"});
    expect_refused("render a.gltf -o a.png --shadow-error nan", {"--shadow-error"});
}

}  // namespace
}  // namespace vesper::test::quality_test
