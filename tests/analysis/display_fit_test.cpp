// Displays from measurements: known ones are found again, nonsense is refused where it stands.
// SPDX-License-Identifier: MIT
#include "analysis/display_fit.h"

#include <cmath>
#include <random>

#include "scene/display_file.h"
#include "scene/scene_files.h"
#include "support/complaints.h"

namespace vesper::test {
namespace {

using analysis::DisplayFit, vision::Eotf, analysis::fit_display;

const std::vector<uint32_t> kCodes{0, 1, 2, 4, 8, 16, 32, 48, 64, 96, 128, 160, 192, 224, 255};

std::vector<analysis::DisplayMeasurement> measure(const vision::Display& display, double noise = 0) {
    std::mt19937 random(3);
    std::normal_distribution<double> error(0, noise);
    const vision::DisplayCurve curve(display);
    std::vector<analysis::DisplayMeasurement> made;
    for (const uint32_t code : kCodes) {
        const uint32_t scaled = code * display.largest_code() / 255;
        made.push_back({scaled,
                        curve.emitted(double(scaled) / display.largest_code()) * (noise > 0 ? 1 + error(random) : 1),
                        made.size() + 2});
    }
    return made;
}

TEST(DisplayFit, FindsTheParametersAgain) {
    const DisplayFit gamma = fit_display(measure({.peak = 85, .black = 0.12f, .gamma = 2.31f}), 8);
    EXPECT_EQ(gamma.display.eotf, Eotf::Gamma);
    EXPECT_NEAR(double(gamma.display.gamma), 2.31, 1e-4);
    EXPECT_NEAR(double(gamma.display.peak), 85, 1e-3);
    EXPECT_NEAR(double(gamma.display.black), 0.12, 1e-5);
    EXPECT_LT(gamma.largest, 1e-5);
    const DisplayFit srgb = fit_display(measure({.peak = 120, .black = 0.3f, .eotf = Eotf::Srgb, .bits = 10}), 10);
    EXPECT_EQ(srgb.display.eotf, Eotf::Srgb);
    EXPECT_EQ(srgb.display.bits, 10u);
    EXPECT_NEAR(double(srgb.display.peak), 120, 1e-3);
    const DisplayFit pq = fit_display(measure({.peak = 600, .black = 0.01f, .eotf = Eotf::Pq, .bits = 10}), 10);
    EXPECT_EQ(pq.display.eotf, Eotf::Pq);
    EXPECT_NEAR(double(pq.display.peak), 600, 1e-3);
}

// A meter's half a percent of noise leaves a gamma within 0.01 and residuals of that size.
TEST(DisplayFit, NoiseStaysInTheResiduals) {
    const DisplayFit fit = fit_display(measure({.peak = 85, .black = 0.12f, .gamma = 2.31f}, 0.005), 8);
    EXPECT_EQ(fit.display.eotf, Eotf::Gamma);
    EXPECT_NEAR(double(fit.display.gamma), 2.31, 0.01);
    EXPECT_GT(fit.rms, 0.002);
    EXPECT_LT(fit.rms, 0.008);
    ASSERT_EQ(fit.residuals.size(), kCodes.size());
}

TEST(DisplayFit, OthersAreTables) {
    vision::Display odd{.peak = 90,
                        .black = 0.3f,
                        .eotf = Eotf::Table,
                        .table = {{0, double(0.3f)}, {0.1, 0.5}, {0.3, 5}, {0.31, 8}, {0.6, 30}, {1, 90}}};
    const auto measured = measure(odd);
    const DisplayFit fit = fit_display(measured, 8);
    EXPECT_EQ(fit.display.eotf, Eotf::Table);
    EXPECT_LT(fit.largest, 1e-6);
    EXPECT_NO_THROW(vision::check_display(fit.display));
}

// Codes 3 and 4 fall within the noise and 255 was measured twice: a plateau of their mean, and the curve rises.
TEST(DisplayFit, TablesRiseThroughNoise) {
    std::vector<analysis::DisplayMeasurement> measured{{0, 0.1, 1}, {3, 0.102, 2}, {4, 0.101, 3},
                                                       {60, 5, 4},  {255, 100, 5}, {255, 102, 6}};
    const DisplayFit fit = fit_display(measured, 8, Eotf::Table);
    ASSERT_EQ(fit.display.table.size(), 5u);
    for (const size_t i : {1u, 2u}) {
        EXPECT_EQ(std::lround(fit.display.table[i].code * 255), long(i) + 2);
        EXPECT_NEAR(fit.display.table[i].luminance, 0.1015, 2e-7);
    }
    EXPECT_FLOAT_EQ(fit.display.peak, 101);
    EXPECT_NEAR(fit.residuals.back(), -1.0 / 102, 1e-6);
}

// Limited range shown as full range: codes below 16 are black, those above 235 white; the profile says so.
TEST(DisplayFit, CrushedAndClippedCodesStayEqual) {
    std::vector<analysis::DisplayMeasurement> measured;
    for (const uint32_t code : {0u, 4u, 8u, 16u, 17u, 20u, 34u, 68u, 120u, 180u, 230u, 235u, 238u, 250u, 255u})
        measured.push_back(
            {code, 0.05 + 8 * std::pow(std::clamp((code - 16.0) / 219, 0.0, 1.0), 2.2), measured.size() + 1});
    const DisplayFit fit = fit_display(measured, 8);
    EXPECT_EQ(fit.display.eotf, Eotf::Table);
    EXPECT_LT(fit.largest, 2e-6);
    const vision::DisplayCurve curve(fit.display);
    EXPECT_NEAR(curve.emitted(12 / 255.0), 0.05, 1e-6) << "between measured codes of the plateau, too";
    EXPECT_NEAR(curve.emitted(244 / 255.0), 8.05, 1e-4);
    for (double code = 0, before = 0; code <= 1; code += 1.0 / 255)
        EXPECT_GE(curve.emitted(code), before), before = curve.emitted(code);
    EXPECT_NO_THROW(vision::check_display(fit.display));
}

// A meter reads 0 for what it cannot tell: equally black.
TEST(DisplayFit, ZerosAreBlack) {
    const DisplayFit fit = fit_display(
        std::vector<analysis::DisplayMeasurement>{
            {0, 0, 1}, {5, 0, 2}, {10, 5e-7, 3}, {60, 5, 4}, {120, 20, 5}, {255, 500, 6}},
        8, Eotf::Table);
    EXPECT_FLOAT_EQ(fit.display.black, 1e-6f);
    EXPECT_LT(vision::DisplayCurve(fit.display).emitted(10 / 255.0), 1.1e-6);
    EXPECT_NO_THROW(vision::check_display(fit.display));
}

// The residuals are those of the noise, and the file is read again.
TEST(DisplayFit, PooledTablesAreReadAgain) {
    const TempFolder folder;
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 0.01);
    for (int round = 0; round < 20; ++round) {
        std::string text;
        double least = 0, largest = 0;  // of the noise, relative
        for (uint32_t code = 0; code <= 255; ++code) {
            const double luminance = 0.1 + 90 * std::pow(code / 255.0, 2.6) + 9 * (code / 255.0),
                         factor = 1 + noise(random);
            least = std::min(least, factor - 1), largest = std::max(largest, factor - 1);
            text += std::to_string(code) + "," + std::to_string(luminance * factor) + "\n";
        }
        const auto measured = analysis::read_display_measurements(folder.write("m.csv", text), 8);
        const DisplayFit fit = fit_display(measured, 8, Eotf::Table);
        EXPECT_LT(fit.largest, largest - least);
        EXPECT_LT(fit.rms, 0.011);
        const vision::Display again = scene::read_display(folder.write("d.json", scene::display_json(fit.display, "")));
        ASSERT_EQ(again.table.size(), fit.display.table.size());
        for (size_t i = 0; i < again.table.size(); ++i)
            EXPECT_EQ(again.table[i].luminance, fit.display.table[i].luminance);
    }
}

TEST(DisplayFit, ReadsWhatSpreadsheetsWrite) {
    const TempFolder folder;
    for (const char* text : {"code,cd_m2\n0,0.1\n128,22\n255,100\n", "0;0,1\r\n128;22\r\n255;100\r\n",
                             "# wall\n255\t100\n\n0\t0.1  # black\n128\t22\n", "0 0.1\n128 22\n255 100"}) {
        const auto measured = analysis::read_display_measurements(folder.write("m.csv", text), 8);
        ASSERT_EQ(measured.size(), 3u) << text;
        double sum = 0;
        for (const auto& m : measured) sum += m.luminance;
        EXPECT_NEAR(sum, 122.1, 1e-9) << text;
    }
}

TEST(DisplayFit, NonsenseIsRefusedWhereItStands) {
    const TempFolder folder;
    const std::pair<const char*, const char*> cases[]{
        {"0,0.1\n128,22\n", "line 2: "},
        {"0,0.1\n128,abc\n255,9\n", "line 2: "},
        {"0,0.1\n300,22\n255,9\n", "line 2: "},
        {"0,0.1\n-1,22\n255,9\n", "line 2: "},
        {"0,0.1\n1.5,22\n255,9\n", "line 2: "},
        {"0,0.1\n128,-3\n255,9\n", "line 2: "},
        {"0,0.1\n128,nan\n255,9\n", "line 2: "},
        {"0,0.1\n128,\n255,9\n", "line 2: "},
        {"0,0.1\n50,20\n128,5\n255,100\n", "line 3: "},
        {"5,0.1\n128,22\n255,100\n", "code 0"},
        {"0,0.1\n128,22\n254,100\n", "255"},
        {"0,99\n128,99.5\n255,100\n", "line 1: "},
        {"0,0\n128,0.01\n255,0.02\n", "line 3: "},
        {"", "line 1: "},
        {"0,0.1\ncode,cd\n255,9\n", "line 2: "},
        {"0,0.1\n128\n255,9\n", "line 2: "},
        {"0,0.1\n200,60\n240,88\n240,1\n255,100\n", "line 4: code 240 has another luminance than in line 3"},
        {"0,0.1\n240,70\n200,60\n240,88\n255,100\n", "line 4: code 240 has another luminance than in line 2"},
        {"0,0.1\n240,88\n200,100\n240,87\n255,120\n", "line 4: code 240 is darker than code 200 in line 3"}};
    for (const auto& [text, place] : cases) {
        const auto file = folder.write("m.csv", text);
        const std::string complaint = complaint_of([&] { analysis::read_display_measurements(file, 8); });
        EXPECT_TRUE(contains(complaint, "m.csv: ")) << text;
        EXPECT_TRUE(contains(complaint, place)) << text;
    }
    EXPECT_THROW(analysis::read_display_measurements(folder / "none.csv", 8), Error);
}

}  // namespace
}  // namespace vesper::test
