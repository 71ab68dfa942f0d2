// `vesper tonemap` as people run it. SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <limits>

#include "analysis/relative_picture.h"
#include "io/read_file.h"
#include "print.h"
#include "support/complaints.h"
#include "support/exr_files.h"
#include "support/program.h"

namespace vesper::test {
namespace {

using apps::format;
using io::HdrImage;
namespace fs = std::filesystem;

HdrImage street(uint32_t width, uint32_t height) {
    HdrImage image{width, height, {}, 0, {}};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const float l =
                std::pow(10.0f, -2 + 5 * float(x + y) / float(width + height)) * (1 + 0.2f * std::sin(0.4f * float(x)));
            for (const float tint : {1.0f, 0.8f, 0.5f}) image.rgb.push_back(l * tint);
        }
    return image;
}

HdrImage uniform(uint32_t width, uint32_t height, float value) {
    return {width, height, std::vector<float>(size_t{3} * width * height, value), 0, {}};
}

class TonemapProgram : public ProgramTest {
protected:
    int tonemap(const std::string& arguments, const std::string& environment = "") {
        return run("tonemap " + arguments, environment);
    }
    Image png(const std::string& name) { return io::decode_image(io::read_file(folder / name, 1u << 28), 32768); }
    std::string header(const std::string& name, const std::string& key) {
        for (const auto& [k, value] : io::read_exr(folder / name).header)
            if (k == key) return value;
        return "none";
    }
    /// The largest difference of codes between two pictures.
    int difference(const std::string& a, const std::string& b) {
        const Image left = png(a), right = png(b);
        if (left.width != right.width || left.rgba.size() != right.rgba.size()) return 999;
        int most = 0;
        for (size_t i = 0; i < left.rgba.size(); ++i) most = std::max(most, std::abs(left.rgba[i] - right.rgba[i]));
        return most;
    }
    bool left_nothing_behind() const {
        for (const auto& entry : fs::directory_iterator(folder.path()))
            if (entry.path().filename().string().starts_with(".vesper")) return false;
        return true;
    }
};

// Red of twice what the display has in it, and of all that white has: as it was named, and nearer to white as it is
// brighter.
TEST_F(TonemapProgram, BrightColoursGiveWayAsAsked) {
    HdrImage image{3, 1, {}, 0, {}};
    for (const float luminance : {0.1f, 0.4f, 1.0f}) image.rgb.insert(image.rgb.end(), {luminance / 0.212639f, 0, 0});
    write_layout(folder / "red.exr", image, {});
    const auto green_of = [&](const std::string& options) {
        EXPECT_EQ(tonemap("red.exr --unit 1 --operator linear --linear-max 1 " + options + " -o red.png"), 0) << said;
        const Image shown = png("red.png");
        EXPECT_TRUE(shown.rgba[0] > 170 && shown.rgba[0] < 190)
            << "below its own luminance red is itself: " << int(shown.rgba[0]);
        EXPECT_TRUE(shown.rgba[4] == 255 && shown.rgba[8] == 255);
        return std::array<int, 3>{shown.rgba[1], shown.rgba[5], shown.rgba[9]};
    };
    const auto given_way = green_of("");
    EXPECT_EQ(given_way, green_of("--gamut luminance"));
    EXPECT_EQ(given_way[0], 0);
    EXPECT_TRUE(given_way[1] > 30 && given_way[2] > given_way[1] + 30 && given_way[2] < 160)
        << given_way[1] << ", " << given_way[2];
    EXPECT_EQ(green_of("--gamut chromaticity"), (std::array<int, 3>{}));
    EXPECT_EQ(green_of("--gamut clip"), (std::array<int, 3>{}));
    EXPECT_EQ(tonemap("red.exr --gamut white -o other.png"), 2);
    EXPECT_NE(said.find("--gamut"), std::string::npos) << said;
    EXPECT_FALSE(fs::exists(folder / "other.png"));
}

TEST_F(TonemapProgram, OnePictureInEveryLayoutIsOnePicture) {
    const HdrImage image = street(100, 70);
    write_layout(folder / "plain.exr", image, {});
    ASSERT_EQ(tonemap("plain.exr --unit 1 -o plain.png"), 0) << said;
    // Lossless ones agree exactly. PXR24 keeps 16 bits of the mantissa; DWA is visually lossless, B44 leaves floats
    // alone; half precision and filtered chroma take up to some codes where luminance changes from pixel to pixel.
    using namespace Imf;
    const std::pair<ExrLayout, int> layouts[]{{{.compression = NO_COMPRESSION}, 0},
                                              {{.compression = RLE_COMPRESSION}, 0},
                                              {{.compression = ZIPS_COMPRESSION}, 0},
                                              {{.compression = PIZ_COMPRESSION}, 0},
                                              {{.compression = PXR24_COMPRESSION}, 1},
                                              {{.compression = B44_COMPRESSION}, 0},
                                              {{.compression = DWAA_COMPRESSION}, 3},
                                              {{.compression = DWAB_COMPRESSION}, 3},
                                              {{.tiles = true}, 0},
                                              {{.tiles = true, .mipmap = true}, 0},
                                              {{.multi_part = true}, 0}};
    for (const auto& [layout, codes] : layouts) {
        write_layout(folder / "other.exr", image, layout);
        ASSERT_EQ(tonemap("other.exr --unit 1 -o other.png"), 0) << said;
        EXPECT_LE(difference("plain.png", "other.png"), codes)
            << layout.compression << layout.tiles << layout.mipmap << layout.multi_part;
    }
    write_chroma(folder / "chroma.exr", image);
    ASSERT_EQ(tonemap("chroma.exr --unit 1 -o chroma.png"), 0) << said;
    EXPECT_LE(difference("plain.png", "chroma.png"), 8);
    write_layout(folder / "grey.exr", image, {.grey = true});
    ASSERT_EQ(tonemap("grey.exr --unit 1 -o grey.png"), 0) << said;
    const Image grey = png("grey.png");
    for (size_t i = 0; i < grey.rgba.size(); i += 4)
        ASSERT_TRUE(grey.rgba[i] == grey.rgba[i + 1] && grey.rgba[i] == grey.rgba[i + 2]);
    write_layout(folder / "window.exr", image, {.x0 = 30, .y0 = -20});
    ASSERT_EQ(tonemap("window.exr --unit 1 -o window.png"), 0) << said;
    const Image window = png("window.png");
    EXPECT_EQ(window.width, 100u);
    EXPECT_LE(window.rgba[4 * 10], 1) << "left of the data window";
    EXPECT_GT(window.rgba[4 * 90], 10) << "inside";
}

TEST_F(TonemapProgram, TheUnitIsTheFilesOrTheOneGiven) {
    const HdrImage image = street(60, 40);
    write_layout(folder / "relative.exr", image, {});
    write_layout(folder / "absolute.exr", image, {.white_luminance = 250});
    ASSERT_EQ(tonemap("absolute.exr -o absolute.png -o on-display.exr"), 0);
    EXPECT_EQ(said, "");
    ASSERT_EQ(tonemap("relative.exr --unit 250 -o scaled.png -o scaled.exr"), 0);
    EXPECT_EQ(said, "");
    ASSERT_EQ(tonemap("absolute.exr --unit 1 -o unscaled.png"), 0);
    EXPECT_NE(said.find("says that 1.0 is 250 cd/m^2: --unit 1 is taken"), std::string::npos) << said;
    EXPECT_EQ(difference("absolute.png", "scaled.png"), 0);
    EXPECT_GT(difference("absolute.png", "unscaled.png"), 0);
    EXPECT_EQ(header("on-display.exr", "vesper:sourceScale"), "250");
    EXPECT_EQ(header("on-display.exr", "vesper:sourceScaleFrom"), "header");
    EXPECT_EQ(header("on-display.exr", "vesper:exposure"), "0");
    EXPECT_EQ(read_text(folder / "absolute.png").find("tEXt"), std::string::npos) << "nothing was chosen";
    EXPECT_EQ(header("on-display.exr", "whiteLuminance"), "1");
    EXPECT_EQ(header("scaled.exr", "vesper:sourceScaleFrom"), "option");
}

// The number that is printed is the one that is used and kept, and gives the same picture again.
TEST_F(TonemapProgram, PicturesWithoutAUnitAreScaled) {
    const HdrImage image = street(60, 40);
    const double scale = analysis::plausible_scale(analysis::relative_luminance(image.rgb));
    const std::string number = format("%.6g", scale);
    write_layout(folder / "a.exr", image, {});
    ASSERT_EQ(tonemap("a.exr -o a.png -o on-display.exr"), 0) << said;
    EXPECT_TRUE(said.starts_with("note: a.exr: its header names no unit: 1.0 is taken as " + number +
                                 " cd/m^2, so that its log average is "))
        << said;
    EXPECT_EQ(header("on-display.exr", "vesper:sourceScale"), number);
    EXPECT_EQ(header("on-display.exr", "vesper:sourceScaleFrom"), "auto");
    EXPECT_NE(read_text(folder / "a.png").find("tEXtvesper:sourceScale" + std::string(1, 0) + number),
              std::string::npos);
    ASSERT_EQ(tonemap("a.exr --unit " + number + " -o same.png"), 0);
    EXPECT_EQ(difference("a.png", "same.png"), 0);
    ASSERT_EQ(tonemap("a.exr --unit auto -o same.png"), 0);
    EXPECT_EQ(difference("a.png", "same.png"), 0);
    // Any multiple of it is the same picture, but for the seventh digit.
    HdrImage times = image;
    for (float& value : times.rgb) value *= 3e-4f;
    write_layout(folder / "times.exr", times, {});
    ASSERT_EQ(tonemap("times.exr -o times.png"), 0);
    EXPECT_LE(difference("a.png", "times.png"), 1);
    // The ldr operator takes values relative to white: they stay.
    ASSERT_EQ(tonemap("a.exr --operator ldr -o ldr.png"), 0);
    EXPECT_EQ(said, "");
    ASSERT_EQ(tonemap("a.exr --operator ldr --unit 1 -o one.png"), 0);
    EXPECT_EQ(difference("ldr.png", "one.png"), 0);
    write_layout(folder / "black.exr", uniform(20, 20, 0), {});
    ASSERT_EQ(tonemap("black.exr -o black.png"), 0);
    EXPECT_EQ(said, "note: black.exr: its header names no unit, and it has no light\n");
}

TEST_F(TonemapProgram, ExposureMultipliesEveryScale) {
    write_layout(folder / "a.exr", street(60, 40), {});
    write_layout(folder / "b.exr", street(60, 40), {.white_luminance = 40});
    const double scale = analysis::plausible_scale(analysis::relative_luminance(street(60, 40).rgb));
    const std::pair<std::string, double> all[]{{"a.exr --exposure -1.5", scale * std::exp2(-1.5)},
                                               {"a.exr --unit 100 --exposure 2", 400},
                                               {"b.exr --exposure 1", 80},
                                               {"b.exr --unit auto --exposure -3", 5}};
    for (const auto& [arguments, wanted] : all) {
        ASSERT_EQ(tonemap(arguments + " -o out.exr -o out.png"), 0) << said;
        EXPECT_NEAR(std::stod(header("out.exr", "vesper:sourceScale")) / wanted, 1, 1e-8) << arguments;
        ASSERT_EQ(tonemap(arguments.substr(0, 5) + format(" --unit %.9g -o given.png", wanted)), 0) << said;
        EXPECT_EQ(difference("out.png", "given.png"), 0) << arguments;
    }
    EXPECT_EQ(header("out.exr", "vesper:exposure"), "-3");
}

// EXPOSURE is divided out, so that the values are those of the scene; of 1, as many programs write it, it says nothing.
TEST_F(TonemapProgram, RadiancePicturesWithExposureAndInXyzStayAbsolute) {
    const auto scale_of = [&](const std::string& lines) {
        folder.write("r.hdr",
                     "#?RADIANCE\n" + lines + "\n-Y 1 +X 2\n" + std::string(4, char(128)) + std::string(4, char(129)));
        EXPECT_EQ(tonemap("r.hdr -o r.exr"), 0) << said;
        return header("r.exr", "vesper:sourceScale") + " " + header("r.exr", "vesper:sourceScaleFrom");
    };
    const std::string rgbe = "FORMAT=32-bit_rle_rgbe\n";
    EXPECT_EQ(scale_of(rgbe + "EXPOSURE=0.5\n"), "1 header");
    EXPECT_EQ(said,
              "note: r.hdr: its header has an EXPOSURE, but no unit: taken as cd/m^2 (--unit 179 if these are "
              "Radiance's watts)\n");
    EXPECT_EQ(scale_of("FORMAT=32-bit_rle_xyze\n"), "1 header");
    EXPECT_EQ(said, "");
    EXPECT_EQ(scale_of("FORMAT=32-bit_rle_xyze\nEXPOSURE=2\n"), "1 header");
    EXPECT_TRUE(scale_of(rgbe).ends_with(" auto"));
    EXPECT_TRUE(scale_of(rgbe + "EXPOSURE=          1.0000000000000\n").ends_with(" auto"));
    EXPECT_TRUE(scale_of(rgbe + "EXPOSURE=0\n").ends_with(" auto"));
    EXPECT_TRUE(
        said.starts_with("note: r.hdr: Radiance: EXPOSURE=0 is not a positive number: read as if it were not "
                         "there\n"))
        << said;
}

// What holds for all is told once, a scale that was found for each; where a sequence changes its unit is told, too.
TEST_F(TonemapProgram, WhatPicturesDoNotSayIsNoted) {
    fs::create_directory(folder / "many");
    write_layout(folder / "a.exr", street(30, 20), {.white_luminance = 10});
    for (const char* name : {"b.exr", "c.exr"}) write_layout(folder / name, street(30, 20), {});
    ASSERT_EQ(tonemap("a.exr b.exr c.exr -o many/"), 0);
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 2) << said;
    for (const char* name : {"note: b.exr: ", "note: c.exr: "})
        EXPECT_NE(said.find(std::string(name) + "its header names no unit: 1.0 is taken as "), std::string::npos)
            << said;
    ASSERT_EQ(tonemap("a.exr --glare cie -o a.png"), 0);
    EXPECT_EQ(
        said,
        "note: a.exr: its header names no angle of a perspective: taken as 40 degrees high (--fov tells another)\n");
    ASSERT_EQ(tonemap("a.exr --glare cie --fov 30 -o a.png"), 0);
    EXPECT_EQ(said, "");
}

