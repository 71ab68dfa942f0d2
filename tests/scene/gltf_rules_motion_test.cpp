// Rules of glTF for nodes, cameras, skins and animations, and for the types and ranges of all properties. SPDX-License-Identifier: MIT
#include <cmath>

#include "scene/broken_rules.h"

namespace vesper::test {
namespace {

using nlohmann::json;

/// Two joints under a node, a camera, and keys of a node's translation. The last row of the second joint's matrix is another where it is stated.
json moving(const std::vector<float>& times = {0, 1, 2}, float corner = 1) {
    GltfFile file;
    const size_t input = file.accessor(times, 5126, "SCALAR", 1), output = file.vec3({0, 0, 0, 1, 0, 0, 2, 0, 0});
    std::vector<float> matrices(32, 0);
    for (size_t i = 0; i < 32; i += i == 15 ? 1 : 5) matrices[i] = 1;
    matrices[31] = corner;
    const size_t inverse = file.accessor(matrices, 5126, "MAT4", 16);
    file.root["accessors"][input]["min"] = {times[0]}, file.root["accessors"][input]["max"] = {times[2]};
    file.root["nodes"] = {{{"children", {1, 2}}, {"camera", 0}}, {{"matrix", {1, 0, 0, 0, 0, 0, 2, 0, 0, -1, 0, 0, 5, 0, 0, 1}}}, json::object()};
    file.root["scenes"] = {{{"nodes", {0}}}};
    file.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"zfar", 100}, {"aspectRatio", 1.5}}}}};
    file.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse}}};
    file.root["animations"] = {{{"samplers", {{{"input", input}, {"output", output}}}}, {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    file.root["materials"] = {{{"name", "m"}, {"emissiveFactor", {1, 1, 1}}, {"alphaCutoff", 0.5}}};
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"color", {1, 1, 1}}, {"range", 5}}};
    file.text();
    return file.root;
}

TEST(GltfMotionRules, WhatIsBrokenIsNotedWithItsPlace) {
    expect_broken(moving(), {
        {"/nodes/1/matrix/4", 1, "/nodes/1/matrix: is no translation, rotation and scale"},
        {"/nodes/1/matrix", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}, "/nodes/1/matrix: is no translation, rotation and scale"},
        {"/scenes/0/nodes", {0, 0}, "/scenes/0/nodes: names something twice"},
        {"/cameras/0/perspective/zfar", 0.05, "/cameras/0/perspective/zfar: is not beyond znear"},
        {"/cameras/0/perspective/aspectRatio", -1, "/cameras/0/perspective/aspectRatio: is not more than 0"},
        {"/cameras/0/orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}, "/cameras/0: is both perspective and orthographic"},
        {"/cameras/1", {{"type", "orthographic"}, {"orthographic", {{"xmag", 0}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}}}, "/cameras/1/orthographic/xmag: is zero"},
        {"/cameras/1", {{"type", "orthographic"}}, "/cameras/1: has no orthographic to its type"},
        {"/skins/0/joints", {1, 1}, "/skins/0/joints: names something twice"},
        {"/skins/0/joints", nullptr, "/skins/0: has no joints"},
        {"/nodes/0/children", {1}, "/skins/0/joints: hang on no common node"},
        {"/skins/0/skeleton", 1, "/skins/0/skeleton: is no node that all joints hang on"},
        {"/nodes/3", {{"skin", 0}}, "/nodes/3: has no mesh to its skin"},
        {"/skins/0/inverseBindMatrices", 1, "/skins/0/inverseBindMatrices: has an accessor of a format that it cannot have"},
        {"/skins/0/joints", {0, 1, 2}, "/skins/0/inverseBindMatrices: has less than the 3 matrices of its joints"},
        {"/animations/0/channels/1", {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}, "/animations/0/channels/1/target: moves what channel 0 moves"},
        {"/animations/0/channels/0/target", {{"node", 1}, {"path", "translation"}}, "/animations/0/channels/0/target: moves a node that has a matrix"},
        {"/animations/0/channels/0/target", {{"node", 0}, {"path", "weights"}}, "/animations/0/channels/0/target: moves weights of a mesh without morph targets"},
        {"/accessors/0/min", nullptr, "/animations/0/samplers/0/input: has an accessor without min and max"},
    }, 2);
    EXPECT_EQ(broken(moving({0, 1, 1})), std::vector<std::string>{"/accessors/0: holds times of keys that do not ascend"});
    json whole = moving();
    whole["accessors"][0] = {{"bufferView", 0}, {"componentType", 5121}, {"count", 3}, {"type", "SCALAR"}, {"min", {0}}, {"max", {0}}};
    EXPECT_TRUE(mentions(broken(whole), "/animations/0/samplers/0/input: has an accessor of a format that it cannot have"));
}

TEST(GltfMotionRules, MatricesOfJointsAreLookedAt) {
    EXPECT_EQ(broken(moving({0, 1, 2}, 0.5f)), std::vector<std::string>{"/accessors/2: holds matrices of joints whose last row is not 0 0 0 1"});
    EXPECT_EQ(broken(moving({0, 1, 2}, NAN)), std::vector<std::string>{"/accessors/2: holds numbers that are not finite"});
}

// A skeleton is any node that all joints hang on, the one above them or one above that.
TEST(GltfMotionRules, SkeletonsAreAboveTheirJoints) {
    json root = moving();
    root["nodes"].push_back({{"children", {0}}}), root["nodes"].push_back(json::object());
    root["scenes"][0]["nodes"] = {3, 4};
    for (const int above : {0, 3}) {
        root["skins"][0]["skeleton"] = above;
        EXPECT_EQ(broken(root), std::vector<std::string>{}) << above;
    }
    for (const int beside : {1, 4}) {
        root["skins"][0]["skeleton"] = beside;
        EXPECT_EQ(broken(root), std::vector<std::string>{"/skins/0/skeleton: is no node that all joints hang on"}) << beside;
    }
    root["skins"][0]["joints"] = {2}, root["skins"][0]["skeleton"] = 2;
    EXPECT_EQ(broken(root), std::vector<std::string>{});
}

