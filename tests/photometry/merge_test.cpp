// Photographs of known scenes merged, against the scenes. SPDX-License-Identifier: MIT
#include "photometry/merge.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "photometry/brackets.h"
#include "support/shared_data.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using io::HdrImage;
using photometry::Exposure, photometry::gamma_response, photometry::merge_exposures;

HdrImage every_fourth(const HdrImage& image) {
    HdrImage made{image.width / 4, image.height / 4};
    for (size_t y = 0; y < made.height; ++y)
        for (size_t x = 0; x < made.width; ++x) {
            const float* p = &image.rgb[3 * (4 * y * image.width + 4 * x)];
            made.rgb.insert(made.rgb.end(), p, p + 3);
        }
    return made;
}

TEST(Merge, RecoversRadianceWithinFivePercent) {
    const HdrImage scene = night(320, 240);
    struct {
        const char* name;
        KnownCamera camera;
        double ratio;
        int count;
    } cases[] = {{"gamma", gamma_camera(), 4, 8},
                 {"sRGB", srgb_camera(), 4, 8},
                 {"film", film_camera(), 4, 8},
                 {"film, one stop", film_camera(), 2, 16}};
    for (const auto& c : cases) {
        const auto exposures = bracket(scene, c.camera, 0.005, c.ratio, c.count);
        const photometry::MergedImage merged =
            merge_exposures(exposures, photometry::recover_response(exposures).response);
        const RadianceError error = radiance_error(merged, scene, c.camera, exposures);
        EXPECT_GT(error.values, scene.rgb.size() * 95 / 100) << c.name;
        EXPECT_LT(error.worst, 0.05) << c.name;
        EXPECT_LT(error.median, 0.01) << c.name;
        EXPECT_GT(std::log10(merged.brightest / merged.darkest), 4.5) << c.name;
    }
}

// 95 % of the values: single dark ones are off by more than noise of one code is of code 40, 5.5 % of light where that
// goes with its power 2.2.
TEST(Merge, RecoversRadianceThroughNoiseOfOneCode) {
    std::vector<HdrImage> scenes = {night(160, 120)};
    for (const char* name : {"hdr/polyhaven/dikhololo_night_1k.hdr", "hdr/polyhaven/potsdamer_platz_1k.hdr"})
        if (const std::filesystem::path file = shared_data(name); is_here(file))
            scenes.push_back(every_fourth(io::read_hdr_image(file)));
    for (const HdrImage& scene : scenes)
        for (const KnownCamera& camera : {gamma_camera(1), srgb_camera(1), film_camera(1), filmic_camera(1)})
            for (const auto& [ratio, count] : {std::pair(2, 3), std::pair(2, 5), std::pair(2, 9), std::pair(4, 3),
                                               std::pair(4, 5), std::pair(4, 9)}) {
                // Code 128 in the middle of the bracket is what most of the picture is about.
                std::vector<float> greens;
                for (size_t i = 1; i < scene.rgb.size(); i += 3) greens.push_back(scene.rgb[i]);
                std::nth_element(greens.begin(), greens.begin() + ptrdiff_t(greens.size() / 2), greens.end());
                const double middle = camera.exposure(128 / 255.0, 1) / double(greens[greens.size() / 2]);
                const auto exposures =
                    bracket(scene, camera, middle * std::pow(ratio, -(count - 1) / 2.0), ratio, count);
                const photometry::MergedImage merged =
                    merge_exposures(exposures, photometry::recover_response(exposures).response);
                const RadianceError error = radiance_error(merged, scene, camera, exposures);
                const std::string name = std::to_string(&scene - scenes.data()) + ", " + std::to_string(count) +
                                         " by " + std::to_string(ratio);
                EXPECT_GT(error.values, scene.rgb.size() / 2) << name;
                EXPECT_LT(error.p95, 0.045) << name;
                EXPECT_LT(error.median, 0.0175) << name;
            }
}

