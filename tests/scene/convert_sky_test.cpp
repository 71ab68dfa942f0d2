// Skies, directional lights and retroreflection, from the photometry file to the scene that is read.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "base/angle.h"
#include "io/hdr_image.h"
#include "scene/colour.h"
#include "scene/photometry.h"
#include "support/conversion.h"

namespace vesper::test {
namespace {

using nlohmann::json;

io::HdrImage picture(uint32_t width, uint32_t height, float value, double white = 0) {
    return {.width = width,
            .height = height,
            .rgb = std::vector<float>(size_t(3) * width * height, value),
            .white_luminance = white,
            .header = {}};
}

class ConvertSky : public ConversionTest {
protected:
    ConvertSky() {
        street_.root["materials"] = {{{"name", "sign"}}, {{"name", "marking"}}, {{"name", "wall"}}};
        const size_t position = street_.vec3({0, 0, 0, 20, 0, 0, 0, 20, 0});
        for (int material : {0, 1, 2}) street_.show({{"attributes", {{"POSITION", position}}}, {"material", material}});
        // A sky that is brighter to the right of the centre, with one lamp.
        io::HdrImage image = picture(64, 32, 0.5f);
        for (size_t i = 0; i < image.rgb.size(); ++i)
            if (i / 3 % 64 >= 32) image.rgb[i] = 1;
        image.rgb[3 * (5 * 64 + 7)] = 4000;
        io::write_exr(folder_ / "night.exr", image);
    }

    photometry::Environment sky() const { return converted().environment.value(); }
    std::string complaint_with(const json& photometry) {
        return complaint_of([&] { convert_with(photometry); });
    }
};

// 0.018 to 0.024 cd/m^2 over a big city, 0.1 to 1 lx in towns.
TEST_F(ConvertSky, WhatIsNotStatedIsANightInTown) {
    const scene::PhotometryReport report = convert_with(json::object());
    EXPECT_TRUE(mentions(report.changes, "not stated"));
    const scene::Scene scene = converted();
    EXPECT_FLOAT_EQ(scene.sky_luminance, 0.02f);
    EXPECT_FLOAT_EQ(scene.ambient_illuminance, 0.1f);
    EXPECT_FALSE(scene.environment);
    const json dark = {{"sky", {{"luminance_cd_m2", 0}}}, {"ambient", {{"illuminance_lx", 0}}}};
    EXPECT_FALSE(mentions(convert_with(dark).changes, "not stated"));
    EXPECT_EQ(converted().sky_luminance, 0);
    EXPECT_EQ(converted().ambient_illuminance, 0);
}

TEST_F(ConvertSky, APictureGoesIntoTheFile) {
    for (const char* output : {"out.gltf", "out.glb"}) {
        SCOPED_TRACE(output);
        const scene::PhotometryReport report =
            convert_with({{"sky", {{"image", "night.exr"}, {"scale", 0.02}, {"rotation_deg", 90}}}}, output);
        EXPECT_TRUE(mentions(report.changes, "night.exr"));
        std::filesystem::rename(folder_ / "night.exr", folder_ / "away.exr");
        const scene::Scene scene = converted(output);
        std::filesystem::rename(folder_ / "away.exr", folder_ / "night.exr");
        ASSERT_TRUE(scene.environment);
        const photometry::Environment& e = *scene.environment;
        EXPECT_EQ(e.width, 64u);
        EXPECT_NEAR(e.rotation, std::numbers::pi / 2, 1e-6);
        EXPECT_EQ(scene.ambient_illuminance, 0) << "the picture lights";
        // Half floats: 5e-4. The lamp reaches 80 cd/m^2, the dim half 0.01.
        EXPECT_NEAR(e.rgb[3 * (5 * 64 + 7)] / 80, 1, 5e-4);
        EXPECT_NEAR(photometry::luminance_of(e, {0.1, 0, 1}).g / 0.02, 1, 2e-3)
            << "azimuth 180 is 90 to the right of the centre";
        EXPECT_NEAR(photometry::luminance_of(e, {0.1, 0, -1}).g / 0.01, 1, 2e-3);
    }
}

TEST_F(ConvertSky, IsScaledToWhatIsStated) {
    convert_with({{"sky", {{"image", "night.exr"}, {"luminance_cd_m2", 0.3}}}});
    EXPECT_NEAR(photometry::sky_luminance(sky()), 0.3, 1e-3 * 0.3);
    convert_with({{"sky", {{"image", "night.exr"}, {"illuminance_lx", 0.25}}}});
    EXPECT_NEAR(photometry::horizontal_illuminance(sky()), 0.25, 1e-3 * 0.25);
    convert_with({{"sky", {{"image", "night.exr"}, {"luminance_cd_m2", 0}}}});
    EXPECT_EQ(photometry::sky_luminance(sky()), 0);
    // A picture that says how bright its white is needs nothing.
    io::write_exr(folder_ / "white.exr", picture(4, 2, 0.5f, 3));
    convert_with({{"sky", {{"image", "white.exr"}}}});
    EXPECT_NEAR(photometry::sky_luminance(sky()), 1.5, 1e-3);
}

TEST_F(ConvertSky, TheMoon) {
    street_.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
    street_.root["scene"] = 0;
    const json moon = {{"name", "moon"},
                       {"illuminance_lx", 0.25},
                       {"azimuth_deg", 90},
                       {"elevation_deg", 30},
                       {"colour_temperature_K", 4100}};
    const json dusk = {{"illuminance_lx", 3}, {"direction", {0, -2, 0}}, {"angular_diameter_deg", 4}};
    convert_with({{"directional", {moon, dusk}}});
    const scene::Scene scene = converted();
    ASSERT_EQ(scene.lamps.size(), 2u);
    EXPECT_EQ(scene.lamps[0].kind, scene::Lamp::Kind::Directional);
    EXPECT_NEAR(scene.lamps[0].intensity, 0.25, 1e-6);
    EXPECT_NEAR(scene.lamps[0].colour.b, scene::colour_of_temperature(4100).b, 1e-5);
    EXPECT_NEAR(scene.lamps[0].angular_diameter, 0.00925, 1e-5) << "that of sun and moon";
    EXPECT_NEAR(scene.lamps[1].angular_diameter, 4 * kRadiansPerDegree, 1e-6);
    const std::vector<glm::dmat4> world = scene::world_transforms(scene, 0);
    std::vector<glm::vec3> ways;
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].lamp != scene::kNone) ways.push_back(-glm::vec3(world[i][2]));
    ASSERT_EQ(ways.size(), 2u);
    EXPECT_NEAR(glm::distance(ways[0], glm::vec3(-std::sqrt(0.75f), -0.5f, 0)), 0, 1e-6) << "from +X, 30 degrees up";
    EXPECT_NEAR(glm::distance(ways[1], glm::vec3(0, -1, 0)), 0, 1e-6);
}

