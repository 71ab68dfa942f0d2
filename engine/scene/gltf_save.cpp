// Writing scenes (glTF 2.0, KHR_lights_punctual, EXT_lights_ies, KHR_materials_emissive_strength).
// SPDX-License-Identifier: MIT
#include "scene/gltf_save.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "io/atomic_file.h"
#include "photometry/ies.h"
#include "scene/gltf_write.h"
#include "scene/photometry_parts.h"
#include "scene/reflection_json.h"

namespace vesper {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

constexpr int kFloat = 5126, kUnsigned = 5125, kShort = 5123;

json json_of(glm::dvec3 v) { return {v.x, v.y, v.z}; }

/// The document under way, and its one buffer.
struct Writer {
    const Scene& scene;
    json root = {{"asset", {{"version", "2.0"}, {"generator", "vesper " VESPER_VERSION}}}};
    std::vector<uint8_t> buffer{};

    size_t view(const void* bytes, size_t size) {
        while (buffer.size() % 4 != 0) buffer.push_back(0);
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", size}});
        const auto* first = static_cast<const uint8_t*>(bytes);
        buffer.insert(buffer.end(), first, first + size);
        return root["bufferViews"].size() - 1;
    }

    template <class Element>
    size_t accessor(const std::vector<Element>& elements, int component, const char* type) {
        const size_t index = view(elements.data(), elements.size() * sizeof(Element));
        root["accessors"].push_back(
            {{"bufferView", index}, {"componentType", component}, {"count", elements.size()}, {"type", type}});
        return root["accessors"].size() - 1;
    }

