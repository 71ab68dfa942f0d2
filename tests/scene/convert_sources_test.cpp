// Openings from the photometry file to the scene, and the two descriptions of a source compared.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <numbers>

#include "io/hdr_image.h"
#include "photometry/ies.h"
#include "places.h"
#include "scene/apply_rules.h"
#include "scene/lamp.h"
#include "support/conversion.h"

namespace vesper::test {
namespace {

using nlohmann::json;

/// Two cars: a mesh with the glass of a lamp, 0.3 x 0.2 m facing +X, and a node for the lamp in its middle.
class ConvertSourcesTest : public ConversionTest {
protected:
    ConvertSourcesTest() {
        street_.root["materials"] = {{{"name", "glass"}, {"emissiveFactor", {1, 1, 1}}}, {{"name", "body"}}};
        const size_t glass = street_.vec3({0, 0, 0, 0, 0, -0.3f, 0, 0.2f, -0.3f, 0, 0.2f, 0});
        const size_t body = street_.vec3({0, 0, 0, 20, 0, 0, 0, 20, 0});
        const size_t square = street_.indices({0, 1, 2, 0, 2, 3});
        street_.root["meshes"] = {{{"primitives",
                                    {{{"attributes", {{"POSITION", glass}}}, {"indices", square}, {"material", 0}},
                                     {{"attributes", {{"POSITION", body}}}, {"material", 1}}}}}};
        for (const int car : {0, 1}) {
            const int first = 3 * car;
            street_.root["nodes"].push_back(
                {{"name", "car"}, {"children", {first + 1, first + 2}}, {"translation", {9 * car, 0, 0}}});
            street_.root["nodes"].push_back({{"name", "shape"}, {"mesh", 0}});
            street_.root["nodes"].push_back({{"name", "headlamp"}, {"translation", {-0.1, 0.1, -0.15}}});
        }
    }
    static json lamp(double candela) {
        return {{"name", "beam"},          {"nodes", "headlamp"}, {"type", "cosine_power"},
                {"intensity_cd", candela}, {"exponent", 9},       {"aim", {1, 0, 0}}};
    }
    static json opening() { return {{"width_m", 0.3}, {"height_m", 0.2}}; }
    scene::PhotometryReport convert_with(const json& lamp_rule, const json& emitter) {
        return ConversionTest::convert_with({{"lamps", {lamp_rule}}, {"emitters", {emitter}}});
    }
    static size_t given(const scene::PhotometryReport& report) {
        size_t count = 0;
        for (const std::string& line : report.warnings) count += line.find(" cd/m^2 given") != std::string::npos;
        return count;
    }
};

TEST_F(ConvertSourcesTest, OpeningsAreStored) {
    json rule = lamp(600);
    rule["opening"] = opening();
    convert_with(rule, {{"materials", "glass"}, {"lamp", "beam"}});
    const scene::Scene scene = converted();
    ASSERT_EQ(scene.lamps.size(), 1u);
    EXPECT_EQ(scene.lamps[0].opening.length, 0.3);
    EXPECT_EQ(scene.lamps[0].opening.width, 0.2);
    EXPECT_FALSE(scene.lamps[0].opening.round);
    EXPECT_NEAR(scene::axis_luminance(scene.lamps[0], scene.distributions), 10000, 0.1);

    rule["opening"] = {{"width_m", 0.2}, {"round", true}};
    convert_with(rule, {{"materials", "glass"}, {"lamp", "beam"}});
    EXPECT_NEAR(converted().lamps.at(0).opening.area(), std::numbers::pi * 0.01, 1e-12);
    EXPECT_TRUE(converted().lamps.at(0).opening.drawn);
    // One that only gives shadows their penumbrae may lie in a surface that emits.
    rule["opening"]["drawn"] = false;
    const scene::PhotometryReport hidden =
        convert_with(rule, {{"materials", "glass"}, {"luminance_cd_m2", 600 / (std::numbers::pi * 0.01)}});
    EXPECT_NEAR(converted().lamps.at(0).opening.area(), std::numbers::pi * 0.01, 1e-12);
    EXPECT_FALSE(converted().lamps.at(0).opening.drawn);
    EXPECT_FALSE(mentions(hidden.warnings, "seen twice"));
    rule.erase("opening");
    convert_with(rule, {{"materials", "glass"}, {"luminance_cd_m2", 1}});
    EXPECT_EQ(converted().lamps.at(0).opening.area(), 0);
}

TEST_F(ConvertSourcesTest, OpeningsOfMeasuredLampsAreStored) {
    photometry::Distribution beam;
    beam.goniometry = photometry::Goniometry::CGamma;
    beam.horizontal = {0}, beam.vertical = {0, 90}, beam.candela = {500, 0};
    beam.opening = {.length = 0.6, .width = 0.25, .height = 0, .round = false};
    folder_.write("beam.ies", photometry::write_ies(beam));
    json rule = {
        {"name", "beam"}, {"nodes", "headlamp"}, {"type", "distribution"}, {"file", "beam.ies"}, {"opening", "file"}};
    json second = rule;
    second["opening"] = opening(), second["name"] = "other";
    ConversionTest::convert_with({{"lamps", {rule, second}}});
    const scene::Scene scene = converted();
    ASSERT_EQ(scene.lamps.size(), 2u) << "one file, two openings";
    EXPECT_NEAR(scene.lamps[0].opening.length, 0.6, 1e-12);
    EXPECT_NEAR(scene.lamps[0].opening.width, 0.25, 1e-12);
    EXPECT_NEAR(scene.lamps[1].opening.length, 0.3, 1e-12);
    EXPECT_NEAR(scene::axis_luminance(scene.lamps[0], scene.distributions), 500 / 0.15, 1);

    beam.opening = {};
    folder_.write("beam.ies", photometry::write_ies(beam));
    try {
        convert_with(rule, {{"materials", "glass"}, {"luminance_cd_m2", 1}});
        ADD_FAILURE() << "a file without luminous area was accepted";
    } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), "/lamps/0/opening: the file states no luminous area"));
    }
}