TEST_F(ConvertSky, Retroreflection) {
    const json rules = {
        {{"materials", "sign"}, {"retroreflection", {{"class", "RA2"}, {"scale", 1.5}}}},
        {{"materials", "marking"}, {"retroreflection", {{"r_l_mcd", 150}}}},
        {{"materials", "wall"}, {"retroreflection", {{"table", {{"observation_deg", {0.1, 1}}, {"r_a", {90, 9}}}}}}}};
    const auto report = convert_with({{"surfaces", rules}});
    EXPECT_TRUE(mentions(report.changes, "retroreflection RA2"));
    EXPECT_FALSE(mentions(report.warnings, "R_L is"));
    const scene::Scene scene = converted();
    ASSERT_EQ(scene.retroreflectors.size(), 3u);
    const auto of = [&](size_t material) { return scene.retroreflectors.at(scene.materials[material].retroreflector); };
    EXPECT_NEAR(photometry::retroreflection(of(0), 0.33, 5), 270, 1e-9);
    EXPECT_TRUE(of(1).marking);
    EXPECT_NEAR(photometry::retroreflection(of(1), 1.05, 88), 0.15, 1e-9);
    EXPECT_NEAR(photometry::retroreflection(of(2), 0.1, 5), 90, 1e-9);
    const json grey = {
        {"materials", "marking"}, {"reflectance_scale", 0.55}, {"retroreflection", {{"r_l_mcd", 150}, {"scale", 2}}}};
    EXPECT_TRUE(mentions(convert_with({{"surfaces", json::array({grey})}}).warnings,
                         "R_L is 165 mcd/(m^2 lx): what is stated, times the base colour of 0.55"));
}

