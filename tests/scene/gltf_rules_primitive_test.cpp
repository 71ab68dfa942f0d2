// Rules of glTF for primitives, accessors and what those are used for. SPDX-License-Identifier: MIT
#include "scene/broken_rules.h"

namespace vesper::test {
namespace {

using nlohmann::json;

constexpr const char* kPicture = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAQAAAAECAIAAAAmkwkpAAAAPElEQVR4nGNgYGRi5+Dk4xcQFRNn4OXjFxEVk5aRVVJWYZCSllFUUtbQ1NI3MGRQ19DU0zcwNTO3sbUDAGqsBdGJVaLCAAAAAElFTkSuQmCC";

/// A textured triangle with all that vertices can have, sparse positions and a morph target.
struct Triangle {
    std::vector<float> normals{0, 0, 1, 0, 0, 1, 0, 0, 1}, tangents{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1};
    std::vector<uint16_t> changed{0, 2};

    json root() const {
        GltfFile file;
        const size_t position = file.vec3(kTriangle), uv = file.vec2({0, 0, 1, 0, 0, 1}), indices = file.indices({0, 1, 2});
        const size_t normal = file.vec3(normals), tangent = file.accessor(tangents, 5126, "VEC4", 4), target = file.vec3(kTriangle);
        const size_t joints = file.accessor(std::vector<uint8_t>(12, 0), 5121, "VEC4", 4), weights = file.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
        const size_t where = file.buffer_view(changed), what = file.buffer_view(std::vector<float>(6, 0.5f));
        for (const size_t bounded : {position, target}) file.root["accessors"][bounded]["min"] = {0, 0, 0}, file.root["accessors"][bounded]["max"] = {1, 1, 0};
        file.root["accessors"][position]["sparse"] = {{"count", 2}, {"indices", {{"bufferView", where}, {"componentType", 5123}}}, {"values", {{"bufferView", what}}}};
        file.root["accessors"][position]["min"] = {0.5, 0, 0}, file.root["accessors"][position]["max"] = {1, 0.5, 0.5};
        file.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TANGENT", tangent}, {"TEXCOORD_0", uv}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}, {"_OWN", normal}}},
                   {"indices", indices}, {"material", 0}, {"targets", {{{"POSITION", target}}}}});
        file.root["meshes"][0]["weights"] = {0.5};
        file.root["images"] = {{{"uri", kPicture}}};
        file.root["textures"] = {{{"source", 0}}};
        file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        file.text();
        return file.root;
    }
};

enum : size_t { kPosition, kUv, kIndices, kNormal, kTangent, kTarget };  // accessors, and their buffer views

