// `vesper saliency` as people run it. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "io/read_file.h"
#include "support/exr_files.h"
#include "support/program.h"

namespace vesper::test {
namespace {

io::HdrImage even(uint32_t width, uint32_t height, float luminance) {
    return {width, height, std::vector<float>(size_t{3} * width * height, luminance), 0, {}};
}

void fill(io::HdrImage& image, uint32_t x, uint32_t y, uint32_t side, float luminance) {
    for (uint32_t v = y; v < y + side; ++v)
        for (uint32_t u = x; u < x + side; ++u)
            for (size_t c = 0; c < 3; ++c) image.rgb[3 * (size_t{v} * image.width + u) + c] = luminance;
}

class SaliencyProgram : public ProgramTest {
protected:
    nlohmann::json json(const std::string& name) { return nlohmann::json::parse(read_text(folder / name)); }
};

// A bright square, a dimmer one, and pixels that are not numbers.
TEST_F(SaliencyProgram, FindsTheBrightestPlaceFirst) {
    io::HdrImage image = even(400, 300, 0.5f);
    fill(image, 294, 70, 20, 200), fill(image, 88, 190, 20, 5);
    fill(image, 0, 280, 8, std::numeric_limits<float>::quiet_NaN());
    write_layout(folder / "a.exr", image, {.white_luminance = 1});
    ASSERT_EQ(run("saliency a.exr --fov 30 --peaks 2 --radius 4 -o map.png --json found.json"), 0) << said;
    EXPECT_EQ(said, "note: a.exr: 64 pixels are not finite or of negative luminance: taken for no light\n");
    const nlohmann::json found = json("found.json");
    ASSERT_EQ(found["places"].size(), 2u);
    const nlohmann::json &first = found["places"][0], &second = found["places"][1];
    EXPECT_NEAR(first["x_px"].get<double>(), 304, 17);
    EXPECT_NEAR(first["y_px"].get<double>(), 80, 17);
    const double focal = 150 / std::tan(15 * 3.14159265358979 / 180);  // px
    EXPECT_NEAR(first["right_deg"].get<double>(),
                std::atan((first["x_px"].get<double>() - 200) / focal) * 180 / 3.14159265358979, 1e-4);
    EXPECT_GT(first["up_deg"].get<double>(), 0);
    EXPECT_EQ(first["saliency"], 1);
    EXPECT_NEAR(first["brightest_cd_m2"].get<double>(), 200, 1e-3);
    EXPECT_EQ(first["on_display"], 1) << found.dump();
    EXPECT_NEAR(second["x_px"].get<double>(), 98, 17);
    EXPECT_GT(found["rank_correlation"].get<double>(), 0.3);
    EXPECT_EQ(found["pairs_of_levels"], 6);
    EXPECT_NE(printed.find("1 on the display"), std::string::npos) << printed;
    EXPECT_NE(printed.find("irawan: rank correlation"), std::string::npos) << printed;
    EXPECT_GT(io::decode_image(io::read_file(folder / "map.png", 1u << 28), 32768).width, 400u);
}

// Of each kind of damage; a dark pixel, and one of a colour outside of the gamut, are none.
TEST_F(SaliencyProgram, NotesPixelsWithoutMeaning) {
    const float inf = std::numeric_limits<float>::infinity();
    for (const auto& [value, noted] : {std::pair(-1.0f, true), {inf, true}, {-inf, true}, {0.0f, false}}) {
        io::HdrImage image = even(400, 300, 0.5f);
        fill(image, 294, 70, 20, 200), fill(image, 10, 10, 1, value);
        image.rgb[0] = -0.1f;
        write_layout(folder / "a.exr", image, {.white_luminance = 1});
        ASSERT_EQ(run("saliency a.exr --fov 30 --peaks 1 -o map.png"), 0) << said;
        EXPECT_EQ(said,
                  noted ? "note: a.exr: 1 pixels are not finite or of negative luminance: taken for no light\n" : "")
            << value;
    }
}

TEST_F(SaliencyProgram, WritesTheMapAsValues) {
    io::HdrImage image = even(400, 300, 0.5f);
    fill(image, 296, 72, 16, 200), fill(image, 88, 190, 16, 5);
    write_layout(folder / "a.exr", image, {.white_luminance = 1});
    ASSERT_EQ(run("saliency a.exr --fov 30 --peaks 2 --radius 4 -o map.exr --json found.json"), 0) << said;
    const io::HdrImage map = io::read_exr(folder / "map.exr");
    ASSERT_EQ(map.width, 25u);
    ASSERT_EQ(map.height, 19u) << "300 px: the last row of squares is not full";
    const auto greatest = size_t(std::max_element(map.rgb.begin(), map.rgb.end()) - map.rgb.begin()) / 3;
    const nlohmann::json places = json("found.json")["places"];
    ASSERT_EQ(places.size(), 2u);
    const auto texel = [&](const nlohmann::json& place) {
        return size_t(place["y_px"].get<double>() / 16) * 25 + size_t(place["x_px"].get<double>() / 16);
    };
    EXPECT_EQ(texel(places[0]), greatest);
    EXPECT_NEAR(map.rgb[3 * texel(places[1])] / map.rgb[3 * greatest], places[1]["saliency"].get<double>(), 1e-6)
        << "of the scene, not of the display";
    EXPECT_EQ(map.white_luminance, 0) << "not luminance";
}

TEST_F(SaliencyProgram, SaysWhereNothingStandsOut) {
    write_layout(folder / "even.exr", even(260, 256, 3), {.white_luminance = 1});
    ASSERT_EQ(run("saliency even.exr --fov 30 -o map.png --json found.json"), 0) << said;
    EXPECT_NE(printed.find("nothing stands out of the picture"), std::string::npos) << printed;
    EXPECT_TRUE(json("found.json")["places"].empty());
    EXPECT_TRUE(json("found.json")["rank_correlation"].is_null());
}

TEST_F(SaliencyProgram, SmallPicturesAreNotedOrRefused) {
    io::HdrImage image = even(80, 70, 1);
    fill(image, 20, 20, 10, 30);
    write_layout(folder / "small.exr", image, {.white_luminance = 1});
    ASSERT_EQ(run("saliency small.exr --fov 30 -o map.png"), 0) << said;
    EXPECT_NE(said.find("only 3 of 6 pairs"), std::string::npos) << said;
    write_layout(folder / "tiny.exr", even(31, 70, 1), {.white_luminance = 1});
    expect_refused("saliency tiny.exr --fov 30 -o tiny.png", {"tiny.exr", "31 x 70 px", "32 px"});
    EXPECT_FALSE(exists("tiny.png"));
    write_layout(folder / "nan.exr", even(64, 64, std::numeric_limits<float>::quiet_NaN()), {.white_luminance = 1});
    expect_refused("saliency nan.exr --fov 30 -o nan.png", {"nan.exr", "no light"});
    expect_refused("saliency small.exr -o map.jpg", {".png"});
    expect_refused("saliency small.exr -o map.png --operator ldr", {"ldr"});
    expect_refused("saliency none.exr -o map.png", {"none.exr"});
}

}  // namespace
}  // namespace vesper::test
