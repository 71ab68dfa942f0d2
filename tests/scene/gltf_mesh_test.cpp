// Meshes: what any accessors become. SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/scene_files.h"

namespace vesper::test {
namespace {

const scene::Primitive& only_primitive(const scene::LoadedScene& loaded) {
    return loaded.scene.meshes.at(0).primitives.at(0);
}

TEST(GltfMesh, MakesFlatNormalsWhereThereAreNone) {
    GltfFile file;
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}}}});
    const scene::LoadedScene loaded = file.read();
    const scene::Primitive& p = only_primitive(loaded);
    ASSERT_EQ(p.indices.size(), 3u);
    for (const scene::Vertex& v : p.vertices) EXPECT_EQ(v.normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(p.bounds.low, glm::vec3(0, 0, 0));
    EXPECT_EQ(p.bounds.high, glm::vec3(1, 1, 0));
    EXPECT_EQ(loaded.scene.materials.at(p.material).base_colour, glm::vec4(0.5f, 0.5f, 0.5f, 1));
    EXPECT_EQ(loaded.scene.materials.at(p.material).metallic, 0);
}

TEST(GltfMesh, ReadsEveryComponentType) {
    const auto uv_of = [](auto values, int type, bool normalized) {
        GltfFile file;
        const size_t uv = file.accessor(values, type, "VEC2", 2, normalized);
        file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}, {"TEXCOORD_0", uv}}}});
        return only_primitive(file.read()).vertices.at(1).uv;
    };
    EXPECT_EQ(uv_of(std::vector<float>{0, 0, 0.25f, 0.5f, 0, 0}, 5126, false), glm::vec2(0.25f, 0.5f));
    EXPECT_EQ(uv_of(std::vector<uint8_t>{0, 0, 51, 255, 0, 0}, 5121, true), glm::vec2(0.2f, 1));
    EXPECT_EQ(uv_of(std::vector<uint16_t>{0, 0, 13107, 65535, 0, 0}, 5123, true), glm::vec2(0.2f, 1));
    EXPECT_EQ(uv_of(std::vector<int8_t>{0, 0, -128, 127, 0, 0}, 5120, true), glm::vec2(-1, 1));
    EXPECT_EQ(uv_of(std::vector<int16_t>{0, 0, -32768, 32767, 0, 0}, 5122, true), glm::vec2(-1, 1));
    // KHR_mesh_quantization: integers as they are
    EXPECT_EQ(uv_of(std::vector<int8_t>{0, 0, -5, 7, 0, 0}, 5120, false), glm::vec2(-5, 7));
    EXPECT_EQ(uv_of(std::vector<uint32_t>{0, 0, 3, 4, 0, 0}, 5125, false), glm::vec2(3, 4));
}