TEST(GltfPrimitiveRules, WhatIsBrokenIsNotedWithItsPlace) {
    expect_broken(Triangle{}.root(), {
        {"/accessors/0/min", nullptr, "/meshes/0/primitives/0/attributes/POSITION: has an accessor without min and max"},
        {"/accessors/5/max", nullptr, "/meshes/0/primitives/0/targets/0/POSITION: has an accessor without min and max"},
        {"/accessors/0/max", {1, 0.5}, "/accessors/0/max: has not 3 numbers"},
        {"/meshes/0/primitives/0/attributes/FOO", kNormal, "/meshes/0/primitives/0/attributes/FOO: is no attribute"},
        {"/meshes/0/primitives/0/attributes/TEXCOORD_01", kUv, "/TEXCOORD_01: is no attribute"},
        {"/meshes/0/primitives/0/attributes/TEXCOORD_2", kUv, "/meshes/0/primitives/0/attributes: has not every TEXCOORD_0 to TEXCOORD_2"},
        {"/meshes/0/primitives/0/attributes/WEIGHTS_0", nullptr, "/meshes/0/primitives/0/attributes: has not as many sets of joints as of weights"},
        {"/meshes/0/primitives/0/targets/0/FOO", kNormal, "/meshes/0/primitives/0/targets/0/FOO: is no attribute"},
        {"/meshes/0/primitives/0/targets/0/NORMAL", kUv, "/meshes/0/primitives/0/targets/0/NORMAL: has an accessor of a format"},
        {"/meshes/0/weights", {1, 2}, "/meshes/0/weights: are not one for each of the 1 morph targets"},
        {"/meshes/0/primitives/1", {{"attributes", {{"POSITION", kPosition}}}}, "/meshes/0/primitives: have not all as many morph targets"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", 3, "/meshes/0/primitives/0: has no TEXCOORD_3, which /materials/0/pbrMetallicRoughness/baseColorTexture needs"},
        {"/meshes/0/primitives/0/attributes/TEXCOORD_0", nullptr, "has no TEXCOORD_0, which"},
        {"/materials/0/occlusionTexture", {{"index", 0}, {"texCoord", 1}}, "has no TEXCOORD_1, which /materials/0/occlusionTexture needs"},
        {"/accessors/1/componentType", 5125, "/meshes/0/primitives/0/attributes/TEXCOORD_0: has an accessor of a format"},
        {"/accessors/4/type", "VEC3", "/meshes/0/primitives/0/attributes/TANGENT: has an accessor of a format"},
        {"/images/0/mimeType", "image/jpeg", "/images/0/mimeType: is not that of the picture, which is image/png"},
    }, 2);
}

// Where they are moved by KHR_texture_transform, textures lie by another set.
TEST(GltfPrimitiveRules, TransformsNameTheirOwnSet) {
    json root = Triangle{}.root();
    root["extensionsUsed"] = {"KHR_texture_transform"};
    root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", 3}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 0}}}}}};
    EXPECT_EQ(broken(root), std::vector<std::string>{});
}

TEST(GltfPrimitiveRules, QuantizedAttributesNeedTheExtension) {
    GltfFile file;
    const size_t position = file.accessor(std::vector<uint16_t>{0, 0, 0, 0, 9, 0, 0, 0, 0, 9, 0, 0}, 5123, "VEC3", 4), normal = file.accessor(std::vector<int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, 5120, "VEC3", 4, true);
    file.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
    file.root["accessors"][position]["min"] = {0, 0, 0}, file.root["accessors"][position]["max"] = {9, 9, 0};
    file.root["bufferViews"][position]["byteStride"] = 8, file.root["bufferViews"][normal]["byteStride"] = 4;
    file.text();
    EXPECT_EQ(broken(file.root), (std::vector<std::string>{"/meshes/0/primitives/0/attributes/NORMAL: has an accessor of a format that it cannot have",
                                                            "/meshes/0/primitives/0/attributes/POSITION: has an accessor of a format that it cannot have"}));
    file.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    EXPECT_EQ(broken(file.root), std::vector<std::string>{"/extensionsUsed: lists KHR_mesh_quantization, which extensionsRequired has to list too"});
    file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    EXPECT_EQ(broken(file.root), std::vector<std::string>{});
    file.root["bufferViews"][normal].erase("byteStride");
    file.root["accessors"][normal]["count"] = 3;
    EXPECT_TRUE(mentions(broken(file.root), "/accessors/1: holds an attribute whose elements do not begin at multiples of four"));
}

TEST(GltfPrimitiveRules, NumbersAreLookedAt) {
    EXPECT_EQ(broken(Triangle{.normals = {0, 0, 1.002f, 0, 0, 0.995f, 0, 0, 1}}.root()), std::vector<std::string>{});
    EXPECT_EQ(broken(Triangle{.normals = {0, 0, 5, 0, 0, 5, 0, 0, 5}}.root()), std::vector<std::string>{"/accessors/3: holds normals that are not of length 1: they are made so"});
    EXPECT_EQ(broken(Triangle{.tangents = {1, 0, 0, 1, 2, 0, 0, 1, 1, 0, 0, 1}}.root()), std::vector<std::string>{"/accessors/4: holds tangents that are not of length 1"});
    EXPECT_EQ(broken(Triangle{.tangents = {1, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 1}}.root()), std::vector<std::string>{"/accessors/4: holds tangents with a sign that is neither 1 nor -1"});
    EXPECT_EQ(broken(Triangle{.changed = {2, 0}}.root()), std::vector<std::string>{"/accessors/0/sparse/indices: do not ascend"});
}

// Limits are those of the bytes, also where a byte of 255 means 1.
TEST(GltfPrimitiveRules, LimitsAreOfStoredNumbers) {
    GltfFile file;
    const size_t colour = file.accessor(std::vector<uint8_t>{0, 0, 51, 255, 255, 0, 51, 255, 7, 0, 51, 255}, 5121, "VEC4", 4, true);
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}, {"COLOR_0", colour}}}});
    file.root["accessors"][colour]["min"] = {0, 0, 51, 255}, file.root["accessors"][colour]["max"] = {255, 0, 51, 255};
    file.text();
    expect_broken(file.root, {
        {"/accessors/0/max", {1, 0, 0.2, 1}, "/accessors/0/max: is not that of its numbers"},
        {"/accessors/0/min/3", 254, "/accessors/0/min: is not that of its numbers"},
    });
}

