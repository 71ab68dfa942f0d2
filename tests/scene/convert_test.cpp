// Conversion, from file to file: what the reader gets is what the photometry file states. SPDX-License-Identifier: MIT
#include "scene/convert.h"

#include <algorithm>
#include <cmath>

#include "scene/colour.h"
#include "support/conversion.h"

namespace vesper::test {
namespace {

using nlohmann::json;

/// A street in miniature: a lamp with a light node, two cars, three materials, a picture beside the file.
class ConvertTest : public ConversionTest {
protected:
    ConvertTest() {
        add_wall_picture();
        street_.root["materials"] = {
            {{"name", "wall"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}},
            {{"name", "lamp_glass"},
             {"pbrMetallicRoughness", {{"baseColorFactor", {0.4, 0.4, 0.4, 1}}, {"metallicFactor", 0}}}},
            {{"name", "asphalt_wet"},
             {"extras", {{"kept", 42}}},
             {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.2, 0.2, 1}}}}}};
        std::vector<float> wide = kTriangle;
        for (float& x : wide) x *= 20;
        const size_t position = street_.vec3(wide), uv = street_.vec2({0, 0, 1, 0, 0, 1});
        for (int material : {0, 1, 2})
            street_.show({{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"material", material}});
        json& nodes = street_.root["nodes"];
        nodes.push_back({{"name", "street_lamp_0"}, {"children", {4}}});
        nodes.push_back({{"name", "light"}, {"translation", {0, 6.5, 0}}});
        for (const char* name : {"car_0/headlamp_left", "car_0/headlamp_right"})
            nodes.push_back({{"name", name}, {"scale", {2, 2, 2}}});
        nodes.push_back({{"name", "sun"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
        street_.root["extensionsUsed"] = {"KHR_lights_punctual"};
        street_.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"intensity", 1e5}}};
        street_.root["extras"]["author"] = "nobody";
    }

    json lamps() const {
        return {{{"name", "street lamp"},
                 {"nodes", "street_lamp_*/light"},
                 {"type", "spot"},
                 {"intensity_cd", 1800},
                 {"inner_cone_deg", 40},
                 {"outer_cone_deg", 80},
                 {"colour_temperature_K", 2100}},
                {{"name", "low beam"},
                 {"nodes", {"car_*/headlamp_*"}},
                 {"type", "cosine_power"},
                 {"intensity_cd", 12000},
                 {"exponent", 250},
                 {"colour_rgb", {1, 0.9, 0.8}},
                 {"aim", {1, 0, 0}},
                 {"offset_m", {0, 0, 0.5}}}};
    }

    std::string complaint_with(const json& photometry, const std::string& output = "out.gltf") {
        return complaint_of([&] { convert_with(photometry, output); });
    }
};

// Bytes that are there uncompressed are all that is written: what says where the compressed ones lie would point
// elsewhere.
TEST_F(ConvertTest, LeavesOutCompressionThatNobodyNeeds) {
    for (json& view : street_.root["bufferViews"])
        view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 1},      {"byteOffset", 0}, {"byteLength", 8},
                                                         {"byteStride", 12}, {"count", 1},      {"mode", "ATTRIBUTES"}};
    street_.root["bufferViews"][0]["extensions"]["KEPT"] = 1;
    street_.root["extensionsUsed"].push_back("EXT_meshopt_compression");
    for (const char* output : {"out.gltf", "out.glb"}) {
        convert_with(json::object(), output);
        const std::string text = read_text(folder_ / output);
        EXPECT_FALSE(contains(text, "EXT_meshopt_compression")) << output;
        EXPECT_TRUE(contains(text, "\"extensions\":{\"KEPT\":1}")) << output;
        EXPECT_FALSE(converted(output).meshes.empty());
    }
}

