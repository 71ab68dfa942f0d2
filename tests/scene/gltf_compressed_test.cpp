// Geometry that is compressed: as it was, and no more than its bytes can hold. SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "base/budget.h"
#include "scene/convert.h"
#include "scene/gltf_compressed.h"
#include "scene/scene_files.h"
#include "support/shared_data.h"

#ifdef VESPER_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

namespace vesper::test {
namespace {

using nlohmann::json;

constexpr uint32_t kSide = 17;  // vertices along each side of a wave of 2 m by 2 m
constexpr double kMost = 0.3;   // m of the wave

double height(double x, double y) { return kMost * std::sin(3 * x) * std::cos(2 * y); }

struct Wave {
    std::vector<float> positions, normals, uv;
    std::vector<uint16_t> corners;
};

Wave wave() {
    Wave made;
    for (uint32_t j = 0; j < kSide; ++j)
        for (uint32_t i = 0; i < kSide; ++i) {
            const double x = 2.0 * i / (kSide - 1), y = 2.0 * j / (kSide - 1);
            const glm::dvec3 normal = glm::normalize(glm::dvec3(-3 * kMost * std::cos(3 * x) * std::cos(2 * y),
                                                                2 * kMost * std::sin(3 * x) * std::sin(2 * y), 1));
            made.positions.insert(made.positions.end(), {float(x), float(y), float(height(x, y))});
            made.normals.insert(made.normals.end(), {float(normal.x), float(normal.y), float(normal.z)});
            made.uv.insert(made.uv.end(), {float(x / 2), float(y / 2)});
        }
    for (uint32_t j = 0; j + 1 < kSide; ++j)
        for (uint32_t i = 0; i + 1 < kSide; ++i) {
            const auto at = [&](uint32_t di, uint32_t dj) { return uint16_t((j + dj) * kSide + i + di); };
            made.corners.insert(made.corners.end(), {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)});
        }
    return made;
}

scene::LoadedScene read(const json& root) {
    const TempFolder folder;
    const Budget budget("reading");
    return scene::read_scene(folder.write("scene.gltf", root.dump()));
}

/// Corners, the least first, of each triangle.
std::set<std::array<std::array<float, 3>, 3>> triangles_of(const scene::Primitive& primitive) {
    std::set<std::array<std::array<float, 3>, 3>> made;
    for (size_t i = 0; i < primitive.indices.size(); i += 3) {
        std::array<std::array<float, 3>, 3> corners;
        for (size_t c = 0; c < 3; ++c) {
            const glm::vec3& p = primitive.vertices[primitive.indices[i + c]].position;
            corners[c] = {p.x, p.y, p.z};
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        made.insert(corners);
    }
    return made;
}

json plain_file(const Wave& of) {
    GltfFile file;
    const size_t position = file.vec3(of.positions), normal = file.vec3(of.normals), uv = file.vec2(of.uv),
                 corners = file.indices(of.corners);
    file.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}}, {"indices", corners}});
    return json::parse(file.text());
}