// 600 cd over 0.06 m^2 are 10,000 cd/m^2 in the mean, whatever the picture.
TEST_F(ConvertSourcesTest, PicturesAreComparedByTheirMean) {
    io::HdrImage image{.width = 4, .height = 1, .white_luminance = 1};
    for (const float value : {39997.0f, 1.0f, 1.0f, 1.0f}) image.rgb.insert(image.rgb.end(), 3, value);
    io::write_exr(folder_ / "lamp.exr", image);
    json& attributes = street_.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_0"] = street_.vec2({0, 1, 1, 1, 1, 0, 0, 0});
    const json emitter = {{"materials", "glass"}, {"image", "lamp.exr"}};
    EXPECT_EQ(given(convert_with(lamp(600), emitter)), 0u);
    EXPECT_FALSE(mentions(convert_with(lamp(600), emitter).warnings, "in the mean of its picture"));
    EXPECT_TRUE(mentions(convert_with(lamp(900), emitter).warnings,
                         "emitter 'glass': 1e+04 cd/m^2 in the mean of its picture, 900 cd of lamp 'beam' over 0.06 "
                         "m^2 is 1.5e+04 cd/m^2 (50 % more)"));
    // Only the bright quarter of the picture lies on the glass.
    attributes["TEXCOORD_0"] = street_.vec2({0, 1, 0.25, 1, 0.25, 0, 0, 0});
    EXPECT_TRUE(mentions(convert_with(lamp(600), emitter).warnings, "emitter 'glass': 4e+04 cd/m^2 in the mean"));
}

TEST_F(ConvertSourcesTest, GlassOfALampDoesNotEmitBesides) {
    json rule = lamp(600);
    rule["opening"] = opening();
    const scene::PhotometryReport named = convert_with(rule, {{"materials", "glass"}, {"lamp", "beam"}});
    EXPECT_EQ(converted().materials.at(0).emission, glm::vec3(0));
    EXPECT_FALSE(mentions(named.warnings, "seen twice"));
    EXPECT_EQ(given(named), 0u);
    const scene::PhotometryReport twice = convert_with(rule, {{"materials", "glass"}, {"luminance_cd_m2", 10000}});
    EXPECT_TRUE(
        mentions(twice.warnings, "emitter 'glass': lies where lamp 'beam' shows its opening and would be seen twice"));
    EXPECT_EQ(given(twice), 0u);
}

// Glass of a lamp shows nothing where that lamp is not.
TEST_F(ConvertSourcesTest, GlassWithoutItsLampIsDark) {
    json rule = lamp(600);
    rule["opening"] = opening();
    EXPECT_FALSE(mentions(convert_with(rule, {{"materials", "glass"}, {"lamp", "beam"}}).warnings, "dark"));
    street_.root["nodes"].push_back({{"name", "shop window"}, {"mesh", 0}, {"translation", {4, 0, 0}}});
    EXPECT_TRUE(
        mentions(convert_with(rule, {{"materials", "glass"}, {"lamp", "beam"}}).warnings,
                 "emitter 'glass': 1 of 3 surfaces has no lamp 'beam' within 1 m and is dark (node 'shop window')"));
    // Two panes in one mesh, the other 20 m away.
    street_.root["nodes"].erase(street_.root["nodes"].size() - 1);
    json& primitive = street_.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] =
        street_.vec3({0, 0, 0, 0, 0, -0.3f, 0, 0.2f, -0.3f, 0, 0.2f, 0, 20, 0, 0, 20, 0, -0.3f, 20, 0.2f, -0.3f});
    primitive["indices"] = street_.indices({0, 1, 2, 0, 2, 3, 4, 5, 6});
    EXPECT_TRUE(mentions(convert_with(rule, {{"materials", "glass"}, {"lamp", "beam"}}).warnings,
                         "emitter 'glass': 2 of 4 surfaces have no lamp 'beam'"));
}

