// Bytes as geometry that glTF has compressed. SPDX-License-Identifier: MIT
#include "fuzz/compressed.h"

#include <array>
#include <fstream>

#include <nlohmann/json.hpp>

namespace vesper::test {
namespace {

using nlohmann::json;

/// The first byte says whether the rest is Draco's geometry, or a mode of meshoptimizer; the next two the count and
/// the filter.
constexpr size_t kHead = 3;

void add_draco(json& root, uint32_t first_attribute, size_t length) {
    root["bufferViews"] = {{{"buffer", 0}, {"byteOffset", kHead}, {"byteLength", length}}};
    const json shell{{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}};
    root["accessors"] = {shell, shell, {{"componentType", 5123}, {"type", "SCALAR"}, {"count", 3}}};
    const json draco{{"bufferView", 0},
                     {"attributes", {{"POSITION", first_attribute}, {"NORMAL", (first_attribute + 1) % 3}}}};
    root["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}},
                                          {"indices", 2},
                                          {"extensions", {{"KHR_draco_mesh_compression", draco}}}};
}

void add_meshopt(json& root, uint32_t mode, uint32_t number, uint32_t filter, size_t length) {
    constexpr std::array kModes{"", "ATTRIBUTES", "TRIANGLES", "INDICES"};
    constexpr std::array kFilters{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
    const uint32_t stride = mode == 1 ? 4 + 4 * (number % 4) : 2 + 2 * (number % 2),
                   count = mode == 2 ? 3 * number : number;
    json compression{{"buffer", 0},          {"byteOffset", kHead},  {"byteLength", length},
                     {"mode", kModes[mode]}, {"byteStride", stride}, {"count", count}};
    if (mode == 1) compression["filter"] = kFilters[filter];
    root["buffers"].push_back(
        {{"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    root["bufferViews"] = {{{"buffer", 1},
                            {"byteLength", count * stride},
                            {"byteStride", stride},
                            {"extensions", {{"EXT_meshopt_compression", compression}}}}};
    root["accessors"] = {{{"bufferView", 0},
                          {"componentType", mode == 1 ? 5120 : 5123},
                          {"type", mode == 1 ? "VEC3" : "SCALAR"},
                          {"count", count}}};
    root["meshes"][0]["primitives"][0]["attributes"][mode == 1 ? "POSITION" : "_X"] = 0;
}

}  // namespace

std::filesystem::path scene_around(const std::filesystem::path& file) {
    std::ifstream from(file, std::ios::binary);
    std::array<char, kHead> head{};
    from.read(head.data(), head.size());
    const size_t size = std::filesystem::file_size(file), length = size > kHead ? size - kHead : 0;
    const auto byte = [&](size_t i) { return uint32_t(uint8_t(head[i])); };
    const uint32_t kind = byte(0) % 4, number = byte(1) + 256 * (byte(2) % 8);
    json root{{"asset", {{"version", "2.0"}}}, {"nodes", {{{"mesh", 0}}}}};
    root["buffers"] = {{{"byteLength", size}, {"uri", file.filename().string()}}};
    kind == 0 ? add_draco(root, number % 3, length) : add_meshopt(root, kind, number, byte(2) >> 6, length);
    std::filesystem::path scene = file.parent_path() / "x.gltf";
    std::ofstream(scene) << root.dump();
    return scene;
}

}  // namespace vesper::test
