// Conversion with measured lamps: what is read back shines where and as strong as the photometry file says.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "photometry/ies.h"
#include "scene/colour.h"
#include "scene/photometry.h"
#include "support/conversion.h"

namespace vesper::test {
namespace {

using nlohmann::json;

/// A street lamp, two cars' headlamps, and files of their distributions beside the photometry file.
class ConvertDistributionTest : public ConversionTest {
protected:
    ConvertDistributionTest() {
        street_.show({{"attributes", {{"POSITION", street_.vec3({0, 0, 0, 20, 0, 0, 0, 20, 0})}}}});
        json& nodes = street_.root["nodes"];
        nodes.push_back({{"name", "street_lamp"}, {"translation", {0, 8, 0}}});
        for (const char* name : {"car_0/headlamp", "car_1/headlamp"}) nodes.push_back({{"name", name}});

        lamp_.goniometry = photometry::Goniometry::CGamma;  // brightest at C30, gamma 60
        for (double c = 0; c <= 360; c += 15) lamp_.horizontal.push_back(c);
        for (double g = 0; g <= 90; g += 10) lamp_.vertical.push_back(g);
        for (const double c : lamp_.horizontal)
            for (const double g : lamp_.vertical)
                lamp_.candela.push_back(g == 60 && c == 30 ? 5000
                                        : g == 0           ? 100
                                        : g < 90           ? 100 + c * (360 - c) / 1000
                                                           : 0);
        folder_.write("lamp.ies", photometry::write_ies(lamp_));
        // Brightest at H = 10, V = -5.
        folder_.write("beam.csv", ",-20,0,10,20\n-10,1,100,200,1\n-5,1,500,30000,1\n0,1,100,200,1\n10,1,1,1,1\n");
    }

    json street_rule() const {
        return {{"name", "street"}, {"nodes", "street_lamp"}, {"type", "distribution"}, {"file", "lamp.ies"}};
    }
    json beam_rule() const {
        return {{"name", "beam"}, {"nodes", "car_*"}, {"type", "distribution"}, {"file", "beam.csv"}};
    }
    scene::PhotometryReport convert_with(const std::vector<json>& lamps, const std::string& output = "out.gltf",
                                         bool keep = false) {
        return ConversionTest::convert_with({{"lamps", lamps}, {"lights", {{"keep", keep}}}}, output);
    }
    std::string complaint_with(const json& rule) {
        return complaint_of([&] { convert_with({rule}); });
    }
    /// Intensity of the first measured lamp of the result in a direction of the world, cd.
    double seen(glm::dvec3 direction, const std::string& output = "out.gltf") const {
        const scene::Scene scene = converted(output);
        const auto world = scene::world_transforms(scene, 0);
        for (size_t i = 0; i < scene.nodes.size(); ++i) {
            if (scene.nodes[i].lamp == scene::kNone) continue;
            const scene::Lamp& lamp = scene.lamps[scene.nodes[i].lamp];
            const glm::dmat3 frame(world[i]);
            return lamp.intensity *
                   photometry::intensity(scene.distributions[lamp.distribution], glm::inverse(frame) * direction);
        }
        return -1;
    }