/// The views of a plain file, compressed with meshoptimizer's own encoders, in its first buffer.
json meshopt_file(const Wave& of, const char* indices_mode) {
    json root = plain_file(of);
    std::vector<uint8_t> bytes;
    const auto take = [&](size_t view, const std::vector<uint8_t>& encoded, const char* mode, size_t stride,
                          size_t count) {
        while (bytes.size() % 4 != 0) bytes.push_back(0);
        root["bufferViews"][view]["buffer"] = 1;
        root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] = {
            {"buffer", 0},  {"byteOffset", bytes.size()}, {"byteLength", encoded.size()},
            {"mode", mode}, {"byteStride", stride},       {"count", count}};
        bytes.insert(bytes.end(), encoded.begin(), encoded.end());
    };
    const auto attribute = [&](size_t view, const std::vector<float>& values, size_t components) {
        const size_t count = values.size() / components, stride = components * sizeof(float);
        std::vector<uint8_t> encoded(meshopt_encodeVertexBufferBound(count, stride));
        encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), values.data(), count, stride));
        take(view, encoded, "ATTRIBUTES", stride, count);
    };
    attribute(0, of.positions, 3), attribute(1, of.normals, 3), attribute(2, of.uv, 2);
    std::vector<unsigned> corners(of.corners.begin(), of.corners.end());
    std::vector<uint8_t> encoded(10'000);
    const auto encode = std::string(indices_mode) == "TRIANGLES"
                            ? [](uint8_t* to, size_t size, const unsigned* from,
                                 size_t n) { return meshopt_encodeIndexBuffer(to, size, from, n); }
                            : [](uint8_t* to, size_t size, const unsigned* from, size_t n) {
                                  return meshopt_encodeIndexSequence(to, size, from, n);
                              };
    encoded.resize(encode(encoded.data(), encoded.size(), corners.data(), corners.size()));
    take(3, encoded, indices_mode, 2, corners.size());
    const json length = root["buffers"][0]["byteLength"];
    root["buffers"] = {
        {{"byteLength", bytes.size()}, {"uri", scene::encode_data_uri("application/octet-stream", bytes)}},
        {{"byteLength", length}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    root["extensionsUsed"] = root["extensionsRequired"] = {"EXT_meshopt_compression"};
    return root;
}

TEST(GltfMeshopt, IsTheGeometryThatWasCompressed) {
    const scene::LoadedScene plain = read(plain_file(wave()));
    const scene::Primitive& wanted = plain.scene.meshes.at(0).primitives.at(0);
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
        const scene::LoadedScene loaded = read(meshopt_file(wave(), mode));
        const scene::Primitive& found = loaded.scene.meshes.at(0).primitives.at(0);
        EXPECT_EQ(loaded.notes, plain.notes);
        EXPECT_EQ(triangles_of(found), triangles_of(wanted)) << mode;
        EXPECT_EQ(found.vertices.size(), wanted.vertices.size());
        for (const scene::Vertex& v : found.vertices) {
            const auto same = std::ranges::find_if(
                wanted.vertices, [&](const scene::Vertex& other) { return other.position == v.position; });
            ASSERT_NE(same, wanted.vertices.end());
            EXPECT_EQ(same->normal, v.normal);
            EXPECT_EQ(same->uv, v.uv);
        }
    }
}

// Closed forms of the filters: +X as octahedral bytes; 3 * 2^-2 of mantissa and exponent.
TEST(GltfMeshopt, FiltersAreUndone) {
    GltfFile file;
    const size_t position = file.vec3(kTriangle);
    std::vector<uint8_t> values;
    const int8_t oct[]{127, 0, 127, 0};
    for (int i = 0; i < 3; ++i) values.insert(values.end(), oct, oct + 4);
    std::vector<uint8_t> encoded(meshopt_encodeVertexBufferBound(3, 4));
    encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), values.data(), 3, 4));
    const size_t view = file.buffer_view(encoded);
    const size_t normal = file.accessor(std::vector<int8_t>(12), 5120, "VEC3", 3, true);
    file.root["accessors"][normal]["count"] = 3;
    file.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
    json root = json::parse(file.text());
    json& of_normals = root["bufferViews"][root["accessors"][normal]["bufferView"].get<size_t>()];
    of_normals = {{"buffer", 1},
                  {"byteLength", 12},
                  {"byteStride", 4},
                  {"extensions",
                   {{"EXT_meshopt_compression",
                     {{"buffer", 0},
                      {"byteOffset", root["bufferViews"][view]["byteOffset"]},
                      {"byteLength", encoded.size()},
                      {"mode", "ATTRIBUTES"},
                      {"filter", "OCTAHEDRAL"},
                      {"byteStride", 4},
                      {"count", 3}}}}}};
    root["buffers"].push_back({{"byteLength", 12}, {"extensions", {{"EXT_meshopt_compression", json::object()}}}});
    const scene::LoadedScene loaded = read(root);
    for (const scene::Vertex& v : loaded.scene.meshes.at(0).primitives.at(0).vertices)
        EXPECT_EQ(v.normal, glm::vec3(1, 0, 0));
    root["bufferViews"][1]["byteLength"] = root["bufferViews"][view]["byteLength"];
    of_normals["extensions"]["EXT_meshopt_compression"]["filter"] = "QUATERNION";
    EXPECT_TRUE(contains(complaint_of([&] { read(root); }), "filter: does not fit"));
}