TEST(GltfMesh, ReadsStridedAndSparseAccessors) {
    GltfFile file;
    const std::vector<float> interleaved = {0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9};
    const size_t position = file.vec3(interleaved);
    file.root["bufferViews"][0]["byteStride"] = 16;
    file.root["accessors"][position]["count"] = 3;
    const size_t where = file.buffer_view(std::vector<uint8_t>{1}),
                 what = file.buffer_view(std::vector<float>{5, 6, 7});
    file.root["accessors"][position]["sparse"] = {{"count", 1},
                                                  {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                                                  {"values", {{"bufferView", what}}}};
    file.show({{"attributes", {{"POSITION", position}}}});
    const scene::Primitive p = only_primitive(file.read());
    EXPECT_EQ(p.vertices.at(1).position, glm::vec3(5, 6, 7));
    EXPECT_EQ(p.vertices.at(2).position, glm::vec3(0, 1, 0));
}

TEST(GltfMesh, TurnsStripsAndFansIntoTriangles) {
    const std::vector<float> quad = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const std::vector<float> up = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    for (const int mode : {5, 6}) {
        GltfFile file;
        const std::vector<uint16_t> corners =
            mode == 5 ? std::vector<uint16_t>{0, 1, 2, 3} : std::vector<uint16_t>{0, 1, 3, 2};
        const nlohmann::json attributes = {{"POSITION", file.vec3(quad)}, {"NORMAL", file.vec3(up)}};
        file.show({{"attributes", attributes}, {"indices", file.indices(corners)}, {"mode", mode}});
        const scene::Primitive p = only_primitive(file.read());
        ASSERT_EQ(p.indices.size(), 6u);
        for (size_t i = 0; i < 6; i += 3) {
            const glm::vec3 a = p.vertices[p.indices[i]].position, b = p.vertices[p.indices[i + 1]].position,
                            c = p.vertices[p.indices[i + 2]].position;
            EXPECT_FLOAT_EQ(glm::cross(b - a, c - a).z, 1) << "mode " << mode;  // counter-clockwise, of that area
        }
    }
}

TEST(GltfMesh, LeavesOutPointsAndLinesAndEmptyTriangles) {
    GltfFile file;
    const size_t position = file.vec3(kTriangle);
    file.show({{"attributes", {{"POSITION", position}}}, {"mode", 0}});
    file.show({{"attributes", {{"POSITION", position}}}, {"indices", file.indices({0, 1, 1})}});
    const scene::LoadedScene loaded = file.read();
    EXPECT_TRUE(loaded.scene.meshes.at(0).primitives.empty());
    EXPECT_TRUE(loaded.scene.meshes.at(1).primitives.empty());
    EXPECT_TRUE(mentions(loaded.notes, "points or lines"));
}

TEST(GltfMesh, ReadsVertexColoursOfAnyKind) {
    GltfFile file;
    const nlohmann::json position = file.vec3(kTriangle);
    file.show({{"attributes", {{"POSITION", position}, {"COLOR_0", file.vec3({1, 0, 0.5f, 2, 0, 0, 0, 0, 0})}}}});
    const size_t shorts =
        file.accessor(std::vector<uint16_t>{65535, 0, 0, 32768, 0, 0, 0, 0, 0, 0, 0, 0}, 5123, "VEC4", 4, true);
    file.show({{"attributes", {{"POSITION", position}, {"COLOR_0", shorts}}}});
    const scene::LoadedScene loaded = file.read();
    using Colour = std::array<uint16_t, 4>;
    EXPECT_EQ(loaded.scene.meshes[0].primitives[0].vertices[0].colour, (Colour{65535, 0, 32768, 65535}));
    EXPECT_EQ(loaded.scene.meshes[0].primitives[0].vertices[1].colour, (Colour{65535, 0, 0, 65535}));  // limited
    EXPECT_EQ(loaded.scene.meshes[1].primitives[0].vertices[0].colour, (Colour{65535, 0, 0, 32768}));
    EXPECT_TRUE(mentions(loaded.notes, "vertex colours outside"));
}

// Asphalt is dark, and so are the shadows that are painted on it: 8 bits of linear values would end at 0.004.
TEST(GltfMesh, KeepsDarkVertexColours) {
    GltfFile file;
    const nlohmann::json position = file.vec3(kTriangle);
    file.show({{"attributes",
                {{"POSITION", position}, {"COLOR_0", file.vec3({0.001f, 0.003f, 0.0196f, 0, 0, 0, 0, 0, 0})}}}});
    file.show(
        {{"attributes",
          {{"POSITION", position},
           {"COLOR_0", file.accessor(std::vector<uint16_t>{1000, 65, 1, 0, 0, 0, 0, 0, 0}, 5123, "VEC3", 3, true)}}}});
    const scene::Scene scene = file.read().scene;
    const auto colour = [&](size_t mesh, size_t c) {
        return scene.meshes[mesh].primitives[0].vertices[0].colour[c] / 65535.0;
    };
    for (const auto& [c, value] : {std::pair(0u, 0.001), {1u, 0.003}, {2u, 0.0196}})
        EXPECT_NEAR(colour(0, c) / value, 1, 0.01);
    EXPECT_EQ(scene.meshes[1].primitives[0].vertices[0].colour, (std::array<uint16_t, 4>{1000, 65, 1, 65535}));
}

TEST(GltfMesh, KeepsOnlyTheVerticesAPrimitiveUses) {
    GltfFile file;
    std::vector<float> many(3 * 1000, 7.0f), normals;
    std::copy(kTriangle.begin(), kTriangle.end(), many.begin() + 300);
    for (int i = 0; i < 1000; ++i) normals.insert(normals.end(), {0, 0, 1});
    const nlohmann::json attributes = {{"POSITION", file.vec3(many)}, {"NORMAL", file.vec3(normals)}};
    file.show({{"attributes", attributes}, {"indices", file.indices({100, 101, 102})}});
    const scene::Primitive p = only_primitive(file.read());
    EXPECT_EQ(p.vertices.size(), 3u);
    EXPECT_EQ(p.bounds.high, glm::vec3(1, 1, 0));
}

TEST(GltfMesh, RepairsNormalsOfNoDirection) {
    GltfFile file;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const size_t normals = file.vec3({0, 0, 0, nan, 0, 0, 0, 3, 0});
    file.show({{"attributes", {{"POSITION", file.vec3(kTriangle)}, {"NORMAL", normals}}}});
    const scene::Primitive p = only_primitive(file.read());
    EXPECT_EQ(p.vertices[0].normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(p.vertices[1].normal, glm::vec3(0, 0, 1));
    EXPECT_EQ(p.vertices[2].normal, glm::vec3(0, 1, 0));
}

TEST(GltfMesh, ExpandsInstances) {
    GltfFile file;
    const size_t translation = file.vec3({1, 0, 0, 2, 0, 0});
    const size_t rotation = file.accessor(std::vector<int16_t>{0, 0, 0, 32767, 0, 32767, 0, 0}, 5122, "VEC4", 4, true);
    const nlohmann::json attributes = {{"TRANSLATION", translation}, {"ROTATION", rotation}};
    file.show(
        {{"attributes", {{"POSITION", file.vec3(kTriangle)}}}},
        {{"translation", {10, 0, 0}}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
    file.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const scene::Scene scene = file.read().scene;
    ASSERT_EQ(scene.nodes.size(), 3u);
    EXPECT_EQ(scene.nodes[0].mesh, scene::kNone);
    EXPECT_EQ(scene.nodes[1].mesh, 0u);
    const auto world = scene::world_transforms(scene, 0);
    EXPECT_EQ(world[1][3], glm::dvec4(11, 0, 0, 1));
    EXPECT_NEAR(world[2][0].x, -1, 1e-6);  // half a turn about Y
}

}  // namespace
}  // namespace vesper::test