    void use(const char* extension) {
        json& used = root["extensionsUsed"];
        if (std::find(used.begin(), used.end(), json(extension)) == used.end()) used.push_back(extension);
    }
};

void write_materials(Writer& writer) {
    for (const Material& material : writer.scene.materials) {
        json made = {{"name", material.name}};
        const glm::vec4 c = material.base_colour;
        made["pbrMetallicRoughness"] = {{"baseColorFactor", {c.r, c.g, c.b, c.a}},
                                        {"metallicFactor", material.metallic},
                                        {"roughnessFactor", material.roughness}};
        const float brightest = std::max({material.emission.r, material.emission.g, material.emission.b});
        if (brightest > 0) {
            made["emissiveFactor"] = json_of(material.emission / brightest);
            made["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = brightest;
            writer.use("KHR_materials_emissive_strength");
        }
        if (material.alpha == Material::Alpha::Mask)
            made["alphaMode"] = "MASK", made["alphaCutoff"] = material.alpha_cutoff;
        if (material.double_sided) made["doubleSided"] = true;
        writer.root["materials"].push_back(std::move(made));
    }
}

json primitive_of(Writer& writer, const Primitive& primitive) {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uv;
    std::vector<std::array<uint16_t, 4>> colours;
    Bounds bounds;
    bool coloured = false, mapped = false;
    for (const Vertex& vertex : primitive.vertices) {
        positions.push_back(vertex.position), normals.push_back(vertex.normal), uv.push_back(vertex.uv),
            colours.push_back(vertex.colour);
        bounds.add(vertex.position);
        coloured = coloured || vertex.colour != Vertex{}.colour;
        mapped = mapped || vertex.uv != glm::vec2(0);
    }
    json attributes;
    attributes["POSITION"] = writer.accessor(positions, kFloat, "VEC3");
    writer.root["accessors"].back()["min"] = json_of(bounds.low),
    writer.root["accessors"].back()["max"] = json_of(bounds.high);
    attributes["NORMAL"] = writer.accessor(normals, kFloat, "VEC3");
    if (mapped) attributes["TEXCOORD_0"] = writer.accessor(uv, kFloat, "VEC2");
    if (coloured) {
        attributes["COLOR_0"] = writer.accessor(colours, kShort, "VEC4");
        writer.root["accessors"].back()["normalized"] = true;
    }
    return {{"attributes", attributes},
            {"indices", writer.accessor(primitive.indices, kUnsigned, "SCALAR")},
            {"material", primitive.material}};
}

void write_meshes(Writer& writer) {
    for (const Mesh& mesh : writer.scene.meshes) {
        json primitives = json::array();
        for (const Primitive& primitive : mesh.primitives)
            if (!primitive.indices.empty()) primitives.push_back(primitive_of(writer, primitive));
        if (primitives.empty()) throw Error("mesh '" + mesh.name + "' has no triangles: glTF cannot hold it");
        writer.root["meshes"].push_back({{"name", mesh.name}, {"primitives", std::move(primitives)}});
    }
}

/// A colour of luminance 1 as one whose largest component is 1, and what that takes off the intensity
/// (docs/photometry.md).
std::pair<json, double> stored(glm::vec3 colour) {
    const float brightest = std::max({colour.r, colour.g, colour.b});
    return {json_of(colour / brightest), brightest};
}

void add_opening(json& openings, const char* of, size_t index, const LuminousOpening& opening) {
    if (!(opening.area() > 0)) return;
    openings.push_back({{of, index}, {"width_m", opening.length}, {"height_m", opening.width}});
    if (opening.round) openings.back()["round"] = true;
}

/// What a node says of each light, and the lights' and profiles' lists.
std::vector<json> write_lights(Writer& writer, json& block) {
    std::vector<json> uses;
    json punctual = json::array(), profiles = json::array(), openings = json::array(), lobes = json::array();
    for (const Lamp& lamp : writer.scene.lamps) {
        const auto [colour, factor] = stored(lamp.colour);
        if (lamp.kind == Lamp::Kind::Measured) {
            // One profile for each light: openings belong to profiles.
            const Distribution& distribution = writer.scene.distributions.at(lamp.distribution);
            const std::string text = write_ies(distribution);
            profiles.push_back({{"name", lamp.name},
                                {"bufferView", writer.view(text.data(), text.size())},
                                {"mimeType", "application/x-ies-lm-63"}});
            add_opening(openings, "profile", profiles.size() - 1, lamp.opening);
            uses.push_back(
                {{"EXT_lights_ies",
                  {{"light", profiles.size() - 1}, {"multiplier", lamp.intensity * factor}, {"color", colour}}}});
            continue;
        }
        const bool spot = lamp.kind == Lamp::Kind::Spot || lamp.kind == Lamp::Kind::CosinePower;
        json made = {{"name", lamp.name},
                     {"intensity", lamp.intensity * factor},
                     {"color", colour},
                     {"type", lamp.kind == Lamp::Kind::Point         ? "point"
                              : lamp.kind == Lamp::Kind::Directional ? "directional"
                                                                       : "spot"}};
        if (spot) made["spot"] = {{"innerConeAngle", lamp.inner_cone}, {"outerConeAngle", lamp.outer_cone}};
        if (lamp.kind == Lamp::Kind::CosinePower)
            lobes.push_back({{"light", punctual.size()}, {"type", "cosine_power"}, {"exponent", lamp.exponent}});
        add_opening(openings, "light", punctual.size(), lamp.opening);
        uses.push_back({{"KHR_lights_punctual", {{"light", punctual.size()}}}});
        punctual.push_back(std::move(made));
    }
    if (!punctual.empty())
        writer.root["extensions"]["KHR_lights_punctual"]["lights"] = std::move(punctual),
        writer.use("KHR_lights_punctual");
    if (!profiles.empty())
        writer.root["extensions"]["EXT_lights_ies"]["lights"] = std::move(profiles), writer.use("EXT_lights_ies");
    if (!openings.empty()) block["openings"] = std::move(openings);
    if (!lobes.empty()) block["lobes"] = std::move(lobes);
    return uses;
}

void write_nodes(Writer& writer, const std::vector<json>& lamps) {
    json roots = json::array();
    for (size_t i = 0; i < writer.scene.nodes.size(); ++i) {
        const Node& node = writer.scene.nodes[i];
        json made = {{"name", node.name}};
        if (node.matrix) {
            for (int c = 0; c < 4; ++c)
                for (int r = 0; r < 4; ++r) made["matrix"].push_back((*node.matrix)[c][r]);
        } else {
            if (node.translation != glm::dvec3(0)) made["translation"] = json_of(node.translation);
            if (node.rotation != glm::quat(1, 0, 0, 0))
                made["rotation"] = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
            if (node.scale != glm::vec3(1)) made["scale"] = json_of(node.scale);
        }
        if (node.mesh != kNone) made["mesh"] = node.mesh;
        if (node.camera != kNone) made["camera"] = node.camera;
        if (node.lamp != kNone) made["extensions"] = lamps.at(node.lamp);
        if (node.parent == kNone)
            roots.push_back(i);
        else
            writer.root["nodes"][node.parent]["children"].push_back(i);
        writer.root["nodes"].push_back(std::move(made));
    }
    writer.root["scenes"] = json::array({{{"name", writer.scene.name}, {"nodes", std::move(roots)}}});
    if (writer.scene.name.empty()) writer.root["scenes"][0].erase("name");
    if (writer.scene.nodes.empty()) writer.root["scenes"][0].erase("nodes");
    writer.root["scene"] = 0;
    for (const Camera& camera : writer.scene.cameras)
        writer.root["cameras"].push_back({{"name", camera.name},
                                          {"type", "perspective"},
                                          {"perspective", {{"yfov", camera.vertical_fov}, {"znear", camera.near}}}});
}

void write_animation(Writer& writer) {
    json samplers = json::array(), channels = json::array();
    for (const Channel& channel : writer.scene.channels) {
        json sampler;
        sampler["input"] = writer.accessor(channel.times, kFloat, "SCALAR");
        writer.root["accessors"].back()["min"] = {channel.times.front()},
        writer.root["accessors"].back()["max"] = {channel.times.back()};
        const bool turns = channel.path == Channel::Path::Rotation;
        std::vector<glm::vec3> threes;
        for (const glm::vec4& value : channel.values) threes.emplace_back(value);
        sampler["output"] =
            turns ? writer.accessor(channel.values, kFloat, "VEC4") : writer.accessor(threes, kFloat, "VEC3");
        sampler["interpolation"] = channel.interpolation == Channel::Interpolation::Step    ? "STEP"
                                   : channel.interpolation == Channel::Interpolation::Cubic ? "CUBICSPLINE"
                                                                                            : "LINEAR";
        const char* path = turns ? "rotation" : channel.path == Channel::Path::Scale ? "scale" : "translation";
        channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", channel.node}, {"path", path}}}});
        samplers.push_back(std::move(sampler));
    }
    if (!channels.empty())
        writer.root["animations"] =
            json::array({{{"name", "drive"}, {"samplers", std::move(samplers)}, {"channels", std::move(channels)}}});
}

void write_block(Writer& writer, json& block, const std::string& source) {
    const Scene& scene = writer.scene;
    block["version"] = 1;
    block["transfer"] = {{"kind", scene.transfer.kind == Transfer::Kind::Gamma ? "gamma" : "srgb"}};
    if (scene.transfer.kind == Transfer::Kind::Gamma) block["transfer"]["gamma"] = scene.transfer.gamma;
    block["ambient"] = {{"illuminance_lx", scene.ambient_illuminance}, {"colour", json_of(scene.ambient_colour)}};
    block["sky"] = {{"luminance_cd_m2", scene.sky_luminance}, {"colour", json_of(scene.sky_colour)}};
    for (const ReflectionTable& table : scene.reflection_tables)
        block["reflection_tables"].push_back(vesper::json_of(table));
    for (const Retroreflector& one : scene.retroreflectors) block["retroreflectors"].push_back(vesper::json_of(one));
    for (size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        if (material.reflection_table != kNone)
            block["roads"].push_back({{"material", m}, {"table", material.reflection_table}});
        if (material.retroreflector != kNone)
            block["retroreflective"].push_back({{"material", m}, {"retroreflector", material.retroreflector}});
    }
    block["provenance"] = {{"input", source}, {"vesper", VESPER_VERSION}};
}

}  // namespace

std::vector<uint8_t> encode_scene(const Scene& scene, const std::string& source, bool binary) {
    if (!scene.images.empty() || !scene.luminance_pictures.empty() || scene.environment)
        throw Error("scene '" + scene.name + "': has pictures, which only its file can give");
    Writer writer{scene};
    json block;
    write_materials(writer);
    write_meshes(writer);
    write_nodes(writer, write_lights(writer, block));
    write_animation(writer);
    write_block(writer, block, source);
    writer.root["extras"]["vesper"] = std::move(block);
    return encode_gltf(writer.root, writer.buffer, scene.name, binary);
}

void save_gltf(const Scene& scene, const std::string& source, const std::filesystem::path& file) {
    const std::string extension = file.extension().string();
    if (extension != ".gltf" && extension != ".glb")
        throw Error(one_line(file.string()) + ": the output must be named .gltf or .glb");
    replace_file(file, encode_scene(scene, source, extension == ".glb"));
}

}  // namespace vesper