TEST_F(ConvertTest, PicturesThatNothingShowsNeedNotBeThere) {
    street_.root["images"].push_back({{"uri", "missing_normal.png"}});
    street_.root["textures"].push_back({{"source", 1}});
    street_.root["materials"][1]["normalTexture"] = {{"index", 1}};
    for (const char* output : {"out.gltf", "out.glb"}) {
        const scene::PhotometryReport report = convert_with(json::object(), output);
        EXPECT_TRUE(mentions(report.warnings, "/images/1/uri")) << output;
        EXPECT_TRUE(contains(read_text(folder_ / output), "\"uri\":\"missing_normal.png\"")) << output;
        EXPECT_EQ(converted(output).images.size(), 1u);
    }
    street_.root["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 1}};
    // Where something shows it, that is as its material says, here and in the result.
    const scene::PhotometryReport report = convert_with(json::object());
    EXPECT_TRUE(mentions(report.warnings, "missing_normal.png: cannot be opened"));
    EXPECT_EQ(converted().materials[1].base_colour_texture.image, scene::kNone);
}

TEST_F(ConvertTest, PutsLampsOnNodes) {
    const scene::PhotometryReport report = convert_with({{"lamps", lamps()}});
    const scene::Scene scene = converted();
    ASSERT_EQ(scene.lamps.size(), 2u);
    const scene::Lamp &street = scene.lamps[0], &beam = scene.lamps[1];
    EXPECT_EQ(street.kind, scene::Lamp::Kind::Spot);
    EXPECT_NEAR(street.intensity, 1800, 1e-3);
    EXPECT_NEAR(street.outer_cone, 80 * std::acos(-1.0) / 180, 1e-6);
    const glm::vec3 wanted = scene::colour_of_temperature(2100);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(street.colour[c], wanted[c], 1e-5);
    EXPECT_EQ(beam.kind, scene::Lamp::Kind::CosinePower);
    EXPECT_EQ(beam.exponent, 250);
    EXPECT_NEAR(beam.intensity, 12000, 1e-2);
    EXPECT_NEAR(beam.colour.g / beam.colour.r, 0.9, 1e-6);
    EXPECT_NEAR(luminance(beam.colour), 1, 1e-6);

    // One lamp on its node, two on children that turn and move them; the offset is in metres whatever the scale.
    const auto world = scene::world_transforms(scene, 0);
    std::vector<uint32_t> lit;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].lamp != scene::kNone) lit.push_back(i);
    ASSERT_EQ(lit.size(), 3u);
    EXPECT_EQ(scene.nodes[lit[0]].name, "light");
    EXPECT_EQ(world[lit[0]][3], glm::dvec4(0, 6.5, 0, 1));
    const glm::vec3 axis = -glm::vec3(world[lit[1]][2]);
    EXPECT_NEAR(glm::normalize(axis).x, 1, 1e-6);
    EXPECT_NEAR(world[lit[1]][3].z, 0.5, 1e-6);

    EXPECT_TRUE(mentions(report.changes, "lamp 'street lamp': 1 node, spot 40-80 deg, 1800 cd, 2100 K"));
    EXPECT_TRUE(mentions(report.changes, "lamp 'low beam': 2 nodes, cosine power 250, 1.2e+04 cd, 300.4 lm each"));
    EXPECT_TRUE(mentions(report.changes, "removed 1 light"));
    EXPECT_TRUE(mentions(report.warnings, "1 directional light"));
}

TEST_F(ConvertTest, StoresStandardGltf) {
    convert_with({{"lamps", lamps()}, {"emitters", {{{"materials", "lamp_glass"}, {"luminance_cd_m2", 7000}}}}});
    const json root = json::parse(read_text(folder_ / "out.gltf"));
    for (const json& lamp : root["extensions"]["KHR_lights_punctual"]["lights"]) {
        double brightest = 0, y = 0;
        const double weights[] = {0.212639, 0.715169, 0.072192};
        for (size_t c = 0; c < 3; ++c) {
            brightest = std::max(brightest, lamp["color"][c].get<double>());
            y += weights[c] * lamp["color"][c].get<double>();
        }
        EXPECT_NEAR(brightest, 1, 1e-12);
        EXPECT_NEAR(lamp["intensity"].get<double>() * y, lamp["name"] == "low beam" ? 12000 : 1800, 1e-2);
        EXPECT_LT(lamp["spot"]["innerConeAngle"], lamp["spot"]["outerConeAngle"]);
    }
    EXPECT_EQ(root["extensionsUsed"], json({"KHR_lights_punctual", "KHR_materials_emissive_strength"}));
    EXPECT_EQ(root["extras"]["author"], "nobody");
    EXPECT_EQ(root["materials"][2]["extras"]["kept"], 42);
    EXPECT_EQ(root["extras"]["vesper"]["version"], 1);
    EXPECT_EQ(root["extras"]["vesper"]["transfer"], json({{"kind", "gamma"}, {"gamma", 2.2}}));
    EXPECT_EQ(root["extras"]["vesper"]["provenance"]["photometry"], "p.json");
}