TEST(Merge, RecoversASharedPicture) {
    const std::filesystem::path file = shared_data("hdr/polyhaven/dikhololo_night_1k.hdr");
    if (!is_here(file)) GTEST_SKIP() << "the shared set is not here";
    const HdrImage scene = io::read_hdr_image(file);
    for (const KnownCamera& camera : {gamma_camera(), film_camera()}) {
        const auto exposures = bracket(scene, camera, 0.01, 4, 10);
        const photometry::RecoveredResponse recovered = photometry::recover_response(exposures);
        for (size_t c = 0; c < 3; ++c) EXPECT_LT(response_error(recovered.response, camera, c, 16, 239), 0.05);
        const RadianceError error =
            radiance_error(merge_exposures(exposures, recovered.response), scene, camera, exposures);
        EXPECT_GT(error.values, scene.rgb.size() * 9 / 10);
        EXPECT_LT(error.worst, 0.05);
    }
}

TEST(Merge, WithAKnownResponseWeighsByPrecision) {
    // One pixel, three pictures, a linear sensor: ln E = sum p ln(Z / 128 / t) / sum p.
    std::vector<Exposure> exposures(3);
    const uint8_t codes[] = {20, 90, 250};
    const double t[] = {0.25, 1, 4};
    for (size_t i = 0; i < 3; ++i) exposures[i] = {Image{"", 1, 1, {codes[i], codes[i], codes[i], 255}}, t[i], {}};
    const photometry::MergedImage merged = merge_exposures(exposures, gamma_response(1));
    // 1 / slope^2, the slope over 8 codes; less within 32 of an end; 250 is no good code.
    const double weights[] = {20 / 32.0 * std::pow(8 / std::log(24 / 16.0), 2), std::pow(8 / std::log(94 / 86.0), 2)};
    const double wanted =
        (weights[0] * std::log(20 / 128.0 / 0.25) + weights[1] * std::log(90 / 128.0)) / (weights[0] + weights[1]);
    EXPECT_NEAR(merged.image.rgb[1], std::exp(wanted), 1e-6);
    EXPECT_EQ(merged.held[0], 1);
    EXPECT_EQ(merged.image.white_luminance, 0.0);
}

TEST(Merge, CountsWhatNoPictureHolds) {
    // Columns: good; black in all; white in all; black, then white; barely held by code 8.
    const auto picture = [](std::initializer_list<uint8_t> codes, double exposure) {
        Exposure made;
        made.exposure = exposure;
        made.image.width = static_cast<uint32_t>(codes.size());
        made.image.height = 1;
        for (const uint8_t code : codes) made.image.rgba.insert(made.image.rgba.end(), {code, 100, 100, 255});
        return made;
    };
    const std::vector<Exposure> exposures = {picture({50, 0, 255, 3, 7}, 1), picture({200, 0, 255, 255, 8}, 4)};
    const photometry::MergedImage merged = merge_exposures(exposures, gamma_response(1));
    EXPECT_EQ(merged.too_dark, 1u);
    EXPECT_EQ(merged.too_bright, 1u);
    EXPECT_EQ(merged.between, 1u);
    EXPECT_EQ(merged.held, (std::vector<uint8_t>{1, 0, 0, 0, 1}));
    const auto red = [&](size_t x) { return merged.image.rgb[3 * x]; };
    EXPECT_NEAR(red(1), 0.5 / 128 / 4, 1e-7);  // the longest exposure
    EXPECT_NEAR(red(2), 255.0 / 128, 1e-6);    // the shortest
    EXPECT_NEAR(red(3), 3.0 / 128, 1e-6);      // the code nearest to the middle
    EXPECT_NEAR(red(4), 8.0 / 128 / 4, 1e-7);
}