// One scale holds for a sequence, which would flicker with its own for each: that of the first picture with a unit or
// light.
TEST_F(TonemapProgram, TheScaleOfASequenceStays) {
    const auto scale_of = [&](const std::string& name) { return header(name, "vesper:sourceScale"); };
    write_layout(folder / "f0.exr", uniform(30, 20, 0), {});
    write_layout(folder / "f1.exr", street(30, 20), {});
    HdrImage brighter = street(30, 20);
    for (float& value : brighter.rgb) value *= 5;
    write_layout(folder / "f2.exr", brighter, {});
    write_layout(folder / "f3.exr", street(30, 20), {.white_luminance = 10});
    write_layout(folder / "f4.exr", street(30, 20), {});
    ASSERT_EQ(tonemap("f%d.exr --fps 30 -o o%d.exr"), 0) << said;
    const std::string first = scale_of("o1.exr");
    EXPECT_EQ(scale_of("o0.exr"), "1") << "black whatever its scale";
    EXPECT_EQ(first, format("%.6g", analysis::plausible_scale(analysis::relative_luminance(street(30, 20).rgb))));
    EXPECT_EQ(scale_of("o2.exr"), first);
    EXPECT_EQ(scale_of("o3.exr"), "10");
    EXPECT_EQ(scale_of("o4.exr"), first);
    EXPECT_EQ(header("o4.exr", "vesper:sourceScaleFrom"), "sequence");
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 4) << said;
    EXPECT_NE(said.find("note: f3.exr: 1.0 is 10 cd/m^2 from here on, and was " + first + "\n"), std::string::npos)
        << said;
    EXPECT_NE(said.find("note: f4.exr: 1.0 is " + first + " cd/m^2 from here on, and was 10\n"), std::string::npos)
        << said;
    fs::create_directory(folder / "many");
    ASSERT_EQ(tonemap("f3.exr f4.exr f1.exr --fps 30 --exposure 1 -o many/"), 0);
    EXPECT_EQ(said, "note: f4.exr: its header names no unit: 1.0 stays 10 cd/m^2\n");
    ASSERT_EQ(tonemap("f2.exr f1.exr -o p%d.exr"), 0) << said;
    EXPECT_NE(scale_of("p0.exr"), scale_of("p1.exr")) << "no sequence";
}

