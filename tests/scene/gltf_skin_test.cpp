// Meshes put in place by joints and morph targets, at rest, against closed forms. SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/placement.h"
#include "scene/scene_files.h"

namespace vesper::test {
namespace {

using nlohmann::json;
using scene::Scene;

const json kUp = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // +Z of the file up

/// A triangle whose vertices hang on joints.
struct Rig {
    GltfFile file;
    std::vector<float> points = kTriangle, normals = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    std::vector<uint8_t> joints = std::vector<uint8_t>(12, 0);
    std::vector<float> weights = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

    void bind(const std::vector<glm::dmat4>& inverse, const json& of) {
        std::vector<float> values;
        for (const glm::dmat4& m : inverse)
            for (int i = 0; i < 16; ++i) values.push_back(static_cast<float>(m[i / 4][i % 4]));
        file.root["skins"].push_back({{"joints", of}});
        if (!inverse.empty())
            file.root["skins"].back()["inverseBindMatrices"] = file.accessor(values, 5126, "MAT4", 16);
    }
    size_t mesh() {
        const json attributes = {{"POSITION", file.vec3(points)},
                                 {"NORMAL", file.vec3(normals)},
                                 {"JOINTS_0", file.accessor(joints, 5121, "VEC4", 4)},
                                 {"WEIGHTS_0", file.accessor(weights, 5126, "VEC4", 4)}};
        file.root["meshes"].push_back({{"primitives", {{{"attributes", attributes}}}}});
        return file.root["meshes"].size() - 1;
    }
};

size_t drawn(const Scene& scene, const std::string& name) {
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].name == name && scene.nodes[i].mesh != scene::kNone) return i;
    ADD_FAILURE() << "no node " << name << " shows a mesh";
    return 0;
}

struct Seen {
    glm::vec3 position{0}, normal{0};
};

/// A vertex of a node in the world.
Seen seen(const Scene& scene, const std::string& name, size_t vertex, const std::vector<glm::dmat4>& world) {
    const size_t node = drawn(scene, name);
    const scene::Vertex& v = scene.meshes.at(scene.nodes.at(node).mesh).primitives.at(0).vertices.at(vertex);
    return {glm::vec3(world[node] * glm::dvec4(v.position, 1)),
            glm::normalize(glm::transpose(glm::inverse(glm::mat3(glm::mat4(world[node])))) * v.normal)};
}
Seen seen(const Scene& scene, const std::string& name, size_t vertex) {
    return seen(scene, name, vertex, scene::world_transforms(scene, 0));
}

void expect_near(glm::vec3 got, glm::vec3 want, double near = 1e-5) {
    EXPECT_LT(glm::length(got - want), near)
        << got.x << " " << got.y << " " << got.z << ", not " << want.x << " " << want.y << " " << want.z;
}

// 3.7.3.3: only the transforms of joints apply, that of the node with the mesh does not.
TEST(GltfSkin, JointsPutAMeshInPlaceAndItsNodeDoesNot) {
    Rig rig;
    rig.bind({}, {0});  // no matrices: identities
    rig.file.root["nodes"] = {{{"name", "joint"}, {"translation", {0.5, 0, 0}}},
                              {{"name", "body"}, {"mesh", rig.mesh()}, {"skin", 0}, {"translation", {-5, 1, 2}}}};
    const scene::LoadedScene loaded = rig.file.read();
    expect_near(seen(loaded.scene, "body", 0).position, {0.5f, 0, 0});
    expect_near(seen(loaded.scene, "body", 1).position, {1.5f, 0, 0});
    EXPECT_TRUE(mentions(loaded.notes, "with a skin is shown at rest"));
}

/// Centimetres, Z up, under nodes that make metres of them and Y up; modelled in metres, bound before the figure was
/// put at (3, 0, 4).
Rig figure() {
    Rig rig;
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), -std::acos(-1.0) / 2, glm::dvec3(1, 0, 0));
    const glm::dmat4 bound =
        glm::scale(turned, glm::dvec3(0.01)) * glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 100));
    rig.bind({glm::inverse(bound)}, {2});
    rig.file.root["nodes"] = {
        {{"name", "figure"}, {"translation", {3, 0, 4}}, {"children", {1}}},
        {{"name", "armature"}, {"rotation", kUp}, {"scale", {0.01, 0.01, 0.01}}, {"children", {2, 3}}},
        {{"name", "hips"}, {"translation", {0, 0, 100}}},
        {{"name", "body"}, {"mesh", rig.mesh()}, {"skin", 0}, {"scale", {7, 7, 7}}}};
    return rig;
}