TEST(Merge, ScalesToAKnownLuminance) {
    const HdrImage scene = night(64, 48);
    const auto exposures = bracket(scene, srgb_camera(), 0.005, 4, 8);
    photometry::MergedImage merged = merge_exposures(exposures, photometry::srgb_response());
    const auto luminance_at = [&](const HdrImage& image, size_t x, size_t y) {
        const float* p = image.rgb.data() + 3 * (y * image.width + x);
        return 0.212639 * static_cast<double>(p[0]) + 0.715169 * static_cast<double>(p[1]) +
               0.072192 * static_cast<double>(p[2]);
    };
    double mean = 0;
    for (size_t y = 20; y < 24; ++y)
        for (size_t x = 30; x < 35; ++x) mean += luminance_at(scene, x, y) / 20;
    const double range = merged.brightest / merged.darkest;
    photometry::scale_to_luminance(merged, {30, 20, 5, 4}, mean);
    EXPECT_EQ(merged.image.white_luminance, 1.0);
    EXPECT_NEAR(merged.brightest / merged.darkest, range, 1e-9 * range);
    for (size_t x = 5; x < 60; x += 9)
        EXPECT_NEAR(luminance_at(merged.image, x, 11) / luminance_at(scene, x, 11), 1, 0.05);
    EXPECT_THROW(photometry::scale_to_luminance(merged, {60, 20, 5, 4}, 1), Error);
    EXPECT_THROW(photometry::scale_to_luminance(merged, {-1, 20, 5, 4}, 1), Error);
    EXPECT_THROW(photometry::scale_to_luminance(merged, {0, 0, INT64_MAX, 1}, 1), Error);
    merged.held[20 * 64 + 31] = 0;
    EXPECT_THROW(photometry::scale_to_luminance(merged, {30, 20, 5, 4}, 1), Error);
    EXPECT_THROW(photometry::scale(merged, 0), Error);

    const TempFolder folder;
    io::write_exr(folder / "x.exr", merged.image);
    const HdrImage read = io::read_exr(folder / "x.exr");
    EXPECT_EQ(read.rgb, merged.image.rgb);
    EXPECT_EQ(read.white_luminance, 1.0);
    io::write_exr(folder / "x.exr", merge_exposures(exposures, photometry::srgb_response()).image);
    EXPECT_EQ(io::read_exr(folder / "x.exr").white_luminance, 0.0);
}

TEST(Merge, RefusesPicturesThatDoNotFit) {
    const HdrImage scene = night(16, 12);
    const std::vector<Exposure> good = bracket(scene, gamma_camera(), 0.1, 4, 2);
    std::vector<Exposure> bad = good;
    bad[1].image.width = 12, bad[1].image.height = 16;
    EXPECT_THROW(merge_exposures(bad, gamma_response(1)), Error);
    bad = good;
    bad[1].exposure = 0;
    EXPECT_THROW(merge_exposures(bad, gamma_response(1)), Error);
    EXPECT_THROW(merge_exposures({}, gamma_response(1)), Error);
    EXPECT_THROW(merge_exposures(std::vector<Exposure>(33, good[0]), gamma_response(1)), Error);
    EXPECT_NO_THROW(merge_exposures(std::vector<Exposure>(32, good[0]), gamma_response(1)));
}