// Radiance's own angle, the picture's height moved by a lift; other projections have none.
TEST_F(TonemapProgram, ViewsOfRadianceTellTheAngle) {
    const auto angle = [&](const std::string& header) {
        folder.write("v.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + header + "\n-Y 1 +X 2\n" +
                                  std::string(4, char(128)) + std::string(4, char(129)));
        EXPECT_EQ(tonemap("v.hdr --unit 179 --glare cie --stats -o v.png"), 0) << said;
        const size_t at = printed.find("degrees)");
        return at == std::string::npos ? 0.0 : std::stod(printed.substr(printed.rfind('(', at) + 1));
    };
    EXPECT_NEAR(angle("VIEW= -vtv -vp 0 0 1 -vd 0 1 0 -vh 20 -vv 15 -vs 0 -vl 0\n"), 15, 0.01);
    EXPECT_EQ(said.find("no angle"), std::string::npos) << said;
    EXPECT_NEAR(angle("VIEW= -vtv -vv 60\nVIEW= -vtv -vv 15\n"), 15, 0.01);
    EXPECT_NEAR(angle("VIEW= -vtv -vv 40 -vl 0.5\n"), 36.1, 0.1) << "atan(2 tan 20)";
    EXPECT_NEAR(angle("VIEW= -vtv -vh 20 -vv 15\nVIEW= -vs 0.5\n"), 15, 0.01) << "each changes what was before";
    EXPECT_NEAR(angle("VIEW= -vta -vh 180 -vv 180\nVIEW= -vv 60\n"), 40, 0.01) << "still a fisheye";
    EXPECT_NEAR(angle("VIEW= -vtv -vv nan\n"), 40, 0.01);
    EXPECT_NEAR(angle("VIEW= -vta -vh 180 -vv 180\n"), 40, 0.01);
    EXPECT_NE(said.find("no angle"), std::string::npos) << said;
    EXPECT_NEAR(angle("PIXASPECT=0.5\n"), 40, 0.01);
    EXPECT_NE(said.find("its pixels are not square (0.5)"), std::string::npos) << said;
}