TEST(GltfSkin, FiguresInCentimetresWithZUpStandUpright) {
    const Scene scene = figure().file.read().scene;
    for (size_t i = 0; i < 3; ++i) {
        expect_near(seen(scene, "body", i).position,
                    glm::vec3(kTriangle[3 * i] + 3, kTriangle[3 * i + 1], kTriangle[3 * i + 2] + 4));
        expect_near(seen(scene, "body", i).normal, {0, 0, 1});
    }
    const scene::Primitive& primitive = scene.meshes.at(scene.nodes[drawn(scene, "body")].mesh).primitives.at(0);
    for (const scene::Vertex& v : primitive.vertices)
        EXPECT_TRUE(glm::all(glm::lessThanEqual(v.position, primitive.bounds.high)));
}

// What programs move by name, or keys: a node above the joints takes the mesh along; so does the mesh's own name.
// Joints and the mesh's node of the file have no say.
TEST(GltfSkin, MeshesGoWithWhatTheirJointsStandOn) {
    GltfFile file = figure().file;
    const auto times = file.accessor(std::vector<float>{0, 1}, 5126, "SCALAR", 1);
    const auto moves = file.vec3({0, 0, 0, 50, 0, 0});
    const auto keyed = [&](size_t node) {
        file.root["animations"] = {
            {{"samplers", {{{"input", times}, {"output", moves}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}}};
        const Scene scene = file.read().scene;
        return seen(scene, "body", 0, scene::world_transforms(scene, 1)).position;
    };
    expect_near(keyed(0), {50, 0, 0}, 1e-4);
    expect_near(keyed(2), {3, 0, 4}, 1e-4);
    expect_near(keyed(3), {3, 0, 4}, 1e-4);
    const Scene scene = file.read().scene;
    EXPECT_EQ(
        std::count_if(scene.nodes.begin(), scene.nodes.end(), [](const scene::Node& n) { return n.name == "body"; }),
        1);
    const auto moved = scene::placed_transforms(
        scene, 0, {{static_cast<uint32_t>(drawn(scene, "body")), glm::translate(glm::mat4(1), glm::vec3(9, 0, 0))}});
    EXPECT_FLOAT_EQ(seen(scene, "body", 0, moved).position.x, 9);
}

TEST(GltfSkin, BlendsJointsByTheirWeights) {
    Rig rig;
    rig.bind({glm::dmat4(1), glm::dmat4(1), glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -1))}, {0, 1, 2});
    rig.joints = {0, 1, 0, 0, 2, 9, 0, 0, 1, 0, 0, 0};          // a joint that is none, of weight 0
    rig.weights = {0.5f, 0.25f, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};  // not of sum 1; nothing at all
    rig.normals = {0, 0, 1, 0, 1, 1, 0, 0, 1};
    const size_t mesh = rig.mesh();
    rig.file.root["nodes"] = {{{"translation", {6, 0, 0}}},
                              {{"translation", {0, 3, 0}}},
                              {{"scale", {1, 1, 2}}},
                              {{"name", "body"}, {"mesh", mesh}, {"skin", 0}}};
    const Scene scene = rig.file.read().scene;
    expect_near(seen(scene, "body", 0).position, {4, 1, 0});   // 2/3 of one, 1/3 of the other
    expect_near(seen(scene, "body", 1).position, {1, 0, -2});  // moved by -1, then drawn out
    expect_near(seen(scene, "body", 1).normal, glm::normalize(glm::vec3(0, 1, 0.5f)));
    expect_near(seen(scene, "body", 2).position, {0, 4, 0});  // with its first joint

    json& attributes = rig.file.root["meshes"][mesh]["primitives"][0]["attributes"];
    attributes["JOINTS_1"] =
        rig.file.accessor(std::vector<uint16_t>{1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0}, 5123, "VEC4", 4);
    attributes["WEIGHTS_1"] =
        rig.file.accessor(std::vector<uint8_t>{255, 0, 0, 0, 0, 0, 0, 0, 51, 0, 0, 0}, 5121, "VEC4", 4, true);
    const Scene more = rig.file.read().scene;
    expect_near(seen(more, "body", 0).position, {6 * 0.5f / 1.75f, 3 * 1.25f / 1.75f, 0});
    expect_near(seen(more, "body", 2).position, {6, 1, 0});
}