// Every node is above all that follow, and a joint: no step of a check may go over all of them.
TEST(GltfMotionRules, DeepSkeletonsTakeNoTime) {
    constexpr int kNodes = 100'000;
    GltfFile file;
    json& nodes = file.root["nodes"] = json::array();
    json joints = json::array();
    for (int i = 0; i < kNodes; ++i) nodes.push_back(i + 1 < kNodes ? json{{"children", {i + 1}}} : json::object()), joints.push_back(kNodes - 1 - i);
    file.root["scenes"] = {{{"nodes", {0}}}};
    file.root["skins"] = {{{"joints", joints}, {"skeleton", 0}}, {{"joints", std::move(joints)}, {"skeleton", 1}}};
    EXPECT_EQ(broken(file.root), std::vector<std::string>{"/skins/1/skeleton: is no node that all joints hang on"});
}

TEST(GltfMotionRules, ScenesHaveTheJointsOfTheirMeshes) {
    GltfFile file;
    const size_t joints = file.accessor(std::vector<uint8_t>(12, 0), 5121, "VEC4", 4), weights = file.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}}, {{"skin", 0}});
    file.root["nodes"].push_back({{"children", {2}}}), file.root["nodes"].push_back(json::object());
    file.root["skins"] = {{{"joints", {2}}}};
    file.root["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0, 1}}}};
    file.text();
    expect_broken(file.root, {{"/scenes/1/nodes", {0}, "/nodes/0/skin: has joints that are not in every scene of the node"}, {"/scenes/2", {{"nodes", {0}}}, "/nodes/0/skin: has joints that are not in"}});
}

TEST(GltfMotionRules, PointersLeadSomewhere) {
    json root = moving();
    root["extensionsUsed"].push_back("KHR_animation_pointer");
    const auto target = [](const char* pointer) { return json{{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}; };
    const auto set = [&](const json& to) { root["animations"][0]["channels"][0]["target"] = to; };
    for (const char* there : {"/nodes/2/translation", "/materials/0/emissiveFactor", "/extensions/KHR_lights_punctual/lights/0/intensity", "/cameras/0/perspective/yfov"}) {
        set(target(there));
        EXPECT_EQ(broken(root), std::vector<std::string>{}) << there;
    }
    for (const char* nowhere : {"/nodes/3/translation", "/meshes/0/weights", "/extensions/KHR_lights_punctual/lights/1/intensity", "/materials/x", "nodes/0/scale", "", "/asset/version/0"}) {
        set(target(nowhere));
        EXPECT_EQ(broken(root), std::vector<std::string>{"/animations/0/channels/0/target/extensions/KHR_animation_pointer/pointer: leads nowhere"}) << nowhere;
    }
    set(target("/nodes/0/translation"));
    expect_broken(root, {
        {"/animations/0/channels/0/target/node", 0, "/animations/0/channels/0/target/node: stands beside a pointer"},
        {"/animations/0/channels/0/target/path", "translation", "/animations/0/channels/0/target/path: is not pointer, and there is one"},
        {"/animations/0/channels/0/target/extensions/KHR_animation_pointer/pointer", nullptr, "/KHR_animation_pointer: has no pointer"},
    });
}

TEST(GltfSchemaRules, TypesAndRangesAreThoseOfTheSpecification) {
    expect_broken(moving(), {
        {"/asset/generator", 5, "/asset/generator: is not text"},
        {"/asset/copyright", json::array({1}), "/asset/copyright: is not text"},
        {"/extensionsUsed", {"KHR_lights_punctual", "KHR_lights_punctual"}, "/extensionsUsed: names something twice"},
        {"/materials/0/emissiveFactor", {5, 1, 1}, "/materials/0/emissiveFactor/0: is more than 1"},
        {"/materials/0/occlusionTexture", {{"strength", 5}, {"index", 0}}, "/materials/0/occlusionTexture/strength: is more than 1"},
        {"/materials/0/normalTexture", {{"scale", "x"}, {"index", 0}}, "/materials/0/normalTexture/scale: is not a number"},
        {"/materials/0/occlusionTexture", {{"strength", 1}}, "/materials/0/occlusionTexture: has no index"},
        {"/extensions/KHR_lights_punctual/lights/0/color", {2, 2, 2}, "/extensions/KHR_lights_punctual/lights/0/color/0: is more than 1"},
        {"/extensions/KHR_lights_punctual/lights/0/range", 0, "/extensions/KHR_lights_punctual/lights/0/range: is not more than 0"},
        {"/accessors/1/sparse", {{"count", 0}, {"indices", {{"bufferView", 1}, {"componentType", 5123}}}, {"values", {{"bufferView", 1}}}}, "/accessors/1/sparse/count: is less than 1"},
        {"/accessors/2/max", {"x"}, "/accessors/2/max/0: is not a number"},
        {"/textures", {{{"name", 1}}}, "/textures/0/name: is not text"},
        {"/samplers", {{{"wrapS", -1}}}, "/samplers/0/wrapS: is not a whole number"},
        {"/scenes/1", {{"nodes", 0}}, "/scenes/1/nodes: is not a list of whole numbers"},
        {"/buffers/1", {{"byteLength", 0}, {"uri", "data:application/octet-stream;base64,"}}, "/buffers/1/byteLength: is less than 1"},
    }, 4);
}

}  // namespace
}  // namespace vesper::test
