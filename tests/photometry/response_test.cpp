// Responses recovered from photographs of a known camera; known responses; their files. SPDX-License-Identifier: MIT
#include "photometry/response.h"

#include "photometry/brackets.h"
#include "support/complaints.h"
#include "support/temp_folder.h"

namespace vesper::test {
namespace {

using photometry::recover_response;

TEST(Response, IsRecoveredWithinFivePercent) {
    const io::HdrImage scene = night(320, 240);
    struct {
        const char* name;
        KnownCamera camera;
        double ratio;
        int count;
    } cases[] = {{"gamma, one stop", gamma_camera(), 2, 16}, {"gamma, two stops", gamma_camera(), 4, 8},
                 {"sRGB, one stop", srgb_camera(), 2, 16},   {"sRGB, two stops", srgb_camera(), 4, 8},
                 {"film, one stop", film_camera(), 2, 16},   {"film, two stops", film_camera(), 4, 8},
                 {"film, noise", film_camera(1), 2, 16},     {"film, more noise", film_camera(2.5), 2, 16}};
    for (const auto& c : cases) {
        const photometry::RecoveredResponse recovered =
            recover_response(bracket(scene, c.camera, 0.005, c.ratio, c.count));
        for (size_t channel = 0; channel < 3; ++channel) {
            EXPECT_LT(response_error(recovered.response, c.camera, channel, 16, 239), 0.05)
                << c.name << ", channel " << channel;
            EXPECT_EQ(recovered.response.ln_exposure[channel][128], 0.0);
            EXPECT_EQ(recovered.falls[channel], 0) << c.name;
            EXPECT_GT(recovered.pixels[channel], 1000u) << c.name;
            // What is left is quantisation and noise, in codes, times the slope of the response.
            EXPECT_LT(recovered.error[channel], 0.015 + 0.035 * c.camera.noise) << c.name;
        }
    }
}

TEST(Response, DoesNotFitAnotherCamera) {
    const io::HdrImage scene = night(160, 120);
    const photometry::RecoveredResponse film = recover_response(bracket(scene, film_camera(), 0.005, 4, 8));
    EXPECT_GT(response_error(film.response, gamma_camera(), 0, 16, 239), 0.2);
    EXPECT_GT(response_error(film.response, film_camera(), 0, 0, 255), 0.02);  // the ends are not recovered
}

TEST(Response, NoticesPicturesThatDoNotAgree) {
    const io::HdrImage scene = night(160, 120);
    std::vector<photometry::Exposure> exposures = bracket(scene, gamma_camera(), 0.005, 4, 8);
    const double good = recover_response(exposures).error[1];
    CameraNoise random;
    exposures[4] = photograph(scene, gamma_camera(), exposures[4].exposure, random, {40, 0});
    EXPECT_GT(recover_response(exposures).error[1], 0.15);
    EXPECT_LT(good, 0.02);
}

TEST(Response, UsesShifts) {
    const io::HdrImage scene = night(160, 120);
    std::vector<photometry::Exposure> exposures = bracket(scene, gamma_camera(), 0.005, 4, 8);
    CameraNoise random;
    exposures[4] = photograph(scene, gamma_camera(), exposures[4].exposure, random, {7, -5});
    exposures[4].shift = {7, -5};
    EXPECT_LT(recover_response(exposures).error[1], 0.02);
}

TEST(Response, IsRefusedWhereItIsNotDetermined) {
    const io::HdrImage scene = night(64, 48);
    const std::vector<photometry::Exposure> good = bracket(scene, gamma_camera(), 0.02, 4, 4);
    EXPECT_NO_THROW(recover_response(good));
    EXPECT_THROW(recover_response(std::span(good).first(1)), Error);
    EXPECT_THROW(recover_response(std::vector<photometry::Exposure>(3, good[2])), Error);
    std::vector<photometry::Exposure> black = good;
    for (photometry::Exposure& exposure : black)
        std::fill(exposure.image.rgba.begin(), exposure.image.rgba.end(), uint8_t{0});
    EXPECT_THROW(recover_response(black), Error);
}

TEST(Response, KnownOnesAreTheirFormulas) {
    const auto linear = photometry::gamma_response(1).ln_exposure[2];
    EXPECT_NEAR(std::exp(linear[255] - linear[51]), 5, 1e-9);
    EXPECT_EQ(linear[128], 0.0);
    EXPECT_NEAR(std::exp(photometry::gamma_response(2.2).ln_exposure[0][255]), std::pow(255.0 / 128, 2.2), 1e-9);
    const auto srgb = photometry::srgb_response().ln_exposure[1];
    EXPECT_NEAR(std::exp(srgb[128] - srgb[255]), 0.2158605, 1e-6);  // IEC 61966-2-1
    EXPECT_NEAR(std::exp(srgb[5] - srgb[255]), 5 / 255.0 / 12.92, 1e-9);
    EXPECT_TRUE(std::isfinite(srgb[0]) && srgb[0] < srgb[1]);
}

TEST(Response, CountsFalls) {
    photometry::Response response = photometry::gamma_response(2.2);
    EXPECT_EQ(photometry::count_falls(response), (std::array<int, 3>{0, 0, 0}));
    std::swap(response.ln_exposure[1][100], response.ln_exposure[1][101]);
    std::swap(response.ln_exposure[2][0], response.ln_exposure[2][1]);  // the ends are extrapolated
    EXPECT_EQ(photometry::count_falls(response), (std::array<int, 3>{0, 1, 0}));
}

TEST(Response, FilesComeBackOrSayWhyNot) {
    const TempFolder folder;
    photometry::Response response = photometry::srgb_response();
    response.ln_exposure[0][7] = -3.25;
    response.ln_exposure[2][255] = 2.5;
    photometry::write_response(folder / "r.csv", response);
    const photometry::Response read = photometry::read_response(folder / "r.csv");
    for (size_t c = 0; c < 3; ++c)
        for (size_t z = 0; z < 256; ++z) EXPECT_NEAR(read.ln_exposure[c][z], response.ln_exposure[c][z], 1e-8);
    const std::string text = read_text(folder / "r.csv");
    const auto refused = [&](std::string changed, const std::string& reason) {
        folder.write("bad.csv", changed);
        try {
            photometry::read_response(folder / "bad.csv");
            ADD_FAILURE() << reason;
        } catch (const Error& error) {
            EXPECT_TRUE(contains(error.what(), "bad.csv: ") && contains(error.what(), reason)) << error.what();
        }
    };
    const auto replaced = [&](const std::string& what, const std::string& with) {
        std::string changed = text;
        return changed.replace(changed.find(what), what.size(), with);
    };
    refused("", "is not a response curve");
    refused("code,", "line 1: the headings");
    refused("code,r,g,b\n", "line 2");
    refused(replaced("ln_exposure_r", "log10_exposure_r"), "line 1: the headings");
    refused(replaced("ln_exposure_g", "ln_exposure_r"), "line 1: the headings");
    refused(text + "256,1,1,1\n", "line 258: nothing is expected after code 255");
    refused(text + "\nthe end", "line 259");
    refused(text.substr(0, text.size() / 2), "line 1");
    refused(replaced("\n9,", "\n10,"), "line 11: expected 9");
    refused(replaced("-3.25", "nan"), "line 9");
    refused(replaced("-3.25", "-325"), "line 9");
    refused(replaced("-3.25,", "-3.25,1,"), "line 9");
    EXPECT_THROW(photometry::read_response(folder / "none.csv"), Error);
    folder.write("crlf.csv", replaced("\n9,", "\r\n 9 , "));
    EXPECT_NO_THROW(photometry::read_response(folder / "crlf.csv"));
    // Columns go by their names.
    for (const char* headings :
         {"code,ln_exposure_b,ln_exposure_g,ln_exposure_r", "code, B, G, R", "code,g(blue),g(green),g(red)"}) {
        folder.write("swapped.csv", replaced("code,ln_exposure_r,ln_exposure_g,ln_exposure_b", headings) + "\n\n");
        const photometry::Response swapped = photometry::read_response(folder / "swapped.csv");
        for (size_t c = 0; c < 3; ++c) EXPECT_EQ(swapped.ln_exposure[c], read.ln_exposure[2 - c]) << headings;
    }
}

}  // namespace
}  // namespace vesper::test
