// Radiance pictures of every kind, read back; what is not read; damaged files. SPDX-License-Identifier: MIT
#include <array>
#include <cmath>

#include "support/hdr_files.h"

namespace vesper::test {
namespace {

const std::string kRgbe = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";

/// The value of a mantissa with an exponent byte.
float rgbe(int mantissa, int exponent) {
    return static_cast<float>((mantissa + 0.5) * std::ldexp(1.0, exponent - 136));
}

io::HdrImage radiance(const std::string& header, const std::string& pixels) {
    const TempFolder folder;
    folder.write("x.hdr", header + pixels);
    return io::read_hdr_image(folder / "x.hdr");
}

TEST(HdrRadiance, ReadsPlainPixelsAndBothKindsOfRuns) {
    const std::string plain("\x80\x40\x20\x81\xff\xff\xff\x00", 8);
    expect_values(radiance(kRgbe, "\n-Y 2 +X 1\n" + plain), {rgbe(128, 129), rgbe(64, 129), rgbe(32, 129), 0, 0, 0});
    // The older runs: a pixel, repeated twice; and 1 + 2 + 256 times.
    const Values grey3 = radiance(kRgbe, "\n-Y 1 +X 3\n" + std::string("\x80\x80\x80\x81\x01\x01\x01\x02", 8)).rgb;
    EXPECT_EQ(grey3, Values(9, rgbe(128, 129)));
    const Values grey259 =
        radiance(kRgbe, "\n-Y 1 +X 259\n" + std::string("\x80\x80\x80\x81\x01\x01\x01\x02\x01\x01\x01\x01", 12)).rgb;
    EXPECT_EQ(grey259, Values(3 * 259, rgbe(128, 129)));
    // The newer runs, component by component: eight times 200; 1 ... 8; 4 of 9 then 4 of 10; exponent 130.
    const std::string row(
        "\x02\x02\x00\x08"
        "\x88\xc8"
        "\x08\x01\x02\x03\x04\x05\x06\x07\x08"
        "\x84\x09\x84\x0a"
        "\x88\x82",
        4 + 2 + 9 + 4 + 2);
    Values wanted;
    for (int x = 0; x < 8; ++x)
        wanted.insert(wanted.end(), {rgbe(200, 130), rgbe(x + 1, 130), rgbe(x < 4 ? 9 : 10, 130)});
    expect_values(radiance("#?RGBE\n", "\n-Y 1 +X 8\n" + row), wanted);
}

// OpenCV and others write EXPOSURE=0 for an exposure that they do not know.
TEST(HdrRadiance, PassesOverExposuresThatAreNone) {
    const std::string one("\n-Y 1 +X 1\n\x80\x40\x20\x81", 15);
    const Values wanted{rgbe(128, 129), rgbe(64, 129), rgbe(32, 129)};
    for (const std::string each : {"0", "-1", "-0", "nan", "inf", "1 2", "", " ", "0,5", "x", "0.0000000000000"}) {
        const io::HdrImage image = radiance(kRgbe + "EXPOSURE=" + each + "\n", one);
        EXPECT_EQ(image.rgb, wanted) << each;
        EXPECT_EQ(image.exposure, 1) << each;
        EXPECT_EQ(image.notes, std::vector<std::string>{"Radiance: EXPOSURE=" + each +
                                                        " is not a positive number: "
                                                        "read as if it were not there"});
    }
    // Those beside it count, and each line is noted once.
    const io::HdrImage mixed = radiance(kRgbe + "EXPOSURE=0\nEXPOSURE=2\nEXPOSURE=0\nCOLORCORR=1 0 1\n", one);
    expect_values(mixed, {rgbe(128, 128), rgbe(64, 128), rgbe(32, 128)});
    EXPECT_EQ(mixed.notes.size(), 2u);
    EXPECT_TRUE(contains(mixed.notes.back(), "COLORCORR=1 0 1 are not three positive numbers"));
    EXPECT_TRUE(radiance(kRgbe + "EXPOSURE=2\nCOLORCORR=1 1 1\n", one).notes.empty());
    for (const std::string each : {"0 0 0", "1 1", "nan 1 1", ""})
        EXPECT_EQ(radiance(kRgbe + "COLORCORR=" + each + "\n", one).rgb, wanted) << each;
}

// The six pixels of a picture 3 wide and 2 high, its rows 1 2 3 and 4 5 6, in the order of every resolution line.
TEST(HdrRadiance, ReadsEveryOrderOfPixels) {
    const std::pair<const char*, std::array<int, 6>> orders[]{
        {"-Y 2 +X 3", {1, 2, 3, 4, 5, 6}}, {"-Y 2 -X 3", {3, 2, 1, 6, 5, 4}}, {"+Y 2 +X 3", {4, 5, 6, 1, 2, 3}},
        {"+Y 2 -X 3", {6, 5, 4, 3, 2, 1}}, {"+X 3 -Y 2", {1, 4, 2, 5, 3, 6}}, {"+X 3 +Y 2", {4, 1, 5, 2, 6, 3}},
        {"-X 3 -Y 2", {3, 6, 2, 5, 1, 4}}, {"-X 3 +Y 2", {6, 3, 5, 2, 4, 1}}};
    for (const auto& [line, order] : orders) {
        std::string pixels;
        for (const int value : order) pixels += std::string(3, char(10 * value)) + char(130);
        const io::HdrImage image = radiance(kRgbe, std::string("\n") + line + "\n" + pixels);
        EXPECT_EQ(image.width, 3u) << line;
        Values wanted;
        for (int value = 1; value <= 6; ++value) wanted.insert(wanted.end(), 3, rgbe(10 * value, 130));
        EXPECT_EQ(image.rgb, wanted) << line;
    }
}

TEST(HdrRadiance, UndoesExposureAndPrimaries) {
    const std::string one("\n-Y 1 +X 1\n\x80\x40\x20\x81", 15);
    const io::HdrImage exposed = radiance(kRgbe + "EXPOSURE=4\nGAMMA=1\nEXPOSURE= 0.5 \n", one);
    expect_values(exposed, {rgbe(128, 128), rgbe(64, 128), rgbe(32, 128)});
    EXPECT_EQ(exposed.header.size(), 4u);
    expect_values(radiance(kRgbe + "COLORCORR= 2 1 0.5\nCOLORCORR=1 1 0.5\n", one),
                  {rgbe(128, 128), rgbe(64, 129), rgbe(32, 131)}, 1e-6);
    expect_values(radiance("#?RADIANCE\nFORMAT= 32-bit_rle_rgbe \n", one),
                  {rgbe(128, 129), rgbe(64, 129), rgbe(32, 129)});
    EXPECT_EQ(exposed.white_luminance, 0.0);
    const Values plain = {rgbe(128, 129), rgbe(64, 129), rgbe(32, 129)};
    expect_values(radiance(kRgbe + "PRIMARIES=0 0 0 0 0 0 0 0\n", one), plain);
    expect_values(radiance(kRgbe + "PRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .3290\n", one), plain);
    expect_values(radiance(kRgbe + "PRIMARIES=.64 .33 .15 .06 .3 .6 .3127 .3290\n", one),
                  {plain[0], plain[2], plain[1]}, 1e-6);
    // XYZ of a colour: x = X 3.2405 - Y 1.5371 - Z 0.4985 and so on (IEC 61966-2-1)
    const double X = static_cast<double>(plain[0]), Y = static_cast<double>(plain[1]),
                 Z = static_cast<double>(plain[2]);
    expect_values(radiance("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n", one),
                  {static_cast<float>(3.2405 * X - 1.5371 * Y - 0.4985 * Z),
                   static_cast<float>(-0.9693 * X + 1.8760 * Y + 0.0416 * Z),
                   static_cast<float>(0.0556 * X - 0.2040 * Y + 1.0572 * Z)},
                  1e-3);
}

// Colours of Radiance's own programs weigh 0.265, 0.670 and 0.065 in luminance (color.h: 0.26507, 0.67013, 0.06480),
// those of others as Rec. 709.
TEST(HdrRadiance, PrimariesAreRadiancesOwnWhereItsProgramsMadeThePicture) {
    const auto luminances = [](const std::string& header) {
        const std::string three("\x80\0\0\x88\0\x80\0\x88\0\0\x80\x88", 12);
        const io::HdrImage image = radiance(header, "\n-Y 1 +X 3\n" + three);
        Values found;
        for (size_t i = 0; i < 9; i += 3)
            found.push_back(float(0.212639 * double(image.rgb[i]) + 0.715169 * double(image.rgb[i + 1]) +
                                  0.072192 * double(image.rgb[i + 2])));
        return found;
    };
    // 128.5 of one channel, 0.5 of the others.
    const auto mixed = [](double r, double g, double b) {
        return Values{float(128 * r + 0.5), float(128 * g + 0.5), float(128 * b + 0.5)};
    };
    const Values own = mixed(0.26507, 0.67013, 0.06480), rec709 = mixed(0.212639, 0.715169, 0.072192);
    const auto expect = [&](const std::string& header, const Values& wanted) {
        const Values found = luminances(header);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], wanted[c], 2e-4 * double(wanted[c])) << header;  // the weights have five digits
    };
    expect(kRgbe, rec709);
    for (const char* other : {"GAMMA=1\nSOFTWARE=a camera\n", "hdrmerge a b\n", "\"\n"}) expect(kRgbe + other, rec709);
    expect(kRgbe + "VIEW= -vtv -vv 20\n", own);
    expect(kRgbe + "SOFTWARE= RADIANCE 5.4a\n", own);
    for (const char* command : {"rpict -vf a.vf scene.oct\n", "\t/usr/local/bin/pfilt -1\n", "\trtrace -x 3\n",
                                "rmtxop -fc a b\n", "\"C:\\Program Files\\Radiance\\bin\\rpict.exe\" a.oct\n"})
        expect(kRgbe + command, own);
    expect(kRgbe + "VIEW= -vtv\nPRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .3290\n", rec709);
    expect(kRgbe + "PRIMARIES=0 0 0 0 0 0 0 0\nrpict scene.oct\n", own);
}

