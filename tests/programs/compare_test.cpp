// `vesper compare` on pictures whose difference is known. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/hdr_image.h"
#include "io/image_file.h"
#include "support/gratings.h"
#include "support/program.h"
#include "vision/visibility.h"

namespace vesper::test {
namespace {

class CompareTest : public ProgramTest {
protected:
    static constexpr uint32_t kWidth = 96, kHeight = 64;

    /// A uniform picture of 1 cd/m^2 with a soft spot in its middle, as many times brighter.
    void write(const std::string& name, double contrast, bool with_angle = true, bool with_unit = true) const {
        io::HdrImage image{.width = kWidth, .height = kHeight, .rgb = {}};
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                const double r2 = std::pow(x - kWidth / 2.0, 2) + std::pow(y - kHeight / 2.0, 2);
                image.rgb.insert(image.rgb.end(), 3, float(1 + contrast * std::exp(-r2 / 32)));
            }
        if (with_unit) image.white_luminance = 1;
        const double half = std::tan(1.0 * std::numbers::pi / 180);  // 2 degrees high: 32 px/degree
        const std::string t = std::to_string(half), w = std::to_string(1.5 * half);
        if (with_angle) image.header = {{"vesper:tangents", "-" + w + " -" + t + " " + w + " " + t}};
        io::write_exr(folder / name, image);
    }
    nlohmann::json figures() const { return nlohmann::json::parse(read_text(folder / "c.json")); }
};

// A spot of about 10 minutes of arc. At 1 cd/m^2 a patch of that area is seen half of the time from a contrast of 0.1
// on (Barten 1999).
TEST_F(CompareTest, TellsWhatIsSeenFromWhatIsNot) {
    write("plain.exr", 0), write("faint.exr", 0.02), write("spot.exr", 0.2);
    ASSERT_EQ(run("compare plain.exr faint.exr --json c.json"), 0) << said;
    EXPECT_LT(figures()["largest_probability"], 0.05);
    EXPECT_GT(figures()["largest_probability"], 0);
    ASSERT_EQ(run("compare plain.exr spot.exr --json c.json -o map.png"), 0) << said;
    const nlohmann::json seen = figures();
    EXPECT_GT(seen["largest_probability"], 0.95);
    EXPECT_NEAR(seen["x"], kWidth / 2, 2);
    EXPECT_NEAR(seen["y"], kHeight / 2, 2);
    EXPECT_NEAR(seen["pixels_per_degree"], 32, 0.01);
    EXPECT_GT(seen["log10_rmse"], 0);
    EXPECT_TRUE(exists("map.png"));
    EXPECT_NE(printed.find("largest probability"), std::string::npos);
    ASSERT_EQ(run("compare spot.exr spot.exr --json c.json"), 0) << said;
    EXPECT_EQ(figures()["largest_probability"], 0);
    EXPECT_TRUE(figures()["pu21_psnr_db"].is_null()) << "infinite";
    EXPECT_TRUE(figures()["x"].is_null());
}

TEST_F(CompareTest, WritesProbabilitiesByPixel) {
    write("plain.exr", 0), write("spot.exr", 0.07);
    ASSERT_EQ(run("compare plain.exr spot.exr --json c.json -o map.exr"), 0) << said;
    const io::HdrImage map = io::read_exr(folder / "map.exr");
    ASSERT_EQ(map.rgb.size(), size_t{3} * kWidth * kHeight);
    const double largest = figures()["largest_probability"], half = figures()["share_above_0.5"];
    EXPECT_GT(largest, 0.05);
    EXPECT_LT(largest, 0.999);
    EXPECT_EQ(*std::max_element(map.rgb.begin(), map.rgb.end()), float(largest));
    const auto above = std::count_if(map.rgb.begin(), map.rgb.end(), [](float p) { return p > 0.5f; });
    EXPECT_DOUBLE_EQ(double(above) / (3.0 * kWidth * kHeight), half);
    const size_t middle = 3 * (size_t{kHeight / 2} * kWidth + kWidth / 2);
    EXPECT_GT(map.rgb[middle], 0.5 * largest);
    EXPECT_LT(map.rgb[0], 0.5 * largest) << "a corner";
    EXPECT_EQ(map.white_luminance, 0) << "not luminance";
}

TEST_F(CompareTest, FailsForIntegration) {
    write("plain.exr", 0), write("spot.exr", 0.2);
    EXPECT_EQ(run("compare plain.exr spot.exr --fail-above 0.5"), 1);
    EXPECT_TRUE(said.empty()) << said;
    EXPECT_EQ(run("compare plain.exr plain.exr --fail-above 0.5"), 0);
}

// Codes of a display: half of the largest is 0.2176 of white's light of a gamma of 2.2.
TEST_F(CompareTest, ReadsCodesOfADisplay) {
    const std::vector<uint8_t> grey(size_t{32} * 32 * 4, 128);
    io::write_png(folder / "grey.png", 32, 32, grey);
    ASSERT_EQ(run("compare grey.png grey.png --fov 1 --display-peak 500"), 0) << said;
    EXPECT_NE(printed.find("to 500"), std::string::npos) << printed;
    io::HdrImage same{.width = 32, .height = 32, .rgb = std::vector<float>(32 * 32 * 3), .white_luminance = 1};
    const double black = 0.1 + 0.01 * 5 / std::numbers::pi;  // of the default display
    for (float& value : same.rgb) value = float(black + 99.9 * std::pow(128 / 255.0, 2.2));
    io::write_exr(folder / "same.exr", same);
    ASSERT_EQ(run("compare grey.png same.exr --fov 1 --json c.json --display-peak 100"), 0) << said;
    EXPECT_LT(figures()["log10_rmse"], 1e-5);
}

TEST_F(CompareTest, RefusesPicturesWithoutAMeaning) {
    write("a.exr", 0), write("blind.exr", 0, false), write("relative.exr", 0, true, false);
    io::write_exr(folder / "large.exr",
                  {.width = 8193, .height = 2048, .rgb = std::vector<float>(8193 * 2048 * 3), .white_luminance = 1});
    io::write_png(folder / "small.png", 2, 2, std::vector<uint8_t>(16, 9));
    expect_refused("compare blind.exr blind.exr", {"--fov"});
    expect_refused("compare a.exr relative.exr", {"relative.exr", "--unit"});
    expect_refused("compare a.exr small.png", {"2 x 2"});
    expect_refused("compare a.exr missing.exr", {"missing.exr"});
    expect_refused("compare large.exr large.exr", {"large.exr", "pixels"});
    expect_refused("compare a.exr a.exr -o map.jpg", {"map.jpg"});
    EXPECT_EQ(run("compare blind.exr a.exr"), 0) << "one of them says it: " << said;
    EXPECT_EQ(run("compare a.exr relative.exr --unit 2"), 0) << said;
}

// --unit is for pictures whose header names no unit.
TEST_F(CompareTest, ScalesOnlyWhatHasNoUnit) {
    write("a.exr", 0), write("relative.exr", 0, true, false);
    io::HdrImage half = io::read_exr(folder / "relative.exr");
    half.header = {};
    for (float& value : half.rgb) value /= 2;
    io::write_exr(folder / "half.exr", half);
    ASSERT_EQ(run("compare a.exr half.exr --unit 2 --json c.json"), 0) << said;
    EXPECT_EQ(figures()["largest_probability"], 0);
    EXPECT_NE(said.find("a.exr: its header names a unit"), std::string::npos) << said;
}

// The axis of the eye is not in the middle: pixels are as large as the header says, and so is the place in degrees.
TEST_F(CompareTest, TakesTheEdgesOfHeaders) {
    const auto write_spot = [&](const char* name, float factor, const char* tangents) {
        io::HdrImage image{.width = 64, .height = 64, .rgb = std::vector<float>(3 * 64 * 64, 1), .white_luminance = 1};
        for (int c = 0; c < 3; ++c) image.rgb[size_t(3 * (10 * 64 + 40) + c)] = factor;
        image.header = {{"vesper:tangents", tangents}};
        io::write_exr(folder / name, image);
    };
    const double edge = 0.64;  // pixels of 0.01 on a plane at 1
    const std::string off = "0 -0.16 0.64 0.48";
    write_spot("a.exr", 1, off.c_str()), write_spot("b.exr", 100, off.c_str());
    ASSERT_EQ(run("compare a.exr b.exr --json c.json"), 0) << said;
    EXPECT_NEAR(figures()["pixels_per_degree"], 64 / edge * std::numbers::pi / 180, 1e-6);
    const double right = std::atan(0.405) * 180 / std::numbers::pi,
                 up = std::atan(0.48 - 0.105) * 180 / std::numbers::pi;
    char place[80];
    std::snprintf(place, sizeof place, "at (40, 10), %.2f degrees right and %.2f above", right, up);
    EXPECT_NE(printed.find(place), std::string::npos) << printed << place;
    write_spot("wide.exr", 1, "0 -0.16 1.28 0.48"), write_spot("middle.exr", 1, "-0.32 -0.32 0.32 0.32");
    expect_refused("compare wide.exr wide.exr", {"not square"});
    expect_refused("compare a.exr middle.exr", {"the pictures cover"});
    EXPECT_EQ(run("compare a.exr middle.exr --fov 30"), 0) << said;
}

// A grating of 4 px is seen alike with and without scatter: the sensitivity is that of a whole eye. Pictures on the
// retina have lost some of it before.
TEST_F(CompareTest, GratingsAreSeenWithAnyModelOfBlur) {
    const auto stripes = [&](const char* name, float contrast) {
        io::HdrImage image{.width = 64, .height = 64, .rgb = {}, .white_luminance = 1};
        for (uint32_t i = 0; i < 64 * 64; ++i) image.rgb.insert(image.rgb.end(), 3, i % 4 < 2 ? 1 + contrast : 1);
        io::write_exr(folder / name, image);
    };
    stripes("plain.exr", 0), stripes("stripes.exr", 0.03f);
    std::map<std::string, double> largest;
    for (const std::string glare : {"cie", "none", "retina"}) {
        ASSERT_EQ(run("compare plain.exr stripes.exr --fov 1 --json c.json --glare " + glare), 0) << said;
        largest[glare] = figures()["largest_probability"];
    }
    EXPECT_GT(largest["none"], 0.1);
    EXPECT_NEAR(largest["cie"], largest["none"], 0.1);
    EXPECT_GT(largest["retina"], largest["none"] + 0.05);
}

// The whole way, with the light that the eye scatters: four times Adrian 1989, k = 1, 2 s, 23 years, within a factor of
// 1.25. His observers see that much more than Barten's eye.
TEST_F(CompareTest, ThresholdsOfDiscsAreFourTimesThoseOfAdrian) {
    constexpr uint32_t kPixels = 160;  // px, 4 degrees
    const auto write_disc = [&](const char* name, double minutes, double contrast) {
        io::HdrImage image{.width = kPixels, .height = kPixels, .rgb = {}, .white_luminance = 1};
        for (const float l : disc(kPixels, minutes / 60 * kPixels / 4 / 2, 1, contrast))
            image.rgb.insert(image.rgb.end(), 3, l);
        io::write_exr(folder / name, image);
    };
    write_disc("plain.exr", 1, 0);
    for (const double minutes : {4.0, 10.0, 30.0}) {
        const double threshold = vision::target_threshold(1, {.size = minutes, .seconds = 2, .probability = 1});
        for (const double factor : {1 / 1.25, 1.25}) {
            constexpr double kOfAdrian = 4.3;
            write_disc("disc.exr", minutes, factor * kOfAdrian * threshold);
            ASSERT_EQ(run("compare plain.exr disc.exr --fov 4 --json c.json"), 0) << said;
            EXPECT_EQ(figures()["largest_probability"] > 0.5, factor > 1) << minutes << "', " << factor;
        }
    }
}

TEST_F(CompareTest, SaysWhatOfAPngDoesNotCount) {
    std::vector<uint8_t> grey(size_t{32} * 32 * 4, 128);
    io::write_png(folder / "grey.png", 32, 32, grey);
    io::write_png(folder / "pq.png", 32, 32, grey, {9, 16});
    ASSERT_EQ(run("compare grey.png pq.png --fov 1"), 0);
    EXPECT_NE(said.find("pq.png: its header says"), std::string::npos) << said;
    EXPECT_EQ(said.find("grey.png"), std::string::npos) << said;
    write("a.exr", 0);
    expect_refused("compare grey.png grey.png --fov 1 --unit 2", {"--unit"});
    expect_refused("compare grey.png grey.png --fov 1 --layer x", {"--layer"});
    expect_refused("compare a.exr a.exr --display-peak 100", {"--display"});
}

// Light below nothing would take light from its neighbours.
TEST_F(CompareTest, NegativeLuminancesAreBlack) {
    write("a.exr", 0);
    io::HdrImage negative = io::read_exr(folder / "a.exr"), black = negative;
    negative.header = {}, black.header = {};
    for (int c = 0; c < 3; ++c) negative.rgb[size_t(300 + c)] = -1e4f, black.rgb[size_t(300 + c)] = 0;
    io::write_exr(folder / "negative.exr", negative), io::write_exr(folder / "black.exr", black);
    ASSERT_EQ(run("compare negative.exr black.exr --fov 2 --json c.json"), 0) << said;
    EXPECT_EQ(figures()["largest_probability"], 0);
    EXPECT_NE(said.find("1 pixels are not finite or of negative luminance"), std::string::npos) << said;
}

TEST_F(CompareTest, NotesPixelsThatAreNotFinite) {
    write("a.exr", 0);
    io::HdrImage damaged = io::read_exr(folder / "a.exr");
    damaged.header = {};  // texts that only a reader may make
    damaged.rgb[30] = std::nanf(""), damaged.rgb[300] = HUGE_VALF;
    io::write_exr(folder / "damaged.exr", damaged);
    ASSERT_EQ(run("compare damaged.exr a.exr --json c.json -o map.png"), 0) << said;
    EXPECT_NE(said.find("2 pixels are not finite"), std::string::npos) << said;
    EXPECT_GT(figures()["largest_probability"], 0.9);
}

}  // namespace
}  // namespace vesper::test