TEST_F(ConvertSky, RefusesWithPlaceAndReason) {
    io::write_exr(folder_ / "square.exr", picture(4, 4, 1));
    io::write_exr(folder_ / "black.exr", picture(4, 2, 0));
    const auto sky_rule = [&](json s) { return complaint_with({{"sky", std::move(s)}}); };
    EXPECT_TRUE(contains(sky_rule({{"image", "missing.exr"}}), "p.json: /sky/image: "));
    EXPECT_TRUE(contains(sky_rule({{"image", "square.exr"}}), "twice as wide"));
    EXPECT_TRUE(contains(sky_rule({{"image", "black.exr"}, {"illuminance_lx", 1}}), "/sky"));
    EXPECT_TRUE(
        contains(sky_rule({{"image", "night.exr"}, {"scale", 1}, {"luminance_cd_m2", 1}}), "/sky/luminance_cd_m2: "));
    EXPECT_TRUE(
        contains(sky_rule({{"image", "night.exr"}, {"scale", 1}, {"illuminance_lx", 1}}), "/sky/illuminance_lx: "));
    EXPECT_TRUE(contains(sky_rule({{"image", "night.exr"}, {"colour_rgb", {1, 1, 1}}}), "unknown key"));
    const auto moon = [&](json m) { return complaint_with({{"directional", json::array({std::move(m)})}}); };
    EXPECT_TRUE(contains(moon({{"illuminance_lx", 1}}), "azimuth_deg"));
    EXPECT_TRUE(contains(moon({{"illuminance_lx", 1}, {"direction", {0, 0, 0}}}), "/directional/0/direction"));
    EXPECT_TRUE(contains(moon({{"illuminance_lx", 1}, {"direction", {0, 1, 0}}, {"azimuth_deg", 1}}), "azimuth_deg"));
    EXPECT_TRUE(contains(moon({{"illuminance_lx", -1}, {"direction", {0, 1, 0}}}), "illuminance_lx"));
    EXPECT_TRUE(contains(moon({{"illuminance_lx", 1}, {"direction", {0, 1, 0}}, {"angular_diameter_deg", 11}}),
                         "/directional/0/angular_diameter_deg"));
    const auto sheet = [&](json r) {
        const json rule = {{"materials", "sign"}, {"retroreflection", std::move(r)}};
        return complaint_with({{"surfaces", json::array({rule})}});
    };
    EXPECT_TRUE(contains(sheet({{"class", "RA7"}}), "/surfaces/0/retroreflection/class: is none of"));
    EXPECT_TRUE(contains(sheet({{"class", "RA1"}, {"r_l_mcd", 100}}), "one of"));
    EXPECT_TRUE(contains(sheet(json::object()), "one of"));
    EXPECT_TRUE(contains(sheet({{"table", {{"observation_deg", {1, 0.1}}, {"r_a", {90, 9}}}}}), "ascend"));
    EXPECT_TRUE(contains(sheet({{"table", {{"observation_deg", {0.1, 1}}, {"r_a", {9, 90}}}}}), "falling"));
    const json both = {{"materials", "sign"}, {"reflection_table", "R3"}, {"retroreflection", {{"class", "RA1"}}}};
    EXPECT_TRUE(contains(complaint_with({{"surfaces", json::array({both})}}), "beside reflection_table"));
    json nine = json::array();
    for (int i = 1; i <= 9; ++i) {
        street_.root["materials"].push_back({{"name", "s" + std::to_string(i)}});
        nine.push_back({{"materials", "s" + std::to_string(i)}, {"retroreflection", {{"class", "RA1"}, {"scale", i}}}});
    }
    EXPECT_TRUE(contains(complaint_with({{"surfaces", nine}}), "9 kinds of retroreflection"));
}

// A damaged converted file is refused as well.
TEST_F(ConvertSky, TheReaderChecks) {
    const json rule = {{"materials", "sign"}, {"retroreflection", {{"class", "RA1"}}}};
    convert_with({{"sky", {{"image", "night.exr"}}}, {"surfaces", json::array({rule})}});
    const json good = json::parse(read_text(folder_ / "out.gltf"));
    const auto complaint = [&](const char* pointer, const json& value) -> std::string {
        json bad = good;
        bad[json::json_pointer(std::string("/extras/vesper/") + pointer)] = value;
        return complaint_of([&] { scene::read_scene(folder_.write("bad.gltf", bad.dump())); });
    };
    EXPECT_EQ(complaint("environment/scale", 2), "");
    EXPECT_TRUE(contains(complaint("environment/width", 66), "twice the height"));
    EXPECT_TRUE(contains(complaint("environment/width", 4096), "environment/width"));
    EXPECT_TRUE(contains(complaint("environment/bufferView", 99), "bufferView"));
    EXPECT_TRUE(contains(complaint("environment/bufferView", 0), "three half floats"));
    EXPECT_TRUE(contains(complaint("environment/scale", -1), "scale"));
    EXPECT_TRUE(contains(complaint("environment/scale", 1e36), "not finite"));
    EXPECT_TRUE(contains(complaint("environment/depth", 1), "unknown key"));
    EXPECT_TRUE(contains(complaint("retroreflective/0/retroreflector", 1), "retroreflector"));
    EXPECT_TRUE(contains(complaint("retroreflectors/0/coefficient", json::array({5, 50, 70})), "falling"));
    json nine = json::array();
    for (int i = 0; i < 9; ++i) nine.push_back(good["extras"]["vesper"]["retroreflectors"][0]);
    EXPECT_TRUE(contains(complaint("retroreflectors", nine), "more than 8"));
}

}  // namespace
}  // namespace vesper::test