TEST(Align, FindsKnownShifts) {
    constexpr int kMargin = 40;
    const HdrImage scene = night(400, 320);
    const std::vector<glm::ivec2> shifts = {{3, -2}, {0, 0}, {-7, 5}, {1, 1}, {12, -9}, {0, 4}, {-20, 17}, {2, 2}};
    CameraNoise random;
    std::vector<Exposure> exposures;
    for (size_t i = 0; i < shifts.size(); ++i)
        exposures.push_back(photograph(scene, gamma_camera(), 0.02 * std::pow(4, i), random, shifts[i], kMargin));
    std::swap(exposures[1], exposures[6]);  // the order of files is not that of exposures
    photometry::estimate_shifts(exposures);
    std::swap(exposures[1], exposures[6]);
    const glm::ivec2 reference = shifts[4];  // the middle exposure
    for (size_t i = 0; i < shifts.size(); ++i) EXPECT_EQ(exposures[i].shift, shifts[i] - reference) << i;

    // Aligned pictures merge as if they had never moved, away from the borders.
    const auto inner_error = [&](const photometry::MergedImage& merged) {
        double sum = 0;
        int count = 0;
        for (int y = 40; y < 200; ++y)
            for (int x = 40; x < 280; ++x) {
                if (!merged.held[static_cast<size_t>(y * 320 + x)]) continue;
                ++count;
                const float* p =
                    scene.rgb.data() + 3 * ((y + kMargin - reference.y) * 400 + x + kMargin - reference.x) + 1;
                sum +=
                    std::abs(std::log(static_cast<double>(merged.image.rgb[3 * static_cast<size_t>(y * 320 + x) + 1]) *
                                      std::pow(128 / 255.0, 2.2) / static_cast<double>(*p)));
            }
        EXPECT_GT(count, 30000);
        return sum / count;
    };
    EXPECT_LT(inner_error(merge_exposures(exposures, gamma_response(2.2))), 0.01);
    for (Exposure& exposure : exposures) exposure.shift = glm::ivec2(0);
    EXPECT_GT(inner_error(merge_exposures(exposures, gamma_response(2.2))), 0.05);
}

TEST(Align, LeavesStillPicturesAlone) {
    std::vector<Exposure> exposures = bracket(night(100, 75), film_camera(2), 0.005, 4, 8);
    photometry::estimate_shifts(exposures);
    for (const Exposure& exposure : exposures) EXPECT_EQ(exposure.shift, glm::ivec2(0));
    std::vector<Exposure> tiny = {{Image{"", 1, 1, {5, 5, 5, 255}}, 1, {}},
                                  {Image{"", 1, 1, {90, 90, 90, 255}}, 2, {}}};
    photometry::estimate_shifts(tiny);
    EXPECT_EQ(tiny[0].shift, glm::ivec2(0));
    photometry::estimate_shifts({});
}

TEST(Align, UncoveredPixelsAreBlackOrOfTheReference) {
    std::vector<Exposure> exposures = {{Image{"", 2, 1, {100, 100, 100, 255, 50, 50, 50, 255}}, 1, {}}};
    exposures[0].shift = {1, 0};
    const photometry::MergedImage merged = merge_exposures(exposures, gamma_response(1));
    EXPECT_NEAR(merged.image.rgb[0], 50 / 128.0, 1e-6);
    EXPECT_EQ(merged.image.rgb[3], 0);
    EXPECT_EQ(merged.held, (std::vector<uint8_t>{1, 0}));
}

TEST(Merge, ExposuresFollowFromCameras) {
    using Pictures = std::vector<std::pair<std::string, io::CameraExposure>>;
    const std::vector<double> found =
        photometry::relative_exposures(Pictures{{"a", {0.1, 2.0, 100}}, {"b", {0.2, 4.0, 400}}});
    EXPECT_NEAR(found[1] / found[0], 2.0 * 4 / 4, 1e-12);
    EXPECT_NEAR(photometry::relative_exposures(Pictures{{"a", {0.1, {}, {}}}, {"b", {0.4, {}, {}}}})[1], 0.4, 1e-12);
    EXPECT_THROW(photometry::relative_exposures(Pictures{{"a", {0.1, 2.0, 100}}, {"b", {{}, 4.0, 400}}}), Error);
    EXPECT_THROW(photometry::relative_exposures(Pictures{{"a", {0.1, 2.0, 100}}, {"b", {0.1, {}, 400}}}), Error);
    EXPECT_THROW(photometry::relative_exposures(Pictures{{"a", {0.1, 2.0, 100}}, {"b", {0.1, 2.0, {}}}}), Error);
}

}  // namespace
}  // namespace vesper::test
