// Photometry files made of what a scene holds. SPDX-License-Identifier: MIT
#include "scene/photometry_template.h"

#include "scene/named_parts.h"
#include "scene/template_patterns.h"

namespace vesper::test {
namespace {

using nlohmann::json;
using scene::kNone;
using scene::Lamp;
using scene::PhotometryTemplate;
using scene::SourceReason;

size_t count(const PhotometryTemplate& made, SourceReason reason) { return made.rules[size_t(reason)]; }

TEST(PhotometryTemplate, NamesWithNumbersShareARule) {
    NamedParts street;
    for (int i = 0; i < 40; ++i)
        street.node("lamp_" + std::string(1, char('0' + i / 10)) + char('0' + i % 10), kNone, {i, 6, 0});
    street.node("wall_01");
    const PhotometryTemplate made = street.made();
    EXPECT_EQ(made.lamps, 1u);
    EXPECT_EQ(made.emitters, 0u);
    EXPECT_EQ(made.sources[size_t(SourceReason::Name)], 40u);
    const json lamp = street.rules("lamps")[0];
    EXPECT_EQ(lamp["nodes"], "lamp_*");
    EXPECT_EQ(lamp["type"], "point");
    EXPECT_EQ(lamp["intensity_cd"], 100);
    EXPECT_EQ(lamp["comment"], "suggestion, by name: 40 nodes about 19.5, 6, 0 m (x, up, z)");
    street.expect_clean();
    // A shade is no lamp of its own, and the pattern leaves it out.
    street.node("lamp_shade");
    EXPECT_EQ(street.rules("lamps")[0]["nodes"], "lamp_??");
    EXPECT_EQ(street.made().lamps, 1u);
    // Nor does the pattern take what differs by letters.
    street.node("lamp_xy");
    ASSERT_EQ(street.rules("lamps").size(), 2u);
    EXPECT_EQ(street.rules("lamps")[0]["nodes"].size(), 40u) << "the names themselves";
    EXPECT_EQ(street.rules("lamps")[1]["nodes"], "lamp_xy");
    EXPECT_EQ(street.warnings(),
              std::vector<std::string>{"1 node sounds like a light, but no lamp rule matches: 'lamp_shade'"});
}

TEST(PhotometryTemplate, CopiesAndSidesShareARule) {
    EXPECT_EQ(scene::family_of("lamp.001"), scene::family_of("lamp"));
    EXPECT_EQ(scene::family_of("Headlamp_Left"), scene::family_of("Headlamp_Right"));
    EXPECT_EQ(scene::without_numbers("a12b3*"), "a*b*?");
    EXPECT_NE(scene::family_of("lamp_a"), scene::family_of("lamp_b"));
    NamedParts street;
    street.node("Lantern"), street.node("Lantern.001"), street.node("Lantern.002");
    EXPECT_EQ(street.rules("lamps"), json::parse(street.made().text)["lamps"]);
    ASSERT_EQ(street.rules("lamps").size(), 1u);
    EXPECT_EQ(street.rules("lamps")[0]["nodes"], (json{"Lantern", "Lantern.*"}));
    street.expect_clean();
}

TEST(PhotometryTemplate, KindsFollowTheNames) {
    struct Case {
        const char *name, *kind, *key;
        json value;
    };
    const Case cases[] = {{"StreetLight_A", "street lamp", "standard", "street-lamp"},
                          {"Straßenlaterne", "street lamp", "standard", "street-lamp"},
                          {"lamp post", "street lamp", "standard", "street-lamp"},
                          {"car_3/headlamp", "headlamp", "standard", "low-beam"},
                          {"Scheinwerfer", "headlamp", "standard", "low-beam"},
                          {"Light_High_Beam", "high beam", "standard", "high-beam"},
                          {"Light_Fog", "fog lamp", "standard", "front-fog"},
                          {"taillight", "tail lamp", "intensity_cd", 5},
                          {"tail_left", "tail lamp", "intensity_cd", 5},
                          {"Bremslicht", "brake lamp", "intensity_cd", 60},
                          {"turn_signal", "turn signal", "intensity_cd", 200},
                          {"signal_07/red", "red signal", "colour_rgb", {1, 0.02, 0.01}},
                          {"Ampel_gruen", "green signal", "colour_rgb", {0.05, 1, 0.55}},
                          {"traffic_light", "amber signal", "colour_rgb", {1, 0.35, 0.02}},
                          {"bulkhead_light", "lamp", "colour_temperature_K", 2700},
                          {"lamp_head_large", "lamp", "intensity_cd", 100},
                          {"headl_3", "headlamp", "standard", "low-beam"},
                          {"front_left_light", "lamp", "intensity_cd", 100},
                          {"front light", "headlamp", "standard", "low-beam"}};
    for (const Case& c : cases) {
        NamedParts street;
        street.node(c.name);
        const json lamps = street.rules("lamps");
        ASSERT_EQ(lamps.size(), 1u) << c.name;
        EXPECT_EQ(lamps[0]["name"], c.kind) << c.name;
        EXPECT_EQ(lamps[0][c.key], c.value) << c.name;
        street.expect_clean();
    }
    for (const char* name : {"wall", "tail", "signal_07", "red", "window", "brake_left", "flight deck", ""}) {
        NamedParts street;
        street.node(name);
        EXPECT_EQ(street.rules("lamps").size(), 0u) << name;
    }
}

// The kind of "light" is that of the node above, which belongs to the pattern then.
TEST(PhotometryTemplate, NamesAboveTellTheKind) {
    NamedParts street;
    for (const char* number : {"1", "2", "3"}) {
        const uint32_t above = street.node(std::string("street_lamp_") + number);
        street.node("light", above, {0, 6, 0});
        street.show(street.node("streetlight", above), street.material("iron"), {0, 0, 0}, {0, 5, 0}, {0.1f, 0, 0});
        street.node("light", street.node(std::string("hall_") + number));
    }
    const json lamps = street.rules("lamps");
    ASSERT_EQ(lamps.size(), 2u) << lamps;
    EXPECT_EQ(lamps[0]["nodes"], "hall_*/light");
    EXPECT_EQ(lamps[0]["name"], "lamp");
    EXPECT_EQ(lamps[1]["nodes"], "street_lamp_*/light") << "and its mesh is no other lamp";
    EXPECT_EQ(lamps[1]["standard"], "street-lamp");
}

// A part has the name of the whole: the pattern tells them apart by the names above.
TEST(PhotometryTemplate, TheSameNameTwice) {
    NamedParts street;
    const uint32_t lantern = street.node("lantern", street.node("square"));
    street.show(street.node("lantern", lantern), street.material("iron"), {0, 0, 0}, {0, 1, 0}, {0.1f, 0, 0});
    const json lamps = street.rules("lamps");
    ASSERT_EQ(lamps.size(), 1u);
    EXPECT_EQ(lamps[0]["nodes"], "square/lantern");
    street.expect_clean();
}

TEST(PhotometryTemplate, LightsOfTheFileAreKeptWherePlausible) {
    NamedParts street;
    street.light(street.node("Empty.003", kNone, {1, 2, 3}), Lamp::Kind::Point, 300);
    street.light(street.node("watts"), Lamp::Kind::Point, 5e6f);
    street.light(street.node("cone"), Lamp::Kind::Spot, 40);
    street.light(street.node("sun"), Lamp::Kind::Directional, 3);
    street.light(street.node(""), Lamp::Kind::Point, 3);
    const PhotometryTemplate made = street.made();
    EXPECT_EQ(count(made, SourceReason::Light), 3u);
    EXPECT_EQ(made.suns, 1u);
    EXPECT_EQ(made.nameless, 1u);
    std::map<std::string, json> lamps;
    for (const json& lamp : street.rules("lamps")) lamps[lamp["nodes"]] = lamp;
    EXPECT_EQ(lamps["Empty.003"]["intensity_cd"], 300);
    EXPECT_TRUE(
        contains(lamps["Empty.003"]["comment"].get<std::string>(), "by light of the file: 1 node at 1, 2, 3 m"));
    EXPECT_EQ(lamps["watts"]["intensity_cd"], 100);
    EXPECT_EQ(lamps["cone"]["type"], "spot");
    EXPECT_NEAR(lamps["cone"]["outer_cone_deg"].get<double>(), 44.977, 1e-3);  // 0.785 rad
}

// A light that is off in the file is no lamp of 100 cd. One in watts becomes a usual lamp, and the rule says so.
TEST(PhotometryTemplate, LightsThatAreOffGetNoRule) {
    NamedParts street;
    street.light(street.node("none"), Lamp::Kind::Point, 0);
    street.light(street.node("black"), Lamp::Kind::Spot, 100);
    street.scene.lamps.back().colour = glm::vec3(0);
    EXPECT_EQ(street.made().dark, 2u);
    EXPECT_EQ(street.made().lamps, 0u);
    // A node that is named as a lamp is one all the same.
    street.light(street.node("street lamp"), Lamp::Kind::Point, 0);
    const PhotometryTemplate made = street.made();
    EXPECT_EQ(made.dark, 2u);
    EXPECT_EQ(count(made, SourceReason::Light), 0u);
    EXPECT_EQ(count(made, SourceReason::Name), 1u);
    NamedParts watts;
    watts.light(watts.node("Empty.001"), Lamp::Kind::Point, 5e6f);
    watts.light(watts.node("Empty.002"), Lamp::Kind::Point, 0.002f);
    const json lamp = watts.rules("lamps").at(0);
    EXPECT_EQ(lamp["intensity_cd"], 100);
    EXPECT_TRUE(contains(lamp["comment"].get<std::string>(), "; not the 0.002 to 5e+06 cd of the file")) << lamp;
    watts.light(watts.node("plain"), Lamp::Kind::Point, 70);
    EXPECT_FALSE(contains(watts.rules("lamps").at(1)["comment"].get<std::string>(), "; not the"));
}

TEST(PhotometryTemplate, MaterialsThatEmit) {
    NamedParts street;
    const uint32_t wall = street.node("wall");
    for (const char* name : {"panel", "", "shop_window", "lit facade", "asphalt"})
        street.show(wall, street.material(name, glm::vec3(0.5f)), {0, 0, 0}, {2, 0, 0}, {0, 1, 0});
    street.scene.materials[0].emission = {1, 0.5f, 0};
    street.scene.materials[1].emission = {1, 1, 1};
    const PhotometryTemplate made = street.made();
    EXPECT_EQ(made.emitters, 3u);
    EXPECT_EQ(count(made, SourceReason::Emission), 1u);
    EXPECT_EQ(count(made, SourceReason::Name), 2u);
    EXPECT_EQ(made.nameless, 1u);
    std::map<std::string, json> rules;
    for (const json& rule : street.rules("emitters")) rules[rule["materials"]] = rule;
    EXPECT_EQ(rules["panel"]["luminance_cd_m2"], 100);
    EXPECT_EQ(rules["panel"]["colour_rgb"], (json{1, 0.5, 0}));
    EXPECT_EQ(rules["panel"]["comment"], "suggestion, by emission: 1 material, 2 m^2");
    EXPECT_EQ(rules["shop_window"]["luminance_cd_m2"], 3);
    EXPECT_EQ(rules["shop_window"]["colour_temperature_K"], 2700);
    EXPECT_TRUE(rules.contains("lit facade"));
}

TEST(PhotometryTemplate, WindowsOfHouses) {
    const auto luminance = [](const char* name) {
        NamedParts street;
        street.material(name);
        const json rules = street.rules("emitters");
        return rules.empty() ? 0 : rules[0]["luminance_cd_m2"].get<int>();
    };
    EXPECT_EQ(luminance("window_03"), 3);
    EXPECT_EQ(luminance("Fenster"), 3);
    EXPECT_EQ(luminance("window_lit"), 30);
    for (const char* other : {"window_frame", "car_window", "windowsill trim", "windscreen"})
        EXPECT_EQ(luminance(other), 0) << other;
}

/// The rules for one material on a rectangle of so many m^2, with a picture of one code if `side` is not 0.
PhotometryTemplate of_white(float area, uint32_t side, uint8_t code, const scene::Material& like = {}) {
    NamedParts street;
    street.scene.materials.push_back(like);
    scene::Material& m = street.scene.materials[0];
    m.name = "a";
    if (side) {
        street.scene.images.push_back({"p", side, side, std::vector<uint8_t>(size_t{4} * side * side, code)});
        m.base_colour_texture.image = 0;
    }
    street.show(street.node("n"), 0, {0, 0, 0}, {area, 0, 0}, {0, 1, 0});
    return street.made();
}

// Above 0.9: snow has less. sRGB 244 is 0.905, 243 is 0.896.
TEST(PhotometryTemplate, BrightPicturesAndSmallSurfaces) {
    const auto bright = [](const PhotometryTemplate& made) { return made.rules[size_t(SourceReason::Bright)]; };
    EXPECT_EQ(bright(of_white(500, 64, 244)), 1u);
    EXPECT_EQ(bright(of_white(500, 64, 243)), 0u);
    EXPECT_EQ(bright(of_white(500, 65, 255)), 0u);
    EXPECT_EQ(bright(of_white(0.99f, 0, 0)), 1u);
    EXPECT_EQ(bright(of_white(1.01f, 0, 0)), 0u);
    EXPECT_EQ(bright(of_white(0.5f, 0, 0, {.base_colour = glm::vec4(0.89f, 0.89f, 0.89f, 1)})), 0u);
    EXPECT_EQ(bright(of_white(0.5f, 0, 0, {.metallic = 1})), 0u);
    EXPECT_EQ(bright(of_white(0.5f, 0, 0, {.clear = true})), 0u);
    const json rule = json::parse(of_white(500, 64, 244).text)["emitters"][0];
    EXPECT_EQ(rule["luminance_cd_m2"], 50);
    EXPECT_EQ(rule["modulate"], true);
    EXPECT_TRUE(contains(rule["comment"].get<std::string>(), "by bright"));
}

TEST(PhotometryTemplate, SaysHowManyRulesAreLeftOut) {
    NamedParts street;
    for (char a = 'a'; a <= 'z'; ++a)
        for (char b = 'a'; b < 'k'; ++b)
            street.node(std::string("lamp ") + a + "_" + b + "x"), street.material(std::string("lamp ") + a + b + "x");
    const PhotometryTemplate made = street.made();
    EXPECT_EQ(made.lamps, scene::kMostTemplateRules);
    EXPECT_EQ(made.emitters, scene::kMostTemplateRules);
    EXPECT_EQ(made.left_out_rules, 2 * (260 - scene::kMostTemplateRules));
    EXPECT_EQ(made.left_out_sources, 2 * (260 - scene::kMostTemplateRules));
}

// Names with wildcards, slashes and quotes are matched, and two rules never put lamps on one node.
TEST(PhotometryTemplate, OddNames) {
    NamedParts street;
    const glm::dvec3 off(0, 3, 0);
    for (const char* name : {"lamp *", "lamp ?x", "lamp/", "/light", "\"lamp\"", "lamp\\1", "lamp", "lamp"})
        street.node(name);
    street.light(street.node("lamp"), Lamp::Kind::Point, 55);
    const uint32_t box = street.node("box");
    street.node("lamp", box, off);
    const TempFolder folder;
    scene::Scene lit = street.scene;
    const scene::PhotometryReport report =
        scene::apply_photometry(lit, scene::read_photometry(folder.write("p.json", street.made().text)), "s.gltf");
    for (const std::string& warning : report.warnings) EXPECT_FALSE(contains(warning, "no node matches")) << warning;
    std::map<uint32_t, size_t> lamps;
    for (uint32_t i = 0; i < lit.nodes.size(); ++i)
        if (lit.nodes[i].lamp != kNone)
            ++lamps[lit.nodes[i].mesh == kNone && lit.nodes[i].parent != kNone ? lit.nodes[i].parent : i];
    for (const auto& [node, number] : lamps) EXPECT_EQ(number, 1u) << lit.nodes[node].name;
    EXPECT_GE(lamps.size(), 8u);
}

TEST(PhotometryTemplate, AnEmptySceneGivesAnEmptyFile) {
    const NamedParts street;
    const PhotometryTemplate made = street.made();
    EXPECT_EQ(made.lamps + made.emitters + made.left_out_rules + made.nameless + made.suns, 0u);
    EXPECT_EQ(json::parse(made.text)["version"], 1);
    street.expect_clean();
}

}  // namespace
}  // namespace vesper::test