// lm/sr/m^2 where RGBE has W/sr/m^2: the unit is known.
TEST(HdrRadiance, XyzeIsInCandelas) {
    EXPECT_EQ(radiance("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n", std::string("\n-Y 1 +X 1\n\x80\x40\x20\x81", 15))
                  .white_luminance,
              1.0);
    EXPECT_EQ(radiance(kRgbe, std::string("\n-Y 1 +X 1\n\x80\x40\x20\x81", 15)).white_luminance, 0.0);
}

TEST(HdrRadiance, RefusesWithAReason) {
    const auto reason = [](const std::string& text) {
        const TempFolder folder;
        folder.write("x.hdr", text);
        return refusal(folder / "x.hdr", {1000, 1000000});
    };
    EXPECT_TRUE(contains(reason(kRgbe + "\n+Y 1 +Y 1\nabcd"), "-Y HEIGHT +X WIDTH"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n*X 1 -Y 1\nabcd"), "-Y HEIGHT +X WIDTH"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 1 +X 1 x\nabcd"), "-Y HEIGHT +X WIDTH"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 0 +X 1\nabcd"), "no pixels"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 999999 +X 999999\nabcd"), "limit for one side"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 999 +X 999\nabcd"), "cut off"));
    for (const char* each : {"1e300", "1e-300"}) {
        const std::string line = std::string("EXPOSURE=") + each + "\n";
        EXPECT_TRUE(
            contains(reason(kRgbe + line + line + "\n-Y 1 +X 1\nabcd"), "the EXPOSUREs and COLORCORRs multiply"))
            << each;
    }
    EXPECT_TRUE(contains(reason(kRgbe + "PRIMARIES=1 2 3\n\n-Y 1 +X 1\nabcd"), "PRIMARIES"));
    EXPECT_TRUE(contains(reason(kRgbe + "PRIMARIES=.1 .1 .1 .1 .1 .1 .1 .1\n\n-Y 1 +X 1\nabcd"), "primaries"));
    EXPECT_TRUE(contains(reason("#?RADIANCE\nFORMAT=other\n\n-Y 1 +X 1\nabcd"), "FORMAT"));
    EXPECT_TRUE(
        contains(reason(kRgbe + "\n-Y 1 +X 8\n" + std::string("\x02\x02\x00\x09\x88\xc8", 6)), "a row of 9 px"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 1 +X 8\n" + std::string("\x02\x02\x00\x08\x89\xc8", 6)), "run"));
    EXPECT_TRUE(contains(reason(kRgbe + "\n-Y 1 +X 1\n" + std::string("\x01\x01\x01\x01", 4)), "run"));
}

TEST(HdrRadiance, SurvivesCutAndChangedFiles) {
    const TempFolder folder;
    std::string pixels;
    for (int y = 0; y < 5; ++y)
        pixels += std::string(
            "\x02\x02\x00\x08"
            "\x88\xc8"
            "\x08\x01\x02\x03\x04\x05\x06\x07\x08"
            "\x84\x09\x84\x0a"
            "\x88\x82",
            21);
    folder.write("x.hdr", kRgbe + "EXPOSURE=2\nPRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .3290\n\n-Y 5 +X 8\n" + pixels);
    expect_survives(folder, folder / "x.hdr", true);
}

}  // namespace
}  // namespace vesper::test
