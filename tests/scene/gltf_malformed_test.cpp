// Damaged and hostile glTF files: each must be refused in one line that says where. SPDX-License-Identifier: MIT
#include <limits>

#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using nlohmann::json;
using scene::read_scene;

/// A valid triangle with indices, to be damaged.
GltfFile triangle() {
    GltfFile file;
    const size_t position = file.vec3(kTriangle), indices = file.indices({0, 1, 2});
    file.show({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
    return file;
}

TEST(GltfMalformed, TheUndamagedFileIsRead) { EXPECT_EQ(triangle().complaint(), ""); }

TEST(GltfMalformed, NamesThePlaceOfWhatIsWrong) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<Fault> faults{
        {"/asset/version", "1.0", "/asset/version"},
        {"/asset/minVersion", "2.1", "/asset/minVersion"},
        {"/extensionsRequired", {"KHR_materials_unknown"}, "KHR_materials_unknown"},
        {"/extensionsRequired", {"EXT_unknown_compression"}, "EXT_unknown_compression"},
        {"/meshes/0/primitives/0/attributes/POSITION", 17, "/meshes/0/primitives/0/attributes/POSITION"},
        {"/meshes/0/primitives/0/indices", 0, "/accessors/0"},  // not scalar
        {"/meshes/0/primitives/0/material", 0, "/meshes/0/primitives/0/material"},
        {"/meshes/0/primitives/0/mode", 7, "/meshes/0/primitives/0/mode"},
        {"/nodes/0/mesh", 1, "/nodes/0/mesh"},
        {"/nodes/0/mesh", -1, "/nodes/0/mesh"},
        {"/nodes/0/mesh", "0", "/nodes/0/mesh"},
        {"/nodes/0/mesh", 1ull << 32, "/nodes/0/mesh"},
        {"/nodes/0/mesh", 0.5, "/nodes/0/mesh"},
        {"/nodes/0/weights", {1, "1"}, "/nodes/0/weights/1"},
        {"/meshes/0/primitives/0/attributes", {0}, "/meshes/0/primitives/0/attributes"},
        {"/meshes/0/primitives/0/targets", {{{"POSITION", 2}}}, "/meshes/0/primitives/0/targets/0/POSITION"},
        {"/materials",
         {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1}}}}}},
         "/materials/0/pbrMetallicRoughness/baseColorFactor"},
        {"/materials", {{{"emissiveTexture", {{"index", 0}}}}}, "/materials/0/emissiveTexture/index"},
        {"/accessors/0/sparse", {{"count", 1ull << 31}}, "/accessors/0/sparse/count"},
        {"/nodes/0", nullptr, "/nodes/0"},
        {"/nodes", json::object(), "/nodes"},
        {"/nodes/0/children", {0}, "/nodes/0"},
        {"/nodes/0/translation", {0, 0}, "/nodes/0/translation"},
        {"/nodes/0/translation", {0, 0, 1e300}, "/nodes/0/translation/2"},
        {"/nodes/0/rotation", {0, 0, 0, 0}, "/nodes/0/rotation"},
        {"/nodes/0/matrix", json::array({nan}), "/nodes/0/matrix"},
        {"/accessors/0/count", 4, "/accessors/0"},
        {"/accessors/0/count", 0, "/accessors/0/count"},
        {"/accessors/0/count", 4294967295u, "/accessors/0/count"},
        {"/accessors/0/count", 18446744073709551615u, "/accessors/0/count"},
        {"/accessors/0/byteOffset", 18446744073709551615u, "/accessors/0"},
        {"/accessors/0/byteOffset", 4, "/accessors/0"},
        {"/accessors/0/componentType", 5124, "/accessors/0/componentType"},
        {"/accessors/0/type", "VEC5", "/accessors/0/type"},
        {"/accessors/0/bufferView", 9, "/accessors/0/bufferView"},
        {"/accessors/1/componentType", 5126, "/accessors/1"},
        {"/bufferViews/0/byteStride", 4, "/bufferViews/0"},
        {"/bufferViews/0/byteLength", 18446744073709551615u, "/bufferViews/0"},
        {"/bufferViews/0/byteOffset", 18446744073709551610u, "/bufferViews/0"},
        {"/bufferViews/0/buffer", 3, "/bufferViews/0/buffer"},
        {"/buffers/0/byteLength", 1u << 30, "/buffers/0"},
        {"/buffers/0/uri", "data:;base64,AAA*", "/buffers/0/uri"},
        {"/buffers/0/uri", "nowhere.bin", "/buffers/0/uri"},
        {"/buffers/0/uri", "/dev/zero", "/buffers/0/uri"},
        {"/cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 1}}}}}, ""},
        {"/animations",
         {{{"channels", {{{"sampler", 3}, {"target", {{"node", 0}, {"path", "scale"}}}}}},
           {"samplers", json::array()}}},
         "/animations/0/channels/0/sampler"},
        {"/extensions/KHR_lights_punctual/lights",
         {{{"type", "point"}, {"intensity", -1}}},
         "/extensions/KHR_lights_punctual/lights/0/intensity"},
        {"/extensions/KHR_lights_punctual/lights",
         {{{"type", "point"}, {"color", {1, 1, 1e39}}}},
         "/extensions/KHR_lights_punctual/lights/0/color/2"},
        {"/materials",
         {{{"emissiveFactor", {1e38, 0, 0}},
           {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e30}}}}}}},
         "/materials/0/emissiveFactor"},
    };
    GltfFile good = triangle();
    good.text();
    expect_places(good.root, faults, [](const json& root) {
        GltfFile file;
        file.root = root;
        const std::string complaint = file.complaint();
        if (!complaint.empty()) {
            EXPECT_TRUE(contains(complaint, "scene.gltf: "));
            EXPECT_EQ(complaint.find('\n'), std::string::npos);
        }
        return complaint;
    });
}

