// Nodes, cameras, lights and animations of glTF files. SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "scene/colour.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using nlohmann::json;
using scene::Scene;

TEST(GltfNode, ReadsTheDefaultSceneOrAllRoots) {
    GltfFile file;
    file.root["nodes"] = {{{"name", "a"}, {"children", {1}}}, {{"name", "b"}}, {{"name", "c"}}};
    EXPECT_EQ(file.read().scene.nodes.size(), 3u);
    file.root["scenes"] = {{{"nodes", {2}}}, {{"nodes", {0}}, {"name", "second"}}};
    EXPECT_EQ(file.read().scene.nodes.at(0).name, "c");
    file.root["scene"] = 1;
    const Scene scene = file.read().scene;
    EXPECT_EQ(scene.name, "second");
    ASSERT_EQ(scene.nodes.size(), 2u);
    EXPECT_EQ(scene.nodes[1].name, "b");
    EXPECT_EQ(scene.nodes[1].parent, 0u);
}

TEST(GltfNode, ReadsATreeAsDeepAsItIs) {
    GltfFile file;
    constexpr int kDepth = 20'000;
    for (int i = 0; i < kDepth; ++i) file.root["nodes"].push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
    file.root["nodes"].push_back(json::object());
    const Scene scene = file.read().scene;
    EXPECT_EQ(scene::world_transforms(scene, 0).back()[3].x, kDepth);
}

TEST(GltfNode, ReadsFilesWithoutAnything) {
    GltfFile file;
    const scene::LoadedScene loaded = file.read();
    EXPECT_TRUE(loaded.scene.nodes.empty());
    EXPECT_TRUE(loaded.notes.empty());
}

// A hidden node hides all below it, whatever these say; cameras stay.
TEST(GltfNode, HidesWhatKhrNodeVisibilityHides) {
    const json hidden = {{"KHR_node_visibility", {{"visible", false}}}},
               shown = {{"KHR_node_visibility", {{"visible", true}}}};
    GltfFile file;
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}});
    file.root["cameras"] = json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}});
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"type", "point"}}});
    const json lamp = {{"light", 0}};
    file.root["nodes"] = {{{"mesh", 0}, {"extensions", shown}, {"children", {1}}},
                          {{"mesh", 0}, {"extensions", hidden}, {"children", {2, 3}}},
                          {{"mesh", 0}, {"extensions", shown}, {"camera", 0}},
                          {{"extensions", {{"KHR_lights_punctual", lamp}}}},
                          {{"mesh", 0}, {"extensions", {{"KHR_lights_punctual", lamp}}}}};
    file.root["extensionsRequired"] = {"KHR_node_visibility"};
    const scene::LoadedScene loaded = file.read();
    std::vector<int> meshes, lamps, cameras;
    for (const scene::Node& node : loaded.scene.nodes) {
        meshes.push_back(node.mesh != scene::kNone), lamps.push_back(node.lamp != scene::kNone);
        cameras.push_back(node.camera != scene::kNone);
    }
    EXPECT_EQ(meshes, (std::vector<int>{1, 0, 0, 0, 1}));
    EXPECT_EQ(lamps, (std::vector<int>{0, 0, 0, 0, 1}));
    EXPECT_EQ(cameras, (std::vector<int>{0, 0, 1, 0, 0}));
    EXPECT_TRUE(mentions(loaded.notes, "a node that KHR_node_visibility hides is not shown (3 times)"));
    file.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = 0;
    EXPECT_TRUE(contains(file.complaint(), "/nodes/1/extensions/KHR_node_visibility/visible"));
}