TEST_F(ConvertTest, MakesMaterialsEmit) {
    const scene::PhotometryReport report = convert_with(
        {{"emitters",
          {{{"name", "glass"}, {"materials", "lamp_gl*"}, {"luminance_cd_m2", 7000}, {"colour_temperature_K", 2100}},
           {{"name", "rest"}, {"materials", "*glass"}, {"luminance_cd_m2", 1}},
           {{"name", "window"}, {"materials", "wall"}, {"luminance_cd_m2", 50}, {"modulate", true}}}}});
    const scene::Scene scene = converted();
    EXPECT_NEAR(luminance(scene.materials[1].emission), 7000, 1e-2);
    EXPECT_EQ(scene.materials[1].emission_texture.image, scene::kNone);
    // The brightest texel of the wall, (255, 128, 0) through sRGB, shows the luminance stated.
    const scene::Material& wall = scene.materials[0];
    ASSERT_EQ(wall.emission_texture.image, wall.base_colour_texture.image);
    const double green = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(luminance(glm::dvec3(wall.emission) * glm::dvec3(1, green, 0)), 50, 1e-3);
    EXPECT_TRUE(mentions(report.warnings, "emitter 'rest': matches only materials that earlier rules have taken"));
    EXPECT_TRUE(mentions(report.changes, "emitter 'window': 1 material, 50 cd/m^2 at most"));
}

TEST_F(ConvertTest, ChangesSurfaces) {
    const scene::PhotometryReport report =
        convert_with({{"surfaces",
                       {{{"materials", "asphalt*"}, {"reflectance_scale", 0.5}, {"roughness", 0.8}, {"metallic", 0}},
                        {{"materials", "lamp_glass"}, {"reflectance_scale", 4}}}}});
    const scene::Scene scene = converted();
    EXPECT_EQ(scene.materials[2].base_colour, glm::vec4(0.1f, 0.1f, 0.1f, 1));
    EXPECT_EQ(scene.materials[2].metallic, 0);
    EXPECT_FLOAT_EQ(scene.materials[2].roughness, 0.8f);
    EXPECT_EQ(scene.materials[1].base_colour.r, 1);
    EXPECT_TRUE(mentions(report.warnings, "cannot be more than 1"));
}

TEST_F(ConvertTest, KeepsPicturesByteForByte) {
    const std::string picture = read_text(folder_ / "wall.png");
    for (const char* output : {"out.gltf", "out.glb"}) {
        convert_with({{"lamps", lamps()}}, output);
        const TempFolder elsewhere;  // nothing beside it
        std::filesystem::copy(folder_ / output, elsewhere / output);
        const scene::LoadedScene loaded = scene::read_scene(elsewhere / output);
        EXPECT_EQ(loaded.scene.images.at(0).rgba, (std::vector<uint8_t>{255, 128, 0, 255, 10, 10, 10, 255}));
        EXPECT_EQ(loaded.scene.lamps.size(), 2u);
        EXPECT_EQ(loaded.scene.meshes.at(2).primitives.at(0).vertices.at(1).position, glm::vec3(20, 0, 0));
        const std::string file = read_text(elsewhere / output);
        const std::string code =
            scene::encode_data_uri("image/png", {reinterpret_cast<const uint8_t*>(picture.data()), picture.size()});
        EXPECT_NE(file.find(std::string(output) == "out.glb" ? picture : code), std::string::npos) << output;
    }
}

TEST_F(ConvertTest, RecordsTransferAmbientAndSky) {
    EXPECT_NO_THROW(convert_with({{"ambient", {{"illuminance_lx", 0.4}, {"colour_temperature_K", 3200}}},
                                  {"sky", {{"luminance_cd_m2", 0.02}}}}));
    scene::Scene scene = converted();
    EXPECT_EQ(scene.transfer.kind, scene::Transfer::Kind::Gamma);
    EXPECT_FLOAT_EQ(scene.transfer.gamma, 2.2f);
    EXPECT_FLOAT_EQ(scene.ambient_illuminance, 0.4f);
    EXPECT_NEAR(scene.ambient_colour.b, scene::colour_of_temperature(3200).b, 1e-6);
    EXPECT_FLOAT_EQ(scene.sky_luminance, 0.02f);
    convert_with({{"textures", {{"transfer", "gamma"}, {"gamma", 2.4}}}});
    EXPECT_FLOAT_EQ(converted().transfer.gamma, 2.4f);
    convert_with({{"textures", {{"gamma", 2.4}}}}, "out.gltf", scene::Transfer{scene::Transfer::Kind::Srgb, 2.2f});
    EXPECT_EQ(converted().transfer.kind, scene::Transfer::Kind::Srgb);
}

TEST_F(ConvertTest, KeepsLightsWhenAsked) {
    const scene::PhotometryReport report = convert_with({{"lights", {{"keep", true}}}, {"lamps", lamps()}});
    const scene::Scene scene = converted();
    ASSERT_EQ(scene.lamps.size(), 3u);
    EXPECT_EQ(scene.lamps[0].kind, scene::Lamp::Kind::Directional);
    EXPECT_EQ(scene.lamps[2].kind, scene::Lamp::Kind::CosinePower);  // the lobe refers to the right one
    EXPECT_FALSE(mentions(report.changes, "removed"));
}