TEST(GltfPrimitiveRules, TheLastIndexOfAType) {
    GltfFile file;
    std::vector<float> many(3 * 256, 0.5f);
    file.show({{"attributes", {{"POSITION", file.vec3(many)}}}, {"indices", file.accessor(std::vector<uint8_t>{0, 1, 255}, 5121, "SCALAR", 1)}});
    file.text();
    EXPECT_EQ(broken(file.root), std::vector<std::string>{"/accessors/1: holds the index 255, the last of its type, which is none"});
    file.root["accessors"][1]["count"] = 2;
    EXPECT_EQ(broken(file.root), std::vector<std::string>{});
}

TEST(GltfPrimitiveRules, OwnAttributesHaveNoLongIntegers) {
    json root = Triangle{}.root();
    root["accessors"].push_back({{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
    root["meshes"][0]["primitives"][0]["attributes"]["_OWN"] = 8;
    expect_broken(root, {{"/accessors/8/componentType", 5125, "/meshes/0/primitives/0/attributes/_OWN: has an accessor of a format"}});
}

// A clear coat's own bumps and the direction of brushed metal lie along tangents; those of a normal texture can be found by it.
TEST(GltfPrimitiveRules, TangentsAreThereWhereTheyAreNeeded) {
    for (const auto& [extension, texture] : {std::pair{"KHR_materials_clearcoat", "clearcoatNormalTexture"}, std::pair{"KHR_materials_anisotropy", "anisotropyTexture"}}) {
        json root = Triangle{}.root();
        root["extensionsUsed"] = {extension};
        root["materials"][0]["extensions"][extension][texture] = {{"index", 0}};
        const std::string needs = "has no TANGENT, which /materials/0/extensions/" + std::string(extension) + "/" + texture;
        expect_broken(root, {{"/meshes/0/primitives/0/attributes/TANGENT", nullptr, needs.c_str()}, {"/meshes/0/primitives/0/attributes/NORMAL", nullptr, needs.c_str()}});
        root["meshes"][0]["primitives"][0]["attributes"].erase("TANGENT");
        root["materials"][0]["normalTexture"] = {{"index", 0}};
        EXPECT_EQ(broken(root), std::vector<std::string>{});
    }
}

TEST(GltfPrimitiveRules, AccessorsAndViewsAreForOneThing) {
    expect_broken(Triangle{}.root(), {
        {"/bufferViews/3/target", 34963, "/bufferViews/3: is used for different things, or not for what its target says"},
        {"/bufferViews/2/target", 34962, "/bufferViews/2: is used for different things"},
        {"/bufferViews/2/byteStride", 2, "/accessors/2: holds indices, and lies in a buffer view with a stride"},
        {"/bufferViews/10", {{"buffer", 0}, {"byteLength", 8}, {"byteStride", 6}}, "/bufferViews/10/byteStride: is no multiple of four"},
        {"/accessors/5/bufferView", kNormal, "/accessors/5: lies in one buffer view with accessor 3, which has no stride"},
        {"/skins", {{{"joints", {0}}, {"inverseBindMatrices", kTarget}}}, "/accessors/5: is used as an attribute and as matrices of joints"},
        {"/images/1", {{"bufferView", kNormal}, {"mimeType", "image/png"}}, "/bufferViews/3: is used for different things"},
        {"/bufferViews/10", {{"buffer", 0}, {"byteLength", 8}, {"byteStride", 3}}, "/bufferViews/10/byteStride: is less than 4"},
        {"/bufferViews/10", {{"buffer", 0}, {"byteLength", 8}, {"byteStride", 12}}, "/bufferViews/10/byteStride: is more than its bytes"},
    }, 3);
}

// Many breaks of one kind are named for the first places and counted.
TEST(GltfPrimitiveRules, ManyOfAKindAreCounted) {
    json root = Triangle{}.root();
    for (int i = 0; i < 300; ++i) root["meshes"][0]["primitives"][0]["attributes"]["FOO" + std::to_string(i)] = kNormal;
    root["nodes"][0]["rotation"] = {0, 0, 0, 2};
    const std::vector<std::string> rules = broken(root);
    EXPECT_EQ(rules.size(), 13u) << json(rules);
    EXPECT_TRUE(mentions(rules, "is no attribute of glTF (290 times)")) << json(rules);
    EXPECT_TRUE(mentions(rules, "/nodes/0/rotation"));
}

}  // namespace
}  // namespace vesper::test