TEST(GltfNode, KeepsNegativeScaleAndMatrices) {
    GltfFile file;
    file.root["nodes"] = {{{"scale", {-1, 2, 3}}}, {{"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}}}};
    const auto world = scene::world_transforms(file.read().scene, 0);
    EXPECT_EQ(world[0][0].x, -1);
    EXPECT_EQ(world[1][0], glm::dvec4(0, 1, 0, 0));
    EXPECT_EQ(world[1][3], glm::dvec4(4, 5, 6, 1));
}

// A database at UTM coordinates that a node above brings back: floats would be 0.2 m off.
TEST(GltfNode, FarFromTheOriginAndBackIsExact) {
    GltfFile file;
    file.root["nodes"] = {{{"translation", {-5'000'000, 0, 412'000.25}}, {"children", {1}}},
                          {{"translation", {5'000'000.3, 1, -412'000}}},
                          {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -5'000'000.1, 0, 0, 1}}, {"children", {3}}},
                          {{"translation", {5'000'000, 0, 0}}}};
    const auto world = scene::world_transforms(file.read().scene, 0);
    EXPECT_NEAR(world[1][3].x, 0.3, 1e-6);
    EXPECT_NEAR(world[1][3].z, 0.25, 1e-6);
    EXPECT_NEAR(world[3][3].x, -0.1, 1e-6);
}

TEST(GltfNode, NamesCameras) {
    GltfFile file;
    const json lens = {{"yfov", 0.7}, {"znear", 0.05}};
    file.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", lens}, {"name", "driver"}},
        {{"type", "perspective"}, {"perspective", lens}},
        {{"type", "perspective"}, {"perspective", lens}, {"name", "shared"}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 2}, {"znear", 1}}}}};
    for (const auto& [name, camera] :
         std::vector<std::pair<const char*, int>>{{"n0", 0}, {"n1", 1}, {"n2", 2}, {"n3", 2}, {"n4", 3}})
        file.root["nodes"].push_back({{"name", name}, {"camera", camera}});
    const scene::LoadedScene loaded = file.read();
    std::vector<std::string> names;
    for (const scene::Camera& camera : loaded.scene.cameras) names.push_back(camera.name);
    EXPECT_EQ(names, (std::vector<std::string>{"driver", "n1", "n2", "n3"}));
    EXPECT_FLOAT_EQ(loaded.scene.cameras[0].vertical_fov, 0.7f);
    EXPECT_EQ(loaded.scene.nodes[4].camera, scene::kNone);
    EXPECT_TRUE(mentions(loaded.notes, "orthographic"));
}

// What is new to this version is left out; the others stay.
TEST(GltfNode, LeavesOutCamerasThatItCannotHave) {
    GltfFile file;
    const auto lens = [](double fov) {
        return json{{"type", "perspective"}, {"perspective", {{"yfov", fov}, {"znear", 0.05}}}};
    };
    file.root["cameras"] = {{{"type", "fisheye"}}, lens(3.2), lens(3.1)};
    for (int i = 0; i < 3; ++i) file.root["nodes"].push_back({{"camera", i}});
    const scene::LoadedScene loaded = file.read();
    ASSERT_EQ(loaded.scene.cameras.size(), 1u);
    EXPECT_EQ(loaded.scene.nodes[2].camera, 0u);
    EXPECT_TRUE(loaded.scene.nodes[0].camera == scene::kNone && loaded.scene.nodes[1].camera == scene::kNone);
    EXPECT_TRUE(mentions(loaded.notes, "a camera of a type that glTF does not have is left out"));
    EXPECT_TRUE(mentions(loaded.notes, "a camera with a field of view of 180 degrees or more is left out"));
    file.root["cameras"][1] = lens(-3);
    EXPECT_TRUE(contains(file.complaint(), "/cameras/1/perspective/yfov"));
}

json lamps(const json& list) { return {{"KHR_lights_punctual", {{"lights", list}}}}; }
json lamp(int index) { return {{"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}}; }

TEST(GltfLight, KeepsTheProductOfIntensityAndColour) {
    GltfFile file;
    file.root["extensions"] = lamps({{{"type", "point"}, {"intensity", 100}, {"color", {1, 0.5, 0.25}}, {"range", 3}},
                                     {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}},
                                     {{"type", "directional"}, {"intensity", 5}}});
    file.root["nodes"] = {lamp(0), lamp(1), lamp(2)};
    const scene::LoadedScene loaded = file.read();
    const auto& read = loaded.scene.lamps;
    ASSERT_EQ(read.size(), 3u);
    const double y = luminance({1, 0.5, 0.25});
    EXPECT_NEAR(read[0].intensity, 100 * y, 1e-4);
    EXPECT_NEAR(luminance(read[0].colour), 1, 1e-6);
    EXPECT_NEAR(read[0].colour.r * read[0].intensity, 100, 1e-4);
    EXPECT_TRUE(mentions(loaded.notes, "range"));
    EXPECT_EQ(read[1].kind, scene::Lamp::Kind::Spot);
    EXPECT_FLOAT_EQ(read[1].inner_cone, 0.1f);
    EXPECT_FLOAT_EQ(read[1].outer_cone, 0.5f);
    EXPECT_FLOAT_EQ(read[1].intensity, 1);  // the default
    EXPECT_EQ(read[2].kind, scene::Lamp::Kind::Directional);
    EXPECT_EQ(loaded.scene.nodes[2].lamp, 2u);
}

TEST(GltfLight, WhatFloatsCannotHoldIsNoted) {
    const auto notes = [](double cone) {
        GltfFile file;
        file.root["extensions"] = lamps({{{"type", "spot"}, {"spot", {{"outerConeAngle", cone}}}}});
        file.root["nodes"] = json::array({lamp(0)});
        return file.read().notes;
    };
    EXPECT_FALSE(mentions(notes(0.01), "gives more light than it says"));
    EXPECT_TRUE(mentions(notes(0.008), "gives more light than it says"));
}

TEST(GltfLight, LeavesOutTypesThatItDoesNotKnow) {
    GltfFile file;
    file.root["extensions"] = lamps({{{"type", "area"}, {"intensity", 100}}, {{"type", "point"}, {"intensity", 7}}});
    file.root["nodes"] = {lamp(0), lamp(1)};
    const scene::LoadedScene loaded = file.read();
    EXPECT_EQ(loaded.scene.nodes[0].lamp, scene::kNone);
    ASSERT_EQ(loaded.scene.nodes[1].lamp, 1u);
    EXPECT_EQ(loaded.scene.lamps[1].intensity, 7);
    EXPECT_TRUE(mentions(loaded.notes, "a light of a type that glTF does not have is left out"));
    file.root["extensions"] = lamps(json::array({json{{"intensity", 100}}}));
    EXPECT_TRUE(contains(file.complaint(), "has no \"type\""));
}

TEST(GltfLight, ReadsTheVesperBlock) {
    GltfFile file;
    file.root["extensions"] = lamps({{{"type", "spot"}, {"intensity", 12000}}});
    file.root["nodes"] = json::array({lamp(0)});
    file.root["extras"]["vesper"] = {{"version", 1},
                                     {"transfer", {{"kind", "gamma"}, {"gamma", 2.2}}},
                                     {"ambient", {{"illuminance_lx", 0.4}, {"colour", {2, 2, 2}}}},
                                     {"sky", {{"luminance_cd_m2", 0.02}}},
                                     {"lobes", {{{"light", 0}, {"type", "cosine_power"}, {"exponent", 250}}}}};
    const scene::LoadedScene loaded = file.read();
    const Scene& scene = loaded.scene;
    EXPECT_TRUE(loaded.photometric);
    EXPECT_EQ(scene.transfer.kind, scene::Transfer::Kind::Gamma);
    EXPECT_FLOAT_EQ(scene.ambient_illuminance, 0.4f);
    EXPECT_NEAR(luminance(scene.ambient_colour), 1, 1e-6);
    EXPECT_FLOAT_EQ(scene.sky_luminance, 0.02f);
    EXPECT_EQ(scene.lamps[0].kind, scene::Lamp::Kind::CosinePower);
    EXPECT_EQ(scene.lamps[0].exponent, 250);
    file.root["extras"]["vesper"]["version"] = 2;
    EXPECT_TRUE(contains(file.complaint(), "/extras/vesper/version"));
    file.root["extras"]["vesper"] = {{"version", 1},
                                     {"lobes", {{{"light", 1}, {"type", "cosine_power"}, {"exponent", 2}}}}};
    EXPECT_TRUE(contains(file.complaint(), "/extras/vesper/lobes/0/light"));
}

/// A node moved by one channel.
Scene animated(const std::string& path, const std::string& mode, const std::vector<float>& times,
               const std::vector<float>& values, int components) {
    GltfFile file;
    file.root["nodes"] = json::array({json::object()});
    const size_t input = file.accessor(times, 5126, "SCALAR", 1);
    const size_t output =
        file.accessor(values, 5126, components == 4 ? "VEC4" : "VEC3", static_cast<size_t>(components));
    file.root["animations"] = {{{"samplers", {{{"input", input}, {"output", output}, {"interpolation", mode}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}}};
    return file.read().scene;
}

TEST(GltfAnimation, InterpolatesStepAndLinear) {
    const std::vector<float> times = {1, 3}, values = {0, 0, 0, 8, 0, 0};
    const Scene linear = animated("translation", "LINEAR", times, values, 3),
                step = animated("translation", "STEP", times, values, 3),
                unknown = animated("translation", "WAVY", times, values, 3);
    const auto x = [](const Scene& scene, double seconds) {
        return float(scene::world_transforms(scene, seconds)[0][3].x);
    };
    EXPECT_EQ(scene::animation_length(linear), 3);
    for (const auto& [seconds, expected] :
         std::vector<std::pair<double, float>>{{0, 0}, {1, 0}, {1.5, 2}, {2, 4}, {3, 8}, {9, 8}})
        EXPECT_FLOAT_EQ(x(linear, seconds), expected) << seconds;
    EXPECT_FLOAT_EQ(x(unknown, 1.5), 2);
    EXPECT_EQ(x(step, 2.9), 0);
    EXPECT_EQ(x(step, 3), 8);
}

TEST(GltfAnimation, TurnsAlongTheShortestWay) {
    const float h = std::sqrt(0.5f);
    // From 0 to 90 degrees about Y, the end given with the opposite sign: the same rotation.
    const Scene scene = animated("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, -h, 0, -h}, 4);
    const glm::mat4 half = scene::world_transforms(scene, 0.5)[0];
    EXPECT_NEAR(half[0].x, std::cos(std::numbers::pi / 4), 1e-6);
    EXPECT_NEAR(half[0].z, -std::sin(std::numbers::pi / 4), 1e-6);
}

TEST(GltfAnimation, FollowsCubicSplines) {
    // x(t) = t^3 on [0, 2]: a cubic spline must reproduce it. Per key: in-tangent, value, out-tangent.
    const Scene scene =
        animated("translation", "CUBICSPLINE", {0, 2}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 12, 0, 0, 8, 0, 0, 12, 0, 0}, 3);
    for (const double t : {0.0, 0.3, 1.0, 1.7, 2.0})
        EXPECT_NEAR(scene::world_transforms(scene, t)[0][3].x, t * t * t, 1e-5);
}

TEST(GltfAnimation, PlaysAllAnimationsTogether) {
    GltfFile file;
    file.root["nodes"] = {json::object(), {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}};
    const size_t input = file.accessor(std::vector<float>{0, 4}, 5126, "SCALAR", 1);
    const size_t up = file.vec3({0, 0, 0, 0, 4, 0}), big = file.vec3({1, 1, 1, 3, 3, 3});
    const auto animation = [&](size_t output, const char* path, int node) {
        return json{{"samplers", {{{"input", input}, {"output", output}}}},
                    {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}};
    };
    file.root["animations"] = {animation(up, "translation", 0), animation(big, "scale", 0),
                               animation(up, "translation", 1)};
    const scene::LoadedScene loaded = file.read();
    EXPECT_EQ(loaded.scene.channels.size(), 2u);
    EXPECT_TRUE(mentions(loaded.notes, "matrix"));
    const glm::mat4 world = scene::world_transforms(loaded.scene, 2)[0];
    EXPECT_EQ(world[3].y, 2);
    EXPECT_EQ(world[0].x, 2);
}

}  // namespace
}  // namespace vesper::test