TEST_F(ConvertTest, PutsSeveralLampsOnOneNode) {
    json rules = lamps();
    rules.push_back({{"name", "second"}, {"nodes", "light"}, {"type", "point"}, {"intensity_cd", 3}});
    convert_with({{"lamps", rules}});
    const scene::Scene scene = converted();
    EXPECT_EQ(std::count_if(scene.nodes.begin(), scene.nodes.end(),
                            [](const scene::Node& n) { return n.lamp != scene::kNone; }),
              4);
}

TEST_F(ConvertTest, WarnsOfWhatCannotBeRight) {
    street_.root["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"] = {0.95, 0.95, 0.95, 1};
    street_.root["nodes"].push_back({{"name", "forgotten_lantern"}});
    const scene::PhotometryReport report =
        convert_with({{"lamps",
                       {{{"name", "none"}, {"nodes", "no_such_node"}, {"type", "point"}, {"intensity_cd", 5}},
                        {{"name", "star"}, {"nodes", "light"}, {"type", "point"}, {"intensity_cd", 5e6}}}},
                      {"emitters", {{{"materials", "no_such_material"}, {"luminance_cd_m2", 5}}}}});
    EXPECT_TRUE(mentions(report.warnings, "lamp 'none': no node matches 'no_such_node'"));
    EXPECT_TRUE(mentions(report.warnings, "lamp 'star': 5e+06 cd"));
    EXPECT_TRUE(mentions(report.warnings, "no material matches 'no_such_material'"));
    EXPECT_TRUE(mentions(report.warnings, "material 'lamp_glass': a mean reflectance of 0.95"));
    EXPECT_TRUE(mentions(report.warnings, "material 'lamp_glass' sounds like a light"));
    EXPECT_TRUE(mentions(report.warnings, "'forgotten_lantern'"));
    EXPECT_FALSE(mentions(report.warnings, "'street_lamp_0'"));  // its child is lit
    EXPECT_FALSE(mentions(report.warnings, "metres"));
    GltfFile toy;
    toy.show({{"attributes", {{"POSITION", toy.vec3({0, 0, 0, 0.1f, 0, 0, 0, 0.1f, 0})}}}});
    const auto small = scene::convert(folder_.write("toy.gltf", toy.text()),
                                      folder_.write("p.json", "{\"version\": 1}"), folder_ / "toy-out.gltf");
    EXPECT_TRUE(mentions(small.warnings, "metres"));
}

TEST_F(ConvertTest, WeighsReflectanceThroughTheTransfer) {
    // A white picture has reflectance 1; (255, 128, 0) and (10, 10, 10) are well below.
    EXPECT_FALSE(mentions(convert_with(json::object()).warnings, "material 'wall'"));
    const std::vector<uint8_t> white(8, 255);
    io::write_png(folder_ / "wall.png", 2, 1, white);
    EXPECT_TRUE(mentions(convert_with(json::object()).warnings, "material 'wall': a mean reflectance of 1"));
}

TEST_F(ConvertTest, RefusesAndLeavesNothingBehind) {
    EXPECT_TRUE(contains(complaint_with(json::object(), "out.obj"), "out.obj"));
    EXPECT_TRUE(contains(complaint_with(json::object(), "in.gltf"), "would replace what is read"));
    EXPECT_TRUE(contains(complaint_with({{"lamp", 1}}), "p.json: /lamp"));
    json many = json::array();
    for (int i = 0; i <= 21000; ++i)
        many.push_back({{"name", "l"}, {"nodes", "light"}, {"type", "point"}, {"intensity_cd", 5}});
    EXPECT_TRUE(contains(complaint_with({{"lamps", many}}), "p.json: /lamps: "));
    EXPECT_TRUE(contains(complaint_with({{"lamps", many}}), " lamps, more than the limit of 21000"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.gltf"));
    EXPECT_TRUE(contains(complaint_with(json::object(), "no/out.gltf"), "no/out.gltf"));
    const json whole = street_.root;
    street_.root["nodes"][0]["mesh"] = 99;
    EXPECT_TRUE(contains(complaint_with(json::object()), "/nodes/0/mesh"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.gltf"));
    street_.root = whole;
    street_.root["extras"]["vesper"] = {{"version", 1}};
    EXPECT_TRUE(contains(complaint_with(json::object()), "converted already"));
}

TEST_F(ConvertTest, GivesTheSameBytesEachTime) {
    convert_with({{"lamps", lamps()}}, "a.glb");
    convert_with({{"lamps", lamps()}}, "b.glb");
    EXPECT_EQ(read_text(folder_ / "a.glb"), read_text(folder_ / "b.glb"));
}

}  // namespace
}  // namespace vesper::test