    photometry::Distribution lamp_;
};

const double kDegree = std::acos(-1.0) / 180;

// Type C without a direction: down where -Z is not, with C0 the shortest way; a stated direction, and -Z within 45
// degrees of down, stay.
TEST_F(ConvertDistributionTest, LuminairesShineDown) {
    const auto bright = [](double c, double g) {  // a direction of the luminaire's that points down, C0 along X
        return glm::dvec3(std::sin(g * kDegree) * std::cos(c * kDegree), -std::cos(g * kDegree),
                          -std::sin(g * kDegree) * std::sin(c * kDegree));
    };
    const scene::PhotometryReport report = convert_with({street_rule()});
    EXPECT_TRUE(mentions(report.warnings, "lamp 'street': 1 node with -Z more than 45 degrees from straight down"));
    EXPECT_NEAR(seen({0, -1, 0}), 100, 1e-3);
    EXPECT_NEAR(seen(bright(30, 60)), 5000, 1);
    json along = street_rule();
    along["c0"] = {1, 0, 0};  // no direction of the light
    EXPECT_TRUE(mentions(convert_with({along}).warnings, "straight down"));
    EXPECT_NEAR(seen(bright(30, 60)), 5000, 1);
    // Turned about the vertical: C0 goes along. Scaled, too.
    json& node = street_.root["nodes"][1];
    ASSERT_EQ(node["name"], "street_lamp");
    node["rotation"] = {0, std::sin(45 * kDegree), 0, std::cos(45 * kDegree)}, node["scale"] = {2, 2, 2};
    EXPECT_TRUE(mentions(convert_with({street_rule()}).warnings, "straight down"));
    EXPECT_NEAR(seen(bright(120, 60)), 5000, 1) << "X of the node is -Z of the world";
    // The node points up.
    node["rotation"] = {std::sin(45 * kDegree), 0, 0, std::cos(45 * kDegree)};
    convert_with({street_rule()});
    EXPECT_NEAR(seen({0, -1, 0}), 100, 1e-3);
    // 30 degrees from straight down: a tilt that somebody meant.
    node["rotation"] = {-std::sin(30 * kDegree), 0, 0, std::cos(30 * kDegree)};
    EXPECT_FALSE(mentions(convert_with({street_rule()}).warnings, "straight down"));
    EXPECT_NEAR(seen({0, -std::cos(30 * kDegree), -std::sin(30 * kDegree)}), 100, 1e-3);
    node.erase("rotation");
    for (const auto& [key, value] :
         {std::pair<const char*, json>("aim", {0, 0, -1}), {"pitch_deg", 5}, {"yaw_deg", 5}}) {
        json stated = street_rule();
        stated[key] = value;
        EXPECT_FALSE(mentions(convert_with({stated}).warnings, "straight down")) << key;
    }
    EXPECT_FALSE(mentions(convert_with({beam_rule()}).warnings, "straight down")) << "types A and B have a front";
}

// A measured lamp has no name but its node's, and roles and factors of lamps go by the rule's.
TEST_F(ConvertDistributionTest, LampsHaveTheNamesOfTheirRules) {
    const auto names = [&](const json& rule) {
        convert_with({rule});
        std::vector<std::string> found;
        const scene::Scene scene = converted();
        for (const scene::Node& node : scene.nodes)
            if (node.lamp != scene::kNone) found.push_back(node.name);
        return found;
    };
    json turned = beam_rule(), named = street_rule();
    turned["pitch_deg"] = -0.5, named["name"] = "street_lamp", named["aim"] = {0, 0, -1};
    EXPECT_EQ(names(beam_rule()), (std::vector<std::string>{"beam", "beam"}));
    EXPECT_EQ(names(turned), (std::vector<std::string>{"beam", "beam"}));
    const size_t nodes = (names(named), converted().nodes.size());
    EXPECT_EQ(names(named), std::vector<std::string>{"street_lamp"});
    EXPECT_EQ(nodes, street_.root["nodes"].size()) << "no node of its own where that has the name already";
}

// Where a car's left side is its right one mirrored, so is the beam: no lamp does that.
TEST_F(ConvertDistributionTest, MirroredNodesAreWarnedOf) {
    EXPECT_FALSE(mentions(convert_with({beam_rule()}).warnings, "mirrored by a scale"));
    for (json& node : street_.root["nodes"])
        if (node.value("name", "") == "car_1/headlamp") node["scale"] = {-1, 1, 1};
    EXPECT_TRUE(
        mentions(convert_with({beam_rule()}).warnings, "lamp 'beam': node 'car_1/headlamp' is mirrored by a scale"));
    json undone = beam_rule();
    undone["mirror"] = true;
    EXPECT_FALSE(mentions(convert_with({undone}).warnings, "mirrored by a scale"));
    folder_.write("even.csv", ",-20,0,20\n-10,1,100,1\n0,1,500,1\n");
    undone["file"] = "even.csv", undone.erase("mirror");
    EXPECT_FALSE(mentions(convert_with({undone}).warnings, "mirrored by a scale")) << "left and right are alike";
    json point = beam_rule();
    point.erase("file"), point["type"] = "spot", point["intensity_cd"] = 5, point["outer_cone_deg"] = 20;
    EXPECT_FALSE(mentions(convert_with({point}).warnings, "mirrored by a scale"));
}

TEST_F(ConvertDistributionTest, EmbedsEachFileOnce) {
    for (const char* output : {"out.gltf", "out.glb"}) {
        json street = street_rule(), again = street_rule();
        street["colour_temperature_K"] = 3000;
        again["nodes"] = "car_1/*";
        again["flux_scale"] = 0.5;
        const scene::PhotometryReport report = convert_with({street, beam_rule(), again}, output);
        const TempFolder elsewhere;  // nothing beside it
        std::filesystem::copy(folder_ / output, elsewhere / output);
        const scene::LoadedScene loaded = scene::read_scene(elsewhere / output);
        const scene::Scene& scene = loaded.scene;
        for (const std::string& note : loaded.notes) EXPECT_TRUE(contains(note, "without material")) << note;
        ASSERT_EQ(scene.distributions.size(), 2u) << output;
        EXPECT_EQ(scene.lamps.size(), 3u);
        EXPECT_EQ(std::count_if(scene.nodes.begin(), scene.nodes.end(),
                                [](const scene::Node& n) { return n.lamp != scene::kNone; }),
                  4);  // the second car has two
        const scene::Lamp& lamp = scene.lamps[0];
        EXPECT_EQ(lamp.kind, scene::Lamp::Kind::Measured);
        EXPECT_NEAR(lamp.intensity, 1, 1e-6);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(lamp.colour[c], scene::colour_of_temperature(3000)[c], 1e-5);
        for (size_t i = 0; i < lamp_.candela.size(); ++i)
            EXPECT_EQ(static_cast<float>(scene.distributions[0].candela[i]), static_cast<float>(lamp_.candela[i]));
        EXPECT_EQ(scene.distributions[1].goniometry, photometry::Goniometry::TypeA);
        EXPECT_TRUE(mentions(report.changes, "lamp 'street': 1 node, 'lamp.ies', 5000 cd at most, 3000 K, "));
        EXPECT_TRUE(mentions(report.changes, "lamp 'beam': 2 nodes, 'beam.csv', 3e+04 cd at most, "));
        EXPECT_TRUE(mentions(report.changes, "lm each"));
    }
}

TEST_F(ConvertDistributionTest, ScalesFlux) {
    const double measured = photometry::luminous_flux(lamp_);
    json rule = street_rule();
    rule["flux_lm"] = 9000;
    rule["maintenance_factor"] = 0.8;
    rule["dimming"] = 0.5;
    const scene::PhotometryReport report = convert_with({rule});
    EXPECT_NEAR(converted().lamps[0].intensity, 9000 / measured * 0.4, 1e-4);
    EXPECT_TRUE(mentions(report.changes, "3600 lm each"));
    rule.erase("flux_lm");
    rule["flux_scale"] = 2;
    convert_with({rule});
    EXPECT_NEAR(converted().lamps[0].intensity, 0.8, 1e-6);
}

TEST_F(ConvertDistributionTest, TurnsAStreetLampToTheRoad) {
    const auto way = [](glm::dvec3 c0, glm::dvec3 c90) {  // C30, gamma 60 of a lamp that looks down
        return std::sin(60 * kDegree) * (std::cos(30 * kDegree) * c0 + std::sin(30 * kDegree) * c90) +
               std::cos(60 * kDegree) * glm::dvec3(0, -1, 0);
    };
    json rule = street_rule();
    rule["aim"] = {0, -1, 0};
    convert_with({rule});
    EXPECT_NEAR(seen(way({1, 0, 0}, {0, 0, -1})), 5000, 1);
    EXPECT_NEAR(seen({0, -1, 0}), lamp_.candela[0], 1e-3);
    rule["c0"] = {0, 0.3, 1};  // only what is at right angles to the aim counts
    convert_with({rule});
    EXPECT_NEAR(seen(way({0, 0, 1}, {1, 0, 0})), 5000, 1);
    rule["rotation_deg"] = 90;  // C0 to where C90 was
    convert_with({rule});
    EXPECT_NEAR(seen(way({1, 0, 0}, {0, 0, -1})), 5000, 1);
    rule.erase("rotation_deg");
    rule["mirror"] = true;  // C0 and C180 exchanged, C90 kept
    const scene::PhotometryReport report = convert_with({rule});
    EXPECT_NEAR(seen(way({0, 0, -1}, {1, 0, 0})), 5000, 1);
    EXPECT_TRUE(mentions(report.changes, "'lamp.ies' mirrored, "));
}

TEST_F(ConvertDistributionTest, AimsAHeadlamp) {
    const auto way = [](double h, double v) {  // right, up, forward are X, Y, -Z
        return glm::dvec3(std::cos(v * kDegree) * std::sin(h * kDegree), std::sin(v * kDegree),
                          -std::cos(v * kDegree) * std::cos(h * kDegree));
    };
    json rule = beam_rule();
    convert_with({rule});
    EXPECT_NEAR(seen(way(10, -5)), 30000, 1);
    rule["pitch_deg"] = -2;  // down
    convert_with({rule});
    EXPECT_NEAR(seen(way(0, -7)), 500, 1);
    EXPECT_NEAR(seen(way(0, -2)), 100, 1);
    rule["pitch_deg"] = 0;
    rule["yaw_deg"] = 3;  // to the right
    convert_with({rule});
    EXPECT_NEAR(seen(way(13, -5)), 30000, 1);
    rule["yaw_deg"] = 0;
    rule["mirror"] = true;
    convert_with({rule});
    EXPECT_NEAR(seen(way(-10, -5)), 30000, 1);
    rule["mirror"] = false;
    rule["aim"] = {1, 0, 0};  // up stays up
    convert_with({rule});
    EXPECT_NEAR(seen({-way(10, -5).z, way(10, -5).y, way(10, -5).x}), 30000, 1);
    rule["up"] = {0, 0, 1};  // on its side: up is +Z, right is -Y
    convert_with({rule});
    EXPECT_NEAR(seen({-way(10, -5).z, -way(10, -5).x, way(10, -5).y}), 30000, 1);
}

TEST_F(ConvertDistributionTest, KeepsOrRemovesThoseOfTheOriginal) {
    folder_.write("old.ies", photometry::write_ies(lamp_));
    street_.root["extensionsUsed"] = {"EXT_lights_ies"};
    street_.root["extensions"]["EXT_lights_ies"]["lights"] = {{{"uri", "old.ies"}}};
    street_.root["nodes"][1]["extensions"]["EXT_lights_ies"] = {{"light", 0}, {"multiplier", 7}};
    for (const char* output : {"out.gltf", "out.glb"}) {
        const scene::PhotometryReport removing = convert_with({beam_rule()}, output);
        EXPECT_TRUE(mentions(removing.changes, "removed 1 light"));
        EXPECT_EQ(converted(output).distributions.size(), 1u);
        convert_with({beam_rule(), street_rule()}, output, true);
        const TempFolder elsewhere;
        std::filesystem::copy(folder_ / output, elsewhere / output);
        const scene::Scene scene = scene::read_scene(elsewhere / output).scene;
        ASSERT_EQ(scene.distributions.size(), 3u);
        EXPECT_EQ(scene.lamps[scene.nodes[1].lamp].intensity, 7);  // the new lamp sits on a child
        EXPECT_EQ(std::count_if(scene.nodes.begin(), scene.nodes.end(),
                                [](const scene::Node& n) { return n.lamp != scene::kNone; }),
                  4);
    }
}

TEST_F(ConvertDistributionTest, SaysWhatIsWrong) {
    folder_.write("broken.ies", "IES:LM-63-2019\nTILT=NONE\n1 -1 1 3\n");
    folder_.write("dark.csv", ",0,10\n0,0,0\n10,0,0\n");
    const struct {
        const char* key;
        json value;
        const char* wanted;
    } cases[] = {
        {"file", "none.ies", "p.json: /lamps/0/file: "},
        {"file", "broken.ies", "broken.ies: line 4: the file ends"},
        {"intensity_cd", 100, "/lamps/0/intensity_cd: unknown key"},
        {"flux_lm", -1, "/lamps/0/flux_lm"},
        {"maintenance_factor", 0, "/lamps/0/maintenance_factor"},
        {"maintenance_factor", 1.1, "/lamps/0/maintenance_factor"},
        {"dimming", 1.5, "/lamps/0/dimming"},
        {"up", {0, 1, 0}, "/lamps/0/up: is for distributions of type A and B"},
        {"c0", {0, 0, 1}, "/lamps/0/c0: must not be parallel to aim"},
        {"aim", {0, 0, 0}, "/lamps/0/aim"},
        {"pitch_deg", 400, "/lamps/0/pitch_deg"},
    };
    for (const auto& c : cases) {
        json rule = street_rule();
        rule[c.key] = c.value;
        EXPECT_TRUE(contains(complaint_with(rule), c.wanted)) << c.key;
    }
    json rule = beam_rule();
    rule["c0"] = {1, 0, 0};
    EXPECT_TRUE(contains(complaint_with(rule), "wants up"));
    rule = beam_rule();
    rule["flux_lm"] = 5;
    rule["flux_scale"] = 5;
    EXPECT_TRUE(contains(complaint_with(rule), "one of them is wanted"));
    rule.erase("flux_scale");
    rule["file"] = "dark.csv";
    EXPECT_TRUE(contains(complaint_with(rule), "without any flux"));
    rule = street_rule();
    rule.erase("file");
    EXPECT_TRUE(contains(complaint_with(rule), "has no \"file\""));
}

}  // namespace
}  // namespace vesper::test
