// The photometry file: what is read, what is refused, which names its patterns match. SPDX-License-Identifier: MIT
#include "scene/photometry.h"

#include <cmath>
#include <numbers>

#include "scene/colour.h"
#include "scene/scene_files.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

using nlohmann::json;

json street_lamp() {
    return {{"name", "street lamp"},       {"nodes", "lamp_*"},    {"type", "spot"},
            {"intensity_cd", 1800},        {"inner_cone_deg", 40}, {"outer_cone_deg", 80},
            {"colour_temperature_K", 2100}};
}

scene::Photometry read(const json& file) {
    const TempFolder folder;
    return scene::read_photometry(folder.write("p.json", file.dump()));
}

TEST(Photometry, ReadsAWholeFile) {
    const scene::Photometry p = read(
        {{"version", 1},
         {"textures", {{"transfer", "gamma"}, {"gamma", 2.4}}},
         {"ambient", {{"illuminance_lx", 0.4}, {"colour_temperature_K", 3200}}},
         {"sky", {{"luminance_cd_m2", 0.02}, {"colour_rgb", {0, 0, 1}}}},
         {"lights", {{"keep", true}}},
         {"lamps",
          {street_lamp(),
           {{"nodes", {"a", "b"}},
            {"type", "cosine_power"},
            {"intensity_cd", 12000},
            {"exponent", 250},
            {"aim", {0, -2, 0}},
            {"offset_m", {0, 0, 1}}}}},
         {"emitters", {{{"materials", "glass"}, {"luminance_cd_m2", 7000}, {"modulate", true}}}},
         {"surfaces", {{{"materials", "asphalt*"}, {"reflectance_scale", 0.5}, {"roughness", 0.8}, {"metallic", 0}}}}});
    EXPECT_FLOAT_EQ(p.transfer.gamma, 2.4f);
    EXPECT_EQ(p.ambient->value, 0.4);
    EXPECT_NEAR(luminance(p.sky->colour), 1, 1e-9);
    EXPECT_TRUE(p.keep_lights);
    ASSERT_EQ(p.lamps.size(), 2u);
    EXPECT_EQ(p.lamps[0].lamp.kind, scene::Lamp::Kind::Spot);
    EXPECT_FLOAT_EQ(p.lamps[0].lamp.outer_cone, static_cast<float>(80 * std::numbers::pi / 180));
    EXPECT_EQ(p.lamps[1].name, "a");
    EXPECT_EQ(p.lamps[1].aim, glm::dvec3(0, -1, 0));
    EXPECT_EQ(p.lamps[1].lamp.colour, glm::vec3(1));
    EXPECT_TRUE(p.emitters[0].modulate);
    EXPECT_EQ(p.surfaces[0].roughness, 0.8);
}

TEST(Photometry, StartsFromEquationOne) {
    const scene::Photometry p = read({{"version", 1}});
    EXPECT_EQ(p.transfer.kind, scene::Transfer::Kind::Gamma);
    EXPECT_FLOAT_EQ(p.transfer.gamma, 2.2f);
    EXPECT_FALSE(p.ambient);
}

// A comment is for people: in the file and in each rule, and nothing changes by it.
TEST(Photometry, ReadsComments) {
    json lamp = street_lamp();
    const json point = {{"nodes", "p"}, {"type", "point"}, {"intensity_cd", 5}};
    const json lobe = {{"nodes", "c"}, {"type", "cosine_power"}, {"intensity_cd", 5}, {"exponent", 2}};
    const json measured = {{"nodes", "m"}, {"type", "distribution"}, {"standard", "low-beam"}};
    json file = {{"version", 1},
                 {"lamps", {lamp, point, lobe, measured}},
                 {"emitters", {{{"materials", "glass"}, {"luminance_cd_m2", 7000}}}},
                 {"surfaces", {{{"materials", "wall"}}}},
                 {"directional", {{{"illuminance_lx", 1}, {"direction", {0, -1, 0}}}}}};
    EXPECT_EQ(complaint_of([&] { read(file); }), "");
    for (const char* rules : {"lamps", "emitters", "surfaces", "directional"})
        for (json& rule : file[rules]) rule["comment"] = "why";
    file["comment"] = "of the file";
    EXPECT_EQ(complaint_of([&] { read(file); }), "");
    EXPECT_EQ(read(file).lamps[0].lamp.intensity, 1800.0f);
    file["lamps"][3]["comment"] = 5;
    EXPECT_TRUE(contains(complaint_of([&] { read(file); }), "/lamps/3/comment"));
    file["lamps"][3].erase("comment");
    file["sky"] = {{"luminance_cd_m2", 1}, {"comment", "no rule"}};
    EXPECT_TRUE(contains(complaint_of([&] { read(file); }), "/sky/comment: unknown key"));
}

