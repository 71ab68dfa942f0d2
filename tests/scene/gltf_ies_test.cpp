// EXT_lights_ies: measured lamps in glTF files. SPDX-License-Identifier: MIT
#include "photometry/ies.h"
#include "scene/colour.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using nlohmann::json;

const std::string kProfile =
    "IES:LM-63-2019\n[LUMINAIRE] Lamp 7\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1.00001 20\n0 45 90\n0\n100 50 25\n";

std::vector<uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

json use(size_t lamp) { return {{"EXT_lights_ies", {{"light", lamp}}}}; }

/// A profile in a buffer view and one in a data URI, each on a node.
GltfFile lamps() {
    GltfFile file;
    const size_t view = file.buffer_view(bytes_of(kProfile));
    file.root["extensionsUsed"] = {"EXT_lights_ies"};
    file.root["extensionsRequired"] = {"EXT_lights_ies"};
    file.root["extensions"]["EXT_lights_ies"]["lights"] = {
        {{"bufferView", view}, {"mimeType", "application/x-ies-lm-63"}},
        {{"uri", scene::encode_data_uri("application/x-ies-lm-63", bytes_of(kProfile))}, {"name", "second"}}};
    for (size_t i = 0; i < 2; ++i) file.root["nodes"].push_back({{"extensions", use(i)}});
    return file;
}

TEST(GltfIes, ReadsProfilesAndTheirUse) {
    GltfFile file = lamps();
    json& lamp = file.root["nodes"][1]["extensions"]["EXT_lights_ies"];
    lamp["multiplier"] = 3;
    lamp["color"] = {0.5, 0.25, 7};  // clamped to 1
    file.root["nodes"].push_back({{"extensions", use(0)}});
    const scene::LoadedScene loaded = file.read();
    const scene::Scene& scene = loaded.scene;
    EXPECT_TRUE(loaded.notes.empty());
    ASSERT_EQ(scene.distributions.size(), 2u);
    EXPECT_EQ(scene.distributions[0].name, "Lamp 7");
    EXPECT_EQ(scene.distributions[1].name, "second");
    EXPECT_EQ(scene.distributions[0].candela, (std::vector<double>{100, 50, 25}));
    ASSERT_EQ(scene.lamps.size(), 2u);  // the third node shares the first one's
    EXPECT_EQ(scene.nodes[2].lamp, scene.nodes[0].lamp);
    const scene::Lamp &first = scene.lamps[scene.nodes[0].lamp], &second = scene.lamps[scene.nodes[1].lamp];
    EXPECT_EQ(first.kind, scene::Lamp::Kind::Measured);
    EXPECT_EQ(first.distribution, 0u);
    EXPECT_EQ(first.intensity, 1);
    EXPECT_EQ(first.colour, glm::vec3(1));
    const double y = 0.212639 * 0.5 + 0.715169 * 0.25 + 0.072192;
    EXPECT_EQ(second.distribution, 1u);
    EXPECT_NEAR(second.intensity, 3 * y, 1e-6);
    EXPECT_NEAR(second.colour.r, 0.5 / y, 1e-6);
    EXPECT_NEAR(luminance(second.colour), 1, 1e-6);
}

TEST(GltfIes, ReadsAFileBesideIt) {
    const TempFolder folder;
    folder.write("lamp.ies", kProfile);
    GltfFile file = lamps();
    file.root["extensions"]["EXT_lights_ies"]["lights"][0] = {{"uri", "lamp.ies"}};
    EXPECT_EQ(scene::read_scene(folder.write("a.gltf", file.text())).scene.distributions[0].name, "Lamp 7");
    file.root["extensions"]["EXT_lights_ies"]["lights"][0] = {{"uri", "none.ies"}};
    EXPECT_TRUE(contains(file.complaint(), "/extensions/EXT_lights_ies/lights/0/uri"));
}

TEST(GltfIes, ANodeMayHoldBothKindsOfLight) {
    GltfFile file = lamps();
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 5}}};
    file.root["nodes"][0]["name"] = "lantern";
    file.root["nodes"][0]["translation"] = {1, 2, 3};
    file.root["nodes"][0]["extensions"]["KHR_lights_punctual"] = {{"light", 0}};
    const scene::Scene scene = file.read().scene;
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.lamps[scene.nodes[0].lamp].kind, scene::Lamp::Kind::Point);
    EXPECT_EQ(scene.nodes[1].name, "lantern");
    EXPECT_EQ(scene.nodes[1].parent, 0u);
    EXPECT_EQ(scene.lamps[scene.nodes[1].lamp].kind, scene::Lamp::Kind::Measured);
    EXPECT_EQ(scene::world_transforms(scene, 0)[1][3], glm::dvec4(1, 2, 3, 1));
    // The index of a punctual light does not reach into the measured ones.
    file.root["nodes"][1]["extensions"]["KHR_lights_punctual"] = {{"light", 1}};
    EXPECT_TRUE(contains(file.complaint(), "KHR_lights_punctual/light"));
}

TEST(GltfIes, NamesThePlaceOfWhatIsWrong) {
    const std::vector<Fault> faults{
        {"/nodes/0/extensions/EXT_lights_ies/light", 2, "/nodes/0/extensions/EXT_lights_ies/light"},
        {"/nodes/0/extensions/EXT_lights_ies/multiplier", -1, "EXT_lights_ies/multiplier"},
        {"/nodes/0/extensions/EXT_lights_ies/color", {1, 1}, "EXT_lights_ies/color"},
        {"/extensions/EXT_lights_ies/lights/0/mimeType", "text/plain", "lights/0/mimeType"},
        {"/extensions/EXT_lights_ies/lights/0/bufferView", 9, "lights/0/bufferView"},
        {"/extensions/EXT_lights_ies/lights/0", json::object(), "lights/0: has neither uri nor bufferView"},
        {"/extensions/EXT_lights_ies/lights/1/uri", "data:,IES91", "EXT_lights_ies/lights/1: line 2: the file ends"},
    };
    expect_places(lamps().root, faults, [](const json& root) {
        GltfFile file = lamps();
        file.root = root;
        return file.complaint();
    });
    GltfFile file = lamps();
    scene::SceneLimits limits;
    limits.candela = 5;
    EXPECT_TRUE(contains(file.complaint(limits), "lights/1: more intensities than the limit of 5"));
}

}  // namespace
}  // namespace vesper::test