TEST_F(TonemapProgram, TargetsArePrinted) {
    write_layout(folder / "a.exr", uniform(64, 48, 2), {.white_luminance = 1});
    ASSERT_EQ(tonemap("a.exr --fov 20 --target .4,.4,.2,.2 -o a.png"), 0) << said;
    EXPECT_EQ(printed, "a.exr: target 2 cd/m^2 on 2 cd/m^2, veil 0 cd/m^2, visibility level 0\n");
    for (const char* target : {".5,.5,.002,.002", "0,0,1,1", ".5,.5,0,0"})
        expect_refused(std::string("tonemap a.exr --fov 20 -o a.png --target ") + target, {"a.exr: --target: "});
}

// The sRGB chunk says sRGB: other displays name what they are, or nothing.
TEST_F(TonemapProgram, PngsSayWhatTheirCodesMean) {
    write_layout(folder / "a.exr", uniform(4, 4, 2), {.white_luminance = 1});
    const auto chunks = [&](const std::string& display) {
        EXPECT_EQ(tonemap("a.exr --display " + display + " -o a.png"), 0) << said;
        const auto bytes = io::read_file(folder / "a.png", 1u << 20);
        return std::string(bytes.begin(), bytes.end());
    };
    const auto profile = [&](const std::string& rest) {
        folder.write("d.json", R"({"version": 1, "peak_cd_m2": 100, "black_cd_m2": 0.1, )" + rest + "}");
        return chunks("d.json");
    };
    const auto cicp = [](int primaries, int transfer) {
        return std::string("cICP") + char(primaries) + char(transfer) + std::string("\0\1", 2);
    };
    EXPECT_TRUE(contains(chunks("desk"), "sRGB"));
    EXPECT_TRUE(contains(chunks("hdr10"), cicp(9, 16)));
    const std::string gamma = profile(R"("eotf": "gamma", "gamma": 2.6)");
    EXPECT_FALSE(contains(gamma, "sRGB"));
    EXPECT_FALSE(contains(gamma, "cICP"));
    EXPECT_TRUE(contains(profile(R"("eotf": "pq", "bits": 8, "primaries": "rec2020")"), cicp(9, 16)));
    EXPECT_TRUE(contains(profile(R"("eotf": "srgb", "primaries": "p3")"), cicp(12, 13)));
    EXPECT_TRUE(contains(profile(R"("eotf": "gamma", "gamma": 2.2, "primaries": "rec2020")"), cicp(9, 4)));
    EXPECT_TRUE(contains(
        profile(
            R"("eotf": "pq", "primaries": {"red": [0.66, 0.33], "green": [0.25, 0.65], "blue": [0.15, 0.06], "white": [0.3127, 0.329]})"),
        cicp(2, 16)));
}

