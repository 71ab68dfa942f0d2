// Fixtures of lamps, from the photometry file to the scene that is read. SPDX-License-Identifier: MIT
#include "scene/convert.h"
#include "scene/fixtures.h"
#include "scene/scene_report.h"
#include "support/conversion.h"

namespace vesper::test {
namespace {

using nlohmann::json;
using Names = std::vector<std::string>;

/// Two poles, each with a housing that holds a light; and a shed apart.
class ConvertFixturesTest : public ConversionTest {
protected:
    ConvertFixturesTest() {
        const json primitive = {{"attributes", {{"POSITION", street_.vec3(kTriangle)}}}};
        for (int pole = 0; pole < 2; ++pole) {
            const int first = 3 * pole;
            street_.show(primitive, {{"name", "pole"}, {"children", {first + 1}}, {"translation", {50 * pole, 0, 0}}});
            street_.show(primitive, {{"name", "housing"}, {"children", {first + 2}}});
            street_.root["nodes"].push_back({{"name", "light"}});
        }
        street_.show(primitive, {{"name", "shed"}, {"translation", {0, 0, 90}}});
        street_.root["nodes"].push_back({{"name", "mark"}});
    }
    static json lamp(const json& fixture) {
        json rule = {{"name", "lantern"}, {"nodes", "light"}, {"type", "point"}, {"intensity_cd", 100}};
        if (!fixture.is_null()) rule["fixture"] = fixture;
        return rule;
    }
    /// Names of the nodes that are the fixture of each lamp, after a conversion by this rule.
    std::vector<Names> fixtures(const json& rule, scene::PhotometryReport* report = nullptr) {
        const auto made = convert_with({{"lamps", {rule}}}, "out.glb");
        if (report) *report = made;
        const scene::Scene scene = converted("out.glb");
        std::vector<uint32_t> lamps;
        for (uint32_t i = 0; i < scene.nodes.size(); ++i)
            if (scene.nodes[i].lamp != scene::kNone) lamps.push_back(i);
        std::vector<Names> named;
        for (const auto& nodes : scene::fixture_nodes(scene, lamps, scene::world_transforms(scene, 0))) {
            named.emplace_back();
            for (const uint32_t node : nodes) named.back().push_back(scene.nodes[node].name);
        }
        return named;
    }
    std::string complaint(const json& fixture) {
        return complaint_of([&] { convert_with({{"lamps", {lamp(fixture)}}}); });
    }
};

TEST_F(ConvertFixturesTest, AreThoseThatTheRuleStates) {
    const auto twice = [](const Names& names) { return std::vector<Names>{names, names}; };
    EXPECT_EQ(fixtures(lamp(nullptr)), twice({"housing"}));
    EXPECT_EQ(fixtures(lamp("own")), twice({"housing"}));
    EXPECT_EQ(fixtures(lamp("none")), twice({}));
    EXPECT_EQ(fixtures(lamp("pole")), twice({"pole", "housing"})) << "each lamp has the pole above it";
    EXPECT_EQ(fixtures(lamp("p?le/h*")), twice({"housing"}));
    EXPECT_EQ(fixtures(lamp("shed")), twice({"shed"})) << "90 m away; the only node of that name";
    json aimed = lamp("pole");
    aimed["offset_m"] = {0, 0, 1};  // the lamp gets a node of its own
    EXPECT_EQ(fixtures(aimed), twice({"pole", "housing"}));
}

TEST_F(ConvertFixturesTest, AreReported) {
    scene::PhotometryReport report;
    fixtures(lamp("none"), &report);
    EXPECT_TRUE(mentions(report.changes, "lm each, no fixture"));
    EXPECT_FALSE(mentions(report.warnings, "fixture"));
    fixtures(lamp("p*le"), &report);
    EXPECT_TRUE(mentions(report.changes, ", fixture 'p*le'"));
    EXPECT_EQ(fixtures(lamp("mark"), &report), (std::vector<Names>{{}, {}}));
    EXPECT_TRUE(mentions(report.warnings, "lamp 'lantern': its fixture, node 'mark', has no meshes"));
    const auto expect = [&](const json& fixture, scene::FixtureRule rule, size_t meshes) {
        fixtures(lamp(fixture));
        const scene::SceneReport found = scene::report_scene(converted("out.glb"));
        ASSERT_EQ(found.lamps.size(), 1u);
        EXPECT_EQ(found.lamps[0].fixture, rule);
        EXPECT_EQ(found.lamps[0].least_meshes, meshes) << fixture;
        EXPECT_EQ(found.lamps[0].most_meshes, meshes) << fixture;
    };
    expect("own", scene::FixtureRule::Own, 1);
    expect("none", scene::FixtureRule::None, 0);
    expect("pole", scene::FixtureRule::Named, 2);
}

TEST_F(ConvertFixturesTest, NamesThePlaceOfErrors) {
    const std::string place = "p.json: /lamps/0/fixture: ";
    EXPECT_EQ(complaint("none"), "");
    EXPECT_TRUE(contains(complaint("lantern"), place + "no node of the scene matches 'lantern'"));
    EXPECT_TRUE(contains(complaint(7), place));
    EXPECT_TRUE(contains(complaint(""), place + "must be \"own\", \"none\" or the name of a node"));
    json rule = lamp("housing");
    rule["nodes"] = "mark";
    const auto message = complaint_of([&] { convert_with({{"lamps", {rule}}}); });
    EXPECT_TRUE(contains(message, place + "'housing' matches 2 nodes, and none of them is node 'mark' of the lamp"))
        << message;
}

/// A file as a conversion leaves it, with something to say about fixtures.
TEST(Fixtures, OfAFileAreReadWithCare) {
    const auto file_with = [](const json& fixtures) {
        GltfFile file;
        file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}});
        file.root["extensionsUsed"] = {"KHR_lights_punctual"};
        file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}, {{"type", "directional"}}};
        for (const int light : {0, 1, 0})
            file.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
        file.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
        file.root["extras"]["vesper"] = {{"version", 1}, {"fixtures", fixtures}};
        return file;
    };
    const json one = {{"node", 1}, {"fixture", 0}}, none = {{"node", 1}, {"fixture", "none"}};
    const auto complaint = [&](const json& fixture) { return file_with(json::array({fixture})).complaint(); };
    EXPECT_EQ(file_with(json::array({one})).read().scene.nodes.at(1).fixture, 0u);
    EXPECT_EQ(file_with(json::array({none})).read().scene.nodes.at(1).fixture, scene::kNone);
    EXPECT_FALSE(file_with(json::array()).read().scene.nodes.at(1).fixture);
    EXPECT_EQ(complaint({{"node", 3}, {"fixture", 0}}), "") << "a lamp that is not shown";
    const std::string place = "/extras/vesper/fixtures/0";
    EXPECT_TRUE(contains(complaint({{"node", 4}, {"fixture", 0}}), place + "/node"));
    EXPECT_TRUE(contains(complaint({{"node", 1}, {"fixture", 4}}), place + "/fixture"));
    EXPECT_TRUE(contains(complaint({{"node", 1}, {"fixture", 3}}), place + "/fixture: is a node that the scene does"));
    EXPECT_TRUE(contains(complaint({{"node", 1}, {"fixture", "own"}}), place + "/fixture: is neither"));
    EXPECT_TRUE(contains(complaint({{"node", 1}, {"fixture", true}}), place + "/fixture"));
    EXPECT_TRUE(contains(complaint({{"node", 1}}), place));
    EXPECT_TRUE(contains(complaint({{"fixture", 0}}), place));
    EXPECT_TRUE(contains(complaint({{"node", 1}, {"fixture", 0}, {"of", 0}}), place + "/of"));
    EXPECT_TRUE(contains(complaint({{"node", 0}, {"fixture", 0}}), place + "/node: has no lamp"));
    EXPECT_TRUE(contains(complaint({{"node", 2}, {"fixture", 0}}), place + "/node: has no lamp"));
    EXPECT_TRUE(
        contains(file_with(json::array({one, one})).complaint(), "/extras/vesper/fixtures/1/node: is named twice"));
}

}  // namespace
}  // namespace vesper::test