// The lamps of data/photometry need no file: 8000 lm of the street lamp, 28,150 cd of the low beam (its README).
TEST(Photometry, KnowsStandardLamps) {
    const auto rule = [](const char* key, const char* lamp) {
        return json{{"nodes", "a"}, {"type", "distribution"}, {key, lamp}};
    };
    json file = {{"version", 1}, {"lamps", {rule("standard", "street-lamp"), rule("standard", "low-beam")}}};
    file["lamps"].push_back(file["lamps"][0]);
    file["lamps"][2]["flux_lm"] = 4000;
    const scene::Photometry p = read(file);
    ASSERT_EQ(p.measured.size(), 2u) << "each once";
    EXPECT_NEAR(photometry::luminous_flux(p.measured[0].distribution), 8000, 10);
    EXPECT_NEAR(photometry::largest_intensity(p.measured[1].distribution), 28150, 10);
    EXPECT_NEAR(static_cast<double>(p.lamps[2].lamp.intensity), 0.5, 1e-3);
    EXPECT_TRUE(p.lamps[0].points_down);
    file["lamps"][0]["file"] = "street-lamp.ies";
    EXPECT_TRUE(contains(complaint_of([&] { read(file); }), "/lamps/0/standard: is given beside file"));
    file["lamps"][0] = rule("standard", "sun");
    EXPECT_TRUE(contains(complaint_of([&] { read(file); }), "/lamps/0/standard: there is no lamp 'sun'"));
    file["lamps"][0] = rule("standard", "street-lamp");
    file["lamps"][0]["lamp_set"] = 1;
    EXPECT_TRUE(contains(complaint_of([&] { read(file); }), "/lamps/0/standard: lamp_set is for EULUMDAT"));
    file["lamps"][0]["lamp_set"] = 0;
    EXPECT_TRUE(contains(complaint_of([&] { read(file); }), "/lamps/0/standard: lamp_set is for EULUMDAT"));
    const std::string schema = read_text(std::filesystem::path(VESPER_SOURCE_DIR) / "data/photometry.schema.json");
    const json refused = json::parse(schema).at(json::json_pointer("/$defs/lamp/oneOf/3/not/anyOf"));
    EXPECT_EQ(refused.at(1)["required"], (json{"standard", "lamp_set"}));
    file["lamps"][0] = rule("file", "street-lamp");
    EXPECT_FALSE(complaint_of([&] { read(file); }).empty()) << "a file of that name is a file";
}

TEST(Photometry, NamesThePlaceOfWhatIsWrong) {
    const std::vector<Fault> faults{
        {"/version", 2, "/version"},
        {"/lamp", json::array(), "/lamp: unknown key"},
        {"/lamps", json::object(), "/lamps"},
        {"/lamps/0/intensity", 5, "/lamps/0/intensity: unknown key"},
        {"/lamps/0/exponent", 5, "/lamps/0/exponent: unknown key"},
        {"/lamps/0/intensity_cd", 0, "/lamps/0/intensity_cd"},
        {"/lamps/0/intensity_cd", "1800", "/lamps/0/intensity_cd"},
        {"/lamps/0/intensity_cd", 1e12, "/lamps/0/intensity_cd"},
        {"/lamps/0/type", "area", "/lamps/0/type"},
        {"/lamps/0/nodes", json::array(), "/lamps/0/nodes"},
        {"/lamps/0/nodes", {"a", 3}, "/lamps/0/nodes/1"},
        {"/lamps/0/inner_cone_deg", 85, "/lamps/0/inner_cone_deg"},
        {"/lamps/0/outer_cone_deg", 91, "/lamps/0/outer_cone_deg"},
        {"/lamps/0/colour_temperature_K", 500, "/lamps/0/colour_temperature_K"},
        {"/lamps/0/colour_rgb", {1, 1, 1}, "/lamps/0/colour_rgb"},  // beside a temperature
        {"/lamps/0/aim", {0, 0, 0}, "/lamps/0/aim"},
        {"/textures/transfer", "linear", "/textures/transfer"},
        {"/textures", {{"transfer", "srgb"}, {"gamma", 2}}, "/textures/gamma"},
        {"/emitters", {{{"materials", "x"}}}, "/emitters/0: has no \"luminance_cd_m2\""},
        {"/emitters", {{{"materials", "x"}, {"luminance_cd_m2", -1}}}, "/emitters/0/luminance_cd_m2"},
        {"/emitters",
         {{{"materials", "x"}, {"luminance_cd_m2", 1}, {"colour_rgb", {0, 0, 0}}}},
         "/emitters/0/colour_rgb"},
        {"/surfaces", {{{"materials", ""}}}, "/surfaces/0/materials"},
        {"/surfaces",
         {{{"materials", "x"}, {"reflection_table", "R3"}, {"reflectance_scale", 0.5}}},
         "/surfaces/0/reflectance_scale: has no meaning beside reflection_table"},
        {"/surfaces", {{{"materials", "x"}, {"reflection_table", "R3"}, {"roughness", 0.5}}}, "/surfaces/0/roughness"},
        {"/surfaces", {{{"materials", "x"}, {"reflection_table", "R3"}, {"metallic", 0}}}, "/surfaces/0/metallic"},
        {"/surfaces",
         {{{"materials", "x"}, {"retroreflection", {{"class", "RA1"}}}, {"metallic", 1}}},
         "/surfaces/0/metallic"},
        {"/sky/luminance_cd_m2", nullptr, "/sky/luminance_cd_m2"},
    };
    expect_places(
        {{"version", 1}, {"lamps", {street_lamp()}}, {"sky", {{"luminance_cd_m2", 1}}}}, faults,
        [](const json& file) { return complaint_of([&] { read(file); }); }, "p.json: ");
    const TempFolder folder;
    EXPECT_THROW(scene::read_photometry(folder.write("p.json", "{\"version\": 1")), Error);
    EXPECT_THROW(scene::read_photometry(folder / "missing.json"), Error);
}

