// Photometry in memory: the scene that a converted file gives, to the bit. SPDX-License-Identifier: MIT
#include "scene/apply_photometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/named_file.h"
#include "scene/convert.h"
#include "scene/half_sky.h"
#include "scene/rotation.h"
#include "scene/scene_files.h"
#include "support/same_scene.h"
#include "support/shared_data.h"

namespace vesper::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
const fs::path kData = fs::path(VESPER_SOURCE_DIR) / "data";

/// Rules for any file: every node gets lamps, every material emits or reflects otherwise.
json rules_for_all() {
    const json lamp = {{"name", "lobe"},        {"nodes", "*"},    {"type", "cosine_power"},
                       {"intensity_cd", 321.7}, {"exponent", 3.3}, {"colour_temperature_K", 2700},
                       {"aim", {0.3, -1, 0.2}}};
    const json spot = {{"name", "spot"},       {"nodes", "*"},           {"type", "spot"},
                       {"intensity_cd", 17.3}, {"outer_cone_deg", 33.3}, {"colour_rgb", {1, 0.31, 0.17}},
                       {"fixture", "none"}};
    return {{"version", 1},
            {"ambient", {{"illuminance_lx", 0.123}, {"colour_temperature_K", 3456}}},
            {"directional", {{{"illuminance_lx", 0.21}, {"direction", {0.1, -0.7, 0.3}}, {"angular_diameter_deg", 3}}}},
            {"lamps", {lamp, spot}},
            {"emitters",
             {{{"materials", "*a*"}, {"luminance_cd_m2", 123.4}, {"modulate", true}, {"colour_rgb", {1, 0.7, 0.3}}},
              {{"materials", "*e*"}, {"luminance_cd_m2", 77.7}, {"colour_temperature_K", 4321}}}},
            {"surfaces",
             {{{"materials", "*o*"}, {"reflectance_scale", 0.37}, {"roughness", 0.63}},
              {{"materials", "*"}, {"reflectance_scale", 0.61}, {"roughness", 0.4}, {"metallic", 0.1}}}}};
}

void expect_same_both_ways(const fs::path& file, const fs::path& photometry, const fs::path& output) {
    SCOPED_TRACE(file.string() + " with " + photometry.string());
    scene::convert(file, photometry, output);
    const scene::LoadedScene made = scene::read_lit_scene(file, photometry), read = scene::read_scene(output);
    EXPECT_TRUE(made.photometric);
    expect_same(made.scene, read.scene);
}

TEST(ApplyPhotometry, GivesTheSceneOfAConvertedFile) {
    const TempFolder folder;
    const io::AllowedFolder lamps(kData);
    for (const auto& [file, photometry, output] :
         {std::tuple{"rivoli/rivoli.gltf", "rivoli/rivoli.measured.photometry.json", "out.glb"},
          {"rivoli/rivoli.gltf", "rivoli/rivoli.photometry.json", "out.gltf"},
          {"rivoli/rivoli-drive.gltf", "rivoli/rivoli-drive.photometry.json", "out.glb"},
          {"photometry/yard.gltf", "photometry/yard.photometry.json", "out.glb"},
          {"photometry/yard.gltf", "photometry/yard.photometry.json", "out.gltf"}})
        expect_same_both_ways(kData / file, kData / photometry, folder / output);
}

TEST(ApplyPhotometry, GivesTheSceneOfAConvertedFileForSharedFiles) {
    const fs::path root = shared_data("gltf");
    if (!is_here(root)) GTEST_SKIP() << "the shared set is not here";
    const TempFolder folder;
    const fs::path photometry = folder.write("p.json", rules_for_all().dump());
    size_t compared = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        if (!scene::is_scene_name(entry.path())) continue;
        std::string converting, applying;
        try {
            scene::convert(entry.path(), photometry, folder / "out.glb");
        } catch (const Error& error) {
            converting = error.what();
        }
        scene::LoadedScene made;
        try {
            made = scene::read_lit_scene(entry.path(), photometry);
        } catch (const Error& error) {
            applying = error.what();
        }
        SCOPED_TRACE(entry.path().string());
        // There nodes of skins, and listed ones that are no roots, follow those of rules; and a lamp on a node with a
        // skin stands where the file has the node, not where the skin is.
        if (mentions(made.notes, "lists nodes that have parents") || mentions(made.notes, "a node with a skin"))
            continue;
        if (applying.empty() && !converting.empty()) continue;  // parts that reading does not need
        EXPECT_EQ(applying, converting);
        if (!converting.empty()) continue;
        expect_same(made.scene, scene::read_scene(folder / "out.glb").scene);
        ++compared;
    }
    EXPECT_GT(compared, 50u);
}