TEST(GltfMeshopt, NamesThePlaceOfWhatIsWrong) {
    const std::string at = "/bufferViews/0/extensions/EXT_meshopt_compression";
    expect_places(meshopt_file(wave(), "TRIANGLES"),
                  {{"/bufferViews/0/extensions/EXT_meshopt_compression/count", 2'000'000'000, "count: states more"},
                   {"/bufferViews/0/extensions/EXT_meshopt_compression/count", 300, "byteLength: is less"},
                   {"/bufferViews/0/extensions/EXT_meshopt_compression/byteStride", 10, "byteStride: does not fit"},
                   {"/bufferViews/0/extensions/EXT_meshopt_compression/byteLength", 100, "is damaged"},
                   {"/bufferViews/0/extensions/EXT_meshopt_compression/byteLength", 1e9, "reaches beyond"},
                   {"/bufferViews/0/extensions/EXT_meshopt_compression/mode", "ANY", "mode: is no mode"},
                   {"/bufferViews/0/extensions/EXT_meshopt_compression/buffer", 1, "buffer: names a buffer without"},
                   {"/bufferViews/3/extensions/EXT_meshopt_compression/count", 1535, "count: is no multiple of three"},
                   {"/bufferViews/0/extensions", json::object(), "and is not compressed"},
                   {"/bufferViews/0/byteOffset", 2, "/bufferViews/0/byteOffset: is no multiple"},
                   {"/bufferViews/0/byteOffset", 1'000'000'000, "/buffers/1/byteLength: is more than"},
                   {"/buffers/1/byteLength", 1'000'000'000, "/buffers/1/byteLength: is more than"}},
                  [](const json& root) { return complaint_of([&] { read(root); }); });
    // Two that name each other.
    json root = meshopt_file(wave(), "TRIANGLES");
    root["buffers"].push_back(root["buffers"][1]);
    root["bufferViews"].push_back(root["bufferViews"][0]);
    root["bufferViews"][4]["buffer"] = 2;
    root["bufferViews"][4]["extensions"]["EXT_meshopt_compression"]["buffer"] = 1;
    root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["buffer"] = 2;
    EXPECT_TRUE(contains(complaint_of([&] { read(root); }), "names a buffer without bytes of its own"));
}

#ifdef VESPER_DRACO

/// The wave as Draco geometry: attributes 0, 1 and 2 are positions, normals and texture coordinates.
std::vector<uint8_t> draco_bytes(const Wave& of, int method) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(of.corners.size() / 3));
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32),
              normal = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32),
              uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    for (size_t i = 0; i < of.corners.size() / 3; ++i) {
        const auto set = [&](int attribute, const std::vector<float>& values, size_t n) {
            const auto at = [&](size_t c) { return &values[of.corners[3 * i + c] * n]; };
            builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(uint32_t(i)), at(0), at(1), at(2));
        };
        set(position, of.positions, 3), set(normal, of.normals, 3), set(uv, of.uv, 2);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 12);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 12);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {buffer.data(), buffer.data() + buffer.size()};
}

json draco_file(const Wave& of, const std::vector<uint8_t>& bytes) {
    GltfFile file;
    const size_t view = file.buffer_view(bytes);
    json root;
    const auto shell = [&](int component, const char* type, size_t count) {
        file.root["accessors"].push_back({{"componentType", component}, {"type", type}, {"count", count}});
        return file.root["accessors"].size() - 1;
    };
    const size_t vertices = of.positions.size() / 3;
    const size_t position = shell(5126, "VEC3", vertices), normal = shell(5126, "VEC3", vertices),
                 uv = shell(5126, "VEC2", vertices), corners = shell(5123, "SCALAR", of.corners.size());
    file.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
               {"indices", corners},
               {"extensions",
                {{"KHR_draco_mesh_compression",
                  {{"bufferView", view}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}}}}}});
    file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return json::parse(file.text());
}