TEST(Pattern, MatchesNames) {
    for (const char* pattern : {"lamp_1", "*", "lamp*", "*1", "l?mp_?", "*a*_*", "lamp_1*", "**"})
        EXPECT_TRUE(scene::matches_name(pattern, "lamp_1")) << pattern;
    for (const char* pattern : {"lamp", "amp_1", "?", "lamp_1?", "*2", "", "LAMP_1"})
        EXPECT_FALSE(scene::matches_name(pattern, "lamp_1")) << pattern;
    EXPECT_TRUE(scene::matches_name("*", ""));
    EXPECT_TRUE(scene::matches_name("a*b*a*c", "aXbYbaZc"));
    EXPECT_TRUE(scene::matches_name("r?verb?re", "réverbère"));
    EXPECT_FALSE(scene::matches_name(std::string(50, '*') + "x", std::string(5000, 'a')));  // at once
}

TEST(Pattern, MatchesEndsOfPaths) {
    const std::vector<std::string> path = {"light", "street_lamp_07", "street"};
    for (const char* pattern :
         {"light", "l*", "street_lamp_*/light", "street/street_lamp_07/light", "*/*/light", "*/light"})
        EXPECT_TRUE(scene::matches_path(pattern, path)) << pattern;
    for (const char* pattern :
         {"street*", "lamp_*/light", "street/light", "street*light", "*/*/*/light", "street_lamp_*", "/light"})
        EXPECT_FALSE(scene::matches_path(pattern, path)) << pattern;
    // A name may hold slashes: it counts as one component, whose inside no match begins in.
    const std::vector<std::string> odd = {"street_lamp_07/light", "street"};
    for (const char* pattern :
         {"street_lamp_*/light", "street_lamp_*7/light", "street_lamp_?7/*", "street/street_lamp_07/light", "*"})
        EXPECT_TRUE(scene::matches_path(pattern, odd)) << pattern;
    EXPECT_FALSE(scene::matches_path("light", odd));
    EXPECT_FALSE(scene::matches_path("street/*", odd));
}

TEST(Pattern, MatchesNodesHoweverDeep) {
    scene::Scene deep;
    std::string pattern;
    for (uint32_t i = 0; i < 40; ++i) {
        deep.nodes.emplace_back();
        deep.nodes[i].name = "level_" + std::to_string(i), deep.nodes[i].parent = i == 0 ? scene::kNone : i - 1;
        pattern += (i == 0 ? "" : "/") + deep.nodes[i].name;
    }
    EXPECT_TRUE(scene::matches_node(pattern, deep, 39)) << "up to the root";
    EXPECT_FALSE(scene::matches_node("*/" + pattern, deep, 39)) << "nothing is above it";
    EXPECT_FALSE(scene::matches_node(pattern, deep, 38));
    EXPECT_TRUE(scene::matches_node("level_7", deep, 7));
    EXPECT_TRUE(scene::matches_node("level_?/*_8", deep, 8));
}

}  // namespace
}  // namespace vesper::test