// tinygltf reads 0.0 as no index at all.
TEST(GltfMalformed, WholeNumbersMayHaveAPoint) {
    GltfFile file = triangle();
    file.root["nodes"][0]["mesh"] = 0.0;
    file.root["meshes"][0]["primitives"][0]["indices"] = 1.0;
    file.root["accessors"][0]["count"] = 3.0;
    const scene::Scene scene = file.read().scene;
    EXPECT_EQ(scene.nodes.at(0).mesh, 0u);
    EXPECT_EQ(scene.meshes.at(0).primitives.at(0).indices.size(), 3u);
}

// tinygltf cuts the names of attributes there.
TEST(GltfMalformed, NamesOfAttributesMayHoldNul) {
    GltfFile file = triangle();
    file.root["meshes"][0]["primitives"][0]["attributes"][std::string("NORMAL\0", 7)] = 99;
    EXPECT_TRUE(contains(file.complaint(), "names number 99 of the accessors"));
}

// An element of tinygltf takes up to 2 kB, its text two bytes.
TEST(GltfMalformed, RefusesListsOfEmptyElements) {
    GltfFile file;
    file.root["materials"] = json(1000, json::object());
    EXPECT_EQ(file.complaint(), "");
    file.root["materials"] = json(200'000, json::object());
    EXPECT_TRUE(contains(file.complaint(), "lists of empty elements"));
    file.root["materials"] = json::array();
    file.root["nodes"] = json(900'000, json::object());
    EXPECT_TRUE(contains(file.complaint(), "lists of empty elements"));
}

TEST(GltfMalformed, RefusesCyclesAndSecondParents) {
    GltfFile file;
    file.root["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {1}}}};
    EXPECT_TRUE(contains(file.complaint(), "more than one parent"));
    file.root["nodes"] = {json::object(), {{"children", {2}}}, {{"children", {1}}}};
    EXPECT_TRUE(contains(file.complaint(), "own ancestor"));
}

TEST(GltfMalformed, RefusesNumbersThatAreNotFinite) {
    GltfFile file;
    std::vector<float> position = kTriangle;
    position[4] = std::numeric_limits<float>::infinity();
    file.show({{"attributes", {{"POSITION", file.vec3(position)}}}});
    EXPECT_TRUE(contains(file.complaint(), "position 1 is not finite"));
    GltfFile tree;
    for (int i = 0; i < 4; ++i) tree.root["nodes"].push_back({{"scale", {1e20, 1, 1}}, {"children", {i + 1}}});
    tree.root["nodes"].push_back(json::object());
    EXPECT_TRUE(contains(tree.complaint(), "not finite"));
}

TEST(GltfMalformed, RefusesIndicesBeyondTheVertices) {
    GltfFile file;
    const size_t position = file.vec3(kTriangle), indices = file.indices({0, 1, 3});
    file.show({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
    EXPECT_TRUE(contains(file.complaint(), "index 3 at position 2"));
}

TEST(GltfMalformed, RefusesMoreThanTheLimits) {
    scene::SceneLimits small;
    small.vertices = 2;
    EXPECT_TRUE(contains(triangle().complaint(small), "limit of 2"));
    small = {};
    small.indices = 2;
    EXPECT_TRUE(contains(triangle().complaint(small), "limit of 2"));
    small = {};
    small.nodes = 0;
    EXPECT_TRUE(contains(triangle().complaint(small), "/nodes"));
    small = {};
    small.file_bytes = 100;
    EXPECT_TRUE(contains(triangle().complaint(small), "limit of 100"));
    // Zeros need no bytes in the file, but memory all the same.
    GltfFile zeros;
    zeros.root["accessors"] = {{{"componentType", 5126}, {"count", 4'000'000'000u}, {"type", "VEC3"}}};
    zeros.show({{"attributes", {{"POSITION", 0}}}});
    EXPECT_TRUE(contains(zeros.complaint(), "/accessors/0/count"));
    // Each within the limit, not all together.
    GltfFile often;
    often.vec3(std::vector<float>(3000));
    for (int i = 0; i < 6; ++i) often.show({{"attributes", {{"POSITION", 0}}}});
    small = {};
    small.vertices = 5000;
    EXPECT_TRUE(contains(often.complaint(small), "/meshes/5/primitives/0: takes the meshes over the limit of 5000"));
    // Few vertices kept, but many read again and again.
    GltfFile again;
    again.vec3(std::vector<float>(15000));
    const size_t corners = again.indices({0, 1, 2});
    for (int i = 0; i < 50; ++i) again.show({{"attributes", {{"POSITION", 0}, {"NORMAL", 0}}}, {"indices", corners}});
    EXPECT_TRUE(contains(again.complaint(small), "too often"));
    // Elements of no bytes, at once or together: a fiftieth of the vertices.
    zeros.root["accessors"][0]["count"] = 1'000'001;
    EXPECT_TRUE(contains(zeros.complaint(), "/accessors/0: has no buffer view")) << zeros.complaint();
    GltfFile empty;
    empty.root["accessors"] = {{{"componentType", 5126}, {"count", 30}, {"type", "VEC3"}}};
    for (int i = 0; i < 3; ++i) empty.show({{"attributes", {{"POSITION", 0}}}});
    EXPECT_EQ(empty.complaint(small), "");
    empty.show({{"attributes", {{"POSITION", 0}}}});
    EXPECT_TRUE(contains(empty.complaint(small),
                         "/accessors/0: has no buffer view: its 30 elements take those that the file does not hold "
                         "over the limit of 100"));
    // A mesh that many nodes show.
    GltfFile shown = triangle();
    small = {};
    small.indices = 3;
    for (int i = 0; i < 9; ++i) shown.root["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(shown.complaint(small), "");
    shown.root["nodes"].push_back({{"mesh", 0}});
    EXPECT_TRUE(contains(shown.complaint(small), "/nodes: show 11 triangles together, more than the limit of 10"));
}

TEST(GltfMalformed, RefusesNestingWithoutEnd) {
    const TempFolder folder;
    const auto complaint = [&](const std::string& text) {
        return complaint_of([&] { read_scene(folder.write("deep.gltf", text)); });
    };
    EXPECT_TRUE(contains(complaint(std::string(1'000'000, '[')), "nested deeper"));
    EXPECT_TRUE(contains(
        complaint(R"({"asset":{"version":"2.0"},"extras":)" + std::string(500, '[') + std::string(500, ']') + "}"),
        "nested deeper"));
    EXPECT_TRUE(contains(complaint("{\"asset\""), "not valid JSON"));
    EXPECT_TRUE(contains(complaint(""), "is empty"));
    EXPECT_TRUE(contains(complaint("glTF"), "cut off"));
    EXPECT_TRUE(contains(complaint("{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"translation\":[1e999,0,0]}]}"),
                         "not valid JSON"));
}

// Buffers that only a compression fills are no fault of the file.
TEST(GltfMalformed, NamesTheExtensionThatBuffersNeed) {
    GltfFile file = triangle();
    file.text();
    file.bytes.clear();  // or the buffer is written again
    file.root["buffers"][0].erase("uri");
    EXPECT_TRUE(contains(file.complaint(), "neither a uri nor a binary chunk"));
    file.root["buffers"][0]["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
    EXPECT_TRUE(
        contains(file.complaint(), "/bufferViews/0: lies in a buffer that has compressed bytes alone, and is not"));
}

TEST(GltfMalformed, SaysWhatIsNoUtf8) {
    const TempFolder folder;
    const auto complaint = [&](const std::string& text) {
        return complaint_of([&] { read_scene(folder.write("x.gltf", text)); });
    };
    EXPECT_TRUE(contains(complaint("{\"asset\":{\"version\":\"2.0\",\"copyright\":\"M\xfcller\"}}"),
                         "x.gltf: byte 41: not valid JSON: is no UTF-8"));
    for (const std::string& begins : {std::string("\xff\xfe{\0", 4), std::string("\xfe\xff\0{", 4),
                                      std::string("{\0}\0", 4), std::string("\0{\0}", 4)})
        EXPECT_TRUE(contains(complaint(begins), "looks like UTF-16"));
    EXPECT_FALSE(contains(complaint("{\"asset\" \"M\xc3\xbcller\"}"), "UTF"));
}

TEST(GltfMalformed, RefusesFilesThatAreNone) {
    const TempFolder folder;
    EXPECT_THROW(read_scene(folder / "missing.gltf"), Error);
    EXPECT_THROW(read_scene(folder.path()), Error);
    EXPECT_THROW(read_scene("/dev/zero"), Error);
}

/// Every single-byte cut of a binary file, and every byte of its head changed: a scene or an Error, never more.
TEST(GltfMalformed, SurvivesCutAndChangedBinaryFiles) {
    GltfFile file = triangle();
    file.root["buffers"] = {{{"byteLength", file.bytes.size()}}};
    std::string text = file.root.dump();
    while (text.size() % 4) text += ' ';
    const auto word = [](size_t value) {
        std::string four;
        for (int shift = 0; shift < 32; shift += 8) four += static_cast<char>(value >> shift);
        return four;
    };
    const std::string glb = "glTF" + word(2) + word(28 + text.size() + file.bytes.size()) + word(text.size()) + "JSON" +
                            text + word(file.bytes.size()) + std::string("BIN\0", 4) +
                            std::string(file.bytes.begin(), file.bytes.end());
    const TempFolder folder;
    EXPECT_EQ(read_scene(folder.write("whole.glb", glb)).scene.meshes.size(), 1u);
    for (size_t size = 0; size < glb.size(); ++size)
        EXPECT_THROW(read_scene(folder.write("cut.glb", glb.substr(0, size))), Error) << size;
    for (size_t i = 0; i < glb.size(); ++i) {
        for (const int change : {1, 0x10, 0x80}) {
            std::string changed = glb;
            changed[i] = static_cast<char>(changed[i] ^ change);
            try {
                read_scene(folder.write("changed.glb", changed));
            } catch (const Error&) {
            }
        }
    }
}

}  // namespace
}  // namespace vesper::test