/// A street of one file, with what rules meet seldom.
class ApplyToFile : public testing::Test {
protected:
    void expect_same_with(const json& photometry) {
        const fs::path rules = folder_.write("p.json", photometry.dump());
        expect_same_both_ways(folder_.write("in.gltf", file_.text()), rules, folder_ / "out.gltf");
    }
    TempFolder folder_;
    GltfFile file_;
};

TEST_F(ApplyToFile, InstancesSecondLampsAndBlendedGlass) {
    const size_t position = file_.vec3({0, 0, 0, 20, 0, 0, 0, 20, 0}), places = file_.vec3({0, 0, 0, 5, 0, 0});
    file_.root["materials"] = {{{"name", "glass"}, {"alphaMode", "BLEND"}, {"emissiveFactor", {1, 1, 1}}},
                               {{"name", "lit glass"}, {"alphaMode", "BLEND"}},
                               {{"name", "gloss"},
                                {"extensions",
                                 {{"KHR_materials_pbrSpecularGlossiness",
                                   {{"diffuseFactor", {0.8, 0.7, 0.6, 1}}, {"specularFactor", {0.1, 0.2, 0.3}}}}}}},
                               {{"name", "unlit"}, {"extensions", {{"KHR_materials_unlit", json::object()}}}}};
    for (int material = 0; material < 4; ++material)
        file_.show({{"attributes", {{"POSITION", position}}}, {"material", material}});
    file_.show({{"attributes", {{"POSITION", position}}}});  // no material
    json& nodes = file_.root["nodes"];
    nodes[0]["name"] = "many", nodes[0]["children"] = {5};
    nodes[0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    nodes.push_back({{"name", "below"}});
    nodes.push_back({{"name", "both"},
                     {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}, {"EXT_lights_ies", {{"light", 0}}}}}});
    file_.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 3.3}}};
    folder_.write("lamp.ies", "IES:LM-63-2019\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n100.1 33.3\n");
    file_.root["extensions"]["EXT_lights_ies"]["lights"] = {{{"uri", "lamp.ies"}}};
    file_.root["extensionsUsed"] = {"KHR_lights_punctual", "EXT_lights_ies", "EXT_mesh_gpu_instancing"};
    json rules = {{"version", 1},
                  {"lamps",
                   {{{"name", "lobe"},
                     {"nodes", "*"},
                     {"type", "spot"},
                     {"intensity_cd", 321.7},
                     {"outer_cone_deg", 60},
                     {"aim", {1, 1, 1}}},
                    {{"name", "measured"},
                     {"nodes", "b*"},
                     {"type", "distribution"},
                     {"file", "lamp.ies"},
                     {"flux_scale", 0.7},
                     {"colour_temperature_K", 2100}}}},
                  {"emitters",
                   {{{"materials", "lit*"}, {"luminance_cd_m2", 5}}, {{"materials", "glass"}, {"luminance_cd_m2", 0}}}},
                  {"surfaces", {{{"materials", "*"}, {"reflectance_scale", 0.5}, {"roughness", 0.3}}}}};
    for (const bool keep : {false, true}) {
        rules["lights"]["keep"] = keep;
        expect_same_with(rules);
    }
    const scene::Scene made = scene::read_lit_scene(folder_ / "in.gltf", folder_ / "p.json").scene;
    EXPECT_EQ(made.materials[1].alpha, scene::Material::Alpha::Opaque) << "it shines now";
    EXPECT_EQ(made.materials[0].alpha, scene::Material::Alpha::Mask) << "it shines no more";
    EXPECT_FLOAT_EQ(made.materials[2].base_colour.r, 0.8f * 0.7f * 0.5f) << "what the specular part leaves, once";
    EXPECT_FLOAT_EQ(made.materials[3].roughness, 0.3f) << "also of an unlit material";
    EXPECT_EQ(made.materials.back().base_colour.r, 0.5f) << "no rule is for what names no material";
}