TEST(GltfSkin, MirroringJointsTurnTrianglesRound) {
    Rig rig;
    rig.bind({}, {0});
    rig.file.root["nodes"] = {{{"scale", {-1, 1, 1}}}, {{"name", "body"}, {"mesh", rig.mesh()}, {"skin", 0}}};
    const Scene scene = rig.file.read().scene;
    const scene::Primitive& p = scene.meshes.at(scene.nodes[drawn(scene, "body")].mesh).primitives.at(0);
    const auto corner = [&](size_t i) { return p.vertices[p.indices[i]].position; };
    const glm::vec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    EXPECT_GT(glm::dot(normal, p.vertices[0].normal), 0.9f);
    expect_near(p.vertices[0].normal, {0, 0, 1});
}

TEST(GltfSkin, AMeshOfSeveralSkinsIsReadForEach) {
    Rig rig;
    const size_t mesh = rig.mesh();
    rig.bind({}, {0});
    rig.bind({}, {1});
    rig.file.root["nodes"] = {{{"translation", {1, 0, 0}}},
                              {{"translation", {2, 0, 0}}},
                              {{"name", "a"}, {"mesh", mesh}, {"skin", 0}},
                              {{"name", "b"}, {"mesh", mesh}, {"skin", 1}},
                              {{"name", "c"}, {"mesh", mesh}},
                              {{"name", "d"}, {"mesh", mesh}, {"skin", 1}}};
    const Scene scene = rig.file.read().scene;
    EXPECT_EQ(scene.meshes.size(), 3u);
    for (const auto& [name, x] : {std::pair("a", 1.0f), {"b", 2.0f}, {"c", 0.0f}, {"d", 2.0f}})
        EXPECT_EQ(seen(scene, name, 0).position.x, x) << name;
    scene::SceneLimits few;
    few.vertices = 8;  // three triangles have nine
    EXPECT_TRUE(contains(rig.file.complaint(few), "over the limit"));
}

// Joints of another scene have a place as well; a mesh that names no joints stays where its node is.
TEST(GltfSkin, WhatIsNotThereDoesNoHarm) {
    Rig rig;
    const size_t mesh = rig.mesh();
    rig.bind({}, {1});
    rig.file.root["nodes"] = {{{"translation", {1, 0, 0}}, {"children", {1}}},
                              {{"translation", {0, 2, 0}}},
                              {{"name", "a"}, {"mesh", mesh}, {"skin", 0}, {"translation", {5, 5, 5}}}};
    rig.file.root["scenes"] = {{{"nodes", {2}}}};
    expect_near(seen(rig.file.read().scene, "a", 0).position, {1, 2, 0});
    rig.file.root["meshes"][mesh]["primitives"][0]["attributes"].erase("JOINTS_0");
    const scene::LoadedScene loaded = rig.file.read();
    expect_near(seen(loaded.scene, "a", 0).position, {5, 5, 5});
    EXPECT_TRUE(mentions(loaded.notes, "as it is modelled"));
}

TEST(GltfSkin, WhatCannotBePutInPlaceIsRefused) {
    const auto complaint = [](auto change) {
        Rig rig;
        rig.bind({glm::dmat4(1)}, {0});
        rig.file.root["nodes"] = {json::object(), {{"mesh", 0}, {"skin", 0}}};
        change(rig);
        rig.mesh();
        return rig.file.complaint();
    };
    EXPECT_EQ(complaint([](Rig&) {}), "");
    EXPECT_TRUE(contains(complaint([](Rig& rig) { rig.joints[4] = 1; }),
                         "/meshes/0/primitives/0/attributes: vertex 1 hangs on a joint that is none of the skin's 1"));
    EXPECT_TRUE(contains(complaint([](Rig& rig) {
                             rig.file.root["skins"][0]["joints"] = {0, 1};
                         }),
                         "/skins/0/inverseBindMatrices: has 1 matrices for 2 joints"));
    EXPECT_TRUE(contains(complaint([](Rig& rig) { rig.file.root["skins"][0]["joints"] = {7}; }), "/skins/0/joints/0"));
    EXPECT_TRUE(contains(complaint([](Rig& rig) { rig.file.root["skins"][0]["joints"] = json::array(); }),
                         "/skins/0: has no joints"));
    EXPECT_TRUE(contains(complaint([](Rig& rig) { rig.file.root["nodes"][1]["skin"] = 3; }), "/nodes/1/skin"));
    EXPECT_TRUE(contains(complaint([](Rig& rig) { rig.weights[0] = std::numeric_limits<float>::infinity(); }),
                         "no finite place"));
    EXPECT_TRUE(contains(
        complaint([](Rig& rig) { rig.bind({glm::dmat4(std::nan(""))}, {0}), rig.file.root["skins"].erase(0); }),
        "matrix 0 is not finite"));
}