// 600 cd over 0.06 m^2 are 10000 cd/m^2, by the opening stated or by the mesh.
TEST_F(ConvertSourcesTest, DisagreementsAboveTenPercentAreReported) {
    for (const bool stated : {true, false})
        for (const double luminance : {7000.0, 8900.0, 9300.0, 10000.0, 10800.0, 11300.0, 15000.0, 90000.0}) {
            json rule = lamp(600), emitter = {{"name", "E"}, {"materials", "glass"}, {"luminance_cd_m2", luminance}};
            if (stated) rule["opening"] = opening(), emitter["lamp"] = "beam";
            const scene::PhotometryReport report = convert_with(rule, emitter);
            const bool wrong = luminance > 11000 || luminance < 10000 / 1.1;
            EXPECT_EQ(given(report), wrong ? 1u : 0u) << luminance << (stated ? " stated" : " measured");
            if (luminance == 15000) {
                EXPECT_TRUE(mentions(report.warnings,
                                     "emitter 'E': 1.5e+04 cd/m^2 given, 600 cd of lamp 'beam' over 0.06 m^2 is "
                                     "1e+04 cd/m^2 (33 % less)"));
                EXPECT_EQ(mentions(report.warnings, "the most of 2 nodes"), !stated);
            }
        }
    const scene::PhotometryReport off = convert_with(lamp(600), {{"materials", "glass"}, {"luminance_cd_m2", 0}});
    EXPECT_EQ(given(off), 0u) << "what is off is meant to be";
}

TEST_F(ConvertSourcesTest, OnlyGlassBesideALampIsMeasured) {
    street_.root["nodes"][2]["translation"] = {-0.1, 0.1, 3};  // three metres from the glass
    street_.root["nodes"][5]["translation"] = {-0.1, 0.1, 3};
    EXPECT_EQ(given(convert_with(lamp(600), {{"materials", "glass"}, {"luminance_cd_m2", 1}})), 0u);
    street_.root["nodes"][2]["translation"] = {-0.1, 0.1, -0.15};
    json rule = lamp(600);
    rule["aim"] = {0, 0, 1};  // along the glass: no area to see
    EXPECT_EQ(given(convert_with(rule, {{"materials", "glass"}, {"luminance_cd_m2", 1}})), 0u);
    const double half = std::sqrt(0.5);
    rule["aim"] = {half, half, 0};
    EXPECT_TRUE(
        mentions(convert_with(rule, {{"materials", "glass"}, {"luminance_cd_m2", 1}}).warnings, "over 0.04243 m^2"));
}

TEST_F(ConvertSourcesTest, NamesThePlaceOfWhatIsWrong) {
    const auto complaint = [&](const json& rule, const json& emitter) {
        return complaint_of([&] { convert_with(rule, emitter); });
    };
    json rule = lamp(600);
    EXPECT_TRUE(contains(complaint(rule, {{"materials", "x"}, {"lamp", "beam"}}),
                         "/emitters/0/lamp: the lamp rule 'beam' has no opening that is drawn"));
    rule["opening"] = opening();
    EXPECT_TRUE(
        contains(complaint(rule, {{"materials", "x"}, {"lamp", "bream"}}), "/emitters/0/lamp: there is no lamp rule"));
    EXPECT_TRUE(
        contains(complaint(rule, {{"materials", "x"}, {"lamp", "beam"}, {"modulate", true}}), "/emitters/0/modulate"));
    EXPECT_TRUE(contains(complaint(rule, {{"materials", "x"}, {"lamp", "beam"}, {"colour_rgb", {1, 1, 1}}}),
                         "/emitters/0/colour_rgb"));
    const json fine = {{"materials", "x"}, {"luminance_cd_m2", 1}};
    for (const auto& [value, place] : std::initializer_list<std::pair<json, const char*>>{
             {"file", "/lamps/0/opening: \"file\" is for lamps of type distribution"},
             {"large", "/lamps/0/opening"},
             {{{"width_m", 0.2}}, "/lamps/0/opening: has no \"height_m\""},
             {{{"width_m", 0}, {"height_m", 1}}, "/lamps/0/opening/width_m"},
             {{{"width_m", 1}, {"height_m", 101}}, "/lamps/0/opening/height_m"},
             {{{"width_m", 1}, {"hight_m", 1}}, "/lamps/0/opening/hight_m: unknown key"}}) {
        rule["opening"] = value;
        EXPECT_TRUE(contains(complaint(rule, fine), place));
    }
}

