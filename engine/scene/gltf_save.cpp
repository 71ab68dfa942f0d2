// Writing scenes with tinygltf (glTF 2.0, KHR_lights_punctual, EXT_lights_ies, KHR_materials_emissive_strength).
// SPDX-License-Identifier: MIT
#include "scene/gltf_save.h"

#include <algorithm>
#include <array>
#include <bit>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/angle.h"
#include "base/error.h"
#include "base/one_line.h"
#include "io/new_file.h"
#include "photometry/ies.h"
#include "scene/photometry_parts.h"
#include "scene/reflection_json.h"
#include "scene/tinygltf.h"

namespace vesper::scene {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

/// Far plane of cameras, in m. tinygltf 2.7 writes one always, and 0 is not allowed; readers of ours ignore it.
constexpr double kFar = 1e6;

/// Names come from files in any encoding; JSON is UTF-8.
std::string utf8(const std::string& text) {
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

/// JSON as tinygltf holds extensions and extras. Whole numbers must fit into an int.
tinygltf::Value value_of(const json& value) {
    switch (value.type()) {
        case json::value_t::object: {
            tinygltf::Value::Object members;
            for (const auto& [key, member] : value.items()) members.emplace(key, value_of(member));
            return tinygltf::Value(std::move(members));
        }
        case json::value_t::array: {
            tinygltf::Value::Array elements;
            for (const json& element : value) elements.push_back(value_of(element));
            return tinygltf::Value(std::move(elements));
        }
        case json::value_t::string:
            return tinygltf::Value(utf8(value.get_ref<const std::string&>()));
        case json::value_t::boolean:
            return tinygltf::Value(value.get<bool>());
        case json::value_t::number_float:
            return tinygltf::Value(value.get<double>());
        default:
            return tinygltf::Value(value.get<int>());
    }
}

std::vector<double> doubles_of(glm::dvec3 v) { return {v.x, v.y, v.z}; }
json json_of(glm::dvec3 v) { return {v.x, v.y, v.z}; }

/// The model under way. Its bytes lie in one buffer.
struct Writer {
    const Scene& scene;
    tinygltf::Model model{};

    explicit Writer(const Scene& of) : scene(of) {
        model.asset.generator = "vesper " VESPER_VERSION;
        model.buffers.emplace_back();
    }

    int view(const void* bytes, size_t size) {
        std::vector<unsigned char>& buffer = model.buffers.front().data;
        while (buffer.size() % 4 != 0) buffer.push_back(0);
        tinygltf::BufferView& made = model.bufferViews.emplace_back();
        made.buffer = 0;
        made.byteOffset = buffer.size();
        made.byteLength = size;
        const auto* first = static_cast<const unsigned char*>(bytes);
        buffer.insert(buffer.end(), first, first + size);
        return static_cast<int>(model.bufferViews.size() - 1);
    }

    template <class Element>
    int accessor(const std::vector<Element>& elements, int component, int type) {
        const int index = view(elements.data(), elements.size() * sizeof(Element));
        tinygltf::Accessor& made = model.accessors.emplace_back();
        made.bufferView = index;
        made.componentType = component;
        made.count = elements.size();
        made.type = type;
        return static_cast<int>(model.accessors.size() - 1);
    }

    void use(const char* extension) {
        std::vector<std::string>& used = model.extensionsUsed;
        if (std::find(used.begin(), used.end(), extension) == used.end()) used.emplace_back(extension);
    }
};

void write_materials(Writer& writer) {
    for (const Material& material : writer.scene.materials) {
        tinygltf::Material& made = writer.model.materials.emplace_back();
        made.name = utf8(material.name);
        const glm::dvec4 c = material.base_colour;
        made.pbrMetallicRoughness.baseColorFactor = {c.r, c.g, c.b, c.a};
        made.pbrMetallicRoughness.metallicFactor = material.metallic;
        made.pbrMetallicRoughness.roughnessFactor = material.roughness;
        made.emissiveFactor = {0, 0, 0};
        const float brightest = std::max({material.emission.r, material.emission.g, material.emission.b});
        if (brightest > 0) {
            made.emissiveFactor = doubles_of(material.emission / brightest);
            made.extensions["KHR_materials_emissive_strength"] = value_of({{"emissiveStrength", brightest}});
            writer.use("KHR_materials_emissive_strength");
        }
        if (material.alpha == Material::Alpha::Mask) {
            made.alphaMode = "MASK";
            made.alphaCutoff = material.alpha_cutoff;
        }
        if (material.clear) {
            made.extensions["KHR_materials_transmission"] = value_of({{"transmissionFactor", 1}});
            writer.use("KHR_materials_transmission");
        }
        made.doubleSided = material.double_sided;
    }
}

tinygltf::Primitive primitive_of(Writer& writer, const Primitive& primitive) {
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
    tinygltf::Primitive made;
    made.mode = TINYGLTF_MODE_TRIANGLES;
    made.material = static_cast<int>(primitive.material);
    made.attributes["POSITION"] = writer.accessor(positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    writer.model.accessors.back().minValues = doubles_of(bounds.low);
    writer.model.accessors.back().maxValues = doubles_of(bounds.high);
    made.attributes["NORMAL"] = writer.accessor(normals, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    if (mapped) made.attributes["TEXCOORD_0"] = writer.accessor(uv, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2);
    if (coloured) {
        made.attributes["COLOR_0"] =
            writer.accessor(colours, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4);
        writer.model.accessors.back().normalized = true;
    }
    made.indices = writer.accessor(primitive.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR);
    return made;
}

void write_meshes(Writer& writer) {
    for (const Mesh& mesh : writer.scene.meshes) {
        tinygltf::Mesh made;
        made.name = utf8(mesh.name);
        for (const Primitive& primitive : mesh.primitives)
            if (!primitive.indices.empty()) made.primitives.push_back(primitive_of(writer, primitive));
        if (made.primitives.empty()) throw Error("mesh '" + mesh.name + "' has no triangles: glTF cannot hold it");
        writer.model.meshes.push_back(std::move(made));
    }
}

void add_opening(json& openings, const char* of, size_t index, const photometry::LuminousOpening& opening) {
    if (!(opening.area() > 0)) return;
    openings.push_back({{of, index}, {"width_m", opening.length}, {"height_m", opening.width}});
    if (opening.round) openings.back()["round"] = true;
    if (!opening.drawn) openings.back()["drawn"] = false;
}

/// The extension by which a node uses a lamp.
struct LampUse {
    std::string extension;
    tinygltf::Value value;
};

/// Lists of punctual lights and light profiles, and how nodes use each lamp of the scene.
std::vector<LampUse> write_lamps(Writer& writer, json& block) {
    std::vector<LampUse> uses;
    json profiles = json::array(), openings = json::array(), lobes = json::array();
    for (const Lamp& lamp : writer.scene.lamps) {
        // A colour of luminance 1 becomes one whose largest component is 1; the intensity takes the factor.
        const float factor = std::max({lamp.colour.r, lamp.colour.g, lamp.colour.b});
        const glm::dvec3 colour = lamp.colour / factor;
        const double intensity = lamp.intensity * double(factor);
        if (lamp.kind == Lamp::Kind::Measured) {
            // One profile for each light: openings belong to profiles.
            const std::string text = photometry::write_ies(writer.scene.distributions.at(lamp.distribution));
            profiles.push_back({{"name", lamp.name},
                                {"bufferView", writer.view(text.data(), text.size())},
                                {"mimeType", "application/x-ies-lm-63"}});
            add_opening(openings, "profile", profiles.size() - 1, lamp.opening);
            uses.push_back(
                {"EXT_lights_ies",
                 value_of({{"light", profiles.size() - 1}, {"multiplier", intensity}, {"color", json_of(colour)}})});
            continue;
        }
        const size_t index = writer.model.lights.size();
        tinygltf::Light& made = writer.model.lights.emplace_back();
        made.name = utf8(lamp.name);
        made.intensity = intensity;
        made.color = doubles_of(colour);
        made.type = lamp.kind == Lamp::Kind::Point         ? "point"
                    : lamp.kind == Lamp::Kind::Directional ? "directional"
                                                           : "spot";
        made.spot.innerConeAngle = lamp.inner_cone;
        made.spot.outerConeAngle = lamp.outer_cone;
        if (lamp.kind == Lamp::Kind::CosinePower)
            lobes.push_back({{"light", index}, {"type", "cosine_power"}, {"exponent", lamp.exponent}});
        add_opening(openings, "light", index, lamp.opening);
        if (lamp.kind == Lamp::Kind::Directional && lamp.angular_diameter != Lamp{}.angular_diameter)
            openings.push_back(
                {{"light", index}, {"angular_diameter_deg", double(lamp.angular_diameter) * kDegreesPerRadian}});
        uses.push_back({"KHR_lights_punctual", value_of({{"light", index}})});
    }
    if (!profiles.empty()) {
        writer.model.extensions["EXT_lights_ies"] = value_of({{"lights", std::move(profiles)}});
        writer.use("EXT_lights_ies");
    }
    if (!openings.empty()) block["openings"] = std::move(openings);
    if (!lobes.empty()) block["lobes"] = std::move(lobes);
    return uses;
}

void write_transform(const Node& node, tinygltf::Node& made) {
    if (node.matrix) {
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) made.matrix.push_back((*node.matrix)[c][r]);
        return;
    }
    if (node.translation != glm::dvec3(0)) made.translation = doubles_of(node.translation);
    if (node.rotation != glm::quat(1, 0, 0, 0))
        made.rotation = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
    // tinygltf writes a node that has nothing as null.
    if (node.scale != glm::vec3(1) || node.name.empty()) made.scale = doubles_of(node.scale);
}

void write_nodes(Writer& writer, const std::vector<LampUse>& lamps) {
    tinygltf::Model& model = writer.model;
    tinygltf::Scene scene;
    scene.name = utf8(writer.scene.name);
    model.nodes.resize(writer.scene.nodes.size());
    for (size_t i = 0; i < model.nodes.size(); ++i) {
        const Node& node = writer.scene.nodes[i];
        tinygltf::Node& made = model.nodes[i];
        made.name = utf8(node.name);
        write_transform(node, made);
        if (node.mesh != kNone) made.mesh = static_cast<int>(node.mesh);
        if (node.camera != kNone) made.camera = static_cast<int>(node.camera);
        if (node.lamp != kNone) made.extensions[lamps.at(node.lamp).extension] = lamps[node.lamp].value;
        (node.parent == kNone ? scene.nodes : model.nodes[node.parent].children).push_back(static_cast<int>(i));
    }
    if (!scene.nodes.empty() || !scene.name.empty()) {
        model.scenes.push_back(std::move(scene));
        model.defaultScene = 0;
    }
    for (const Camera& camera : writer.scene.cameras) {
        tinygltf::Camera& made = model.cameras.emplace_back();
        made.name = utf8(camera.name);
        made.type = "perspective";
        made.perspective.yfov = camera.vertical_fov;
        made.perspective.znear = camera.near;
        made.perspective.zfar = kFar;
    }
}

void write_animation(Writer& writer) {
    tinygltf::Animation animation;
    animation.name = "drive";
    for (const Channel& channel : writer.scene.channels) {
        const bool turns = channel.path == Channel::Path::Rotation;
        tinygltf::AnimationSampler sampler;
        sampler.input = writer.accessor(channel.times, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR);
        writer.model.accessors.back().minValues = {channel.times.front()};
        writer.model.accessors.back().maxValues = {channel.times.back()};
        const std::vector<glm::vec3> threes(channel.values.begin(), channel.values.end());
        sampler.output = turns ? writer.accessor(channel.values, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4)
                               : writer.accessor(threes, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
        sampler.interpolation = channel.interpolation == Channel::Interpolation::Step    ? "STEP"
                                : channel.interpolation == Channel::Interpolation::Cubic ? "CUBICSPLINE"
                                                                                         : "LINEAR";
        tinygltf::AnimationChannel made;
        made.sampler = static_cast<int>(animation.samplers.size());
        made.target_node = static_cast<int>(channel.node);
        made.target_path = turns ? "rotation" : channel.path == Channel::Path::Scale ? "scale" : "translation";
        animation.channels.push_back(std::move(made));
        animation.samplers.push_back(std::move(sampler));
    }
    if (!animation.channels.empty()) writer.model.animations.push_back(std::move(animation));
}

void write_block(const Scene& scene, json& block, const std::string& source) {
    block["version"] = 1;
    block["transfer"] = {{"kind", scene.transfer.kind == Transfer::Kind::Gamma ? "gamma" : "srgb"}};
    if (scene.transfer.kind == Transfer::Kind::Gamma) block["transfer"]["gamma"] = scene.transfer.gamma;
    block["ambient"] = {{"illuminance_lx", scene.ambient_illuminance}, {"colour", json_of(scene.ambient_colour)}};
    block["sky"] = {{"luminance_cd_m2", scene.sky_luminance}, {"colour", json_of(scene.sky_colour)}};
    for (const photometry::ReflectionTable& table : scene.reflection_tables)
        block["reflection_tables"].push_back(scene::json_of(table));
    for (const photometry::Retroreflector& one : scene.retroreflectors)
        block["retroreflectors"].push_back(scene::json_of(one));
    for (size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        if (material.reflection_table != kNone)
            block["roads"].push_back({{"material", m}, {"table", material.reflection_table}});
        if (material.retroreflector != kNone)
            block["retroreflective"].push_back({{"material", m}, {"retroreflector", material.retroreflector}});
    }
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const std::optional<uint32_t>& fixture = scene.nodes[i].fixture;
        if (scene.nodes[i].lamp != kNone && fixture)
            block["fixtures"].push_back({{"node", i}, {"fixture", *fixture == kNone ? json("none") : json(*fixture)}});
    }
    block["provenance"] = {{"input", source}, {"vesper", VESPER_VERSION}};
}

std::vector<uint8_t> encode(Writer& writer, bool binary) {
    const auto too_large = [&] { return Error("scene '" + writer.scene.name + "': takes more than 4 GiB as glTF"); };
    std::vector<tinygltf::Buffer>& buffers = writer.model.buffers;
    if (buffers.front().data.size() > UINT32_MAX) throw too_large();
    if (buffers.front().data.empty()) buffers.clear();
    std::stringbuf bytes;
    std::ostream stream(&bytes);
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&writer.model, stream, false, binary);
    const std::string file = std::move(bytes).str();
    if (binary && file.size() > UINT32_MAX) throw too_large();
    return {file.begin(), file.end()};
}

}  // namespace

bool is_gltf_name(const std::filesystem::path& file) {
    return file.extension() == ".gltf" || file.extension() == ".glb";
}

void save_gltf(const Scene& scene, const std::string& source, const std::filesystem::path& file) {
    if (!is_gltf_name(file)) throw Error(one_line(file.string()) + ": the output must be named .gltf or .glb");
    if (!scene.images.empty() || !scene.luminance_pictures.empty() || scene.environment)
        throw Error("scene '" + scene.name + "': has pictures, which only its file can give");
    Writer writer(scene);
    json block;
    write_materials(writer);
    write_meshes(writer);
    write_nodes(writer, write_lamps(writer, block));
    write_animation(writer);
    write_block(scene, block, source);
    writer.model.extras = value_of({{"vesper", std::move(block)}});
    io::replace_file(file, encode(writer, file.extension() == ".glb"));
}

}  // namespace vesper::scene