TEST(GltfSkin, JointsOfAnyDepthTakeATimeThatIsBounded) {
    Rig rig;
    const int depth = 1000, skins = 100;
    for (int i = 0; i < depth; ++i) rig.file.root["nodes"].push_back({{"children", {i + 1}}});
    rig.file.root["nodes"].push_back(json::object());
    const size_t mesh = rig.mesh();
    for (int i = 0; i < skins; ++i)
        rig.bind({}, {0, depth}), rig.file.root["nodes"].push_back({{"mesh", mesh}, {"skin", i}});
    scene::SceneLimits limits;
    limits.nodes = 2 * depth;
    EXPECT_TRUE(contains(rig.file.complaint(limits), "together stand too deep"));
    EXPECT_EQ(rig.file.complaint(), "");
}

// 3.7.2.2: weights of the node, or else of the mesh.
TEST(GltfMorph, TargetsCountByTheirWeights) {
    GltfFile file;
    const json targets = {
        {{"POSITION", file.vec3({1, 0, 0, 1, 0, 0, 1, 0, 0})}, {"NORMAL", file.vec3({1, 0, 0, 1, 0, 0, 1, 0, 0})}},
        {{"POSITION", file.vec3({0, 2, 0, 0, 2, 0, 0, 2, 0})}}};
    const json attributes = {{"POSITION", file.vec3(kTriangle)}, {"NORMAL", file.vec3({0, 0, 1, 0, 0, 1, 0, 0, 1})}};
    file.root["meshes"] = {{{"primitives", {{{"attributes", attributes}, {"targets", targets}}}}, {"weights", {1, 0}}}};
    file.root["nodes"] = {{{"name", "a"}, {"mesh", 0}},
                          {{"name", "b"}, {"mesh", 0}, {"weights", {0.5, -0.5}}},
                          {{"name", "c"}, {"mesh", 0}, {"weights", {0, 0}}}};
    const Scene scene = file.read().scene;
    expect_near(seen(scene, "a", 0).position, {1, 0, 0});
    expect_near(seen(scene, "a", 0).normal, glm::normalize(glm::vec3(1, 0, 1)));
    expect_near(seen(scene, "b", 0).position, {0.5f, -1, 0});
    expect_near(seen(scene, "b", 0).normal, glm::normalize(glm::vec3(0.5f, 0, 1)));
    expect_near(seen(scene, "c", 0).position, {0, 0, 0});
    file.root["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = file.vec3({1, 0, 0});
    EXPECT_TRUE(contains(file.complaint(), "/targets/0/POSITION: has 1 elements"));
    file.root["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = file.vec2({1, 0, 1, 0, 1, 0});
    EXPECT_TRUE(mentions(file.read().notes, "a morph target that is not of type VEC3 is left out"));
}

TEST(GltfMorph, FlatNormalsAreThoseOfWhatIsShown) {
    GltfFile file;
    const json targets = {{{"POSITION", file.vec3({0, 0, 0, 0, 0, 0, 0, -1, 1})}}};  // the upper corner comes forward
    file.root["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", file.vec3(kTriangle)}}}, {"targets", targets}}}},
         {"weights", {1}}}};
    file.root["nodes"] = {{{"name", "a"}, {"mesh", 0}}};
    expect_near(seen(file.read().scene, "a", 0).normal, {0, -1, 0});
}

}  // namespace
}  // namespace vesper::test