TEST_F(TonemapProgram, AnglesSetTheFovealLevel) {
    write_layout(folder / "a.exr", street(640, 400), {});
    const auto level = [&](const std::string& arguments) {
        EXPECT_EQ(tonemap("a.exr -o x.exr " + arguments), 0) << said;
        return header("x.exr", "vesper:shownFovealLevel");
    };
    EXPECT_EQ(level("--fov 100"), "2");  // 4 px a degree
    EXPECT_EQ(level("--fov 25"), "4");   // 16 px
    EXPECT_EQ(level("--fov 25 --foveal-level 5"), "5");
    EXPECT_EQ(level(""), "3") << "40 degrees";
}

TEST_F(TonemapProgram, SequencesRememberAndOthersDoNot) {
    for (const int number : {8, 9, 10, 14})
        write_layout(folder / ("f." + std::to_string(number) + ".exr"), street(20 + uint32_t(number), 20),
                     {.white_luminance = 1});
    ASSERT_EQ(tonemap("f.%d.exr --fps 4 -o o.%03d.exr"), 0) << said;
    EXPECT_EQ(said, "note: 3 pictures are missing before f.14.exr\n");
    EXPECT_EQ(header("o.008.exr", "vesper:eyeSeconds"), "0");
    EXPECT_EQ(header("o.009.exr", "vesper:eyeSeconds"), "0.25");
    EXPECT_EQ(header("o.010.exr", "vesper:eyeSeconds"), "0.5");
    EXPECT_EQ(header("o.014.exr", "vesper:eyeSeconds"), "1.5") << "missing frames take their time";
    ASSERT_EQ(tonemap("f.10.exr f.8.exr --fps 2 -o p%d.exr"), 0) << said;
    EXPECT_EQ(header("p1.exr", "vesper:eyeSeconds"), "0.5");
    ASSERT_EQ(tonemap("f.10.exr f.8.exr -o q%d.exr"), 0) << said;
    EXPECT_EQ(header("q1.exr", "vesper:eyeSeconds"), "0");
    fs::create_directory(folder / "all");
    ASSERT_EQ(tonemap("f.10.exr f.8.exr -o all"), 0) << said;
    EXPECT_TRUE(exists("all/f.10.png") && exists("all/f.8.png"));
}