TEST(GltfDraco, IsTheGeometryThatWasCompressed) {
    const Wave of = wave();
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        const scene::LoadedScene loaded = read(draco_file(of, draco_bytes(of, method)));
        const scene::Primitive& found = loaded.scene.meshes.at(0).primitives.at(0);
        EXPECT_EQ(loaded.notes, read(plain_file(of)).notes);
        EXPECT_EQ(found.indices.size(), of.corners.size());
        EXPECT_EQ(found.vertices.size(), of.positions.size() / 3);
        double area = 0;
        for (size_t i = 0; i < found.indices.size(); i += 3) {
            const auto at = [&](size_t c) { return glm::dvec2(found.vertices[found.indices[i + c]].position); };
            const glm::dvec2 a = at(1) - at(0), b = at(2) - at(0);
            area += (a.x * b.y - a.y * b.x) / 2;
        }
        EXPECT_NEAR(area, 4, 1e-3) << "counter-clockwise from +Z, each once";
        const double step = 2.0 / (1 << 14);
        for (const scene::Vertex& v : found.vertices) {
            EXPECT_NEAR(v.position.z, height(v.position.x, v.position.y), 3 * step);
            EXPECT_NEAR(v.uv.x, v.position.x / 2, 1.0 / (1 << 11));
            EXPECT_NEAR(v.uv.y, v.position.y / 2, 1.0 / (1 << 11));
            const glm::dvec3 normal =
                glm::normalize(glm::dvec3(-3 * kMost * std::cos(3 * v.position.x) * std::cos(2 * v.position.y),
                                          2 * kMost * std::sin(3 * v.position.x) * std::sin(2 * v.position.y), 1));
            EXPECT_GT(glm::dot(normal, glm::dvec3(v.normal)), std::cos(0.002));
        }
    }
}

TEST(GltfDraco, NamesThePlaceOfWhatIsWrong) {
    const Wave of = wave();
    const auto complaint = [](const json& root) { return complaint_of([&] { read(root); }); };
    const json good = draco_file(of, draco_bytes(of, draco::MESH_EDGEBREAKER_ENCODING));
    const char* at = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    expect_places(
        good,
        {{"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView", 1, "bufferView"},
         {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION", 7, "no attribute 7"},
         {"/accessors/0/type", "VEC2", "/accessors/0: has another number of components"},
         {"/bufferViews/0/byteLength", 60, at},
         {"/bufferViews/0/byteLength", 4, at},
         {"/bufferViews/0/byteOffset", 1, "/bufferViews/0"}},
        complaint);
    // Each byte changed: the geometry, another one, or an error, and never more memory than the budget has.
    const std::vector<uint8_t> bytes = draco_bytes(of, draco::MESH_EDGEBREAKER_ENCODING);
    size_t refused = 0;
    for (size_t i = 0; i < bytes.size(); ++i) {
        std::vector<uint8_t> other = bytes;
        other[i] ^= uint8_t(1u << i % 8);
        refused += !complaint(draco_file(of, other)).empty();
    }
    EXPECT_GT(refused, 5u);
}

#endif

// The converted file has the geometry without compression, for any viewer.
TEST(GltfCompressed, IsConvertedToPlainGeometry) {
    std::vector<json> files{meshopt_file(wave(), "TRIANGLES")};
#ifdef VESPER_DRACO
    files.push_back(draco_file(wave(), draco_bytes(wave(), draco::MESH_EDGEBREAKER_ENCODING)));
#endif
    for (const json& root : files)
        for (const char* output : {"out.gltf", "out.glb"}) {
            const TempFolder folder;
            const auto rules = folder.write("rules.json", R"({"version": 1})");
            scene::convert(folder.write("in.gltf", root.dump()), rules, folder / output, {});
            const std::string text = read_text(folder / output);
            EXPECT_FALSE(contains(text, "_compression")) << output;
            EXPECT_EQ(triangles_of(scene::read_scene(folder / output).scene.meshes.at(0).primitives.at(0)),
                      triangles_of(read(root).scene.meshes.at(0).primitives.at(0)));
        }
}

TEST(GltfCompressed, SharedFilesAreRead) {
    for (const char* name : {"BoxMeshopt", "BoxDraco", "DracoSparseMesh"}) {
        const auto file = shared_data("gltf/gltf-transform/extensions/" + std::string(name) + ".gltf");
        if (!is_here(file)) GTEST_SKIP() << "no shared data";
        if (std::string(name).find("Draco") != std::string::npos && !scene::reads_draco()) continue;
        const scene::LoadedScene loaded = scene::read_scene(file);
        const size_t corners = loaded.scene.meshes.at(0).primitives.at(0).indices.size();
        EXPECT_EQ(corners, std::string(name) == "DracoSparseMesh" ? 306u : 36u) << name;
    }
}

}  // namespace
}  // namespace vesper::test