/// A file as a conversion leaves it, with something to say about openings.
TEST(Openings, AreReadWithCare) {
    const auto complaint = [](const json& opening) {
        GltfFile file;
        file.root["extensionsUsed"] = {"KHR_lights_punctual"};
        file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}, {{"type", "directional"}}};
        file.root["extras"]["vesper"] = {{"version", 1}, {"openings", {opening}}};
        return file.complaint();
    };
    EXPECT_EQ(complaint({{"light", 0}, {"width_m", 1}, {"height_m", 1}}), "");
    const std::string place = "/extras/vesper/openings/0";
    EXPECT_TRUE(contains(complaint({{"light", 2}, {"width_m", 1}, {"height_m", 1}}), place + "/light"));
    EXPECT_TRUE(
        contains(complaint({{"light", 1}, {"width_m", 1}, {"height_m", 1}}), place + "/light: a directional light"));
    EXPECT_TRUE(contains(complaint({{"profile", 0}, {"width_m", 1}, {"height_m", 1}}), place + "/profile"));
    EXPECT_TRUE(contains(complaint({{"light", 0}, {"width_m", -1}, {"height_m", 1}}), place + "/width_m"));
    EXPECT_TRUE(contains(complaint({{"light", 0}, {"width_m", 1}}), place));
    EXPECT_TRUE(contains(complaint({{"width_m", 1}, {"height_m", 1}}), place));
    EXPECT_TRUE(
        contains(complaint({{"light", 0}, {"width_m", 1}, {"height_m", 1}, {"depth_m", 1}}), place + "/depth_m"));
}

/// What is given of every source of the project's own streets agrees, but for lantern glass, which is given as seen
/// from aside.
TEST_F(ConvertSourcesTest, OwnStreetsAgree) {
    const std::filesystem::path rivoli = std::filesystem::path(VESPER_SOURCE_DIR) / "data/rivoli";
    for (const auto& [street, photometry] :
         {std::pair("rivoli", "rivoli"), {"rivoli", "rivoli.measured"}, {"rivoli-drive", "rivoli-drive"}}) {
        const scene::PhotometryReport report =
            scene::convert(rivoli / (std::string(street) + ".gltf"),
                           rivoli / (std::string(photometry) + ".photometry.json"), folder_ / "own.gltf");
        EXPECT_FALSE(report.changes.empty());
        for (const std::string& warning : report.warnings)
            EXPECT_TRUE(!warning.starts_with("emitter") ||
                        warning.starts_with("emitter 'lantern glass': 8000 cd/m^2 given"))
                << photometry << ": " << warning;
    }
}

TEST(Intensity, OfEveryLobe) {
    scene::Lamp lamp;
    lamp.intensity = 100;
    EXPECT_EQ(scene::luminous_intensity(lamp, {}, {3, 1, 2}), 100) << "a point";
    lamp.kind = scene::Lamp::Kind::Spot, lamp.inner_cone = 0.3f, lamp.outer_cone = 0.6f;
    const auto at = [&](double angle) {
        return scene::luminous_intensity(lamp, {}, {std::sin(angle), 0, -std::cos(angle)});
    };
    EXPECT_EQ(at(0.29), 100);
    EXPECT_EQ(at(0.61), 0);
    const double ramp = (std::cos(0.45) - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6));
    EXPECT_NEAR(at(0.45), 100 * ramp * ramp, 1e-4);
    lamp.kind = scene::Lamp::Kind::CosinePower, lamp.exponent = 3;
    EXPECT_NEAR(at(1), 100 * std::pow(std::cos(1.0), 3), 1e-9);
    EXPECT_EQ(at(2), 0);
    lamp.kind = scene::Lamp::Kind::Directional;
    EXPECT_EQ(at(0), 0);
    EXPECT_EQ(scene::deviation(0.67), "33 % less");
    EXPECT_EQ(scene::deviation(1.55), "55 % more");
    EXPECT_EQ(scene::deviation(12.1), "12 times as much");
}

}  // namespace
}  // namespace vesper::test