TEST_F(TonemapProgram, HostilePicturesGiveAPicture) {
    const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
    HdrImage lamp = uniform(64, 64, 0);
    lamp.rgb[3 * 777] = lamp.rgb[3 * 777 + 1] = 1e8f;
    const std::pair<const char*, HdrImage> pictures[]{{"one", uniform(1, 1, 3)},
                                                      {"black", uniform(40, 30, 0)},
                                                      {"nan", uniform(40, 30, nan)},
                                                      {"inf", uniform(40, 30, inf)},
                                                      {"minus", uniform(40, 30, -inf)},
                                                      {"negative", uniform(40, 30, -5)},
                                                      {"largest", uniform(40, 30, 3.4e38f)},
                                                      {"least", uniform(40, 30, 1e-42f)},
                                                      {"lamp", lamp},
                                                      {"wide", uniform(16384, 3, 2)},
                                                      {"tall", uniform(2, 16384, 2)}};
    for (const auto& [name, image] : pictures) {
        write_layout(folder / "a.exr", image, {.white_luminance = 1});
        for (const char* tone : {"ward", "reinhard", "linear", "ldr"}) {
            ASSERT_EQ(tonemap("a.exr -o a.png -o b.exr --operator " + std::string(tone)), 0) << name << said;
            const Image shown = png("a.png");
            ASSERT_EQ(shown.width, image.width);
            const std::string kind = name;
            if (kind == "black" || kind == "nan" || kind == "inf" || kind == "minus" || kind == "negative") {
                EXPECT_EQ(shown.rgba[0], 0) << name << tone;
            }
            if (kind == "lamp") {
                EXPECT_GT(shown.rgba[4 * 777], 250) << tone;
            }
            for (const float value : io::read_exr(folder / "b.exr").rgb)
                ASSERT_TRUE(std::isfinite(value)) << name << tone;
        }
        EXPECT_EQ(said.find("not finite") != std::string::npos,
                  std::string(name) == "nan" || std::string(name) == "inf" || std::string(name) == "minus")
            << said;
    }
}