TEST_F(ApplyToFile, RefusesWithPlaceAndReason) {
    file_.show({{"attributes", {{"POSITION", file_.vec3(kTriangle)}}}}, {{"name", "a"}, {"translation", {3e38, 0, 0}}});
    const auto complaint = [&](const json& rules) {
        const fs::path photometry = folder_.write("p.json", rules.dump());
        return complaint_of([&] { scene::read_lit_scene(folder_.write("in.gltf", file_.text()), photometry); });
    };
    EXPECT_EQ(complaint({{"version", 1}}), "");
    EXPECT_TRUE(contains(complaint({{"version", 2}}), "p.json: /version: "));
    json lamp = {{"name", "l"}, {"nodes", "a"}, {"type", "point"}, {"intensity_cd", 5}, {"offset_m", {3e38, 0, 0}}};
    EXPECT_TRUE(
        contains(complaint({{"version", 1}, {"lamps", {lamp}}}),
                 "in.gltf: node 'l': its transform and those above it multiply to a number that is not finite"));
    lamp["offset_m"] = {0, 0, 0}, lamp["fixture"] = "none such";
    EXPECT_TRUE(contains(complaint({{"version", 1}, {"lamps", {lamp}}}), "p.json: /lamps/0/fixture: no node"));
    file_.root["extras"]["vesper"] = {{"version", 1}};
    EXPECT_TRUE(contains(complaint({{"version", 1}}), "in.gltf: /extras/vesper: the file has been converted already"));
}

TEST(ApplyPhotometryToScene, NeedsNoFile) {
    scene::Scene scene;
    scene.materials.push_back({.name = "road"});
    scene.nodes.push_back({.name = "lamp", .translation = {0, 8, 0}});
    scene.nodes.push_back({.name = "other"});
    scene.channels.push_back({.node = 1, .times = {0}, .values = {glm::vec4(0)}});
    scene::Photometry rules;
    rules.lamps.push_back(
        {.name = "street", .nodes = {"lamp"}, .lamp = {.intensity = 1800}, .aim = glm::dvec3(0, -1, 0)});
    rules.surfaces.push_back({.name = "road", .materials = {"road"}, .reflectance_scale = 0.1, .roughness = 0.8});
    const scene::PhotometryReport report = scene::apply_photometry(scene, rules, "street");
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.nodes[1].name, "street") << "before the nodes that do not hang on its parent";
    EXPECT_EQ(scene.nodes[1].parent, 0u);
    EXPECT_EQ(report.node_of, (std::vector<uint32_t>{0, 2}));
    EXPECT_EQ(scene.channels[0].node, 2u);
    EXPECT_EQ(scene.lamps.at(scene.nodes[1].lamp).intensity, 1800);
    const glm::dvec3 axis = -glm::dvec3(scene::world_transforms(scene, 0)[1][2]);
    EXPECT_NEAR(glm::distance(axis, glm::dvec3(0, -1, 0)), 0, 1e-6);
    EXPECT_FLOAT_EQ(scene.materials[0].base_colour.g, 0.1f);
    EXPECT_FLOAT_EQ(scene.sky_luminance, 0.02f);
}

TEST(HalfSky, GoesThroughHalfFloatsOnce) {
    photometry::Environment sky{4, 2, {}, 0};
    for (int i = 0; i < 24; ++i) sky.rgb.push_back(std::exp(float(i) / 3) * 1.2345f);
    const photometry::Environment once = scene::as_half_floats(sky), twice = scene::as_half_floats(once);
    EXPECT_EQ(once.rgb, twice.rgb);
    for (size_t i = 0; i < 24; ++i) EXPECT_NEAR(once.rgb[i] / sky.rgb[i], 1, 5e-4);
}

TEST(SettledRotation, StaysWhenReadAgain) {
    for (int i = 1; i < 500; ++i) {
        const glm::dquat turn = glm::normalize(glm::dquat(std::sin(i), std::cos(3.7 * i), std::sin(1.3 * i), 0.2));
        const glm::quat settled = scene::settled_rotation(turn);
        EXPECT_EQ(settled, scene::unit_rotation({settled.x, settled.y, settled.z, settled.w})) << i;
        EXPECT_NEAR(std::abs(glm::dot(glm::dquat(settled), turn)), 1, 1e-6);
    }
    EXPECT_FALSE(scene::unit_rotation(glm::vec4(0)));
}

// A lamp that is built in is no file of that name, and what is said of it does not read like one.
TEST(ApplyPhotometry, NotesOfBuiltInLampsNameNoFile) {
    const TempFolder folder;
    const fs::path file = folder.write("p.json", R"({"version": 1, "lamps": [{"nodes": "a", "type": "distribution",
        "standard": "street-lamp"}]})");
    scene::Photometry rules = scene::read_photometry(file);
    for (const bool standard : {true, false}) {
        rules.measured.at(0).standard = standard;
        rules.measured[0].distribution.notes = {"is odd"};
        scene::Scene street;
        street.nodes.push_back({.name = "a"});
        const std::vector<std::string> warnings = scene::apply_photometry(street, rules, "s.gltf").warnings;
        const std::string said = std::string(standard ? "built-in lamp " : "") + "'street-lamp': is odd";
        EXPECT_NE(std::find(warnings.begin(), warnings.end(), said), warnings.end()) << said;
    }
}

}  // namespace
}  // namespace vesper::test