TEST_F(TonemapProgram, DamagedFilesLeaveEarlierOutputsAlone) {
    write_layout(folder / "good.exr", street(60, 40), {.white_luminance = 1});
    ASSERT_EQ(tonemap("good.exr -o out.png -o out.exr"), 0) << said;
    const std::string before = read_text(folder / "out.png"), before_exr = read_text(folder / "out.exr"),
                      whole = read_text(folder / "good.exr");
    for (const size_t part : {0u, 3u, 50u, 95u}) {
        folder.write("cut.exr", whole.substr(0, whole.size() * part / 100));
        expect_refused("tonemap cut.exr -o out.png -o out.exr", {"cut.exr"});
    }
    folder.write("text.hdr", "no picture");
    expect_refused("tonemap text.hdr -o out.png", {"text.hdr", "neither"});
    expect_refused("tonemap none.exr -o out.png", {"none.exr"});
    write_layout(folder / "wide.exr", uniform(40000, 1, 1), {.white_luminance = 1});  // more than devices take
    expect_refused("tonemap wide.exr -o out.png", {"wide.exr", "40000"});
    EXPECT_EQ(read_text(folder / "out.png"), before);
    EXPECT_EQ(read_text(folder / "out.exr"), before_exr);
    // Of several, the others are shown.
    fs::create_directory(folder / "all");
    EXPECT_EQ(tonemap("text.hdr good.exr -o all"), 2);
    EXPECT_TRUE(exists("all/good.png"));
    EXPECT_NE(said.find("1 of 2"), std::string::npos) << said;
    EXPECT_TRUE(left_nothing_behind());
}

TEST_F(TonemapProgram, RefusesInOneLine) {
    write_layout(folder / "a.exr", uniform(4, 4, 1), {.white_luminance = 1});
    fs::copy(folder / "a.exr", folder / "b.exr");
    fs::create_directory(folder / "all");
    fs::copy(folder / "a.exr", folder / "n.0000.exr"), fs::copy(folder / "a.exr", folder / "n.0001.exr");
    for (const char* arguments : {"n.0001.exr n.0000.exr -o n.%04d.exr",
                                  "n.%04d.exr -o n.%04d.exr",
                                  "a.exr",
                                  "a.exr -o a.tiff",
                                  "a.exr -o none/a.png",
                                  "a.exr -o none/",
                                  "a.exr b.exr -o x.png",
                                  "a.exr b.exr -o x.mp4",
                                  "a.exr -o x.mp4",
                                  "f.%d.exr -o x.%d.png",
                                  "f.%s.exr -o x.png",
                                  "a.exr f.%d.exr -o x.%d.png",
                                  "a.exr -o x.%d.%d.png",
                                  "a.exr a.exr -o all",
                                  "a.exr -o x.png -o x.png",
                                  "a.exr -o a.exr",
                                  "a.exr b.exr -o ./%d.exr -o a.exr",
                                  "a.exr -o x.png --unit 0",
                                  "a.exr -o x.png --unit nan",
                                  "a.exr -o x.png --unit automatic",
                                  "a.exr -o x.png --unit -3",
                                  "a.exr -o x.png --exposure 41",
                                  "a.exr -o x.png --exposure nan",
                                  "a.exr -o x.png --fov 180",
                                  "a.exr -o x.png --fps -1",
                                  "a.exr -o x.png --operator foo",
                                  "a.exr -o x.png --display foo",
                                  "a.exr -o x.png --foveal-level 9",
                                  "a.exr -o x.png --histogram-low 5 --histogram-high 5",
                                  "a.exr --fps 5 -o x.mp4 -o y.mp4",
                                  "a.exr -o x.png --device nowhere"})
        expect_refused(std::string("tonemap ") + arguments);
    EXPECT_FALSE(exists("x.png"));
    EXPECT_TRUE(left_nothing_behind());
}

TEST_F(TonemapProgram, Films) {
    for (int number = 0; number < 5; ++number)
        write_layout(folder / ("f" + std::to_string(number) + ".exr"), uniform(65, 33, float(number + 1)),
                     {.white_luminance = 1});
    expect_refused("tonemap f%d.exr -o film.mp4", {"film.mp4", "ffmpeg", "not installed"}, "PATH=/nowhere");
    folder.write("film.mp4", "an earlier film");
    fs::create_directory(folder / "bin");
    folder.write("bin/ffmpeg", "#!/bin/sh\necho 'no encoder here' >&2\nexit 3\n");
    fs::permissions(folder / "bin/ffmpeg", fs::perms::owner_all);
    expect_refused("tonemap f%d.exr -o film.mp4", {"film.mp4", "no encoder here"}, "PATH=" + (folder / "bin").string());
    EXPECT_EQ(read_text(folder / "film.mp4"), "an earlier film");
    EXPECT_TRUE(left_nothing_behind());
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not here";
    ASSERT_EQ(tonemap("f%d.exr --display hdr10 -o film.mp4"), 0) << said;
    ASSERT_EQ(tonemap("f%d.exr --fps 12 -o film.mp4 -o shown%d.png"), 0) << said;
    EXPECT_GT(fs::file_size(folder / "film.mp4"), 500u);
    EXPECT_EQ(read_text(folder / "film.mp4").substr(4, 4), "ftyp");
    EXPECT_TRUE(exists("shown4.png"));
    // One of another size ends it, and leaves the earlier film.
    const std::string before = read_text(folder / "film.mp4");
    write_layout(folder / "f3.exr", uniform(10, 10, 1), {.white_luminance = 1});
    expect_refused("tonemap f%d.exr -o film.mp4", {"one size"});
    EXPECT_EQ(read_text(folder / "film.mp4"), before);
    EXPECT_TRUE(left_nothing_behind());
}

TEST_F(TonemapProgram, IsDeterministic) {
    write_layout(folder / "a.exr", street(300, 200), {.white_luminance = 1});
    for (const char* name : {"x", "y"})
        ASSERT_EQ(tonemap(std::string("a.exr -o ") + name + ".png -o " + name + ".exr --glare ldr"), 0) << said;
    EXPECT_EQ(read_text(folder / "x.png"), read_text(folder / "y.png"));
    EXPECT_EQ(io::read_exr(folder / "x.exr").rgb, io::read_exr(folder / "y.exr").rgb);
}

}  // namespace
}  // namespace vesper::test
